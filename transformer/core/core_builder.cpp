#include "transformer/core/core_builder.h"

#include "elements/step_lap/step_lap_interface.h"
#include "elements/step_lap/step_lap_joint.h"
#include "mbd/base/number_text.h"
#include "mbd/model/entries.h"
#include "mbd/model/validate.h"
#include "transformer/core/core_dimensions.h"
#include "transformer/core/core_geometry.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Range of the ratio of a body's given mass to that of its sheets; outside it the model is rejected. Tie plates, bindings and the like add
// a few percent. Within it, beyond the plausible range (plausible.cpp), there is a remark.
constexpr double k_least_steel = 0.8, k_most_steel = 1.6;

// Returns the middle of the limb in its body's frame: the origin, except for the paper's strips, which are relative to the centre of
// gravity.
Vec2 middle_in_frame(const Core& core, const Body& limb) { return core.has_strips() ? limb.cg : Vec2(Vec2::Zero()); }

// Returns true if the fields are within their ranges and consistent, so that geometry may be computed from the table.
bool is_sound(const Core& core, const Model& model) {
  std::vector<Diagnostic> problems;
  FieldChecker(model, problems).check(core_kind().fields, &core, "", [&core](const std::string&) { return std::optional(core.where); });
  return problems.empty() && check_dimensions(core).empty();
}

// Expands one [[core]]; collects all errors before it reports them.
class CoreBuilder {
public:
  CoreBuilder(const Core& core, Model& model) : core_(core), model_(model), limbs_(core.all_limbs()) {}

  void build() {
    check_names();
    const std::vector<Diagnostic> found = check_dimensions(core_);
    problems_.insert(problems_.end(), found.begin(), found.end());
    if (core_.pressure == 0.0)
      error("needs 'pressure' above 0, that clamps its sheets (in Pa), or a [[clamp]] with what presses them", "pressure");
    stop_if_wrong();
    const CoreGeometry geometry(core_);
    try {
      for (std::size_t i = 0; i < limbs_.size(); ++i) add_joint(i, geometry);
      for (std::size_t i = 0; i < limbs_.size(); ++i) give_steel(i);
    } catch (const PolygonError& wrong) {
      error(wrong.what(), "bolt_holes");
    }
    check_yokes();
    stop_if_wrong();
    set_limb_outlines(geometry);
    set_active_part_outline(geometry);
  }

private:
  // Adds an error with the location of `field`, or of the table if the field is not given.
  void error(const std::string& message, const std::string& field = "") {
    problems_.push_back({core_.place(field), "core '" + core_.name + "': " + message});
  }
  void stop_if_wrong() {
    if (!problems_.empty()) throw ModelError(std::move(problems_));
  }
  [[nodiscard]] double widest() const {
    double width = core_.limb_width.value_or(0.0);
    for (const Vec2& packet : core_.packets) width = std::max(width, packet.x());
    return width;
  }
  [[nodiscard]] const char* list_of(std::size_t limb) const { return core_.is_middle(limb) ? "middle_limbs" : "limbs"; }
  [[nodiscard]] const Element* find_element(const std::string& name) const;
  [[nodiscard]] const Body& limb(std::size_t i) const { return *model_.find_body(limbs_[i]); }
  [[nodiscard]] const Body& active_part() const { return *model_.find_body(core_.active_part); }

  void check_names();
  void check_limb(std::size_t i, const Body& active_part);
  void check_distance(std::size_t i, std::size_t j, const Body& active_part);
  void check_row(const Body& active_part);
  void check_other_tables(std::size_t i);
  void check_joint(const std::string& name, const std::string& limb);
  void check_settings(const StepLapJoint& joint);
  [[nodiscard]] bool is_given(const std::string& field) const { return core_.places.count(field) > 0; }

  void add_joint(std::size_t i, const CoreGeometry& geometry);
  void give_settings(StepLapJoint& joint) const;
  void add_interface(std::size_t i, const CoreCorner& corner, const Lap& lap, const CoreGeometry& geometry);
  void check_packets(std::size_t i, const CoreCorner& corner, const CoreGeometry& geometry);
  void find_parts(std::size_t i, const CoreGeometry& geometry);
  void press(StepLapInterface& face, std::size_t i, const CoreCorner& corner, const Lap& lap, const CoreGeometry& geometry);
  void refuse_repetition(const StepLapInterface& face);
  void give_steel(std::size_t i);
  void check_yokes();
  void check_steel(const Body& body, const char* field, double given, double steel, const std::string& unit);
  [[nodiscard]] std::string names_of_tables(const std::string& limb) const;

