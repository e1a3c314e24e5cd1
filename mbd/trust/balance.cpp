#include "mbd/trust/balance.h"

#include "mbd/base/counter_random.h"
#include "mbd/base/fingerprint.h"
#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "mbd/trust/frozen_growth.h"
#include "mbd/trust/global_error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

namespace steplap {

namespace {

constexpr double k_nudge = 1e-9;           // size of a nudge, relative to the radius of gyration of the body
constexpr double k_above_rounding = 1e4;   // least size of a nudge, in rounding errors of the body's position
constexpr double k_least_part = 1e-3;      // fraction of a nudge; if constraints permit only a smaller part of it, they hold the body
constexpr double k_least_fastest = 0.3;    // least component of the nudge along the fastest growing direction, in nudge sizes
constexpr double k_least_share = 0.5;      // fraction of the mean rate required; slower growth at an instant counts as 0
constexpr double k_visible_exponent = 0.2; // growth by 22 %, far above rounding; a smaller predicted exponent is not confirmed by runs
constexpr double k_confirmed = 0.5; // fraction of the exponent that runs must confirm: instants are few, and the growing direction rotates
// Test for exponential growth in one run. Exponential growth takes about as long from 1 to 100 as from 100 to 1e4. The displacement of a
// body that falls or slides takes ten times as long, that of a body which drifts evenly a hundred times. The second time may therefore be
// at most k_slower times the first.
constexpr double k_begun = 2.0, k_half_way = 100.0;
constexpr double k_slower = 5.0;
// Growth beyond k_suspicious in one run is examined again in the difference of two runs, in which the motion itself cancels. In that
// difference a growth by k_seen distinguishes exponentials from powers of time up to t⁵, by the last two doublings. For an exponential they
// take equally long, or the last one less (growth from rest); for t⁵ the last one takes at least 1.07 times as long.
constexpr double k_suspicious = 5.0, k_seen = 16.0, k_even_doublings = 1.03;
constexpr int k_parts_of_step = 8;
constexpr double k_least_steps = 100.0; // number of steps in the leg, so that doublings are resolved
constexpr double k_swing_step = 0.5;    // phase of the oscillation per step, rad; methods of order 4 or more have errors of 1e-4 then
constexpr int k_least_samples = 6;      // in the last two doublings
// A direction may start to move late in a leg because rounding errors grew along it. Constraints are met to about 1e-9 of a body's size;
// growth of this by an exponent of 6 or more is visible (k_moved). Motion that starts before the fraction k_early of the leg belongs to the
// model.
constexpr double k_by_rounding = 6.0, k_early = 0.05;
// Least number of instants with growth if the leg is in motion; a single one may lie within an impact.
constexpr int k_least_instants = 3;
// Largest number of coordinates for which the stiffness is analysed. The algebra is dense; the cost of an instant grows with the cube of
// the number.
constexpr int k_most_coordinates = 300;
constexpr double k_dense_work = 3e8; // limit on (coordinates)³ · instants in a leg
constexpr int k_most_instants = 32;
constexpr int k_steady_instants = 2;         // number of instants in a leg of steady motion, in which only loads change
constexpr std::size_t k_most_stretches = 32; // largest number of intervals between breakpoints of loads that are examined separately

// Growth of small displacements over a leg, as its stiffness predicts.
struct LegGrowth {
  double exponent = 0.0; ///< ∫ rate dt
  double rate = 0.0;     ///< largest rate, 1/s
  VecX shape;            ///< displacement that grows fastest, as W δ (square roots of masses times displacements)
  double swing = 0.0;    ///< angular frequency of that displacement if it oscillates, rad/s (FrozenGrowth)
  int growing = 0;       ///< number of instants with growth
};

// An instant of a leg at which the growth rate is computed, and the part of the leg's duration that it represents.
struct Instant {
  State state;
  double duration; ///< s
};

// Returns instants in a leg at rest, in which only loads change: the middles of equal parts of the intervals between breakpoints of loads.
std::vector<Instant> instants_at_rest(const System& system, const LegMotion& leg, int count) {
  std::vector<double> edges = {leg.begin.t};
  for (const double t : system.breakpoints)
    if (t > edges.back() && t < leg.end) edges.push_back(t);
  edges.push_back(leg.end);
  if (edges.size() > k_most_stretches + 1) edges = {leg.begin.t, leg.end};
  const int parts = std::max(1, count / static_cast<int>(edges.size() - 1));
  std::vector<Instant> instants;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    for (int part = 0; part < parts; ++part) {
      const double length = (edges[i + 1] - edges[i]) / parts;
      instants.push_back({leg.begin, length});
      instants.back().state.t = edges[i] + (part + 0.5) * length;
    }
  return instants;
}

// Returns recorded states of a leg in motion. Each represents the time until half-way to its neighbours.
std::vector<Instant> instants_in_motion(const LegMotion& leg, int count) {
  std::vector<const State*> states = {&leg.begin};
  const std::size_t stride = std::max<std::size_t>(1, leg.states.size() / static_cast<std::size_t>(std::max(count, 1)));
  for (std::size_t i = 0; i < leg.states.size(); i += stride) states.push_back(&leg.states[i]);
  std::vector<Instant> instants;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double from = i == 0 ? leg.begin.t : 0.5 * (states[i - 1]->t + states[i]->t);
    const double to = i + 1 == states.size() ? leg.end : 0.5 * (states[i]->t + states[i + 1]->t);
    if (to > from) instants.push_back({*states[i], to - from});
  }
  return instants;
}

using GrowthAt = std::function<FrozenGrowth(const State&)>;

LegGrowth growth_over_leg(const GrowthAt& growth_at, const std::vector<Instant>& instants) {
  LegGrowth course;
  for (const Instant& instant : instants) {
    const FrozenGrowth growth = growth_at(instant.state);
    course.exponent += growth.rate * instant.duration;
    if (growth.rate > 0.0) ++course.growing;
    if (!(growth.rate > course.rate)) continue;
    course.rate = growth.rate;
    course.shape = growth.shape;
    course.swing = growth.swing;
  }
  return course;
}

// Returns the size of the nudge of every body except the ground, m.
std::vector<double> nudges_of(const System& system, const State& begin) {
  std::vector<double> nudges;
  for (std::size_t body = 1; body < system.bodies.size(); ++body) {
    const BodyData& b = system.bodies[body];
    const double radius = b.mass > 0.0 ? std::sqrt(b.inertia / b.mass) : 0.0;
    const double far = std::max(std::abs(begin.q[3 * body]), std::abs(begin.q[3 * body + 1]));
    nudges.push_back(std::max(k_nudge * radius, k_above_rounding * std::numeric_limits<double>::epsilon() * far));
  }
  return nudges;
}

// Returns the size of each body's displacement, m; rotations are multiplied by the radius of gyration. `weighted` is W δ.
std::vector<double> ways_of(const System& system, const VecX& weighted) {
  std::vector<double> ways;
  for (std::size_t body = 1; body < system.bodies.size(); ++body) {
    const auto first = static_cast<Eigen::Index>(3 * body - 3);
    ways.push_back(weighted.segment<3>(first).norm() / std::sqrt(system.bodies[body].mass));
  }
  return ways;
}

// Returns the largest ratio of a body's displacement to its nudge size.
double largest_share(const std::vector<double>& ways, const std::vector<double>& nudges) {
  double share = 0.0;
  for (std::size_t i = 0; i < ways.size(); ++i)
    if (nudges[i] > 0.0) share = std::max(share, ways[i] / nudges[i]);
  return share;
}

// Returns a pseudo-random displacement W δ. It depends only on the model and the leg, so results are reproducible. Each component has a
// random sign and a size between half the nudge size and the whole, so that every mode is excited.
VecX random_nudge(const System& system, std::size_t leg, const std::vector<double>& nudges) {
  Fingerprint machine;
  for (const BodyData& body : system.bodies) {
    machine.add(std::string_view(body.name));
    for (const double number : {body.mass, body.inertia, body.pose[0], body.pose[1], body.pose[2]}) machine.add(number);
  }
  for (const auto& name : system.element_names) machine.add(std::string_view(name));
  VecX weighted(static_cast<Eigen::Index>(3 * nudges.size()));
  for (Eigen::Index i = 0; i < weighted.size(); ++i) {
    const double u = counter_uniform(machine.value(), 0, leg, static_cast<std::uint32_t>(i));
    const auto body = static_cast<std::size_t>(i) / 3;
    weighted[i] = (u < 0.5 ? 0.5 + u : -u) * nudges[body] * std::sqrt(system.bodies[body + 1].mass);
  }
  return weighted;
}

VecX beyond(const MotionSpan& moved, const VecX& weighted) {
  std::vector<double> parts(weighted.begin(), weighted.end());
  moved.remove(parts);
  return Eigen::Map<const VecX>(parts.data(), weighted.size());
}

// Repeats a run with a displacement (nudge) at the start of one leg. Throws an exception beyond `most_evaluations`.
class NudgedRun {
public:
  NudgedRun(const System& system, const State& initial, const SimulationOptions& options, double most_evaluations, const LegMotion& leg)
      : simulation_(system, initial, options), progress_(options.progress), most_evaluations_(most_evaluations), leg_(leg) {}

