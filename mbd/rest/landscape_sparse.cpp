#include "mbd/base/decompositions.h"
#include "mbd/rest/bordered_system.h"
#include "mbd/rest/landscape.h"
#include "mbd/rest/sparse_rows.h"
#include "mbd/rest/spread.h"

#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

using Sparse = BorderedSystem::Sparse;
using MatrixEntry = Statics::MatrixEntry;

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
// Multiple of the largest eigenvalue below which eigenvalues may be rounding errors of the stiffness and its factors.
constexpr double k_loose = 1000.0 * k_epsilon;
constexpr double k_small = 1e-11; // fraction of the size of the model; smaller steps are rounding of the pose
constexpr int k_most_filters = 8;
constexpr double k_well_inside = 0.5; // fraction of the trust region's radius; steps longer than this are accepted
constexpr double k_close = 1.2;       // ratio of the bounds of σ at which the search ends: another factorisation is not worth its cost
constexpr int k_most_shifts = 60;
constexpr int k_named = 24; // largest number of directions that are described
constexpr double k_skew = 1e-9;

double largest(const VecX& x) { return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0; }

class SparseLandscape final : public Landscape {
public:
  explicit SparseLandscape(const StepProblem& scene) : Landscape(scene), n_(scene.statics.coordinates()) {
    identity_.resize(static_cast<int>(n_), static_cast<int>(n_));
    identity_.setIdentity();
  }

  void linearise(const State& state) override {
    held_.measure_and_rank(scene_.statics, scene_.scale);
    factor_rows();
    VecX reaction;
    const VecX whole = scaled_force();
    force_ = whole;
    reaction = VecX::Zero(held_.size().size());
    if (!rows().empty() && !onto_rows_.solve(whole, force_, &reaction)) force_ = whole;
    lambda_ = -reaction.cwiseQuotient(held_.size());
    find_stiffness(whole);
    VecX pull = VecX::Zero(n_);
    for (std::size_t r = 0; r < rows().size(); ++r)
      for (int k = 0; k < rows()[r].count; ++k) pull[rows()[r].at[k]] += std::abs(rows()[r].j[k] * reaction[static_cast<Eigen::Index>(r)]);
    rounding_ = rounding_of(state, whole.cwiseAbs() + pull, [this](const VecX& place) { return VecX(size_ * (hat_.cwiseAbs() * place)); });
    steps_.set(hat_, rows(), inertia_);
    factored_ = std::numeric_limits<double>::quiet_NaN();
    is_newton_known_ = false;
    used_sigma_ = loose_;
  }

  VecX newton_step() override {
    find_newton();
    return newton_;
  }
  bool is_pushed() override {
    find_newton();
    return is_pushed_;
  }
  bool is_skew() const override { return is_skew_; }
  double imbalance() const override { return std::sqrt(force_.cwiseAbs2().cwiseQuotient(scene_.mass).sum()); }

  // Finds σ by bisection between values that are too small (the step is too long, or the stiffness not positive) and values at which the
  // step is too short. For large σ the step is proportional to 1/σ.
  VecX trust_step(const StepSize& size) override {
    used_sigma_ = loose_;
    if (!is_skew_) {
      find_newton();
      if (is_newton_downhill_ && !is_pushed_ && size(newton_) <= 1.0) return newton_;
    }
    double low = 0.0, high = 0.0, low_size = 0.0;
    VecX best = VecX::Zero(n_), step;
    double sigma = std::max(last_sigma_, loose_);
    for (int i = 0; i < k_most_shifts; ++i) {
      const bool is_downhill = factor(sigma) && steps_.negative() == 0 && steps_.solve(force_ / size_, step);
      const double now = is_downhill ? size(step) : 0.0;
      if (is_downhill && now <= 1.0) {
        high = sigma;
        best = step;
        if (now >= k_well_inside || sigma <= loose_) break;
        sigma = std::max(loose_, 1.25 * now * sigma);
        if (low > 0.0) sigma = std::max(sigma, std::sqrt(low * high));
      } else {
        low = sigma;
        low_size = now;
        sigma *= low_size > 0.0 ? std::max(2.0, 1.25 * low_size) : 8.0;
        if (high > 0.0) sigma = std::sqrt(low * high);
      }
      if (high > 0.0 && low > 0.0 && high < k_close * low) break;
    }
    used_sigma_ = last_sigma_ = high;
    if (high > loose_ && size(best) < k_well_inside) add_soft_direction(size, best);
    return best;
  }

