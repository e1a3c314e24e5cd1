#include "transformer/core.h"

#include "elements/step_lap_interface.h"
#include "elements/step_lap_joint.h"
#include "mbd/math/portable_math.h"
#include "mbd/base/number_text.h"
#include "transformer/book.h"
#include "transformer/corner.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

// A mitre flatter or steeper against the yoke is none: limb and yoke would meet edge to edge.
constexpr double k_least_angle = 10.0 * std::numbers::pi / 180.0;
constexpr double k_largest_angle = 80.0 * std::numbers::pi / 180.0;
constexpr double k_usual_notch = 45.0 * std::numbers::pi / 180.0;

std::string metres(double value) { return number_text(value) + " m"; }

// One [[core]] on its way into a model; says all that is wrong with it at once.
class CoreBuilder {
public:
  CoreBuilder(const Core& core, Model& model) : core_(core), model_(model), limbs_(core.limbs) {
    limbs_.insert(limbs_.end(), core.middle_limbs.begin(), core.middle_limbs.end());
  }

  void build() {
    check_names();
    check_dimensions();
    check_friction();
    const std::vector<LapBand> bands = is_counted() ? counted_bands() : built_bands();
    if (problems_.empty()) check_reach(bands);
    if (!problems_.empty()) throw ModelError(std::move(problems_));
    for (std::size_t i = 0; i < limbs_.size(); ++i) add_joint(i, bands);
    if (!problems_.empty()) throw ModelError(std::move(problems_));
    draw_limbs();
    draw_active_part();
  }

private:
  // At the field that the message is about, if the table gives it.
  void error(const std::string& message, const std::string& field = "") {
    problems_.push_back({core_.place(field), "core '" + core_.name + "': " + message});
  }
  [[nodiscard]] const char* list_of(std::size_t limb) const { return is_middle(limb) ? "middle_limbs" : "limbs"; }
  [[nodiscard]] bool is_counted() const { return core_.overlap || core_.interfaces; }
  [[nodiscard]] std::string joint_name(std::size_t i) const {
    return core_.joints.empty() ? limbs_[i] + " joint" : core_.joints[i];
  }
  [[nodiscard]] bool is_middle(std::size_t i) const { return i >= core_.limbs.size(); }
  [[nodiscard]] double notch_angle() const { return core_.notch_angle.value_or(k_usual_notch); }
  [[nodiscard]] Book book() const;
  [[nodiscard]] const Element* find_element(const std::string& name) const;

  void check_names();
  void check_limb(std::size_t i, const Body& active_part);
  void check_joint(const std::string& name, const std::string& limb);
  void check_settings(const StepLapJoint& joint);
  [[nodiscard]] bool is_given(const std::string& field) const { return core_.places.count(field) > 0; }
  [[nodiscard]] bool has_clearance() const { return is_given("clearance") || core_.clearance > 0.0; }
  void check_dimensions();
  void check_angle(double angle, const std::string& what, const std::string& hint);
  void check_notch();
  void check_friction();
  std::vector<LapBand> counted_bands();
  std::vector<LapBand> built_bands();
  void check_reach(const std::vector<LapBand>& bands);
  void add_joint(std::size_t i, const std::vector<LapBand>& bands);
  void add_corner(std::size_t i, bool is_top, const CornerFrame& corner, const std::string& place,
                  const std::vector<LapBand>& bands);
  void add_interface(std::size_t i, bool is_top, const CornerFrame& corner, const std::string& name,
                     const LapBand& lap);
  void refuse_repetition(const StepLapInterface& face);

  [[nodiscard]] std::vector<Vec2> limb_corners(std::size_t i) const;
  void draw_limbs();
  void draw_active_part();

  const Core& core_;
  Model& model_;
  std::vector<std::string> limbs_; ///< outer ones, then middle ones
  std::vector<Diagnostic> problems_;
};

// --- what it refers to ------------------------------------------------------------------------------

const Element* CoreBuilder::find_element(const std::string& name) const {
  for (const ElementEntry& entry : model_.elements)
    if (entry.element->name == name) return entry.element.get();
  return nullptr;
}

// Place of the limb's centre of gravity in the active part's axes, from the active part's.
Vec2 reach(const Body& limb, const Body& active_part) {
  return rotated((limb.reference_pose() - active_part.reference_pose()).head<2>(), -active_part.angle);
}

