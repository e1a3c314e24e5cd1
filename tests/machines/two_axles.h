// A vehicle on two wheels, seen from the side, by an integration of its own: three coordinates of the frame, the spin of each wheel, the bending of each
// tread. Classical Runge–Kutta with short steps; the Coulomb friction of the brakes is applied between steps, as much of it as stops the wheel at most.
#pragma once

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace steplap::testing {

/// The natural cubic spline through points, straight beyond them: y and y′. Solved densely.
class OwnSpline {
public:
  explicit OwnSpline(std::vector<std::array<double, 2>> points) : p_(std::move(points)) {
    const auto n = static_cast<Eigen::Index>(p_.size());
    if (n < 2) return;
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 1; i + 1 < n; ++i) {
      const auto [x0, y0] = at(i - 1);
      const auto [x1, y1] = at(i);
      const auto [x2, y2] = at(i + 1);
      a.row(i) << Eigen::RowVectorXd::Zero(n);
      a(i, i - 1) = (x1 - x0) / 6.0;
      a(i, i) = (x2 - x0) / 3.0;
      a(i, i + 1) = (x2 - x1) / 6.0;
      b[i] = (y2 - y1) / (x2 - x1) - (y1 - y0) / (x1 - x0);
    }
    bend_ = a.partialPivLu().solve(b);
  }
  /// y, y′.
  [[nodiscard]] std::array<double, 2> operator()(double x) const {
    if (p_.size() < 2) return {0.0, 0.0};
    if (x < p_.front()[0] || x > p_.back()[0]) {
      const double end = x < p_.front()[0] ? p_.front()[0] : p_.back()[0];
      const auto [y, slope] = (*this)(end);
      return {y + slope * (x - end), slope};
    }
    Eigen::Index i = 0;
    while (i + 2 < static_cast<Eigen::Index>(p_.size()) && x > at(i + 1)[0]) ++i;
    const double h = at(i + 1)[0] - at(i)[0], l = (at(i + 1)[0] - x) / h, r = 1.0 - l;
    const double y = l * at(i)[1] + r * at(i + 1)[1] + ((l * l * l - l) * bend_[i] + (r * r * r - r) * bend_[i + 1]) * h * h / 6.0;
    const double slope = (at(i + 1)[1] - at(i)[1]) / h + ((1.0 - 3.0 * l * l) * bend_[i] + (3.0 * r * r - 1.0) * bend_[i + 1]) * h / 6.0;
    return {y, slope};
  }

private:
  [[nodiscard]] const std::array<double, 2>& at(Eigen::Index i) const { return p_[static_cast<std::size_t>(i)]; }
  std::vector<std::array<double, 2>> p_;
  Eigen::VectorXd bend_;
};

struct OwnWheel {
  double px = 0.0, py = 0.0; ///< of its pin, from the frame's centre of gravity, m
  double mass = 0.0, inertia = 0.0;
  double brake = 0.0; ///< N m
};

struct TwoAxles {
  double mass = 0.0, inertia = 0.0, radius = 0.3;
  double stiffness = 0.0, damping = 0.0, friction = 0.0, slip_stiffness = 0.0, relaxation = 0.0, tread = 0.0;
  std::array<OwnWheel, 2> wheel; ///< front, rear
  OwnSpline road{{}};
  std::function<double(double t, double lean)> drive = [](double, double) { return 0.0; }; ///< couple on the rear wheel, positive forward
  std::function<double(double t)> pressure = [](double) { return 0.0; };

  // x, y, θ, then their rates, then spins, then bendings.
  using State = Eigen::Matrix<double, 10, 1>;
  State state = State::Zero();
  std::array<double, 2> normal{0.0, 0.0}, grip{0.0, 0.0}; ///< forces of the tyres, N

  State rates(double t, const State& s) {
    const double c = std::cos(s[2]), n = std::sin(s[2]);
    double total = mass, sx = 0.0, sy = 0.0, about = inertia; // Σ m, Σ m p, Σ m p²
    Eigen::Vector3d force(0.0, -9.81 * mass, 0.0);
    State d = State::Zero();
    for (std::size_t i = 0; i < 2; ++i) {
      const OwnWheel& w = wheel[i];
      const auto k = static_cast<Eigen::Index>(i);
      const double rx = c * w.px - n * w.py, ry = n * w.px + c * w.py;
      const double x = s[0] + rx, y = s[1] + ry, vx = s[3] - s[5] * ry, vy = s[4] + s[5] * rx;
      double foot = x; // nearest place, by Newton's method with a slope of differences
      for (int j = 0; j < 30; ++j) {
        const auto off = [&](double at) {
          const auto [h, slope] = road(at);
          return (at - x) + slope * (h - y);
        };
        const double step = off(foot) / ((off(foot + 1e-6) - off(foot - 1e-6)) / 2e-6);
        foot -= step;
        if (std::abs(step) < 1e-13) break;
      }
      const auto [h, slope] = road(foot);
      const double size = std::sqrt(1.0 + slope * slope), tx = 1.0 / size, ty = slope / size;
      const double gap = -ty * (x - foot) + tx * (y - h) - radius, rate = -ty * vx + tx * vy;
      normal[i] = gap < 0.0 ? std::max(0.0, -stiffness * gap - damping * rate) : 0.0;
      const double slip = tx * vx + ty * vy + radius * s[6 + k], bent = s[8 + k], c0 = slip_stiffness / relaxation;
      const double held = slip - std::abs(radius * s[6 + k]) * bent / relaxation, most = friction * normal[i];
      grip[i] = std::clamp(c0 * bent + tread * held, -most, most);
      d[8 + k] = (grip[i] - c0 * bent) / tread;             // adhering this is `held`
      const double couple = i == 1 ? -drive(t, s[2]) : 0.0; // on the wheel
      const double fx = -ty * normal[i] - tx * grip[i], fy = tx * normal[i] - ty * grip[i] - 9.81 * w.mass;
      d[6 + k] = (couple - radius * grip[i]) / w.inertia;
      force += Eigen::Vector3d(fx, fy, rx * fy - ry * fx - couple);
      total += w.mass;
      sx += w.mass * rx;
      sy += w.mass * ry;
      about += w.mass * (rx * rx + ry * ry);
    }
    Eigen::Matrix3d m;
    m << total, 0.0, -sy, 0.0, total, sx, -sy, sx, about;
    force += s[5] * s[5] * Eigen::Vector3d(sx, sy, 0.0);
    d.head<3>() = s.segment<3>(3);
    const Eigen::LDLT<Eigen::Matrix3d> solver(m);
    d.segment<3>(3) = solver.solve(force);
    turned_ = solver.solve(Eigen::Vector3d::UnitZ());
    return d;
  }

  void step(double t, double h) {
    const State a = rates(t, state), b = rates(t + 0.5 * h, state + 0.5 * h * a), c = rates(t + 0.5 * h, state + 0.5 * h * b),
                d = rates(t + h, state + h * c);
    state += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    for (std::size_t i = 0; i < 2; ++i) {
      const auto k = static_cast<Eigen::Index>(6 + i);
      const double against = state[k] - state[5], stops = std::abs(against) / (1.0 / wheel[i].inertia + turned_[2]);
      const double blow = std::copysign(std::min(stops, h * wheel[i].brake * pressure(t + 0.5 * h)), against);
      state[k] -= blow / wheel[i].inertia;
      state.segment<3>(3) += blow * turned_;
    }
  }

private:
  Eigen::Vector3d turned_ = Eigen::Vector3d::Zero(); ///< velocities of the frame by a unit couple's impulse
};

} // namespace steplap::testing
