#include "tools/assess/friction_trace.h"

#include "elements/coulomb_friction.h"
#include "elements/coulomb_stick.h"

#include <algorithm>
#include <cmath>

namespace steplap::assess {

namespace {

const CoulombFriction* friction_of(const System& system, const std::string& element) {
  for (const FrictionUnit& unit : system.frictions)
    if (system.element_names[unit.element] == element) return dynamic_cast<const CoulombFriction*>(unit.friction.get());
  return nullptr;
}

bool has_opened(const Model& whole, const RunResult& result, const std::string& element) {
  for (const ElementEntry& entry : whole.elements) {
    const auto* const stick = dynamic_cast<const CoulombStick*>(entry.element.get());
    if (!stick || stick->name != element) continue;
    return std::any_of(result.events.begin(), result.events.end(), [&](const Event& event) {
      return event.kind == EventKind::opens &&
             std::find(stick->contacts.begin(), stick->contacts.end(), event.element) != stick->contacts.end();
    });
  }
  return false;
}

} // namespace

double trace_step(const DriveHistory& history) {
  constexpr double k_most = 1e-3, k_least = 5e-4; // s; contacts of heavy machines vibrate below 100 Hz
  if (history.step > k_most) return history.step / std::ceil(history.step / k_most);
  return history.step * std::ceil(k_least / history.step);
}

std::vector<std::string> traced_channels(const std::vector<std::string>& elements) {
  std::vector<std::string> channels;
  for (const std::string& element : elements)
    for (const char* const name : {".friction", ".normal", ".mode"}) channels.push_back(element + name);
  return channels;
}

std::vector<FrictionTrace> friction_traces(const Model& whole, const System& system, const RunResult& result,
                                           const std::vector<std::string>& elements, double begin, double step) {
  std::vector<FrictionTrace> traces;
  const Trajectory& rows = *result.trajectory;
  for (const std::string& element : elements) {
    FrictionTrace trace;
    trace.step = step;
    trace.lifts = has_opened(whole, result, element);
    if (const CoulombFriction* const friction = friction_of(system, element))
      trace.mu_static = friction->mu_static, trace.mu_kinetic = friction->mu_kinetic;
    const std::size_t force = rows.column(element + ".friction"), normal = rows.column(element + ".normal"),
                      mode = rows.column(element + ".mode");
    // If a run did not begin at 0, its rows are at multiples of the step on its own time axis.
    constexpr double k_hair = 1e-6; // of a step
    for (std::size_t i = 0, k = 0; i < rows.size(); ++k) {
      const double t = begin + static_cast<double>(k) * step;
      while (i + 1 < rows.size() && rows.time(i + 1) <= t + k_hair * step) ++i;
      const bool is_last = i + 1 == rows.size();
      if (is_last && rows.time(i) < t - k_hair * step) break;
      const double share = is_last ? 0.0 : std::clamp((t - rows.time(i)) / (rows.time(i + 1) - rows.time(i)), 0.0, 1.0);
      const auto at = [&](std::size_t column) {
        const double value = rows.value(i, column);
        return share > 0.0 ? value + share * (rows.value(i + 1, column) - value) : value;
      };
      trace.force.push_back(at(force));
      trace.normal.push_back(std::max(0.0, at(normal)));
      trace.sticks.push_back(static_cast<FrictionPhase>(static_cast<int>(rows.value(i, mode))) == FrictionPhase::stick ? 1 : 0);
      if (is_last) break;
    }
    traces.push_back(std::move(trace));
  }
  return traces;
}

} // namespace steplap::assess
