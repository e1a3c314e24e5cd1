#include "mbd/base/decompositions.h"
#include "mbd/rest/landscape.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
constexpr double k_rounded_terms = 32.0;

class DenseLandscape final : public Landscape {
public:
  explicit DenseLandscape(const StepProblem& scene) : Landscape(scene) {}

  void linearise(const State& state) override {
    const Statics& statics = scene_.statics;
    const Tangent t = tangent_of(statics, scene_.scale);
    kept_ = t.kept;
    force_ = scaled_force();
    lambda_ = multipliers_of(statics, scene_.scale, t);
    stiffness_ = scene_.scale.asDiagonal() * statics.stiffness(lambda_) * scene_.scale.asDiagonal();
    VecX reactions = VecX::Zero(force_.size());
    if (!t.kept.empty()) reactions = t.held.cwiseAbs() * (t.held.transpose() * force_).cwiseAbs();
    const VecX rounding =
        rounding_of(state, force_.cwiseAbs() + reactions, [&](const VecX& place) { return VecX(stiffness_.cwiseAbs() * place); });
    force_ -= t.held * (t.held.transpose() * force_);
    shape_ = t.free;
    find_modes();
    share_rounding_ = shape_.cwiseAbs().transpose() * rounding;
  }

  // Uses the whole stiffness matrix, which need not be symmetric.
  VecX newton_step() override {
    std::vector<Eigen::Index> firm;
    for (Eigen::Index i = 0; i < value_.size(); ++i)
      if (std::abs(value_[i]) > value_rounding_[i]) firm.push_back(i);
    const auto count = static_cast<Eigen::Index>(firm.size());
    if (count == 0) return VecX::Zero(force_.size());
    MatX a(count, count), w(force_.size(), count);
    VecX g(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      g[i] = share_[firm[i]];
      w.col(i) = shape_.col(firm[i]);
      for (Eigen::Index j = 0; j < count; ++j) a(i, j) = reduced_(firm[i], firm[j]);
    }
    return w * DenseLu(a).solve(g);
  }

  bool is_pushed() override {
    for (Eigen::Index i = 0; i < value_.size(); ++i)
      if (std::abs(value_[i]) <= value_rounding_[i] && std::abs(share_[i]) > share_rounding_[i]) return true;
    return false;
  }

  bool is_skew() const override { return (reduced_ - reduced_.transpose()).cwiseAbs().sum() > 1e-9 * reduced_.cwiseAbs().sum(); }

  double imbalance() const override { return share_.size() > 0 ? share_.cwiseAbs().maxCoeff() : 0.0; }

  // Chooses σ such that the step ends at the border of the trust region. Returns Newton's step if that lies inside.
  VecX trust_step(const StepSize& size) override {
    double least = std::numeric_limits<double>::infinity(), largest = 0.0;
    for (Eigen::Index i = 0; i < value_.size(); ++i) {
      largest = std::max(largest, std::abs(value_[i]));
      if (!is_loose(i)) least = std::min(least, value_[i] - value_rounding_[i]);
    }
    used_sigma_ = 0.0;
    if (least > 0.0) {
      const VecX newton = regularised(0.0);
      if (size(newton) <= 1.0) return newton;
    }
    const double base = std::max(0.0, -least);
    double low = 0.0, high = std::max({1e-12 * largest, 1e-6 * base, 1e-30});
    for (int i = 0; i < 400 && size(regularised(base + high)) > 1.0; ++i) {
      low = high;
      high *= 4.0;
    }
    for (int i = 0; i < 12 && low > 0.0; ++i) {
      const double middle = std::sqrt(low * high);
      (size(regularised(base + middle)) > 1.0 ? low : high) = middle;
    }
    used_sigma_ = base + high;
    return regularised(used_sigma_);
  }

  std::optional<Unstable> most_unstable_direction() override {
    Eigen::Index worst = 0;
    if (value_.size() == 0 || !(value_.minCoeff(&worst) < -value_rounding_[worst])) return std::nullopt;
    // Sliding friction depends on normal forces, but these do not depend on friction. This adds an off-diagonal stiffness k μ, which makes
    // the symmetric part indefinite although nothing is unstable. An instability must therefore appear in the eigenvalues of the whole
    // matrix, too.
    if (is_skew() && (eigenvalues(reduced_).real().array() >= -value_rounding_.maxCoeff()).all()) return std::nullopt;
    return Unstable{shape_.col(worst), share_[worst], share_rounding_[worst]};
  }

  // Includes the effect of sliding friction, by the eigenvalues of the whole stiffness.
  int count_yielding() override {
    if (value_.size() == 0) return 0;
    const double rounding = value_rounding_.maxCoeff();
    return static_cast<int>((eigenvalues(reduced_).real().array() <= rounding).count());
  }

