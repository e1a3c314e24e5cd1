// Buffer or draw gear of a railway vehicle: its force follows one curve during compression, a lower one during release, and it sticks in
// between.
//
// With d the compression, L(d) the loading and U(d) ≤ L(d) the unloading curve, it is a spring (L + U)/2 in parallel with dry friction of
// bound (L − U)/2. The force is L during compression, U during release, and at rest exactly what equilibrium requires between them. A wagon
// therefore stays at rest between its buffers under loads that vary within these bounds, as with ring springs and rubber. The spring's
// energy is stored; the work of friction in a cycle is the area between the curves.
#pragma once

#include "mbd/model/model.h"

#include <vector>

namespace steplap {

struct Buffer : Element {
  std::string a, b = "ground";
  Vec2 axis{1.0, 0.0};         ///< direction in which a is pushed away, in marker b's axes
  std::vector<Vec2> loading;   ///< loading curve: (d, force), m and N, beginning with (0, 0)
  std::vector<Vec2> unloading; ///< unloading curve, for decreasing d; empty: equal to `loading`
  double gap = 0.0;            ///< gap in the reference pose, m; negative: compressed
  long count = 1;
};

[[nodiscard]] const ElementKind& buffer_kind();

} // namespace steplap
