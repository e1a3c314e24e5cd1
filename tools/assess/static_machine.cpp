#include "tools/assess/static_machine.h"

#include "elements/step_lap/step_lap_joint.h"
#include "mbd/model/entries.h"
#include "mbd/rest/assembly.h"
#include "mbd/rest/start.h"
#include "mbd/rest/tangent.h"
#include "mbd/run/failure.h"
#include "mbd/run/prominence.h"
#include "mbd/run/rest_values.h"
#include "mbd/system/actions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace steplap::assess {

namespace {

// reserve reported for friction that has slid during loading; the amount by which its limit was exceeded is unknown
constexpr double k_beyond = -1e-3;

constexpr double k_first_increments[] = {1.0 / 16.0, 1.0 / 23.0}; // of the two divisions of a path; their halves do not coincide
constexpr double k_small_force = 0.1;                             // of the largest force; smaller ones count as this one

constexpr double k_rounding = 1e-6; // of the largest force: forces at an equilibrium are known to this; couples times the size of the model

constexpr double k_near = 1e-3;    // of a pull: friction that has k_reserve left does not slide within it
constexpr double k_reserve = 1e-2; // of its capacity

int channel_index(const System& system, const std::string& name) {
  for (std::size_t i = 0; i < system.channels.size(); ++i)
    if (system.channels[i].name == name) return static_cast<int>(i);
  return -1;
}

// Sets a machine's gravity during its lifetime.
class PulledMachine {
public:
  PulledMachine(System& system, const Vec2& gravity) : system_(system), before_(system.gravity) { system.gravity = gravity; }
  PulledMachine(const PulledMachine&) = delete;
  PulledMachine& operator=(const PulledMachine&) = delete;
  ~PulledMachine() { system_.gravity = before_; }

private:
  System& system_;
  const Vec2 before_;
};

Model with_monitors(Model model) {
  for (StepLapJoint* const joint : elements_of<StepLapJoint>(model))
    if (!is_elastic(*joint)) joint->mode = "monitor";
  return model;
}

} // namespace

void Probe::append_equilibrium(std::vector<double> next) {
  if (low.empty()) low = high = next;
  for (std::size_t i = 0; i < next.size(); ++i) {
    if (!(next[i] >= low[i])) low[i] = next[i]; // NaN is the worst
    if (!(next[i] <= high[i])) high[i] = next[i];
  }
  values = std::move(next);
}

const char* name_of(LimitKind kind) {
  switch (kind) {
  case LimitKind::slips: return "slips";
  case LimitKind::slides: return "slides";
  case LimitKind::lifts: return "lifts";
  case LimitKind::breaks: return "breaks";
  case LimitKind::ends: break;
  }
  return "ends";
}

StaticMachine::StaticMachine(const LoadedModel& loaded)
    : model_(with_monitors(loaded.model)), system_(compile(model_)), gravity_(system_->gravity) {
  try {
    at_rest_.rest = RampedRest{equilibrium_at_start(*system_, assemble(model_, *system_)), {}};
  } catch (const RunStopped&) { // the search was interrupted, so nothing is known about the machine
    throw;
  } catch (const NumericalFailure& failure) {
    throw NumericalFailure("without any acceleration: " + failure_of(failure, model_, *system_, 0.0).text);
  }
  std::fill(at_rest_.rest->state.v.begin(), at_rest_.rest->state.v.end(), 0.0);
  at_rest_.append_equilibrium(values_at_rest(*system_, at_rest_.rest->state));
  at_rest_.action = action_met_at(*system_, at_rest_.rest->state);
  find_watches();
  at_rest_.left = reserves_of(at_rest_);
}

std::vector<ForcesOfUnit> StaticMachine::forces_in(const std::vector<double>& values) const {
  std::map<std::string, ForcesOfUnit> groups; // by unit
  double largest = 0.0;                       // N, here and without pull
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Channel& channel = system_->channels[i];
    if (!is_reaction(channel)) continue;
    groups[channel.unit].values.push_back(values[i]);
    if (channel.unit == "N") largest = std::max({largest, std::abs(values[i]), std::abs(at_rest_.values[i])}); // not NaN
  }
  const double length = scale_of(*system_, at_rest_.rest->state).length;
  std::vector<ForcesOfUnit> forces;
  for (auto& [unit, group] : groups) {
    group.rounding = unit == "N" ? k_rounding * largest : unit == "N m" ? k_rounding * largest * length : 0.0;
    forces.push_back(std::move(group));
  }
  return forces;
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
    if (const int strength = channel_index(*system_, name + ".strength_share"); strength >= 0) add(LimitKind::breaks, name, strength, -1);
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
      const double value = probe.high[static_cast<std::size_t>(channel_[w])];
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