  [[nodiscard]] std::vector<Vec2> limb_corners(std::size_t i, const CoreGeometry& geometry) const;
  void set_limb_outlines(const CoreGeometry& geometry);
  void set_active_part_outline(const CoreGeometry& geometry);

  const Core& core_;
  Model& model_;
  std::vector<std::string> limbs_;  ///< outer limbs, then middle ones
  std::vector<double> part_shares_; ///< fraction of the present limb's steel in each packet; empty: packets are not distinguished
  bool is_shared_ = false;          ///< several tables name the present limb
  std::vector<Diagnostic> problems_;
};

// --- references -------------------------------------------------------------------------------------

const Element* CoreBuilder::find_element(const std::string& name) const {
  for (const ElementEntry& entry : model_.elements)
    if (entry.element->name == name) return entry.element.get();
  return nullptr;
}

void CoreBuilder::check_names() {
  const Body* active_part = model_.find_body(core_.active_part);
  if (!active_part) return error("'active_part' must be a body that moves, not 'ground'", "active_part");
  if (limbs_.empty()) error("'limbs' or 'middle_limbs' must name at least one body");
  for (std::size_t i = 0; i < limbs_.size(); ++i) {
    check_limb(i, *active_part);
    for (std::size_t j = 0; j < i; ++j)
      if (limbs_[j] == limbs_[i]) error("names limb '" + limbs_[i] + "' twice", list_of(i));
      else check_distance(i, j, *active_part);
  }
  check_row(*active_part);
  if (!core_.joints.empty() && core_.joints.size() != limbs_.size())
    return error("'joints' must name one joint for each of the " + std::to_string(limbs_.size()) + " limbs, got " +
                     std::to_string(core_.joints.size()),
                 "joints");
  for (std::size_t i = 0; i < limbs_.size(); ++i) {
    check_joint(core_.joint_name(i), limbs_[i]);
    check_other_tables(i);
  }
}

void CoreBuilder::check_limb(std::size_t i, const Body& active_part) {
  const std::string& name = limbs_[i];
  const Body* limb = model_.find_body(name);
  if (!limb) {
    std::vector<std::string> known;
    for (const Body& body : model_.bodies) known.push_back(body.name);
    return error("limb '" + name + "' is no body" + did_you_mean(name, known), list_of(i));
  }
  if (limb == &active_part) return error("limb '" + name + "' is the active part itself", list_of(i));
  if (!core_.is_middle(i) && std::abs(middle_of_limb(core_, *limb, active_part).x()) < 0.5 * widest())
    error("limb '" + name +
              "' stands in the middle of the active part: only outer limbs, at least half a "
              "limb's width ahead of its centre of gravity or behind it, have mitred corners; name it in "
              "'middle_limbs'",
          "limbs");
}

// Checks that two limbs of a core do not overlap.
void CoreBuilder::check_distance(std::size_t i, std::size_t j, const Body& active_part) {
  const Body *a = model_.find_body(limbs_[i]), *b = model_.find_body(limbs_[j]);
  if (!a || !b || a == b || a == &active_part || b == &active_part) return;
  const double apart = std::abs(middle_of_limb(core_, *a, active_part).x() - middle_of_limb(core_, *b, active_part).x());
  if (apart < widest())
    error("limbs '" + a->name + "' and '" + b->name + "' stand " + number_text(apart) +
              " m apart ('position' of the bodies), less than a limb is wide, " + number_text(widest()) + " m ('" +
              (core_.packets.empty() ? "limb_width" : "packets") + "')",
          core_.packets.empty() ? "limb_width" : "packets");
}

