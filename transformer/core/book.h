// The book of a step-lap core: where the sheets of one layer after the other meet.
//
// A stack is built of layers of `sheets_per_layer` equal sheets. In each layer the yoke sheet and the limb
// sheet meet, but for a clearance g, along a line parallel to the mitre; from layer to layer that line moves
// by the step pitch s. The n lines are at
//   q_k = (k − (n−1)/2) s,  k = 0 … n−1,
// and the layers take them in an order that repeats:
//   saw tooth         0 1 … n−1 | 0 1 … n−1 | …           n layers; neighbours overlap by s − g, and once in n by
//                                                         (n−1) s − g: mean 2(n−1)/n s − g
//   zig-zag           0 1 … n−1 n−2 … 1 | 0 1 …           2(n−1) layers; every one by s − g: mean s − g
//   zig-zag, doubled  0 1 … n−1 | n−1 … 1 0 | 0 1 …       2n layers; s − g, and none once in n: mean (n−1)/n (s − g)
// The interfaces inside a layer carry no overlap. q, s and g are measured across the mitre, from its middle,
// away from the yoke. Source and assumptions: docs/reference/core.md.
#pragma once

namespace steplap {

enum class BookKind { saw_tooth, zig_zag, zig_zag_doubled };

struct Book {
  BookKind kind = BookKind::saw_tooth;
  long sheets_per_layer = 1;
  long steps = 2;         ///< n
  double pitch = 0.0;     ///< s, m
  double clearance = 0.0; ///< g, m
};

/// After so many layers the book begins again.
[[nodiscard]] long period_of(const Book& book);
/// Line k that the layer takes, counted from the first of a packet.
[[nodiscard]] long position_of(const Book& book, long layer);
/// q_k
[[nodiscard]] double line_at(const Book& book, long position);
/// Of the interfaces between layers, in a stack without end.
[[nodiscard]] double mean_overlap(const Book& book);

} // namespace steplap