Probe StaticMachine::probe(const RampedRest& start, const Vec2& before, const Vec2& pull, double first_increment) {
  RampQuestions questions;
  Probe probe;
  questions.forces = [this](const RampedRest& rest) { return forces_in(values_at_rest(*system_, rest.state)); };
  questions.on_rest = [&](const RampedRest& rest, double share) {
    probe.append_equilibrium(values_at_rest(*system_, rest.state));
    if (probe.action.empty()) probe.action = action_met_at(*system_, rest.state);
    probe.rest = rest;
    probe.pull = before + share * (pull - before);
  };
  questions.on_jump = [&](int f, double share) {
    const int element = system_->frictions[static_cast<std::size_t>(f)].element;
    if (!probe.jump)
      probe.jump = Jump{system_->element_names[static_cast<std::size_t>(element)], Vec2(before + share * (pull - before)).norm()};
  };
  // Returns the probe of a failed search, with the last equilibrium on the path.
  const auto ended_by = [&](const NumericalFailure& failure) {
    Probe none;
    if (probe.rest) {
      probe.left = reserves_of(probe);
      probe.is_still = probe.rest->slid.empty();
      none.reached = std::make_shared<Probe>(std::move(probe));
    }
    none.pull = pull;
    none.failure = failure.what();
    return none;
  };
  try {
    probe.rest = find_ramped_rest(*system_, start, {gravity_ + before, gravity_ + pull, first_increment}, questions);
    probe.pull = pull;
    probe.left = reserves_of(probe);
    probe.is_still = probe.rest->slid.empty();
  } catch (const RunStopped&) {
    throw;
  } catch (const RestNotFound& failure) {
    Probe none = ended_by(failure);
    none.is_unknown = true;
    return none;
  } catch (const NumericalFailure& failure) {
    return ended_by(failure);
  }
  return probe;
}

// If only one of both paths comes to a rest, returns that one.
Probe StaticMachine::in_two_divisions(const std::function<Probe(double first_increment)>& path) const {
  Probe found = path(k_first_increments[0]), other = path(k_first_increments[1]);
  if (!found.rest) std::swap(found, other);
  if (!found.rest) return found;
  found.doubt = other.rest ? largest_difference(forces_in(found.values), forces_in(other.values), k_small_force)
                           : std::numeric_limits<double>::infinity();
  if (!found.jump) found.jump = other.jump;
  return found;
}

Probe StaticMachine::ramped(const Vec2& pull) {
  return in_two_divisions([&](double first) { return probe(*at_rest_.rest, Vec2::Zero(), pull, first); });
}

Probe StaticMachine::ramped_from(const Probe& before, const Vec2& pull) {
  if (before.is_still) {
    Probe found = still(pull);
    // Near a rest in which friction is far from sliding the machine leaves its place with all friction sticking.
    if (found.rest || (!found.is_unknown && (pull - before.pull).norm() <= k_near * pull.norm() && has_reserve(before))) return found;
  }
  Probe found = probe(*before.rest, before.pull, pull);
  found.is_still = found.is_still && before.is_still;
  if (found.reached) found.reached->is_still = found.reached->is_still && before.is_still;
  return found;
}

Probe StaticMachine::still(const Vec2& pull) {
  const PulledMachine pulled(*system_, gravity_ + pull);
  Probe probe;
  probe.pull = pull;
  try {
    std::optional<Equilibrium> found = find_still_rest(*system_, *at_rest_.rest);
    probe.is_unknown = !found;
    if (!found) return probe;
    probe.rest = RampedRest{std::move(*found), {}};
    probe.append_equilibrium(values_at_rest(*system_, probe.rest->state));
    probe.left = reserves_of(probe);
  } catch (const RunStopped&) {
    throw;
  } catch (const NumericalFailure& failure) {
    probe.failure = failure.what();
    probe.rest.reset();
  }
  return probe;
}

bool StaticMachine::has_reserve(const Probe& probe) const {
  for (std::size_t w = 0; w < watches_.size(); ++w)
    if (watches_[w].kind != LimitKind::lifts && probe.left[w] < k_reserve) return false;
  return true;
}

Probe StaticMachine::loaded_again(const Probe& before, const Vec2& pull) {
  Probe again = in_two_divisions([&](double first) {
    const Probe unloaded = probe(*before.rest, before.pull, Vec2::Zero(), first);
    if (!unloaded.rest) return unloaded;
    Probe loaded = probe(*unloaded.rest, Vec2::Zero(), pull, first);
    if (unloaded.jump) loaded.jump = unloaded.jump;
    for (const Probe* const earlier : {&unloaded, &before})
      if (!earlier->action.empty()) loaded.action = earlier->action;
    return loaded;
  });
  again.doubt = std::max(again.doubt, before.doubt);
  return again;
}

Probe StaticMachine::without_friction(const Vec2& pull) {
  RampedRest loose = *at_rest_.rest;
  for (std::size_t w = 0; w < watches_.size(); ++w)
    if (watches_[w].kind == LimitKind::slides) loose.state.friction[static_cast<std::size_t>(friction_[w])].phase = FrictionPhase::apart;
  Probe found = in_two_divisions([&](double first) { return probe(loose, Vec2::Zero(), pull, first); });
  if (!found.rest) return found;
  found.low = found.high = found.values; // the growing pull is only the way of the search: without it the loose machine may have no rest
  found.left = reserves_of(found);
  return found;
}

double StaticMachine::value_in(const std::vector<double>& values, const std::string& channel) const {
  const int index = channel_index(*system_, channel);
  return index < 0 || values.empty() ? std::numeric_limits<double>::quiet_NaN() : values[static_cast<std::size_t>(index)];
}

} // namespace steplap::assess
