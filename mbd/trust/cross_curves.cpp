#include "mbd/trust/cross_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

namespace steplap {

namespace {

constexpr double k_least_part = 1e-3; // fraction of the largest range of its kind, used as the scale of a channel with a smaller range
constexpr double k_wide_part = 0.1;
constexpr double k_least_ratio = 0.5, k_most_ratio = 0.9; // limits for the ratio of the two differences of three runs
// Largest uncertainty of an event's time, as a fraction of the duration, within which samples are compared with tolerance in time. It also
// limits that of an event which another setting lacks, whose uncertainty is infinite.
constexpr double k_doubtful_event = 0.02;
// Lower bounds of estimates, as fractions of the largest estimate in the same body or mechanism.
constexpr double k_part_of_body = 0.3, k_part_of_mechanism = 0.1;
constexpr double k_lacking = 0.1; // fraction of the energy residual that counts as an error of dissipated energy, and of work
constexpr double k_still = 1e-3;  // fraction of the bodies' size; smaller motions count as none

std::optional<ErrorKind> kind_of(const Channel& channel, const std::set<std::string>& bodies) {
  if (is_audit_channel(channel)) return std::nullopt;
  if (channel.unit == "N" || channel.unit == "N m") return ErrorKind::reaction;
  const std::size_t dot = channel.name.rfind('.');
  if (dot == std::string::npos || bodies.count(channel.name.substr(0, dot)) == 0) return std::nullopt;
  if (channel.unit == "m" || channel.unit == "rad") return ErrorKind::position;
  if (channel.unit == "m/s" || channel.unit == "rad/s") return ErrorKind::velocity;
  return std::nullopt;
}

double arm_of(const Channel& channel, double size) {
  if (channel.unit == "rad" || channel.unit == "rad/s") return size;
  return channel.unit == "N m" ? 1.0 / size : 1.0;
}

// Returns the mechanism of each body: bodies that act on each other, other than through the ground, have the same number.
std::vector<int> mechanisms_of(const System& system) {
  std::vector<int> number(system.bodies.size());
  std::iota(number.begin(), number.end(), 0);
  const auto join = [&](int a, int b) {
    if (a == k_ground || b == k_ground || number[a] == number[b]) return;
    const int from = number[a], to = number[b];
    std::replace(number.begin(), number.end(), from, to);
  };
  for (int i = 0; i < system.links.size(); ++i) join(system.links[i].a, system.links[i].b);
  for (const RowSpec& row : system.rows) join(row.a, row.b);
  const State start = system.initial_state();
  for (std::size_t f = 0; f < system.frictions.size(); ++f) {
    const RowSpec& row = system.frictions[f].friction->rows(start.friction[f])[0];
    int before = k_ground; // all bodies of one row belong together, also if the row has several parts
    for (const RowSpec* part = &row; part; part = part->next) {
      join(part->a, part->b);
      const int moving = part->a == k_ground ? part->b : part->a;
      join(before, moving);
      before = moving;
    }
  }
  return number;
}

// Returns the column of the `shares` channel (audit.h) for a channel such as "one.friction"; −1 if there is none.
int share_column(const std::vector<const Channel*>& channels, const Channel& channel) {
  const std::size_t dot = channel.name.rfind('.');
  if (dot == std::string::npos || channel.name.substr(dot) != ".friction") return -1;
  const std::string wanted = shares_channel(channel.name.substr(0, dot));
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const Channel* c) { return c->name == wanted; });
  return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

// Returns the weight of all bodies, N; without gravity their mass times `acceleration`.
double weight_of(const System& system, double acceleration) {
  double mass = 0.0;
  for (const BodyData& body : system.bodies) mass += body.mass;
  return mass * (system.gravity.norm() + acceleration);
}

double range_of(const Trajectory& t, std::size_t column) {
  double low = INFINITY, high = -INFINITY;
  for (std::size_t row = 0; row < t.size(); ++row) {
    low = std::min(low, t.value(row, column));
    high = std::max(high, t.value(row, column));
  }
  return high >= low ? high - low : 0.0;
}

double middle_range(const std::vector<const RunResult*>& runs, std::size_t column) {
  std::vector<double> ranges;
  for (const RunResult* run : runs) ranges.push_back(range_of(*run->trajectory, column));
  std::sort(ranges.begin(), ranges.end());
  return ranges.empty() ? 0.0 : ranges[ranges.size() / 2];
}

// Returns true if most runs exchange no more energy than rounding. The ranges of channels are then rounding, too, and scales follow from
// the size of the model.
bool is_at_rest(const System& system, const std::vector<const RunResult*>& runs) {
  const auto rests = [&system](const RunResult* run) {
    const RunStatistics& s = run->statistics;
    return s.energy_exchanged <= s.energy_rounding && system.kinetic_energy(run->final_state) <= s.energy_rounding;
  };
  return 2 * std::count_if(runs.begin(), runs.end(), rests) > static_cast<std::ptrdiff_t>(runs.size());
}

using Key = std::tuple<std::string, EventKind, bool>; // element, kind, and whether the event is at t = 0
struct EventTime {
  double t = 0.0, within = 0.0; // s: Event::located_within
};
using Times = std::map<Key, std::vector<EventTime>>;

Times times_of(const RunResult& run) {
  Times times;
  for (const Event& event : run.events) times[{event.element, event.kind, event.is_at_start()}].push_back({event.t, event.located_within});
  return times;
}

EventTime nearest(const std::vector<EventTime>& times, double t) {
  EventTime best{INFINITY};
  for (const EventTime& other : times)
    if (std::abs(other.t - t) < std::abs(best.t - t)) best = other;
  return best;
}

// Returns the difference in time, s, to the same event of another run; infinite if that run lacks it.
double shift_of(double t, const std::vector<EventTime>& times, const Times& other, const Key& key) {
  const auto found = other.find(key);
  if (found == other.end()) return INFINITY;
  const EventTime partner = nearest(found->second, t);
  return nearest(times, partner.t).t == t ? std::abs(partner.t - t) + partner.within : INFINITY;
}

} // namespace

