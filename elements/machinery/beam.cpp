#include "elements/machinery/beam.h"

#include "elements/machinery/beam_part.h"
#include "elements/machinery/section.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/model/model_building.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

struct Material {
  const char* name;
  double modulus, density; ///< Young's modulus, Pa; density, kg/m³
};

constexpr std::array<Material, 2> k_materials = {{
    {"steel", 210e9, 7850.0},    // sources: EN 1993-1-1, 3.2.6; EN 1991-1-1, A.4
    {"aluminium", 70e9, 2700.0}, // source: EN 1999-1-1, 3.2.5
}};

/// All values of a beam, given or computed.
struct BeamValues {
  double length = 0.0; ///< length, m
  Vec2 along = Vec2::UnitX();
  double modulus = 0.0;    ///< Young's modulus, Pa
  double per_length = 0.0; ///< mass per length, kg/m
  SectionValues section;
  double damping_time = 0.0; ///< τ, s: dampers have τ times the stiffness
};

// Expands one [[beam]]; collects all errors before it reports them.
class BeamMaker {
public:
  BeamMaker(const Beam& beam, Model& model) : beam_(beam), model_(model) {}

  void make() {
    find_place();
    find_section();
    find_material();
    find_damping();
    if (!problems_.empty())
      // Dummy values, so that references to the beam cause no further errors.
      values_ = {1.0, Vec2::UnitX(), 1.0, 1.0, {1.0, 1.0, 1.0}, 0.0};
    for (long i = 0; i <= beam_.segments; ++i) add_segment(i);
    for (long i = 1; i <= beam_.segments; ++i) add_elastic_part(i);
    add_marker("start", 0, Vec2::Zero());
    add_marker("end", beam_.segments, Vec2::Zero());
    if (!problems_.empty()) throw ModelError(std::move(problems_));
  }

private:
  void error(const std::string& message, const std::string& field = "") {
    problems_.push_back({beam_.place(field), "beam '" + beam_.name + "': " + message});
  }
  [[nodiscard]] double part_length() const { return values_.length / static_cast<double>(beam_.segments); }
  [[nodiscard]] std::string body_name(long i) const { return beam_.name + "." + std::to_string(i); }

  void find_place();
  void find_section();
  void find_material();
  void find_damping();
  void add_segment(long i);
  void add_elastic_part(long i);
  std::string add_marker(const std::string& name, long segment, const Vec2& point);

  const Beam& beam_;
  Model& model_;
  BeamValues values_;
  std::vector<Diagnostic> problems_;
};

void BeamMaker::find_place() {
  const Vec2 way = beam_.to - beam_.from;
  values_.length = way.norm();
  if (!(values_.length > 0.0)) return error("'from' and 'to' are one place, and a beam has a length", "to");
  values_.along = way / values_.length;
}

// Sets the section, given as a shape or as values; the height is used only for drawings.
void BeamMaker::find_section() {
  const int shapes = int{!beam_.profile.empty()} + int{beam_.width || beam_.height} + int{beam_.diameter || beam_.wall};
  const bool has_values = beam_.area || beam_.second_moment;
  if (shapes + int{has_values} != 1)
    return error(
        "give its cross section once: by 'profile', by 'width' and 'height', by 'diameter' and 'wall', or by 'area' and 'second_moment'");
  if (has_values) {
    if (!beam_.area || !beam_.second_moment) return error("give both 'area' and 'second_moment'", beam_.area ? "area" : "second_moment");
    values_.section = {*beam_.area, *beam_.second_moment, std::sqrt(12.0 * *beam_.second_moment / *beam_.area)};
  } else if (beam_.width || beam_.height) {
    if (!beam_.width || !beam_.height) return error("give both 'width' and 'height'", beam_.width ? "width" : "height");
    values_.section = rectangular_section(*beam_.width, *beam_.height);
  } else if (beam_.diameter || beam_.wall) {
    if (!beam_.diameter || !beam_.wall) return error("give both 'diameter' and 'wall'", beam_.diameter ? "diameter" : "wall");
    if (*beam_.wall > 0.5 * *beam_.diameter) return error("'wall' is at most half of 'diameter', where it makes the section solid", "wall");
    values_.section = tubular_section(*beam_.diameter, *beam_.wall);
  } else {
    const auto found = profile_section(beam_.profile);
    if (!found)
      return error("profile '" + beam_.profile + "' is not known" + did_you_mean(beam_.profile, profile_names()) +
                       "; give 'area' and 'second_moment' of others",
                   "profile");
    values_.section = *found;
  }
}

void BeamMaker::find_material() {
  const auto* const material =
      std::find_if(k_materials.begin(), k_materials.end(), [&](const Material& m) { return beam_.material == m.name; });
  const bool is_named = material != k_materials.end();
  if (is_named == beam_.modulus.has_value()) error("give either its 'material' or its 'modulus'", is_named ? "modulus" : "");
  values_.modulus = beam_.modulus.value_or(is_named ? material->modulus : 0.0);
  if (beam_.density && beam_.mass_per_length) return error("give either 'density' or 'mass_per_length'", "mass_per_length");
  if (!is_named && !beam_.density && !beam_.mass_per_length) return error("give its 'density' or its 'mass_per_length'");
  const double density = beam_.density.value_or(is_named ? material->density : 0.0);
  values_.per_length = beam_.mass_per_length.value_or(density * values_.section.area);
}