  // Runs to the start of the leg. Returns false if the run ends before.
  bool reach_leg() {
    while (simulation_.past_legs() < leg_.past_legs)
      if (!step()) return false;
    now_ = before_ = simulation_.current_state();
    return simulation_.past_legs() == leg_.past_legs;
  }
  void displace(const std::vector<double>& by) {
    simulation_.displace(by);
    now_ = before_ = simulation_.current_state();
  }
  // Makes one step. Returns false if the leg has ended.
  bool advance() {
    if (is_over_) return false;
    before_ = std::move(now_);
    is_over_ = !step();
    now_ = simulation_.current_state();
    is_over_ = is_over_ || simulation_.past_legs() != leg_.past_legs;
    return true;
  }
  [[nodiscard]] const State& now() const { return now_; }
  [[nodiscard]] double step_begin() const { return before_.t; } ///< start of the last step, s
  [[nodiscard]] double evaluations() const { return static_cast<double>(simulation_.statistics().evaluations); }
  // Returns the pose at t within the last step by cubic Hermite interpolation of positions and velocities.
  [[nodiscard]] std::vector<double> pose_at(double t) const {
    const double h = now_.t - before_.t;
    if (!(h > 0.0) || t >= now_.t) return now_.q;
    if (t <= before_.t) return before_.q;
    const double s = (t - before_.t) / h, r = 1.0 - s;
    std::vector<double> q(now_.q.size());
    for (std::size_t i = 0; i < q.size(); ++i)
      q[i] = r * r * (1.0 + 2.0 * s) * before_.q[i] + s * s * (1.0 + 2.0 * r) * now_.q[i] + h * s * r * (r * before_.v[i] - s * now_.v[i]);
    return q;
  }

private:
  bool step() {
    const bool goes_on = simulation_.advance();
    const double t = simulation_.state().t;
    if (progress_) progress_(t); // throws if the user stops the computation
    if (evaluations() > most_evaluations_)
      throw EvaluationBudgetExceeded("aborted after " + number_text(most_evaluations_) + " evaluations, at t = " + number_text(t) +
                                     " s of a run from nudged poses");
    return goes_on;
  }

