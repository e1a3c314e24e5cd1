#include "tools/steplap/run_screen.h"

#include "elements/step_lap_assessment.h"
#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/math/portable_math.h"
#include "mbd/model/validate.h"
#include "run/measured_text.h"
#include "run/prominence.h"
#include "run/quantity_text.h"
#include "tools/steplap/text_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

namespace steplap {

namespace {

using Align = TextTable::Align;

constexpr std::size_t k_most_events_shown = 30;

// "0.6", "12"
std::string rough_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value < 10.0 ? "%.1g" : "%.0f", value);
  return text;
}

// With the option that asks for what was too dear.
std::string why_not_estimated(const Estimate& estimate) {
  return estimate.reason + (estimate.status == EstimateStatus::too_dear ? " (--estimate-error)" : "");
}

void print_no_estimate(std::ostream& out, const Report& report) {
  if (report.estimate.errors) return;
  out << "  error not estimated: ";
  if (!report.estimate.cost) out << why_not_estimated(report.estimate) << "\n";
  else out << "would take about " << rough_text(*report.estimate.cost) << " s; ask with --estimate-error\n";
}

void print_heading(std::ostream& out, const FinishedRun& finished) {
  const LoadedModel& loaded = *finished.report.run.loaded;
  const SimulationSettings& s = loaded.model.simulation;
  out << loaded.name;
  if (!loaded.model.header.title.empty()) out << ": " << loaded.model.header.title;
  out << "\n  " << s.integrator;
  if (s.step && has_fixed_step(s.integrator)) out << ", step " << number_text(*s.step) << " s";
  if (s.tolerance && !has_fixed_step(s.integrator)) out << ", tolerance " << number_text(*s.tolerance);
  out << ", t = 0 to " << number_text(finished.report.run.result.final_state.t) << " s\n";
  if (finished.report.run.failure)
    out << "  STOPPED before the end: " << finished.report.run.failure->text << "\n";
  print_no_estimate(out, finished.report);
}

void print_events(std::ostream& out, const FinishedRun& finished) {
  const std::vector<Event>& events = finished.report.run.result.events;
  const auto main = std::count_if(events.begin(), events.end(), is_main_event);
  out << "\nEvents: " << (events.empty() ? "none" : std::to_string(events.size()));
  if (main < static_cast<long>(events.size()))
    out << "; without changes of foot and kinks of a force " << main;
  out << "\n";
  TextTable table({Align::right, Align::left, Align::left});
  std::size_t shown = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    if (!is_main_event(event)) continue;
    if (shown++ < k_most_events_shown)
      table.add_row({measured_time_text(event.t, finished.report.event_error(i)), event.element, event.words()});
  }
  out << table;
  if (shown > k_most_events_shown)
    out << "  … and " << shown - k_most_events_shown << " more: see events.csv\n";
}

// Channels that are told of: reactions that are not zero throughout.
bool is_shown(const ChannelRange& range) {
  return is_reaction(*range.channel) && !std::isnan(range.low.value) && range.largest().value != 0.0;
}

// What is rounding beside the channel's largest value is zero; an error says so itself.
std::string value_text(const Report& report, const ChannelRange& range, const Extreme& extreme) {
  const std::string& unit = range.channel->unit;
  const auto error = report.error_of(range, &extreme == &range.low ? &ChannelError::low : &ChannelError::high);
  const bool is_singular = &extreme == &range.low ? range.is_low_singular : range.is_high_singular;
  if (is_singular && error && std::isnan(*error)) return "diverges at a singular pose";
  return error ? measured_text(extreme.value, error, unit) : quantity_text(extreme.value, unit, range.largest().value);
}

std::string extreme_time_text(double t, std::optional<double> error) {
  return error ? measured_time_text(t, error) : quantity_text(t, "s");
}

std::string time_of_text(const Report& report, const ChannelRange& range, const Extreme& extreme) {
  return extreme_time_text(extreme.t, report.error_of(range, &extreme == &range.low ? &ChannelError::t_low : &ChannelError::t_high));
}

// Of a joint that bears nothing but rounding, digits of its margin would say something that is not so.
std::string small_margin_text(double margin, std::optional<double> error) {
  constexpr double k_unloaded = 1e9; // beyond it a margin is followed by its size only (mbd/simulation/extremes.cpp)
  if (!std::isfinite(margin)) return "–";
  if (margin > k_unloaded) return "> 1e9";
  if (error) return measured_text(margin, error, "");
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", margin);
  return text;
}

