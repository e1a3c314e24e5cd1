// Scenes for tests: a model from TOML text, run to its end with the settings that a test chooses.
#pragma once

#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "transformer/catalog.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace steplap::testing {

/// A system and what a run of it gave; the trajectory's channels live in the system.
struct Run {
  std::unique_ptr<System> system;
  RunResult result;

  [[nodiscard]] const std::vector<double>& times() const { return result.trajectory->times(); }
  [[nodiscard]] std::vector<double> series(const std::string& channel) const { return result.trajectory->series(channel); }
  /// Value of a channel in the last sample.
  [[nodiscard]] double last(const std::string& channel) const {
    return result.trajectory->value(result.trajectory->size() - 1, result.trajectory->column(channel));
  }
  /// Times of the events of one element, all or those with one description.
  [[nodiscard]] std::vector<double> event_times(const std::string& element, const std::string& what = "") const {
    std::vector<double> times;
    for (const Event& event : result.events)
      if (event.element == element && (what.empty() || event.kind == event_kind_called(what).value())) times.push_back(event.t);
    return times;
  }
};

/// What most tests choose: an integrator, its step or tolerance, the end, samples.
struct Settings {
  std::string integrator = "dop853";
  double step_or_tolerance = 1e-12;
  double end = 1.0;
  double output_step = 0.0; ///< 0: start and end only
};

inline Model scene(const std::string& text) { return parse_model(text, "scene.toml", transformer_catalog()); }

inline SimulationOptions options(const Settings& settings) {
  SimulationOptions o;
  o.end = settings.end;
  o.integrator = settings.integrator;
  if (settings.integrator == "rk4") o.settings.step = settings.step_or_tolerance;
  else o.settings.tolerance = settings.step_or_tolerance;
  o.output_step = settings.output_step > 0.0 ? settings.output_step : settings.end;
  return o;
}

inline Run run(const Model& model, const Settings& settings) {
  Run r;
  r.system = compile(model);
  r.result = simulate(*r.system, r.system->initial_state(), options(settings));
  return r;
}

/// `text` needs no [simulation]: one that validates is added.
inline Run run(const std::string& text, const Settings& settings) { return run(scene(text + "\n[simulation]\nstep = 1e-3\n"), settings); }

} // namespace steplap::testing
