#include "tools/steplap/run_screen.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/model/validate.h"
#include "mbd/run/measured_text.h"
#include "mbd/run/prominence.h"
#include "mbd/run/quantity_text.h"
#include "mbd/trust/global_error.h"
#include "tools/steplap/text_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <ostream>
#include <unordered_map>
#include <unordered_set>

namespace steplap {

namespace {

using Align = TextTable::Align;
using Json = OrderedJson;

constexpr std::size_t k_most_events_shown = 30;

// --- reading numbers from a summary

std::string text_at(const Json& json, const char* key) { return json.at(key).get<std::string>(); }

// Returns a number of the summary. JSON has no infinity: ±∞ is stored as null with a second entry KEY_is. Other nulls are NaN.
double number_at(const Json& json, const std::string& key) {
  if (const Json& value = json.at(key); value.is_number()) return value.get<double>();
  const auto which = json.find(key + "_is");
  if (which == json.end()) return std::numeric_limits<double>::quiet_NaN();
  if (*which == "∞") return std::numeric_limits<double>::infinity();
  return *which == "-∞" ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
}

// Returns a number that may be missing: no entry, or null.
std::optional<double> optional_at(const Json& json, const std::string& key) {
  if (!json.contains(key) || (json.at(key).is_null() && !json.contains(key + "_is"))) return {};
  return number_at(json, key);
}

// Returns the error: empty if not estimated, NaN if unknown.
std::optional<double> error_at(const Json& json, const std::string& key) {
  return json.contains(key) ? std::optional(number_at(json, key)) : std::nullopt;
}

// An extreme of a channel.
struct ShownExtreme {
  double value = 0.0;
  std::optional<double> t, error, t_error;
  bool is_singular = false;
};

ShownExtreme extreme_at(const Json& entry, const std::string& which) {
  return {number_at(entry, which), optional_at(entry, "t_" + which), error_at(entry, "error_" + which), error_at(entry, "error_t_" + which),
          entry.contains(which + "_singular")};
}

struct ShownRange {
  std::string name, unit;
  ShownExtreme low, high;
  bool is_on_request = false;

  // Returns the extreme further from zero.
  [[nodiscard]] const ShownExtreme& largest() const { return std::abs(low.value) > std::abs(high.value) ? low : high; }
};

// A run with its extremes, indexed by channel name.
struct TabledRun {
  explicit TabledRun(const ShownRun& shown) : run(shown), summary(shown.summary), name(text_at(summary.at("model"), "name")) {
    for (const auto& [channel, entry] : summary.at("extremes").items()) {
      places.emplace(channel, ranges.size());
      ranges.push_back({channel, text_at(entry, "unit"), extreme_at(entry, "min"), extreme_at(entry, "max"), entry.contains("on_request")});
    }
  }

  [[nodiscard]] const ShownRange* find(const std::string& channel) const {
    const auto found = places.find(channel);
    return found == places.end() ? nullptr : &ranges[found->second];
  }
  [[nodiscard]] bool has_errors() const { return summary.contains("global_error"); }

  const ShownRun& run;
  const Json& summary;
  std::string name; ///< head of the run's column
  std::vector<ShownRange> ranges;
  std::unordered_map<std::string, std::size_t> places;
};

// Formats a value with one digit below 10, otherwise as an integer: "0.6", "12".
std::string rough_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value < 10.0 ? "%.1g" : "%.0f", value);
  return text;
}

// Returns the reason why errors were not estimated. If the cost was too high, it names the option that requests them.
std::string why_not_estimated(const TabledRun& run) {
  return text_at(run.summary, "error_not_estimated") + (run.summary.at("error_estimate") == "too dear" ? " (--estimate-error)" : "");
}

void print_no_estimate(std::ostream& out, const TabledRun& run) {
  if (run.has_errors()) return;
  out << "  error not estimated: ";
  if (!run.run.cost || !run.run.cost->cost_of_estimate) out << why_not_estimated(run) << "\n";
  else out << "would take about " << rough_text(*run.run.cost->cost_of_estimate) << " s; ask with --estimate-error\n";
}

