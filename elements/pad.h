// Pads of wood, pressboard or rubber between parts: stiffness k = E A/t from material, area A and thickness t.
//
// E is the modulus across the grain or the layers, as pads are loaded; rubber is free to bulge at its sides. A pad that cannot bulge, or
// whose stiffness was measured, is given by its stiffness.
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// A material of pads.
struct PadMaterial {
  std::string name;
  double modulus = 0.0; ///< E, Pa
  std::string source;   ///< document; what no document states begins with "assumed"

  [[nodiscard]] bool is_assumed() const { return source.starts_with("assumed"); }
};

/// Returns all materials.
[[nodiscard]] const std::vector<PadMaterial>& pad_materials();

/// A pad as a model gives it; `material` is empty if there is none.
struct Pad {
  std::string material;
  std::optional<double> area, thickness; ///< m², m

  /// Returns the material; nullptr if no pad is given or the name is unknown.
  [[nodiscard]] const PadMaterial* known_material() const;
  /// Returns k in N/m. Precondition: problem() is "".
  [[nodiscard]] double stiffness() const;
  /// Returns what is wrong as an error message, "" if nothing is. A pad excludes a given stiffness.
  [[nodiscard]] std::string problem(bool has_stiffness) const;
};

/// Returns the pad of an element whose kind has the fields of add_pad_fields().
template <class T> [[nodiscard]] Pad pad_of(const T& element) { return {element.material, element.area, element.thickness}; }

/// Adds the fields `material`, `area` and `thickness` to the kind of T, which has members of these names as in Pad.
template <class T> void add_pad_fields(FieldTable& fields) {
  std::vector<std::string> names{""};
  std::string list;
  for (const PadMaterial& material : pad_materials()) {
    names.push_back(material.name);
    list += (list.empty() ? "" : "; ") + material.name + " " + std::to_string(static_cast<long>(material.modulus * 1e-6 + 0.5)) + " MPa, " +
            material.source;
  }
  fields.add("material", &T::material).one_of(names).doc("of a pad, with area and thickness instead of stiffness E A/t: " + list);
  fields.add("area", &T::area).in("m^2").positive().doc("of the pad's face");
  fields.add("thickness", &T::thickness).in("m").positive().doc("of the pad, in the direction of the force");
}

} // namespace steplap
