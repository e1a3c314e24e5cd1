#include "transformer/book.h"

#include <cmath>

namespace steplap {

long sheets_in(const Book& book) {
  // A depth made as a whole number of sheets must not lose one to rounding.
  return std::lround(std::floor(book.stack_depth * book.stacking_factor / book.sheet_thickness + 1e-9));
}

long interfaces_in(const Book& book) {
  const long layers = sheets_in(book) / book.sheets_per_layer;
  return layers > 1 ? layers - 1 : 0;
}

double mean_overlap(const Book& book) {
  const double n = static_cast<double>(book.steps);
  return 2.0 * (n - 1.0) / n * book.step_pitch - book.clearance;
}

std::vector<LapBand> mean_band(const Book& book) {
  const double half = 0.5 * mean_overlap(book);
  return {{-half, half, static_cast<double>(interfaces_in(book))}};
}

std::vector<LapBand> each_band(const Book& book) {
  const double count = static_cast<double>(interfaces_in(book)) / static_cast<double>(book.steps);
  const double half_gap = 0.5 * book.clearance;
  const auto line = [&](long k) {
    return (static_cast<double>(k) - 0.5 * static_cast<double>(book.steps - 1)) * book.step_pitch;
  };
  std::vector<LapBand> bands;
  for (long k = 0; k + 1 < book.steps; ++k)
    bands.push_back({line(k) + half_gap, line(k + 1) - half_gap, count});
  bands.push_back({line(0) + half_gap, line(book.steps - 1) - half_gap, count});
  return bands;
}

} // namespace steplap