void print_heading(std::ostream& out, const TabledRun& run) {
  const Json& settings = run.summary.at("settings");
  const std::string title = text_at(run.summary.at("model"), "title"), integrator = text_at(run.summary, "integrator");
  out << shown(run.name);
  if (!title.empty()) out << ": " << shown(title);
  out << "\n  " << integrator;
  if (const auto step = optional_at(settings, "step"); step && has_fixed_step(integrator)) out << ", step " << number_text(*step) << " s";
  if (const auto tolerance = optional_at(settings, "tolerance"); tolerance && !has_fixed_step(integrator))
    out << ", tolerance " << number_text(*tolerance);
  out << ", t = 0 to " << number_text(number_at(run.summary.at("final_state"), "t")) << " s\n";
  if (run.summary.contains("failure")) out << "  STOPPED before the end: " << text_at(run.summary, "failure") << "\n";
  print_no_estimate(out, run);
}

void print_events(std::ostream& out, const std::vector<ResultEvent>& events) {
  const auto main =
      static_cast<std::size_t>(std::count_if(events.begin(), events.end(), [](const ResultEvent& event) { return is_main(event.kind); }));
  out << "\nEvents: " << (main == 0 ? "none" : std::to_string(main));
  out << "\n";
  TextTable table({Align::right, Align::left, Align::left});
  std::size_t shown = 0;
  for (const ResultEvent& event : events)
    if (is_main(event.kind) && shown++ < k_most_events_shown)
      table.add_row({measured_time_text(event.t, event.error), event.element, event.words});
  out << table;
  if (shown > k_most_events_shown) out << "  … and " << shown - k_most_events_shown << " more: see events.csv\n";
}

// Returns true for reactions that are not zero during the whole run.
bool is_shown(const ShownRange& range) {
  return is_reaction(range.name, range.unit) && !std::isnan(range.low.value) && range.largest().value != 0.0;
}

// Formats a value. Values that are rounding relative to the channel's largest one are shown as zero, unless an error is known.
std::string value_text(const ShownRange& range, const ShownExtreme& extreme) {
  if (extreme.is_singular && extreme.error && std::isnan(*extreme.error)) return "diverges at a singular pose";
  return extreme.error ? measured_text(extreme.value, extreme.error, range.unit)
                       : quantity_text(extreme.value, range.unit, range.largest().value);
}

std::string extreme_time_text(double t, std::optional<double> error) {
  return error ? measured_time_text(t, error) : quantity_text(t, "s");
}

std::string time_of_text(const ShownExtreme& extreme) { return extreme_time_text(extreme.t.value_or(0.0), extreme.t_error); }

// Formats a joint's margin. It is shown as "> 1e9" if the joint carries only rounding errors.
std::string small_margin_text(double margin, std::optional<double> error) {
  constexpr double k_unloaded = 1e9; // larger margins are tracked by magnitude only (mbd/simulation/extremes.cpp)
  if (!std::isfinite(margin)) return "–";
  if (margin > k_unloaded) return "> 1e9";
  if (error) return measured_text(margin, error, "");
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", margin);
  return text;
}

// Prints one row per channel with both extremes and their times.
void add_extremes(TextTable& table, const ShownRange& range) {
  table.add_row(
      {range.name, value_text(range, range.low), time_of_text(range.low), value_text(range, range.high), time_of_text(range.high)});
}

TextTable table_of_extremes() {
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right});
  table.add_row({"", "lowest", "at", "highest", "at"});
  return table;
}

void print_reactions(std::ostream& out, const TabledRun& run) {
  TextTable table = table_of_extremes();
  bool is_any = false;
  for (const ShownRange& range : run.ranges) {
    if (!is_shown(range)) continue;
    is_any = true;
    add_extremes(table, range);
  }
  if (is_any) out << "\nReactions and required pressures, extremes of the whole run\n" << table;
}

bool is_requested(const ShownRange& range) { return range.is_on_request && !is_shown(range) && !std::isnan(range.low.value); }

constexpr std::size_t k_most_requested = 24;

