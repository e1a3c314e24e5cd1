// Book of a step-lap core: the positions at which the sheets of successive layers meet.
//
// A stack consists of layers of `sheets_per_layer` equal sheets. In each layer the yoke sheet and the limb sheet meet, with a clearance g,
// along a line parallel to the mitre. From layer to layer this line is shifted by the step pitch s. The n lines are at
//
//   q_k = (k − (n−1)/2) s,  k = 0 … n−1,
//
// and the layers use them in a periodic order:
//
//   saw tooth         0 1 … n−1 | 0 1 … n−1 | …           period n layers; neighbours overlap by s − g, once in n by
//                                                         (n−1) s − g: mean 2(n−1)/n s − g
//   zig-zag           0 1 … n−1 n−2 … 1 | 0 1 …           period 2(n−1) layers; all overlap by s − g
//   zig-zag, doubled  0 1 … n−1 | n−1 … 1 0 | 0 1 …       period 2n layers; s − g, but zero once in n: mean (n−1)/n (s − g)
//
// Interfaces between sheets of the same layer have no overlap. q, s and g are measured perpendicular to the mitre from its middle, positive
// away from the yoke. Source and assumptions: docs/reference/core.md.
#pragma once

namespace steplap {

enum class BookKind { saw_tooth, zig_zag, zig_zag_doubled };

/// Structure of a book.
struct Book {
  BookKind kind = BookKind::saw_tooth;
  long sheets_per_layer = 1;
  long steps = 2;         ///< number n of lines
  double pitch = 0.0;     ///< step pitch s, m
  double clearance = 0.0; ///< clearance g, m
};

/// Returns the period of the book in layers.
[[nodiscard]] long period_of(const Book& book);
/// Returns the index k of the line used by a layer; layers are counted from the first of a packet.
[[nodiscard]] long position_of(const Book& book, long layer);
/// Returns the position q_k of a line, m.
[[nodiscard]] double line_at(const Book& book, long position);
/// Returns the mean overlap of the interfaces between layers in an infinite stack, m.
[[nodiscard]] double mean_overlap(const Book& book);

} // namespace steplap