  Simulation simulation_;
  std::function<void(double)> progress_;
  double most_evaluations_;
  const LegMotion& leg_;
  State before_, now_;
  bool is_over_ = false;
};

// Growth of one body's displacement, and the times at which it passed k_begun and k_half_way.
struct Growth {
  double from = 0.0, now = 0.0; // initial displacement, m; present one over the initial one
  double t_begun = 0.0, t_half_way = 0.0;
};

// Returns the time at which the growth passed `mark`, by interpolation within a step. This is linear, because the growth over a long step
// need not be exponential.
double passed(double mark, double t0, double grown0, double t1, double grown1) {
  return grown1 > grown0 ? t0 + (t1 - t0) * (mark - grown0) / (grown1 - grown0) : t1;
}

// Updates the growth by one step from t0 to t1, at whose end the displacement is `way`. Returns true if the displacement has just passed
// k_far_grown_nudge and has grown as fast as an exponential.
bool goes_off(Growth& g, double way, double t0, double t1) {
  const double before = g.now;
  g.now = way / g.from;
  if (g.now <= k_begun) g.t_begun = t1;
  else if (before <= k_begun) g.t_begun = passed(k_begun, t0, before, t1, g.now);
  if (before <= k_half_way && g.now > k_half_way) g.t_half_way = passed(k_half_way, t0, before, t1, g.now);
  if (!(before <= k_far_grown_nudge && g.now > k_far_grown_nudge)) return false;
  const double t_far = passed(k_far_grown_nudge, t0, before, t1, g.now);
  return t_far - g.t_half_way <= k_slower * (g.t_half_way - g.t_begun);
}

// Returns x with cosh x = `grown`, the exponent of exponential growth that starts at rest.
double exponent_of(double grown) { return std::numbers::ln10 * portable::log10(grown + std::sqrt((grown - 1.0) * (grown + 1.0))); }

// Tests one leg of a run by runs from displaced poses.
class NudgedLeg {
public:
  NudgedLeg(const System& system, const State& initial, const SimulationOptions& options, const LegMotion& leg, double most_evaluations)
      : system_(system), initial_(initial), options_(options), leg_(leg), most_evaluations_(most_evaluations),
        nudges_(nudges_of(system, leg.begin)) {
    options_.has_extremes = options_.notes_motion = false;
    options_.output_step = 0.0;
    options_.end = std::min(options_.end, leg.end);
  }

