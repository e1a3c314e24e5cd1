// A machine on a vehicle that accelerates steadily, as statics sees it: at rest under apparent gravity g + p, p the pull.
//
// On a vehicle with constant acceleration a, in axes that move with it, every body of mass m is pulled by −m a beside its weight:
// Newton's second law for the rest in these axes is statics with gravity g − a. So the model's vector of gravity is changed and
// the drives of the vehicle are held. What springs, contacts and joints do depends on relative places alone and stays as it
// is. The vehicle's rotation and what it does before its acceleration is steady are not part of it.
//
// Step-lap joints that stick exactly are taken as monitors: they hold whatever they take and tell what share of their capacity that
// is, so that the margin of a joint that would slip is known, too.
#pragma once

#include "mbd/rest/equilibrium.h"
#include "run/loaded_model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// What a growing pull may do.
enum class LimitKind {
  slips,  ///< a joint that friction holds in the plane: it does not hold any more
  slides, ///< friction on a line or about a pin gives way; what it held may come to rest elsewhere
  lifts,  ///< a contact that pressed at rest opens
  ends    ///< no rest near the one before
};
/// "slips", "slides", "lifts" or "ends".
[[nodiscard]] const char* name_of(LimitKind kind);

/// Something that is looked at while a pull grows.
struct Watch {
  LimitKind kind = LimitKind::slips;
  std::string element;
};

/// A rest under a pull, or why there is none.
struct Probe {
  std::optional<Equilibrium> rest;
  std::string failure;        ///< where there is no rest: a sentence
  bool is_unknown = false;    ///< no rest was found, but that there is none is not said
  std::vector<double> left;   ///< of each watch: positive while it holds, zero at its limit; in linear statics convex or linear in the pull
  std::vector<double> values; ///< of System::channels
};

class StaticMachine {
public:
  /// Finds the rest under gravity alone. Throws NumericalFailure if there is none, saying why.
  explicit StaticMachine(const LoadedModel& loaded);

  [[nodiscard]] const System& system() const { return *system_; }
  [[nodiscard]] const Model& model() const { return model_; } ///< with joints as monitors
  [[nodiscard]] const Vec2& gravity() const { return gravity_; }
  [[nodiscard]] const Probe& at_rest() const { return at_rest_; }
  [[nodiscard]] const std::vector<Watch>& watches() const { return watches_; }
  /// Step-lap joints that have friction to lose.
  [[nodiscard]] const std::vector<std::string>& joints() const { return joints_; }

  /// The pull grows from zero on the machine at rest.
  [[nodiscard]] Probe ramped(const Vec2& pull);
  /// The same on the machine at rest under another pull.
  [[nodiscard]] Probe ramped_from(const Probe& before, const Vec2& pull);
  /// Friction on lines and about pins bears nothing, as after long vibration; joints that friction holds in the plane hold.
  [[nodiscard]] Probe worked_loose(const Vec2& pull);
  /// The value of a channel; not-a-number if there is none of that name.
  [[nodiscard]] double value(const Probe& probe, const std::string& channel) const;

private:
  void find_watches();
  Probe probe(const State& start, const Vec2& pull);
  [[nodiscard]] std::vector<double> left_of(const Probe& probe) const;

  Model model_;
  std::unique_ptr<System> system_;
  Vec2 gravity_;
  Probe at_rest_;
  std::vector<Watch> watches_;
  std::vector<int> channel_, friction_; ///< of each watch, or −1
  std::vector<double> rest_gap_;        ///< of each watch, m
  std::vector<std::string> joints_;
};

} // namespace steplap::assess