void CoreBuilder::check_names() {
  const Body* active_part = model_.find_body(core_.active_part);
  if (!active_part) return error("'active_part' must be a body that moves, not 'ground'", "active_part");
  if (limbs_.empty()) error("'limbs' or 'middle_limbs' must name at least one body");
  for (std::size_t i = 0; i < limbs_.size(); ++i) {
    check_limb(i, *active_part);
    for (std::size_t j = 0; j < i; ++j)
      if (limbs_[j] == limbs_[i]) error("names limb '" + limbs_[i] + "' twice", list_of(i));
  }
  if (!core_.joints.empty() && core_.joints.size() != limbs_.size())
    return error("'joints' must name one joint for each of the " + std::to_string(limbs_.size()) +
                 " limbs, got " + std::to_string(core_.joints.size()), "joints");
  for (std::size_t i = 0; i < limbs_.size(); ++i) check_joint(joint_name(i), limbs_[i]);
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
  if (!is_middle(i) && std::abs(reach(*limb, active_part).x()) < 0.5 * core_.limb_width)
    error("limb '" + name + "' stands in the middle of the active part: only outer limbs, at least half a "
          "limb's width ahead of its centre of gravity or behind it, have mitred corners; name it in "
          "'middle_limbs'", "limbs");
}

void CoreBuilder::check_joint(const std::string& name, const std::string& limb) {
  if (name.empty()) return error("'joints': a joint needs a name", "joints");
  const Element* element = find_element(name);
  if (!element) return;
  const auto* joint = dynamic_cast<const StepLapJoint*>(element);
  if (!joint) return error("joint '" + name + "': the element of this name is no step_lap_joint", "joints");
  if (joint->limb != limb || joint->active_part != core_.active_part)
    error("step_lap_joint '" + name + "' holds '" + joint->limb + "' to '" + joint->active_part +
          "', not '" + limb + "' to '" + core_.active_part + "'", "joints");
  check_settings(*joint);
}

// What is given here for the joints must be what a joint declared elsewhere has.
void CoreBuilder::check_settings(const StepLapJoint& joint) {
  const auto check = [&](const char* field, bool is_same) {
    if (is_given(field) && !is_same)
      error("'" + std::string(field) + "' is for joints that this table adds; step_lap_joint '" + joint.name +
            "' exists already with another: set it there, and leave it out here", field);
  };
  check("mode", core_.mode == joint.mode);
  check("on_apart", core_.on_apart == joint.on_apart);
  check("least_margin", core_.least_margin == joint.least_margin);
  check("most_slide", core_.most_slide == joint.most_slide);
}

// --- dimensions ----------------------------------------------------------------------------------------

void CoreBuilder::check_dimensions() {
  if (2.0 * core_.yoke_height >= core_.core_height)
    error("two yokes of " + metres(core_.yoke_height) + " leave no window in a core of " +
          metres(core_.core_height) + ": 'core_height' is from the bottom of the lower yoke to the top of "
          "the upper", "core_height");
  if (!core_.limbs.empty())
    check_angle(
        core_.mitre_angle.value_or(portable::atan2(core_.yoke_height, core_.limb_width)), "mitre",
        core_.mitre_angle
            ? ""
            : "; it follows from 'yoke_height' and 'limb_width' unless 'mitre_angle' is given");
  if (!core_.middle_limbs.empty()) check_notch();
}

void CoreBuilder::check_angle(double angle, const std::string& what, const std::string& hint) {
  if (angle < k_least_angle || angle > k_largest_angle)
    error("a " + what + " at " + number_text(std::round(angle * 1800.0 / std::numbers::pi) / 10.0) +
          "° to the yoke: must be 10° to 80°" + hint);
}

void CoreBuilder::check_notch() {
  check_angle(notch_angle(), "notch", "");
  const auto [s, c] = portable::sin_cos(notch_angle());
  const double depth = 0.5 * core_.limb_width * s / c;
  if (depth > core_.yoke_height)
    error("the point of a middle limb, " + metres(depth) + " high, is higher than the yoke of " +
          metres(core_.yoke_height) + ": take a smaller 'notch_angle'", "notch_angle");
}

void CoreBuilder::check_friction() {
  const double bottom_static = core_.bottom_static_friction.value_or(core_.static_friction);
  if (core_.kinetic_friction.value_or(0.0) > core_.static_friction)
    error("'kinetic_friction' must not exceed 'static_friction'", "kinetic_friction");
  if (core_.bottom_kinetic_friction.value_or(0.0) > bottom_static)
    error("'bottom_kinetic_friction' must not exceed the static friction there, " + number_text(bottom_static),
          "bottom_kinetic_friction");
  if (core_.kinetic_friction && core_.bottom_static_friction && !core_.bottom_kinetic_friction)
    error("needs 'bottom_kinetic_friction' besides 'bottom_static_friction'", "bottom_static_friction");
}

