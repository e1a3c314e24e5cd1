#include "tools/assess/sliding_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace steplap::assess {

// An interval in which the load changes linearly.
struct SlidingPoint::Piece {
  const PointLoad &begin, &end;
  double duration;
  [[nodiscard]] PointLoad at(double t) const {
    const double share = t / duration;
    return {begin.drive + share * (end.drive - begin.drive), begin.normal + share * (end.normal - begin.normal)};
  }
};

SlidingPoint::SlidingPoint(double mass, double mu_static, double mu_kinetic, double largest_step, const Vec2& velocity)
    : mass_(mass), mu_static_(mu_static), mu_kinetic_(mu_kinetic), largest_step_(largest_step), velocity_(velocity),
      rests_(velocity == Vec2::Zero()) {}

// Returns the first time after `from` at which |D| exceeds μ_s N; infinity if there is none in this interval.
double SlidingPoint::onset(const Piece& piece, double from) const {
  const PointLoad load = piece.at(from);
  const Vec2 rate = (piece.end.drive - piece.begin.drive) / piece.duration;
  const double bound = mu_static_ * load.normal, bound_rate = mu_static_ * (piece.end.normal - piece.begin.normal) / piece.duration;
  // |D|² - (mu_s N)² = a τ² + 2 b τ + c
  const double a = rate.squaredNorm() - bound_rate * bound_rate, b = load.drive.dot(rate) - bound * bound_rate,
               c = load.drive.squaredNorm() - bound * bound;
  constexpr double k_never = std::numeric_limits<double>::infinity();
  double after = 0.0;
  if (!(c > 0.0)) {
    const double square = b * b - a * c;
    if (!(square > 0.0)) return k_never;
    if (b > 0.0) after = -c / (b + std::sqrt(square));
    else if (a > 0.0) after = (std::sqrt(square) - b) / a;
    else return k_never;
  }
  return from + after < piece.duration ? from + after : k_never;
}

std::optional<double> SlidingPoint::time_to_stop(const PointLoad& load) const {
  const double c = mu_kinetic_ * load.normal, d = load.drive.norm();
  if (!(c > d)) return {};
  return mass_ * (load.drive.dot(velocity_) + c * velocity_.norm()) / ((c - d) * (c + d));
}

// Returns a step that limits the rotation of the velocity, whose rate is |v × D|/(m v²), to 0.03 rad.
double SlidingPoint::step_for(const PointLoad& load) const {
  // rad per step; smallest fraction of the largest step, needed because the direction is undefined when the point reverses
  constexpr double k_turn = 0.03, k_least = 1e-4;
  const double turning = std::abs(cross(velocity_, load.drive)), square = mass_ * velocity_.squaredNorm();
  if (!(turning * largest_step_ > k_turn * square) || square == 0.0) return largest_step_;
  return std::max(k_least * largest_step_, k_turn * square / turning);
}

void SlidingPoint::stop(const PointLoad& load, double after) {
  const double c = mu_kinetic_ * load.normal / mass_, d = load.drive.norm() / mass_, s = velocity_.norm();
  const Vec2 along = d > 0.0 ? Vec2(load.drive / load.drive.norm()) : Vec2(velocity_ / s);
  const double vx = along.dot(velocity_), vy = cross(along, velocity_);
  const double x = (c * s * vx + 0.5 * d * (vx * vx + s * s)) / (2.0 * (c - d) * (c + d));
  path_ += std::max(0.0, (2.0 * d * x + s * s) / (2.0 * c));
  position_ += x * along + vy * (2.0 * c * s + d * vx) / ((2.0 * c - d) * (2.0 * c + d)) * perp(along);
  velocity_.setZero();
  time_ += after;
  rests_ = true;
  last_rest_ = time_;
}

void SlidingPoint::step(const Piece& piece, double from, double h) {
  constexpr double k_gamma = 0.43586652150845899942; // coefficient γ of the method: root of γ³ − 3 γ² + 3 γ/2 = 1/6
  constexpr double k_b1 = -0.25 * (6.0 * k_gamma * k_gamma - 16.0 * k_gamma + 1.0),
                   k_b2 = 0.25 * (6.0 * k_gamma * k_gamma - 20.0 * k_gamma + 5.0);
  constexpr std::array<double, 3> k_node{k_gamma, 0.5 * (1.0 + k_gamma), 1.0}, k_weight{k_b1, k_b2, k_gamma};
  constexpr std::array<std::array<double, 2>, 3> k_before{{{0.0, 0.0}, {0.5 * (1.0 - k_gamma), 0.0}, {k_b1, k_b2}}};
  std::array<Vec2, 3> rate;
  Vec2 v = velocity_, moved = Vec2::Zero();
  double length = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    Vec2 w = velocity_;
    for (std::size_t j = 0; j < i; ++j) w += h * k_before[i][j] * rate[j];
    const PointLoad load = piece.at(from + k_node[i] * h);
    const Vec2 pulled = w + k_gamma * h / mass_ * load.drive;
    const double size = pulled.norm(), shorter = k_gamma * h / mass_ * mu_kinetic_ * load.normal;
    v = size > shorter ? Vec2((1.0 - shorter / size) * pulled) : Vec2::Zero();
    rate[i] = (v - w) / (k_gamma * h);
    moved += h * k_weight[i] * v;
    length += h * k_weight[i] * v.norm();
  }
  velocity_ = v;
  position_ += moved;
  path_ += std::max(0.0, length);
  time_ += h;
  const PointLoad load = piece.at(from + h);
  rests_ = v == Vec2::Zero() && load.drive.norm() <= mu_static_ * load.normal;
  if (rests_) last_rest_ = time_;
}

void SlidingPoint::advance(const PointLoad& begin, const PointLoad& end, double duration) {
  if (!(duration > 0.0)) return;
  const Piece piece{begin, end, duration};
  const double started = time_;
  for (double t = 0.0; t < duration;) {
    if (rests_) {
      t = onset(piece, t);
      if (!(t < duration)) break;
      rests_ = false;
      if (!first_slip_) first_slip_ = started + t;
      time_ = started + t;
    }
    const double most = step_for(piece.at(t)), left = duration - t, h = left < 1.5 * most ? left : most;
    if (velocity_ != Vec2::Zero()) {
      const std::optional<double> guess = time_to_stop(piece.at(t));
      if (guess && *guess < 2.0 * h) {
        const PointLoad mean = piece.at(std::min(t + 0.5 * *guess, duration));
        const std::optional<double> after = time_to_stop(mean);
        if (after && *after <= h) {
          stop(mean, *after);
          t += *after;
          continue;
        }
      }
    }
    step(piece, t, h);
    t += h;
  }
  time_ = started + duration;
}

bool SlidingPoint::come_to_rest(const PointLoad& load) {
  if (rests_) return true;
  const std::optional<double> after = time_to_stop(load);
  if (!after) return false;
  if (*after > 0.0) stop(load, *after);
  rests_ = true;
  return true;
}

} // namespace steplap::assess
