#include "tools/steplap/accuracy_report.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/csv.h"
#include "mbd/run/quantity_text.h"
#include "tools/steplap/json_screen.h"
#include "tools/steplap/text_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

namespace steplap {

namespace {

using Align = TextTable::Align;

constexpr ErrorKind k_kinds[] = {ErrorKind::position, ErrorKind::velocity, ErrorKind::reaction, ErrorKind::event_time};

std::string milliseconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", 1e3 * seconds);
  return text;
}

// Formats an error: "3.1e-09", "<2e-12" below the resolution of the reference, "–" if the reference is not converged.
Cell error_cell(const AccuracyStudy& study, const AccuracyEntry& entry, ErrorKind kind) {
  if (!study.is_resolved(kind)) return "–";
  const double error = entry.error.of(kind).value, resolution = study.resolution.of(kind).value;
  return error < resolution ? Cell("<" + small_text(resolution)) : Cell(small_text(error), error);
}

Cell number_cell(double value) { return {small_text(value), value}; }
Cell whole_cell(long count) { return {std::to_string(count), static_cast<double>(count)}; }

std::string events_text(const AccuracyStudy& study, const AccuracyEntry& entry) {
  std::string text = std::to_string(entry.cost.events);
  if (study.is_resolved(ErrorKind::event_time) && entry.error.unmatched_events > 0)
    text += " (" + std::to_string(entry.error.unmatched_events) + " differ)";
  return text;
}

void print_reference(std::ostream& out, const AccuracyStudy& study) {
  out << "  reference: " << study.first_reference.text() << " and " << study.second_reference.text() << " differ by at most\n";
  for (const ErrorKind kind : k_kinds) {
    const WorstError& worst = study.resolution.of(kind);
    out << "    " << small_text(worst.value) << " in " << name_of(kind);
    if (!worst.where.empty()) out << " (" << worst.where << " at " << rounded_text(worst.t, 12) << " s)";
    if (!study.is_resolved(kind)) out << ": too much, nothing is said of them";
    out << "\n";
  }
  if (study.resolution.unmatched_events > 0)
    out << "    " << counted(static_cast<std::size_t>(study.resolution.unmatched_events), "event has", "events have")
        << " no partner: nothing is said of event times\n";
}

// Prints the cheapest setting for each wanted error.
void print_answer(std::ostream& out, const AccuracyStudy& study, const std::vector<double>& wanted) {
  for (const double error : wanted) {
    const AccuracyEntry* const best = study.cheapest(error);
    out << "  cheapest for an error of " << number_text(error) << ": "
        << (best ? best->setting.text() + ", " + milliseconds(best->cpu_seconds) + " ms" : "none of these") << "\n";
  }
}

constexpr std::size_t k_most_rows = 12; // largest number of rows printed on the screen

// Returns the entries for the screen, in the order of the study. Pareto-optimal entries (no other is both faster and more accurate) are
// chosen first, then the cheapest of the others.
std::vector<const AccuracyEntry*> entries_to_show(const AccuracyStudy& study, bool are_all) {
  std::vector<const AccuracyEntry*> entries;
  for (const AccuracyEntry& e : study.entries)
    if (e.failure.empty()) entries.push_back(&e);
  if (are_all || entries.size() <= k_most_rows) return entries;
  std::stable_sort(entries.begin(), entries.end(), [](const AccuracyEntry* a, const AccuracyEntry* b) {
    return a->is_pareto != b->is_pareto ? a->is_pareto : a->cpu_seconds < b->cpu_seconds;
  });
  entries.resize(k_most_rows);
  std::sort(entries.begin(), entries.end()); // restores the order of the study: the pointers refer to one vector
  return entries;
}

// --- diagram ------------------------------------------------------------------------------------

constexpr double k_width = 640.0, k_height = 440.0, k_left = 70.0, k_right = 120.0, k_top = 40.0, k_bottom = 55.0;
constexpr const char* k_colours[] = {"#1b6ca8", "#c8553d", "#3a7d44", "#7b4fa3", "#b8860b", "#4a4a4a"};

// A logarithmic axis that begins and ends at whole decades.
struct Axis {
  double low = INFINITY, high = -INFINITY; ///< smallest and largest decade, log10 of the value
  double from = 0.0, to = 1.0;             ///< positions of both ends on the page
  void take(double value) {
    if (!(value > 0.0)) return;
    low = std::min(low, std::floor(portable::log10(value)));
    high = std::max(high, std::ceil(portable::log10(value)));
  }
  void close() {
    if (!(low < high)) high = low + 1.0;
  }
  [[nodiscard]] double at(double value) const { return from + (to - from) * (portable::log10(value) - low) / (high - low); }
};

std::string fixed(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else out += c;
  }
  return out;
}