void print_reactions(std::ostream& out, const Report& report) {
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right});
  table.add_row({"", "lowest", "at", "highest", "at"});
  bool is_any = false;
  for (const ChannelRange& range : report.ranges()) {
    if (!is_shown(range)) continue;
    is_any = true;
    table.add_row({range.channel->name, value_text(report, range, range.low), time_of_text(report, range, range.low),
                   value_text(report, range, range.high), time_of_text(report, range, range.high)});
  }
  if (is_any) out << "\nReactions and required pressures, extremes of the whole run\n" << table;
}

bool is_requested(const ChannelRange& range) {
  return range.channel->is_on_request && !is_shown(range) && !std::isnan(range.low.value);
}

constexpr std::size_t k_most_requested = 24;

// What the model asks for besides, in the order in which it is made: formulas come last, and are the last to be left out.
void print_requested(std::ostream& out, const Report& report) {
  std::vector<const ChannelRange*> asked;
  for (const ChannelRange& range : report.ranges())
    if (is_requested(range)) asked.push_back(&range);
  const std::size_t left_out = asked.size() > k_most_requested ? asked.size() - k_most_requested : 0;
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right});
  table.add_row({"", "lowest", "at", "highest", "at"});
  for (std::size_t i = left_out; i < asked.size(); ++i) {
    const ChannelRange& range = *asked[i];
    table.add_row({range.channel->name, value_text(report, range, range.low), time_of_text(report, range, range.low),
                   value_text(report, range, range.high), time_of_text(report, range, range.high)});
  }
  if (asked.empty()) return;
  out << "\nChannels on request, extremes of the whole run\n" << table;
  if (left_out > 0) out << "  and " << left_out << " more: see summary.json\n";
}

void print_slides(std::ostream& out, const Report& report) {
  TextTable table({Align::left, Align::right, Align::right});
  for (const ChannelRange& range : report.ranges())
    if (is_slide(*range.channel))
      table.add_row({range.channel->name, value_text(report, range, range.largest()),
                     "at " + time_of_text(report, range, range.largest())});
  if (!table.is_empty()) out << "\nLargest slides\n" << table;
}

// Edges that bore, and what bears beside a joint.
void print_beside(std::ostream& out, const JointAssessment& a, const std::optional<JointErrors>& e) {
  if (a.has_edges && a.edge_load.value > 0.0) {
    out << "  " << a.joint << ": sheet edges bore up to "
        << measured_text(a.edge_load.value, e ? std::optional(e->edge_load) : std::nullopt, "N/m");
    if (a.allowed_line_load) out << ", allowed are " << quantity_text(*a.allowed_line_load, "N/m");
    out << "\n";
  }
  if (a.shared_with.empty()) return;
  out << "  " << a.joint << ": margin of its own share; beside it";
  for (const SharedLoad& shared : a.shared_with) {
    out << (&shared == &a.shared_with.front() ? " '" : ", '") << shared.element << "'";
    if (!std::isnan(shared.largest)) out << " with up to " << quantity_text(shared.largest, "N");
  }
  out << (a.is_elastic ? "\n" : " (the joint is rigid: they take no part before it slides)\n");
}

void print_joints(std::ostream& out, const FinishedRun& finished) {
  const auto& joints = finished.report.joints;
  TextTable table({Align::left, Align::left, Align::right, Align::right, Align::right, Align::right,
                   Align::right, Align::right});
  table.add_row({"", "verdict", "first slip", "largest p_req", "at", "margin", "slid", "area lost"});
  for (const JointAssessment& a : joints) {
    std::optional<JointErrors> e;
    if (const auto& estimate = finished.report.estimate.errors)
      e = joint_errors(a, *finished.report.run.loaded->system, finished.report.run.result, *estimate);
    const auto error = [&e](double JointErrors::*which) { return e ? std::optional((*e).*which) : std::nullopt; };
    const double slid = portable::hypot(a.slid_x, a.slid_y);
    const auto slid_error = e ? std::optional(portable::hypot(e->slid_x, e->slid_y)) : std::nullopt;
    table.add_row({a.joint, words_of(a.verdict), a.first_slip ? measured_time_text(*a.first_slip, error(&JointErrors::first_slip)) : "–",
                   measured_text(a.largest_required_pressure, error(&JointErrors::largest_required_pressure), "Pa"),
                   extreme_time_text(a.time_of_largest, error(&JointErrors::time_of_largest)),
                   small_margin_text(a.smallest_margin, error(&JointErrors::smallest_margin)),
                   e ? measured_text(slid, slid_error, "m") : quantity_text(slid, "m", 1e-3),
                   e ? measured_text(a.area_lost, e->area_lost, "m^2") : quantity_text(a.area_lost, "m^2", 1.0)});
  }
  if (!joints.empty()) out << "\nStep-lap joints\n" << table;
  for (const JointAssessment& a : joints) {
    std::optional<JointErrors> e;
    if (const auto& estimate = finished.report.estimate.errors)
      e = joint_errors(a, *finished.report.run.loaded->system, finished.report.run.result, *estimate);
    print_beside(out, a, e);
  }
}

