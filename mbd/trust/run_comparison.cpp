#include "mbd/trust/run_comparison.h"

#include "mbd/trust/event_match.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace steplap {

namespace {

constexpr double k_least_range = 1e-3; // fraction of the largest range of the channels of one kind
constexpr double k_is_constant = 1e-9; // fraction of the value; a smaller range is rounding
// Fraction of the bodies' size L below which motions count as none. Errors of positions are controlled to 1e-3 L (Integrator); hundreds of
// steps at the usual tolerance leave 1e-9 L, a tenth of this limit.
constexpr double k_no_motion = 1e-8;

struct Compared {
  const Channel* channel = nullptr;
  ErrorKind kind = ErrorKind::position;
  std::size_t column = 0;
  double low = 0.0, high = 0.0, size = 0.0; ///< range and largest absolute value in the reference
  double arm = 1.0;                         ///< m: factor from angles to lengths, and divisor from torques to forces
  [[nodiscard]] double range() const { return high - low; }
};

std::optional<ErrorKind> kind_of(const Channel& channel, const std::set<std::string>& bodies) {
  if (channel.unit == "N" || channel.unit == "N m") return ErrorKind::reaction;
  const std::size_t dot = channel.name.rfind('.');
  if (dot == std::string::npos || bodies.count(channel.name.substr(0, dot)) == 0) return std::nullopt;
  if (channel.unit == "m" || channel.unit == "rad") return ErrorKind::position;
  if (channel.unit == "m/s" || channel.unit == "rad/s") return ErrorKind::velocity;
  return std::nullopt;
}

// Returns the largest radius of gyration of the bodies, m.
double size_of(const System& system) {
  double size = 0.0;
  for (const BodyData& body : system.bodies)
    if (body.mass > 0.0) size = std::max(size, std::sqrt(body.inertia / body.mass));
  return size > 0.0 ? size : 1.0;
}

// Returns the factor that converts angles to lengths or torques to forces; 1 for other channels. `size`: size of the bodies, m.
double arm_of(const Channel& channel, double size) {
  if (channel.unit == "rad" || channel.unit == "rad/s") return size;
  return channel.unit == "N m" ? 1.0 / size : 1.0;
}

void widen(Compared& c, double value) {
  c.low = std::min(c.low, value);
  c.high = std::max(c.high, value);
  c.size = std::max(c.size, std::abs(value));
}

// Sets the ranges of all channels: over the whole run if extremes were located, else over samples. The trajectory is read row by row,
// because it may be on disk.
void set_ranges(std::vector<Compared>& list, const System& system, const RunResult& run) {
  const Trajectory& reference = *run.trajectory;
  for (std::size_t row = 0; row < reference.size(); ++row) {
    const std::span<const double> values = reference.row(row);
    for (Compared& c : list) {
      const double value = values[c.column + 1];
      if (row == 0) c.low = c.high = value;
      widen(c, value);
    }
  }
  if (run.ranges.empty()) return;
  for (Compared& c : list) {
    const ChannelRange& whole = run.ranges[static_cast<std::size_t>(c.channel - system.channels.data())];
    for (const double value : {whole.low.value, whole.high.value})
      if (std::isfinite(value)) widen(c, value);
  }
}

std::vector<Compared> compared_channels(const System& system, const RunResult& run) {
  const Trajectory& reference = *run.trajectory;
  std::set<std::string> bodies;
  for (const BodyData& body : system.bodies) bodies.insert(body.name);
  const double size = size_of(system);
  std::vector<Compared> list;
  for (std::size_t column = 0; column < reference.channels().size(); ++column) {
    Compared c;
    c.channel = reference.channels()[column];
    c.column = column;
    const std::optional<ErrorKind> kind = kind_of(*c.channel, bodies);
    if (!kind || reference.size() == 0) continue;
    c.kind = *kind;
    c.arm = arm_of(*c.channel, size);
    list.push_back(c);
  }
  set_ranges(list, system, run);
  return list;
}

// Scale of each kind of error, in units of translations or forces.
using Scales = std::map<ErrorKind, double>;

Scales sizes_of(const std::vector<Compared>& channels) {
  Scales size;
  for (const Compared& c : channels) size[c.kind] = std::max(size[c.kind], c.arm * c.size);
  return size;
}

// Returns the largest range of each kind, or its largest value if nothing moves.
Scales scales_of(const std::vector<Compared>& channels) {
  Scales range, size = sizes_of(channels);
  for (const Compared& c : channels) range[c.kind] = std::max(range[c.kind], c.arm * c.range());
  for (auto& [kind, value] : range) {
    if (value <= k_is_constant * size[kind]) value = size[kind];
    if (value == 0.0) value = 1.0; // all values are zero: errors are not scaled
  }
  return range;
}

bool is_worse(double value, const WorstError& worst) { // not-a-number is worse than any number
  return !(value <= worst.value) && !std::isnan(worst.value);
}

void keep_worst(WorstError& worst, double value, const std::string& where, double t) {
  if (is_worse(value, worst)) worst = {value, where, t};
}

void keep_worst(WorstError& worst, double value, double t) {
  if (!is_worse(value, worst)) return;
  worst.value = value;
  worst.t = t;
}

double difference(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0; // also for equal infinities
  return std::abs(a - b);
}

// Returns the divisor for the error of the channel; `size` is the size of the bodies, m.
double scale_of(const Compared& c, const Scales& scales, double size) {
  const double of_kind = std::max(k_least_range * scales.at(c.kind), c.kind == ErrorKind::position ? k_no_motion * size : 0.0);
  return std::max(c.range(), of_kind / c.arm);
}

// Returns the largest error of every channel with its time. The trajectories are read row by row, because they may be on disk.
std::vector<std::pair<const Compared*, WorstError>> worst_of_channels(const std::vector<Compared>& channels, double size,
                                                                      const Trajectory& mine, const Trajectory& theirs,
                                                                      const RowPairs& rows, const BetweenEvents& between) {
  const Scales scales = scales_of(channels), sizes = sizes_of(channels);
  std::vector<std::pair<const Compared*, WorstError>> list;
  std::vector<double> scale,
      rounding; // rounding: largest value of its kind times k_rounded_range, for channels whose range is less; else 0
  for (const Compared& c : channels) {
    list.push_back({&c, {}});
    scale.push_back(scale_of(c, scales, size));
    const double least = k_rounded_range * sizes.at(c.kind) / c.arm;
    rounding.push_back(c.range() <= least ? least : 0.0);
  }
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::span<const double> a = mine.row(row), b = theirs.row(rows.theirs(row));
    const bool is_jump = between.holds(b[0]);
    for (std::size_t i = 0; i < list.size(); ++i) {
      const Compared& c = *list[i].first;
      if (c.kind == ErrorKind::reaction && is_jump) continue;
      const double off = difference(a[c.column + 1], b[c.column + 1]);
      if (!(off <= rounding[i])) keep_worst(list[i].second, off / scale[i], b[0]);
    }
  }
  return list;
}

} // namespace