  // Brackets the least eigenvalue between −σ for two σ. The direction follows by inverse iteration.
  std::optional<Unstable> most_unstable_direction() override {
    if (is_definite(loose_)) return std::nullopt;
    double low = loose_, high = 8.0 * loose_;
    for (; !is_definite(high) && std::isfinite(high); high *= 8.0) low = high;
    while (high > k_close * low) {
      const double middle = std::sqrt(low * high);
      (is_definite(middle) ? high : low) = middle;
    }
    if (!factor(high)) return std::nullopt;
    VecX x = Spread().vector(n_), next;
    for (int i = 0; i < 40; ++i) {
      if (!steps_.solve(inertia_.cwiseProduct(x), next)) return std::nullopt;
      x = next / std::sqrt(next.cwiseAbs2().dot(scene_.mass));
    }
    return Unstable{x, x.dot(force_), x.cwiseAbs().dot(rounding_)};
  }

  // Counts the directions that only friction would resist, too: the dependence of sliding friction on normal forces is not part of the
  // symmetric stiffness used here.
  int count_yielding() override { return negative_at(-loose_); }

  VecX acceleration() override {
    BorderedSystem by_mass;
    const double unit = scene_.mass.maxCoeff();
    std::vector<MatrixEntry> entries;
    for (int i = 0; i < static_cast<int>(n_); ++i) entries.emplace_back(i, i, scene_.mass[i] / unit);
    Sparse mass(static_cast<int>(n_), static_cast<int>(n_));
    mass.setFromTriplets(entries.begin(), entries.end());
    by_mass.set(mass, rows(), VecX::Zero(n_));
    VecX x;
    if (!by_mass.factor(0.0) || !by_mass.solve(force_ / unit, x)) return force_.cwiseQuotient(scene_.mass);
    return x;
  }

  std::vector<MotionPart> indifferent(int& unnamed) override {
    std::vector<MotionPart> parts;
    const int all = negative_at(-loose_) - negative_at(loose_);
    unnamed = std::max(0, all);
    if (all <= 0) return parts;
    const std::vector<char> is_bare = bare_coordinates();
    int bare = 0;
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (is_bare[static_cast<std::size_t>(i)] == 0) continue;
      if (++bare <= k_named) parts.push_back({static_cast<int>(i) / 3 + 1, static_cast<int>(i) % 3, 1.0});
    }
    const int others = std::min(all - bare, k_named - static_cast<int>(parts.size()));
    if (others > 0) name_directions(others, is_bare, parts);
    unnamed = all - static_cast<int>(parts.size());
    return parts;
  }

  double displacement_to_rows(const VecX& off, VecX& way) override {
    held_.measure(scene_.statics, scene_.scale);
    factor_rows();
    way = VecX::Zero(n_);
    if (rows().empty()) return 0.0;
    VecX left = off.cwiseQuotient(held_.size());
    for (std::size_t r = 0; r < rows().size(); ++r)
      if (held_.is_dependent(r)) left[static_cast<Eigen::Index>(r)] = 0.0;
    if (!onto_rows_.solve(VecX::Zero(n_), way, nullptr, &left)) return std::numeric_limits<double>::quiet_NaN();
    return largest(way);
  }

  const VecX& row_size() const override { return held_.size(); }

  VecX along_rows(const VecX& vector) const override {
    VecX allowed;
    return !rows().empty() && onto_rows_.solve(vector, allowed) ? allowed : vector;
  }

  VecX stiff_imbalance(double& size) override {
    VecX move;
    size = 0.0;
    if (!factor(used_sigma_) || !steps_.solve(along_rows(scaled_force()) / size_, move)) return VecX::Zero(n_);
    for (int i = 0; i < 2 && used_sigma_ > loose_; ++i)
      if (!keep_firm(used_sigma_, move)) return VecX::Zero(n_);
    size = largest(move);
    return move;
  }

