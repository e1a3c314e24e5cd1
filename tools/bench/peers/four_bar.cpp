// B2, the N-four-bar of IFToMM A02, hand-written in two forms.
//
// On the parallelogram branch it has one coordinate, θ from the vertical:
//   θ'' = g ((N+1)/2 + N) / ((N+1)/3 + N) sin θ.
// The general form has the N + 1 angles α of the rods, the N angles β of the bars, and two closure conditions per window. It passes through
// flat positions, where the closures lose rank. It is integrated by RK4 with fixed steps, a dense Schur complement, and projection onto
// position and velocity constraints after each step.

#include "dop853_run.h"
#include "mechanisms.h"
#ifdef STEPLAP_PEER_ARKODE
#include "arkode_runner.h"
#endif

#include <Eigen/Dense>

#include <cmath>
#include <numbers>

namespace steplap::peers {
namespace {

constexpr double k_gravity = 9.81;

double pull_of(int windows) {
  const double n = windows;
  return k_gravity * ((n + 1.0) / 2.0 + n) / ((n + 1.0) / 3.0 + n);
}

double error_of(const FourBarExact& exact, double x, double y) { return std::max(std::abs(x - exact.x), std::abs(y - exact.y)); }

// General form with the state α0 … αN, β1 … βN and their rates. Rods and bars are uniform, 1 m and 1 kg.
class FourBarChain {
public:
  explicit FourBarChain(int windows)
      : n_(windows), count_(2 * windows + 1), mass_(count_), coupling_(windows), g_(2 * windows, count_), reached_(count_, 2 * windows),
        gamma_(2 * windows), force_(count_), free_(count_), schur_(2 * windows) {}

  [[nodiscard]] Eigen::VectorXd start() const {
    Eigen::VectorXd y = Eigen::VectorXd::Zero(2 * count_);
    y.head(n_ + 1).setConstant(0.5 * std::numbers::pi);
    y.segment(count_, n_ + 1).setConstant(-1.0); // point B0 moves at +1 m/s
    return y;
  }

  void rates(const Eigen::VectorXd& y, Eigen::VectorXd& dydt) {
    ++evaluations;
    assemble(y);
    solve_mass(force_, free_);
    const Eigen::VectorXd lambda = schur_.solve(g_ * free_ - gamma_);
    dydt.head(count_) = y.tail(count_);
    dydt.tail(count_) = free_ - reached_ * lambda;
  }

  // Projects positions, then velocities, onto the constraints with the smallest change.
  void project(Eigen::VectorXd& y) {
    assemble(y);
    Eigen::VectorXd open(2 * n_);
    for (int j = 0; j < n_; ++j) {
      const double a = y[j], next = y[j + 1], b = y[n_ + 1 + j];
      open[2 * j] = std::cos(a) + std::cos(b) - std::cos(next) - 1.0;
      open[2 * j + 1] = std::sin(a) + std::sin(b) - std::sin(next);
    }
    y.head(count_) -= reached_ * schur_.solve(open);
    y.tail(count_) -= reached_ * schur_.solve(g_ * y.tail(count_));
  }

  long evaluations = 0;

private:
  void assemble(const Eigen::VectorXd& y) {
    g_.setZero();
    for (int j = 0; j <= n_; ++j) {
      mass_[j] = 1.0 / 3.0 + (j < n_ ? 1.0 : 0.0);
      force_[j] = -k_gravity * std::cos(y[j]) * (0.5 + (j < n_ ? 1.0 : 0.0));
    }
    for (int j = 0; j < n_; ++j) {
      const int bar = n_ + 1 + j;
      const double a = y[j], next = y[j + 1], b = y[bar];
      const double wa = y[count_ + j], wn = y[count_ + j + 1], wb = y[count_ + bar];
      mass_[bar] = 1.0 / 3.0;
      coupling_[j] = 0.5 * std::cos(a - b);
      force_[j] += 0.5 * std::sin(b - a) * wb * wb;
      force_[bar] = -0.5 * k_gravity * std::cos(b) + 0.5 * std::sin(a - b) * wa * wa;
      g_(2 * j, j) = -std::sin(a);
      g_(2 * j + 1, j) = std::cos(a);
      g_(2 * j, bar) = -std::sin(b);
      g_(2 * j + 1, bar) = std::cos(b);
      g_(2 * j, j + 1) = std::sin(next);
      g_(2 * j + 1, j + 1) = -std::cos(next);
      gamma_[2 * j] = std::cos(a) * wa * wa + std::cos(b) * wb * wb - std::cos(next) * wn * wn;
      gamma_[2 * j + 1] = std::sin(a) * wa * wa + std::sin(b) * wb * wb - std::sin(next) * wn * wn;
    }
    for (int c = 0; c < 2 * n_; ++c) {
      const Eigen::VectorXd row = g_.row(c).transpose();
      Eigen::VectorXd column(count_);
      solve_mass(row, column);
      reached_.col(c) = column;
    }
    schur_.compute(g_ * reached_);
  }

