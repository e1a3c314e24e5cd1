// Published measurements beside what steplap computes of them: data in tests/data/experiments, models in models/experiments, told
// in docs/evidence/experiments.md.
#pragma once

#include <string>
#include <vector>

namespace steplap::testing {

/// One measured quantity and what the model says of it.
struct Compared {
  std::string experiment; ///< name of the data file
  std::string what;       ///< which quantity, in words
  double setting = 0.0;   ///< height, mass, amplitude or aspect ratio: what was changed from case to case
  int number = 0;         ///< of the bounce or set; 0 where there is none
  int count = 0;          ///< measurements behind `measured`
  double measured = 0.0;  ///< their mean
  double scatter = 0.0;   ///< their standard deviation; without repetition half of the last digit written
  double predicted = 0.0;
  bool is_fitted = false; ///< the measurement was used to find a value of the model

  [[nodiscard]] double miss() const { return predicted - measured; }
};

/// Intervals between the bounces of a ball, s; damping from the throws from `fitted_height`.
[[nodiscard]] std::vector<Compared> bounces(const std::string& ball, double fitted_height);
/// Times of a trolley with free and with turning flywheels, s; slope from the free ones.
[[nodiscard]] std::vector<Compared> flywheel_trolley();
/// Times of two balls on a steep rail, s: the rubber one predicted, friction of the metal one fitted.
[[nodiscard]] std::vector<Compared> balls_on_rail();
/// Times of three cylinders that slide on it, s: friction from the first twenty runs of each, the last twenty predicted.
[[nodiscard]] std::vector<Compared> cylinders_on_rail();
/// Energies of cycles of a friction damper with slack, J; friction and slack of each set (`number`) from two amplitudes at 0.25 Hz.
[[nodiscard]] std::vector<Compared> friction_damper();
/// Times of a trolley on an air track, s. `is_ideal`: from masses and way alone; else with the fitted offset and drag.
[[nodiscard]] std::vector<Compared> air_track(bool is_ideal);
/// Changes of speed of two cars, m/s, with a coefficient of restitution.
[[nodiscard]] std::vector<Compared> car_to_car(double restitution);

/// Time that a brick takes from a tilt of 35 degrees to the ground, s.
[[nodiscard]] std::vector<Compared> toppling_brick();

/// A block that rocks on two corners.
struct RockingBlock {
  double width = 0.2, height = 1.0; ///< m
  double density = 2400.0;          ///< kg/m^3, of a block as deep as wide
  double stiffness = 1e7;           ///< of a corner, N/m
  double damping_ratio = 1.0;       ///< damping over 2 sqrt(stiffness mass)
  double tilt = 0.5;                ///< at which it is let go, as a share of the angle at which it falls over
};
/// Housner's ratio of the angular velocities after and before an impact: 1 - 3/2 sin^2 a.
[[nodiscard]] double housner_ratio(const RockingBlock& block);
/// The same of each of the first impacts by a run, from the energies of the swings before and after it: sqrt(E_after/E_before).
[[nodiscard]] std::vector<double> rocking_ratios(const RockingBlock& block, std::size_t impacts);
/// Measured shares of Housner's ratio; stiffness of the base found from the slender block. `tilt`: not in the source.
[[nodiscard]] std::vector<Compared> rocking_blocks(double tilt);

} // namespace steplap::testing
