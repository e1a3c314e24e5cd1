// The book of a step-lap core: how far yoke sheets and limb sheets overlap at each interface of a stack.
//
// A stack is built of layers of `sheets_per_layer` equal sheets. In each layer the yoke sheet and the
// limb sheet meet, but for a clearance g, at a line across the mitre; from layer to layer that line moves
// by the step pitch s, n layers make a book, and the next book begins where the first did (saw-tooth):
//   line of layer k at q_k = (k − (n−1)/2) s,  k = 0 … n−1.
// Between layers k and k+1 the yoke sheet of k+1 covers the limb sheet of k over s − g; between the last
// layer of a book and the first of the next the overlap is (n−1) s − g. That is n overlaps in a book,
//   2(n−1) s − n g together, a mean of 2(n−1)/n s − g;
// the other interfaces, inside a layer, carry none. q, s and g are measured across the mitre, from its
// middle, away from the yoke. Source and assumptions: docs/core.md.
#pragma once

#include <vector>

namespace steplap {

struct Book {
  double stack_depth = 0.0;     ///< m, of steel and insulation
  double stacking_factor = 1.0; ///< steel's share of it
  double sheet_thickness = 0.0; ///< m
  long sheets_per_layer = 1;
  long steps = 2;               ///< n, layers in a book
  double step_pitch = 0.0;      ///< s, m
  double clearance = 0.0;       ///< g, m
};

/// Overlaps of equal place and width: where yoke sheets (q < `outer`) cover limb sheets (q > `inner`).
struct LapBand {
  double inner = 0.0, outer = 0.0; ///< m
  double count = 0.0;              ///< of interfaces in the stack
};

[[nodiscard]] long sheets_in(const Book& book);
/// Interfaces that carry an overlap: one between any two neighbouring layers.
[[nodiscard]] long interfaces_in(const Book& book);
/// 2(n−1)/n s − g
[[nodiscard]] double mean_overlap(const Book& book);

/// One band of the mean overlap in the middle, or each of the n bands where it is: of the same area
/// together, but the n−1 narrow ones are the first to part as the limb is drawn away.
[[nodiscard]] std::vector<LapBand> mean_band(const Book& book);
[[nodiscard]] std::vector<LapBand> each_band(const Book& book);

} // namespace steplap
