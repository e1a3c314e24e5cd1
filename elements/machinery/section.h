// Cross sections of straight beams: area and second moment of area about the axis of bending.
//
// Hot-rolled I sections of the series IPE (EN 10365) are found from their five sizes, the fillets included:
//   A = 2 b t_f + (h − 2 t_f) t_w + (4 − π) r²
//   I = (b h³ − (b − t_w) (h − 2 t_f)³)/12 + 4 (I_s + A_s d²)
// with A_s = (1 − π/4) r² of one fillet, (10 − 3π)/(12 − 3π) r from web and flange its centroid, d the centroid's way to the neutral axis,
// and I_s = (1 − 5π/16) r⁴ − A_s ((10 − 3π)/(12 − 3π) r)² its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace steplap {

struct SectionValues {
  double area = 0.0;          ///< m²
  double second_moment = 0.0; ///< m⁴
  double height = 0.0;        ///< m, across the axis of bending
};

/// width × height.
[[nodiscard]] SectionValues rectangular_section(double width, double height);
/// Round, of this outer diameter and wall; a wall of half the diameter makes it solid.
[[nodiscard]] SectionValues tubular_section(double diameter, double wall);
/// "IPE 300", bent about its strong axis; nullopt: there is none of that name.
[[nodiscard]] std::optional<SectionValues> profile_section(const std::string& name);
/// All names that profile_section() knows.
[[nodiscard]] std::vector<std::string> profile_names();

} // namespace steplap