  // Sets the nudge, along directions that are free. It gets a component along `shape`, unless that is empty.
  void choose_nudge(const FrozenLeg* frozen, const VecX& shape) {
    nudge_ = random_nudge(system_, leg_.past_legs, nudges_);
    nudge_ = frozen ? frozen->along_directions(nudge_) : beyond(leg_.moved, nudge_);
    const double share = largest_share(ways_of(system_, nudge_), nudges_);
    if (share > 0.0) nudge_ /= std::max(share, 1.0);
    if (shape.size() > 0) {
      const VecX fastest = shape / largest_share(ways_of(system_, shape), nudges_);
      const double part = shape.dot(nudge_) / shape.dot(fastest);
      if (std::abs(part) < k_least_fastest) nudge_ += (std::copysign(k_least_fastest, part) - part) * fastest;
    }
    if (!nudge_.allFinite()) throw NumericalFailure("the bodies lie so far apart that nudged poses are beyond all numbers");
  }

  // Returns true if half the difference of two runs, from the nudge and from its mirror image, grows along `shape` as `course` predicts.
  bool confirms(const LegGrowth& course) {
    if (course.swing > 0.0) limit_steps(k_swing_step / course.swing);
    NudgedRun plus = nudged(1.0), minus = nudged(-1.0);
    if (!plus.reach_leg() || !minus.reach_leg()) return false;
    displace(plus, 1.0);
    displace(minus, -1.0);
    const double from = std::abs(course.shape.dot(difference(plus, minus)));
    if (!(from > k_least_part * std::abs(course.shape.dot(nudge_)))) return false;
    double grown = 1.0;
    while (plus.advance()) {
      while (minus.now().t < plus.now().t && minus.advance()) {}
      if (plus.evaluations() + minus.evaluations() > most_evaluations_)
        throw EvaluationBudgetExceeded("aborted after " + number_text(most_evaluations_) +
                                       " evaluations, at t = " + number_text(plus.now().t) + " s of two runs from nudged poses");
      grown = std::max(grown, std::abs(course.shape.dot(difference(plus, minus))) / from);
      if (grown > k_grown_nudge) return true;
    }
    return exponent_of(grown) > k_confirmed * course.exponent;
  }