std::vector<LapBand> CoreBuilder::counted_bands() {
  if (!core_.overlap || !core_.interfaces) {
    error(std::string("needs '") + (core_.overlap ? "interfaces" : "overlap") + "' besides '" +
          (core_.overlap ? "overlap" : "interfaces") + "'", core_.overlap ? "overlap" : "interfaces");
    return {};
  }
  if (core_.stack_depth || core_.sheet_thickness || core_.step_pitch || core_.steps || core_.bands != "mean")
    error("give either 'overlap' and 'interfaces', or how the stack is built ('stack_depth', "
          "'sheet_thickness', 'steps', 'step_pitch', 'bands'), not both", "overlap");
  return {{-0.5 * *core_.overlap, 0.5 * *core_.overlap, *core_.interfaces}};
}

Book CoreBuilder::book() const {
  Book b;
  b.stack_depth = *core_.stack_depth;
  b.stacking_factor = core_.stacking_factor;
  b.sheet_thickness = *core_.sheet_thickness;
  b.sheets_per_layer = core_.sheets_per_layer;
  b.steps = *core_.steps;
  b.step_pitch = *core_.step_pitch;
  b.clearance = core_.clearance;
  return b;
}

std::vector<LapBand> CoreBuilder::built_bands() {
  if (!core_.stack_depth || !core_.sheet_thickness || !core_.steps || !core_.step_pitch) {
    error("needs either 'overlap' and 'interfaces', or 'stack_depth', 'sheet_thickness', 'steps' and "
          "'step_pitch'");
    return {};
  }
  const Book b = book();
  if (b.clearance >= b.step_pitch)
    error("a clearance of " + metres(b.clearance) + " leaves no overlap at steps of " + metres(b.step_pitch), "clearance");
  if (interfaces_in(b) < b.steps)
    error("a stack of " + std::to_string(sheets_in(b)) + " sheets (" + metres(b.stack_depth) + " · " +
          number_text(b.stacking_factor) + " / " + metres(b.sheet_thickness) + ") holds no book of " +
          std::to_string(b.steps) + " layers of " + std::to_string(b.sheets_per_layer), "stack_depth");
  return core_.bands == "each" ? each_band(b) : mean_band(b);
}

void CoreBuilder::check_reach(const std::vector<LapBand>& bands) {
  for (const LapBand& b : bands)
    if (b.outer >= core_.tongue || -b.inner >= core_.tongue)
      return error("an overlap of " + metres(b.outer - b.inner) + " is wider than the sheets: 'tongue', " +
                   metres(core_.tongue) + " on either side of the middle of the mitre, must be more than " +
                   metres(b.outer), core_.overlap ? "overlap" : "step_pitch");
}

// --- into the model -----------------------------------------------------------------------------------

void CoreBuilder::add_joint(std::size_t i, const std::vector<LapBand>& bands) {
  if (!find_element(joint_name(i))) {
    const auto joint = std::make_shared<StepLapJoint>();
    joint->name = joint_name(i);
    joint->where = core_.where;
    joint->limb = limbs_[i];
    joint->active_part = core_.active_part;
    joint->mode = core_.mode;
    joint->on_apart = core_.on_apart;
    joint->least_margin = core_.least_margin.value_or(joint->least_margin);
    joint->most_slide = core_.most_slide.value_or(joint->most_slide);
    model_.elements.push_back({&step_lap_joint_kind(), joint});
  }
  const Mitre outer{core_.limb_width, core_.core_height, core_.yoke_height, core_.mitre_angle};
  const Mitre notch{core_.limb_width, core_.core_height, core_.yoke_height, notch_angle()};
  const Body &limb = *model_.find_body(limbs_[i]), &part = *model_.find_body(core_.active_part);
  const double side = reach(limb, part).x() > 0.0 ? 1.0 : -1.0;
  for (const bool is_top : {true, false}) {
    const double level = is_top ? 1.0 : -1.0;
    const std::string place = is_top ? ", top" : ", bottom";
    if (!is_middle(i)) {
      add_corner(i, is_top, corner_frame(outer, side, level), place, bands);
      continue;
    }
    add_corner(i, is_top, notch_frame(notch, -1.0, level), place + " front", bands);
    add_corner(i, is_top, notch_frame(notch, 1.0, level), place + " rear", bands);
  }
}

void CoreBuilder::add_corner(std::size_t i, bool is_top, const CornerFrame& corner, const std::string& place,
                             const std::vector<LapBand>& bands) {
  for (std::size_t k = 0; k < bands.size(); ++k)
    add_interface(i, is_top, corner,
                  core_.name + ": " + joint_name(i) + place + (bands.size() > 1 ? " " + std::to_string(k + 1) : ""),
                  bands[k]);
}