void BeamMaker::find_damping() {
  const bool has_ratio = beam_.damping_ratio || beam_.damping_frequency;
  if (has_ratio && beam_.damping_time)
    return error("give either 'damping_time' or 'damping_ratio' with its 'damping_frequency'", "damping_time");
  if (has_ratio && !(beam_.damping_ratio && beam_.damping_frequency))
    return error("a ratio holds at one frequency: give both 'damping_ratio' and 'damping_frequency'",
                 beam_.damping_ratio ? "damping_ratio" : "damping_frequency");
  values_.damping_time =
      has_ratio ? *beam_.damping_ratio / (std::numbers::pi * *beam_.damping_frequency) : beam_.damping_time.value_or(0.0);
}

void BeamMaker::add_segment(long i) {
  const bool is_first = i == 0, is_last = i == beam_.segments;
  const double h = part_length(), behind = is_first ? 0.0 : 0.5 * h, ahead = is_last ? 0.0 : 0.5 * h, length = behind + ahead;
  Body& body = model_.bodies.emplace_back();
  body.name = body_name(i);
  body.where = beam_.where;
  body.mass = values_.per_length * length;
  body.inertia = body.mass * (length * length / 12.0 + values_.section.second_moment / values_.section.area);
  body.position = beam_.from + static_cast<double>(i) * h * values_.along;
  body.angle = portable::atan2(values_.along.y(), values_.along.x());
  body.cg = {0.5 * (ahead - behind), 0.0};
  const double half = 0.5 * values_.section.height;
  body.outline = {{-behind, -half}, {ahead, -half}, {ahead, half}, {-behind, half}};
}

std::string BeamMaker::add_marker(const std::string& name, long segment, const Vec2& point) {
  Marker& marker = model_.markers.emplace_back();
  marker.name = beam_.name + "." + name;
  marker.body = body_name(segment);
  marker.point = point;
  marker.where = beam_.where;
  return marker.name;
}

// Adds the elastic element between the segments i − 1 and i.
void BeamMaker::add_elastic_part(long i) {
  const double h = part_length();
  const std::string name = "part " + std::to_string(i);
  BeamPart& part = add_element<BeamPart>(model_, beam_part_kind(), beam_.name + "." + name);
  part.where = beam_.where;
  part.a = add_marker(name + ".ahead", i, {-0.5 * h, 0.0});
  part.b = add_marker(name + ".behind", i - 1, {0.5 * h, 0.0});
  part.length = h;
  part.axial_stiffness = values_.modulus * values_.section.area;
  part.bending_stiffness = values_.modulus * values_.section.second_moment;
  part.shear_stiffness = beam_.shear_stiffness;
  part.damping_time = values_.damping_time;
}

std::vector<std::string> material_names() {
  std::vector<std::string> names = {""};
  for (const Material& m : k_materials) names.emplace_back(m.name);
  return names;
}

} // namespace

void Beam::add_bodies(Model& model) const { BeamMaker(*this, model).make(); }

const TableKind& beam_kind() {
  static const TableKind kind = [] {
    using T = Beam;
    TableKind k;
    k.name = "beam";
    k.doc = "A straight elastic beam: rigid segments 'name.0' to 'name.n', which are bodies, with springs between them that are as stiff "
            "as the "
            "beam is. Its ends are the markers 'name.start' and 'name.end', with their x axes along it. Forces and couples at segments "
            "bend it exactly as the elastic line has it; frequencies are too low by about (j π/n)²/24.";
    FieldTable& f = k.fields;
    f.add("from", &T::from).in("m").required().doc("where its axis begins");
    f.add("to", &T::to).in("m").required().doc("where its axis ends");
    f.add("frame", &T::frame).one_of({"ground"}).doc("axes of from and to: those of the ground, in a part those of the part");
    f.add("segments", &T::segments)
        .at_least(1)
        .at_most(10000)
        .doc("parts n into which it is divided: a mode needs several to each of its waves");
    f.add("material", &T::material)
        .one_of(material_names())
        .doc("gives modulus and density: steel 210 GPa, 7850 kg/m3; aluminium 70 GPa, 2700 kg/m3");
    f.add("modulus", &T::modulus).in("Pa").positive().doc("Young's modulus, where no material gives it");
    f.add("density", &T::density).in("kg/m^3").positive().doc("goes before that of the material");
    f.add("mass_per_length", &T::mass_per_length).in("kg/m").positive().doc("of the beam and what lies on it, instead of a density");
    f.add("profile", &T::profile).doc("rolled section bent about its strong axis, \"IPE 80\" to \"IPE 600\"");
    f.add("width", &T::width).in("m").positive().doc("of a rectangular cross section, with height");
    f.add("height", &T::height).in("m").positive().doc("of a rectangular cross section, in the plane");
    f.add("diameter", &T::diameter).in("m").positive().doc("outer diameter of a round cross section, with wall");
    f.add("wall", &T::wall).in("m").positive().doc("of a round cross section; half of the diameter: solid");
    f.add("area", &T::area).in("m^2").positive().doc("of the cross section, with second_moment");
    f.add("second_moment", &T::second_moment).in("m^4").positive().doc("second moment of area about the axis of bending");
    f.add("shear_stiffness", &T::shear_stiffness).in("N").positive().doc("shear modulus times shear area; not given: it does not shear");
    f.add("damping_time", &T::damping_time)
        .in("s")
        .not_negative()
        .doc("what dampers have of stiffnesses: a mode of angular frequency w gets the ratio damping_time*w/2");
    f.add("damping_ratio", &T::damping_ratio).not_negative().doc("the same, given as the ratio of damping at damping_frequency");
    f.add("damping_frequency", &T::damping_frequency).in("Hz").positive().doc("where damping_ratio holds, for one that of the first mode");
    k.holds<T>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element&, Model&) {}; // nothing to apply later: the table only adds bodies and elements
    return k;
  }();
  return kind;
}

} // namespace steplap