  // Searches for growth that the stiffness does not show, in one run. Returns its rate, 1/s, and the displacement W δ; nothing if there is
  // none.
  std::optional<std::pair<double, VecX>> goes_off_otherwise() {
    NudgedRun run = nudged(1.0);
    if (!run.reach_leg()) return {};
    displace(run, 1.0);
    const auto ways_now = [&] { return ways_of(system_, beyond(leg_.moved, displacement(run.now().q))); };
    const std::vector<double> begin = ways_now();
    std::vector<Growth> growth(begin.size());
    for (std::size_t i = 0; i < begin.size(); ++i) {
      growth[i].from = std::max(begin[i], nudges_[i]);
      growth[i].now = begin[i] / growth[i].from;
      growth[i].t_begun = leg_.begin.t;
    }
    if (!(largest_share(begin, nudges_) > k_least_part)) return {};
    bool is_suspicious = false;
    for (double t = leg_.begin.t; run.advance();) {
      const std::vector<double> ways = ways_now();
      for (std::size_t i = 0; i < ways.size(); ++i) {
        if (goes_off(growth[i], ways[i], t, run.now().t)) {
          const double rate = exponent_of(k_far_grown_nudge) / (run.now().t - leg_.begin.t);
          return std::pair{rate, VecX(beyond(leg_.moved, displacement(run.now().q)))};
        }
        is_suspicious = is_suspicious || growth[i].now > k_suspicious;
      }
      t = run.now().t;
    }
    if (is_suspicious) return grows_evenly();
    return {};
  }

private:
  // Searches for exponential growth over the whole leg in half the difference of two runs, from the nudge and from its mirror image.
  // Returns its rate, 1/s, and the displacement W δ.
  std::optional<std::pair<double, VecX>> grows_evenly() {
    limit_steps((leg_.end - leg_.begin.t) / k_least_steps);
    NudgedRun plus = nudged(1.0), minus = nudged(-1.0);
    if (!plus.reach_leg() || !minus.reach_leg()) return {};
    displace(plus, 1.0);
    displace(minus, -1.0);
    const double duration = leg_.end - leg_.begin.t;
    std::vector<double> times = {leg_.begin.t};
    std::vector<std::vector<double>> ways = {ways_of(system_, beyond(leg_.moved, difference(plus, minus)))};
    while (plus.advance()) {
      while (minus.now().t < plus.now().t && minus.advance()) {}
      if (plus.evaluations() + minus.evaluations() > most_evaluations_)
        throw EvaluationBudgetExceeded("aborted after " + number_text(most_evaluations_) +
                                       " evaluations, at t = " + number_text(plus.now().t) + " s of two runs from nudged poses");
      const double from = plus.step_begin(), step = plus.now().t - from;
      for (int part = 1; part <= k_parts_of_step; ++part) {
        const double t = from + step * part / k_parts_of_step;
        if (t < minus.step_begin() || !(t > times.back())) continue;
        times.push_back(t);
        ways.push_back(ways_of(system_, beyond(leg_.moved, difference(plus, minus, t))));
      }
    }
    if (times.back() < leg_.end - k_early * duration) return {};
    double rate = k_exponent / std::max(duration, 1.0);
    bool is_found = false;
    for (std::size_t body = 0; body < nudges_.size(); ++body) {
      std::vector<double> way;
      for (const std::vector<double>& all : ways) way.push_back(all[body]);
      const double from = std::max(way.front(), k_least_fastest * nudges_[body]);
      const double found = nudges_[body] > 0.0 && way.back() > k_seen * from ? last_rate(times, way) : 0.0;
      if (!(found > rate)) continue;
      rate = found;
      is_found = true;
    }
    if (!is_found) return {};
    return std::pair{rate, VecX(beyond(leg_.moved, difference(plus, minus)))};
  }
  // Limits the step. Nudges are smaller than the tolerance, so error control ignores them. In a leg at rest or in even motion, explicit
  // methods would then take steps at their limit of stability, and implicit ones would damp oscillations.
  void limit_steps(double most) {
    double& limit = options_.settings.max_step;
    limit = limit > 0.0 ? std::min(limit, most) : most;
  }
  // Returns the growth rate over the last two doublings, 1/s; 0 if the growth is not exponential.
  static double last_rate(const std::vector<double>& times, const std::vector<double>& way) {
    std::size_t i = way.size() - 1;
    const double end = way.back(), t_end = times.back();
    const auto last_below = [&](double mark) { // last time at which the displacement was below `mark`, by exponential interpolation
      while (i > 0 && way[i] > mark) --i;
      if (!(way[i] > 0.0) || !(way[i] < way[i + 1])) return times[i];
      return times[i] + (times[i + 1] - times[i]) * portable::log10(mark / way[i]) / portable::log10(way[i + 1] / way[i]);
    };
    const double t_half = last_below(0.5 * end), t_quarter = last_below(0.25 * end);
    if (static_cast<int>(way.size() - 1 - i) < k_least_samples) return 0.0;
    if (!(t_end - t_half <= k_even_doublings * (t_half - t_quarter))) return 0.0;
    return 2.0 * std::numbers::ln2 / (t_end - t_quarter);
  }
  [[nodiscard]] std::vector<double> by(double sign) const {
    std::vector<double> all(3, 0.0);
    for (Eigen::Index i = 0; i < nudge_.size(); ++i)
      all.push_back(leg_.moved.weights()[static_cast<std::size_t>(i)] > 0.0
                        ? sign * nudge_[i] / leg_.moved.weights()[static_cast<std::size_t>(i)]
                        : 0.0);
    return all;
  }
  // Returns a run of the leg. For the first leg the run starts from the displaced pose, so that modes of contacts and friction are
  // determined there.
  [[nodiscard]] NudgedRun nudged(double sign) const {
    State start = initial_;
    if (leg_.past_legs == 0) {
      const std::vector<double> all = by(sign);
      for (std::size_t i = 0; i < all.size(); ++i) start.q[i] += all[i];
    }
    return {system_, start, options_, most_evaluations_, leg_};
  }
  void displace(NudgedRun& run, double sign) const {
    if (leg_.past_legs > 0) run.displace(by(sign));
  }
  // Returns W (q − q₀) with q₀ the pose at the start of the leg.
  [[nodiscard]] VecX displacement(const std::vector<double>& q) const {
    VecX weighted(nudge_.size());
    for (Eigen::Index i = 0; i < weighted.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      weighted[i] = leg_.moved.weights()[at] * (q[at + 3] - leg_.begin.q[at + 3]);
    }
    return weighted;
  }
  [[nodiscard]] VecX difference(const NudgedRun& plus, const NudgedRun& minus) const { return difference(plus, minus, plus.now().t); }
  [[nodiscard]] VecX difference(const NudgedRun& plus, const NudgedRun& minus, double t) const {
    const std::vector<double> a = plus.pose_at(t), b = minus.pose_at(t);
    VecX weighted(nudge_.size());
    for (Eigen::Index i = 0; i < weighted.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      weighted[i] = 0.5 * leg_.moved.weights()[at] * (a[at + 3] - b[at + 3]);
    }
    return weighted;
  }

