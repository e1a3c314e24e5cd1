#include "transformer/core/core.h"

#include "transformer/core/clamp.h"
#include "transformer/core/core_builder.h"

namespace steplap {

std::vector<std::string> Core::all_limbs() const {
  std::vector<std::string> all = limbs;
  all.insert(all.end(), middle_limbs.begin(), middle_limbs.end());
  return all;
}

std::string Core::joint_name(std::size_t limb) const { return joints.empty() ? all_limbs()[limb] + " joint" : joints[limb]; }

namespace {

void add_dimensions(FieldTable& f) {
  using T = Core;
  f.add("active_part", &T::active_part).as(FieldType::body).required().doc("the body with the yokes");
  f.add("limbs", &T::limbs).doc("bodies of the outer limbs, mitred to the yokes");
  f.add("middle_limbs", &T::middle_limbs).doc("bodies of the limbs between, which end in a point (T-joint)");
  f.add("joints", &T::joints)
      .doc("names of the joints, one for each limb, middle ones last; default '<limb> joint'. A step_lap_joint of that name "
           "is used as it stands, else one is added");
  f.add("core_height", &T::core_height)
      .in("m")
      .positive()
      .required()
      .doc("over both yokes, of the packet with the highest; its middle is at the origin of the limbs' body frames");
  f.add("limb_width", &T::limb_width).in("m").positive().doc("width of a limb's sheets, of a core of one packet");
  f.add("yoke_height", &T::yoke_height).in("m").positive().doc("of one yoke, of a core of one packet");
  f.add("packets", &T::packets)
      .in("m")
      .positive()
      .doc("stepped section: width of the limb's sheets and depth of each packet, from the front face to the back");
  f.add("yoke_heights", &T::yoke_heights).in("m").positive().doc("height of the yoke in each packet; of round yokes the limb's widths");
  f.add("yoke_steps", &T::yoke_steps)
      .one_of({"both", "window", "outside"})
      .doc("where yokes of several packets are stepped: on both sides (an axis in common), at the "
           "window or outside only");
  f.add("ducts", &T::ducts)
      .in("m")
      .doc("oil ducts across the stack: depth of stack in front of each, and its width; sheets on either side do not touch");
  f.add("bolt_holes", &T::bolt_holes)
      .in("m")
      .doc("centres of holes at every corner, through limb and yoke: from where the axes of limb "
           "and yoke cross, outwards and "
           "away from the window");
  f.add("bolt_hole_diameter", &T::bolt_hole_diameter).in("m").positive().doc("of all bolt holes");
  f.add("mitre_angle", &T::mitre_angle).in("rad").doc("against the yoke; default: from corner to corner");
  f.add("notch_angle", &T::notch_angle).in("rad").doc("of a middle limb's point against the yoke; default: 45°");
  f.add("sheet_outlines", &T::sheet_outlines)
      .one_of({"real", "strips"})
      .doc("real: as limb and yoke have them; strips: along the mitre, with square ends, as in the "
           "paper (counted overlaps only)");
  f.add("tongue", &T::tongue)
      .in("m")
      .positive()
      .doc("of strips: length of sheet on either side of the middle of the mitre; default: 50 mm");
  f.add("margin", &T::margin)
      .in("m")
      .not_negative()
      .doc("of strips: of the yoke's sheet beyond the limb's at either end of the mitre; default: 20 mm");
  f.add("density", &T::density).in("kg/m^3").positive().doc("of the sheets");
  f.add("centre_of_gravity", &T::centre_of_gravity)
      .one_of({"of_the_sheets", "as_given"})
      .doc("of the limbs: that of their sheets where the body gives none, or the body's 'cg'");
}

void add_stack(FieldTable& f) {
  using T = Core;
  f.add("overlap", &T::overlap).in("m").positive().doc("of one interface, across the mitre");
  f.add("interfaces", &T::interfaces).positive().doc("that carry an overlap, number at a corner");
  f.add("stack_depth", &T::stack_depth).in("m").positive().doc("of steel and insulation, of a core of one packet");
  f.add("stacking_factor", &T::stacking_factor).positive().at_most(1.0).doc("steel's share of the stack");
  f.add("sheet_thickness", &T::sheet_thickness).in("m").positive().doc("of the steel");
  f.add("sheets_per_layer", &T::sheets_per_layer).at_least(1).at_most(100).doc("equal sheets one on the other");
  f.add("steps", &T::steps).at_least(2).at_most(100).doc("lines at which the sheets of a book meet");
  f.add("step_pitch", &T::step_pitch).in("m").positive().doc("from layer to layer");
  f.add("pitch_direction", &T::pitch_direction)
      .one_of({"across", "along_limb", "along_yoke"})
      .doc("how 'step_pitch' is measured: across the mitre, or along the length of the limb's or the yoke's sheet");
  f.add("book", &T::book)
      .one_of({"saw_tooth", "zig_zag", "zig_zag_doubled"})
      .doc("order of the layers: 1 2 3 | 1 2 3, 1 2 3 2 | 1 2 3 2, or 1 2 3 | 3 2 1");
  f.add("clearance", &T::clearance)
      .in("m")
      .not_negative()
      .doc("between the sheets of one layer, across the "
           "mitre; a run says whether a limb closes it");
  f.add("bands", &T::bands)
      .one_of({"mean", "each"})
      .doc("each: every overlap of a book where it is; mean: all of a packet as one of their mean area (quicker)");
}

void add_friction(FieldTable& f) {
  using T = Core;
  f.add("pressure", &T::pressure).in("Pa").not_negative().doc("clamping pressure, constant; needed unless [[clamp]] tables press the core");
  f.add("static_friction", &T::static_friction).positive().required().doc("mu_s");
  f.add("kinetic_friction", &T::kinetic_friction).positive().doc("mu_k; default: mu_s");
  f.add("bottom_pressure", &T::bottom_pressure).in("Pa").positive().doc("at the bottom corners, if different");
  f.add("bottom_static_friction", &T::bottom_static_friction)
      .positive()
      .doc("at the bottom corners, if "
           "different");
  f.add("bottom_kinetic_friction", &T::bottom_kinetic_friction)
      .positive()
      .doc("at the bottom corners, if "
           "different");
  f.add("pressure_shares", &T::pressure_shares)
      .positive()
      .doc("of each packet: its pressure over 'pressure' (or 'bottom_pressure'); where packets "
           "meet the mean of both; default: all 1");
  f.add("joint_pressure_shares", &T::joint_pressure_shares)
      .positive()
      .doc("of each joint, in the order of 'joints': all its pressures over those given; default: all 1");
  f.add("pressure_gradient", &T::pressure_gradient)
      .in("Pa/m")
      .doc("by which the pressure grows outwards (at a T-joint: off the limb's axis, to either side) and away from the "
           "window; 'pressure' is then that at the middle of the mitre. Default: uniform over a corner");
  f.add("bottom_pressure_gradient", &T::bottom_pressure_gradient).in("Pa/m").doc("at the bottom corners, if different");
}

void add_joints(FieldTable& f) {
  using T = Core;
  f.add("pressure_signal", &T::pressure_signal)
      .as(FieldType::signal)
      .doc("of the joints added: factor of all their pressures in time, above 0");
  f.add("pressure_loss", &T::pressure_loss)
      .not_negative()
      .at_most(0.99)
      .doc("of the joints added: share of all their pressures that relaxation has taken");
  f.add("transverse_acceleration", &T::transverse_acceleration)
      .as(FieldType::signal)
      .in("m/s^2")
      .doc("across the sheets, from the front face to the back: packets' pressures follow, by what leans on them");
  f.add("transverse_support", &T::transverse_support)
      .one_of({"both", "front", "back"})
      .doc("what holds the stack against it: both faces alike (one gains what the other loses), or one face while the other is "
           "pressed by a force that does not change; with 'transverse_acceleration', without a default");
  f.add("transverse_slices", &T::transverse_slices)
      .at_least(1)
      .at_most(100)
      .doc("of each packet with its own pressure; default: 1, correct until a packet has lost all its pressure");
  f.add("tangential_stiffness", &T::tangential_stiffness)
      .in("N/m")
      .positive()
      .doc("of each of the joints added, in translation: they yield before they slide, see step_lap_joint");
  f.add("contact_stiffness", &T::contact_stiffness).in("N/m^3").positive().doc("the same, of a square metre of one interface");
  f.add("shear_modulus", &T::shear_modulus)
      .in("Pa")
      .positive()
      .doc("of the sheets, of 'sheet_thickness', in series with 'contact_stiffness'");
  f.add("edge_stiffness", &T::edge_stiffness)
      .in("N/m^2")
      .positive()
      .doc("of sheet edges once 'clearance' has closed, of all sheets at a corner, see step_lap_joint");
  f.add("allowed_line_load", &T::allowed_line_load)
      .in("N/m")
      .positive()
      .doc("of all sheets at a corner, along the mitre: a joint whose edges carry more is rejected");
  f.add("mode", &T::mode).one_of({"slip", "monitor"}).doc("of the joints added, see step_lap_joint");
  f.add("on_apart", &T::on_apart).one_of({"stop", "continue"}).doc("of the joints added, see step_lap_joint");
  f.add("least_margin", &T::least_margin).at_least(1.0).doc("of the joints added, see step_lap_joint");
  f.add("most_slide", &T::most_slide).positive().at_most(1.0).doc("of the joints added, see step_lap_joint");
}

} // namespace

const TableKind& core_kind() {
  static const TableKind kind = [] {
    TableKind k;
    k.name = "core";
    k.doc = "A core's limbs, mitred to the yokes: adds a step_lap_joint for each limb, with the sheets of its top "
            "and bottom corner (outer limbs) or of both sides of its points (middle limbs). The overlaps are given by 'overlap' and "
            "'interfaces', or by how the "
            "stack is built; then limbs without a mass get that of their sheets.";
    add_dimensions(k.fields);
    add_stack(k.fields);
    add_friction(k.fields);
    add_joints(k.fields);
    k.holds<Core>();
    k.reads_masses = k.reads_elements = false; // the table reads only names of elements and outlines of sheets
    k.apply = [](const Element& table, Model& model) {
      const auto& core = static_cast<const Core&>(table);
      if (has_sound_clamps(core, model)) build_core(clamped(core, model), model);
    };
    return k;
  }();
  return kind;
}

} // namespace steplap