// Prints the channels requested by the model in the order of their creation. Formulas are last and are therefore omitted last.
void print_requested(std::ostream& out, const TabledRun& run) {
  std::vector<const ShownRange*> asked;
  for (const ShownRange& range : run.ranges)
    if (is_requested(range)) asked.push_back(&range);
  if (asked.empty()) return;
  const std::size_t left_out = asked.size() > k_most_requested ? asked.size() - k_most_requested : 0;
  TextTable table = table_of_extremes();
  for (std::size_t i = left_out; i < asked.size(); ++i) add_extremes(table, *asked[i]);
  out << "\nChannels on request, extremes of the whole run\n" << table;
  if (left_out > 0) out << "  and " << left_out << " more: see summary.json\n";
}

void print_slides(std::ostream& out, const TabledRun& run) {
  TextTable table({Align::left, Align::right, Align::right});
  for (const ShownRange& range : run.ranges)
    if (is_slide(range.name)) table.add_row({range.name, value_text(range, range.largest()), "at " + time_of_text(range.largest())});
  if (!table.is_empty()) out << "\nLargest slides\n" << table;
}

// Prints the largest line load on the joint's sheet edges, N/m, and the elements that carry load in parallel with the joint.
void print_edges_and_parallel_elements(std::ostream& out, const std::string& joint, const Json& a) {
  if (const auto load = optional_at(a, "largest_edge_load"); load && *load > 0.0) {
    out << "  " << joint << ": sheet edges carried up to " << measured_text(*load, error_at(a, "error_largest_edge_load"), "N/m");
    if (const auto allowed = optional_at(a, "allowed_line_load")) out << ", allowed are " << quantity_text(*allowed, "N/m");
    out << "\n";
  }
  if (!a.contains("shared_with")) return;
  out << "  " << joint << ": margin of its own share; in parallel";
  const char* before = " '";
  for (const Json& shared : a.at("shared_with")) {
    out << before << text_at(shared, "element") << "'";
    if (const auto largest = optional_at(shared, "largest_force")) out << " with up to " << quantity_text(*largest, "N");
    before = ", '";
  }
  out << (a.at("shares_before_it_slides").get<bool>() ? "\n" : " (the joint is rigid: they take no part before it slides)\n");
}

void add_joint(TextTable& table, const std::string& joint, const Json& a) {
  const auto error = [&a](const std::string& figure) { return error_at(a, "error_" + figure); };
  const auto first_slip = optional_at(a, "first_slip");
  const double slid = portable::hypot(number_at(a, "slid_x"), number_at(a, "slid_y")), area_lost = number_at(a, "area_lost");
  const auto x = error("slid_x"), y = error("slid_y");
  table.add_row({joint, text_at(a, "verdict"), first_slip ? measured_time_text(*first_slip, error("first_slip")) : "–",
                 measured_text(number_at(a, "largest_required_pressure"), error("largest_required_pressure"), "Pa"),
                 extreme_time_text(number_at(a, "t_largest_required_pressure"), error("t_largest_required_pressure")),
                 small_margin_text(number_at(a, "smallest_margin"), error("smallest_margin")),
                 x && y ? measured_text(slid, portable::hypot(*x, *y), "m") : quantity_text(slid, "m", 1e-3),
                 x ? measured_text(area_lost, error("area_lost"), "m^2") : quantity_text(area_lost, "m^2", 1.0)});
}

void print_joints(std::ostream& out, const TabledRun& run) {
  if (!run.summary.contains("joints")) return;
  TextTable table({Align::left, Align::left, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right});
  table.add_row({"", "verdict", "first slip", "largest p_req", "at", "margin", "slid", "area lost"});
  for (const auto& [joint, a] : run.summary.at("joints").items()) add_joint(table, joint, a);
  out << "\nStep-lap joints\n" << table;
  for (const auto& [joint, a] : run.summary.at("joints").items()) print_edges_and_parallel_elements(out, joint, a);
}

std::string value_beside_limit(const Json& criterion) {
  const auto value = optional_at(criterion, "value"), limit = optional_at(criterion, "limit");
  if (!value || !limit) return "";
  const std::string unit = text_at(criterion, "unit");
  return measured_text(*value, optional_at(criterion, "error"), unit) + " (limit " + quantity_text(*limit, unit) + ")";
}

