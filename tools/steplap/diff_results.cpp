#include "tools/steplap/diff_results.h"

#include "mbd/base/shown_text.h"
#include "mbd/run/measured_text.h"
#include "mbd/run/shown_quantity.h"
#include "tools/steplap/json_screen.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <ostream>

namespace steplap {

namespace {

using Align = TextTable::Align;
using Json = OrderedJson;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_same_value = 1e-9;   // relative difference of equal values without error estimates, from runs with different steps
constexpr std::size_t k_most_rows = 20; // largest number of rows in the tables of events and of extremes
constexpr double k_least_share = 0.005; // changes of a utilisation below 0.5 % of the limit are shown as 0 % and therefore omitted

double number_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : k_nan;
}

std::string text_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

// Returns the error: empty if not estimated, NaN if unknown.
std::optional<double> error_in(const Json& json, const std::string& key) {
  return json.contains(key) ? std::optional(number_in(json, key.c_str())) : std::nullopt;
}

/// A number in the results of a run, with its error.
struct Measured {
  double value = k_nan;
  std::optional<double> error;
};

Measured measured_in(const Json& json, const std::string& key, const std::string& error) {
  return {number_in(json, key.c_str()), error_in(json, error)};
}

// Returns true if the values differ by more than their errors. Values with unknown errors never differ.
bool differ(const Measured& a, const Measured& b) {
  if (std::isnan(a.value) || std::isnan(b.value)) return std::isnan(a.value) != std::isnan(b.value);
  const double difference = std::abs(a.value - b.value), rounding = k_same_value * std::max(std::abs(a.value), std::abs(b.value));
  return difference > std::max(rounding, a.error.value_or(0.0) + b.error.value_or(0.0)); // false if an error is NaN
}

// Returns both values with few digits and one prefix, or with all digits if few do not distinguish them.
std::pair<Cell, Cell> cells_of(const Measured& a, const Measured& b, const std::string& unit) {
  const double column = std::fmax(std::abs(a.value), std::abs(b.value)); // fmax ignores NaN and returns the other value
  const auto few = [&](const Measured& m) { return shown_quantity(m.value, unit, {.error = m.error, .limit = {}, .column = column}); };
  const bool is_told_apart = few(a) != few(b);
  const auto cell = [&](const Measured& m) {
    return std::isnan(m.value) ? Cell("–") : Cell(is_told_apart ? few(m) : measured_text(m.value, m.error, unit), m.value, unit, m.error);
  };
  return {cell(a), cell(b)};
}

// Returns the relative change from a to b. The cell is empty if a is zero within its error, or if one of them is NaN.
Cell change_of(const Measured& a, const Measured& b) {
  if (std::isnan(a.value) || std::isnan(b.value) || std::abs(a.value) <= std::max(k_same_value * std::abs(b.value), a.error.value_or(0.0)))
    return "";
  return change_cell(a.value, b.value);
}

std::size_t print_outcome(std::ostream& out, const Json& a, const Json& b) {
  TextTable table({Align::left, Align::left, Align::left});
  table.set_head("outcome", {"outcome", "before", "after"}, {"what", "before", "after"});
  const auto add = [&table](const char* what, const std::string& before, const std::string& after) {
    if (before != after) table.add_row({what, before, after});
  };
  const Json &first = a.at("overview"), &second = b.at("overview");
  add("verdict", text_in(first, "verdict"), text_in(second, "verdict"));
  add("trust", text_in(first.at("trust"), "level"), text_in(second.at("trust"), "level"));
  add("program", text_in(a.at("program"), "version"), text_in(b.at("program"), "version"));
  add("ended", a.contains("failure") ? text_in(a, "failure") : "by itself", b.contains("failure") ? text_in(b, "failure") : "by itself");
  if (text_in(first, "verdict") == text_in(second, "verdict")) out << "Verdict of both: " << text_in(first, "verdict") << "\n";
  if (table.is_empty()) return 0;
  out << table;
  for (const Json* run : {&first, &second}) out << (run == &first ? "  before: " : "  after:  ") << text_in(*run, "reason") << "\n";
  return table.rows().size() - 1;
}

std::size_t print_criteria(std::ostream& out, const Json& a, const Json& b) {
  TextTable table({Align::left, Align::left, Align::right, Align::right, Align::left, Align::left});
  table.set_head("criteria", {"criterion", "", "before", "after", "was", "is"},
                 {"name", "criterion", "before", "after", "outcome before", "outcome after"});
  static const Json none = Json::array();
  const Json& before = a.contains("judgement") ? a.at("judgement").at("criteria") : none;
  const Json& after = b.contains("judgement") ? b.at("judgement").at("criteria") : none;
  const auto same = [](const Json& list, const Json& wanted) {
    return std::find_if(list.begin(), list.end(), [&](const Json& c) {
      return text_in(c, "name") == text_in(wanted, "name") && text_in(c, "criterion") == text_in(wanted, "criterion");
    });
  };
  const auto add = [&table](const Json& c, const Json* was, const Json* is) {
    const Measured first = was ? measured_in(*was, "value", "error") : Measured{},
                   second = is ? measured_in(*is, "value", "error") : Measured{};
    const std::string outcome = was ? text_in(*was, "outcome") : "–", now = is ? text_in(*is, "outcome") : "–";
    const auto [value_before, value_after] = cells_of(first, second, text_in(c, "unit"));
    if (outcome != now || differ(first, second))
      table.add_row({text_in(c, "name"), text_in(c, "criterion"), value_before, value_after, outcome, now});
  };
  for (const Json& c : before) {
    const auto other = same(after, c);
    add(c, &c, other == after.end() ? nullptr : &*other);
  }
  for (const Json& c : after)
    if (same(before, c) == before.end()) add(c, nullptr, &c);
  if (table.is_empty()) return 0;
  out << "\nCriteria\n" << table;
  return table.rows().size() - 1;
}

// Prints the utilisation of each element's limit in both runs, in descending order of the larger one. Returns the number of changes.
std::size_t print_shares(std::ostream& out, const Json& a, const Json& b) {
  struct Row {
    double worst;
    TextTable::Row cells;
  };
  std::vector<Row> rows;
  const Json &before = a.at("overview").at("utilisations"), &after = b.at("overview").at("utilisations");
  for (const Json& was : before) {
    const auto is = std::find_if(after.begin(), after.end(), [&](const Json& u) { return text_in(u, "name") == text_in(was, "name"); });
    if (is == after.end()) continue;
    const Measured first = measured_in(was, "share", "error"), second = measured_in(*is, "share", "error");
    if (!differ(first, second) || std::abs(first.value - second.value) < k_least_share) continue;
    const auto cell = [](const Json& u, const Measured& m) { return Cell(text_in(u, "percent"), m.value, "", m.error); };
    rows.push_back({std::fmax(first.value, second.value),
                    {text_in(was, "name"), cell(was, first), cell(*is, second), text_in(was, "detail"), text_in(*is, "detail")}});
  }
  if (rows.empty()) return 0;
  std::stable_sort(rows.begin(), rows.end(), [](const Row& x, const Row& y) { return x.worst > y.worst; });
  TextTable table({Align::left, Align::right, Align::right, Align::left, Align::left});
  table.set_head("shares", {"share of the limit", "before", "after", "was", "is"},
                 {"name", "before", "after", "detail before", "detail after"});
  for (const Row& row : rows) table.add_row(row.cells);
  out << "\n" << table;
  return rows.size();
}

std::size_t print_joints(std::ostream& out, const Json& a, const Json& b) {
  if (!a.contains("joints") || !b.contains("joints")) return 0;
  TextTable table({Align::left, Align::left, Align::right, Align::right, Align::right});
  table.set_head("joints", {"joint", "", "before", "after", "change"}, {"joint", "figure", "before", "after", "change"});
  struct Figure {
    const char *name, *key, *unit;
  };
  static constexpr Figure figures[] = {{"margin", "smallest_margin", ""},
                                       {"required pressure", "largest_required_pressure", "Pa"},
                                       {"slid along x", "slid_x", "m"},
                                       {"slid along y", "slid_y", "m"}};
  for (const auto& [joint, before] : a.at("joints").items()) {
    const auto after = b.at("joints").find(joint);
    if (after == b.at("joints").end()) continue;
    for (const Figure& f : figures) {
      const std::string error = std::string("error_") + f.key;
      const Measured first = measured_in(before, f.key, error), second = measured_in(*after, f.key, error);
      const auto [value_before, value_after] = cells_of(first, second, f.unit);
      if (differ(first, second)) table.add_row({joint, f.name, value_before, value_after, change_of(first, second)});
    }
  }
  if (table.is_empty()) return 0;
  out << "\nStep-lap joints\n" << table;
  return table.rows().size() - 1;
}

// Pairs events by element and kind in order of time: the first lift of a foot in one run with the first in the other.
template <class Value> using ByEvent = std::map<std::pair<std::string, std::string>, Value>;
using EventTimes = ByEvent<std::vector<Measured>>;

// Returns the times of main events by element and kind. Other events depend on the integrator's steps.
EventTimes times_of(const ShownRun& run) {
  EventTimes times;
  for (const ResultEvent& event : run.events)
    if (is_main(event.kind)) times[{event.element, event.words}].push_back({event.t, event.error});
  return times;
}

std::size_t count_of(const EventTimes& events) {
  std::size_t count = 0;
  for (const auto& [what, times] : events) count += times.size();
  return count;
}

std::size_t print_events(std::ostream& out, const ShownRun& a, const ShownRun& b) {
  struct Row {
    double t;
    TextTable::Row cells;
  };
  std::vector<Row> rows;
  EventTimes before = times_of(a), after = times_of(b);
  const std::size_t count_before = count_of(before), count_after = count_of(after);
  for (const auto& [what, times] : before) after.try_emplace(what);
  for (const auto& [what, times] : after) {
    const std::vector<Measured>& was = before[what];
    for (std::size_t i = 0; i < std::max(was.size(), times.size()); ++i) {
      const Measured first = i < was.size() ? was[i] : Measured{}, second = i < times.size() ? times[i] : Measured{};
      if (!differ(first, second)) continue;
      const auto [time_before, time_after] = cells_of(first, second, "s");
      const std::string change = std::isnan(first.value)      ? "new"
                                 : std::isnan(second.value)   ? "gone"
                                 : second.value > first.value ? "later"
                                                              : "earlier";
      rows.push_back({std::isnan(first.value) ? second.value : first.value, {what.first, what.second, time_before, time_after, change}});
    }
  }
  if (rows.empty()) return 0;
  std::stable_sort(rows.begin(), rows.end(), [](const Row& x, const Row& y) { return x.t < y.t; });
  TextTable table({Align::left, Align::left, Align::right, Align::right, Align::left});
  table.set_head("events", {"element", "event", "before", "after", ""}, {"element", "event", "before", "after", "change"});
  const std::size_t shown = json_screen(out) ? rows.size() : std::min(rows.size(), k_most_rows);
  for (std::size_t i = 0; i < shown; ++i) table.add_row(rows[i].cells);
  out << "\nEvents: " << count_before << " before, " << count_after << " after; " << counted(rows.size(), "differs", "differ") << "\n"
      << table;
  if (shown < rows.size()) out << "  … and " << rows.size() - shown << " more: --json has all\n";
  return rows.size();
}

std::size_t print_extremes(std::ostream& out, const Json& a, const Json& b) {
  struct Row {
    double share;
    TextTable::Row cells;
  };
  std::vector<Row> rows;
  std::map<std::string, const Json*> others;
  for (const auto& [channel, entry] : b.at("extremes").items()) others.emplace(channel, &entry);
  for (const auto& [channel, before] : a.at("extremes").items()) {
    const auto found = others.find(channel);
    if (found == others.end()) continue;
    const Json& after = *found->second;
    const auto range = [&](const char* which) { return std::max(std::abs(number_in(before, which)), std::abs(number_in(after, which))); };
    const double scale = std::max(range("min"), range("max"));
    for (const char* which : {"min", "max"}) {
      const std::string error = std::string("error_") + which;
      const Measured first = measured_in(before, which, error), second = measured_in(after, which, error);
      if (!differ(first, second) || std::abs(first.value - second.value) <= k_same_value * scale) continue;
      const auto [value_before, value_after] = cells_of(first, second, text_in(before, "unit"));
      rows.push_back({std::abs(first.value - second.value) / scale,
                      {channel, std::string(which) == "min" ? "lowest" : "highest", value_before, value_after, change_of(first, second)}});
    }
  }
  if (rows.empty()) return 0;
  std::stable_sort(rows.begin(), rows.end(), [](const Row& x, const Row& y) { return x.share > y.share; });
  TextTable table({Align::left, Align::left, Align::right, Align::right, Align::right});
  table.set_head("extremes", {"channel", "", "before", "after", "change"}, {"channel", "extreme", "before", "after", "change"});
  const std::size_t shown = json_screen(out) ? rows.size() : std::min(rows.size(), k_most_rows);
  for (std::size_t i = 0; i < shown; ++i) table.add_row(rows[i].cells);
  out << "\nExtremes of the whole run: " << counted(rows.size(), "differs", "differ") << ", those that changed most of their size first\n"
      << table;
  if (shown < rows.size()) out << "  … and " << rows.size() - shown << " more: --json has all\n";
  return rows.size();
}

// Prints entries that exist in one of the runs only, and returns their number.
std::size_t print_channels_of_one_run(std::ostream& out, const Json& a, const Json& b) {
  std::size_t count = 0;
  for (const bool is_gone : {true, false}) {
    const Json &from = (is_gone ? a : b).at("extremes"), &to = (is_gone ? b : a).at("extremes");
    std::map<std::string, bool> known;
    for (const auto& entry : to.items()) known.emplace(entry.key(), true);
    std::size_t missing = 0;
    std::string example;
    for (const auto& entry : from.items())
      if (!known.contains(entry.key()) && missing++ == 0) example = entry.key();
    if (missing > 0)
      out << "  " << counted(missing, "channel", "channels") << " only " << (is_gone ? "before" : "after") << ", such as '" << example
          << "'\n";
    count += missing;
  }
  return count;
}

} // namespace

