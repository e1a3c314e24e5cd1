#include "mbd/rest/admissible_rest.h"

#include "mbd/base/decompositions.h"
#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_rank = 1e-9;
constexpr double k_balance = 1e-7;  // largest remaining imbalance, relative to the forces
constexpr double k_give = 4.0;      // largest deformation of contacts, in units of (load scale)/(contact stiffness)
constexpr double k_settled = 1e-12; // largest last change of the pose, relative to the size of the model
constexpr double k_most_usage = 64.0;
constexpr int k_rounds = 10, k_halvings = 40, k_projections = 12;

// Inequalities a z + b ≤ t.
struct Inequalities {
  MatX a;
  VecX b;
};

// Minimises the largest violation t of the inequalities over (z, t), by Newton's method on a logarithmic barrier.
class LeastViolation {
public:
  explicit LeastViolation(Eigen::Index dimension) : z_(VecX::Zero(dimension)) {}

  double solve(const Inequalities& c) {
    VecX value = c.a * z_ + c.b;
    t_ = value.maxCoeff() + 1.0;
    for (double sharp = 1.0; sharp < 1e11; sharp *= 8.0)
      for (int i = 0; i < 40 && newton(c, sharp); ++i) {}
    return (c.a * z_ + c.b).maxCoeff();
  }
  [[nodiscard]] const VecX& point() const { return z_; }

private:
  [[nodiscard]] double barrier(const Inequalities& c, const VecX& z, double t, double sharp) const {
    const VecX slack = VecX::Constant(c.b.size(), t) - c.a * z - c.b;
    if (!(slack.minCoeff() > 0.0)) return std::numeric_limits<double>::infinity();
    double sum = sharp * t + 0.5 * k_tie * z.squaredNorm();
    for (Eigen::Index i = 0; i < slack.size(); ++i) sum -= portable::log10(slack[i]) * k_ln10;
    return sum;
  }
  bool newton(const Inequalities& c, double sharp) {
    const Eigen::Index n = z_.size();
    const VecX inverse = (VecX::Constant(c.b.size(), t_) - c.a * z_ - c.b).cwiseInverse();
    MatX rows(c.a.rows(), n + 1);
    rows << -c.a, VecX::Ones(c.a.rows());
    VecX gradient = -(rows.transpose() * inverse);
    gradient.head(n) += k_tie * z_;
    gradient[n] += sharp;
    MatX hessian = rows.transpose() * inverse.cwiseAbs2().asDiagonal() * rows;
    hessian.diagonal().head(n).array() += k_tie;
    const VecX step = solve_symmetric(hessian, VecX(-gradient));
    const double slope = gradient.dot(step), start = barrier(c, z_, t_, sharp);
    if (!(slope < -1e-9)) return false;
    for (double factor = 1.0; factor > 1e-10; factor *= 0.5) {
      const VecX z = z_ + factor * step.head(n);
      const double t = t_ + factor * step[n];
      if (!(barrier(c, z, t, sharp) <= start + 0.1 * factor * slope)) continue;
      z_ = z;
      t_ = t;
      return true;
    }
    return false;
  }

  static constexpr double k_tie = 1e-9; // weight of |z|²/2, which keeps unknowns near zero that no inequality determines
  static constexpr double k_ln10 = 2.302585092994046;
  VecX z_;
  double t_ = 0.0;
};

class Search {
public:
  Search(const System& system, const State& state, const VecX& scale, double length)
      : system_(system), state_(state), given_(state), statics_(system), scale_(scale), length_(length) {}

  std::optional<AdmissibleRest> run() {
    for (int round = 0; round < k_rounds; ++round) {
      if (!linearise() || !find_usage()) return std::nullopt;
      const double moved = move();
      if (!(moved >= 0.0)) return std::nullopt;
      if (moved <= k_settled * length_ || usage_ > 1.0) break;
    }
    for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f)
      if (state_.friction[f].phase == FrictionPhase::stick) anchor_friction(system_, state_, f);
    return AdmissibleRest{state_, usage_};
  }

