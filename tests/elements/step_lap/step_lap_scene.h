// Scenes for tests of the step-lap joint, as text of a model file.
#pragma once

#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "transformer/catalog.h"

#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace step_lap_scene {

struct Run {
  std::unique_ptr<steplap::System> system;
  steplap::RunResult result;

  [[nodiscard]] std::vector<double> series(const std::string& channel) const { return result.trajectory->series(channel); }
  [[nodiscard]] double last(const std::string& channel) const { return series(channel).back(); }
  /// Times of the events of one element.
  [[nodiscard]] std::vector<double> times(const std::string& element, const std::string& what) const {
    std::vector<double> t;
    for (const steplap::Event& e : result.events)
      if (e.element == element && e.kind == steplap::event_kind_called(what).value()) t.push_back(e.t);
    return t;
  }
  [[nodiscard]] double relative_energy_residual() const { return result.statistics.energy_residual / result.statistics.energy_exchanged; }
};

inline Run run(const steplap::Model& model) {
  Run r;
  r.system = steplap::compile(model);
  r.result = steplap::simulate(*r.system, r.system->initial_state(), steplap::options_of(model));
  return r;
}

inline Run run_text(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return run(steplap::parse_model(text, "scene.toml", steplap::transformer_catalog(), overrides));
}

inline steplap::Model read(const std::string& path, const std::vector<std::string>& overrides = {}) {
  return steplap::read_model(std::string(STEPLAP_MODELS) + "/" + path, steplap::transformer_catalog(), overrides);
}

inline Run run_file(const std::string& path, const std::vector<std::string>& overrides = {}) { return run(read(path, overrides)); }

inline std::string number(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}

inline std::string points(const std::vector<steplap::Vec2>& ring) {
  std::string text = "[";
  for (const steplap::Vec2& p : ring) text += "[" + number(p.x()) + ", " + number(p.y()) + "], ";
  return text + "]";
}

inline std::vector<steplap::Vec2> rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

/// Regular, of the area π R².
inline std::vector<steplap::Vec2> disc(double radius, int sides) {
  const double step = 2.0 * M_PI / sides, r = radius * std::sqrt(step / std::sin(step));
  std::vector<steplap::Vec2> ring;
  for (int i = 0; i < sides; ++i) ring.push_back({r * std::cos(step * i), r * std::sin(step * i)});
  return ring;
}

inline std::string body(const std::string& name, double mass, double inertia, const steplap::Vec2& at,
                        const steplap::Vec2& velocity = steplap::Vec2::Zero(), double spin = 0.0) {
  return "[[body]]\nname = \"" + name + "\"\nmass = " + number(mass) + "\ninertia = " + number(inertia) + "\nposition = [" +
         number(at.x()) + ", " + number(at.y()) + "]\nvelocity = [" + number(velocity.x()) + ", " + number(velocity.y()) +
         "]\nangular_velocity = " + number(spin) + "\n";
}

inline std::string joint(const std::string& limb, const std::string& part, const std::string& more = "") {
  return "[[element]]\nkind = \"step_lap_joint\"\nname = \"joint\"\nlimb = \"" + limb + "\"\nactive_part = \"" + part + "\"\n" + more +
         "\n";
}

inline std::string interface(const std::vector<steplap::Vec2>& yoke, const std::vector<steplap::Vec2>& limb, double pressure,
                             double friction, const std::string& more = "", const std::string& name = "sheets") {
  return "[[element]]\nkind = \"step_lap_interface\"\nname = \"" + name + "\"\njoint = \"joint\"\nyoke = " + points(yoke) +
         "\nlimb = " + points(limb) + "\npressure = " + number(pressure) + "\nstatic_friction = " + number(friction) + "\n" + more + "\n";
}

inline std::string header(const std::string& simulation, double output_step, const char* gravity = "[0.0, 0.0]") {
  return "title = \"test\"\ngravity = " + std::string(gravity) + "\n[simulation]\n" + simulation +
         "\n[output]\nstep = " + number(output_step) + "\n";
}

} // namespace step_lap_scene