  VecX acceleration() override { return share_.size() > 0 ? VecX(shape_ * share_) : VecX(VecX::Zero(force_.size())); }

  std::vector<MotionPart> indifferent(int& unnamed) override {
    unnamed = 0;
    std::vector<MotionPart> parts;
    for (Eigen::Index i = 0; i < value_.size(); ++i)
      if (std::abs(value_[i]) <= value_rounding_[i]) parts.push_back(largest_part(shape_.col(i)));
    return parts;
  }

  double displacement_to_rows(const VecX& off, VecX& way) override {
    end_ = tangent_of(scene_.statics, scene_.scale, &kept_);
    const auto count = static_cast<Eigen::Index>(end_.kept.size());
    VecX left(count);
    for (Eigen::Index k = 0; k < count; ++k) left[k] = off[end_.kept[k]] / end_.row_size[end_.kept[k]];
    way = VecX::Zero(force_.size());
    if (count == 0) return 0.0;
    way = end_.held * end_.triangle.transpose().triangularView<Eigen::Lower>().solve(left);
    return left.cwiseAbs().maxCoeff();
  }

  const VecX& row_size() const override { return end_.row_size; }

  VecX along_rows(const VecX& vector) const override { return vector - end_.held * (end_.held.transpose() * vector); }

  // Uses the stiffness from the start of the step.
  VecX stiff_imbalance(double& size) override {
    VecX gradient = scaled_force();
    gradient -= end_.held * (end_.held.transpose() * gradient);
    VecX share = shape_.transpose() * gradient;
    for (Eigen::Index i = 0; i < share.size(); ++i) {
      const bool counts = value_[i] > 10.0 * used_sigma_ && value_[i] > value_rounding_[i];
      share[i] = counts ? share[i] / (value_[i] + used_sigma_) : 0.0;
    }
    const VecX move = shape_ * share;
    size = move.size() > 0 ? move.cwiseAbs().maxCoeff() : 0.0;
    return move;
  }

private:
  // Determines mass-orthonormal eigenvectors of the stiffness.
  void find_modes() {
    const Eigen::Index r = shape_.cols();
    value_ = share_ = value_rounding_ = VecX::Zero(r);
    if (r == 0) return;
    const MatX mass = shape_.transpose() * scene_.mass.asDiagonal() * shape_;
    shape_ = solve_lower(mass, shape_.transpose()).transpose();
    const MatX turned = -(shape_.transpose() * stiffness_ * shape_);
    const SymmetricEigen eigen = symmetric_eigen(0.5 * (turned + turned.transpose()));
    shape_ = shape_ * eigen.vectors;
    value_ = eigen.values;
    reduced_ = eigen.vectors.transpose() * turned * eigen.vectors;
    share_ = shape_.transpose() * force_;
    const MatX size = stiffness_.cwiseAbs() * shape_.cwiseAbs();
    const double largest = value_.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < r; ++i)
      value_rounding_[i] = k_epsilon * (k_rounded_terms * shape_.col(i).cwiseAbs().dot(size.col(i)) + 4.0 * largest);
  }

  [[nodiscard]] bool is_loose(Eigen::Index i) const {
    return std::abs(value_[i]) <= value_rounding_[i] && std::abs(share_[i]) <= share_rounding_[i];
  }

  [[nodiscard]] VecX regularised(double sigma) const {
    VecX share = share_;
    for (Eigen::Index i = 0; i < share.size(); ++i) share[i] = is_loose(i) ? 0.0 : share_[i] / (value_[i] + sigma);
    return shape_ * share;
  }

  MatX stiffness_, shape_, reduced_;                     ///< scaled stiffness; wᵢ; −wᵀKw
  VecX value_, value_rounding_, share_, share_rounding_; ///< λᵢ, gᵢ and their rounding errors
  double used_sigma_ = 0.0;
  std::vector<int> kept_; ///< independent rows at the last linearise()
  Tangent end_;
};

} // namespace

MotionPart largest_part(const VecX& scaled) {
  Eigen::Index at = 0;
  scaled.cwiseAbs().maxCoeff(&at);
  return {static_cast<int>(at) / 3 + 1, static_cast<int>(at) % 3, scaled[at] < 0.0 ? -1.0 : 1.0};
}

VecX Landscape::rounding_of(const State& state, const VecX& sizes, const std::function<VecX(const VecX&)>& stiffness) const {
  VecX place(sizes.size());
  for (Eigen::Index i = 0; i < place.size(); ++i)
    place[i] = std::max(scene_.length, std::abs(state.q[static_cast<std::size_t>(i) + 3]) / scene_.scale[i]);
  return k_rounded_terms * k_epsilon * (sizes + stiffness(place));
}

std::unique_ptr<Landscape> dense_landscape(const Landscape::StepProblem& scene) { return std::make_unique<DenseLandscape>(scene); }

} // namespace steplap