  const System& system_;
  const State& initial_;
  SimulationOptions options_;
  const LegMotion& leg_;
  double most_evaluations_;
  std::vector<double> nudges_; ///< m, for every body except the ground
  VecX nudge_;                 ///< W δ
};

// Returns the result for a displacement: the body that it moves most, relative to the body's size, and whether the body moves or rotates.
UnstableBody balance_by(const System& system, const LegMotion& leg, const VecX& shape, double rate) {
  const std::vector<double> ways = ways_of(system, shape), nudges = nudges_of(system, leg.begin);
  std::size_t most = 0;
  for (std::size_t i = 0; i < ways.size(); ++i)
    if (ways[i] * nudges[most] > ways[most] * nudges[i]) most = i;
  const auto first = static_cast<Eigen::Index>(3 * most);
  const double x = shape[first], y = shape[first + 1], turned = shape[first + 2];
  UnstableBody found{system.bodies[most + 1].name, 0, 0.0, leg.begin.t, rate};
  if (std::abs(turned) > portable::hypot(x, y)) found.coordinate = 2;
  else found.direction = x < 0.0 || (x == 0.0 && y < 0.0) ? portable::atan2(-y, -x) : portable::atan2(y, x);
  return found;
}

// Returns flags of the bodies on which units of the named element act; all bodies if no unit has this name.
std::vector<char> bodies_of(const System& system, const std::string& element) {
  std::vector<char> is_used(system.bodies.size(), 0);
  bool is_found = false;
  const auto is_it = [&](int index) {
    const bool is_this = system.element_names[static_cast<std::size_t>(index)] == element;
    is_found = is_found || is_this;
    return is_this;
  };
  for (const Unit& unit : system.units)
    if (is_it(unit.element)) unit.group->mark_bodies(is_used);
  for (const FrictionUnit& unit : system.frictions)
    if (is_it(unit.element)) unit.friction->mark_bodies(is_used);
  if (!is_found) std::fill(is_used.begin(), is_used.end(), char{1});
  return is_used;
}

// Returns true if no body that the free directions move has an event in the leg. Actions and kinks do not count.
bool is_without_events(const System& system, const RunResult& run, const LegMotion& leg, const FrozenLeg& frozen) {
  return std::none_of(run.events.begin(), run.events.end(), [&](const Event& event) {
    if (event.t < leg.begin.t || event.t > leg.end || event.kind == EventKind::happens || is_kink(event.kind)) return false;
    const std::vector<char> is_used = bodies_of(system, event.element);
    for (std::size_t body = 1; body < is_used.size(); ++body)
      if (is_used[body] != 0 && frozen.moves(body)) return true;
    return false;
  });
}

// Tests legs of one run, one at a time, for unstable equilibria.
struct ExaminedLeg {
  const System& system; ///< system of the run
  const State& initial; ///< initial state of the run
  const SimulationOptions& options;
  const RunResult& run;
  double most_evaluations;

