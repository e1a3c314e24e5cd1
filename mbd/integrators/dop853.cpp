// The explicit pair of order 8 of Dormand and Prince (DOP853). Its dense output of order 7 needs three more evaluations, made only for
// steps that are evaluated inside.
#include "mbd/integrators/explicit_pair.h"
#include "mbd/integrators/methods.h"
#include "mbd/integrators/tableau_dop853.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

// Largest accepted difference between the dense output and the stage at 0.2, as error norm. In a step beyond the stability limit (hρ
// large, ρ the fastest rate) components that exist only as rounding errors grow: at the end of the step by up to (hρ)¹²/12!, but in the
// dense output by (hρ)¹⁵, which is 10⁴ times as much at hρ = 30 and 10⁵ times at 60. The error estimate does not see this. The
// difference at 0.2 is then 1/15 to 1/60 of the error of the dense output; in accurate steps it is a tenth of the tolerance
// (docs/how-to/choose_a_method.md).
constexpr std::size_t k_checked_stage = 14;
constexpr double k_most_departure = 5.0;
// Stricter limit for steps with slip, because friction directions depend on slip velocities, which may decrease to a tenth within a step
// (Integrator::resolves_slips): the error of the dense output, up to 60 times the difference, is then at most 10 in the error norm.
constexpr double k_most_departure_of_slips = 10.0 / 60.0;
constexpr double k_most_defect = 10.0; // largest accepted defect, as error norm; about 1 in accurate steps

class Dop853 final : public ExplicitPair {
public:
  Dop853(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension)
      : ExplicitPair(dynamics, settings, max_dimension, 16, 8), r_(7 * max_dimension) {
    set_rate_storage(k(0), k(12));
  }
  [[nodiscard]] const char* name() const override { return "dop853"; }

  void dense_of_pair(Dynamics& dynamics, double theta, double* out) override {
    if (!is_dense_ready_) prepare_dense(dynamics);
    dense_of_pair(theta, out);
  }
  // Evaluates y + s (r0 + u (r1 + s (r2 + u (r3 + s (r4 + u (r5 + s r6)))))), s = theta, u = 1 − s.
  void dense_of_pair(double theta, double* out) {
    const double s = theta, u = 1.0 - theta;
    for_numbers(
        n_, [ s, u, out, m = stride_, r = r_.data(), y = y0_.data() ]<class S>(int i) __attribute__((always_inline)) {
          S sum, part;
          read_numbers(r + 6 * m + i, sum);
          for (int p = 5; p >= 0; --p) {
            read_numbers(r + p * m + i, part);
            sum = part + (p % 2 == 1 ? s : u) * sum;
          }
          read_numbers(y + i, part);
          sum = part + s * sum;
          std::memcpy(out + i, &sum, sizeof sum);
        });
  }

  [[nodiscard]] double share_of_stability(Dynamics&) override {
    double* const y = scratch_.data();
    combine<dop853::a, 11, 11>(y0_.data(), h_, k_.data(), stride_, n_, y);
    for (int i = 0; i < n_; ++i) y[i] = y1_[i] - y[i];
    return rate_of_stages(12, 11, y) / 6.1; // dop853 is stable on the negative real axis for hρ up to 6.1
  }

protected:
  double try_step(Dynamics& dynamics) override {
    using namespace dop853;
    is_dense_ready_ = false;
    [&]<std::size_t... I>(std::index_sequence<I...>) { (stage<a, I + 1>(dynamics, c[I + 1]), ...); }(std::make_index_sequence<11>{});
    add_stages<a, 12, 12>(y1_.data());
    return error_of_stages(dynamics);
  }

  [[nodiscard]] double dense_error(Dynamics& dynamics) override {
    if (!is_dense_ready_) prepare_dense(dynamics);
    double error = stage_departure() / (has_slip_scale0_ ? k_most_departure_of_slips : k_most_departure);
    if (flows_inside(dynamics)) error = std::max(error, defect(dynamics) / k_most_defect);
    return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
  }

private:
  [[nodiscard]] double error_of_stages(Dynamics& dynamics) {
    using namespace dop853;
    sum_stages<e5, 12>(scratch_.data());
    const double fifth = projected_error_norm(dynamics, scratch_.data());
    sum_stages<e3, 12>(scratch_.data());
    const double third = projected_error_norm(dynamics, scratch_.data());
    const double denominator = std::sqrt(fifth * fifth + 0.01 * third * third);
    return denominator > 0.0 ? h_ * fifth * fifth / denominator : h_ * fifth;
  }