void print_second_opinion(std::ostream& out, const Json& opinion, double end) {
  const double known_until = number_at(opinion, "known_until");
  out << "  Second opinion, " << text_at(opinion, "method") << ": ";
  if (!text_at(opinion, "disagreement").empty()) out << "disagrees\n";
  else if (!text_at(opinion, "none_because").empty()) out << "none; " << text_at(opinion, "none_because") << "\n";
  else if (known_until < end * (1.0 - 1e-6))
    out << "agrees up to t = " << quantity_text(known_until, "s") << " and cannot be compared from there on\n";
  else out << "agrees; the worst difference is " << small_text(number_at(opinion, "worst_ratio")) << " of what both errors allow\n";
}

void print_judgement(std::ostream& out, const TabledRun& run) {
  if (!run.summary.contains("judgement")) return;
  const Json &judgement = run.summary.at("judgement"), &criteria = judgement.at("criteria");
  if (const std::string why = text_at(judgement, "distrust"); !why.empty()) out << "\nNOT TO BE TRUSTED: " << why << "\n";
  if (criteria.empty()) return;
  out << "\nVerdict by the criteria of the model: " << text_at(judgement, "verdict");
  if (run.summary.contains("failure")) out << "; the run broke off, until then: " << text_at(judgement, "so_far");
  out << "\n";
  for (const Json& why : judgement.at("capped_by")) out << "  It cannot be \"hold\": " << why.get<std::string>() << "\n";
  TextTable table({Align::left, Align::left, Align::left, Align::right, Align::right});
  for (const Json& c : criteria) {
    const auto t = optional_at(c, "t");
    const std::string outcome = text_at(c, "outcome");
    table.add_row({text_at(c, "name"), text_at(c, "criterion"), outcome == name_of(Verdict::hold) ? "met" : outcome, value_beside_limit(c),
                   t ? "at " + extreme_time_text(*t, optional_at(c, "error_t")) : ""});
  }
  out << table;
  bool is_undecided = false;
  for (const Json& c : criteria) {
    if (text_at(c, "doubt").empty()) continue;
    out << "  '" << text_at(c, "name") << "', " << text_at(c, "criterion") << ": " << text_at(c, "doubt") << "\n";
    is_undecided = true;
  }
  if (!run.has_errors()) out << "  judged without the errors of the numbers: " << why_not_estimated(run) << "\n";
  if (is_undecided) out << "  A smaller tolerance or step decides.\n";
  if (run.summary.contains("second_opinion"))
    print_second_opinion(out, run.summary.at("second_opinion"), number_at(run.summary.at("final_state"), "t"));
}

// Formats "rk4, step 5e-05 s and 2.5e-05 s", "auto, tolerance 1e-09 and 1e-11".
std::string finer_text(const Json& finer, bool has_steps) {
  std::string text = text_at(finer.back(), "integrator"), before = has_steps ? ", step " : ", tolerance ";
  for (const Json& options : finer) {
    text += before + (has_steps ? number_text(number_at(options, "step")) + " s" : rounded_text(number_at(options, "tolerance")));
    before = " and ";
  }
  return text;
}

bool rests(const TabledRun& run) { return run.summary.at("accuracy").at("rests").get<bool>(); }

void print_global_error(std::ostream& out, const TabledRun& run) {
  if (!run.has_errors()) return;
  const Json &estimate = run.summary.at("global_error"), &finer = estimate.at("finer_runs");
  if (rests(run)) {
    out << "\nThe machine rests: nothing moves but by rounding, so that errors have no range to be measured by\n";
    return;
  }
  if (estimate.contains("unknown_because")) {
    out << "\nGlobal error: unknown; " << text_at(estimate, "unknown_because") << "\n";
    return;
  }
  const bool is_by_references = estimate.contains("references");
  const bool has_steps = !is_by_references && number_at(finer.back(), "step") != number_at(estimate.at("run"), "step");
  out << "\nGlobal error, estimated from "
      << (is_by_references   ? "two adaptive runs ("
          : finer.size() > 1 ? "finer runs ("
                             : "a finer run (")
      << finer_text(finer, has_steps) << "); of each channel's range\n";
  TextTable table({Align::left, Align::right, Align::left});
  double largest = 0.0;
  for (std::size_t k = 0; k < k_error_kinds; ++k) {
    const char* const kind = name_of(static_cast<ErrorKind>(k));
    const Json& worst = estimate.at(kind);
    const double error = number_at(worst, "error");
    const std::string where = text_at(worst, "where");
    table.add_row({kind, std::isnan(error) ? "unknown" : small_text(error),
                   where.empty() ? "" : where + " at " + quantity_text(number_at(worst, "t"), "s")});
    if (!(error <= largest)) largest = error;
  }
  out << table;
  const double times_tolerance = largest / number_at(estimate.at("run"), "tolerance");
  if (!is_by_references && !has_steps && times_tolerance > 1.0)
    out << "  the largest is " << small_text(times_tolerance) << " times the tolerance, which is meant for each step\n";
  if (const auto unmatched = estimate.at("unmatched_events").get<std::size_t>(); unmatched > 0)
    out << "  " << counted(unmatched, "event is", "events are") << " in one of the runs only: the run is not converged there\n";
}

