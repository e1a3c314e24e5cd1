// Expands a [[core]] to joints, interfaces, and the steel and outlines of its limbs.
#pragma once

#include "transformer/core/core_geometry.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Adds joints, interfaces, steel and outlines to the model. Throws ModelError with all errors found.
void build_core(const Core& core, Model& model);

/// Returns the position of the middle of a limb relative to the active part's centre of gravity, in its axes, m.
[[nodiscard]] Vec2 middle_of_limb(const Core& core, const Body& limb, const Body& active_part);
/// Returns +1 for a limb in front of the active part, −1 for one behind it.
[[nodiscard]] double side_of_limb(const Core& core, const Body& limb, const Body& active_part);
/// Returns the positions of all limbs of a core.
[[nodiscard]] std::vector<LimbPlace> places_of_limbs(const Core& core, const Model& model);
/// Returns true if two tables describe limbs of the same yokes: equal yokes of one active part, and no limb in common.
[[nodiscard]] bool share_yokes(const Core& a, const Core& b);
/// Returns the mass of all yokes of an active part, each between the outer faces of its outer limbs, kg. Tables with the same yokes (limbs
/// of different width) count once; others add up (further parts of the stack). Nothing if it cannot be determined: counted overlaps,
/// inconsistent fields, a limb that is not a body, or a yoke without an outer limb at either end.
[[nodiscard]] std::optional<double> yoke_steel(const Model& model, const std::string& active_part);

/// A table that names a limb, and the limb's index in it (Core::all_limbs).
struct CoreOfLimb {
  const Core* core = nullptr;
  std::size_t limb = 0;
};
/// Returns the tables that name the limb, in the order of the model. If there are several, each describes a part of its stack.
[[nodiscard]] std::vector<CoreOfLimb> cores_of(const Model& model, const std::string& limb);
/// Returns the steel of a limb by all tables that name it, as CoreGeometry::limb_steel does if there is only one. Nothing if one of several
/// counts its overlaps, so that the mass of its part is unknown, or has inconsistent fields.
[[nodiscard]] std::optional<LimbSteel> steel_of(const Model& model, const std::string& limb);

} // namespace steplap