// Checks that the limbs of a table can stand between the same two straight yokes: each ends at one outer limb on either side, with the
// middle limbs between them.
void CoreBuilder::check_row(const Body& active_part) {
  constexpr double k_level = 0.01; // largest difference of heights, of the height of the core: more is not an inaccuracy of a drawing
  struct Standing {
    std::size_t limb;
    Vec2 middle;
  };
  std::vector<Standing> all;
  for (std::size_t i = 0; i < limbs_.size(); ++i)
    if (const Body* body = model_.find_body(limbs_[i]); body && body != &active_part)
      all.push_back({i, middle_of_limb(core_, *body, active_part)});
  for (const Standing& a : all)
    for (const Standing& b : all) {
      const bool is_one_side = (a.middle.x() > 0.0) == (b.middle.x() > 0.0);
      const std::string names = "limbs '" + limbs_[a.limb] + "' and '" + limbs_[b.limb] + "' ";
      if (const double apart = std::abs(a.middle.y() - b.middle.y()); a.limb < b.limb && apart > k_level * core_.core_height)
        error(names + "stand at heights that differ by " + number_text(std::round(1e3 * apart) / 1e3) +
                  " m ('position' of the bodies, in the axes of '" + core_.active_part +
                  "'): the middles of all limbs lie at half the height of the core",
              list_of(b.limb));
      if (core_.is_middle(a.limb) || !is_one_side || a.limb == b.limb) continue;
      if (!core_.is_middle(b.limb) && a.limb < b.limb)
        error(names + "are both outer limbs on one side of the middle of '" + core_.active_part +
                  "', where the yokes end at one: name those between the outermost in 'middle_limbs'; another core has an active part of "
                  "its own",
              "limbs");
      if (core_.is_middle(b.limb) && std::abs(b.middle.x()) > std::abs(a.middle.x()))
        error("middle limb '" + limbs_[b.limb] + "' stands outside outer limb '" + limbs_[a.limb] +
                  "', where the yokes end ('position' of the bodies): the outermost limb of a side belongs in 'limbs', those between in "
                  "'middle_limbs'",
              "middle_limbs");
    }
}

// Checks that another table that names the same limb can describe a part of the same stack.
void CoreBuilder::check_other_tables(std::size_t i) {
  bool is_before = true; // each contradiction is reported once, by the later table
  for (const CoreOfLimb& other : cores_of(model_, limbs_[i])) {
    if (other.core->name == core_.name) {
      is_before = false;
      continue;
    }
    const std::string limb = "limb '" + limbs_[i] + "', which core '" + other.core->name + "' names, too, ";
    if (!core_.transverse_acceleration.empty())
      error(limb + "needs its whole stack in one table for 'transverse_acceleration': a packet is pressed by all that leans on it. Give "
                   "all its 'packets' in one table",
            "transverse_acceleration");
    if (!is_before) continue;
    if (other.core->is_middle(other.limb) != core_.is_middle(i))
      error(limb + (core_.is_middle(i) ? "counts as a middle limb here and as an outer one there"
                                       : "counts as an outer limb here and as a middle one there"),
            list_of(i));
    if (other.core->joints.empty() || other.core->joints.size() == other.core->all_limbs().size())
      if (const std::string joint = other.core->joint_name(other.limb); joint != core_.joint_name(i))
        error(limb + "is held by joint '" + joint + "' there and by '" + core_.joint_name(i) +
                  "' here: a limb has one joint. Give it the same name in the 'joints' of both",
              "joints");
    if (other.core->centre_of_gravity != core_.centre_of_gravity)
      error(limb + "has 'centre_of_gravity' = \"" + other.core->centre_of_gravity + "\" there and \"" + core_.centre_of_gravity +
                "\" here: give both the same",
            "centre_of_gravity");
  }
}

void CoreBuilder::check_joint(const std::string& name, const std::string& limb) {
  if (name.empty()) return error("'joints': a joint needs a name", "joints");
  const Element* element = find_element(name);
  if (!element) return;
  const auto* joint = dynamic_cast<const StepLapJoint*>(element);
  if (!joint) return error("joint '" + name + "': the element of this name is no step_lap_joint", "joints");
  if (joint->limb != limb || joint->active_part != core_.active_part)
    error("step_lap_joint '" + name + "' holds '" + joint->limb + "' to '" + joint->active_part + "', not '" + limb + "' to '" +
              core_.active_part + "'",
          "joints");
  check_settings(*joint);
}

