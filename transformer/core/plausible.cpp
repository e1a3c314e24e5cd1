#include "transformer/core/plausible.h"

#include "elements/step_lap/step_lap_interface.h"
#include "mbd/base/number_text.h"
#include "mbd/model/entries.h"
#include "transformer/core/clamp.h"
#include "transformer/core/core.h"
#include "transformer/core/core_builder.h"
#include "transformer/core/core_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace steplap {

namespace {

// Usual range of the ratio of given to computed masses (k_light, k_heavy) and moments of inertia (k_small, k_large). Given values may be
// lower (stacking factor, cropped corners) or higher (tie plates, bindings).
constexpr double k_light = 0.98, k_heavy = 1.10, k_small = 0.95, k_large = 1.15;
constexpr double k_off_centre = 10e-3; // largest usual distance of a given centre of gravity from that of the sheets, m

const char* const k_assumed = "assumed: nothing published was found";

constexpr double k_shop_mitre = 0.25 * std::numbers::pi;         // usual mitre angle in workshops, rad
constexpr double k_same_angle = 0.05 * std::numbers::pi / 180.0; // tolerance of angles, rad, which are given to a tenth of a degree

std::string degrees_text(double angle) { return number_text(std::round(angle * 1800.0 / std::numbers::pi) / 10.0) + "°"; }

std::string rounded_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

class PlausibilityCheck {
public:
  PlausibilityCheck(const Model& model, const Core& core, std::vector<CoreRemark>& said) : model_(model), core_(core), said_(said) {
    for (const std::string& limb : core_.all_limbs())
      for (const CoreOfLimb& table : cores_of(model_, limb))
        if (std::find(stack_.begin(), stack_.end(), table.core) == stack_.end()) stack_.push_back(table.core);
  }

  void run() {
    check_fields();
    check_packets();
    check_shape();
    note_mitre();
    check_angles();
    check_rows();
    check_steel();
  }

private:
  void say(const std::string& field, const std::string& message) {
    said_.push_back({core_.place(field), "core '" + core_.name + "': " + message});
  }
  void look_at(const std::string& field, double value, const std::string& unit, const std::string& name) {
    for (const UsualRange& usual : usual_ranges())
      if (usual.field == field && (value < usual.low || value > usual.high))
        say(field, name + " = " + number_text(value) + (unit.empty() ? "" : " " + unit) + " is unusual: " + usual.text + " are usual (" +
                       usual.source + ")");
  }

  void check_fields() {
    for (const Field& field : core_kind().fields.fields()) {
      if (field.type != FieldType::number && field.type != FieldType::integer) continue;
      const bool is_of_section = field.name == "limb_width" || field.name == "yoke_height" || field.name == "stack_depth";
      if (is_of_section && is_one_of_several()) continue; // check_packets
      const FieldValue value = field.get(&core_);
      const std::string name = "'" + field.name + "'";
      if (const double* number = std::get_if<double>(&value)) look_at(field.name, *number, field.unit, name);
      if (const long* number = std::get_if<long>(&value)) look_at(field.name, static_cast<double>(*number), "", name);
    }
  }

  [[nodiscard]] bool is_one_of_several() const { return stack_.size() > 1; }
  // Returns true for the first of several tables that describe one stack, which reports on the stack as a whole.
  [[nodiscard]] bool reports_on_stack() const { return stack_.front()->name == core_.name; }

  // Checks the smallest and the largest of several pressure shares.
  void check_shares(const std::string& field, const std::vector<double>& shares) {
    if (shares.empty()) return;
    const auto [least, most] = std::minmax_element(shares.begin(), shares.end());
    for (const double share : {*least, *most})
      for (const UsualRange& usual : usual_ranges())
        if (const double p = share * core_.pressure; usual.field == std::string("pressure") && (p < usual.low || p > usual.high) &&
                                                     core_.pressure >= usual.low && core_.pressure <= usual.high)
          say(field, "'" + field + "': " + number_text(share) + " of 'pressure' is " + number_text(p) +
                         " Pa, which is unusual: " + usual.text + " are usual (" + usual.source + ")");
  }

