// [[core]]: the step-lap joints between the limbs of a core and its yokes, from the core's dimensions.
//
// For each limb named there is one step_lap_joint, and at its top and bottom corner one
// step_lap_interface for each band of overlap (book.h), its sheets in ground coordinates of the reference
// pose:
//   limb sheet 0 ≤ s ≤ l, inner ≤ q ≤ tongue, fixed in the limb;
//   yoke sheet −margin ≤ s ≤ l + margin, −tongue ≤ q ≤ outer, fixed in the active part
// (s, q along and across the mitre, l its length: corner.h). The limb's centre is its centre of gravity.
// An outer limb has one mitre at either end, a middle limb ends in a point between two (T-joint).
// Assumes rectangular yokes and limbs of one sheet width (a core of several packets is several [[core]]
// tables that name the same joints), pressure uniform over a corner. Source and assumptions: docs/core.md.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Core : TableObject {
  std::string active_part;         ///< body with the yokes
  std::vector<std::string> limbs;  ///< bodies of the outer limbs
  std::vector<std::string> middle_limbs; ///< bodies of the limbs between
  std::vector<std::string> joints; ///< one for each limb, outer ones first; default "<limb> joint"

  double limb_width = 0.0, core_height = 0.0, yoke_height = 0.0; ///< m
  std::optional<double> mitre_angle; ///< rad against the yoke; default: from corner to corner
  std::optional<double> notch_angle; ///< rad, of either side of a T-joint's point against the yoke; default 45°
  double tongue = 0.05;              ///< m, sheet on either side of the middle of the mitre
  double margin = 0.02;              ///< m, of the yoke sheet beyond the limb's at both ends of the mitre

  // Overlaps: either counted and measured, …
  std::optional<double> overlap, interfaces; ///< m; number a corner
  // … or as the stack is built.
  std::optional<double> stack_depth, sheet_thickness, step_pitch; ///< m
  std::optional<long> steps;
  double stacking_factor = 0.96;
  long sheets_per_layer = 1;
  double clearance = 0.0;    ///< m; judged only where it is given
  std::string bands = "mean"; ///< "mean" or "each"

  double pressure = 0.0; ///< Pa
  double static_friction = 0.0;
  std::optional<double> kinetic_friction;
  std::optional<double> bottom_pressure, bottom_static_friction, bottom_kinetic_friction;

  std::string mode = "slip", on_apart = "stop"; ///< of the joints added
  std::optional<double> least_margin, most_slide; ///< of the joints added
};

[[nodiscard]] const TableKind& core_kind();

} // namespace steplap