// Checks that the core's settings for joints agree with those of a joint that the model declares separately.
void CoreBuilder::check_settings(const StepLapJoint& joint) {
  const std::vector<CoreOfLimb> tables = cores_of(model_, joint.limb);
  const auto maker = std::find_if(tables.begin(), tables.end(), [&](const CoreOfLimb& table) {
    const Location& where = table.core->where;
    return where.line > 0 && where.file == joint.where.file && where.line == joint.where.line && where.column == joint.where.column;
  });
  const auto check = [&](const char* field, bool is_same) {
    if (!is_given(field) || is_same) return;
    if (maker != tables.end())
      error("'" + std::string(field) + "' differs from that of core '" + maker->core->name + "', and both describe joint '" + joint.name +
                "': give both tables the same",
            field);
    else
      error("'" + std::string(field) + "' is for joints that this table adds; step_lap_joint '" + joint.name +
                "' exists already with another: set it there, and leave it out here",
            field);
  };
  check("mode", core_.mode == joint.mode);
  check("on_apart", core_.on_apart == joint.on_apart);
  check("least_margin", core_.least_margin == joint.least_margin);
  check("most_slide", core_.most_slide == joint.most_slide);
  // Two tables that make a joint together must agree. A declared joint has its own settings. Settings of the core that the joint lacks
  // would be ignored, so they are an error.
  const auto check_said = [&](const char* field, bool is_said, bool is_same) {
    if (maker != tables.end()) return check(field, is_same);
    if (is_given(field) && !is_said)
      error("'" + std::string(field) + "' is for joints that this table adds; step_lap_joint '" + joint.name +
                "' exists already and does not say its own: give it there, too",
            field);
  };
  check_said("tangential_stiffness", is_elastic(joint), core_.tangential_stiffness == joint.tangential_stiffness);
  check_said("contact_stiffness", is_elastic(joint), core_.contact_stiffness == joint.contact_stiffness);
  check_said("edge_stiffness", joint.edge_stiffness.has_value(), core_.edge_stiffness == joint.edge_stiffness);
  check_said("allowed_line_load", joint.allowed_line_load.has_value(), core_.allowed_line_load == joint.allowed_line_load);
  check_said("pressure_signal", !joint.pressure_signal.empty(), core_.pressure_signal == joint.pressure_signal);
  check_said("pressure_loss", joint.pressure_loss != 0.0 || core_.pressure_loss == 0.0, core_.pressure_loss == joint.pressure_loss);
  check_said("transverse_acceleration", !joint.transverse_acceleration.empty(), true); // several tables: check_other_tables
  if (maker != tables.end()) {
    check("shear_modulus", core_.shear_modulus == joint.shear_modulus);
    check("sheet_thickness", !joint.shear_modulus || core_.sheet_thickness == joint.sheet_thickness);
  }
}

// --- additions to the model ----------------------------------------------------------------------------

void CoreBuilder::add_joint(std::size_t i, const CoreGeometry& geometry) {
  if (!find_element(core_.joint_name(i))) {
    const auto joint = std::make_shared<StepLapJoint>();
    joint->name = core_.joint_name(i);
    joint->where = core_.where;
    joint->limb = limbs_[i];
    joint->active_part = core_.active_part;
    joint->mode = core_.mode;
    joint->on_apart = core_.on_apart;
    joint->least_margin = core_.least_margin.value_or(joint->least_margin);
    joint->most_slide = core_.most_slide.value_or(joint->most_slide);
    give_settings(*joint);
    model_.elements.push_back({&step_lap_joint_kind(), joint});
  }
  const double reach = std::abs(middle_of_limb(core_, limb(i), active_part()).x());
  find_parts(i, geometry);
  for (const CoreCorner& corner : geometry.corners(core_.is_middle(i), side_of_limb(core_, limb(i), active_part()), reach)) {
    for (const Lap& lap : corner.laps) add_interface(i, corner, lap, geometry);
    check_packets(i, corner, geometry);
  }
}

// Checks that overlaps remain after holes and edges of sheets are removed.
void CoreBuilder::check_packets(std::size_t i, const CoreCorner& corner, const CoreGeometry& geometry) {
  const Stack& stack = geometry.stack();
  if (core_.is_counted() || !problems_.empty()) return; // one error suffices
  for (std::size_t p = 0; p < stack.packets.size(); ++p) {
    if (!stack.is_by_place && likeness(stack, p) != p) continue;
    const auto holds = [&](const Lap& lap) { return !lap.is_between && geometry.packet_of(lap) == p && lap.area > 0.0; };
    if (std::none_of(corner.laps.begin(), corner.laps.end(), holds))
      return error("no two sheets of packet " + std::to_string(p + 1) + " overlap at " + corner.place + " of '" + limbs_[i] +
                       "': nothing would hold them there",
                   core_.packets.empty() ? "stack_depth" : "packets");
  }
}

