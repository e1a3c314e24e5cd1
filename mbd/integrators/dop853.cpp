// The explicit pair of order 8 of Dormand and Prince (DOP853) with its dense output of order 7, whose
// three extra evaluations are made only for steps that are looked into.
#include "mbd/integrators/explicit_pair.h"
#include "mbd/integrators/lane_try.h"
#include "mbd/integrators/methods.h"
#include "mbd/integrators/tableau_dop853.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace steplap {

namespace {

// Beyond stability a motion that is not there yet but for rounding grows within a step: its end by up to (hρ)¹²/12!, the
// dense output by (hρ)¹⁵, which is 10⁴ times as much at hρ = 30 and 10⁵ at 60, unseen by the estimate at the end. There
// the stage at 0.2 departs from the dense output by a 15th to a 60th of what that is off by; in steps that are accurate,
// where both are right, by a tenth of the tolerance (docs/how-to/choose_a_method.md).
constexpr std::size_t k_looked_stage = 14;
constexpr double k_most_departure = 5.0;
// Velocities of a slip by which its friction turns may be off by no more there than where they have fallen to a tenth
// within a step (Integrator::resolves_slips): a 60th of that.
constexpr double k_most_departure_of_slips = 10.0 / 60.0;
constexpr double k_most_defect = 10.0; // of accurate steps about 1: an eighth of the polynomial's error, times hρ

class Dop853 final : public ExplicitPair, public LaneTry {
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
  void dense_of_pair(double theta, double* out) {
    const double s = theta, u = 1.0 - theta;
    const double* __restrict r = r_.data();
    const double* __restrict y = y0_.data();
    double* __restrict result = out;
    const int m = stride_;
    for (int i = 0; i < n_; ++i)
      result[i] = y[i] +
               s * (r[i] + u * (r[m + i] +
                                s * (r[2 * m + i] +
                                     u * (r[3 * m + i] +
                                          s * (r[4 * m + i] + u * (r[5 * m + i] + s * r[6 * m + i]))))));
  }

  [[nodiscard]] double share_of_stability(Dynamics&) override {
    double* const y = scratch_.data();
    combine<dop853::a, 11, 11>(y0_.data(), h_, k_.data(), stride_, n_, y);
    for (int i = 0; i < n_; ++i) y[i] = y1_[i] - y[i];
    return rate_of_stages(12, 11, y) / 6.1; // stable for hρ up to 6.1 on the negative axis
  }

  [[nodiscard]] LaneTry* lane_try() override { return this; }
  [[nodiscard]] Given given(const Dynamics& dynamics) override {
    return {t0_, h_, n_, y0_.data(), k0_, weight_.data(), stages_looked_at(dynamics)};
  }
  void take(Dynamics& dynamics, const LaneColumns& made, int lane) override {
    is_dense_ready_ = false;
    const StageProgram& program = *dynamics.lane_program();
    const int lanes = made.lanes();
    for (int s = 1; s <= k_lane_stages; ++s) {
      const auto stage = static_cast<std::size_t>(s);
      gather(made.rates(s, lane), lanes, k(stage));
      take_stage(dynamics, program, made.stage(s, lane), stage);
    }
    gather(made.end(lane), lanes, y1_.data());
    try_error_ = dynamics.is_near_singular()
                     ? error_of_stages(dynamics)
                     : error_of(std::sqrt(made.fifth(lane) / n_), std::sqrt(made.third(lane) / n_));
  }

protected:
  double try_step(Dynamics& dynamics) override {
    using namespace dop853;
    is_dense_ready_ = false;
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (stage<a, I + 1>(dynamics, c[I + 1]), ...);
    }(std::make_index_sequence<11>{});
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
    return error_of(fifth, projected_error_norm(dynamics, scratch_.data()));
  }
  [[nodiscard]] double error_of(double fifth, double third) const {
    const double denominator = std::sqrt(fifth * fifth + 0.01 * third * third);
    return denominator > 0.0 ? h_ * fifth * fifth / denominator : h_ * fifth;
  }

  void gather(const double* column, int lanes, double* to) const {
    for (int i = 0; i < n_; ++i) to[i] = column[static_cast<std::ptrdiff_t>(i) * lanes];
  }

  // Bits of stages, as take_stage() will have it.
  [[nodiscard]] unsigned stages_looked_at(const Dynamics& dynamics) {
    unsigned looks = 0;
    for (std::size_t s = 1; s <= k_lane_stages; ++s) {
      const bool is_due = is_merged_look_due(dop853::c[s]);
      if (is_due) last_merged_look_ = dop853::c[s];
      if (dynamics.looks_at_merged(is_due)) looks |= 1U << s;
    }
    last_merged_look_ = 0.0;
    return looks;
  }

