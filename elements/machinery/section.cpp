#include "elements/machinery/section.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_pi = std::numbers::pi;

struct Profile {
  const char* name;
  double h, b, web, flange, fillet; ///< dimensions, mm: height, width, web and flange thickness, fillet radius
};

constexpr std::array<Profile, 18> k_profiles = {{
    {"IPE 80", 80, 46, 3.8, 5.2, 5},
    {"IPE 100", 100, 55, 4.1, 5.7, 7},
    {"IPE 120", 120, 64, 4.4, 6.3, 7},
    {"IPE 140", 140, 73, 4.7, 6.9, 7},
    {"IPE 160", 160, 82, 5.0, 7.4, 9},
    {"IPE 180", 180, 91, 5.3, 8.0, 9},
    {"IPE 200", 200, 100, 5.6, 8.5, 12},
    {"IPE 220", 220, 110, 5.9, 9.2, 12},
    {"IPE 240", 240, 120, 6.2, 9.8, 15},
    {"IPE 270", 270, 135, 6.6, 10.2, 15},
    {"IPE 300", 300, 150, 7.1, 10.7, 15},
    {"IPE 330", 330, 160, 7.5, 11.5, 18},
    {"IPE 360", 360, 170, 8.0, 12.7, 18},
    {"IPE 400", 400, 180, 8.6, 13.5, 21},
    {"IPE 450", 450, 190, 9.4, 14.6, 21},
    {"IPE 500", 500, 200, 10.2, 16, 21},
    {"IPE 550", 550, 210, 11.1, 17.2, 24},
    {"IPE 600", 600, 220, 12, 19, 24},
}};

SectionValues values_of(const Profile& p) {
  const double inner = p.h - 2.0 * p.flange, r = p.fillet, fillet = (1.0 - 0.25 * k_pi) * r * r;
  const double centroid = (10.0 - 3.0 * k_pi) / (12.0 - 3.0 * k_pi) * r, to_axis = 0.5 * inner - centroid;
  const double own = (1.0 - 5.0 * k_pi / 16.0) * r * r * r * r - fillet * centroid * centroid;
  const double area = 2.0 * p.b * p.flange + inner * p.web + 4.0 * fillet;
  const double moment = (p.b * p.h * p.h * p.h - (p.b - p.web) * inner * inner * inner) / 12.0 + 4.0 * (own + fillet * to_axis * to_axis);
  return {1e-6 * area, 1e-12 * moment, 1e-3 * p.h};
}

} // namespace

SectionValues rectangular_section(double width, double height) { return {width * height, width * height * height * height / 12.0, height}; }

SectionValues tubular_section(double diameter, double wall) {
  const double bore = diameter - 2.0 * wall, outer = diameter * diameter, inner = bore * bore;
  return {0.25 * k_pi * (outer - inner), k_pi / 64.0 * (outer * outer - inner * inner), diameter};
}

std::optional<SectionValues> profile_section(const std::string& name) {
  const auto* const found = std::find_if(k_profiles.begin(), k_profiles.end(), [&](const Profile& p) { return name == p.name; });
  return found == k_profiles.end() ? std::nullopt : std::optional(values_of(*found));
}

std::vector<std::string> profile_names() {
  std::vector<std::string> names;
  for (const Profile& p : k_profiles) names.emplace_back(p.name);
  return names;
}

} // namespace steplap
