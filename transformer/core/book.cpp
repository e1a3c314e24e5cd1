#include "transformer/core/book.h"

namespace steplap {

long period_of(const Book& book) {
  switch (book.kind) {
  case BookKind::saw_tooth: return book.steps;
  case BookKind::zig_zag: return 2 * (book.steps - 1);
  case BookKind::zig_zag_doubled: return 2 * book.steps;
  }
  return book.steps;
}

long position_of(const Book& book, long layer) {
  const long period = period_of(book), place = layer % period;
  if (place < book.steps) return place;
  return book.kind == BookKind::zig_zag ? period - place : period - 1 - place;
}

double line_at(const Book& book, long position) {
  return (static_cast<double>(position) - 0.5 * static_cast<double>(book.steps - 1)) * book.pitch;
}

double mean_overlap(const Book& book) {
  const double n = static_cast<double>(book.steps), s = book.pitch, g = book.clearance;
  switch (book.kind) {
  case BookKind::saw_tooth: return 2.0 * (n - 1.0) / n * s - g;
  case BookKind::zig_zag: return s - g;
  case BookKind::zig_zag_doubled: return (n - 1.0) / n * (s - g);
  }
  return 0.0;
}

} // namespace steplap
