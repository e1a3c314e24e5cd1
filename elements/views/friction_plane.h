// Friction that models of one machine in different planes have in common, and its utilisation by both planes together.
//
// Friction is one vector. Each model compares its component with the whole capacity mu N, although both components together use √(T_1² +
// T_2²). Elements are one friction if their names, or their `shared_friction`, are equal. Several elements of one model are summed. At each
// time
//
//   use = sqrt(T_1² + T_2²) / (mu N),  N = min over i of N_i - N_i(0) (1 - c / c_i),  c² = c_1² + c_2² - 1
//
// with T_i and N_i from model i; c_i is the cosine of the tilt of plane i (angle between gravity and the normal of its contacts), c the
// cosine of both tilts together. Every N_i contains the vertical load, which must count only once: therefore the minimum. N_i(0) is the
// normal force at rest, the only part that a constant tilt reduces.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/run_record.h"
#include "mbd/system/system.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Names of the elements with Coulomb friction on contacts, by the name of their friction.
using FrictionNames = std::map<std::string, std::vector<std::string>>;
[[nodiscard]] FrictionNames friction_names(const Model& model);

/// A friction in the plane of one model.
struct FrictionPlane {
  std::string model_name;        ///< name of the model, for messages
  Vec2 tangent = Vec2(1.0, 0.0); ///< unit tangent of the contacts, ground axes
  double gravity = 0.0;          ///< magnitude of gravity, m/s²
  double downhill = 0.0;         ///< component of gravity along the tangent, m/s²
  double tilt = 1.0;             ///< cosine of the angle between gravity and the normal of the contacts
};

/// Returns the plane of a friction; nothing if its elements have no contact with a fixed direction. `gravity`: gravity at rest, m/s².
/// Throws ModelError at `file` if the elements do not act along the same line.
[[nodiscard]] std::optional<FrictionPlane> friction_plane(const System& system, const std::string& friction,
                                                          const std::vector<std::string>& elements, const Vec2& gravity,
                                                          const std::string& file);

/// A friction during a run, sampled at equal steps.
struct SampledFriction {
  double step = 0.0;                 ///< sampling interval, s
  std::vector<double> force, normal; ///< friction and normal force, N, as in the channels of the element
  std::vector<char> sticks;          ///< true while it sticks; `force` is then the force required for sticking
  double mu_static = 0.0, mu_kinetic = 0.0;
  bool lifts = false; ///< one of the contacts opened
};

/// Returns the names of the channels needed for traces of these elements.
[[nodiscard]] std::vector<std::string> traced_channels(const std::vector<std::string>& elements);
/// Returns the samples of `elements` from a run in which traced_channels() were sampled every `step`, s, from `begin`, s. `whole`: the
/// completed model.
[[nodiscard]] std::vector<SampledFriction> friction_traces(const Model& whole, const System& system, const RunResult& result,
                                                           const std::vector<std::string>& elements, double begin, double step);
/// Returns the sum of frictions that act together; at least one.
[[nodiscard]] SampledFriction sum_of_traces(const std::vector<SampledFriction>& traces);

/// A friction that two models share, with its normal forces at rest.
struct SharedContact {
  std::string name;
  std::array<const FrictionPlane*, 2> planes{};
  std::array<double, 2> at_rest{}; ///< normal forces at rest in both models, N

  /// Returns the contradiction that shows that the models do not belong to one machine; empty if there is none.
  [[nodiscard]] std::string disagreement() const;
  /// Returns the normal force at sample `k`, N.
  [[nodiscard]] double normal(const std::array<SampledFriction, 2>& traces, std::size_t k) const;
};

/// Largest use of a shared friction during a run.
struct SharedUse {
  double use = 0.0;      ///< largest use, relative to mu N
  double capacity = 0.0; ///< mu N at that time, N
  double at = 0.0;       ///< time after the first sample, s
  double error = 0.0;    ///< largest change of the use to the samples next to it, which a peak between samples does not exceed
  bool slips = false;    ///< both planes together slip, and each contributes
};
[[nodiscard]] SharedUse shared_use(const SharedContact& contact, const std::array<SampledFriction, 2>& traces);

} // namespace steplap