void CoreBuilder::add_interface(std::size_t i, bool is_top, const CornerFrame& corner, const std::string& name,
                                const LapBand& lap) {
  const Body &limb = *model_.find_body(limbs_[i]), &part = *model_.find_body(core_.active_part);
  const auto e = std::make_shared<StepLapInterface>();
  e->name = name;
  e->where = core_.where;
  e->joint = joint_name(i);
  e->limb = band(corner, 0.0, corner.length, lap.inner, core_.tongue);
  e->yoke = band(corner, -core_.margin, corner.length + core_.margin, -core_.tongue, lap.outer);
  const Vec2 centre = limb.reference_pose().head<2>();
  for (std::vector<Vec2>* sheet : {&e->limb, &e->yoke})
    for (Vec2& point : *sheet) point = centre + rotated(point, part.angle);
  e->count = lap.count;
  if (has_clearance()) e->clearance = core_.clearance;
  e->pressure = is_top ? core_.pressure : core_.bottom_pressure.value_or(core_.pressure);
  e->static_friction = is_top ? core_.static_friction : core_.bottom_static_friction.value_or(core_.static_friction);
  e->kinetic_friction = !is_top && core_.bottom_kinetic_friction ? core_.bottom_kinetic_friction
                                                                 : core_.kinetic_friction;
  refuse_repetition(*e);
  model_.elements.push_back({&step_lap_interface_kind(), e});
}

bool is_same_sheet(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  constexpr double k_same = 1e-9; // m
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](const Vec2& p, const Vec2& q) { return (p - q).norm() < k_same; });
}

// The same sheets at the same place twice would bear twice as much.
void CoreBuilder::refuse_repetition(const StepLapInterface& face) {
  if (!problems_.empty()) return; // once is enough
  for (const ElementEntry& entry : model_.elements) {
    const auto* other = dynamic_cast<const StepLapInterface*>(entry.element.get());
    if (!other || other->joint != face.joint || !is_same_sheet(other->limb, face.limb) || !is_same_sheet(other->yoke, face.yoke))
      continue;
    return error("its sheets at joint '" + face.joint + "' are those of '" + other->name +
                 "' over again, and would count twice: a core of several packets has one table for each width of sheet; "
                 "sheets of one width go into one table, as a deeper stack or more 'interfaces'");
  }
}

// --- outlines, for bodies whose model gives none ---------------------------------------------------------

// Counter-clockwise from the bottom, in the active part's axes about the limb's centre.
std::vector<Vec2> CoreBuilder::limb_corners(std::size_t i) const {
  const Mitre outer{core_.limb_width, core_.core_height, core_.yoke_height, core_.mitre_angle};
  const Mitre notch{core_.limb_width, core_.core_height, core_.yoke_height, notch_angle()};
  const double side = reach(*model_.find_body(limbs_[i]), *model_.find_body(core_.active_part)).x() > 0.0 ? 1.0 : -1.0;
  std::vector<Vec2> corners;
  for (const double level : {-1.0, 1.0}) {
    std::vector<Vec2> end;
    if (is_middle(i)) {
      const CornerFrame left = notch_frame(notch, 1.0, level), right = notch_frame(notch, -1.0, level);
      end = {left.origin, left.origin + left.length * left.along, right.origin};
    } else {
      const CornerFrame corner = corner_frame(outer, side, level);
      end = {corner.origin, corner.origin + corner.length * corner.along};
    }
    // From left to right at the bottom, back again at the top.
    std::sort(end.begin(), end.end(), [level](const Vec2& a, const Vec2& b) { return level * a.x() > level * b.x(); });
    corners.insert(corners.end(), end.begin(), end.end());
  }
  return corners;
}

void CoreBuilder::draw_limbs() {
  const Body& part = *model_.find_body(core_.active_part);
  for (std::size_t i = 0; i < limbs_.size(); ++i)
    for (Body& body : model_.bodies) {
      if (body.name != limbs_[i] || !body.outline.empty()) continue;
      for (const Vec2& p : limb_corners(i))
        body.outline.push_back(body.cg + rotated(p, part.angle - body.angle));
    }
}