  void check_packets() {
    double width = 0.0, depth = 0.0, highest = 0.0;
    for (const Core* table : stack_)
      for (const Packet& packet : stack_of(*table).packets) {
        width = std::max(width, packet.width);
        depth += packet.depth;
        highest = std::max(highest, packet.yoke_height);
      }
    if (reports_on_stack() && (is_one_of_several() || !core_.packets.empty())) {
      const std::string all = is_one_of_several() ? "packets in all tables of limb '" + core_.all_limbs().front() + "'" : "'packets'";
      look_at("limb_width", width, "m", "the widest of " + all);
      if (!is_counted()) look_at("stack_depth", depth, "m", "the depth of all " + all);
      look_at("yoke_height", highest, "m", is_one_of_several() ? "the highest yoke of " + all : "the highest of 'yoke_heights'");
    }
    check_shares("pressure_shares", core_.pressure_shares);
    check_shares("joint_pressure_shares", core_.joint_pressure_shares);
    for (const Vec2& duct : core_.ducts) look_at("ducts", duct.y(), "m", "the width of a duct in 'ducts'");
  }

  void check_shape() {
    const CoreGeometry geometry(core_);
    const Mitre m = geometry.mitre(geometry.largest(), false);
    const double window = m.core_height - 2.0 * m.yoke_height;
    if (window < m.limb_width)
      say("core_height", "'core_height' = " + number_text(m.core_height) + " m leaves a window " + rounded_text(window) +
                             " m high between limbs " + number_text(m.limb_width) +
                             " m wide: windows are usually higher than limbs are wide (" + k_assumed + ")");
    if (is_counted() || !reports_on_stack()) return;
    double depth = 0.0, width = 0.0;
    for (const Core* table : stack_) {
      const CoreGeometry own(*table);
      depth += depth_of(own.stack());
      width = std::max(width, own.mitre(own.largest(), false).limb_width);
    }
    if (depth < 0.4 * width || depth > 1.8 * width)
      say("stack_depth", "a stack " + rounded_text(depth) + " m deep of limbs " + number_text(width) +
                             " m wide is unusual: sections are about as deep as wide, 0.4 to 1.8 of it (" + k_assumed + ")");
  }

  // Reports a mitre angle that follows from the dimensions (corner to corner) and is not the angle that workshops cut.
  void note_mitre() {
    if (core_.mitre_angle || core_.limbs.empty()) return;
    const CoreGeometry geometry(core_);
    const std::size_t packets = geometry.stack().packets.size();
    double least = k_shop_mitre, most = k_shop_mitre;
    std::string each;
    for (std::size_t p = 0; p < packets; ++p) {
      const double angle = geometry.angle(p, false);
      least = std::min(least, angle);
      most = std::max(most, angle);
      each += (p == 0 ? "" : p + 1 == packets ? " and " : ", ") + degrees_text(angle);
    }
    if (k_shop_mitre - least < k_same_angle && most - k_shop_mitre < k_same_angle) return;
    const bool is_one = packets == 1;
    said_.push_back({core_.place("mitre_angle"),
                     "core '" + core_.name + "': without 'mitre_angle' the mitre runs from corner to corner, here at " + each +
                         " against the yoke" + (is_one ? "" : ", packet by packet") +
                         ". Workshops cut 45°: if this core is cut so, give 'mitre_angle' = \"45 degree\"",
                     true});
  }

  // The sheets of a limb lie along the axes of the active part, whatever the angle of its body.
  void check_angles() {
    for (const std::string& name : core_.all_limbs()) {
      const Body &limb = *model_.find_body(name), &part = *model_.find_body(core_.active_part);
      const double turn = std::remainder(limb.angle - part.angle, 2.0 * std::numbers::pi);
      if (std::abs(turn) <= k_same_angle) continue;
      said_.push_back({limb.where, "body '" + name + "': 'angle' differs by " + degrees_text(turn) + " from that of '" + core_.active_part +
                                       "', and the sheets of core '" + core_.name +
                                       "' lie along the axes of that all the same: give both the same 'angle'"});
    }
  }

  // Checks that limbs of another table can stand between yokes that both share: not beyond the ends, and each in a place of its own.
  void check_rows() {
    const auto width_of = [](const Core& core) {
      const CoreGeometry geometry(core);
      return geometry.mitre(geometry.largest(), false).limb_width;
    };
    const std::vector<LimbPlace> own = places_of_limbs(core_, model_);
    const std::vector<std::string> names = core_.all_limbs();
    bool is_after = false; // two limbs in one place are reported once, by the first table
    for (const Core* other : tables_of<Core>(model_)) {
      if (other->name == core_.name) is_after = true;
      if (other->name == core_.name || !share_yokes(core_, *other)) continue;
      const std::vector<LimbPlace> places = places_of_limbs(*other, model_);
      const double apart = 0.5 * (width_of(core_) + width_of(*other));
      for (std::size_t i = 0; i < own.size(); ++i)
        for (std::size_t j = 0; j < places.size(); ++j) {
          const std::string limb = "limb '" + other->all_limbs()[j] + "' of core '" + other->name + "', which has the same yokes, stands ";
          const char* const remedy = "; another core has an active part of its own";
          if (is_after && std::abs(places[j].x - own[i].x) < apart)
            say(core_.is_middle(i) ? "middle_limbs" : "limbs", limb + "in the same place as '" + names[i] + "'" + remedy);
          else if (!core_.is_middle(i) && own[i].side * (places[j].x - own[i].x) >= apart)
            say("limbs", limb + "beyond outer limb '" + names[i] +
                             "', where the yokes end: name the limbs between the outermost in 'middle_limbs'" + remedy);
        }
    }
  }

