// Initial state of a run for its checks: contacts, forces, and the findings so far. Kinds add checks of their own fields (ElementView).
#pragma once

#include "mbd/run/finding.h"
#include "mbd/run/start_balance.h"
#include "mbd/run/start_contacts.h"

#include <string>
#include <vector>

namespace steplap {

/// Returns a value with three digits, enough to recognise it.
[[nodiscard]] std::string three_digits(double value);
/// Returns a length with three digits and its unit.
[[nodiscard]] std::string short_length(double metres);
/// Returns a force, or with the unit "N m" a couple, with three digits and its unit.
[[nodiscard]] std::string short_force(double value, const char* unit = "N");
/// Returns an angle in degrees with three digits.
[[nodiscard]] std::string short_degrees(double radians);

/// Data of the checks at the start of a run. Keeps a reference to the model.
struct StartScene {
  /// Computes the state of the model before a search for equilibrium, its contacts and its forces.
  explicit StartScene(const LoadedModel& loaded_);

  static constexpr double k_typed = 1e-6; ///< rounding of typed poses, relative to the bodies' size
  static constexpr double k_off = 1e-3;   ///< deviations above this, relative to the bodies' size, are not rounding

  const LoadedModel& loaded;            ///< the model
  const System& system;                 ///< its system
  State start;                          ///< state of the checks
  StartBalance balance;                 ///< forces and accelerations in `start`
  std::vector<ContactAtStart> contacts; ///< all contacts in `start` with all velocities zero
  std::vector<Finding> found;           ///< findings so far

  /// Adds a warning.
  void add(const char* code, const Location& where, std::string text);
};

} // namespace steplap