std::string label(double x, double y, const std::string& anchor, const std::string& content, const std::string& more = "") {
  return "<text x=\"" + fixed(x) + "\" y=\"" + fixed(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" + content + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
  return "<line x1=\"" + fixed(x1) + "\" y1=\"" + fixed(y1) + "\" x2=\"" + fixed(x2) + "\" y2=\"" + fixed(y2) + "\" " + style + "/>\n";
}

std::string power_of_ten(double exponent) {
  return "10<tspan dy=\"-5\" font-size=\"9\">" + std::to_string(static_cast<int>(exponent)) + "</tspan>";
}

std::string grid(const Axis& x, const Axis& y) {
  std::string svg;
  const std::string style = "stroke=\"#dddddd\"";
  for (double d = x.low; d <= x.high + 0.5; d += 1.0) {
    const double at = x.at(portable::pow(10.0, d));
    svg += line(at, y.from, at, y.to, style) + label(at, y.from + 18.0, "middle", power_of_ten(d));
  }
  for (double d = y.low; d <= y.high + 0.5; d += 1.0) {
    const double at = y.at(portable::pow(10.0, d));
    svg += line(x.from, at, x.to, at, style) + label(x.from - 8.0, at + 4.0, "end", power_of_ten(d));
  }
  svg += label(0.5 * (x.from + x.to), k_height - 12.0, "middle", "largest scaled error");
  const double middle = 0.5 * (y.from + y.to);
  svg += label(18.0, middle, "middle", "CPU time, ms", " transform=\"rotate(-90 18 " + fixed(middle) + ")\"");
  return svg;
}

struct DrawnEntry {
  const AccuracyEntry* entry;
  double error;
};

std::vector<DrawnEntry> drawn(const AccuracyStudy& study) {
  std::vector<DrawnEntry> list;
  for (const AccuracyEntry& entry : study.entries)
    if (entry.failure.empty() && study.error_of(entry) > 0.0) list.push_back({&entry, study.error_of(entry)});
  return list;
}

std::string curve(const std::vector<DrawnEntry>& points, const std::string& integrator, const std::string& colour, const Axis& x,
                  const Axis& y) {
  std::string path, dots;
  for (const DrawnEntry& p : points) {
    if (p.entry->setting.integrator != integrator) continue;
    const std::string px = fixed(x.at(p.error)), py = fixed(y.at(1e3 * p.entry->cpu_seconds));
    path += (path.empty() ? "M" : "L") + px + " " + py;
    dots += "<circle cx=\"" + px + "\" cy=\"" + py + "\" r=\"4\" stroke=\"" + colour + "\" fill=\"" +
            (p.entry->is_pareto ? colour : "white") + "\"><title>" + escaped(p.entry->setting.text()) + "</title></circle>\n";
  }
  return "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + colour + "\" stroke-width=\"1.5\"/>\n" + dots;
}

std::vector<std::string> integrators_of(const std::vector<DrawnEntry>& points) {
  std::vector<std::string> names;
  for (const DrawnEntry& p : points)
    if (std::find(names.begin(), names.end(), p.entry->setting.integrator) == names.end()) names.push_back(p.entry->setting.integrator);
  return names;
}

} // namespace

namespace {

// Prints the computing time allowed for the study and the settings that were not tried because of it. A fast computer tries more of them.
void print_budget(std::ostream& out, const AccuracyStudy& study) {
  std::string left_out;
  for (const AccuracyEntry& e : study.entries)
    if (e.is_left_out) left_out += (left_out.empty() ? "" : ", ") + e.setting.text();
  out << "  budget: " << small_text(study.spent) << " of " << number_text(study.budget) << " s of CPU time";
  if (!left_out.empty()) out << "; left out as too dear (--budget gives more): " << left_out;
  out << "\n";
}

} // namespace

