#include "tools/steplap/overview_screen.h"

#include "mbd/base/shown_text.h"
#include "run/prominence.h"
#include "tools/steplap/text_table.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <vector>

namespace steplap {

namespace {

constexpr std::size_t k_columns = 100, k_all_columns = 1000; // the second for all digits
constexpr std::size_t k_story_lines = 10, k_most_bars = 5, k_most_warnings = 3; // with them the screen has at most 30 lines
constexpr double k_least_share = 0.005;                                         // less is 0 %, and no news
constexpr int k_bar = 20;                                                       // characters

// Characters, not bytes, of a text in UTF-8.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string cut(const std::string& text, std::size_t most) {
  if (width(text) <= most) return text;
  std::string kept;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80;
    if (begins && width(kept) + 2 > most) break;
    kept += text[i];
  }
  return kept + "…";
}

// Broken at blanks, but not between a number and what follows it, its unit; at most so many lines, all but the first indented.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t most_lines) {
  std::string result, line;
  std::size_t lines = 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = std::min(text.find_first_not_of(' ', at), text.size() - 1); // blanks before a word stay with it
    std::size_t end = std::min(text.find(' ', begin), text.size());
    if (std::isdigit(static_cast<unsigned char>(text[end - 1])) && end < text.size()) end = std::min(text.find(' ', end + 1), text.size());
    const std::string word = text.substr(at, end - at);
    if (!line.empty() && width(line) + 1 + width(word) > k_columns && lines < most_lines) {
      result += line + "\n";
      line = std::string(indent, ' ') + word;
      ++lines;
    } else {
      line += (at == 0 ? "" : " ") + word;
    }
    at = end + 1;
  }
  return result + cut(line, k_columns);
}

std::string coloured(const std::string& text, const char* colour, bool is_coloured) {
  return is_coloured ? std::string("\x1b[") + colour + "m" + text + "\x1b[0m" : text;
}

const char* colour_of(Verdict verdict) {
  switch (verdict) {
  case Verdict::hold: return "1;32";
  case Verdict::reject: return "1;31";
  case Verdict::inspect: return "1;33";
  default: return "1;35";
  }
}

void print_head(std::ostream& out, const Report& report, const Overview& overview, bool is_coloured) {
  std::string verdict = name_of(overview.verdict);
  std::transform(verdict.begin(), verdict.end(), verdict.begin(), [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  const std::string text = wrapped(verdict + "  " + shown(overview.reason), verdict.size() + 2, 3);
  out << coloured(verdict, colour_of(overview.verdict), is_coloured) << text.substr(verdict.size()) << "\n";
  const LoadedModel& loaded = *report.run.loaded;
  out << cut(shown(loaded.name + (loaded.model.header.title.empty() ? "" : ": " + loaded.model.header.title)), k_columns) << "\n";
}

void print_story(std::ostream& out, const Report& report, const Overview& overview) {
  const std::vector<Event>& events = report.run.result.events;
  const auto main = static_cast<std::size_t>(std::count_if(events.begin(), events.end(), is_main_event));
  out << "\nWhat happened: " << (events.empty() ? "no events" : main == 0 ? counted(events.size(), "minor event", "minor events") : counted(main, "event", "events"));
  if (main > 0 && main < events.size()) out << " (" << events.size() << " with minor ones)";
  out << "\n";
  std::size_t lines = 0;
  for (std::size_t i = 0; i < overview.story.size(); ++i) {
    const std::string text = wrapped("  " + shown(overview.story[i].text), 4, 2);
    const std::size_t needed = text.find('\n') == std::string::npos ? 1 : 2;
    const bool is_last = i + 1 == overview.story.size();
    if (lines + needed > k_story_lines - (is_last ? 0 : 1)) {
      out << "  … and " << overview.story.size() - i << " more, see events.csv\n";
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

void print_bars(std::ostream& out, const Overview& overview, ShownDigits digits) {
  const auto is_idle = [](const Utilisation& u) { return u.share < k_least_share; };
  const auto used = std::find_if(overview.utilisations.begin(), overview.utilisations.end(), is_idle) - overview.utilisations.begin();
  const std::size_t count = std::min(k_most_bars, static_cast<std::size_t>(used));
  if (count == 0) return;
  out << "\nNearest to their limits\n";
  std::size_t widest = 0;
  for (std::size_t i = 0; i < count; ++i) widest = std::max(widest, width(shown(overview.utilisations[i].name)));
  widest = std::min<std::size_t>(widest, 36);
  for (std::size_t i = 0; i < count; ++i) {
    const Utilisation& u = overview.utilisations[i];
    const std::string name = cut(shown(u.name), widest), share = shown_share(u.share, u.error, digits);
    const std::string line = "  " + name + std::string(widest - width(name), ' ') + "  " + bar_of(u.share) + std::string(width(share) < 6 ? 6 - width(share) : 0, ' ') +
                             " " + share + (u.detail.empty() ? "" : "   " + u.detail);
    out << cut(line, digits.is_full ? k_all_columns : k_columns) << "\n";
  }
}

void print_warnings(std::ostream& out, const Report& report, bool is_coloured) {
  std::vector<const Finding*> warnings;
  for (const Finding& finding : report.findings)
    if (finding.level == FindingLevel::warning) warnings.push_back(&finding);
  const std::size_t count = warnings.size() > k_most_warnings ? k_most_warnings - 1 : warnings.size();
  for (std::size_t i = 0; i < count; ++i) out << coloured("Warning", "1;33", is_coloured) << cut("Warning: " + shown(text_with_place(*warnings[i])), k_columns).substr(7) << "\n";
  if (count < warnings.size()) out << "… and " << warnings.size() - count << " more warnings, see 'findings' in summary.json\n";
}

} // namespace

void print_overview(std::ostream& out, const Report& report, const std::string& folder, bool is_coloured, ShownDigits digits) {
  const Overview overview = overview_of(report, digits);
  print_head(out, report, overview, is_coloured);
  print_story(out, report, overview);
  print_bars(out, overview, digits);
  const char* const remedy = report.estimate.status == EstimateStatus::too_dear ? " (--estimate-error)" : "";
  out << "\n" << wrapped(std::string("Trust: ") + name_of(overview.trust.level) + ". " + shown(overview.trust.text) + remedy, 7, 2) << "\n";
  print_warnings(out, report, is_coloured);
  out << "Results: " << shown(folder) << "\n";
  out << "Page: steplap report RESULTS. Tables of all extremes: steplap simulate -v MODEL.\n";
}

bool takes_colour(const std::ostream& out) {
  const char* const refused = std::getenv("NO_COLOR");
  return &out == &std::cout && isatty(STDOUT_FILENO) == 1 && (refused == nullptr || *refused == '\0');
}

} // namespace steplap