// Computes the fraction of a limb's steel in each packet, if there are several: each packet must then be held separately.
void CoreBuilder::find_parts(std::size_t i, const CoreGeometry& geometry) {
  const double side = side_of_limb(core_, limb(i), active_part());
  part_shares_ = geometry.packet_shares(core_.is_middle(i), side);
  is_shared_ = cores_of(model_, limbs_[i]).size() > 1;
  if (!is_shared_) {
    if (std::count_if(part_shares_.begin(), part_shares_.end(), [](double share) { return share > 0.0; }) < 2) part_shares_.clear();
    return;
  }
  const std::optional<LimbSteel> steel = steel_of(model_, limbs_[i]);
  if (!steel) return part_shares_.clear(); // reported as a remark (plausible.cpp)
  const double of_table = geometry.limb_steel(core_.is_middle(i), side).mass / steel->mass;
  for (double& share : part_shares_) share *= of_table;
}

void CoreBuilder::give_settings(StepLapJoint& joint) const {
  joint.tangential_stiffness = core_.tangential_stiffness;
  joint.contact_stiffness = core_.contact_stiffness;
  joint.shear_modulus = core_.shear_modulus;
  if (core_.shear_modulus) joint.sheet_thickness = core_.sheet_thickness;
  joint.edge_stiffness = core_.edge_stiffness;
  joint.allowed_line_load = core_.allowed_line_load;
  const std::vector<CoreOfLimb> tables = cores_of(model_, joint.limb);
  if (core_.edge_stiffness &&
      std::all_of(tables.begin(), tables.end(), [&](const CoreOfLimb& t) { return is_sound(*t.core, model_) && !t.core->is_counted(); })) {
    joint.steel_thickness = 0.0;
    for (const CoreOfLimb& table : tables) {
      const Stack stack = stack_of(*table.core);
      *joint.steel_thickness += static_cast<double>(sheets_in(stack)) * stack.sheet_thickness;
    }
  }
  joint.pressure_signal = core_.pressure_signal;
  joint.pressure_loss = core_.pressure_loss;
  joint.transverse_acceleration = core_.transverse_acceleration;
}

void CoreBuilder::press(StepLapInterface& face, std::size_t i, const CoreCorner& corner, const Lap& lap, const CoreGeometry& geometry) {
  const LapPressure pressure = geometry.pressure(corner, lap, core_.joint_share(i, corner.is_top));
  face.pressure = pressure.middle;
  face.pressure_gradient = rotated(pressure.gradient, active_part().angle);
  face.transverse_pressure = pressure.transverse;
  face.transverse_spread = pressure.transverse_spread;
  if (pressure.least >= 0.0) return;
  face.pressure = core_.pressure; // errors of the pressure are reported here
  face.pressure_gradient = Vec2::Zero();
  if (!problems_.empty()) return; // one error suffices
  const std::string field = !corner.is_top && core_.bottom_pressure_gradient ? "bottom_pressure_gradient" : "pressure_gradient";
  const std::string level = !corner.is_top && core_.bottom_pressure ? "bottom_pressure" : "pressure";
  error("'" + field + "' is too steep for '" + level + "': at " + corner.place + " of '" + limbs_[i] + "' sheets would be pressed by " +
            number_text(std::round(pressure.least)) + " Pa",
        field);
}

void CoreBuilder::add_interface(std::size_t i, const CoreCorner& corner, const Lap& lap, const CoreGeometry& geometry) {
  const double turn = active_part().angle;
  const Vec2 middle = limb(i).position + rotated(middle_in_frame(core_, limb(i)), limb(i).angle);
  const auto placed = [&](const Ring& ring) {
    std::vector<Vec2> points;
    for (const Vec2& p : ring) points.emplace_back(middle + rotated(p, turn));
    return points;
  };
  const auto e = std::make_shared<StepLapInterface>();
  e->name = core_.name + ": " + core_.joint_name(i) + ", " + corner.place;
  if (!lap.name.empty()) e->name += (lap.name.front() == 'p' ? ", " : " ") + lap.name;
  e->where = core_.where;
  e->joint = core_.joint_name(i);
  e->limb = placed(lap.limb.outer);
  e->yoke = placed(lap.yoke.outer);
  for (const Ring& hole : lap.limb.holes) e->limb_cutouts.push_back(placed(hole));
  for (const Ring& hole : lap.yoke.holes) e->yoke_cutouts.push_back(placed(hole));
  if (!core_.has_strips()) e->across = rotated(corner.frame.across, turn);
  e->count = lap.count;
  e->clearance = core_.clearance;
  press(*e, i, corner, lap, geometry);
  e->static_friction = corner.is_top ? core_.static_friction : core_.bottom_static_friction.value_or(core_.static_friction);
  e->kinetic_friction = !corner.is_top && core_.bottom_kinetic_friction ? core_.bottom_kinetic_friction : core_.kinetic_friction;
  if (!part_shares_.empty()) {
    const std::size_t packet = geometry.packet_of(lap);
    e->part = (is_shared_ ? core_.name + ", packet " : "packet ") + std::to_string(packet + 1);
    e->part_share = part_shares_[packet];
  }
  refuse_repetition(*e);
  model_.elements.push_back({&step_lap_interface_kind(), e});
}