  // Solves M x = right. In M each bar is coupled with the rod that carries it; the last rod is uncoupled.
  void solve_mass(const Eigen::VectorXd& right, Eigen::VectorXd& x) const {
    for (int j = 0; j < n_; ++j) {
      const int bar = n_ + 1 + j;
      const double over = 1.0 / (mass_[j] * mass_[bar] - coupling_[j] * coupling_[j]);
      x[j] = (mass_[bar] * right[j] - coupling_[j] * right[bar]) * over;
      x[bar] = (mass_[j] * right[bar] - coupling_[j] * right[j]) * over;
    }
    x[n_] = right[n_] / mass_[n_];
  }

  int n_, count_;
  Eigen::VectorXd mass_, coupling_;
  Eigen::MatrixXd g_, reached_;
  Eigen::VectorXd gamma_, force_, free_;
  Eigen::LDLT<Eigen::MatrixXd> schur_; // pivoted, because rank is lost near the flat positions
};

} // namespace

MechanismResult run_four_bar_dop853(const FourBarExact& exact, double tolerance) {
  const double pull = pull_of(exact.windows);
  std::array<double, 2> y = {0.0, 1.0};
  auto rates = [pull](double, const double* x, double* f) {
    f[0] = x[1];
    f[1] = pull * std::sin(x[0]);
  };
  const SmoothCounts counts = run_dop853(rates, y, k_four_bar_end, 0.5 * std::pow(tolerance, 0.125), tolerance);
  return {error_of(exact, std::sin(y[0]), std::cos(y[0])), counts.steps, counts.evaluations, 0};
}

#ifdef STEPLAP_PEER_ARKODE
MechanismResult run_four_bar_arkode(const FourBarExact& exact, double tolerance) {
  double pull = pull_of(exact.windows);
  std::array<double, 2> y = {0.0, 1.0};
  auto rates = [](double, N_Vector x, N_Vector dydt, void* a) {
    data_of(dydt)[0] = data_of(x)[1];
    data_of(dydt)[1] = *static_cast<double*>(a) * std::sin(data_of(x)[0]);
    return 0;
  };
  ArkodeRunner runner({2, rates, &pull}, y.data(), tolerance);
  (void)runner.advance(k_four_bar_end);
  return {error_of(exact, std::sin(y[0]), std::cos(y[0])), runner.steps(), runner.evaluations(), 0};
}
#endif

MechanismResult run_four_bar_kkt_rk4(const FourBarExact& exact, double step) {
  FourBarChain chain(exact.windows);
  Eigen::VectorXd y = chain.start();
  const auto size = y.size();
  Eigen::VectorXd k1(size), k2(size), k3(size), k4(size);
  const long steps = std::lround(k_four_bar_end / step);
  const double h = k_four_bar_end / static_cast<double>(steps);
  for (long i = 0; i < steps; ++i) {
    chain.rates(y, k1);
    chain.rates(y + 0.5 * h * k1, k2);
    chain.rates(y + 0.5 * h * k2, k3);
    chain.rates(y + h * k3, k4);
    y += (h / 6.0) * (k1 + 2.0 * (k2 + k3) + k4);
    chain.project(y);
  }
  return {error_of(exact, std::cos(y[0]), std::sin(y[0])), steps, chain.evaluations, 0};
}

} // namespace steplap::peers