double size_of_bodies(const System& system) {
  double size = 0.0;
  for (const BodyData& body : system.bodies)
    if (body.mass > 0.0) size = std::max(size, std::sqrt(body.inertia / body.mass));
  return size > 0.0 ? size : 1.0;
}

std::vector<ComparedChannel> compared_channels(const System& system, const std::vector<const RunResult*>& runs) {
  std::set<std::string> bodies;
  std::map<std::string, int> body_index;
  for (std::size_t b = 0; b < system.bodies.size(); ++b) {
    bodies.insert(system.bodies[b].name);
    body_index[system.bodies[b].name] = static_cast<int>(b);
  }
  const std::vector<int> mechanism = mechanisms_of(system);
  const double size = size_of_bodies(system);
  std::vector<ComparedChannel> list;
  const std::vector<double>& times = runs.front()->trajectory->times();
  const double duration = times.size() > 1 ? times.back() - times.front() : 1.0;
  const bool rests = is_at_rest(system, runs);
  const double still = rests ? 1.0 : k_still, least_part = rests ? 1.0 : k_least_part;
  std::map<ErrorKind, double> largest{{ErrorKind::position, still * size},
                                      {ErrorKind::velocity, still * size / duration},
                                      {ErrorKind::reaction, still * weight_of(system, size / (duration * duration))}};
  const auto& channels = runs.front()->trajectory->channels();
  for (std::size_t column = 0; column < channels.size(); ++column) {
    const std::optional<ErrorKind> kind = kind_of(*channels[column], bodies);
    if (!kind) continue;
    ComparedChannel c{channels[column], column, *kind, arm_of(*channels[column], size), 0.0, 0.0, 0, 0};
    c.shares = share_column(channels, *channels[column]);
    if (*kind != ErrorKind::reaction) {
      c.body = body_index.at(channels[column]->name.substr(0, channels[column]->name.rfind('.')));
      c.mechanism = mechanism[c.body];
    }
    c.scale = middle_range(runs, column);
    largest[*kind] = std::max(largest[*kind], c.arm * c.scale);
    list.push_back(c);
  }
  for (ComparedChannel& c : list) {
    const double of_kind = (largest[c.kind] > 0.0 ? largest[c.kind] : 1.0) / c.arm;
    c.wide_scale = std::max(c.scale, k_wide_part * of_kind);
    c.scale = std::max(c.scale, least_part * of_kind);
  }
  return list;
}

double distance_at(const ComparedChannel& channel, const Trajectory& x, const Trajectory& y, std::size_t row, double slack) {
  const std::size_t c = channel.column, rows = std::min(x.size(), y.size());
  const double plain = std::abs(x.value(row, c) - y.value(row, c));
  if (!std::isfinite(plain)) return x.value(row, c) == y.value(row, c) ? 0.0 : INFINITY;
  if (rows < 2) return plain;
  const double step = x.times()[1] - x.times()[0], samples = std::min(slack / step, static_cast<double>(rows));
  const bool jumps = channel.kind == ErrorKind::reaction;
  const std::size_t reach = static_cast<std::size_t>(jumps ? 1.0 + std::ceil(samples) : std::floor(samples));
  if (reach == 0) return plain;
  const std::size_t first = row > reach ? row - reach : 0, last = std::min(rows - 1, row + reach);
  const auto to_graph = [&](const Trajectory& from, const Trajectory& to) {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = first; i <= last; ++i) {
      low = std::min(low, to.value(i, c));
      high = std::max(high, to.value(i, c));
    }
    return std::max({0.0, low - from.value(row, c), from.value(row, c) - high});
  };
  return std::max(to_graph(x, y), to_graph(y, x));
}

