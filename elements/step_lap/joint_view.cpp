#include "elements/step_lap/joint_view.h"

#include <algorithm>
#include <array>
#include <limits>

namespace steplap {

namespace {

// Returns the bodies of the element's markers.
std::vector<std::string> bodies_of(const ElementEntry& entry, const Model& model) {
  std::vector<std::string> bodies;
  for (const Field& field : entry.kind->fields.fields()) {
    if (field.type != FieldType::marker) continue;
    const auto name = std::get<std::string>(field.get(entry.element.get()));
    const auto marker = std::find_if(model.markers.begin(), model.markers.end(), [&](const Marker& m) { return m.name == name; });
    bodies.push_back(marker == model.markers.end() ? name : marker->body);
  }
  return bodies;
}

std::vector<std::string> beside(const StepLapJoint& joint, const Model& model) {
  static const std::array<const char*, 4> springs = {"tie", "spring_damper", "rotational_spring_damper", "bushing"};
  std::vector<std::string> found;
  for (const ElementEntry& entry : model.elements) {
    if (std::find(springs.begin(), springs.end(), entry.kind->name) == springs.end()) continue;
    const std::vector<std::string> bodies = bodies_of(entry, model);
    const auto joins = [&](const std::string& body) { return std::find(bodies.begin(), bodies.end(), body) != bodies.end(); };
    if (joins(joint.limb) && joins(joint.active_part)) found.push_back("'" + entry.element->name + "' (" + entry.kind->name + ")");
  }
  return found;
}

// Returns a wrench or twist in axes that are turned by −angle.
Vec3 turned(const Vec3& w, double angle) {
  const Vec2 plane = rotated(w.head<2>(), angle);
  return {plane.x(), plane.y(), w[2]};
}

JointView look_at(const StepLapJoint& joint, const StepLapFriction& friction, const Model& model, const System& system) {
  JointView view;
  view.joint = &joint;
  view.friction = &friction;
  for (const ElementEntry& entry : model.elements)
    if (const auto* e = dynamic_cast<const StepLapInterface*>(entry.element.get()); e && e->joint == joint.name)
      view.interfaces.push_back(e);
  view.beside = beside(joint, model);
  const State state = system.initial_state();
  std::vector<Motion<double>> motion(static_cast<std::size_t>(system.body_count()));
  place_bodies(state.q, state.v, motion);
  const Pose pose = friction.pose_of(motion.data());
  view.patch = friction.patch_at(pose, GripLaw::holding);
  view.pressure_factor = friction.pressure_at(0.0).factor;
  OverlapWorkspace workspace;
  Region region;
  for (const SheetPair& sheets : friction.sheets()) {
    intersect(sheets.yoke, sheets.limb, pose, workspace, region);
    view.areas.push_back(area(region));
  }
  return view;
}

} // namespace

double JointView::sliding(int direction) const { // support function h of the unit twist in this direction
  if (interfaces.empty()) return std::numeric_limits<double>::infinity();
  return pressure_factor * evaluate_gradient(patch, turned(Vec3::Unit(direction), friction->part_frame.theta)).h;
}

double JointView::alone(int direction) const { // largest wrench in this direction that the limit surface contains
  if (interfaces.empty()) return std::numeric_limits<double>::infinity();
  return pressure_factor / required_pressure(patch, turned(Vec3::Unit(direction), friction->part_frame.theta)).u;
}

RequiredPressure JointView::required(const Vec3& wrench) const {
  if (interfaces.empty()) return {};
  RequiredPressure found = required_pressure(patch, turned(wrench, friction->part_frame.theta) / pressure_factor);
  if (!found.converged)
    throw NumericalFailure("the required pressure of '" + joint->name +
                           "' was not found to the last digit; the wrench may be out of all proportion");
  found.direction = turned(found.direction, -friction->part_frame.theta);
  if (found.centre) found.centre = friction->in_part(*found.centre);
  return found;
}

std::vector<JointView> joint_views(const Model& model, const System& system) {
  std::vector<JointView> views;
  for (const FrictionUnit& unit : system.frictions) {
    const auto* friction = dynamic_cast<const StepLapFriction*>(unit.friction.get());
    if (!friction) continue;
    for (const ElementEntry& entry : model.elements)
      if (entry.kind == &step_lap_joint_kind() && entry.element->name == system.element_names[static_cast<std::size_t>(unit.element)])
        views.push_back(look_at(static_cast<const StepLapJoint&>(*entry.element), *friction, model, system));
  }
  return views;
}

} // namespace steplap