std::string value_beside_limit(const CriterionResult& c) {
  if (!c.value || !c.limit) return "";
  return measured_text(*c.value, c.error, c.unit) + " (limit " + quantity_text(*c.limit, c.unit) + ")";
}

void print_second_opinion(std::ostream& out, const SecondOpinion& opinion, double end) {
  out << "  Second opinion, " << opinion.method << ": ";
  if (!opinion.disagreement.empty()) out << "disagrees\n";
  else if (!opinion.none_because.empty()) out << "none; " << opinion.none_because << "\n";
  else if (opinion.known_until < end * (1.0 - 1e-6)) out << "agrees up to t = " << quantity_text(opinion.known_until, "s") << " and cannot tell from there on\n";
  else out << "agrees; the worst difference is " << small_text(opinion.worst_ratio) << " of what both errors allow\n";
}

void print_judgement(std::ostream& out, const FinishedRun& finished) {
  const Judgement& judgement = finished.report.judgement;
  if (!judgement.distrust.empty()) out << "\nNOT TO BE TRUSTED: " << judgement.distrust << "\n";
  if (!judgement.has_criteria) return;
  out << "\nVerdict by the criteria of the model: " << name_of(judgement.verdict);
  if (finished.report.run.failure) out << "; the run broke off, until then: " << name_of(judgement.so_far);
  out << "\n";
  for (const std::string& why : judgement.caps) out << "  It cannot be \"hold\": " << why << "\n";
  TextTable table({Align::left, Align::left, Align::left, Align::right, Align::right});
  for (const CriterionResult& c : judgement.criteria)
    table.add_row({c.name, c.text, c.outcome == Verdict::hold ? "met" : name_of(c.outcome), value_beside_limit(c),
                   c.t ? "at " + extreme_time_text(*c.t, c.t_error) : ""});
  out << table;
  for (const CriterionResult& c : judgement.criteria)
    if (!c.doubt.empty()) out << "  '" << c.name << "', " << c.text << ": " << c.doubt << "\n";
  const bool is_in_doubt = std::any_of(judgement.criteria.begin(), judgement.criteria.end(),
                                       [](const CriterionResult& c) { return !c.doubt.empty(); });
  if (!finished.report.estimate.errors) out << "  judged without the errors of the numbers: " << why_not_estimated(finished.report.estimate) << "\n";
  if (is_in_doubt) out << "  A smaller tolerance or step decides.\n";
  if (finished.report.second_opinion) print_second_opinion(out, *finished.report.second_opinion, finished.report.run.result.final_state.t);
}

// "rk4, step 5e-05 s and 2.5e-05 s"
std::string finer_text(const std::vector<SimulationOptions>& finer, const SimulationOptions& asked) {
  std::string text = finer.back().integrator, before = ", step ";
  if (finer.back().settings.step == asked.settings.step) return text + ", tolerance " + rounded_text(finer.back().settings.tolerance);
  for (const SimulationOptions& options : finer) {
    text += before + number_text(options.settings.step) + " s";
    before = " and ";
  }
  return text;
}

// What moves and what is exchanged is rounding: it has no range by which an error could be measured.
bool rests(const FinishedRun& f) {
  const RunStatistics& s = f.report.run.result.statistics;
  return s.energy_exchanged <= s.energy_rounding && f.report.run.loaded->system->kinetic_energy(f.report.run.result.final_state) <= s.energy_rounding;
}

