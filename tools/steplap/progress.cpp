#include "tools/steplap/progress.h"

#include <cstdio>
#include <ostream>

namespace steplap {

namespace {

constexpr std::chrono::milliseconds k_period{100};

} // namespace

Progress::Progress(Console& console, std::string name, double end)
    : console_(console), name_(std::move(name)), end_(end), last_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
  if (is_shown_) console_.err << "\r\x1b[K" << std::flush;
}

void Progress::operator()(double t) {
  if (!console_.is_terminal || console_.verbosity == Verbosity::quiet) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < k_period) return;
  last_ = now;
  is_shown_ = true;
  char text[64];
  std::snprintf(text, sizeof text, "%3.0f %%  t = %.4f s of %g s", 100.0 * t / end_, t, end_);
  console_.err << "\r\x1b[K" << name_ << "  " << text << std::flush;
}

} // namespace steplap