  // As evaluate_stage(), of what was made elsewhere.
  void take_stage(Dynamics& dynamics, const StageProgram& program, const StageColumn& made, std::size_t stage) {
    const double theta = dop853::c[stage];
    const bool is_due = is_merged_look_due(theta);
    if (is_due) last_merged_look_ = theta;
    const bool has_merged = dynamics.looks_at_merged(is_due);
    if (!has_merged) dynamics.take_stage(program, made);
    else if (program.can_look()) dynamics.take_look(program, made, t0_ + theta * h_, y0_.data());
    else evaluate_again(dynamics, made, stage);
    nodes_.add(theta, dynamics.watch().data(), has_merged);
  }

  // Joints inside clusters are looked at by an evaluation.
  void evaluate_again(Dynamics& dynamics, const StageColumn& made, std::size_t stage) {
    double* const y = scratch_.data();
    double* const f = y + n_;
    for (int i = 0; i < n_ - 2; ++i) y[i] = made.input(static_cast<std::size_t>(i));
    std::copy_n(y0_.begin() + n_ - 2, 2, y + n_ - 2); // energies, on which no rate hangs
    dynamics.rates(t0_ + dop853::c[stage] * h_, y, f);
    const auto is_same = [](double a, double b) { // a motion that becomes infinite is refused elsewhere
      return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
    };
    if (!std::equal(f, f + n_, k(stage), is_same))
      throw std::logic_error("a stage made in lanes is not what its evaluation makes");
    dynamics.watch_merged_if_near(f, true);
  }

  void prepare_dense(Dynamics& dynamics) {
    using namespace dop853;
    stage<a, 13>(dynamics, c[13]);
    stage<a, 14>(dynamics, c[14]);
    stage<a, 15>(dynamics, c[15]);
    double* r = r_.data();
    const int m = stride_;
    for (int i = 0; i < n_; ++i) {
      r[i] = y1_[i] - y0_[i];
      r[m + i] = h_ * k(0)[i] - r[i];
      r[2 * m + i] = 2.0 * r[i] - h_ * (k(0)[i] + k(12)[i]);
    }
    weighted_row<d, 0, 16>(k_.data(), m, n_, r + 3 * m);
    weighted_row<d, 1, 16>(k_.data(), m, n_, r + 4 * m);
    weighted_row<d, 2, 16>(k_.data(), m, n_, r + 5 * m);
    weighted_row<d, 3, 16>(k_.data(), m, n_, r + 6 * m);
    for (int p = 3; p < 7; ++p)
      for (int i = 0; i < n_; ++i) r[p * m + i] *= h_;
    is_dense_ready_ = true;
  }

  // Of the dense output from a stage that knows its place to order 6.
  [[nodiscard]] double stage_departure() {
    double* const y = scratch_.data();
    double* const departure = y + n_;
    combine<dop853::a, k_looked_stage, k_looked_stage>(y0_.data(), h_, k_.data(), stride_, n_, y);
    dense_of_pair(dop853::c[k_looked_stage], departure);
    for (int i = 0; i < n_; ++i) departure[i] -= y[i];
    return error_norm(departure);
  }

  // Of the dense output u in the middle of the step: h (u' − f(u)).
  [[nodiscard]] double defect(Dynamics& dynamics) {
    double* const y = scratch_.data();
    double* const f = y + n_;
    double* const change = f + n_;
    const double* const r = r_.data();
    constexpr double s = 0.5;
    for (int i = 0; i < n_; ++i) {
      double value = r[6 * stride_ + i], slope = 0.0; // of the polynomial from its innermost bracket
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

  // An elastic joint slides: its force turns to the way of the slip within the strain that it bears, however small
  // that is against the way, and nothing but rounding may have turned it away from there when the step began.
  [[nodiscard]] bool flows_inside(const Dynamics& dynamics) {
    for (int i = n_ - 2 - dynamics.inner_count(); i < n_ - 2; ++i)
      if (k(0)[i] != 0.0 || k(12)[i] != 0.0) return true;
    return false;
  }

  std::vector<double> r_;
  bool is_dense_ready_ = false;
};

} // namespace

std::unique_ptr<Integrator> make_dop853(const Dynamics& dynamics, const IntegratorSettings& settings,
                                        int max_dimension) {
  return std::make_unique<Dop853>(dynamics, settings, max_dimension);
}

} // namespace steplap
