#include "mbd/rest/modes.h"

#include "mbd/base/decompositions.h"
#include "mbd/rest/free_vibration.h"
#include "mbd/rest/sparse_modes.h"
#include "mbd/rest/statics.h"
#include "mbd/rest/tangent.h"
#include "mbd/system/own_states.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

namespace steplap {

namespace {

constexpr double k_two_pi = 2.0 * std::numbers::pi;

using Complex = std::complex<double>;
using ComplexVector = Eigen::VectorXcd;

// Rate of an inner state relative to the velocity of its element above which its force follows the motion. That of a tyre's tread at rest is
// its deflection over the relaxation length, a term of second order.
constexpr double k_felt = 1e-2;

bool is_large(const System& system) { return 3 * (system.body_count() - 1) > k_max_modal_coordinates; }

// Returns true if the force of the element follows its inner states.
bool is_felt(const InnerJacobian& part) {
  return (part.force * part.by_velocity).cwiseAbs().maxCoeff() > k_felt * part.force.cwiseAbs().maxCoeff();
}

// Returns true if the element has one inner state that relaxes by itself, as a spring and damper in series.
bool relaxes(const InnerJacobian& part) { return part.count == 1 && part.by_inner(0, 0) < 0.0 && is_felt(part); }

std::vector<InnerJacobian> inner_parts(const System& system, const Evaluation& evaluation) {
  std::vector<InnerJacobian> parts;
  for (const ForceGroup* group : system.inner_groups) group->add_inner_jacobian(evaluation, parts);
  return parts;
}

// Adds the inner states that relax.
void add_inner_states(const System& system, const Evaluation& evaluation, FreeVibration& v) {
  std::vector<InnerJacobian> parts = inner_parts(system, evaluation);
  std::erase_if(parts, [](const InnerJacobian& part) { return !relaxes(part); });
  const auto m = static_cast<Eigen::Index>(parts.size());
  if (m == 0) return;
  MatX force = MatX::Zero(v.basis.rows(), m), drive = MatX::Zero(m, v.basis.rows());
  v.inner_decay = VecX(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const InnerJacobian& part = parts[static_cast<std::size_t>(i)];
    v.inner_decay[i] = part.by_inner(0, 0);
    for (int end = 0; end < 2; ++end) {
      const int body = end == 0 ? part.a : part.b;
      if (body == k_ground) continue;
      force.col(i).segment<3>(3 * body - 3) += part.force.col(0).segment<3>(3 * end);
      drive.row(i).segment<3>(3 * body - 3) += part.by_velocity.row(0).segment<3>(3 * end);
    }
  }
  v.inner_force = v.basis.transpose() * force;
  v.inner_drive = drive * v.basis;
}

FreeVibration free_vibration(const System& system, State state) {
  Statics statics(system);
  statics.evaluate(state);
  statics.collect_rows(state);
  const VecX scale = scale_of(system, state).scale;
  const Tangent tangent = tangent_of(statics, scale);
  const VecX lambda = multipliers_of(statics, scale, tangent);
  const int n = statics.coordinates();
  VecX mass(n);
  for (int k = 0; k < n; ++k) {
    const BodyData& body = system.bodies[k / 3 + 1];
    mass[k] = (k % 3 < 2 ? body.mass : body.inertia) * scale[k] * scale[k];
  }
  FreeVibration v;
  v.basis = scale.asDiagonal() * tangent.free;
  if (v.basis.cols() == 0) return v;
  const MatX metric = tangent.free.transpose() * mass.asDiagonal() * tangent.free;
  v.basis = solve_lower(metric, v.basis.transpose()).transpose();
  const MatX stiffness = statics.stiffness(lambda);
  v.a = v.basis.transpose() * stiffness * v.basis;
  v.b = v.basis.transpose() * statics.damping() * v.basis;
  const MatX size = stiffness.cwiseAbs();
  add_inner_states(system, statics.evaluation(), v);
  v.separate_null_motions([&size](const MatX& shapes) { return MatX(size * shapes.cwiseAbs()); });
  return v;
}

// Returns the complex displacements (x, y, θ) of all bodies, ground included, from the coordinates q.
std::vector<Complex> shape_of(const System& system, const ComplexVector& q) {
  std::vector<Complex> shape(3 * system.bodies.size(), 0.0);
  Complex largest = 0.0;
  for (int i = 1; i < system.body_count(); ++i) {
    for (int c = 0; c < 3; ++c) shape[3 * i + c] = q[3 * i - 3 + c];
    const double gyration = std::sqrt(system.bodies[i].inertia / system.bodies[i].mass);
    for (const auto& part : {shape[3 * i], shape[3 * i + 1], gyration * shape[3 * i + 2]})
      if (size_of(part) > size_of(largest)) largest = part;
  }
  if (largest != 0.0)
    for (auto& part : shape) part /= largest;
  return shape;
}

} // namespace

double VibrationMode::frequency() const { return std::abs(eigenvalue.imag()) / k_two_pi; }
double VibrationMode::natural_frequency() const { return size_of(eigenvalue) / k_two_pi; }
double WantedModes::distance(const std::complex<double>& eigenvalue) const {
  return near ? size_of(eigenvalue - Complex(0.0, k_two_pi * *near)) : size_of(eigenvalue);
}
double VibrationMode::damping_ratio() const { return -eigenvalue.real() / size_of(eigenvalue); }

namespace {

// Returns VibrationMode::residual of a mode.
double residual_of(const FreeVibration& v, const FreeMode& mode) {
  const Complex square = mode.eigenvalue * mode.eigenvalue;
  ComplexVector left = square * mode.x - mode.eigenvalue * (v.b * mode.x) - v.a * mode.x;
  if (v.inner_decay.size() > 0) left -= mode.eigenvalue * (v.relaxation(mode.eigenvalue) * mode.x);
  const double size = size_of(mode.eigenvalue);
  return left.norm() / (size * size * mode.x.norm());
}

// Keeps the `count` modes nearest to the wanted ones, by ascending natural frequency.
void keep_wanted(const WantedModes& wanted, VibrationModes& found) {
  const auto count = static_cast<std::size_t>(wanted.count);
  if (wanted.count > 0 && count < found.modes.size()) {
    std::stable_sort(found.modes.begin(), found.modes.end(), [&](const VibrationMode& one, const VibrationMode& other) {
      return wanted.distance(one.eigenvalue) < wanted.distance(other.eigenvalue);
    });
    found.modes.erase(found.modes.begin() + static_cast<std::ptrdiff_t>(count), found.modes.end());
    found.is_all = false;
  }
  std::stable_sort(found.modes.begin(), found.modes.end(), [](const VibrationMode& one, const VibrationMode& other) {
    return one.natural_frequency() < other.natural_frequency();
  });
}

VibrationModes all_modes(const System& system, const State& state) {
  const FreeVibration v = free_vibration(system, state);
  VibrationModes found;
  found.rigid_motions = static_cast<int>(v.loose.cols());
  for (const FreeMode& mode : modes_of(v))
    found.modes.push_back({mode.eigenvalue, shape_of(system, v.basis * mode.x), residual_of(v, mode)});
  return found;
}

VibrationModes some_modes(const System& system, const State& state, const WantedModes& wanted) {
  const SparseModes sparse = sparse_modes(system, state, wanted);
  VibrationModes found;
  found.rigid_motions = sparse.rigid_motions;
  found.is_all = sparse.is_all;
  found.is_counted = sparse.is_counted;
  for (const SparseModes::Mode& mode : sparse.modes) found.modes.push_back({mode.eigenvalue, shape_of(system, mode.q), mode.residual});
  return found;
}

} // namespace

namespace {

// Distance from the end of a piece of a law, in sizes of the model or in these per second, below which the rest is at that end.
constexpr double k_at_kink = 1e-9;
// Relative difference of stiffnesses and dampings below which two pieces of a law continue each other.
constexpr double k_same_slope = 1e-9;

// Returns "'a', 'b' and 3 more".
std::string list_of(const System& system, const std::vector<int>& elements) {
  constexpr std::size_t k_named = 5;
  std::string text;
  const std::size_t named = std::min(k_named, elements.size());
  for (std::size_t i = 0; i < named; ++i) text += (i > 0 ? ", '" : "'") + system.element_names[elements[i]] + "'";
  return elements.size() > named ? text + " and " + std::to_string(elements.size() - named) + " more" : text;
}

// Returns the elements whose force changes with an inner state that changes with the motion and that the modes hold.
std::vector<int> held_inner_states(const System& system, const Evaluation& evaluation) {
  std::vector<int> elements;
  for (const InnerJacobian& part : inner_parts(system, evaluation)) {
    if (!is_felt(part) || (!is_large(system) && relaxes(part))) continue;
    const int element = system.inner_elements[part.first];
    if (elements.empty() || elements.back() != element) elements.push_back(element);
  }
  const OwnStateGroup* const states = own_state_group(system);
  if (!states) return elements;
  StateJacobian own;
  for (const auto& group : system.groups) group->add_state_jacobian(evaluation, own);
  for (const StateJacobian::Force& force : own.forces) {
    const auto is_moved = [&force](const StateJacobian::ByMotion& m) {
      return m.inner == force.inner && !(m.pose.isZero(0.0) && m.velocity.isZero(0.0));
    };
    const auto state = std::find_if(states->entries.begin(), states->entries.end(),
                                    [&force](const OwnStateGroup::ElementData& entry) { return entry.place.inner == force.inner; });
    if (state == states->entries.end()) continue;
    const int element = state->element;
    if (std::find(elements.begin(), elements.end(), element) == elements.end() &&
        std::any_of(own.by_motion.begin(), own.by_motion.end(), is_moved))
      elements.push_back(element);
  }
  return elements;
}

// Returns true if the stiffness or damping of the group in the modes of `one` differs from that in those of `other`.
bool has_other_slopes(const ForceGroup& group, const Evaluation& one, const Evaluation& other) {
  std::vector<PairJacobian> here, there;
  group.add_jacobian(one, here);
  group.add_jacobian(other, there);
  if (here.size() != there.size()) return true;
  const auto differ = [](const auto& a, const auto& b) {
    return (a - b).cwiseAbs().maxCoeff() > k_same_slope * std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  };
  for (std::size_t i = 0; i < here.size(); ++i)
    if (differ(here[i].stiffness, there[i].stiffness) || differ(here[i].damping, there[i].damping)) return true;
  return false;
}

// Returns the elements whose law has a kink at the rest: an end of its present piece lies there, and the next piece has another slope.
std::vector<int> at_kinks(const System& system, const State& state, const Evaluation& evaluation) {
  std::vector<int> elements;
  const double near = k_at_kink * scale_of(system, state).length;
  std::vector<UnitMode> modes = state.mode;
  Evaluation beyond = evaluation;
  beyond.mode = modes.data();
  for (std::size_t u = 0; u < system.units.size(); ++u) {
    const Unit& unit = system.units[u];
    for (int slot = 0; slot < unit.event_count; ++slot) {
      if (unit.group->event_tolerance(slot) == EventTolerance::none) continue;
      if (!(std::abs(evaluation.event_value[unit.first_event + slot]) <= near)) continue;
      const UnitMode next = unit.group->next_mode(unit.index, state.mode[u], slot, evaluation);
      if (next == state.mode[u]) continue;
      modes[u] = next;
      const bool is_kink = has_other_slopes(*unit.group, evaluation, beyond);
      modes[u] = state.mode[u];
      if (!is_kink) continue;
      elements.push_back(unit.element);
      break;
    }
  }
  return elements;
}

} // namespace

std::vector<std::string> remarks_on_modes(const System& system, const State& state) {
  State still = state;
  Statics statics(system);
  statics.evaluate(still);
  std::vector<std::string> remarks;
  if (const std::vector<int> elements = held_inner_states(system, statics.evaluation()); !elements.empty())
    remarks.push_back("the modes hold the inner state of " + list_of(system, elements) +
                      ", which changes with the motion: what that adds to stiffness and damping is left out");
  if (const std::vector<int> elements = at_kinks(system, still, statics.evaluation()); !elements.empty())
    remarks.push_back("the rest is at a kink of " + list_of(system, elements) +
                      ": the modes have the stiffness and damping of one side of it, and a vibration crosses both");
  return remarks;
}

VibrationModes vibration_modes(const System& system, const State& state, WantedModes wanted, ModesAlgebra algebra) {
  VibrationModes found;
  if (system.body_count() <= 1) return found;
  if ((is_large(system) || algebra == ModesAlgebra::sparse || wanted.near) && wanted.count <= 0) wanted.count = k_usual_modes;
  const OneThread alone;
  const bool is_sparse = algebra == ModesAlgebra::sparse || (algebra == ModesAlgebra::by_size && is_large(system));
  found = is_sparse ? some_modes(system, state, wanted) : all_modes(system, state);
  keep_wanted(wanted, found);
  return found;
}

} // namespace steplap
