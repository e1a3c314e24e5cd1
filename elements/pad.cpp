#include "elements/pad.h"

#include <algorithm>

namespace steplap {

const std::vector<PadMaterial>& pad_materials() {
  static const std::vector<PadMaterial> materials = {
      {"densified wood", 4300e6, "across the grain: USDA Wood Handbook, table 19-2, in bending"},
      {"laminated birch", 1000e6, "across the grain: USDA Wood Handbook, table 19-2, in bending"},
      {"sawn timber", 370e6, "assumed: across the grain, as C24 of EN 338, from memory"},
      {"pressboard", 150e6, "assumed: stacks have 50 to 300 MPa and stiffen"},
      {"rubber", 4e6, "assumed: 60 Shore A, free to bulge"}};
  return materials;
}

const PadMaterial* Pad::known_material() const {
  const std::vector<PadMaterial>& all = pad_materials();
  const auto found = std::find_if(all.begin(), all.end(), [this](const PadMaterial& m) { return m.name == material; });
  return found == all.end() ? nullptr : &*found;
}

double Pad::stiffness() const { return known_material()->modulus * *area / *thickness; }

std::string Pad::problem(bool has_stiffness) const {
  if (material.empty()) return area || thickness ? "'area' and 'thickness' are of a pad: give its 'material', too" : "";
  if (!area || !thickness) return "a pad of '" + material + "' needs 'area' and 'thickness'";
  return has_stiffness ? "give either 'stiffness' or a pad by 'material', 'area' and 'thickness', not both" : "";
}

} // namespace steplap
