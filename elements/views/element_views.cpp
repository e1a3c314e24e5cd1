#include "elements/views/element_views.h"

#include "elements/catalog.h"
#include "elements/joints.h"
#include "elements/limit.h"
#include "elements/load.h"
#include "elements/machinery/rope.h"
#include "elements/own_state.h"
#include "elements/pad.h"
#include "elements/shape.h"
#include "elements/spring_damper.h"
#include "elements/step_lap/step_lap_assessment.h"
#include "elements/step_lap/step_lap_interface.h"
#include "elements/step_lap/step_lap_joint.h"
#include "elements/unilateral_contact.h"
#include "elements/views/kind_checks.h"
#include "elements/views/symbols.h"
#include "mbd/base/shown_text.h"
#include "mbd/model/action.h"
#include "mbd/model/entries.h"

#include <algorithm>
#include <utility>

namespace steplap {

namespace {

std::vector<std::string> ends_of_joint(const Element& element) {
  const auto& joint = static_cast<const Joint&>(element);
  return {joint.a, joint.b};
}

std::vector<std::string> ends_of_spring(const Element& element) {
  const auto& spring = static_cast<const SpringDamper&>(element);
  return spring.axis ? std::vector<std::string>() : std::vector<std::string>{spring.a, spring.b};
}

std::vector<std::string> way_of_rope(const Element& element) {
  const auto& rope = static_cast<const Rope&>(element);
  std::vector<std::string> way{rope.a};
  way.insert(way.end(), rope.over.begin(), rope.over.end());
  way.push_back(rope.b);
  return way;
}

JointAssessment assess(const Element& element, const Model& model, const RunResult& result) {
  return assess_joint(static_cast<const StepLapJoint&>(element), model, result);
}

std::optional<DrawnSheets> sheets_of(const Element& element, const Model& model) {
  const auto& face = static_cast<const StepLapInterface&>(element);
  const StepLapJoint* joint = nullptr;
  for (const ElementEntry& entry : model.elements)
    if (entry.kind == &step_lap_joint_kind() && entry.element->name == face.joint)
      joint = static_cast<const StepLapJoint*>(entry.element.get());
  if (!joint) return std::nullopt;
  DrawnSheets sheets{joint->name, joint->limb, joint->active_part, face.frame == "ground", face.count, face.yoke, face.limb, {}, {}, {},
                     {},          {}};
  sheets.yoke_holes = face.yoke_holes;
  sheets.limb_holes = face.limb_holes;
  if (!face.yoke_holes.empty() || !face.limb_holes.empty()) sheets.hole = round_hole(Vec2::Zero(), face.hole_diameter, face.hole_sides);
  sheets.yoke_cutouts = face.yoke_cutouts;
  sheets.limb_cutouts = face.limb_cutouts;
  return sheets;
}

std::vector<Finding> unlike_shapes(const Model& model) {
  std::vector<Finding> findings;
  for (ShapeRemark& remark : contradicted_shapes(model))
    findings.push_back({"unlike_shape", FindingLevel::warning, std::move(remark.text), std::move(remark.where)});
  return findings;
}

// Notes a pad whose modulus no document states.
template <class T> void note_assumed_pads(const Model& model, std::vector<Finding>& findings) {
  for (const T* element : elements_of<T>(model)) {
    const PadMaterial* const material = pad_of(*element).known_material();
    if (!material || !material->is_assumed()) continue;
    findings.push_back({"assumed_pad", FindingLevel::note,
                        "'" + element->name + "': the modulus of '" + material->name + "', " + rounded_text(material->modulus * 1e-6) +
                            " MPa, is " + material->source + ". Give 'stiffness' where it is known, or vary it",
                        element->where});
  }
}

std::vector<Finding> assumed_pads(const Model& model) {
  std::vector<Finding> findings;
  note_assumed_pads<SpringDamper>(model, findings);
  note_assumed_pads<UnilateralContact>(model, findings);
  return findings;
}

// Returns true if an action gives the element a value.
bool is_set_by_action(const Model& model, const std::string& element) {
  return std::any_of(model.elements.begin(), model.elements.end(), [&element](const ElementEntry& entry) {
    const auto* const action = as_action(*entry.element);
    return action && std::any_of(action->steps.begin(), action->steps.end(), [&element](const std::string& text) {
             const ActionStepText step = action_step(text);
             return step.verb == ActionVerb::set && step.name == element;
           });
  });
}

// Finds loads to which nothing gives a value. A force of zero that the file states is intended, for example as one value of a study.
std::vector<Finding> loads_without_value(const Model& model) {
  std::vector<Finding> findings;
  for (const Load* const load : elements_of<Load>(model)) {
    const bool is_given = load->force || load->couple || !load->force_x.empty() || !load->force_y.empty() || !load->torque.empty();
    if (is_given || is_set_by_action(model, load->name)) continue;
    findings.push_back({"load_without_value", FindingLevel::warning,
                        "load '" + load->name + "' has no force, no couple and no signal, so that the run is judged without it. Give " +
                            "'force', 'couple', 'force_x', 'force_y' or 'torque'; force = [0, 0] says that none is meant",
                        load->where});
  }
  return findings;
}

} // namespace

KindViews element_views() {
  KindViews views;
  for (const ElementKind* const kind : element_catalog().elements) views.elements[kind].draw = symbol_of(kind->name);
  views.elements[&own_state_element_kind()].draw = symbol_of(own_state_element_kind().name);
  views.elements[&revolute_kind()].pulls_between = ends_of_joint;
  views.elements[&distance_kind()].pulls_between = ends_of_joint;
  views.elements[&spring_damper_kind()].pulls_between = ends_of_spring;
  views.elements[&rope_kind()].pulls_between = way_of_rope;
  views.elements[&unilateral_contact_kind()].check_contact = check_foot;
  views.elements[&limit_kind()].check_poses = check_stops;
  views.elements[&step_lap_joint_kind()].assess = assess;
  views.elements[&step_lap_interface_kind()].sheets = sheets_of;
  views.value_checks = {unlike_shapes, assumed_pads, loads_without_value};
  views.scene_checks = {doubled_corners};
  views.assembly_checks = {far_joints, stepped_feet};
  return views;
}

} // namespace steplap
