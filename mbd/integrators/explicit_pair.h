// Step control common to the embedded explicit Runge–Kutta pairs.
#pragma once

#include "mbd/integrators/explicit_runge_kutta.h"
#include "mbd/integrators/singular_passage.h"

namespace steplap {

/// Thrown if a singular position of joints lies ahead that cannot be passed in joint coordinates, but may be passable in absolute ones.
/// The state is that of the last accepted step.
struct JointsNearSingular : NumericalFailure {
  using NumericalFailure::NumericalFailure;
};

/// Base class of the embedded explicit pairs. Derived classes supply stages, error estimate and dense output.
class ExplicitPair : public Integrator {
public:
  ExplicitPair(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension, int stages, int order);
  [[nodiscard]] bool is_adaptive() const override { return true; }
  void step(Dynamics& dynamics, double t_limit) final;
  [[nodiscard]] bool dense_output_is_accurate(Dynamics& dynamics) final;
  void dense(Dynamics& dynamics, double theta, double* out) final;
  [[nodiscard]] double stability_share(Dynamics& dynamics) final { return is_crossing_ ? 0.0 : share_of_stability(dynamics); }

protected:
  /// Dense output of the pair, as Integrator::dense(), for a step that is not a singular crossing.
  virtual void dense_of_pair(Dynamics& dynamics, double theta, double* out) = 0;
  /// Returns Integrator::stability_share() of the pair.
  [[nodiscard]] virtual double share_of_stability(Dynamics& dynamics) = 0;
  /// Computes the stages, y1 and the error norm (acceptable if ≤ 1) of a step of length h_ from t0_.
  virtual double try_step(Dynamics& dynamics) = 0;
  /// Returns the error norm of the dense output of an accepted step, for pairs whose dense output can be less accurate than the end of
  /// the step; 0 for all others. The step is rejected if the norm is above 1 or NaN.
  [[nodiscard]] virtual double dense_error(Dynamics& /*dynamics*/) { return 0.0; }
  void on_restart(Dynamics& dynamics) override;
  [[nodiscard]] bool withdraw(Dynamics& dynamics, double h) final;

  template <const auto& Rows, std::size_t Row> void stage(Dynamics& dynamics, double c) {
    add_stages<Rows, Row, Row>(scratch_.data());
    evaluate_stage(dynamics, t0_ + c * h_, scratch_.data(), k(Row), c);
  }
  /// Call combine() and weighted_sum() of explicit_runge_kutta.h with the stages of this pair.
  template <const auto& Rows, std::size_t Row, std::size_t Count> void add_stages(double* out) {
    combine<Rows, Row, Count>(y0_.data(), h_, k_.data(), stride_, n_, out);
  }
  template <const auto& Weights, std::size_t Count> void sum_stages(double* out) {
    weighted_sum<Weights, Count>(k_.data(), stride_, n_, out);
  }
  /// Returns h ‖k_i − k_j‖/‖y_i − y_j‖ for two stages at the end of the step, an estimate of h times the fastest rate (Hairer, Wanner,
  /// Solving ODEs II, IV.2). `difference` is y_i − y_j.
  [[nodiscard]] double rate_of_stages(std::size_t i, std::size_t j, const double* difference) {
    double rates = 0.0, states = 0.0;
    for (int l = 0; l < n_ - 2; ++l) {
      const double f = (k(i)[l] - k(j)[l]) * weight_[l], y = difference[l] * weight_[l];
      rates += f * f;
      states += y * y;
    }
    // Differences far below the tolerance (bodies at rest) consist of rounding errors only.
    return states > 1e-6 ? h_ * std::sqrt(rates / states) : 0.0;
  }
  double* k(std::size_t i) { return k_.data() + i * stride_; }

  std::vector<double> k_;
  int stride_;

private:
  [[nodiscard]] bool begin_try(double h, double t_limit);
  [[nodiscard]] bool accept_inside(Dynamics& dynamics, double h, double error, bool is_retry, double& inside);
  [[nodiscard]] double cross_singularity(Dynamics& dynamics, double left);
  void note_end(double pivot);
  [[nodiscard]] double error_inside(Dynamics& dynamics);
  /// Returns the ratio of the next step length to the rejected one for this error norm.
  [[nodiscard]] double shrink_factor(double error) const;
  /// Counts a rejected attempt. Returns the length of the next one, `factor` times that of the rejected one.
  [[nodiscard]] double rejected(double factor) {
    ++rejections_;
    return factor * h_;
  }

  StepControl control_;
  int order_;
  double next_h_ = 0.0;
  std::unique_ptr<SingularCrossing> crossing_; ///< created when the first crossing occurs
  SingularApproach approach_;
  bool is_crossing_ = false;        ///< the last step is a singular crossing
  bool is_inside_known_ = false;    ///< the dense output of the last step has been checked
  bool is_beside_singular_ = false; ///< the last step is near a singular position
  /// Step-control data before the last step, restored by withdraw().
  struct SavedControl {
    SingularApproach approach;
    double error = 1e-4;
  };
  SavedControl saved_control_;
};

} // namespace steplap