bool is_same_sheet(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  constexpr double k_same = 1e-9; // tolerance of positions, m
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](const Vec2& p, const Vec2& q) { return (p - q).norm() < k_same; });
}

// Adds an error if the same sheets are given twice at the same position, which would double the capacity.
void CoreBuilder::refuse_repetition(const StepLapInterface& face) {
  if (!problems_.empty()) return; // one error suffices
  const std::string own = core_.name + ": ";
  for (const StepLapInterface* other : elements_of<StepLapInterface>(std::as_const(model_))) {
    if (other->joint != face.joint || other->name.rfind(own, 0) == 0) continue;
    if (!is_same_sheet(other->limb, face.limb) || !is_same_sheet(other->yoke, face.yoke)) continue;
    return error("its sheets at joint '" + face.joint + "' are those of '" + other->name +
                 "' over again, and would count twice: a core of several packets is one table with 'packets'; "
                 "sheets of one width go into one packet, as a deeper stack or more 'interfaces'");
  }
}

// --- steel of the limbs -----------------------------------------------------------------------------------

// Returns "core 'a'", or "cores 'a' and 'b'".
std::string CoreBuilder::names_of_tables(const std::string& limb) const {
  const std::vector<CoreOfLimb> tables = cores_of(model_, limb);
  std::string names = tables.size() > 1 ? "cores " : "core ";
  for (std::size_t i = 0; i < tables.size(); ++i)
    names += (i == 0 ? "'" : i + 1 == tables.size() ? " and '" : ", '") + tables[i].core->name + "'";
  return names;
}

void CoreBuilder::check_steel(const Body& body, const char* field, double given, double steel, const std::string& unit) {
  if (given >= k_least_steel * steel && given <= k_most_steel * steel) return;
  problems_.push_back(
      {body.where, "'" + std::string(field) + "' of body '" + body.name + "', " + number_text(given) + " " + unit + ", contradicts " +
                       names_of_tables(body.name) + ", whose sheets make it " + number_text(std::round(steel)) + " " + unit +
                       " ('stack_depth' or 'packets', 'stacking_factor', 'density'): leave '" + field + "' out to take it from the core"});
}

void CoreBuilder::give_steel(std::size_t i) {
  Body* body = nullptr;
  for (Body& candidate : model_.bodies)
    if (candidate.name == limbs_[i]) body = &candidate;
  // The last of several tables gives the steel of all.
  if (core_.has_strips() || body->fixed || cores_of(model_, limbs_[i]).back().core->name != core_.name) return;
  const std::optional<LimbSteel> steel = steel_of(model_, limbs_[i]);
  if (!steel) return;
  if (steel->mass > 0.0) {
    if (body->mass == 0.0) body->mass = steel->mass;
    else check_steel(*body, "mass", body->mass, steel->mass, "kg");
    if (body->inertia == 0.0) body->inertia = steel->inertia * body->mass / steel->mass;
    else check_steel(*body, "inertia", body->inertia, steel->inertia, "kg m²");
  }
  if (core_.centre_of_gravity == "of_the_sheets" && body->cg == Vec2(Vec2::Zero()))
    body->cg = rotated(steel->centre, active_part().angle - body->angle);
}

// Checks the mass of the active part, which contains the yokes and more.
void CoreBuilder::check_yokes() {
  const Core* last = nullptr; // of several tables, the last one reports the error
  for (const Core* core : tables_of<Core>(std::as_const(model_)))
    if (core->active_part == core_.active_part) last = core;
  if (!problems_.empty() || (last && last->name != core_.name) || active_part().mass <= 0.0) return;
  const double steel = yoke_steel(model_, core_.active_part).value_or(0.0);
  if (active_part().mass < steel)
    problems_.push_back({active_part().where, "'mass' of body '" + core_.active_part + "', " + number_text(active_part().mass) +
                                                  " kg, is less than the yokes of core '" + core_.name + "' weigh alone, " +
                                                  number_text(std::round(steel)) + " kg"});
}

