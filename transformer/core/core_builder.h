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
/// Returns the mass of all yokes of an active part, each between the outer faces of its outer limbs, kg. Tables with the same yokes (limbs
/// of different width) count once; others add up (further parts of the stack). Nothing if it cannot be determined: counted overlaps,
/// inconsistent fields, a limb that is not a body, or a yoke without an outer limb at either end.
[[nodiscard]] std::optional<double> yoke_steel(const Model& model, const std::string& active_part);
/// Returns the number of tables that name the limb. If there are several, each describes a part of its steel.
[[nodiscard]] std::size_t count_cores_of(const Model& model, const std::string& limb);

} // namespace steplap