  void prepare_dense(Dynamics& dynamics) {
    using namespace dop853;
    stage<a, 13>(dynamics, c[13]);
    stage<a, 14>(dynamics, c[14]);
    stage<a, 15>(dynamics, c[15]);
    double* const r = r_.data();
    const int m = stride_;
    for_numbers(
        n_, [ r, m, h = h_, y0 = y0_.data(), y1 = y1_.data(), k0 = k(0), k1 = k(12) ]<class S>(int i) __attribute__((always_inline)) {
          S begin, end, rate0, rate1;
          read_numbers(y0 + i, begin);
          read_numbers(y1 + i, end);
          read_numbers(k0 + i, rate0);
          read_numbers(k1 + i, rate1);
          const S way = end - begin, first = h * rate0 - way, second = 2.0 * way - h * (rate0 + rate1);
          std::memcpy(r + i, &way, sizeof way);
          std::memcpy(r + m + i, &first, sizeof first);
          std::memcpy(r + 2 * m + i, &second, sizeof second);
        });
    weighted_row<d, 0, 16>(h_, k_.data(), m, n_, r + 3 * m);
    weighted_row<d, 1, 16>(h_, k_.data(), m, n_, r + 4 * m);
    weighted_row<d, 2, 16>(h_, k_.data(), m, n_, r + 5 * m);
    weighted_row<d, 3, 16>(h_, k_.data(), m, n_, r + 6 * m);
    is_dense_ready_ = true;
  }

  // Returns the error norm of the difference between the dense output and stage k_checked_stage, which is accurate to order 6.
  [[nodiscard]] double stage_departure() {
    double* const y = scratch_.data();
    double* const departure = y + n_;
    combine<dop853::a, k_checked_stage, k_checked_stage>(y0_.data(), h_, k_.data(), stride_, n_, y);
    dense_of_pair(dop853::c[k_checked_stage], departure);
    for (int i = 0; i < n_; ++i) departure[i] -= y[i];
    return error_norm(departure);
  }

  // Returns the error norm of the defect h (u' − f(u)) of the dense output u in the middle of the step.
  [[nodiscard]] double defect(Dynamics& dynamics) {
    double* const y = scratch_.data();
    double* const f = y + n_;
    double* const change = f + n_;
    const double* const r = r_.data();
    constexpr double s = 0.5;
    for (int i = 0; i < n_; ++i) {
      double value = r[6 * stride_ + i], slope = 0.0; // value and derivative of the dense polynomial by Horner's scheme
      for (int p = 5; p >= 0; --p) {
        slope = (p % 2 == 1 ? value : -value) + s * slope;
        value = r[p * stride_ + i] + s * value;
      }
      y[i] = y0_[i] + s * value;
      change[i] = value + s * slope;
    }
    dynamics.rates(t0_ + s * h_, y, f);
    for (int i = 0; i < n_; ++i) change[i] -= h_ * f[i];
    return error_norm(change);
  }

  // Returns true if an elastic joint slides in the step. Its force turns to the slip direction within its elastic strain, however small
  // that is compared with the slip, and at the start of the step may deviate from it only by rounding.
  [[nodiscard]] bool flows_inside(const Dynamics& dynamics) {
    for (int i = n_ - 2 - dynamics.inner_count(); i < n_ - 2; ++i)
      if (k(0)[i] != 0.0 || k(12)[i] != 0.0) return true;
    return false;
  }

  std::vector<double> r_;
  bool is_dense_ready_ = false;
};

} // namespace

std::unique_ptr<Integrator> make_dop853(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension) {
  return std::make_unique<Dop853>(dynamics, settings, max_dimension);
}

} // namespace steplap