// --- outlines of bodies without one in the model ---------------------------------------------------------

// Returns the outline of the largest packet, counter-clockwise from the bottom, in the axes of the active part about the middle of the
// limb.
std::vector<Vec2> CoreBuilder::limb_corners(std::size_t i, const CoreGeometry& geometry) const {
  const bool is_middle = core_.is_middle(i);
  const Mitre mitre = geometry.mitre(geometry.largest(), is_middle);
  const double side = side_of_limb(core_, limb(i), active_part());
  std::vector<Vec2> corners;
  for (const double level : {-1.0, 1.0}) {
    std::vector<Vec2> end;
    if (is_middle) {
      const CornerFrame left = notch_frame(mitre, 1.0, level), right = notch_frame(mitre, -1.0, level);
      end = {left.origin, left.origin + left.length * left.along, right.origin};
    } else {
      const CornerFrame corner = corner_frame(mitre, side, level);
      end = {corner.origin, corner.origin + corner.length * corner.along};
    }
    // Corners from left to right at the bottom, back again at the top.
    std::sort(end.begin(), end.end(), [level](const Vec2& a, const Vec2& b) { return level * a.x() > level * b.x(); });
    corners.insert(corners.end(), end.begin(), end.end());
  }
  return corners;
}

// Sets the outlines of all limbs for which the model gives none.
void CoreBuilder::set_limb_outlines(const CoreGeometry& geometry) {
  const double turn = active_part().angle;
  for (std::size_t i = 0; i < limbs_.size(); ++i)
    for (Body& body : model_.bodies) {
      if (body.name != limbs_[i] || !body.outline.empty()) continue;
      for (const Vec2& p : limb_corners(i, geometry)) body.outline.push_back(middle_in_frame(core_, body) + rotated(p, turn - body.angle));
    }
}

// Sets the outline of the active part: the area between the outer limbs, with yokes and windings.
void CoreBuilder::set_active_part_outline(const CoreGeometry& geometry) {
  const Body* rear = nullptr;
  const Body* front = nullptr;
  std::vector<Vec2> at_rear, at_front;
  for (Body& part : model_.bodies) {
    if (part.name != core_.active_part || !part.outline.empty()) continue;
    for (std::size_t i = 0; i < core_.limbs.size(); ++i) {
      const Vec2 place = middle_of_limb(core_, limb(i), part);
      const bool is_front = place.x() > 0.0;
      (is_front ? front : rear) = &limb(i);
      std::vector<Vec2>& corners = is_front ? at_front : at_rear;
      corners = limb_corners(i, geometry);
      for (Vec2& p : corners) p += part.cg + place;
    }
    if (!rear || !front) return;
    // Corners of an outer limb: bottom left, bottom right, top right, top left.
    part.outline = {at_rear[0], at_front[1], at_front[0], at_front[3], at_front[2], at_rear[3], at_rear[2], at_rear[1]};
  }
}

} // namespace

void build_core(const Core& core, Model& model) { CoreBuilder(core, model).build(); }

Vec2 middle_of_limb(const Core& core, const Body& limb, const Body& active_part) {
  const Vec2 middle = limb.position + rotated(middle_in_frame(core, limb), limb.angle);
  return rotated(middle - active_part.reference_pose().head<2>(), -active_part.angle);
}

double side_of_limb(const Core& core, const Body& limb, const Body& active_part) {
  return middle_of_limb(core, limb, active_part).x() > 0.0 ? 1.0 : -1.0;
}

std::vector<LimbPlace> places_of_limbs(const Core& core, const Model& model) {
  std::vector<LimbPlace> places;
  const std::vector<std::string> names = core.all_limbs();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Body &limb = *model.find_body(names[i]), &part = *model.find_body(core.active_part);
    places.push_back({core.is_middle(i), side_of_limb(core, limb, part), middle_of_limb(core, limb, part).x()});
  }
  return places;
}

