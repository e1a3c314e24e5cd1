// What all mechanisms of a random scene are written with: names, signals, magnitudes that suit the run.
#pragma once

#include "tests/random/random_number.h"
#include "tests/random/scene.h"

#include <initializer_list>
#include <utility>

namespace steplap::random {

struct At {
  double x = 0.0, y = 0.0;
};

class SceneWriter {
public:
  explicit SceneWriter(std::uint64_t seed);

  RandomNumber r;
  Scene scene;
  double duration = 1.0, gravity = 9.81, size = 1.0, mass = 1.0; ///< scales of the scene; s, m/s², m, kg

  using Fields = std::vector<std::pair<std::string, std::string>>;
  std::string body(double body_mass, double inertia, At at, const Fields& more = {});
  /// `uses`: bodies, elements, signals it names.
  std::string element(const std::string& kind, const Fields& fields, const std::vector<std::string>& uses);
  std::string action(const Fields& fields, const std::vector<std::string>& uses);
  /// Of any kind; zero at the start and without jumps if `is_smooth`.
  std::string signal(double peak, bool is_smooth = false);

  /// 2π times so many periods in the run.
  [[nodiscard]] double rate(double least_periods, double most_periods);
  [[nodiscard]] double stiffness_for(double m, double least_periods, double most_periods);
  /// Of a spring with mass m: a share of critical damping, often none.
  [[nodiscard]] double damping_for(double m, double k);
  /// Inertia of a thing of mass m and length `length`.
  [[nodiscard]] double inertia_of(double m, double length);
  [[nodiscard]] double some_mass() { return mass * r.decades(-0.7, 0.7); }

private:
  std::string new_name(const std::string& stem);
  std::string record(double peak);
  std::string composed(const std::string& part, double peak);
  int count_ = 0;
};

/// "{ body = 'b1', at = [1.0, 2.0] }"; also of the ground.
[[nodiscard]] std::string marker(const std::string& body, At at);
[[nodiscard]] std::string quoted(const std::string& text);

/// A mechanism at `place`; returns the bodies that others may be coupled to.
using Cell = std::vector<std::string> (*)(SceneWriter& w, At place);
struct NamedCell {
  const char* name;
  Cell make;
};
[[nodiscard]] const std::vector<NamedCell>& rotating_cells();
[[nodiscard]] const std::vector<NamedCell>& sliding_cells();
[[nodiscard]] const std::vector<NamedCell>& touching_cells();

} // namespace steplap::random