  void check_steel() {
    for (const std::string& name : core_.all_limbs()) {
      const std::vector<CoreOfLimb> tables = cores_of(model_, name);
      if (tables.front().core->name != core_.name) continue; // of several tables, the first one reports
      const Body &limb = *model_.find_body(name), &part = *model_.find_body(core_.active_part);
      const std::string body = "body '" + limb.name + "'";
      const std::optional<LimbSteel> steel = steel_of(model_, name);
      if (!steel) {
        const auto counted = std::find_if(tables.begin(), tables.end(), [](const CoreOfLimb& t) { return t.core->is_counted(); });
        if (counted == tables.end()) continue;
        said_.push_back({limb.where, body + ": " + std::to_string(tables.size()) + " [[core]] tables name it, and 'overlap' of core '" +
                                         counted->core->name +
                                         "' does not say what its part of the stack weighs: no packet is judged alone, and mass and centre "
                                         "of gravity are not compared with the sheets. Give 'stack_depth' and the like in each"});
        continue;
      }
      if (core_.has_strips()) continue;
      const std::string sheets = tables.size() == 1 ? "the sheets of core '" + core_.name + "' " : "the sheets of all its cores ";
      if (steel->mass > 0.0) {
        compare(limb.where, body + ": 'mass'", limb.mass, steel->mass, k_light, k_heavy, sheets, "kg");
        compare(limb.where, body + ": 'inertia'", limb.inertia, steel->inertia, k_small, k_large, sheets, "kg m²");
      }
      const Vec2 centre = rotated(steel->centre, part.angle - limb.angle);
      if (core_.centre_of_gravity == "of_the_sheets" && (limb.cg - centre).norm() > k_off_centre)
        said_.push_back({limb.where, body + ": 'cg' = [" + number_text(limb.cg.x()) + ", " + number_text(limb.cg.y()) + "] m, " + sheets +
                                         "have theirs at [" + rounded_text(centre.x()) + ", " + rounded_text(centre.y()) +
                                         "] m from the middle of the limb"});
    }
  }

  void compare(const Location& where, const std::string& what, double given, double steel, double low, double high,
               const std::string& sheets, const char* unit) {
    if (given >= low * steel && given <= high * steel) return;
    said_.push_back({where, what + " = " + number_text(given) + " " + unit + ", " + sheets + "make it " + rounded_text(steel) + " " + unit +
                                (given < steel ? ": too light a limb takes too little friction to be held"
                                               : ": more than tie plates and bindings usually add")});
  }

  // Returns true if the depth of a part of the stack is unknown.
  [[nodiscard]] bool is_counted() const {
    return std::any_of(stack_.begin(), stack_.end(), [](const Core* table) { return table->is_counted(); });
  }

  const Model& model_;
  const Core& core_;
  std::vector<CoreRemark>& said_;
  std::vector<const Core*> stack_; ///< tables that have a limb in common with this one, with it
};

} // namespace