Cell change_cell(double before, double after) {
  if (before == 0.0 || !std::isfinite(after / before)) return "";
  const double percent = 100.0 * (after / before - 1.0);
  char text[40];
  if (after / before > 0.1 && after / before < 10.0) std::snprintf(text, sizeof text, "%+.3g %%", percent);
  else std::snprintf(text, sizeof text, "× %.3g", after / before);
  return {text, percent, "%"};
}

std::size_t print_limit_changes(std::ostream& out, const ShownRun& before, const ShownRun& after) {
  const Json &a = before.summary, &b = after.summary;
  return print_outcome(out, a, b) + print_criteria(out, a, b) + print_shares(out, a, b);
}

std::size_t print_other_changes(std::ostream& out, const ShownRun& before, const ShownRun& after) {
  const Json &a = before.summary, &b = after.summary;
  return print_joints(out, a, b) + print_events(out, before, after) + print_extremes(out, a, b) + print_channels_of_one_run(out, a, b);
}

void print_unknown_errors(std::ostream& out, const ShownRun& before, const ShownRun& after) {
  for (const ShownRun* run : {&before, &after})
    if (!run->summary.contains("global_error"))
      out << "  The errors of '" << run->folder << "' are not known: what differs may be an error (steplap simulate --estimate-error).\n";
}

} // namespace steplap