double extrapolated_error(const std::vector<double>& differences) {
  const double last = differences.back();
  if (differences.size() < 2 || last == 0.0) return last;
  const double before = differences[differences.size() - 2];
  const double ratio = std::clamp(before > 0.0 ? last / before : k_most_ratio, k_least_ratio, k_most_ratio);
  // The last difference may be small by chance, so half of the one before is the least estimate.
  return std::max(last * ratio / (1.0 - ratio), k_least_ratio * before);
}

MethodCurves::MethodCurves(const std::vector<ComparedChannel>& channels, const std::vector<const RunResult*>& levels, double step,
                           double end, const EventFilter& is_counted)
    : channels_(channels), levels_(levels), step_(step) {
  rows_ = levels_.front()->trajectory->size();
  for (const RunResult* level : levels_) rows_ = std::min(rows_, level->trajectory->size());
  estimate_events(is_counted);
  spread_slack(end);
  estimate_channels();
  find_known();
  std::vector<double> dissipated, work;
  for (std::size_t i = 1; i < levels_.size(); ++i) {
    dissipated.push_back(std::abs(levels_[i]->statistics.dissipated - levels_[i - 1]->statistics.dissipated));
    work.push_back(std::abs(levels_[i]->statistics.work - levels_[i - 1]->statistics.work));
  }
  // The energy residual is an error of dissipated energy or of work; each gets a fraction of it.
  const double lacking = step_ > 0.0 ? k_lacking * levels_.back()->statistics.energy_residual : 0.0;
  const double in_a_step = std::max(lacking, step_ * audited_power(*levels_.back()));
  dissipated_error_ = std::max(extrapolated_error(dissipated), in_a_step);
  work_error_ = std::max(extrapolated_error(work), in_a_step);
}

void MethodCurves::estimate_events(const EventFilter& is_counted) {
  const Times fine = times_of(*levels_.back());
  std::vector<Times> coarser;
  for (std::size_t i = 0; i + 1 < levels_.size(); ++i) coarser.push_back(times_of(*levels_[i]));
  std::map<std::string, std::vector<double>> of_element;
  for (const Event& event : levels_.back()->events) of_element[event.element].push_back(event.t);
  for (const auto& [key, times] : fine) {
    const auto& [element, kind, is_at_start] = key;
    const double of_steps = is_at_start ? 0.0 : 2.0 * step_; // an event at t = 0 has an exact time
    for (const auto& [t, located_within] : times) {
      const double within = of_steps + located_within;
      TimedEvent event{element, kind, is_at_start, t, within, INFINITY, INFINITY, !is_counted || is_counted({t, element, kind})};
      for (const Times& other : coarser) event.shift = std::max(event.shift, within + shift_of(t, times, other, key));
      bool is_itself = true;
      for (const double other : of_element[element]) {
        if (other == t && is_itself) is_itself = false;
        else if (other > 0.0 || is_at_start) event.alone = std::min(event.alone, std::abs(other - t));
        if (other > t) event.lasts = std::min(event.lasts, other - t);
      }
      events_.push_back(event);
    }
  }
  std::sort(events_.begin(), events_.end(), [](const TimedEvent& a, const TimedEvent& b) { return a.t < b.t; });
}

void MethodCurves::spread_slack(double end) {
  slack_.assign(rows_, 2.0 * step_);
  if (rows_ < 2) return;
  const std::vector<double>& times = levels_.back()->trajectory->times();
  const double step = times[1] - times[0];
  for (const TimedEvent& event : events_) {
    const double shift = std::min(event.shift, k_doubtful_event * end);
    for (std::size_t row = 0; row < rows_; ++row)
      if (std::abs(times[row] - event.t) <= k_margin * shift + step) slack_[row] = std::max(slack_[row], shift);
  }
}