// Rows of the last table: a name, and a function that formats a run's value.
struct Figure {
  std::string name;
  std::function<std::string(const TabledRun&)> text;
};

// Returns the error of kinetic energy, work or dissipation, whose balance is known up to the residual.
std::optional<double> exchanged_error(const Json& accuracy) {
  const auto dissipated = error_at(accuracy, "error_dissipated"), work = error_at(accuracy, "error_work");
  if (!dissipated || !work) return {};
  return larger_error(larger_error(*dissipated, *work), number_at(accuracy, "energy_residual"));
}

Figure residual(const char* name, const char* key, const char* unit = "") {
  return {name, [key, unit](const TabledRun& run) { return small_text(number_at(run.summary.at("accuracy"), key)) + unit; }};
}

Figure count(const char* name, const char* key) {
  return {name, [key](const TabledRun& run) { return std::to_string(run.summary.at("statistics").at(key).get<long>()); }};
}

std::vector<Figure> accuracy_and_cost(bool has_cost) {
  std::vector<Figure> figures{residual("energy residual", "energy_residual", " J"),
                              {"energy exchanged",
                               [](const TabledRun& run) {
                                 const Json& accuracy = run.summary.at("accuracy");
                                 return measured_text(number_at(accuracy, "energy_exchanged"), exchanged_error(accuracy), "J");
                               }},
                              {"energy dissipated",
                               [](const TabledRun& run) {
                                 const Json& accuracy = run.summary.at("accuracy");
                                 return measured_text(number_at(accuracy, "dissipated"), error_at(accuracy, "error_dissipated"), "J");
                               }},
                              {"energy residual, relative",
                               [](const TabledRun& run) {
                                 return rests(run) ? "nothing is exchanged"
                                                   : small_text(number_at(run.summary.at("accuracy"), "relative_energy_residual"));
                               }},
                              residual("constraint residual, m or rad", "max_position_residual"),
                              residual("constraint residual, per s", "max_velocity_residual"),
                              count("steps", "steps"),
                              count("steps rejected", "rejections"),
                              count("evaluations", "evaluations")};
  if (has_cost) figures.push_back({"CPU time", [](const TabledRun& run) { return quantity_text(1e3 * run.run.cost->cpu_seconds, "ms"); }});
  return figures;
}

void print_place(std::ostream& out, const ShownRun& run) {
  if (!run.cost) {
    out << "Results: " << shown(run.folder) << "\n";
    return;
  }
  const char* const part = run.summary.contains("failure") ? "partial_" : "";
  out << "Written to " << run.folder << ": " << part << "trajectory.csv (" << counted(run.cost->rows, "row", "rows") << ", "
      << counted(run.cost->channels, "channel", "channels") << ")";
  for (const char* file : {"events.csv", "summary.json", "model.toml", "drawing.json"}) out << ", " << part << file;
  out << "\n";
}

using Tabled = std::vector<TabledRun>;

TextTable::Row cells(const std::string& name, const Tabled& runs, const std::function<std::string(const TabledRun&)>& text) {
  TextTable::Row row{name};
  for (const TabledRun& run : runs) row.push_back(text(run));
  return row;
}

// Returns the channels reported by any run, in order of appearance.
template <class Predicate> std::vector<std::string> channel_names(const Tabled& runs, Predicate is_wanted) {
  std::vector<std::string> names;
  std::unordered_set<std::string> known;
  for (const TabledRun& run : runs)
    for (const ShownRange& range : run.ranges)
      if (is_wanted(range) && known.insert(range.name).second) names.push_back(range.name);
  return names;
}

