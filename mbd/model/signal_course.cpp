#include "mbd/model/signal_course.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

using Piece = Signal::Piece;

bool has_waves(const Piece& piece) {
  return std::any_of(piece.harmonics.begin(), piece.harmonics.end(), [](const Signal::Harmonic& h) { return h.amplitude != 0.0; });
}

bool is_modulated(const Piece& piece) {
  return std::any_of(piece.modulated.begin(), piece.modulated.end(), [](const Signal::Modulated& m) { return m.amplitude != 0.0; });
}

bool is_level(const Piece& piece) { return piece.is_level && !has_waves(piece) && !is_modulated(piece); }
bool is_stationary(const Piece& piece) { return piece.is_level && has_waves(piece) && !is_modulated(piece); }

// Returns Σ a², which is twice the mean square of the piece.
double power_of(const Piece& piece) {
  double square = 0.0;
  for (const Signal::Harmonic& h : piece.harmonics) square += h.amplitude * h.amplitude;
  return square;
}

double mean_period(const Piece& piece) {
  double square_of_rate = 0.0;
  for (const Signal::Harmonic& h : piece.harmonics) square_of_rate += h.amplitude * h.amplitude * h.frequency * h.frequency;
  return 2.0 * std::numbers::pi * std::sqrt(power_of(piece) / square_of_rate);
}

// Returns the tolerance for comparing levels, 1e-9 of the largest value. Sums and products leave levels that differ by rounding.
double rounding_of(const Signal& signal) {
  double largest = 0.0;
  const std::vector<Piece>& pieces = signal.pieces();
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    largest = std::max(largest, std::abs(signal.value(pieces[k].start)));
    if (k + 1 < pieces.size()) largest = std::max(largest, std::abs(signal.value(0.5 * (pieces[k].start + pieces[k + 1].start))));
    for (const Signal::Harmonic& h : pieces[k].harmonics) largest = std::max(largest, std::abs(h.amplitude));
  }
  return 1e-9 * largest;
}

} // namespace

SignalCourse course_of(const Signal& signal) {
  SignalCourse course;
  const std::vector<Piece>& pieces = signal.pieces();
  if (pieces.empty()) return course;
  const double slack = rounding_of(signal);
  const auto is_at = [slack](const Piece& piece, double level) { return is_level(piece) && std::abs(piece.c[0] - level) <= slack; };
  const Piece& last = pieces.back();
  // If the last piece is zero, the reference level is zero: a pulse that begins at t = 0 also has a constant first piece. Otherwise a
  // constant first piece gives the reference level.
  const bool begins_level = is_level(pieces.front()) && pieces.front().start <= 0.0 && !is_at(last, 0.0);
  const double level = begins_level ? pieces.front().c[0] : 0.0;
  const auto first = std::find_if(pieces.begin(), pieces.end(), [&](const Piece& piece) { return !is_at(piece, level); });
  if (first == pieces.end()) return course;
  course.begins = std::max(0.0, first->start);
  const auto run_of_level = std::find_if(pieces.rbegin(), pieces.rend(), [&](const Piece& piece) { return !is_at(piece, last.c[0]); });
  const double last_start = is_level(last) ? run_of_level.base()->start : last.start;
  if (is_at(last, level)) {
    course.ends = last_start;
    if (course.ends <= 0.0) return {};
    // The stationary part is the piece of pure harmonics with the largest power. The rising and falling parts of an envelope consist of
    // harmonics, too, but have less.
    const Piece* strongest = nullptr;
    for (const Piece& piece : pieces)
      if (is_stationary(piece) && (!strongest || power_of(piece) > power_of(*strongest))) strongest = &piece;
    if (!strongest) return course;
    const double period = mean_period(*strongest);
    if ((strongest + 1)->start - strongest->start < SignalCourse::k_periods * period) return course;
    course.full = std::max(0.0, strongest->start);
    course.period = period;
    return course;
  }
  if (!is_level(last) && !is_stationary(last)) return course;
  if (is_level(last) && last_start <= 0.0) return {};
  course.full = std::max(0.0, last_start);
  if (is_stationary(last)) course.period = mean_period(last);
  return course;
}

} // namespace steplap
