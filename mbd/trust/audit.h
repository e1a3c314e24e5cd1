// Checks at every sample that a run obeys the laws of friction and contact. The checks are channels of the system, computed from the state
// alone, so they treat all integrators alike.
//
//   pushes     power of a friction element, W. Sliding: power of its wrench, which must not be positive. Sticking: support of its set of
//              admissible wrenches at the actual relative velocity, which must be zero. Both are reduced by the power that rounding of
//              the velocities explains
//   overload   utilisation of the friction bound, less 1; an unloaded element must carry no force
//   pull       largest tensile force in any contact of the system, N
//   shares     1 where several friction elements act between the same two bodies along one line (feet on a floor) and some of them
//              stick, or slide in opposite directions. The laws of friction then determine only the sum of their forces
//   unknown    rounding errors of positions, velocities and forces of the whole system (known_to.h), m, m/s, N, including the change of a
//              joint's friction wrench at the onset of slip that they cause. No method can be more accurate than this
//
// The sum of such undetermined friction forces is an additional channel, "shared: one + other".
#pragma once

#include "mbd/simulation/simulation.h"

#include <string>
#include <vector>

namespace steplap {

/// Adds the channels "audit: <element>.pushes" and so on. Must be called once for a system, before the run. Contacts are not checked if one
/// of them has the paper's literal law, which permits tension.
void add_audit_channels(System& system, const Model& model);
[[nodiscard]] bool is_audit_channel(const Channel& channel);
/// Returns the name of a friction element's `pushes` channel.
[[nodiscard]] std::string pushes_channel(const std::string& element);
/// Returns the name of a friction element's `shares` channel.
[[nodiscard]] std::string shares_channel(const std::string& element);
/// Columns of the three `unknown` channels in a trajectory.
struct UnknownColumns {
  std::size_t force = 0, rate = 0, place = 0;
};
[[nodiscard]] UnknownColumns unknown_columns(const Trajectory& trajectory);

struct AuditFinding {
  std::string what;  ///< violated law, such as "friction does positive work"
  std::string where; ///< element
  double t = 0.0;    ///< s
  double value = 0.0, bound = 0.0;
  [[nodiscard]] double ratio() const { return value / bound; }
};

/// Returns the worst violation of each law in a run. The bound for a violation is `share` times the largest power or force of the run; a
/// `value` above `bound` is a violation. `value` is the least of `persistent` consecutive samples, so that single samples do not count.
/// Precondition: the trajectory contains the audit channels.
[[nodiscard]] std::vector<AuditFinding> audit(const System& system, const RunResult& run, double share, int persistent);

/// Returns the scale for energy residuals, J: kinetic energy plus exchanged energies. If nothing moves, it is a millionth of the work of
/// the largest force over the size of the bodies.
[[nodiscard]] double energy_scale(const System& system, const RunResult& run);

/// Returns the largest power, over all samples, that all friction elements together dissipate, W.
[[nodiscard]] double audited_power(const RunResult& run);

/// Returns groups of bodies on which gravity is the only external force, by body index in the compiled system. Only gravity may change the
/// momentum of such a group, and nothing its angular momentum about the centre of gravity.
[[nodiscard]] std::vector<std::vector<int>> free_groups(const Model& model, const System& system);

/// Returns the largest violation of the balance of momentum or angular momentum of the groups, relative to the group's own motion.
[[nodiscard]] AuditFinding momentum_change(const System& system, const std::vector<std::vector<int>>& groups, const RunResult& run);

} // namespace steplap
