// What a [[core]] stands for, put into the model: joints, interfaces, the limbs' steel and outlines.
#pragma once

#include "transformer/core/core_geometry.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Throws ModelError with all that is wrong.
void build_core(const Core& core, Model& model);

/// Where the middle of a limb is, from the active part's centre of gravity, in its axes.
[[nodiscard]] Vec2 middle_of_limb(const Core& core, const Body& limb, const Body& active_part);
/// +1 for a limb ahead of the active part, −1 behind.
[[nodiscard]] double side_of_limb(const Core& core, const Body& limb, const Body& active_part);
/// All limbs of a core, as CoreGeometry wants them.
[[nodiscard]] std::vector<LimbPlace> places_of_limbs(const Core& core, const Model& model);
/// Of all yokes of an active part, between the outer faces of the outer limbs of each, kg. Tables with the same yokes share
/// them (limbs of other widths), others add to them (a further part of the stack). Empty where it cannot be told: a table
/// with counted overlaps or with fields that contradict each other, a limb that is no body, a yoke without an outer limb at
/// either end.
[[nodiscard]] std::optional<double> yoke_steel(const Model& model, const std::string& active_part);
/// Tables that name the limb: with several, each is a part of its steel.
[[nodiscard]] std::size_t count_cores_of(const Model& model, const std::string& limb);

} // namespace steplap
