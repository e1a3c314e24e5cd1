// The models of models/machines, as a user runs them.
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/run/run.h"
#include "transformer/program.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace steplap::testing {

inline std::shared_ptr<const LoadedModel> machine(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return load_model(STEPLAP_MODELS "/machines/" + name + ".toml", overrides);
}

/// A run to its end, with the series of its channels.
struct MachineRun {
  std::shared_ptr<const LoadedModel> loaded;
  Run run;

  explicit MachineRun(const std::string& name, const std::vector<std::string>& overrides = {})
      : loaded(machine(name, overrides)), run(run_model(loaded)) {}
  [[nodiscard]] bool is_complete() const { return !run.failure && run.result.stop_reason.empty(); }
  [[nodiscard]] const std::vector<double>& times() const { return run.result.trajectory->times(); }
  [[nodiscard]] std::vector<double> series(const std::string& channel) const { return run.result.trajectory->series(channel); }
  /// At the sample nearest to t.
  [[nodiscard]] double at(const std::string& channel, double t) const {
    const std::vector<double>& all = times();
    const auto after = std::lower_bound(all.begin(), all.end(), t - 1e-9);
    const auto i = static_cast<std::size_t>(std::min<std::ptrdiff_t>(after - all.begin(), static_cast<std::ptrdiff_t>(all.size()) - 1));
    return run.result.trajectory->value(i, run.result.trajectory->column(channel));
  }
  [[nodiscard]] double last(const std::string& channel) const { return at(channel, times().back()); }
  /// Times of events of one element.
  [[nodiscard]] std::vector<double> events(const std::string& element, EventKind kind) const {
    std::vector<double> found;
    for (const Event& event : run.result.events)
      if (event.element == element && event.kind == kind) found.push_back(event.t);
    return found;
  }
};

/// Channel of a system at rest.
inline double at_rest(const LoadedModel& loaded, const Equilibrium& rest, const std::string& channel) {
  const System& system = *loaded.system;
  Dynamics dynamics(system);
  dynamics.set_state(rest.state);
  std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y.size());
  dynamics.pack(rest.state, y.data());
  dynamics.rates(0.0, y.data(), dy.data());
  return system.find_channel(channel)->value(dynamics.snapshot(dy.data()));
}

} // namespace steplap::testing
