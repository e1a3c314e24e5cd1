#include "mbd/rest/modes.h"

#include "mbd/base/decompositions.h"
#include "mbd/rest/free_vibration.h"
#include "mbd/rest/sparse_modes.h"
#include "mbd/rest/tangent.h"

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
  const ComplexVector left = square * mode.x - mode.eigenvalue * (v.b * mode.x) - v.a * mode.x;
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

VibrationModes vibration_modes(const System& system, const State& state, WantedModes wanted, ModesAlgebra algebra) {
  VibrationModes found;
  if (system.body_count() <= 1) return found;
  const bool is_large = 3 * (system.body_count() - 1) > k_max_modal_coordinates;
  if ((is_large || algebra == ModesAlgebra::sparse || wanted.near) && wanted.count <= 0) wanted.count = k_usual_modes;
  const OneThread alone;
  const bool is_sparse = algebra == ModesAlgebra::sparse || (algebra == ModesAlgebra::by_size && is_large);
  found = is_sparse ? some_modes(system, state, wanted) : all_modes(system, state);
  keep_wanted(wanted, found);
  return found;
}

} // namespace steplap
