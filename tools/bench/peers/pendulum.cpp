// B3, the simple pendulum of IFToMM A01, released at rest from the horizontal: θ'' = −(g/l) sin θ, with θ measured from the downward
// vertical.

#include "dop853_run.h"
#include "mechanisms.h"
#ifdef STEPLAP_PEER_ARKODE
#include "arkode_runner.h"
#endif

#include <cmath>
#include <numbers>

namespace steplap::peers {
namespace {

constexpr double k_gravity = 9.81;

void rates(const double* y, double* dydt) {
  dydt[0] = y[1];
  dydt[1] = -k_gravity * std::sin(y[0]);
}

double error_of(double theta) { return std::max(std::abs(std::sin(theta) - k_pendulum_x), std::abs(-std::cos(theta) - k_pendulum_y)); }

} // namespace

MechanismResult run_pendulum_dop853(double tolerance) {
  std::array<double, 2> y = {-0.5 * std::numbers::pi, 0.0};
  const SmoothCounts counts =
      run_dop853([](double, const double* x, double* f) { rates(x, f); }, y, k_pendulum_end, 0.5 * std::pow(tolerance, 0.125), tolerance);
  return {error_of(y[0]), counts.steps, counts.evaluations, 0};
}

#ifdef STEPLAP_PEER_ARKODE
MechanismResult run_pendulum_arkode(double tolerance) {
  std::array<double, 2> y = {-0.5 * std::numbers::pi, 0.0};
  auto f = [](double, N_Vector x, N_Vector dydt, void*) {
    rates(data_of(x), data_of(dydt));
    return 0;
  };
  ArkodeRunner runner({2, f}, y.data(), tolerance);
  (void)runner.advance(k_pendulum_end);
  return {error_of(y[0]), runner.steps(), runner.evaluations(), 0};
}
#endif

} // namespace steplap::peers