const std::vector<UsualRange>& usual_ranges() {
  static const std::vector<UsualRange> ranges = {
      {"core_height", 0.8, 6.0, "0.8 m to 6 m", k_assumed},
      {"limb_width", 0.15, 1.4, "0.15 m to 1.4 m", "assumed: 0.6 m to 0.8 m at 100 to 150 MVA"},
      {"yoke_height", 0.1, 1.4, "0.1 m to 1.4 m", "assumed, as limbs"},
      {"stack_depth", 0.1, 1.5, "0.1 m to 1.5 m", "assumed, as limbs"},
      {"sheet_thickness", 0.18e-3, 0.35e-3, "0.18 mm to 0.35 mm", "grain-oriented sheet, US patent 4948656"},
      {"stacking_factor", 0.91, 0.98, "0.91 to 0.98", "makers' data; 0.97 at 1 MPa by EN 60404-13"},
      {"sheets_per_layer", 1, 2, "1 or 2", "Cogent Power, Multi-step lap core technical data"},
      {"steps", 3, 7, "3 to 7", "Cogent Power, Multi-step lap core technical data"},
      {"step_pitch", 3e-3, 10e-3, "3 mm to 10 mm", "assumed; 4 mm to 6 mm typical"},
      {"clearance", 0.2e-3, 3e-3, "0.2 mm to 3 mm", "assumed; 0.5 mm to 1 mm typical"},
      {"overlap", 2e-3, 25e-3, "2 mm to 25 mm", "assumed, by books of 3 to 7 steps"},
      {"interfaces", 100, 6000, "100 to 6000 a corner", "assumed: sheets in a stack"},
      {"mitre_angle", 0.52, 1.05, "30° to 60°", "assumed; 45° typical"},
      {"notch_angle", 0.52, 1.05, "30° to 60°", "assumed; 45° typical"},
      {"ducts", 2e-3, 15e-3, "2 mm to 15 mm", k_assumed},
      {"bolt_hole_diameter", 8e-3, 60e-3, "8 mm to 60 mm", k_assumed},
      {"density", 7600, 7700, "7600 to 7700 kg/m³", "iron with 3 % silicon, 7650"},
      {"pressure", 0.05e6, 0.4e6, "0.05 MPa to 0.4 MPa", k_assumed},
      {"bottom_pressure", 0.05e6, 0.4e6, "0.05 MPa to 0.4 MPa", k_assumed},
      {"pressure_loss", 0.0, 0.5, "0 to 0.5", k_assumed},
      {"tangential_stiffness", 1e9, 1e13, "1e9 to 1e13 N/m", "assumed: 'contact_stiffness' over 1 to 50 m² of interfaces"},
      {"contact_stiffness", 2e9, 2e11, "2e9 to 2e11 N/m³", "assumed: a micrometre of micro-slip at 20 kPa, and a factor of ten"},
      {"shear_modulus", 60e9, 130e9, "60 to 130 GPa", "crystals of iron with 3 % silicon, by direction"},
      {"edge_stiffness", 1e8, 6e12, "1e8 to 6e12 N/m²", "assumed; at most that of sheets in compression, E h/(b/2)"},
      {"allowed_line_load", 1e5, 4.5e8, "1e5 to 4.5e8 N/m", "assumed; at most yield, 300 MPa times the steel's thickness"},
      {"static_friction", 0.1, 0.3, "0.1 to 0.3", "assumed: no value for coated sheets is published"},
      {"kinetic_friction", 0.07, 0.3, "0.07 to 0.3", "assumed: no value for coated sheets is published"},
      {"bottom_static_friction", 0.1, 0.3, "0.1 to 0.3", "assumed: no value for coated sheets is published"},
      {"bottom_kinetic_friction", 0.07, 0.3, "0.07 to 0.3", "assumed: no value for coated sheets is published"},
  };
  return ranges;
}

std::vector<CoreRemark> implausible_cores(const Model& model) {
  std::vector<CoreRemark> said;
  for (const Core* core : tables_of<Core>(model)) PlausibilityCheck(model, clamped(*core, model), said).run();
  // Checks interfaces defined individually. Those generated by a [[core]] are checked and reported with the core.
  const auto is_of_core = [&](const StepLapInterface& face) {
    return std::any_of(model.tables.begin(), model.tables.end(),
                       [&](const TableEntry& entry) { return face.name.rfind(entry.table->name + ": ", 0) == 0; });
  };
  for (const StepLapInterface* face : elements_of<StepLapInterface>(model)) {
    if (is_of_core(*face)) continue;
    for (const UsualRange& usual : usual_ranges())
      for (const auto& [field, value] : {std::pair<std::string, double>{"pressure", face->pressure},
                                         {"static_friction", face->static_friction},
                                         {"kinetic_friction", face->kinetic_friction.value_or(face->static_friction)}})
        if (field == usual.field && (value < usual.low || value > usual.high) && (field != "kinetic_friction" || face->kinetic_friction))
          said.push_back({face->where, "step_lap_interface '" + face->name + "': '" + field + "' = " + number_text(value) +
                                           (field == "pressure" ? " Pa" : "") + " is unusual: " + usual.text + " are usual (" +
                                           usual.source + ")"});
  }
  return said;
}

} // namespace steplap