void print_global_error(std::ostream& out, const FinishedRun& finished) {
  if (!finished.report.estimate.errors) return;
  const GlobalErrorEstimate& estimate = *finished.report.estimate.errors;
  if (rests(finished)) {
    out << "\nThe machine rests: nothing moves but by rounding, so that errors have no range to be measured by\n";
    return;
  }
  if (!estimate.unknown_because.empty()) {
    out << "\nGlobal error: unknown; " << estimate.unknown_because << "\n";
    return;
  }
  const SimulationOptions asked = options_of(finished.report.run.loaded->model);
  out << "\nGlobal error, estimated from " << (estimate.finer.size() > 1 ? "finer runs (" : "a finer run (")
      << finer_text(estimate.finer, asked) << "); of each channel's range\n";
  TextTable table({Align::left, Align::right, Align::left});
  for (std::size_t k = 0; k < k_error_kinds; ++k) {
    const WorstError& worst = estimate.error.worst[k];
    table.add_row({name_of(static_cast<ErrorKind>(k)), std::isnan(worst.value) ? "unknown" : small_text(worst.value),
                   worst.where.empty() ? "" : worst.where + " at " + quantity_text(worst.t, "s")});
  }
  out << table;
  const double times_tolerance = estimate.error.largest() / asked.settings.tolerance;
  if (estimate.finer.back().settings.step == asked.settings.step && times_tolerance > 1.0)
    out << "  the largest is " << small_text(times_tolerance) << " times the tolerance, which is meant for each step\n";
  if (estimate.error.unmatched_events > 0)
    out << "  " << counted(static_cast<std::size_t>(estimate.error.unmatched_events), "event is", "events are") << " in one of the runs only: the run is not converged there\n";
}

// Rows of the last table: name and how a run's value reads.
struct Figure {
  std::string name;
  std::string (*text)(const FinishedRun&);
};

const RunStatistics& statistics(const FinishedRun& f) {
  return f.report.run.result.statistics;
}

// Of kinetic energy, work or dissipation, the balance of which is known to the residual.
std::optional<double> exchanged_error(const FinishedRun& f) {
  if (!f.report.estimate.errors) return {};
  return larger_error(larger_error(*f.report.dissipated_error(), *f.report.work_error()), statistics(f).energy_residual);
}

const std::vector<Figure>& accuracy_and_cost() {
  static const std::vector<Figure> figures{
      {"energy residual",
       [](const FinishedRun& f) { return small_text(statistics(f).energy_residual) + " J"; }},
      {"energy exchanged",
       [](const FinishedRun& f) { return measured_text(statistics(f).energy_exchanged, exchanged_error(f), "J"); }},
      {"energy dissipated",
       [](const FinishedRun& f) { return measured_text(statistics(f).dissipated, f.report.dissipated_error(), "J"); }},
      {"energy residual, relative",
       [](const FinishedRun& f) { return rests(f) ? "nothing is exchanged" : small_text(f.report.relative_energy_residual); }},
      {"constraint residual, m or rad",
       [](const FinishedRun& f) { return small_text(statistics(f).max_position_residual); }},
      {"constraint residual, per s",
       [](const FinishedRun& f) { return small_text(statistics(f).max_velocity_residual); }},
      {"steps", [](const FinishedRun& f) { return std::to_string(statistics(f).steps); }},
      {"steps rejected", [](const FinishedRun& f) { return std::to_string(statistics(f).rejections); }},
      {"evaluations", [](const FinishedRun& f) { return std::to_string(statistics(f).evaluations); }},
      {"CPU time", [](const FinishedRun& f) {
         return quantity_text(1e3 * statistics(f).cpu_seconds, "ms");
       }}};
  return figures;
}

void print_place(std::ostream& out, const FinishedRun& finished) {
  const Trajectory& trajectory = *finished.report.run.result.trajectory;
  if (finished.folder.empty()) return;
  const char* const part = !finished.report.run.failure ? "" : "partial_";
  out << "Written to " << finished.folder << ": " << part << "trajectory.csv (" << counted(trajectory.size(), "row", "rows") << ", "
      << counted(trajectory.channels().size(), "channel", "channels") << ")";
  for (const char* file : {"events.csv", "summary.json", "model.toml", "drawing.json"}) out << ", " << part << file;
  out << "\n";
}