void print_accuracy(std::ostream& out, const AccuracyStudy& study, const std::vector<double>& wanted) {
  print_answer(out, study, wanted);
  std::vector<Align> columns(14, Align::right);
  columns[0] = columns[13] = Align::left;
  TextTable table(columns);
  table.set_head("settings",
                 {"setting", "CPU ms", "steps", "rejected", "evaluations", "events", "positions", "velocities", "reactions", "event times",
                  "energy", "constraints", "", ""},
                 {"setting", "CPU ms", "steps", "rejected", "evaluations", "events", "positions", "velocities", "reactions", "event times",
                  "energy", "constraints", "", "pareto"});
  const std::vector<const AccuracyEntry*> entries = entries_to_show(study, json_screen(out) != nullptr);
  for (const AccuracyEntry* const shown : entries) {
    const AccuracyEntry& e = *shown;
    table.add_row({e.setting.text(), Cell(milliseconds(e.cpu_seconds), 1e3 * e.cpu_seconds), whole_cell(e.cost.steps),
                   whole_cell(e.cost.rejections), whole_cell(e.cost.evaluations), events_text(study, e),
                   error_cell(study, e, ErrorKind::position), error_cell(study, e, ErrorKind::velocity),
                   error_cell(study, e, ErrorKind::reaction), error_cell(study, e, ErrorKind::event_time), number_cell(e.energy_residual),
                   number_cell(e.constraint_residual), "", e.is_pareto ? "Pareto" : ""});
  }
  out << table;
  const auto finished = std::count_if(study.entries.begin(), study.entries.end(), [](const AccuracyEntry& e) { return e.failure.empty(); });
  if (const std::size_t more = static_cast<std::size_t>(finished) - entries.size(); more > 0)
    out << "  … and " << more << " more in accuracy.csv\n";
  print_reference(out, study);
  for (const AccuracyEntry& e : study.entries)
    if (!e.failure.empty() && !e.is_left_out) out << "  " << e.setting.text() << " gave nothing: " << e.failure << "\n";
  print_budget(out, study);
  for (const ErrorSlope& s : study.slopes())
    out << "  " << s.integrator << ": error of positions ~ " << (s.is_step ? "step" : "tolerance") << "^" << small_text(s.slope) << " over "
        << small_text(s.decades) << " decades\n";
}

std::string accuracy_csv(const AccuracyStudy& study) {
  std::string csv = "integrator,tolerance,step [s],cpu [s],steps,rejected,evaluations,events,unmatched events,"
                    "positions,velocities,reactions,event times,energy,constraints,pareto,failure\n";
  csv += "# the times, what is Pareto by them and which settings the budget of " + number_text(study.budget) +
         " s permitted depend on the computer and on its clock\n";
  for (const AccuracyEntry& e : study.entries) {
    const std::string value = number_text(e.setting.value);
    csv += e.setting.integrator + (e.setting.is_step ? ",," + value : "," + value + ",");
    if (!e.failure.empty()) {
      csv += ",,,,,,,,,,,,," + csv_field(e.failure) + "\n";
      continue;
    }
    csv += "," + number_text(e.cpu_seconds);
    for (const long count :
         {e.cost.steps, e.cost.rejections, e.cost.evaluations, e.cost.events, static_cast<long>(e.error.unmatched_events)})
      csv += "," + std::to_string(count);
    for (const ErrorKind kind : k_kinds) csv += "," + (study.is_resolved(kind) ? number_text(e.error.of(kind).value) : std::string());
    csv += "," + number_text(e.energy_residual) + "," + number_text(e.constraint_residual) + (e.is_pareto ? ",1," : ",0,") + "\n";
  }
  return csv;
}

std::string work_precision_svg(const AccuracyStudy& study, const std::string& title) {
  const std::vector<DrawnEntry> points = drawn(study);
  Axis x, y;
  x.from = k_left;
  x.to = k_width - k_right;
  y.from = k_height - k_bottom;
  y.to = k_top;
  for (const DrawnEntry& p : points) {
    x.take(p.error);
    y.take(1e3 * p.entry->cpu_seconds);
  }
  if (points.empty()) x.low = y.low = 0.0;
  x.close();
  y.close();
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + fixed(k_width) + "\" height=\"" + fixed(k_height) +
                    "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" "
                    "height=\"100%\" fill=\"white\"/>\n" +
                    label(k_left, 22.0, "start", escaped(title), " font-size=\"14\"") + grid(x, y) +
                    "<desc>Times are measured: they, and the settings that a time budget permitted, depend on the computer.</desc>\n";
  double resolution = 0.0;
  for (const ErrorKind kind : k_kinds)
    if (study.is_resolved(kind)) resolution = std::max(resolution, study.resolution.of(kind).value);
  if (resolution > 0.0 && portable::log10(resolution) >= x.low && portable::log10(resolution) <= x.high)
    svg += line(x.at(resolution), y.from, x.at(resolution), y.to, "stroke=\"#888888\" stroke-dasharray=\"4 3\"");
  const std::vector<std::string> names = integrators_of(points);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string colour = k_colours[i % std::size(k_colours)];
    svg += curve(points, names[i], colour, x, y);
    svg += label(k_width - k_right + 14.0, k_top + 16.0 + 18.0 * static_cast<double>(i), "start", escaped(names[i]),
                 " fill=\"" + colour + "\"");
  }
  return svg + "</svg>\n";
}

} // namespace steplap
