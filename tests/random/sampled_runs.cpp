#include "tests/random/sampled_runs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <sstream>

namespace steplap::random {

namespace {

constexpr long k_most_steps = 40'000;
// An extreme is located to `resolution`. Samples meet the joints, which places between the ends of a step miss by what the
// method allows: their own error, not the extreme's.
constexpr double k_resolutions = 3.0;
constexpr double k_off_joints = 1e-7; // of the largest range of channels in the same unit
constexpr double k_rounding = 1e-9;   // in SI, of scenes under gravity: what moves or bears less is at rest

struct Ran {
  RunResult run;
  std::string failure;
};

Ran ran(const System& system, const State& start, const SimulationOptions& options) {
  Ran found;
  Simulation simulation(system, start, options);
  try {
    while (simulation.statistics().steps < k_most_steps && simulation.advance()) {}
  } catch (const NumericalFailure& failure) {
    found.failure = failure.what();
  }
  found.run = std::move(simulation).result();
  return found;
}

bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

std::string difference(const RunResult& a, const RunResult& b) {
  std::ostringstream text;
  text.precision(17);
  for (std::size_t i = 0; i < std::min(a.events.size(), b.events.size()); ++i)
    if (!is_same(a.events[i].t, b.events[i].t) || a.events[i].kind != b.events[i].kind) {
      text << "event " << i << " '" << a.events[i].element << "' " << a.events[i].words() << " at " << a.events[i].t << " s and "
           << b.events[i].t << " s";
      return text.str();
    }
  if (a.events.size() != b.events.size()) text << a.events.size() << " and " << b.events.size() << " events";
  if (a.statistics.steps != b.statistics.steps) text << a.statistics.steps << " and " << b.statistics.steps << " steps";
  for (std::size_t i = 0; i < a.final_state.q.size(); ++i)
    if (!is_same(a.final_state.q[i], b.final_state.q[i]))
      text << "coordinate " << i << " ends otherwise: " << a.final_state.q[i] << " and " << b.final_state.q[i] << "; ";
  for (std::size_t c = 0; c < a.ranges.size(); ++c)
    if (!is_same(a.ranges[c].low.value, b.ranges[c].low.value) || !is_same(a.ranges[c].high.value, b.ranges[c].high.value)) {
      text << "extremes of " << a.ranges[c].channel->name << ": " << a.ranges[c].low.value << " … " << a.ranges[c].high.value << " and "
           << b.ranges[c].low.value << " … " << b.ranges[c].high.value;
      break;
    }
  return text.str();
}

} // namespace

Sampled sampled(const System& system, const State& start, SimulationOptions options, int count) {
  Sampled found;
  options.has_extremes = true;
  options.channels.clear();
  options.output_step = 0.0;
  const Ran plain = ran(system, start, options);
  options.output_step = options.end / count;
  const Ran often = ran(system, start, options);
  found.failure = often.failure;
  if (plain.failure != often.failure) found.difference = "one stops: " + plain.failure + often.failure;
  else found.difference = difference(plain.run, often.run);
  std::map<std::string, double> range; // by unit
  for (const ChannelRange& r : often.run.ranges) {
    const double own = r.high.value - r.low.value;
    if (std::isfinite(own)) range[r.channel->unit] = std::max(range[r.channel->unit], own);
  }
  const Trajectory& rows = *often.run.trajectory;
  found.samples = rows.size();
  std::map<std::size_t, Beyond> worst;
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (std::size_t column = 0; column < rows.channels().size(); ++column) {
      const auto c = static_cast<std::size_t>(rows.channels()[column] - system.channels.data());
      const ChannelRange& r = often.run.ranges[c];
      if (!r.channel->has_extremes || r.is_low_singular || r.is_high_singular) continue;
      const double value = rows.value(row, column), excess = std::max(value - r.high.value, r.low.value - value);
      const double allowed = k_resolutions * r.resolution + k_off_joints * range[r.channel->unit] + k_rounding;
      if (!(excess > allowed) || excess <= worst[c].excess) continue;
      worst[c] = {r.channel->name, rows.times()[row], excess, r.high.value - r.low.value, allowed};
    }
  for (auto& [c, beyond] : worst)
    if (beyond.excess > 0.0) found.beyond.push_back(std::move(beyond));
  return found;
}

} // namespace steplap::random