void MethodCurves::estimate_channels() {
  const std::size_t pairs = levels_.size() - 1;
  estimate_.assign(channels_.size(), std::vector<double>(rows_, 0.0));
  std::vector<double> difference(pairs);
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    std::fill(difference.begin(), difference.end(), 0.0);
    // Just after an event, reactions of two settings may be equal by chance, so the next sample is compared, too.
    const std::size_t ahead = channels_[c].kind == ErrorKind::reaction ? 1 : 0;
    for (std::size_t row = 0; row < rows_; ++row) {
      const std::size_t at = std::min(row + ahead, rows_ - 1);
      const auto look = [&](double most_slack) {
        for (std::size_t i = 0; i < pairs; ++i)
          for (const std::size_t k : {row, at})
            difference[i] = std::max(difference[i], distance_at(channels_[c], *levels_[i]->trajectory, *levels_[i + 1]->trajectory, k,
                                                                std::min(slack_[k], most_slack)));
      };
      look(INFINITY);
      // Two curves that jump in opposite directions are near each other within the uncertainty of the event's time, even if their values
      // differ at the same time. With fixed steps the distance is therefore also computed with at most two steps of tolerance in time.
      if (step_ > 0.0 && ahead > 0) look(2.0 * step_);
      estimate_[c][row] = extrapolated_error(difference);
    }
    if (step_ > 0.0) add_step_of_motion(c);
  }
  share_estimates();
}

// Raises the estimates of channels that depend on uncertain ones. If one coordinate of a body is uncertain, its other coordinates are too,
// and to a lesser degree those of bodies on which it acts: a body at rest may be hit at another time, although its own difference is zero.
// Reactions count as one mechanism, since their bodies are not known here.
void MethodCurves::share_estimates() {
  std::map<std::pair<int, ErrorKind>, std::vector<std::size_t>> bodies, mechanisms;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    if (channels_[c].kind != ErrorKind::reaction) bodies[{channels_[c].body, channels_[c].kind}].push_back(c);
    mechanisms[{channels_[c].mechanism, channels_[c].kind}].push_back(c);
  }
  const auto share = [&](const auto& groups, double part) {
    for (const auto& [key, list] : groups)
      for (std::size_t row = 0; row < rows_; ++row) {
        double most = 0.0;
        for (const std::size_t c : list) most = std::max(most, channels_[c].arm * estimate_[c][row]);
        for (const std::size_t c : list) estimate_[c][row] = std::max(estimate_[c][row], part * most / channels_[c].arm);
      }
  };
  share(bodies, k_part_of_body);
  share(mechanisms, k_part_of_mechanism);
}

// With fixed steps an event may lie anywhere within a step, and three runs may agree by chance. The error is therefore at least the largest
// motion so far within one step.
void MethodCurves::add_step_of_motion(std::size_t c) {
  const Trajectory& t = *levels_.back()->trajectory;
  double most = 0.0;
  for (std::size_t row = 1; row < rows_; ++row) {
    const double span = t.times()[row] - t.times()[row - 1];
    most = std::max(most, std::abs(t.value(row, channels_[c].column) - t.value(row - 1, channels_[c].column)) / span);
    estimate_[c][row - 1] = std::max(estimate_[c][row - 1], step_ * most);
    estimate_[c][row] = std::max(estimate_[c][row], step_ * most);
  }
}

double MethodCurves::friction_energy(const std::string& element, double t, double span) const {
  const Trajectory& trajectory = *levels_.back()->trajectory;
  if (rows_ < 2) return 0.0;
  const std::size_t column = trajectory.column(pushes_channel(element));
  const double step = trajectory.times()[1] - trajectory.times()[0];
  double most = 0.0, sum = 0.0;
  for (std::size_t row = 0; row < rows_; ++row) {
    const double at = trajectory.times()[row];
    if (at < t - step || at > t + span + step) continue;
    const double power = std::abs(trajectory.value(row, column));
    most = std::max(most, power);
    if (at >= t && at <= t + span) sum += step * power;
  }
  return std::max(sum, std::min(span, step) * most);
}

void MethodCurves::find_known() {
  const std::vector<double>& times = levels_.back()->trajectory->times();
  std::size_t row = 0;
  const auto is_lost = [&](std::size_t at) {
    for (std::size_t c = 0; c < channels_.size(); ++c)
      if (channels_[c].kind == ErrorKind::position && !(estimate_[c][at] <= k_vague * channels_[c].wide_scale)) return true;
    return false;
  };
  while (row < rows_ && !is_lost(row)) ++row;
  known_until_ = row == 0 ? 0.0 : times[row - 1];
}

WorstError MethodCurves::largest(ErrorKind kind) const {
  WorstError worst;
  if (rows_ == 0) return worst;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    if (channels_[c].kind != kind) continue;
    const double error = estimate_[c][rows_ - 1] / channels_[c].wide_scale;
    if (!(error <= worst.value)) worst = {error, channels_[c].channel->name, levels_.back()->trajectory->times()[rows_ - 1]};
  }
  return worst;
}

} // namespace steplap
