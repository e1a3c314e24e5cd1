#include "mbd/run/tipping_mechanism.h"

#include "mbd/base/decompositions.h"
#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace steplap {

namespace {

constexpr double k_rank = 1e-8;       // relative tolerance for the rank of the rows
constexpr double k_balanced = 1e-10;  // unbalanced remainder, relative to the loads, that counts as rounding
constexpr double k_same_tilt = 1e-12; // convergence of the tilt, rad
constexpr int k_most_checks = 200;    // largest number of iterations for a tilt
constexpr double k_right_angle = 0.5 * std::numbers::pi;

MatX columns_of(const MatX& a, const std::vector<int>& which) {
  MatX some(a.rows(), static_cast<Eigen::Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i) some.col(static_cast<Eigen::Index>(i)) = a.col(which[i]);
  return some;
}

// Solves min |a x − b| with x ≥ 0 (C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, 1974, ch. 23).
VecX nonnegative_solution(const MatX& a, const VecX& b, double rounding) {
  VecX x = VecX::Zero(a.cols());
  std::vector<int> held; // columns with x > 0
  for (Eigen::Index round = 0; round < 10 * a.cols() + 10; ++round) {
    VecX pull = a.transpose() * (b - a * x);
    for (const int i : held) pull[i] = 0.0;
    Eigen::Index most = 0;
    if (a.cols() == 0 || !(pull.maxCoeff(&most) > rounding)) break;
    held.push_back(static_cast<int>(most));
    while (!held.empty()) {
      const VecX wanted = least_squares(columns_of(a, held), b);
      double share = 1.0;
      for (std::size_t i = 0; i < held.size(); ++i)
        if (const double w = wanted[static_cast<Eigen::Index>(i)]; w < 0.0) share = std::min(share, x[held[i]] / (x[held[i]] - w));
      std::vector<int> left;
      for (std::size_t i = 0; i < held.size(); ++i) {
        const double w = wanted[static_cast<Eigen::Index>(i)];
        double& own = x[held[i]];
        own += share * (w - own);
        if (w < 0.0 && !(own > rounding)) own = 0.0;
        else left.push_back(held[i]);
      }
      const bool is_done = left.size() == held.size();
      held = left;
      if (is_done) break;
    }
  }
  return x;
}

// Returns the first root of a cos φ + b sin φ + c = 0 after `from` in the direction `sign`; nothing if there is no root.
std::optional<double> root_beyond(double a, double b, double c, double from, double sign) {
  const double size = portable::hypot(a, b);
  if (!(size > std::abs(c))) return std::nullopt;
  const double middle = portable::atan2(b, a), reach = portable::atan2(std::sqrt(size * size - c * c), -c);
  double nearest = 2.0 * std::numbers::pi;
  for (const double root : {middle - reach, middle + reach}) {
    double ahead = std::remainder(sign * (root - from), 2.0 * std::numbers::pi);
    if (ahead < 0.0) ahead += 2.0 * std::numbers::pi;
    nearest = std::min(nearest, ahead);
  }
  return from + sign * nearest;
}

class TiltSearch {
public:
  explicit TiltSearch(const Blocks& blocks) : blocks_(blocks) {
    basis_ = MatX::Identity(blocks.weight.size(), blocks.weight.size());
    if (blocks.joints.rows() > 0) basis_ = PivotedQr(blocks.joints.transpose(), k_rank).complement();
    gaps_ = blocks.gaps * basis_;
    rounding_ = k_balanced * (blocks.weight.norm() + blocks.turned.norm() + blocks.loads.norm());
  }

  // Newton's method for the tilt: the next tilt is the root of the power of that motion which has most power at the present tilt.
  std::optional<Collapse> run(double sign) {
    Collapse found;
    balance(0.0);
    found.stands = left_.norm() <= rounding_;
    double tilt = found.stands ? sign * k_right_angle : 0.0;
    for (int look = 0; look < k_most_checks; ++look) {
      balance(tilt);
      if (left_.norm() <= rounding_) break;
      found.motion = (basis_ * left_).normalized();
      const VecX& m = found.motion;
      const double a = blocks_.weight.dot(m), b = blocks_.turned.dot(m), c = blocks_.loads.dot(m);
      const auto next = root_beyond(a, b, c, tilt, found.stands ? -sign : sign);
      if (!next || !(std::abs(*next) < k_right_angle) || (found.stands && *next * sign < 0.0)) return std::nullopt;
      const double last = std::exchange(tilt, *next);
      if (std::abs(tilt - last) <= k_same_tilt) break;
    }
    if (found.motion.size() == 0) return std::nullopt;
    found.turned = tilt;
    balance(tilt);
    found.gap_forces = forces_;
    const VecX unmet = -(load(tilt) + blocks_.gaps.transpose() * forces_);
    found.joint_forces = blocks_.joints.rows() > 0 ? shortest_solution(blocks_.joints.transpose(), unmet, k_rank) : VecX();
    return found;
  }

private:
  [[nodiscard]] VecX load(double tilt) const {
    return portable::cos(tilt) * blocks_.weight + portable::sin(tilt) * blocks_.turned + blocks_.loads;
  }
  // Projects the loads at `tilt` onto those that contact forces ≥ 0 can balance, and stores the remainder in left_, which is zero in
  // balance. Otherwise it is the motion of the collapse: it opens gaps or keeps them closed, and its power is |left_|².
  void balance(double tilt) {
    const VecX driving = basis_.transpose() * load(tilt);
    forces_ = nonnegative_solution(gaps_.transpose(), -driving, rounding_);
    left_ = driving + gaps_.transpose() * forces_;
  }

  const Blocks& blocks_;
  MatX basis_, gaps_;
  double rounding_ = 0.0;
  VecX forces_, left_;
};

} // namespace

std::optional<Collapse> collapse_of(const Blocks& blocks, double sign) { return TiltSearch(blocks).run(sign); }

} // namespace steplap