namespace {

// Returns true if both tables can describe the same yokes: equal numbers of sheets of equal heights.
bool has_equal_yokes(const Core& a, const Core& b) {
  const Stack one = stack_of(a), two = stack_of(b);
  const auto is_same = [](const Packet& p, const Packet& q) { return p.yoke_height == q.yoke_height && p.depth == q.depth; };
  return a.core_height == b.core_height && a.density == b.density && a.yoke_steps == b.yoke_steps &&
         one.sheet_thickness == two.sheet_thickness && one.stacking_factor == two.stacking_factor &&
         std::equal(one.packets.begin(), one.packets.end(), two.packets.begin(), two.packets.end(), is_same);
}

bool shares_limb(const Core& a, const Core& b) {
  for (const std::string& limb : a.all_limbs())
    for (const std::string& other : b.all_limbs())
      if (limb == other) return true;
  return false;
}

// Tables with the same pair of yokes, and the parts of the yokes that their limbs replace.
struct Yokes {
  struct Limb {
    LimbPlace place;
    const Core* core;
  };
  std::vector<const Core*> cores;
  std::vector<Limb> limbs;

  [[nodiscard]] std::optional<double> steel() const {
    if (limbs.empty()) return {};
    const auto is_before = [](const Limb& a, const Limb& b) { return a.place.x < b.place.x; };
    const auto [rear, front] = std::minmax_element(limbs.begin(), limbs.end(), is_before);
    if (rear->place.is_middle || front->place.is_middle || rear->place.side > 0.0 || front->place.side < 0.0) return {};
    double mass = CoreGeometry(*front->core).yoke_strip(front->place) + CoreGeometry(*rear->core).yoke_strip(rear->place);
    for (const Limb& limb : limbs) mass -= CoreGeometry(*limb.core).yoke_cut(limb.place);
    return mass;
  }
};

} // namespace

bool share_yokes(const Core& a, const Core& b) { return a.active_part == b.active_part && has_equal_yokes(a, b) && !shares_limb(a, b); }

std::optional<double> yoke_steel(const Model& model, const std::string& active_part) {
  std::vector<Yokes> all;
  for (const Core* core : tables_of<Core>(model)) {
    if (core->active_part != active_part) continue;
    const std::vector<std::string> names = core->all_limbs();
    const auto is_body = [&](const std::string& name) { return model.find_body(name) != nullptr; };
    if (!is_body(active_part) || !std::all_of(names.begin(), names.end(), is_body)) return {};
    if (core->is_counted() || !is_sound(*core, model)) return {};
    const auto is_own = [&](const Yokes& yokes) {
      return std::all_of(yokes.cores.begin(), yokes.cores.end(), [&](const Core* other) { return share_yokes(*other, *core); });
    };
    auto yokes = std::find_if(all.begin(), all.end(), is_own);
    if (yokes == all.end()) yokes = all.insert(all.end(), Yokes());
    yokes->cores.push_back(core);
    for (const LimbPlace& place : places_of_limbs(*core, model)) yokes->limbs.push_back({place, core});
  }
  if (all.empty()) return {};
  double mass = 0.0;
  for (const Yokes& yokes : all) {
    const std::optional<double> steel = yokes.steel();
    if (!steel) return {};
    mass += *steel;
  }
  return mass;
}

std::vector<CoreOfLimb> cores_of(const Model& model, const std::string& limb) {
  std::vector<CoreOfLimb> found;
  for (const Core* core : tables_of<Core>(model)) {
    const std::vector<std::string> limbs = core->all_limbs();
    if (const auto at = std::find(limbs.begin(), limbs.end(), limb); at != limbs.end())
      found.push_back({core, static_cast<std::size_t>(at - limbs.begin())});
  }
  return found;
}

std::optional<LimbSteel> steel_of(const Model& model, const std::string& limb) {
  const std::vector<CoreOfLimb> tables = cores_of(model, limb);
  LimbSteel all;
  for (const CoreOfLimb& table : tables) {
    if (tables.size() > 1 && (table.core->is_counted() || !is_sound(*table.core, model))) return {};
    const Body *body = model.find_body(limb), *part = model.find_body(table.core->active_part);
    if (!body || !part) return {};
    LimbSteel own;
    try {
      own = CoreGeometry(*table.core).limb_steel(table.core->is_middle(table.limb), side_of_limb(*table.core, *body, *part));
    } catch (const PolygonError&) {
      if (tables.size() == 1) throw;
      return {}; // reported by the table with the bolt hole
    }
    if (tables.size() == 1) return own;
    all.mass += own.mass;
    all.centre += own.mass * own.centre;
    all.inertia += own.inertia + own.mass * own.centre.squaredNorm();
  }
  if (!(all.mass > 0.0)) return {};
  all.centre /= all.mass;
  all.inertia -= all.mass * all.centre.squaredNorm();
  return all;
}

} // namespace steplap
