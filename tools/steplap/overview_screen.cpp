#include "tools/steplap/overview_screen.h"

#include "mbd/base/shown_text.h"
#include "mbd/run/finding.h"
#include "tools/steplap/colour.h"
#include "tools/steplap/text_layout.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <vector>

namespace steplap {

namespace {

// line widths, in characters; the second if all digits are shown
constexpr std::size_t k_columns = 100, k_all_columns = 1000;
constexpr std::size_t k_all_lines = 100;                                        // number of lines for texts that must not be shortened
constexpr std::size_t k_story_lines = 10, k_most_bars = 5, k_most_warnings = 3; // limits that keep the screen within 30 lines
// smaller utilisations are shown as 0 % and therefore omitted
constexpr double k_least_share = 0.005;
constexpr int k_bar = 20; // length of a full bar, in characters

std::string coloured(const std::string& text, const char* colour, bool is_coloured) {
  return is_coloured ? std::string("\x1b[") + colour + "m" + text + "\x1b[0m" : text;
}

const char* colour_of(const std::string& verdict) {
  if (verdict == name_of(Verdict::hold)) return "1;32";
  if (verdict == name_of(Verdict::reject)) return "1;31";
  return verdict == name_of(Verdict::inspect) ? "1;33" : "1;35";
}

std::string text_at(const OrderedJson& json, const char* key) { return json.at(key).get<std::string>(); }

void print_head(std::ostream& out, const OrderedJson& summary, bool is_coloured) {
  const OrderedJson& overview = summary.at("overview");
  const std::string name = text_at(overview, "verdict");
  const auto is_judged = overview.find("is_judged"); // missing in results of older versions
  std::string verdict = is_judged != overview.end() && !is_judged->get<bool>() ? "no criteria" : name;
  std::transform(verdict.begin(), verdict.end(), verdict.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  const std::string text = wrapped(verdict + "  " + shown(text_at(overview, "reason")), k_columns, verdict.size() + 2, 3);
  out << coloured(verdict, colour_of(name), is_coloured) << text.substr(verdict.size()) << "\n";
  const std::string title = text_at(summary.at("model"), "title");
  out << cut(shown(text_at(summary.at("model"), "name") + (title.empty() ? "" : ": " + title)), k_columns) << "\n";
}

void print_story(std::ostream& out, const OrderedJson& summary) {
  const auto main = summary.at("events").at("main").get<std::size_t>(); // other events are details of the integration
  out << "\nWhat happened: " << (main == 0 ? "no events" : counted(main, "event", "events")) << "\n";
  const OrderedJson& story = summary.at("overview").at("story");
  std::size_t lines = 0;
  for (std::size_t i = 0; i < story.size(); ++i) {
    const std::string text = wrapped("  " + shown(text_at(story[i], "text")), k_columns, 4, 2);
    const std::size_t needed = text.find('\n') == std::string::npos ? 1 : 2;
    const bool is_last = i + 1 == story.size();
    if (lines + needed > k_story_lines - (is_last ? 0 : 1)) {
      out << "  … and " << story.size() - i << " more, see events.csv\n";
      return;
    }
    out << text << "\n";
    lines += needed;
  }
}

std::string bar_of(double share) {
  const int filled = std::clamp(static_cast<int>(std::lround(share * k_bar)), 0, k_bar);
  return "[" + std::string(static_cast<std::size_t>(filled), '#') + std::string(static_cast<std::size_t>(k_bar - filled), '-') + "]";
}

void print_bars(std::ostream& out, const OrderedJson& utilisations, bool has_all_digits) {
  const auto share_of = [](const OrderedJson& u) { return u.at("share").get<double>(); };
  std::size_t count = 0, widest = 0;
  while (count < std::min(k_most_bars, utilisations.size()) && share_of(utilisations[count]) >= k_least_share)
    widest = std::max(widest, width_of(shown(text_at(utilisations[count++], "name"))));
  if (count == 0) return;
  out << "\nNearest to their limits\n";
  widest = std::min<std::size_t>(widest, 36);
  for (std::size_t i = 0; i < count; ++i) {
    const OrderedJson& u = utilisations[i];
    const std::string name = cut(shown(text_at(u, "name")), widest), percent = text_at(u, "percent"), detail = text_at(u, "detail");
    const std::string line = "  " + name + std::string(widest - width_of(name), ' ') + "  " + bar_of(share_of(u)) +
                             std::string(width_of(percent) < 6 ? 6 - width_of(percent) : 0, ' ') + " " + percent +
                             (detail.empty() ? "" : "   " + detail);
    out << cut(line, has_all_digits ? k_all_columns : k_columns) << "\n";
  }
}

std::string finding_text(const OrderedJson& f) {
  return shown(
      text_with_place({text_at(f, "code"), FindingLevel::warning, text_at(f, "text"), {text_at(f, "file"), f.at("line").get<int>()}}));
}

void print_warnings(std::ostream& out, const OrderedJson& findings, bool is_coloured) {
  std::vector<std::string> warnings;
  for (const OrderedJson& f : findings)
    if (f.at("level") == "warning") warnings.push_back(finding_text(f));
  const std::size_t count = warnings.size() > k_most_warnings ? k_most_warnings - 1 : warnings.size();
  for (std::size_t i = 0; i < count; ++i)
    out << coloured("Warning", "1;33", is_coloured) << wrapped("Warning: " + warnings[i], k_columns, 9, k_all_lines).substr(7) << "\n";
  if (count < warnings.size()) out << "… and " << warnings.size() - count << " more warnings, see 'findings' in summary.json\n";
}

// Prints the notes among the findings: their reason is explained in the model, so they belong to the result.
void print_notes(std::ostream& out, const OrderedJson& findings) {
  for (const OrderedJson& f : findings)
    if (f.at("code") == "friction_by_source") out << wrapped("Note: " + finding_text(f), k_columns, 6, 3) << "\n";
}

// Returns a text for the level of numerical accuracy. It says nothing about effects that the model omits.
std::string text_of_level(const std::string& level) {
  return level == "good" ? "small" : level == "limited" ? "not known to be small" : "not known";
}

std::string list_of(const OrderedJson& texts) {
  std::string list;
  for (const OrderedJson& text : texts) list += (list.empty() ? "" : ", ") + text.get<std::string>();
  return list;
}

} // namespace

void print_overview(std::ostream& out, const ShownRun& run, const OverviewStyle& style) {
  const OrderedJson &overview = run.summary.at("overview"), &trust = overview.at("trust");
  print_head(out, run.summary, style.is_coloured);
  print_story(out, run.summary);
  print_bars(out, overview.at("utilisations"), style.has_all_digits);
  const char* const remedy = run.summary.at("error_estimate") == "too dear" ? " (--estimate-error)" : "";
  out << "\n"
      << wrapped("Numerical error: " + text_of_level(text_at(trust, "level")) + ". " + shown(text_at(trust, "text")) + remedy, k_columns, 7,
                 3)
      << "\n";
  if (trust.contains("guards")) out << cut("Checked by: " + shown(list_of(trust.at("guards"))), k_columns) << "\n";
  const OrderedJson& findings = run.summary.at("findings");
  if (style.has_warnings) print_warnings(out, findings, style.is_coloured);
  print_notes(out, findings);
  out << "Results: " << shown(run.folder) << "\n";
  out << "Write a page with: steplap report RESULTS. List all extremes with: steplap show -v RESULTS.\n";
}

void print_overviews(std::ostream& out, const std::vector<ShownRun>& runs, OverviewStyle style) {
  style.is_coloured = takes_colour(out);
  for (const ShownRun& run : runs) {
    if (&run != &runs.front()) out << "\n";
    print_overview(out, run, style);
  }
}

} // namespace steplap
