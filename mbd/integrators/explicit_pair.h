// Step control shared by the embedded explicit pairs.
#pragma once

#include "mbd/integrators/explicit_runge_kutta.h"
#include "mbd/integrators/singular_passage.h"

#include <optional>

namespace steplap {

/// A singular position of joints lies ahead that the step from here does not pass in joint coordinates, which bodies'
/// own might: thrown where there is a choice, the state still that of the last step.
struct JointsNearSingular : NumericalFailure {
  using NumericalFailure::NumericalFailure;
};

class ExplicitPair : public Integrator {
public:
  ExplicitPair(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension, int stages, int order);
  [[nodiscard]] bool is_adaptive() const override { return true; }
  void step(Dynamics& dynamics, double t_limit) override { step_by_parts(dynamics, t_limit); }
  void begin_step(Dynamics& dynamics, double t_limit) override;
  void make_try(Dynamics& dynamics) override { try_error_ = try_step(dynamics); }
  [[nodiscard]] bool conclude_try(Dynamics& dynamics) override;
  [[nodiscard]] bool bears_look(Dynamics& dynamics) final;
  void dense(Dynamics& dynamics, double theta, double* out) final;
  [[nodiscard]] double stability_share(Dynamics& dynamics) final { return is_crossing_ ? 0.0 : share_of_stability(dynamics); }

protected:
  virtual void dense_of_pair(Dynamics& dynamics, double theta, double* out) = 0;
  [[nodiscard]] virtual double share_of_stability(Dynamics& dynamics) = 0;
  /// Stages, y1 and the error norm (accepted when ≤ 1) of a step of h_ from t0_.
  virtual double try_step(Dynamics& dynamics) = 0;
  /// Of a step whose end is accepted and finished: error norm of its dense output, where the end's does not bound it;
  /// beyond 1, which is no number too (infinite), the step is refused like any other.
  [[nodiscard]] virtual double dense_error(Dynamics& /*dynamics*/) { return 0.0; }
  void on_restart(Dynamics& dynamics) override;
  [[nodiscard]] bool withdraw(Dynamics& dynamics, double h) final;

  template <const auto& Rows, std::size_t Row> void stage(Dynamics& dynamics, double c) {
    add_stages<Rows, Row, Row>(scratch_.data());
    evaluate_stage(dynamics, t0_ + c * h_, scratch_.data(), k(Row), c);
  }
  /// combine() and weighted_sum() of the stages.
  template <const auto& Rows, std::size_t Row, std::size_t Count> void add_stages(double* out) {
    combine<Rows, Row, Count>(y0_.data(), h_, k_.data(), stride_, n_, out);
  }
  template <const auto& Weights, std::size_t Count> void sum_stages(double* out) {
    weighted_sum<Weights, Count>(k_.data(), stride_, n_, out);
  }
  /// h ‖k_i − k_j‖/‖y_i − y_j‖ of two stages at the step's end: the fastest rate in the steps' direction
  /// (Hairer, Wanner, Solving ODEs II, IV.2). `difference`: y_i − y_j.
  [[nodiscard]] double rate_of_stages(std::size_t i, std::size_t j, const double* difference) {
    double rates = 0.0, states = 0.0;
    for (int l = 0; l < n_ - 2; ++l) {
      const double f = (k(i)[l] - k(j)[l]) * weight_[l], y = difference[l] * weight_[l];
      rates += f * f;
      states += y * y;
    }
    // Differences far below the tolerance (bodies at rest) are rounding.
    return states > 1e-6 ? h_ * std::sqrt(rates / states) : 0.0;
  }
  double* k(std::size_t i) { return k_.data() + i * stride_; }

  std::vector<double> k_;
  int stride_;

  double try_error_ = 0.0; ///< of the try made last

private:
  /// Of the step that is being tried.
  struct Attempt {
    double left = 0.0; ///< to the limit, s
    double h = 0.0;    ///< that is wanted, before it is cut to end well
    bool is_last = false, is_retry = false, has_tried_crossing = false;
    std::optional<SingularPassage> passage;
  };
  void prepare_try();
  /// Is the step, whose end was finished, as good inside as at its end? Then it is noted.
  [[nodiscard]] bool accept_inside(Dynamics& dynamics, double& inside);
  double cross_singularity(Dynamics& dynamics, double left);
  void note_end(double pivot);
  [[nodiscard]] double error_inside(Dynamics& dynamics);
  void refuse_shorter_than_rounding(double h) const;
  [[nodiscard]] double shorter(double error) const;
  /// The next try takes h.
  bool try_again(double h) {
    attempt_.h = h;
    attempt_.is_retry = true;
    prepare_try();
    return false;
  }

  StepControl control_;
  int order_;
  double next_h_ = 0.0;
  Attempt attempt_;
  std::unique_ptr<SingularCrossing> crossing_; ///< made where one is met
  SingularApproach approach_;
  bool is_crossing_ = false;        ///< the step made is one
  bool is_inside_known_ = false;    ///< of the step made: it bears a look
  bool is_beside_singular_ = false; ///< the step made is
  /// What was before the step made, if it is withdrawn.
  struct Before {
    SingularApproach approach;
    double error = 1e-4;
  };
  Before before_;
};

} // namespace steplap