// What lies between the outer limbs: yokes, windings and all.
void CoreBuilder::draw_active_part() {
  const Body* rear = nullptr;
  const Body* front = nullptr;
  std::vector<Vec2> at_rear, at_front;
  for (Body& part : model_.bodies) {
    if (part.name != core_.active_part || !part.outline.empty()) continue;
    for (std::size_t i = 0; i < core_.limbs.size(); ++i) {
      const Body* limb = model_.find_body(limbs_[i]);
      const Vec2 place = reach(*limb, part);
      const bool is_front = place.x() > 0.0;
      (is_front ? front : rear) = limb;
      std::vector<Vec2>& corners = is_front ? at_front : at_rear;
      corners = limb_corners(i);
      for (Vec2& p : corners) p += part.cg + place;
    }
    if (!rear || !front) return;
    // Corners of an outer limb: bottom left, bottom right, top right, top left.
    part.outline = {at_rear[0], at_front[1], at_front[0], at_front[3], at_front[2], at_rear[3], at_rear[2], at_rear[1]};
  }
}

void add_dimensions(FieldTable& f) {
  using T = Core;
  f.add("active_part", &T::active_part).as(FieldType::body).required().doc("the body with the yokes");
  f.add("limbs", &T::limbs).doc("bodies of the outer limbs, mitred to the yokes");
  f.add("middle_limbs", &T::middle_limbs).doc("bodies of the limbs between, which end in a point (T-joint)");
  f.add("joints", &T::joints)
      .doc("names of the joints, one for each limb, middle ones last; default '<limb> joint'. A step_lap_joint of that name "
           "is used as it stands, else one is added");
  f.add("limb_width", &T::limb_width).in("m").positive().required().doc("width of a limb's sheets");
  f.add("core_height", &T::core_height).in("m").positive().required().doc("over both yokes; its middle is "
                                                                          "at the limb's centre of gravity");
  f.add("yoke_height", &T::yoke_height).in("m").positive().required().doc("of one yoke");
  f.add("mitre_angle", &T::mitre_angle).in("rad").doc("against the yoke; default: from corner to corner");
  f.add("notch_angle", &T::notch_angle).in("rad").doc("of a middle limb's point against the yoke; default: 45°");
  f.add("tongue", &T::tongue).in("m").positive().doc("length of sheet on either side of the middle of the mitre");
  f.add("margin", &T::margin).in("m").not_negative().doc("of the yoke's sheet beyond the limb's at either end "
                                                         "of the mitre");
}

void add_stack(FieldTable& f) {
  using T = Core;
  f.add("overlap", &T::overlap).in("m").positive().doc("of one interface, across the mitre");
  f.add("interfaces", &T::interfaces).positive().doc("that carry an overlap, number at a corner");
  f.add("stack_depth", &T::stack_depth).in("m").positive().doc("of steel and insulation");
  f.add("sheet_thickness", &T::sheet_thickness).in("m").positive().doc("of the steel");
  f.add("stacking_factor", &T::stacking_factor).positive().at_most(1.0).doc("steel's share of the stack");
  f.add("sheets_per_layer", &T::sheets_per_layer).at_least(1).doc("equal sheets one on the other");
  f.add("steps", &T::steps).at_least(2).at_most(100).doc("layers in a book");
  f.add("step_pitch", &T::step_pitch).in("m").positive().doc("from layer to layer, across the mitre");
  f.add("clearance", &T::clearance).in("m").not_negative().doc("between the sheets of one layer, across the "
                                                               "mitre; given, a run says whether a limb closes it");
  f.add("bands", &T::bands)
      .one_of({"mean", "each"})
      .doc("mean: all interfaces of a corner have the mean overlap; each: every overlap of a book where it is");
}

void add_friction(FieldTable& f) {
  using T = Core;
  f.add("pressure", &T::pressure).in("Pa").positive().required().doc("clamping pressure, constant");
  f.add("static_friction", &T::static_friction).positive().required().doc("mu_s");
  f.add("kinetic_friction", &T::kinetic_friction).positive().doc("mu_k; default: mu_s");
  f.add("bottom_pressure", &T::bottom_pressure).in("Pa").positive().doc("at the bottom corners, if different");
  f.add("bottom_static_friction", &T::bottom_static_friction).positive().doc("at the bottom corners, if "
                                                                             "different");
  f.add("bottom_kinetic_friction", &T::bottom_kinetic_friction).positive().doc("at the bottom corners, if "
                                                                               "different");
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
            "and bottom corner (outer limbs) or of both sides of its points (middle limbs). The overlaps are given by 'overlap' and 'interfaces', or by how the "
            "stack is built.";
    add_dimensions(k.fields);
    add_stack(k.fields);
    add_friction(k.fields);
    k.holds<Core>();
    k.reads_masses = k.reads_elements = false; // of elements names, and outlines of sheets
    k.apply = [](const Element& table, Model& model) {
      CoreBuilder(static_cast<const Core&>(table), model).build();
    };
    return k;
  }();
  return kind;
}

} // namespace steplap
