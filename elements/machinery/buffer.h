// Buffer or draw gear of a railway vehicle: pressed in it follows one curve, let go a lower one, and between the two it sticks.
//
// With d the depth, L(d) the loading and U(d) ≤ L(d) the unloading curve, it is the spring (L + U)/2 beside dry friction whose bound
// is (L − U)/2: pressing, the force is L; let go, U; at rest it takes whatever lies between, exactly. So a wagon stands still between
// its buffers under loads that change within these bounds, as ring springs and rubber do. The spring's energy counts as stored; the
// friction's work is what a cycle loses, the area between the curves.
#pragma once

#include "mbd/model/model.h"

#include <vector>

namespace steplap {

struct Buffer : Element {
  std::string a, b = "ground";
  Vec2 axis{1.0, 0.0};         ///< in marker b's axes: the way in which a is pushed off
  std::vector<Vec2> loading;   ///< (d, force), m and N, from (0, 0)
  std::vector<Vec2> unloading; ///< the same while d falls; empty: as loading
  double gap = 0.0;            ///< m, in the reference pose; negative: pressed in
  long count = 1;
};

[[nodiscard]] const ElementKind& buffer_kind();

} // namespace steplap
