#include "mbd/trust/balance.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "mbd/trust/global_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <unordered_map>
#include <vector>

namespace steplap {

namespace {

constexpr double k_nudge = 1e-9;                    // of a body's size
constexpr double k_above_rounding = 1e4;            // at least so many roundings of its place
constexpr double k_still = 0.1;                     // of a nudge: in axes that are turned, what stays where it is does so to rounding
constexpr double k_least_part = 1e-3;               // of a nudge: joints that leave less of it hold the coordinate
constexpr double k_begun = 2.0, k_half_way = 100.0; // times a nudge
// From 1 to 100 and from there to 1e4 an exponential takes as long, a body that falls or slides off ten times as long, one that
// drifts evenly a hundred times.
constexpr double k_slower = 5.0;

// One of a body's coordinates, measured as a way of the body: an angle by its radius of gyration.
struct StillCoordinate {
  std::size_t coordinate; // in State::q
  double place, arm;      // m or rad; m per unit of the coordinate
  double nudge;           // m, of its body
};

// Spread over 1/2 to 1 of either sign, so that no motion of several coordinates together is without its part.
double weight_of(std::size_t i) {
  constexpr double k_golden = 0.6180339887498949;
  const double u = std::fmod(static_cast<double>(i + 1) * k_golden, 1.0);
  return u < 0.5 ? 0.5 + u : -u;
}

// Those of bodies that move at all: of others each channel is one number.
std::vector<StillCoordinate> still_coordinates(const System& system, const RunResult& run) {
  std::unordered_map<std::string_view, const ChannelRange*> ranges;
  for (const ChannelRange& range : run.ranges) ranges.emplace(range.channel->name, &range);
  std::vector<StillCoordinate> still;
  for (std::size_t body = 1; body < system.bodies.size(); ++body) {
    const BodyData& b = system.bodies[body];
    if (!(b.mass > 0.0)) continue;
    const double radius = std::sqrt(b.inertia / b.mass);
    if (!(radius > 0.0)) continue;
    std::array<const ChannelRange*, 3> range{};
    double far = 0.0;
    for (const std::size_t k : {0, 1, 2}) {
      constexpr std::array<const char*, 3> k_names = {".x", ".y", ".theta"};
      const auto found = ranges.find(b.name + k_names[k]);
      if (found == ranges.end()) continue;
      range[k] = found->second;
      if (k < 2) far = std::max({far, std::abs(range[k]->low.value), std::abs(range[k]->high.value)});
    }
    const double nudge = std::max(k_nudge * radius, k_above_rounding * std::numeric_limits<double>::epsilon() * far);
    for (const std::size_t k : {0, 1, 2}) {
      const double arm = k < 2 ? 1.0 : radius;
      if (range[k] && (range[k]->high.value - range[k]->low.value) * arm <= k_still * nudge)
        still.push_back({3 * body + k, range[k]->low.value, arm, nudge});
    }
  }
  return still;
}

// How far each body is from where it stays, in m; coordinates of one body stand side by side.
std::vector<double> ways_of(const std::vector<StillCoordinate>& still, const State& state) {
  std::vector<double> ways(still.size(), 0.0);
  for (std::size_t i = 0, first = 0; i < still.size(); ++i) {
    if (still[i].coordinate / 3 != still[first].coordinate / 3) first = i;
    ways[first] = portable::hypot(ways[first], (state.q[still[i].coordinate] - still[i].place) * still[i].arm);
  }
  return ways;
}

// Of the body whose coordinates begin at `first`, the one that has gone furthest.
const StillCoordinate& furthest(const std::vector<StillCoordinate>& still, std::size_t first, const State& state) {
  const auto way = [&state](const StillCoordinate& s) { return std::abs(state.q[s.coordinate] - s.place) * s.arm; };
  std::size_t most = first;
  for (std::size_t i = first; i < still.size() && still[i].coordinate / 3 == still[first].coordinate / 3; ++i)
    if (way(still[i]) > way(still[most])) most = i;
  return still[most];
}

// What a way has grown to, and when it passed the marks.
struct Growth {
  double from = 0.0, now = 0.0; // m; times `from`
  double t_begun = 0.0, t_half_way = 0.0;
};

// Between the ends of a step as a line, which what is no exponential may be over a long step.
double passed(double mark, double t0, double grown0, double t1, double grown1) {
  return grown1 > grown0 ? t0 + (t1 - t0) * (mark - grown0) / (grown1 - grown0) : t1;
}

// Has it gone off as what balances does?
bool goes_off(Growth& g, double way, double t0, double t1) {
  const double before = g.now;
  g.now = way / g.from;
  if (g.now <= k_begun) g.t_begun = t1;
  else if (before <= k_begun) g.t_begun = passed(k_begun, t0, before, t1, g.now);
  if (before <= k_half_way && g.now > k_half_way) g.t_half_way = passed(k_half_way, t0, before, t1, g.now);
  if (!(before <= k_grown_nudge && g.now > k_grown_nudge)) return false;
  const double t_far = passed(k_grown_nudge, t0, before, t1, g.now);
  return t_far - g.t_half_way <= k_slower * (g.t_half_way - g.t_begun);
}

// The evaluations of a run are bounded by what was granted.
class NudgedRun {
public:
  NudgedRun(const System& system, const State& initial, const SimulationOptions& options, double most_evaluations)
      : simulation_(system, initial, options), progress_(options.progress), most_evaluations_(most_evaluations) {}