const char* name_of(ErrorKind kind) {
  switch (kind) {
  case ErrorKind::position: return "positions";
  case ErrorKind::velocity: return "velocities";
  case ErrorKind::reaction: return "reactions";
  case ErrorKind::event_time: return "event times";
  }
  return "";
}

double RunDifference::largest() const {
  double value = 0.0;
  for (const WorstError& w : worst)
    if (!(w.value <= value)) value = w.value;
  return value;
}

RowPairs::RowPairs(const Trajectory& mine, const Trajectory& theirs, std::size_t stride)
    : stride_(stride), size_(mine.size()), last_(theirs.size() > 0 ? theirs.size() - 1 : 0) {
  if (theirs.size() == 0) size_ = 0;
  // The last row of a run may be at any time. If one run ended earlier, later rows of the other one belong to no row.
  else if (size_ > 0) size_ = std::min(size_, (last_ + stride - 1) / stride + 1);
}

RunDifference compare_runs(const System& system, const RunResult& run, const RunResult& reference, const EventFilter& is_counted,
                           std::size_t stride) {
  RunDifference d;
  const Trajectory& mine = *run.trajectory;
  const Trajectory& theirs = *reference.trajectory;
  const RowPairs rows(mine, theirs, stride);
  if (rows.size() > 0) d.compared_until = theirs.time(rows.theirs(rows.size() - 1));
  const EventMatch match = match_events(run.events, reference.events);
  const auto counted = [&](const std::vector<std::size_t>& places, const std::vector<Event>& events) {
    return std::count_if(places.begin(), places.end(), [&](std::size_t i) { return !is_counted || is_counted(events[i]); });
  };
  d.unmatched_events = static_cast<int>(counted(match.only_mine, run.events) + counted(match.only_reference, reference.events));
  const BetweenEvents between(match, run.events, reference.events);
  const std::vector<Compared> channels = compared_channels(system, reference);
  for (const auto& [c, worst] : worst_of_channels(channels, size_of(system), mine, theirs, rows, between))
    keep_worst(d.worst[static_cast<std::size_t>(c->kind)], worst.value, c->channel->name, worst.t);
  const double duration = theirs.size() > 0 ? theirs.time(theirs.size() - 1) - theirs.time(0) : 0.0;
  for (const EventPair& pair : match.pairs) {
    const Event &mine_event = run.events[pair.mine], &event = reference.events[pair.reference];
    if (is_counted && !is_counted(event)) continue;
    keep_worst(d.worst[static_cast<std::size_t>(ErrorKind::event_time)],
               std::abs(mine_event.t - event.t) / (duration > 0.0 ? duration : 1.0), "'" + event.element + "' " + event.words(), event.t);
  }
  return d;
}

// Only positions are compared, because in a model at rest velocities and forces are rounding.
std::optional<double> parts_at(const System& system, const RunResult& run, const RunResult& reference, std::size_t stride, double share) {
  const Trajectory &mine = *run.trajectory, &theirs = *reference.trajectory;
  const RowPairs rows(mine, theirs, stride);
  const std::vector<Compared> channels = compared_channels(system, reference);
  const Scales scales = scales_of(channels);
  const double size = size_of(system);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::span<const double> a = mine.row(row), b = theirs.row(rows.theirs(row));
    for (const Compared& c : channels) {
      if (c.kind != ErrorKind::position) continue;
      if (!(difference(a[c.column + 1], b[c.column + 1]) <= share * scale_of(c, scales, size))) return b[0];
    }
  }
  return {};
}

} // namespace steplap
