// What no run may do, looked at in every sample: friction that pushes, friction beyond its bound, contacts that
// pull. Added to a system as channels of its own, so that every method is looked at in the same way, from outside.
//
//   pushes     W: power of a sliding friction element's wrench, which must not be positive; of a sticking one the
//              power that its bound would take at the rate it moves with, which must be zero; both less what its bound
//              takes at rates that are known no better than zero
//   overload   share of its bound that the wrench takes, less 1; an unloaded element must bear nothing
//   pull       N: the largest tension in any contact of the scene
//   shares     1 where several frictions act on the same two bodies along one line (feet on a floor) and some of them
//              hold, or slide against each other: then the laws of friction say what they bear together, and not who
//              bears what of it
//   unknown    m, m/s, N: to what places, velocities and forces of the whole scene are known (known_to.h), and what the wrench of a joint's
//              slip that has just begun turns by with that. It bounds nothing, but no method knows them better
//
// With these goes a channel of what such frictions bear together, "shared: one + other", a force like others.
#pragma once

#include "mbd/simulation/simulation.h"

#include <string>
#include <vector>

namespace steplap {

/// Adds the channels, "audit: <element>.pushes" and so on. Once per system, before it is run. Where a contact of the
/// model has the paper's literal law, which may pull, contacts are not looked at.
void add_audit_channels(System& system, const Model& model);
[[nodiscard]] bool is_audit_channel(const Channel& channel);
/// Name of a friction element's channel of power.
[[nodiscard]] std::string pushes_channel(const std::string& element);
/// Of the channel that tells whether it shares what it bears.
[[nodiscard]] std::string shares_channel(const std::string& element);
/// Columns of what forces, velocities and places are known to.
struct UnknownColumns {
  std::size_t force = 0, rate = 0, place = 0;
};
[[nodiscard]] UnknownColumns unknown_columns(const Trajectory& trajectory);

struct AuditFinding {
  std::string what;  ///< "friction does positive work"
  std::string where; ///< element
  double t = 0.0;    ///< s
  double value = 0.0, bound = 0.0;
  [[nodiscard]] double ratio() const { return value / bound; }
};

/// The worst of each sort, with the bound that `share` of the run's own powers and forces allows; `value` is
/// beyond `bound` if it is a breach, the least of `persistent` samples in a row. Needs the audit channels in the
/// trajectory.
[[nodiscard]] std::vector<AuditFinding> audit(const System& system, const RunResult& run, double share, int persistent);

/// Kinetic energy and energies exchanged: what a residual of energy is measured by, J. Where nothing moves a
/// millionth of what the largest force does over the bodies' size.
[[nodiscard]] double energy_scale(const System& system, const RunResult& run);

/// The most that all friction together takes at a time, W.
[[nodiscard]] double audited_power(const RunResult& run);

/// Bodies that only act on each other, and gravity on them: their momentum changes by gravity alone, and so does
/// their angular momentum. Indices of bodies of the compiled system.
[[nodiscard]] std::vector<std::vector<int>> free_groups(const Model& model, const System& system);

/// The worst change of momentum or angular momentum of a free group, of the scale of its own motion.
[[nodiscard]] AuditFinding momentum_change(const System& system, const std::vector<std::vector<int>>& groups, const RunResult& run);

} // namespace steplap