  [[nodiscard]] State state() const { return simulation_.current_state(); }
  bool advance() {
    if (!simulation_.advance()) return false;
    if (progress_) progress_(state().t); // throws where it is to stop
    if (const auto made = static_cast<double>(simulation_.statistics().evaluations); made > most_evaluations_)
      throw EstimateTooDear("given up after " + number_text(most_evaluations_) + " evaluations, at t = " + number_text(state().t) +
                            " s of a run from nudged poses");
    return true;
  }

private:
  Simulation simulation_;
  std::function<void(double)> progress_;
  double most_evaluations_;
};

} // namespace

std::optional<Balance> balance_of(const System& system, const State& initial, const SimulationOptions& options, const RunResult& run,
                                  double most_evaluations) {
  const std::vector<StillCoordinate> still = still_coordinates(system, run);
  if (still.empty()) return {};
  State nudged = initial;
  for (std::size_t i = 0; i < still.size(); ++i) nudged.q[still[i].coordinate] += weight_of(i) * still[i].nudge / still[i].arm;
  SimulationOptions plain = options;
  plain.has_extremes = false;
  plain.output_step = 0.0;
  plain.end = std::min(options.end, run.final_state.t);
  if (!(plain.end > initial.t)) return {};
  NudgedRun again(system, nudged, plain, most_evaluations);
  std::vector<Growth> growth(still.size());
  const std::vector<double> begin = ways_of(still, again.state());
  bool is_free = false;
  for (std::size_t i = 0; i < still.size(); ++i) {
    growth[i].from = std::max(begin[i], still[i].nudge);
    growth[i].now = begin[i] / growth[i].from;
    growth[i].t_begun = initial.t;
    is_free = is_free || begin[i] > k_least_part * still[i].nudge;
  }
  if (!is_free) return {};
  for (double t = initial.t; again.advance();) {
    const State state = again.state();
    const std::vector<double> ways = ways_of(still, state);
    for (std::size_t i = 0; i < still.size(); ++i)
      if (goes_off(growth[i], ways[i], t, state.t)) {
        const std::size_t at = furthest(still, i, state).coordinate;
        return Balance{system.bodies[at / 3].name, static_cast<int>(at % 3), state.t};
      }
    t = state.t;
  }
  return {};
}

} // namespace steplap
