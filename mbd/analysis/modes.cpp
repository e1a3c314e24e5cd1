#include "mbd/analysis/modes.h"

#include "mbd/dynamics/linearization.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_two_pi = 2.0 * std::numbers::pi;
// Constraint rows below this against the largest count as dependent.
constexpr double k_rank_tolerance = 1e-10;
// Eigenvalues below this against the largest belong to rigid motions: double ones split by rounding as its
// square root, 1e-8.
constexpr double k_rigid_tolerance = 3e-8;

// Orthonormal basis of the motions that rows and locks leave free: n × r. Coordinates are scaled by the
// square root of their mass, so that rank does not depend on units.
MatX free_motions(const Linearization& linear, const VecX& root_of_mass) {
  const int n = linear.coordinates();
  std::vector<int> unlocked;
  for (int i = 0; i < n; ++i)
    if (linear.inverse_mass()[i] > 0.0) unlocked.push_back(i);
  const int free_count = static_cast<int>(unlocked.size());
  MatX basis = MatX::Zero(n, free_count);
  for (int k = 0; k < free_count; ++k) basis(unlocked[k], k) = 1.0;
  if (linear.rows() == 0) return basis;
  const MatX gradient = linear.dense(linear.gradient(), linear.rows());
  const MatX rows = gradient * root_of_mass.cwiseInverse().asDiagonal() * basis;
  Eigen::ColPivHouseholderQR<MatX> qr(rows.transpose());
  qr.setThreshold(k_rank_tolerance);
  const MatX q = qr.householderQ() * MatX::Identity(free_count, free_count);
  return basis * q.rightCols(free_count - qr.rank());
}

// Complex displacements of all bodies for one of the clusters' coordinates.
std::vector<std::complex<double>> shape_of(const System& system, const Dynamics& dynamics,
                                           const Eigen::VectorXcd& q) {
  std::vector<std::complex<double>> shape(3 * system.bodies.size(), 0.0);
  std::complex<double> largest = 0.0;
  for (int i = 1; i < system.body_count(); ++i) {
    const Placement& place = dynamics.layout().placements[i];
    const Motion<double>& k = dynamics.motion()[dynamics.layout().clusters[place.cluster].motion];
    const Pair<double> lever = to_ground(k, place.offset);
    const std::complex<double> turn = q[3 * place.cluster + 2];
    shape[3 * i] = q[3 * place.cluster] - turn * lever.y;
    shape[3 * i + 1] = q[3 * place.cluster + 1] + turn * lever.x;
    shape[3 * i + 2] = turn;
    const double gyration = std::sqrt(system.bodies[i].inertia / system.bodies[i].mass);
    for (const auto& part : {shape[3 * i], shape[3 * i + 1], gyration * turn})
      if (size_of(part) > size_of(largest)) largest = part;
  }
  if (largest != 0.0)
    for (auto& part : shape) part /= largest;
  return shape;
}

} // namespace

double VibrationMode::frequency() const { return std::abs(eigenvalue.imag()) / k_two_pi; }
double VibrationMode::natural_frequency() const {
  return size_of(eigenvalue) / k_two_pi;
}
double VibrationMode::damping_ratio() const {
  return -eigenvalue.real() / size_of(eigenvalue);
}

VibrationModes vibration_modes(const System& system, const State& state) {
  Dynamics dynamics(system);
  dynamics.set_state(state);
  if (dynamics.coordinate_count() > k_max_modal_coordinates)
    throw NumericalFailure("modes are found with dense algebra: " + std::to_string(dynamics.coordinate_count()) +
                           " coordinates are more than the " + std::to_string(k_max_modal_coordinates) +
                           " that it is made for");
  std::vector<double> y(dynamics.dimension());
  dynamics.pack(state, y.data());
  Linearization linear;
  linear.evaluate(dynamics, state.t, y.data());
  const int n = linear.coordinates();
  VecX root(n);
  for (int i = 0; i < n; ++i) {
    const Cluster& cluster = dynamics.layout().clusters[i / 3];
    root[i] = std::sqrt(i % 3 < 2 ? cluster.mass : cluster.inertia);
  }
  const MatX z = free_motions(linear, root);
  const int r = static_cast<int>(z.cols());
  MatX by_pose, by_velocity;
  linear.acceleration_by_state(by_pose, by_velocity);
  // In mass-scaled coordinates Z is orthonormal and a symmetric stiffness stays symmetric.
  const auto reduced = [&](const MatX& a) {
    return MatX(z.transpose() * root.asDiagonal() * a * root.cwiseInverse().asDiagonal() * z);
  };
  MatX companion = MatX::Zero(2 * r, 2 * r);
  companion.topRightCorner(r, r).setIdentity();
  companion.bottomLeftCorner(r, r) = reduced(by_pose);
  companion.bottomRightCorner(r, r) = reduced(by_velocity);

  VibrationModes found;
  if (r == 0) return found;
  const Eigen::EigenSolver<MatX> solver(companion);
  if (solver.info() != Eigen::Success) throw NumericalFailure("the eigenvalues of the small vibrations do not converge");
  const auto& values = solver.eigenvalues();
  double largest = 0.0;
  for (int i = 0; i < 2 * r; ++i)
    largest = std::max(largest, size_of(values[i]));
  int rigid = 0;
  for (int i = 0; i < 2 * r; ++i) {
    if (size_of(values[i]) <= k_rigid_tolerance * largest) {
      ++rigid;
      continue;
    }
    if (values[i].imag() < 0.0) continue;
    VibrationMode mode;
    mode.eigenvalue = values[i];
    const Eigen::VectorXcd scaled = z * solver.eigenvectors().col(i).head(r);
    mode.shape = shape_of(system, dynamics, root.cwiseInverse().cast<std::complex<double>>().cwiseProduct(scaled));
    found.modes.push_back(std::move(mode));
  }
  found.rigid_motions = (rigid + 1) / 2;
  std::stable_sort(found.modes.begin(), found.modes.end(), [](const VibrationMode& a, const VibrationMode& b) {
    return a.natural_frequency() < b.natural_frequency();
  });
  return found;
}

} // namespace steplap
