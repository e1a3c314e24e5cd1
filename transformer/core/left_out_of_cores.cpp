#include "transformer/core/left_out_of_cores.h"

#include "elements/step_lap/step_lap_joint.h"
#include "transformer/core/core.h"

#include <algorithm>

namespace steplap {

std::vector<std::string> left_out_of_cores(const Model& model) {
  const auto is_joint = [](const ElementEntry& entry) { return entry.kind == &step_lap_joint_kind(); };
  const auto is_core = [](const TableEntry& entry) { return entry.kind == &core_kind(); };
  if (std::none_of(model.elements.begin(), model.elements.end(), is_joint) &&
      std::none_of(model.tables.begin(), model.tables.end(), is_core))
    return {};
  return {"motion across the plane of the model: a limb that tilts or leans across the stack",
          "bending of sheets, limbs and yokes: all are rigid",
          "burrs, varnish and oil between the sheets: friction is as given, the same everywhere on an overlap",
          "micro-slip: part of an overlap that slides before all of it does, wear, and what many small shocks do together",
          "how the clamping pressure spreads between bolts or bands: it is as given, uniform or linear at each corner"};
}

} // namespace steplap
