// Statics of a machine on a vehicle with constant acceleration: equilibrium under apparent gravity g + p, where p is called the pull.
//
// In axes that move with a vehicle of constant acceleration a, every body of mass m has the additional force −m a. Equilibrium in these
// axes is statics with gravity g − a, so p = −a. The model's gravity vector is changed and the drives of the vehicle are held. Springs,
// contacts and joints depend on relative positions only and are unchanged. Rotation of the vehicle and transients before the acceleration
// is constant are not considered.
//
// Step-lap joints with exact sticking are replaced by monitors: they hold any load and report their utilisation. The margin is then known
// even for a joint that would slip.
#pragma once

#include "mbd/rest/ramped_rest.h"
#include "mbd/run/loaded_model.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// Kinds of limits that a growing pull can reach.
enum class LimitKind {
  slips,  ///< friction of a joint in the plane is exceeded
  slides, ///< friction along a line or about a pin is exceeded; the body may come to rest elsewhere
  lifts,  ///< a contact that was pressed at rest opens
  breaks, ///< the force of an element reaches its strength; the proof goes on as if it held
  ends    ///< no equilibrium exists near the previous one
};
/// Returns "slips", "slides", "lifts", "breaks" or "ends".
[[nodiscard]] const char* name_of(LimitKind kind);

/// A limit that is monitored while the pull grows.
struct Watch {
  LimitKind kind = LimitKind::slips;
  std::string element;
};

/// A jump of a machine under a growing pull: friction slides past its next rest (mbd/rest/ramped_rest.h).
struct Jump {
  std::string element;       ///< that slides
  double acceleration = 0.0; ///< of the pull, m/s²
};

/// Result of the search for an equilibrium under one pull: an equilibrium, or the reason why there is none.
struct Probe {
  std::optional<RampedRest> rest;
  std::string failure;            ///< sentence why there is no equilibrium
  std::shared_ptr<Probe> reached; ///< the last equilibrium on the path, if there is none under the whole pull
  bool is_unknown = false;        ///< true if the search failed without proving that no equilibrium exists
  std::vector<double> left;   ///< least reserve of each watch on the path: positive below its limit, zero at it; for linear statics convex
                              ///< or linear in the pull
  Vec2 pull = Vec2::Zero();   ///< pull at this equilibrium, m/s²
  std::vector<double> values; ///< of System::channels
  std::vector<double> low, high; ///< extremes of `values` on the path; NaN once a value was NaN

  std::optional<Jump> jump; ///< the first one on the path
  std::string action;       ///< an [[action]] whose condition is met on the path; "" if there is none
  bool is_still = true;     ///< nothing has slid since the equilibrium without pull
  double doubt =
      0.0; ///< largest relative difference of the final forces from those of a path in other increments; infinite if that one comes to no rest

  /// Adds the values of the next equilibrium on the path.
  void append_equilibrium(std::vector<double> next);
};

/// A model prepared for statics under different pulls.
class StaticMachine {
public:
  /// Finds the equilibrium under gravity alone. Throws NumericalFailure with the reason if there is none.
  explicit StaticMachine(const LoadedModel& loaded);

  [[nodiscard]] const System& system() const { return *system_; }
  [[nodiscard]] const Model& model() const { return model_; } ///< the model with monitored joints
  [[nodiscard]] const Vec2& gravity() const { return gravity_; }
  [[nodiscard]] const Probe& at_rest() const { return at_rest_; }
  [[nodiscard]] const std::vector<Watch>& watches() const { return watches_; }
  /// Returns the step-lap joints with finite friction capacity.
  [[nodiscard]] const std::vector<std::string>& joints() const { return joints_; }

  // Each pull is followed from the equilibrium before it (mbd/rest/ramped_rest.h), whole paths twice: two different divisions of the path into
  // increments must come to the same forces (Probe::doubt).
  /// Increases the pull from zero, starting from the equilibrium under gravity alone.
  [[nodiscard]] Probe ramped(const Vec2& pull);
  /// Increases the pull from the equilibrium `before`, which belongs to another pull. While friction sticks the rest does not depend on the
  /// path, and is found at once.
  [[nodiscard]] Probe ramped_from(const Probe& before, const Vec2& pull);
  /// Takes the pull of `before` back to zero, then increases `pull` from there; extremes are those of the second part.
  [[nodiscard]] Probe loaded_again(const Probe& before, const Vec2& pull);
  /// Returns the equilibrium without friction along lines and about pins, as after long vibration. Friction of joints in the plane holds. The
  /// extremes are the values at the end.
  [[nodiscard]] Probe without_friction(const Vec2& pull);
  /// Returns the value of a channel, or its extreme on the path; NaN if there is none of that name.
  [[nodiscard]] double value(const Probe& probe, const std::string& channel) const { return value_in(probe.values, channel); }
  [[nodiscard]] double least(const Probe& probe, const std::string& channel) const { return value_in(probe.low, channel); }
  [[nodiscard]] double largest(const Probe& probe, const std::string& channel) const { return value_in(probe.high, channel); }

private:
  void find_watches();
  Probe probe(const RampedRest& start, const Vec2& before, const Vec2& pull, double first_increment = 1.0);
  /// `path` is called with the length of its first increment, as a share of the pull.
  [[nodiscard]] Probe in_two_divisions(const std::function<Probe(double first_increment)>& path) const;
  [[nodiscard]] Probe still(const Vec2& pull);
  [[nodiscard]] bool has_reserve(const Probe& probe) const;
  /// Returns the reactions among the values of channels, in a group for each unit.
  [[nodiscard]] std::vector<ForcesOfUnit> forces_in(const std::vector<double>& values) const;
  [[nodiscard]] double value_in(const std::vector<double>& values, const std::string& channel) const;
  [[nodiscard]] std::vector<double> reserves_of(const Probe& probe) const;

  Model model_;
  std::unique_ptr<System> system_;
  Vec2 gravity_;
  Probe at_rest_;
  std::vector<Watch> watches_;
  std::vector<int> channel_, friction_; ///< index of channel and friction of each watch; −1: none
  std::vector<double> rest_gap_;        ///< penetration of each watched contact at rest, m
  std::vector<std::string> joints_;
};

} // namespace steplap::assess
