// Explicit pair of order 5(4) by Tsitouras, with dense output of order 4.
#include "mbd/integrators/explicit_pair.h"
#include "mbd/integrators/methods.h"
#include "mbd/integrators/tableau_tsit5.h"

namespace steplap {

namespace {

// Factor on the permitted error of slip velocities. The dense output is of order 4 and has no error estimate, but near the end of a slip
// the friction direction depends on its velocity. With this factor 200 random slips (slip_ends_test.cpp) stay within 2 % of the
// capacity.
constexpr double k_slip_care = 0.1;

class Tsit5 final : public ExplicitPair {
public:
  Tsit5(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension)
      : ExplicitPair(dynamics, settings, max_dimension, 7, 5), raw_(max_dimension) {
    set_rate_storage(k(0), k(6));
    slip_care_ = k_slip_care;
  }
  [[nodiscard]] const char* name() const override { return "tsit5"; }

  void dense_of_pair(Dynamics&, double theta, double* out) override {
    double weight[7];
    for (std::size_t j = 0; j < 7; ++j) {
      const auto& d = tsit5::d[j];
      weight[j] = theta * (d[0] + theta * (d[1] + theta * (d[2] + theta * d[3])));
    }
    // The displacement by projection is distributed smoothly over the step, so that the dense output ends at the projected state.
    const double blend = theta * theta * (3.0 - 2.0 * theta);
    for (int i = 0; i < n_; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < 7; ++j) sum += weight[j] * k(j)[i];
      out[i] = y0_[i] + h_ * sum + blend * (y1_[i] - raw_[i]);
    }
  }

  [[nodiscard]] double share_of_stability(Dynamics&) override {
    double* const y = scratch_.data();
    combine<tsit5::a, 5, 5>(y0_.data(), h_, k_.data(), stride_, n_, y);
    for (int i = 0; i < n_; ++i) y[i] = y1_[i] - y[i];
    return rate_of_stages(6, 5, y) / 3.5; // tsit5 is stable on the negative real axis for hρ up to 3.5
  }

protected:
  double try_step(Dynamics& dynamics) override {
    using namespace tsit5;
    stage<a, 1>(dynamics, c[1]);
    stage<a, 2>(dynamics, c[2]);
    stage<a, 3>(dynamics, c[3]);
    stage<a, 4>(dynamics, c[4]);
    stage<a, 5>(dynamics, c[5]);
    add_stages<a, 6, 6>(y1_.data());
    // The last stage, the rates at the end, belongs to the error estimate. It is evaluated before projection, which moves the state by
    // much less than the error.
    dynamics.evaluate(Request::stage, t0_ + h_, y1_.data(), k(6));
    std::copy(y1_.begin(), y1_.begin() + n_, raw_.begin());
    sum_stages<e, 7>(scratch_.data());
    return h_ * projected_error_norm(dynamics, scratch_.data());
  }

private:
  std::vector<double> raw_;
};

} // namespace

std::unique_ptr<Integrator> make_tsit5(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension) {
  return std::make_unique<Tsit5>(dynamics, settings, max_dimension);
}

} // namespace steplap