  [[nodiscard]] const System& own_system(const LegMotion& leg) const { return leg.system ? *leg.system : system; }
  // Returns the number of instants for which the cost of dense algebra is acceptable.
  [[nodiscard]] int instants() const {
    const double coordinates = 3.0 * (system.body_count() - 1);
    return static_cast<int>(
        std::clamp(k_dense_work / (coordinates * coordinates * coordinates), 4.0, static_cast<double>(k_most_instants)));
  }
  [[nodiscard]] bool has_dense_algebra() const { return 3 * (system.body_count() - 1) <= k_most_coordinates; }
  [[nodiscard]] static bool has_moved_everywhere(const LegMotion& leg) {
    return leg.moved.directions().size() >= leg.moved.weights().size();
  }
  [[nodiscard]] bool is_at_rest(const LegMotion& leg) const { return leg.moved.directions().empty() && own_system(leg).inner_count() == 0; }
  [[nodiscard]] std::optional<UnstableBody> by_growth(const FrozenLeg& frozen, const GrowthAt& growth_at, const LegMotion& leg,
                                                      const std::vector<Instant>& looks, double least_exponent) const;
  [[nodiscard]] std::optional<UnstableBody> by_stiffness(FrozenLeg& frozen, const LegMotion& leg, double least_exponent) const;
  [[nodiscard]] std::optional<UnstableBody> by_nudge(FrozenLeg* frozen, const LegMotion& leg) const;
  [[nodiscard]] std::optional<UnstableBody> until_it_fell(const LegMotion& leg) const;
  [[nodiscard]] std::optional<UnstableBody> of(const LegMotion& leg) const;
};

// Returns an unstable equilibrium if the growth at the instants `looks` amounts to an exponent above `least_exponent` over the leg, and if
// runs from displaced poses confirm it. `growth_at` computes the growth rate at a state.
std::optional<UnstableBody> ExaminedLeg::by_growth(const FrozenLeg& frozen, const GrowthAt& growth_at, const LegMotion& leg,
                                                   const std::vector<Instant>& looks, double least_exponent) const {
  const LegGrowth course = growth_over_leg(growth_at, looks);
  if (!(course.exponent > least_exponent)) return {};
  if (!is_at_rest(leg) && course.growing < std::min(k_least_instants, static_cast<int>(looks.size()))) return {};
  NudgedLeg nudged(system, initial, options, leg, most_evaluations);
  nudged.choose_nudge(&frozen, course.shape);
  if (course.exponent >= k_visible_exponent && !nudged.confirms(course)) return {};
  return balance_by(system, leg, course.shape, course.exponent / (leg.end - leg.begin.t));
}

std::optional<UnstableBody> ExaminedLeg::by_stiffness(FrozenLeg& frozen, const LegMotion& leg, double least_exponent) const {
  const double least = k_least_share * least_exponent / (leg.end - leg.begin.t);
  const std::vector<Instant> looks =
      is_at_rest(leg) ? instants_at_rest(own_system(leg), leg, instants()) : instants_in_motion(leg, instants());
  for (std::size_t variant = 0; variant < frozen.variants(); ++variant) {
    const auto growth_at = [&](const State& state) { return frozen.growth_at(state, least, variant); };
    if (auto found = by_growth(frozen, growth_at, leg, looks, least_exponent)) return found;
  }
  if (!frozen.is_steady()) return {};
  const auto growth_at = [&](const State& state) { return frozen.steady_growth_at(state, least); };
  return by_growth(frozen, growth_at, leg, instants_in_motion(leg, std::min(instants(), k_steady_instants)), least_exponent);
}

std::optional<UnstableBody> ExaminedLeg::by_nudge(FrozenLeg* frozen, const LegMotion& leg) const {
  NudgedLeg nudged(system, initial, options, leg, most_evaluations);
  nudged.choose_nudge(frozen, {});
  const auto gone = nudged.goes_off_otherwise();
  if (!gone) return {};
  return balance_by(system, leg, gone->second, gone->first);
}

// Returns true if some displacement grows faster than `least`, 1/s, at this state.
bool grows_at(FrozenLeg& frozen, const State& state, double least) {
  for (std::size_t variant = 0; variant < frozen.variants(); ++variant)
    if (frozen.growth_at(state, least, variant).rate > 0.0) return true;
  return frozen.is_steady() && frozen.steady_growth_at(state, least).rate > 0.0;
}

// Finds equilibria that ended during the leg because rounding errors grew. For each direction that started to move late, the time before is
// tested like a leg in which this direction did not move.
std::optional<UnstableBody> ExaminedLeg::until_it_fell(const LegMotion& leg) const {
  const double duration = leg.end - leg.begin.t;
  double last = -std::numeric_limits<double>::infinity();
  for (const double t : leg.moved.since()) {
    if (t == last || t - leg.begin.t < k_early * duration) continue;
    last = t;
    LegMotion part{leg.system, leg.past_legs, leg.begin, t, {}, leg.moved.before(t)};
    for (const State& state : leg.states)
      if (state.t < t) part.states.push_back(state);
    FrozenLeg frozen(own_system(leg), part);
    if (frozen.directions() == 0) continue;
    const State& middle = part.states.empty() ? part.begin : part.states[part.states.size() / 2];
    if (!grows_at(frozen, middle, k_by_rounding / (t - leg.begin.t))) continue;
    if (auto found = by_stiffness(frozen, part, k_by_rounding)) return found;
  }
  return {};
}

std::optional<UnstableBody> ExaminedLeg::of(const LegMotion& leg) const {
  const double duration = leg.end - leg.begin.t;
  if (!(duration > 0.0) || leg.moved.weights().empty()) return {};
  if (!has_dense_algebra()) {
    if (has_moved_everywhere(leg)) return {};
    return by_nudge(nullptr, leg);
  }
  if (!has_moved_everywhere(leg)) {
    FrozenLeg frozen(own_system(leg), leg);
    if (frozen.directions() > 0) {
      if (auto found = by_stiffness(frozen, leg, k_exponent * std::min(duration, 1.0))) return found;
      if (!is_at_rest(leg) && is_without_events(own_system(leg), run, leg, frozen))
        if (auto found = by_nudge(&frozen, leg)) return found;
    }
  }
  return until_it_fell(leg);
}

} // namespace

std::optional<UnstableBody> balance_of(const System& system, const State& initial, const SimulationOptions& options, const RunResult& run,
                                       double most_evaluations) {
  if (!run.legs) return {};
  const ExaminedLeg asked{system, initial, options, run, most_evaluations};
  for (const LegMotion& leg : *run.legs)
    if (auto found = asked.of(leg)) return found;
  return {};
}

} // namespace steplap
