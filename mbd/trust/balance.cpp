#include "mbd/trust/balance.h"

#include "mbd/base/number_text.h"
#include "mbd/trust/global_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace steplap {

namespace {

constexpr double k_nudge = 1e-9;      // of the scene's size; rad
constexpr double k_rounding = 0.1;    // of a nudge: in axes that are turned, what stays where it is does so to rounding
constexpr double k_least_part = 1e-3; // of a nudge: joints that leave less of it hold the coordinate

struct StillCoordinate {
  std::size_t coordinate; // in State::q
  double place, nudge;    // m or rad
};

// Spread over 1/2 to 1 of either sign, so that no motion of several coordinates together is without its part.
double weight_of(std::size_t i) {
  constexpr double k_golden = 0.6180339887498949;
  const double u = std::fmod(static_cast<double>(i + 1) * k_golden, 1.0);
  return u < 0.5 ? 0.5 + u : -u;
}

double size_of(const System& system, const RunResult& run) {
  double size = 0.0;
  for (const BodyData& body : system.bodies)
    if (body.mass > 0.0) size = std::max(size, std::sqrt(body.inertia / body.mass));
  for (std::size_t i = 0; i < run.final_state.q.size(); ++i)
    if (i % 3 != 2) size = std::max(size, std::abs(run.final_state.q[i]));
  return size > 0.0 ? size : 1.0;
}

// Those of bodies that move at all: of others each channel is one number.
std::vector<StillCoordinate> still_coordinates(const System& system, const RunResult& run) {
  std::unordered_map<std::string_view, const ChannelRange*> ranges;
  for (const ChannelRange& range : run.ranges) ranges.emplace(range.channel->name, &range);
  const double size = size_of(system, run);
  std::vector<StillCoordinate> still;
  for (std::size_t body = 1; body < system.bodies.size(); ++body)
    for (const std::size_t k : {0, 1, 2}) {
      constexpr std::array<const char*, 3> k_names = {".x", ".y", ".theta"};
      const auto found = ranges.find(system.bodies[body].name + k_names[k]);
      if (found == ranges.end()) continue;
      const double low = found->second->low.value, high = found->second->high.value, nudge = (k < 2 ? size : 1.0) * k_nudge;
      if (high - low <= k_rounding * nudge) still.push_back({3 * body + k, low, nudge * weight_of(still.size())});
    }
  return still;
}

// The one that has gone furthest, of its nudge.
std::pair<const StillCoordinate*, double> furthest(const std::vector<StillCoordinate>& still, const State& state) {
  std::pair<const StillCoordinate*, double> most = {nullptr, 0.0};
  for (const StillCoordinate& s : still)
    if (const double grown = std::abs((state.q[s.coordinate] - s.place) / s.nudge); grown > most.second) most = {&s, grown};
  return most;
}

// The evaluations of a run are bounded by what was granted.
class NudgedRun {
public:
  NudgedRun(const System& system, const State& initial, const SimulationOptions& options, double most_evaluations)
      : simulation_(system, initial, options), most_evaluations_(most_evaluations) {}

  [[nodiscard]] State state() const { return simulation_.current_state(); }
  bool advance() {
    if (!simulation_.advance()) return false;
    if (const auto made = static_cast<double>(simulation_.statistics().evaluations); made > most_evaluations_)
      throw EstimateTooDear("given up after " + number_text(most_evaluations_) + " evaluations, at t = " + number_text(state().t) +
                            " s of a run from nudged poses");
    return true;
  }

private:
  Simulation simulation_;
  double most_evaluations_;
};

} // namespace

std::optional<Balance> balance_of(const System& system, const State& initial, const SimulationOptions& options, const RunResult& run,
                                  double most_evaluations) {
  const std::vector<StillCoordinate> still = still_coordinates(system, run);
  if (still.empty()) return {};
  State nudged = initial;
  for (const StillCoordinate& s : still) nudged.q[s.coordinate] += s.nudge;
  SimulationOptions plain = options;
  plain.has_extremes = false;
  plain.output_step = 0.0;
  NudgedRun again(system, nudged, plain, most_evaluations);
  if (furthest(still, again.state()).second < k_least_part) return {};
  while (again.advance()) {
    const State state = again.state();
    const auto [s, grown] = furthest(still, state);
    if (grown > k_grown_nudge) return Balance{system.bodies[s->coordinate / 3].name, static_cast<int>(s->coordinate % 3), state.t};
  }
  return {};
}

} // namespace steplap
