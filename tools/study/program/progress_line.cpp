#include "tools/study/program/progress_line.h"

#include <cmath>
#include <cstdio>
#include <ostream>

namespace steplap::study {

namespace {

std::string formatted(const char* format, double value) {
  char text[60];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

// Formats a duration in seconds, minutes or hours, with the accuracy of an estimate.
std::string span_text(double seconds) {
  constexpr double k_minute = 60.0, k_hour = 3600.0;
  if (seconds < 2.0 * k_minute) return formatted("%.0f s", std::ceil(seconds));
  if (seconds < 2.0 * k_hour) return formatted("%.0f min", seconds / k_minute);
  return formatted("%.1f h", seconds / k_hour);
}

} // namespace

std::string progress_text(const Pace& pace) {
  const bool has_end = pace.expected > pace.samples;
  std::string text = std::to_string(pace.samples);
  if (has_end) text += " of " + std::string(pace.is_guess ? "about " : "") + std::to_string(pace.expected);
  text += " samples";
  if (pace.rate > 0.0) text += ", " + formatted("%.3g", pace.rate) + " a second";
  text += ", " + formatted("%.0f s", pace.seconds) + " gone";
  if (has_end && pace.rate > 0.0)
    text += ", about " + span_text(static_cast<double>(pace.expected - pace.samples) / pace.rate) + " left" +
            (pace.is_guess ? " of this method" : "");
  if (pace.stored > 0) text += ", " + std::to_string(pace.stored) + " from the store";
  return pace.estimate.empty() ? text : text + "; " + pace.estimate;
}

ProgressLine::~ProgressLine() {
  if (is_shown_) console_.err << "\r\x1b[K" << std::flush;
}

void ProgressLine::operator()(const Pace& pace) {
  constexpr double k_between = 0.2; // shortest interval between updates, s
  if (!console_.is_terminal || console_.verbosity == Verbosity::quiet || pace.seconds - last_ < k_between) return;
  last_ = pace.seconds;
  is_shown_ = true;
  console_.err << "\r\x1b[K" << progress_text(pace) << std::flush;
}

} // namespace steplap::study
