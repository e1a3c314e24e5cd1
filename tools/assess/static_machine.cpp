#include "tools/assess/static_machine.h"

#include "elements/step_lap/step_lap_joint.h"
#include "mbd/model/entries.h"
#include "mbd/rest/assembly.h"
#include "mbd/rest/ramped_rest.h"
#include "mbd/rest/start.h"
#include "mbd/run/failure.h"
#include "mbd/run/rest_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace steplap::assess {

namespace {

// reserve reported for friction that has slid during loading; the amount by which its limit was exceeded is unknown
constexpr double k_beyond = -1e-3;

int channel_index(const System& system, const std::string& name) {
  for (std::size_t i = 0; i < system.channels.size(); ++i)
    if (system.channels[i].name == name) return static_cast<int>(i);
  return -1;
}

Model with_monitors(Model model) {
  for (StepLapJoint* const joint : elements_of<StepLapJoint>(model))
    if (!is_elastic(*joint)) joint->mode = "monitor";
  return model;
}

} // namespace

const char* name_of(LimitKind kind) {
  switch (kind) {
  case LimitKind::slips: return "slips";
  case LimitKind::slides: return "slides";
  case LimitKind::lifts: return "lifts";
  case LimitKind::ends: break;
  }
  return "ends";
}

StaticMachine::StaticMachine(const LoadedModel& loaded)
    : model_(with_monitors(loaded.model)), system_(compile(model_)), gravity_(system_->gravity) {
  try {
    at_rest_.rest = equilibrium_at_start(*system_, assemble(model_, *system_));
  } catch (const RunStopped&) { // the search was interrupted, so nothing is known about the machine
    throw;
  } catch (const NumericalFailure& failure) {
    throw NumericalFailure("without any acceleration: " + failure_of(failure, model_, *system_, 0.0).text);
  }
  std::fill(at_rest_.rest->state.v.begin(), at_rest_.rest->state.v.end(), 0.0);
  at_rest_.values = values_at_rest(*system_, at_rest_.rest->state);
  find_watches();
  at_rest_.left = reserves_of(at_rest_);
}

void StaticMachine::find_watches() {
  const auto add = [&](LimitKind kind, const std::string& element, int channel, int friction) {
    watches_.push_back({kind, element});
    channel_.push_back(channel);
    friction_.push_back(friction);
    rest_gap_.push_back(0.0);
  };
  std::set<std::string> step_lap;
  for (const ElementEntry& entry : model_.elements) {
    const std::string& name = entry.element->name;
    if (dynamic_cast<const StepLapJoint*>(entry.element.get())) {
      step_lap.insert(name);
      const int usage = channel_index(*system_, name + ".u");
      if (usage < 0) continue; // the joint has unlimited capacity
      joints_.push_back(name);
      add(LimitKind::slips, name, usage, -1);
      continue;
    }
    const int gap = channel_index(*system_, name + ".gap");
    if (gap < 0 || !(at_rest_.values[static_cast<std::size_t>(gap)] < 0.0)) continue;
    add(LimitKind::lifts, name, gap, -1);
    rest_gap_.back() = -at_rest_.values[static_cast<std::size_t>(gap)];
  }
  for (int f = 0; f < static_cast<int>(system_->frictions.size()); ++f) {
    const FrictionUnit& unit = system_->frictions[static_cast<std::size_t>(f)];
    const std::string& name = system_->element_names[static_cast<std::size_t>(unit.element)];
    if (unit.friction->never_slips() || step_lap.contains(name)) continue;
    add(unit.friction->dimension() > 1 ? LimitKind::slips : LimitKind::slides, name, -1, f);
  }
}

std::vector<double> StaticMachine::reserves_of(const Probe& probe) const {
  std::vector<double> left(watches_.size(), 1.0);
  for (std::size_t w = 0; w < watches_.size(); ++w) {
    if (channel_[w] >= 0) {
      const double value = probe.values[static_cast<std::size_t>(channel_[w])];
      left[w] = watches_[w].kind == LimitKind::lifts ? -value / rest_gap_[w] : 1.0 - value;
      continue;
    }
    for (const FrictionMargin& margin : probe.rest->margins)
      if (margin.friction == friction_[w]) left[w] = 1.0 - margin.used;
    const std::vector<int>& slid = probe.rest->slid;
    if (std::find(slid.begin(), slid.end(), friction_[w]) != slid.end()) left[w] = k_beyond;
  }
  return left;
}

Probe StaticMachine::probe(const State& start, const Vec2& pull) {
  struct Restored { // restores gravity at the end of the scope, also after an exception
    System& system;
    Vec2 gravity;
    ~Restored() { system.gravity = gravity; }
  } const restored{*system_, gravity_};
  system_->gravity = gravity_ + pull;
  Probe probe;
  try {
    Equilibrium found = find_ramped_rest(*system_, start);
    if (!found.left.empty()) {
      probe.failure = "the pose balances, but a nudge of " + part_text(*system_, found.left.front()) + " leaves it";
      return probe;
    }
    if (found.turned != 0.0) {
      probe.failure = "'" + system_->bodies[static_cast<std::size_t>(found.turned_body)].name + "' tips over";
      return probe;
    }
    probe.values = values_at_rest(*system_, found.state);
    probe.rest = std::move(found);
    probe.left = reserves_of(probe);
  } catch (const RunStopped&) {
    throw;
  } catch (const NumericalFailure& failure) {
    probe.failure = failure.what();
    probe.is_unknown = dynamic_cast<const RestNotFound*>(&failure) != nullptr;
    probe.rest.reset();
  }
  return probe;
}

Probe StaticMachine::ramped(const Vec2& pull) { return probe(at_rest_.rest->state, pull); }

Probe StaticMachine::ramped_from(const Probe& before, const Vec2& pull) { return probe(before.rest->state, pull); }

Probe StaticMachine::without_friction(const Vec2& pull) {
  State loose = at_rest_.rest->state;
  for (std::size_t w = 0; w < watches_.size(); ++w)
    if (watches_[w].kind == LimitKind::slides) loose.friction[static_cast<std::size_t>(friction_[w])].phase = FrictionPhase::apart;
  return probe(loose, pull);
}

double StaticMachine::value(const Probe& probe, const std::string& channel) const {
  const int index = channel_index(*system_, channel);
  return index < 0 || probe.values.empty() ? std::numeric_limits<double>::quiet_NaN() : probe.values[static_cast<std::size_t>(index)];
}

} // namespace steplap::assess
