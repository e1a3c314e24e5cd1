// Cross sections of straight beams: area and second moment of area about the axis of bending.
//
// Hot-rolled I sections of the IPE series (EN 10365) are computed from their five dimensions, including the fillets:
//
//   A = 2 b t_f + (h − 2 t_f) t_w + (4 − π) r²
//   I = (b h³ − (b − t_w) (h − 2 t_f)³)/12 + 4 (I_s + A_s d²)
//
// with A_s = (1 − π/4) r² the area of one fillet, (10 − 3π)/(12 − 3π) r the distance of its centroid from web and flange, d the distance of
// the centroid from the neutral axis, and I_s = (1 − 5π/16) r⁴ − A_s ((10 − 3π)/(12 − 3π) r)² its own second moment.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Values of a cross section.
struct SectionValues {
  double area = 0.0;          ///< area, m²
  double second_moment = 0.0; ///< second moment of area, m⁴
  double height = 0.0;        ///< height, m, perpendicular to the axis of bending
};

/// Returns the values of a rectangle width × height, m.
[[nodiscard]] SectionValues rectangular_section(double width, double height);
/// Returns the values of a tube with this outer diameter and wall, m; a wall of half the diameter makes it solid.
[[nodiscard]] SectionValues tubular_section(double diameter, double wall);
/// Returns the values of a section such as "IPE 300" for bending about its strong axis, or nullopt for an unknown name.
[[nodiscard]] std::optional<SectionValues> profile_section(const std::string& name);
/// Returns all names known to profile_section().
[[nodiscard]] std::vector<std::string> profile_names();

} // namespace steplap
