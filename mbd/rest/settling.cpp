#include "mbd/rest/settling.h"

#include "mbd/base/stop.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/events/blow.h"
#include "mbd/integrators/time_stepping.h"
#include "mbd/rest/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
constexpr double k_first = 1e-4; // displacement of the first step, relative to the size of the model
// Largest displacement of a step, relative to the size of the model, and largest rotation, rad.
constexpr double k_move = 0.05, k_turn = 0.1;
constexpr double k_balanced = 1e-9; // fraction of the initial accelerations; Newton's method removes the remaining imbalance
constexpr double k_shortest = 1e-5; // fraction of the longest step; in shorter steps rounding errors would dominate
constexpr double k_touch = 64.0;    // in roundings of the largest coordinate
constexpr double k_on_rows = 1e-12; // m, rad
// Limits of the number of steps, and of that number times the square of the number of rows and coordinates.
constexpr int k_most_steps = 4000, k_most_steps_near = 400, k_least_steps = 100;
constexpr double k_most_work = 4e8;
// A step that time stepping divides into more parts counts as failed. All steps together may take so many times their number of parts.
constexpr long k_most_parts_of_step = 200;
constexpr double k_most_parts_per_step = 10.0;

class Settler {
public:
  Settler(const System& system, const State& start, std::optional<double> reach)
      : system_(system), dynamics_(system), stepping_(system), start_(start.q), state_(start), scene_(scale_of(system, start)),
        reach_(reach), clearance_(system, k_touch * k_epsilon * scene_.reach) {
    const auto limit = std::upper_bound(system.breakpoints.begin(), system.breakpoints.end(), start.t);
    dynamics_.set_left_limit_time(limit == system.breakpoints.end() ? system.drives_end : *limit);
    dynamics_.use_coordinates(Coordinates::absolute);
    stepping_.hold_time(start.t, reach.has_value());
  }

  Settling run() {
    Settling found;
    const double rows = static_cast<double>(system_.friction_row_count + system_.largest_dimension());
    const double most = k_most_work / (rows * rows);
    found.is_tried = most >= k_least_steps;
    if (!found.is_tried) return found;
    reference_ = largest_at_start();
    if (!(reference_ > 0.0)) {
      found.rest = state_;
      return found;
    }
    double h = std::sqrt(k_first * scene_.length / reference_), longest = h;
    clearance_.measure(state_.q);
    const double most_steps = std::min(most, 1.0 * (reach_ ? k_most_steps_near : k_most_steps));
    const auto is_left = [&] { return found.steps < most_steps && static_cast<double>(parts_) < most_steps * k_most_parts_per_step; };
    for (; is_left() && h > k_shortest * longest; ++found.steps) {
      throw_if_stopped("while the machine settled");
      State next = state_;
      if (!can_step(next, h)) {
        h *= 0.25;
        continue;
      }
      const VecX way = displacement_to(next);
      const double size = std::max(size_of(way), 1.0 / clearance_.share(way));
      if (!(size <= 1.0) || !passes_nothing(next, way)) {
        h *= std::isfinite(size) && size > 1.0 ? std::max(0.1, 0.7 / std::sqrt(size)) : 0.25;
        continue;
      }
      state_ = next;
      found.away = part_beyond_reach();
      if (found.away) break;
      if (acceleration_of(way, h) <= k_balanced * reference_) {
        found.rest = state_;
        break;
      }
      if (size < 0.5) h *= 2.0;
      longest = std::max(longest, h);
    }
    return found;
  }

private:
  [[nodiscard]] bool can_step(State& next, double h) {
    const double t = state_.t;
    next.t = t - h;
    const long last_part = parts_ + k_most_parts_of_step;
    const auto count_part = [&](const State&, const State&) {
      throw_if_stopped("while the machine settled");
      if (++parts_ > last_part) throw NumericalFailure("a step has too many parts");
    };
    try {
      stepping_.step(dynamics_, next, t, k_on_rows, count_part);
    } catch (const RunStopped&) {
      throw;
    } catch (const NumericalFailure&) {
      return false;
    }
    next.t = t;
    std::fill(next.v.begin(), next.v.end(), 0.0);
    return true;
  }

  [[nodiscard]] bool passes_nothing(const State& next, const VecX& way) {
    clearance_.measure(next.q);
    if (clearance_.keeps_sides(way)) return true;
    clearance_.measure(state_.q);
    return false;
  }

  [[nodiscard]] VecX displacement_to(const State& next) const {
    VecX way(scene_.scale.size());
    for (Eigen::Index k = 0; k < way.size(); ++k)
      way[k] = next.q[static_cast<std::size_t>(k) + 3] - state_.q[static_cast<std::size_t>(k) + 3];
    return way;
  }
  // Returns the size of a displacement, relative to the largest one allowed in a step.
  [[nodiscard]] double size_of(const VecX& way) const {
    double size = 0.0;
    for (Eigen::Index k = 0; k < way.size(); ++k) size = std::max(size, std::abs(way[k]) / (k % 3 < 2 ? k_move * scene_.length : k_turn));
    return size;
  }
  [[nodiscard]] double acceleration_of(const VecX& way, double h) const {
    return way.cwiseQuotient(scene_.scale).cwiseAbs().maxCoeff() / (h * h);
  }

  // Returns the largest displacement since the start if it is beyond the reach.
  [[nodiscard]] std::optional<MotionPart> part_beyond_reach() const {
    if (!reach_) return {};
    VecX moved(scene_.scale.size());
    for (Eigen::Index k = 0; k < moved.size(); ++k) {
      const auto i = static_cast<std::size_t>(k) + 3;
      moved[k] = (state_.q[i] - start_[i]) / (*reach_ * (k % 3 < 2 ? scene_.length : 1.0));
    }
    if (moved.cwiseAbs().maxCoeff() <= 1.0) return {};
    return largest_part(moved);
  }

  // Returns the largest acceleration, m/s², that the forces on a body would cause without joints and friction; angular accelerations are
  // multiplied by the body's radius. Accelerations with constraints would not show forces that joints and friction resist.
  [[nodiscard]] double largest_at_start() {
    Statics statics(system_);
    State state = state_;
    statics.evaluate(state);
    double largest = system_.gravity.norm();
    for (int k = 0; k < statics.coordinates(); ++k) {
      const BodyData& body = system_.bodies[static_cast<std::size_t>(k / 3 + 1)];
      largest = std::max(largest, std::abs(statics.force()[k]) / (k % 3 < 2 ? body.mass : body.inertia * scene_.scale[k]));
    }
    return largest;
  }

  const System& system_;
  Dynamics dynamics_;
  TimeStepping stepping_;
  const std::vector<double> start_;
  State state_;
  SceneScale scene_;
  const std::optional<double> reach_; ///< of the whole displacement, in sizes of the model and rad
  Clearance clearance_;
  double reference_ = 0.0;
  long parts_ = 0; ///< of all steps
};

} // namespace

Settling settle_in_time(const System& system, const State& start) { return Settler(system, start, {}).run(); }

Settling settle_near(const System& system, const State& start, double reach) { return Settler(system, start, reach).run(); }

} // namespace steplap