// Prints the columns "lowest" and "highest" of a channel for each run.
void add_range_row(TextTable& table, const Tabled& runs, const std::string& name) {
  TextTable::Row row{name};
  for (const TabledRun& run : runs) {
    const ShownRange* range = run.find(name);
    row.push_back(range ? value_text(*range, range->low) : "–");
    row.push_back(range ? value_text(*range, range->high) : "–");
  }
  table.add_row(row);
}

void print_side_by_side(std::ostream& out, const Tabled& runs, const std::vector<std::string>& names, const char* title) {
  if (names.empty()) return;
  std::vector<Align> columns(2 * runs.size() + 1, Align::right);
  columns.front() = Align::left;
  TextTable table(columns);
  TextTable::Row models{""}, heads{""};
  for (const TabledRun& run : runs) {
    models.insert(models.end(), {run.name, ""});
    heads.insert(heads.end(), {"lowest", "highest"});
  }
  table.add_row(models);
  table.add_row(heads);
  for (const std::string& name : names) add_range_row(table, runs, name);
  out << title << ", extremes of the whole run (their times: summary.json)\n" << table;
}

void print_requested_side_by_side(std::ostream& out, const Tabled& runs) {
  std::vector<std::string> names = channel_names(runs, is_requested);
  const std::size_t left_out = names.size() > k_most_requested ? names.size() - k_most_requested : 0;
  names.erase(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(left_out));
  print_side_by_side(out, runs, names, "\nChannels on request");
  if (left_out > 0) out << "  and " << left_out << " more: see summary.json\n";
}

void print_run(std::ostream& out, const ShownRun& shown) {
  const TabledRun run(shown);
  print_heading(out, run);
  print_events(out, shown.events);
  print_reactions(out, run);
  print_slides(out, run);
  print_requested(out, run);
  print_joints(out, run);
  print_judgement(out, run);
  print_global_error(out, run);
  TextTable table({Align::left, Align::right});
  for (const Figure& figure : accuracy_and_cost(shown.cost.has_value())) table.add_row({figure.name, figure.text(run)});
  out << "\nAccuracy and cost\n" << table << "\n";
  print_place(out, shown);
}

void print_comparison(std::ostream& out, const std::vector<ShownRun>& shown) {
  Tabled runs;
  runs.reserve(shown.size());
  for (const ShownRun& run : shown) runs.emplace_back(run);
  std::unordered_map<std::string, int> times;
  for (const TabledRun& run : runs) ++times[run.name];
  for (TabledRun& run : runs)
    if (times[run.name] > 1) run.name = run.run.folder; // several runs of the same model
  for (const TabledRun& run : runs) {
    print_heading(out, run);
    print_events(out, run.run.events);
    print_joints(out, run);
    print_judgement(out, run);
    print_global_error(out, run);
    out << "\n";
  }
  std::vector<Align> columns(runs.size() + 1, Align::right);
  columns.front() = Align::left;
  TextTable table(columns);
  table.add_row(cells("", runs, [](const TabledRun& run) { return run.name; }));
  for (const std::string& name : channel_names(runs, [](const ShownRange& r) { return is_slide(r.name); }))
    table.add_row(cells(name + ", largest", runs, [&](const TabledRun& run) -> std::string {
      const ShownRange* range = run.find(name);
      return range ? value_text(*range, range->largest()) : "–";
    }));
  const bool have_cost = std::all_of(shown.begin(), shown.end(), [](const ShownRun& run) { return run.cost.has_value(); });
  for (const Figure& figure : accuracy_and_cost(have_cost)) table.add_row(cells(figure.name, runs, figure.text));
  print_side_by_side(out, runs, channel_names(runs, is_shown), "Reactions and required pressures");
  print_requested_side_by_side(out, runs);
  out << "\nSide by side\n" << table;
  out << "\n";
  for (const ShownRun& run : shown) print_place(out, run);
}

} // namespace

void print_tables(std::ostream& out, const std::vector<ShownRun>& runs) {
  if (runs.size() == 1) print_run(out, runs.front());
  else print_comparison(out, runs);
}

} // namespace steplap
