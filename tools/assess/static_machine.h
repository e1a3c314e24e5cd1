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

#include "mbd/rest/equilibrium.h"
#include "mbd/run/loaded_model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// Kinds of limits that a growing pull can reach.
enum class LimitKind {
  slips,  ///< friction of a joint in the plane is exceeded
  slides, ///< friction along a line or about a pin is exceeded; the body may come to rest elsewhere
  lifts,  ///< a contact that was pressed at rest opens
  ends    ///< no equilibrium exists near the previous one
};
/// Returns "slips", "slides", "lifts" or "ends".
[[nodiscard]] const char* name_of(LimitKind kind);

/// A limit that is monitored while the pull grows.
struct Watch {
  LimitKind kind = LimitKind::slips;
  std::string element;
};

/// Result of the search for an equilibrium under one pull: an equilibrium, or the reason why there is none.
struct Probe {
  std::optional<Equilibrium> rest;
  std::string failure;     ///< sentence why there is no equilibrium
  bool is_unknown = false; ///< true if the search failed without proving that no equilibrium exists
  /// reserve of each monitored limit: 1 − utilisation, or contact force relative to that at rest; positive below the limit; for linear
  /// statics a concave or linear function of the pull
  std::vector<double> left;
  std::vector<double> values; ///< values of all channels
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

  /// Returns the equilibrium under `pull`, m/s², which grows from zero. Starts from the equilibrium under gravity alone.
  [[nodiscard]] Probe ramped(const Vec2& pull);
  /// As ramped(), but starts from the equilibrium `before` under another pull.
  [[nodiscard]] Probe ramped_from(const Probe& before, const Vec2& pull);
  /// Returns the equilibrium without friction along lines and about pins, as after long vibration. Friction of joints in the plane holds.
  [[nodiscard]] Probe without_friction(const Vec2& pull);
  /// Returns the value of a channel; NaN if there is none of that name.
  [[nodiscard]] double value(const Probe& probe, const std::string& channel) const;

private:
  void find_watches();
  Probe probe(const State& start, const Vec2& pull);
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