private:
  // Extends the step to the border of the trust region by the eigenvector of the least eigenvalue, for the case that forces hardly act
  // along it. Both signs of the eigenvector lead downhill.
  void add_soft_direction(const StepSize& size, VecX& step) {
    VecX soft = Spread().vector(n_), next;
    if (!factor(used_sigma_)) return;
    for (int i = 0; i < 6; ++i) {
      if (!steps_.solve(inertia_.cwiseProduct(soft), next)) return;
      soft = next / std::sqrt(next.cwiseAbs2().dot(scene_.mass));
    }
    // Iteration may not have found a direction of negative stiffness: its Rayleigh quotient must be negative.
    if (!(soft.dot(VecX(hat_ * soft)) < 0.0)) return;
    if (soft.dot(force_) < 0.0) soft = -soft;
    const double whole = size(soft);
    if (whole > 0.0) step += (1.0 - size(step)) / whole * soft;
  }

  // Factorises the rows for the projection onto the motions that they allow.
  void factor_rows() {
    if (rows().empty()) return;
    onto_rows_.set(identity_, rows(), VecX::Zero(n_));
    (void)onto_rows_.factor(0.0);
  }
  [[nodiscard]] const std::vector<SparseRow>& rows() const { return held_.rows(); }

  void find_stiffness(const VecX& whole_force) {
    std::vector<MatrixEntry> entries, both;
    scene_.statics.stiffness(lambda_, entries, false);
    both.reserve(2 * entries.size() + static_cast<std::size_t>(n_));
    for (const MatrixEntry& e : entries) {
      const double half = -0.5 * e.value() * scene_.scale[e.row()] * scene_.scale[e.col()];
      both.emplace_back(e.row(), e.col(), half);
      both.emplace_back(e.col(), e.row(), half);
    }
    for (int i = 0; i < static_cast<int>(n_); ++i) both.emplace_back(i, i, 0.0);
    hat_.resize(static_cast<int>(n_), static_cast<int>(n_));
    hat_.setFromTriplets(both.begin(), both.end());
    VecX sum = VecX::Zero(n_), root = scene_.mass.cwiseSqrt();
    double most = 0.0;
    for (int c = 0; c < hat_.outerSize(); ++c)
      for (Sparse::InnerIterator it(hat_, c); it; ++it) {
        most = std::max(most, std::abs(it.value()));
        sum[c] += std::abs(it.value()) / (root[it.row()] * root[c]);
      }
    const VecX by_force = whole_force.cwiseAbs() / scene_.length;
    size_ = std::max({most, largest(by_force), std::numeric_limits<double>::min()});
    loose_ = k_loose * std::max({largest(sum), largest(by_force.cwiseQuotient(scene_.mass)), 1e-290});
    hat_ /= size_;
    inertia_ = scene_.mass / size_;
    find_skew();
  }

  void find_skew() {
    std::vector<MatrixEntry> entries;
    scene_.statics.stiffness(lambda_, entries, true);
    for (MatrixEntry& e : entries) e = MatrixEntry(e.row(), e.col(), -e.value() * scene_.scale[e.row()] * scene_.scale[e.col()] / size_);
    whole_hat_.resize(static_cast<int>(n_), static_cast<int>(n_));
    whole_hat_.setFromTriplets(entries.begin(), entries.end());
    const Sparse turned = whole_hat_.transpose();
    const Sparse skew = whole_hat_ - turned;
    is_skew_ = skew.cwiseAbs().sum() > k_skew * whole_hat_.cwiseAbs().sum();
  }

  bool factor(double sigma) {
    if (sigma == factored_) return true;
    factored_ = std::numeric_limits<double>::quiet_NaN();
    if (!steps_.factor(sigma)) return false;
    factored_ = sigma;
    return true;
  }
  bool is_definite(double sigma) { return factor(sigma) && steps_.negative() == 0; }
  // Returns the number of eigenvalues below −σ. If a pivot vanishes, σ is increased slightly.
  int negative_at(double sigma) {
    for (int i = 0; i < 4; ++i, sigma *= 1.1)
      if (factor(sigma)) return steps_.negative();
    return 0;
  }

  // Multiplies the component of x along each eigenvector by λ/(λ + σ), which removes directions without stiffness. Returns false if the
  // solution fails.
  bool keep_firm(double sigma, VecX& x) const {
    VecX loose;
    if (!apply(sigma * inertia_.cwiseProduct(x), loose)) return false;
    x -= loose;
    return true;
  }
  bool apply(const VecX& f, VecX& x) const {
    if (!is_skew_) return steps_.solve(f, x);
    VecX right = VecX::Zero(n_ + static_cast<Eigen::Index>(rows().size()));
    right.head(n_) = f;
    const VecX z = skew_factors_.solve(right);
    x = z.head(n_);
    return skew_factors_.info() == Eigen::Success && x.allFinite();
  }
  bool factor_skew() {
    std::vector<MatrixEntry> entries;
    for (int c = 0; c < whole_hat_.outerSize(); ++c)
      for (Sparse::InnerIterator it(whole_hat_, c); it; ++it) entries.emplace_back(static_cast<int>(it.row()), c, it.value());
    const int n = static_cast<int>(n_), m = static_cast<int>(rows().size());
    for (int i = 0; i < n; ++i) entries.emplace_back(i, i, loose_ * inertia_[i]);
    for (int r = 0; r < m; ++r) {
      entries.emplace_back(n + r, n + r, -1e-12); // keeps pivots of dependent rows non-zero
      for (int k = 0; k < rows()[r].count; ++k) {
        entries.emplace_back(n + r, rows()[r].at[k], rows()[r].j[k]);
        entries.emplace_back(rows()[r].at[k], n + r, rows()[r].j[k]);
      }
    }
    Sparse bordered(n + m, n + m);
    bordered.setFromTriplets(entries.begin(), entries.end());
    skew_factors_.compute(bordered);
    return skew_factors_.info() == Eigen::Success;
  }

  void find_newton() {
    if (is_newton_known_) return;
    is_newton_known_ = true;
    is_pushed_ = false;
    is_newton_downhill_ = is_definite(loose_);
    const bool is_factored = is_skew_ ? factor_skew() : factor(loose_);
    if (!is_factored || !apply(force_ / size_, newton_)) {
      newton_ = VecX::Constant(n_, 1e6 * scene_.length); // larger than any trust region, so not usable as a step
      is_newton_downhill_ = false;
      return;
    }
    const VecX first = newton_;
    const double all = largest(first);
    if (all <= k_small * scene_.length) return;
    for (int i = 0; i < k_most_filters; ++i) {
      const double before = largest(newton_);
      if (before <= k_small * scene_.length || !keep_firm(loose_, newton_)) break;
      if (i == 0 && largest(newton_) > 0.5 * before) return;
    }
    VecX loose = first, next;
    for (int i = 0; i < 3; ++i) {
      if (!apply(loose_ * inertia_.cwiseProduct(loose), next)) return;
      loose = next;
    }
    const double size = std::sqrt(loose.cwiseAbs2().dot(scene_.mass));
    is_pushed_ = size > 0.0 && std::abs(loose.dot(force_)) > loose.cwiseAbs().dot(rounding_);
  }

  // Marks the coordinates on which no stiffness and no row acts.
  [[nodiscard]] std::vector<char> bare_coordinates() const {
    std::vector<char> is_bare(static_cast<std::size_t>(n_), 1);
    for (int c = 0; c < hat_.outerSize(); ++c)
      for (Sparse::InnerIterator it(hat_, c); it; ++it)
        if (it.value() != 0.0) is_bare[static_cast<std::size_t>(c)] = 0;
    for (const SparseRow& row : rows())
      for (int k = 0; k < row.count; ++k)
        if (row.j[k] != 0.0) is_bare[static_cast<std::size_t>(row.at[k])] = 0;
    return is_bare;
  }

  // Describes `count` of the directions without stiffness, found by subspace iteration, each by a coordinate that distinguishes it from the
  // others.
  void name_directions(int count, const std::vector<char>& is_bare, std::vector<MotionPart>& parts) {
    if (!factor(loose_)) return;
    const VecX root = scene_.mass.cwiseSqrt();
    Spread spread;
    MatX block(n_, count);
    for (int k = 0; k < count; ++k) {
      block.col(k) = spread.vector(n_);
      for (Eigen::Index i = 0; i < n_; ++i)
        if (is_bare[static_cast<std::size_t>(i)] != 0) block(i, k) = 0.0;
    }
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < count; ++k) {
        VecX next;
        if (!steps_.solve(inertia_.cwiseProduct(VecX(block.col(k))), next)) return;
        block.col(k) = next.cwiseProduct(root);
      }
      block = root.cwiseInverse().asDiagonal() * orthonormal(block, count);
    }
    if (count == 1) {
      parts.push_back(largest_part(block.col(0)));
      return;
    }
    const PivotedQr qr(block.transpose());
    for (int k = 0; k < count; ++k) {
      const int at = qr.column(k);
      parts.push_back({at / 3 + 1, at % 3, 1.0});
    }
  }

  Eigen::Index n_;
  Sparse identity_;
  SparseRows held_;
  BorderedSystem onto_rows_, steps_;
  Sparse hat_, whole_hat_;          ///< −K/size_: symmetric part without sliding friction, and the whole
  double size_ = 1.0, loose_ = 0.0; ///< eigenvalues below loose_ (1/s²) count as zero
  VecX inertia_;                    ///< masses/size_
  VecX rounding_;                   ///< rounding errors of the forces
  bool is_skew_ = false;
  Eigen::SparseLU<Sparse> skew_factors_;
  double factored_ = 0.0, used_sigma_ = 0.0, last_sigma_ = 0.0;
  bool is_newton_known_ = false, is_newton_downhill_ = false, is_pushed_ = false;
  VecX newton_;
};

} // namespace

std::unique_ptr<Landscape> sparse_landscape(const Landscape::StepProblem& scene) { return std::make_unique<SparseLandscape>(scene); }

} // namespace steplap