private:
  [[nodiscard]] bool is_bounded(const StaticRow& row) const {
    if (row.friction < 0) return false;
    const FrictionElement& element = *system_.frictions[row.friction].friction;
    return element.dimension() == 1 && !element.never_slips();
  }

  void split_rows() {
    hard_.clear();
    bounded_.clear();
    for (int r = 0; r < static_cast<int>(statics_.rows().size()); ++r) (is_bounded(statics_.rows()[r]) ? bounded_ : hard_).push_back(r);
  }

  // Determines the free motions η of the joints, and writes the balance of forces along them as A x = right, for x = (κ η, w).
  bool linearise() {
    statics_.evaluate(state_);
    statics_.collect_rows(state_);
    split_rows();
    const int n = statics_.coordinates();
    const MatX rows = (statics_.gradient() * scale_.asDiagonal()).transpose();
    if (lambda_.size() != static_cast<Eigen::Index>(statics_.rows().size()))
      lambda_ = VecX::Zero(static_cast<Eigen::Index>(statics_.rows().size()));
    free_ = MatX::Identity(n, n);
    if (!hard_.empty()) {
      hard_rows_ = MatX(n, static_cast<Eigen::Index>(hard_.size()));
      for (std::size_t i = 0; i < hard_.size(); ++i) hard_rows_.col(static_cast<Eigen::Index>(i)) = rows.col(hard_[i]);
      free_ = PivotedQr(hard_rows_, k_rank).complement();
    }
    const VecX force = scale_.cwiseProduct(statics_.force());
    const MatX k = scale_.asDiagonal() * statics_.stiffness(lambda_) * scale_.asDiagonal();
    const MatX reduced = free_.transpose() * k * free_;
    kappa_ = reduced.size() > 0 ? reduced.cwiseAbs().maxCoeff() : 0.0;
    if (!(kappa_ > 0.0)) return false;
    const auto count = static_cast<Eigen::Index>(bounded_.size());
    MatX a(free_.cols(), free_.cols() + count);
    a.leftCols(free_.cols()) = reduced / kappa_;
    for (Eigen::Index i = 0; i < count; ++i) a.col(free_.cols() + i) = free_.transpose() * rows.col(bounded_[i]);
    const VecX right = -(free_.transpose() * force);
    at_ = shortest_solution(a, right, k_rank);
    force_scale_ = std::max(force.cwiseAbs().maxCoeff(), at_.cwiseAbs().maxCoeff());
    if (!(force_scale_ > 0.0) || !((a * at_ - right).cwiseAbs().maxCoeff() <= k_balance * force_scale_)) return false;
    ways_ = PivotedQr(a.transpose(), k_rank).complement();
    find_capacities();
    return give_ > 0.0;
  }

  // Determines capacities and normal forces as linear functions of x.
  void find_capacities() {
    std::vector<PairJacobian> parts;
    for (const auto& group : system_.groups) group->add_jacobian(statics_.evaluation(), parts);
    const auto unknowns = at_.size(), count = static_cast<Eigen::Index>(bounded_.size());
    for (int side = 0; side < 2; ++side) {
      capacity_[side] = VecX::Zero(count);
      capacity_by_[side] = MatX::Zero(count, unknowns);
    }
    std::vector<VecX> normals;
    std::vector<double> forces;
    double softest = 0.0, pressed = 0.0;
    for (int side = 0; side < 2; ++side)
      for (Eigen::Index i = 0; i < count; ++i) capacity_[side][i] = support(i, side);
    for (const PairJacobian& part : parts) {
      if (part.contact < 0) continue;
      double& normal = statics_.contact_force(part.contact);
      const double before = normal, more = std::max(1.0, before);
      VecX slope = VecX::Zero(statics_.coordinates());
      for (int l = 0; l < 6; ++l)
        if (const int body = l < 3 ? part.a : part.b; body != k_ground) slope[3 * body - 3 + l % 3] += part.normal[l];
      VecX by = VecX::Zero(unknowns);
      by.head(free_.cols()) = free_.transpose() * scale_.cwiseProduct(slope) / kappa_;
      normal = before + more;
      for (int side = 0; side < 2; ++side)
        for (Eigen::Index i = 0; i < count; ++i)
          capacity_by_[side].row(i) += (support(i, side) - capacity_[side][i]) / more * by.transpose();
      normal = before;
      if (before <= 0.0) continue;
      pressed = std::max(pressed, before);
      const double stiffness = slope.cwiseAbs().maxCoeff();
      softest = softest == 0.0 ? stiffness : std::min(softest, stiffness);
      normals.push_back(by);
      forces.push_back(before);
    }
    if (give_ == 0.0 && softest > 0.0) give_ = k_give * std::max(pressed, statics_.force().cwiseAbs().maxCoeff()) / softest;
    normal_ = VecX::Map(forces.data(), static_cast<Eigen::Index>(forces.size()));
    normal_by_ = MatX(normal_.size(), unknowns);
    for (Eigen::Index i = 0; i < normal_.size(); ++i) normal_by_.row(i) = normals[static_cast<std::size_t>(i)].transpose();
  }
  // Returns the friction capacity that resists increasing (side 0) or decreasing (side 1) values of the row. A freewheel resists on one
  // side only.
  [[nodiscard]] double support(Eigen::Index i, int side) const {
    const double rate = side == 0 ? -1.0 : 1.0;
    const int f = statics_.rows()[bounded_[static_cast<std::size_t>(i)]].friction;
    return system_.frictions[f].friction->support(statics_.evaluation(), state_.friction[f], &rate);
  }

  [[nodiscard]] Inequalities constraints(double usage) const {
    const Eigen::Index count = capacity_[0].size(), unknowns = at_.size();
    const Eigen::Index places = statics_.coordinates(), forces = 2 * count + normal_.size();
    MatX rows = MatX::Zero(forces + 2 * places, unknowns);
    VecX constant(rows.rows());
    for (Eigen::Index i = 0; i < count; ++i)
      for (int side = 0; side < 2; ++side) {
        rows.row(2 * i + side) = -usage * capacity_by_[side].row(i);
        rows(2 * i + side, unknowns - count + i) += side == 0 ? 1.0 : -1.0;
        constant[2 * i + side] = -usage * capacity_[side][i];
      }
    rows.middleRows(2 * count, normal_.size()) = -normal_by_;
    constant.segment(2 * count, normal_.size()) = -normal_;
    // |δq| is bounded by the deformation that contacts can have. Farther away other contacts may be closed, and these inequalities would
    // be wrong.
    rows.block(forces, 0, places, free_.cols()) = free_ / kappa_ * (force_scale_ / give_);
    rows.block(forces + places, 0, places, free_.cols()) = -rows.block(forces, 0, places, free_.cols());
    for (Eigen::Index k = 0; k < places; ++k) {
      const double moved = (state_.q[k + 3] - given_.q[k + 3]) / scale_[k] * (force_scale_ / give_);
      constant[forces + k] = moved - force_scale_;
      constant[forces + places + k] = -moved - force_scale_;
    }
    return {rows * ways_, (rows * at_ + constant) / force_scale_};
  }

  bool find_usage() {
    LeastViolation program(ways_.cols());
    constexpr double k_met = 1e-9;
    const auto is_met = [&](double usage) { return program.solve(constraints(usage)) <= k_met; };
    double high = 1.0, low = 0.0;
    while (high <= k_most_usage && !is_met(high)) {
      low = high;
      high *= 2.0;
    }
    if (high > k_most_usage) return false;
    VecX best = program.point();
    for (int i = 0; i < k_halvings; ++i) {
      const double middle = 0.5 * (low + high);
      if (is_met(middle)) {
        high = middle;
        best = program.point();
      } else {
        low = middle;
      }
    }
    usage_ = high;
    at_ += force_scale_ * (ways_ * best);
    for (std::size_t i = 0; i < bounded_.size(); ++i) lambda_[bounded_[i]] = at_[free_.cols() + static_cast<Eigen::Index>(i)];
    return true;
  }

  // Moves the pose by the solution and projects it onto the joints. Returns the largest displacement of the solution.
  double move() {
    const VecX step = free_ * at_.head(free_.cols()) / kappa_;
    for (int k = 0; k < statics_.coordinates(); ++k) state_.q[k + 3] += scale_[k] * step[k];
    for (int i = 0; i < k_projections && !hard_.empty(); ++i) {
      statics_.evaluate(state_);
      const VecX off = statics_.off();
      const MatX rows = statics_.gradient() * scale_.asDiagonal();
      MatX hard(static_cast<Eigen::Index>(hard_.size()), rows.cols());
      VecX left(hard.rows());
      for (Eigen::Index r = 0; r < hard.rows(); ++r) {
        hard.row(r) = rows.row(hard_[static_cast<std::size_t>(r)]);
        left[r] = off[hard_[static_cast<std::size_t>(r)]];
      }
      if (left.cwiseAbs().maxCoeff() <= 1e-14 * length_) break;
      const VecX back = shortest_solution(hard, left, k_rank);
      for (int k = 0; k < statics_.coordinates(); ++k) state_.q[k + 3] -= scale_[k] * back[k];
    }
    return step.cwiseAbs().maxCoeff();
  }

  const System& system_;
  State state_;
  const State& given_;
  Statics statics_;
  const VecX& scale_;
  double length_, give_ = 0.0, kappa_ = 1.0, force_scale_ = 1.0, usage_ = 0.0;
  std::vector<int> hard_, bounded_;
  VecX lambda_, at_, normal_;
  VecX capacity_[2]; ///< by side, see support()
  MatX hard_rows_, free_, ways_, normal_by_;
  MatX capacity_by_[2];
};

} // namespace

std::optional<AdmissibleRest> admissible_rest(const System& system, const State& state, const VecX& scale, double length) {
  return Search(system, state, scale, length).run();
}

} // namespace steplap
