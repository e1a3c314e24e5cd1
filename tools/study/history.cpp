#include "tools/study/history.h"

#include "mbd/base/number_text.h"
#include "mbd/io/column_unit.h"
#include "mbd/io/csv.h"
#include "mbd/io/units.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace steplap::study {

namespace {

std::optional<double> noise_of(const Node& entry, const History& h, const std::string& unit, std::vector<Diagnostic>& problems) {
  if (h.noise_text.empty()) return {};
  double value = 0.0;
  const char* const end = h.noise_text.data() + h.noise_text.size();
  const auto [rest, status] = std::from_chars(h.noise_text.data(), end, value);
  if (status != std::errc() || rest != end) {
    const Quantity quantity = parse_quantity(h.noise_text, unit);
    if (!quantity.problem.empty()) problems.push_back({entry.find("noise")->where(), "'noise': " + quantity.problem});
    value = quantity.value;
  }
  if (!(value > 0.0) || !std::isfinite(value))
    problems.push_back({entry.find("noise")->where(), "'noise', the standard deviation of the measured values, must be above zero"});
  return value;
}

} // namespace

void load_history(const Node& entry, const StudyModel& model, History& h, std::vector<Diagnostic>& problems) {
  const std::size_t before = problems.size();
  const auto& channels = model.system->channels;
  const auto channel = std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.name == h.channel; });
  if (channel == channels.end()) {
    std::vector<std::string> names;
    for (const Channel& c : channels) names.push_back(c.name);
    problems.push_back({entry.find("channel")->where(),
                        "no channel of model '" + model.name + "' is called '" + h.channel + "'" + did_you_mean(h.channel, names)});
    return;
  }
  h.noise = noise_of(entry, h, channel->unit, problems);
  h.channel_unit = channel->unit;
  if (problems.size() != before) return;
  const Location where = entry.find("file")->where();
  try {
    const CsvTable table = read_csv(h.file, where);
    const Node *const time_node = entry.find("time"), *const column_node = entry.find("column");
    const std::size_t t = table.column(h.time, time_node ? time_node->where() : where);
    const std::size_t y = table.column(h.column, column_node ? column_node->where() : where);
    const auto conversion = [&](const char* key, const std::string& given, std::size_t column, const std::string& wanted) {
      const Node* const field = entry.find(key);
      return conversion_of(table, column, {"history '" + h.name + "'", key, given, field ? field->where() : where, wanted});
    };
    const UnitConversion time = conversion("time_unit", h.time_unit, t, "s"), value = conversion("unit", h.unit, y, channel->unit);
    for (std::size_t i = 0; i < table.columns[t].size(); ++i) {
      const double at = time.factor * table.columns[t][i] + time.shift;
      if ((h.from && at < *h.from) || (h.to && at > *h.to)) continue;
      const Location line{h.file, table.lines[i], 1};
      if (!h.t.empty() && !(at > h.t.back()))
        return problems.push_back({line, "the times of history '" + h.name + "' must rise from row to row"});
      const double end = model.given.simulation.end;
      if (at < 0.0 || at > end * (1.0 + 1e-12))
        return problems.push_back({line, "t = " + number_text(at) + " s of history '" + h.name + "' lies outside the run of model '" +
                                             model.name + "', which goes from 0 to " + number_text(end) +
                                             " s: choose rows by 'from' and 'to', or let it end later"});
      h.t.push_back(at);
      h.measured.push_back(value.factor * table.columns[y][i] + value.shift);
    }
  } catch (const ModelError& error) {
    problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
    return;
  }
  if (h.t.empty()) problems.push_back({where, "history '" + h.name + "' has no rows between 'from' and 'to'"});
}

Sampling sampling_of(const Study& study, const StudyModel& model) {
  std::vector<double> times;
  for (const History& h : study.histories)
    if (h.model == model.name) times.insert(times.end(), h.t.begin(), h.t.end());
  if (times.empty()) return {};
  constexpr double k_off = 1e-6; // tolerance for rounded times in a file, relative to the step
  std::sort(times.begin(), times.end());
  double gap = std::numeric_limits<double>::infinity(), last = 0.0;
  for (const double t : times) {
    if (t - last > 1e-12 * times.back()) gap = std::min(gap, t - last);
    last = t;
  }
  if (!std::isfinite(gap)) return {model.given.simulation.end, true}; // all measured times are zero
  constexpr double k_most = 1e6;                                      // largest number of output samples of a run
  for (int parts = 1; parts <= 20 && times.back() * parts < k_most * gap; ++parts) {
    const double step = gap / parts;
    // The last time divided by the number of steps is more accurate than a single interval.
    const double fine = times.back() / std::round(times.back() / step);
    if (std::all_of(times.begin(), times.end(), [&](double t) { return std::abs(t / fine - std::round(t / fine)) < k_off; }))
      return {fine, true};
  }
  constexpr double k_parts = 8.0;
  return {std::max(gap / k_parts, times.back() / k_most), false};
}

void compare_times(const History& history, const Sampling& sampling, const Trajectory& trajectory, double* values) {
  const double slack = 1e-5 * sampling.step;
  const std::vector<double>& times = trajectory.times();
  const std::size_t column = trajectory.column(history.channel);
  std::size_t k = 0;
  for (std::size_t i = 0; i < history.t.size(); ++i) {
    const double t = history.t[i];
    while (k < times.size() && times[k] < t - slack) ++k;
    if (k == times.size()) values[i] = std::numeric_limits<double>::quiet_NaN();
    else if (times[k] <= t + slack || k == 0) values[i] = trajectory.value(k, column);
    else {
      const double share = (t - times[k - 1]) / (times[k] - times[k - 1]);
      values[i] = (1.0 - share) * trajectory.value(k - 1, column) + share * trajectory.value(k, column);
    }
  }
}

} // namespace steplap::study