std::vector<std::string> cells(std::string name, const std::vector<FinishedRun>& runs,
                               const std::function<std::string(const FinishedRun&)>& text) {
  std::vector<std::string> row{std::move(name)};
  for (const FinishedRun& run : runs)
    row.push_back(text(run));
  return row;
}

// Names of the channels that any run tells of, in the order in which they come.
template <class Predicate>
std::vector<std::string> channel_names(const std::vector<FinishedRun>& runs, Predicate is_wanted) {
  std::vector<std::string> names;
  for (const FinishedRun& run : runs)
    for (const ChannelRange& range : run.report.ranges())
      if (is_wanted(range) &&
          std::find(names.begin(), names.end(), range.channel->name) == names.end())
        names.push_back(range.channel->name);
  return names;
}

// "lowest" and "highest" of a channel for each run, or the one further from zero.
void add_range_row(TextTable& table, const std::vector<FinishedRun>& runs, const std::string& name) {
  std::vector<std::string> row{name};
  for (const FinishedRun& run : runs) {
    const ChannelRange* range = run.report.find(name);
    row.push_back(range ? value_text(run.report, *range, range->low) : "–");
    row.push_back(range ? value_text(run.report, *range, range->high) : "–");
  }
  table.add_row(row);
}

void print_side_by_side(std::ostream& out, const std::vector<FinishedRun>& runs, const std::vector<std::string>& names, const char* title) {
  if (names.empty()) return;
  std::vector<Align> columns(2 * runs.size() + 1, Align::right);
  columns.front() = Align::left;
  TextTable table(columns);
  std::vector<std::string> models{""}, heads{""};
  for (const FinishedRun& run : runs) {
    models.insert(models.end(), {run.report.run.loaded->name, ""});
    heads.insert(heads.end(), {"lowest", "highest"});
  }
  table.add_row(models);
  table.add_row(heads);
  for (const std::string& name : names)
    add_range_row(table, runs, name);
  out << title << ", extremes of the whole run (their times: summary.json)\n" << table;
}

void print_requested_side_by_side(std::ostream& out, const std::vector<FinishedRun>& runs) {
  std::vector<std::string> names = channel_names(runs, is_requested);
  const std::size_t left_out = names.size() > k_most_requested ? names.size() - k_most_requested : 0;
  names.erase(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(left_out));
  print_side_by_side(out, runs, names, "\nChannels on request");
  if (left_out > 0) out << "  and " << left_out << " more: see summary.json\n";
}

} // namespace

void print_run(std::ostream& out, const FinishedRun& finished) {
  print_heading(out, finished);
  print_events(out, finished);
  print_reactions(out, finished.report);
  print_slides(out, finished.report);
  print_requested(out, finished.report);
  print_joints(out, finished);
  print_judgement(out, finished);
  print_global_error(out, finished);
  TextTable table({Align::left, Align::right});
  for (const Figure& figure : accuracy_and_cost())
    table.add_row({figure.name, figure.text(finished)});
  out << "\nAccuracy and cost\n" << table << "\n";
  print_place(out, finished);
}

void print_comparison(std::ostream& out, const std::vector<FinishedRun>& runs) {
  for (const FinishedRun& run : runs) {
    print_heading(out, run);
    print_events(out, run);
    print_joints(out, run);
    print_judgement(out, run);
    print_global_error(out, run);
    out << "\n";
  }
  std::vector<Align> columns(runs.size() + 1, Align::right);
  columns.front() = Align::left;
  TextTable table(columns);
  table.add_row(cells("", runs, [](const FinishedRun& run) { return run.report.run.loaded->name; }));
  for (const std::string& name :
       channel_names(runs, [](const ChannelRange& r) { return is_slide(*r.channel); }))
    table.add_row(cells(name + ", largest", runs, [&](const FinishedRun& run) -> std::string {
      const ChannelRange* range = run.report.find(name);
      return range ? value_text(run.report, *range, range->largest()) : "–";
    }));
  for (const Figure& figure : accuracy_and_cost())
    table.add_row(cells(figure.name, runs, figure.text));
  print_side_by_side(out, runs, channel_names(runs, is_shown), "Reactions and required pressures");
  print_requested_side_by_side(out, runs);
  out << "\nSide by side\n" << table;
  out << "\n";
  for (const FinishedRun& run : runs)
    print_place(out, run);
}

} // namespace steplap
