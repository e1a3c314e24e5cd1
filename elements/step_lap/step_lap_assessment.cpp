#include "elements/step_lap/step_lap_assessment.h"

#include "elements/step_lap/step_lap_interface.h"
#include "elements/step_lap/step_lap_joint.h"
#include "mbd/trust/element_judgement.h"
#include "mbd/trust/weighed_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();

double final_of(const RunResult& result, const std::string& name) {
  const ChannelRange* range = find_range(result, name);
  return range ? range->final : k_unknown;
}

void read_extremes(const RunResult& result, JointAssessment& a) {
  const auto extreme = [&](const char* channel, Extreme ChannelRange::*which) {
    const ChannelRange* range = find_range(result, a.joint + channel);
    return range ? range->*which : Extreme{};
  };
  const Extreme pressure = extreme(".p_req", &ChannelRange::high), margin = extreme(".margin", &ChannelRange::low);
  a.largest_required_pressure = pressure.value;
  a.time_of_largest = pressure.t;
  a.smallest_margin = margin.value;
  a.time_of_smallest = margin.t;
  a.least_pressure = extreme(".least_pressure", &ChannelRange::low);
  a.corner_margin = extreme(".corner_margin", &ChannelRange::low);
  a.part_margin = extreme(".part_margin", &ChannelRange::low);
  a.largest_demand = extreme(".demand", &ChannelRange::high).value;
  a.slid_share = extreme(".slid_share", &ChannelRange::high);
  a.overlap_left = extreme(".overlap_left", &ChannelRange::low);
  a.edge_share = extreme(".edge_share", &ChannelRange::high);
  a.edge_load = extreme(".edge_load", &ChannelRange::high);
  a.edge_pressure = extreme(".edge_pressure", &ChannelRange::high);
  a.clearance_left = extreme(".clearance_left", &ChannelRange::low);
  a.slid_x = final_of(result, a.joint + ".dx");
  a.slid_y = final_of(result, a.joint + ".dy");
  a.slid_angle = final_of(result, a.joint + ".theta_acc");
  a.area_lost = final_of(result, a.joint + ".area_lost");
  const ChannelRange* usage = find_range(result, a.joint + ".u");
  if (a.is_monitored && usage) a.first_slip = usage->first_above_one;
}

void read_events(const std::vector<Event>& events, JointAssessment& result) {
  for (const Event& event : events) {
    if (event.element != result.joint) continue;
    if (is_slip(event.kind)) {
      result.has_slipped = true;
      if (!result.first_slip) result.first_slip = event.t;
    }
    if (event.kind == EventKind::comes_apart) result.has_come_apart = true;
  }
}

// Change of the force on the limb, relative to its weight, above which it counts as a load. Smaller changes occur while the machine
// settles.
constexpr double k_least_load = 1e-3;

// Determines whether the joint was loaded beyond its load at rest.
void read_load(const RunResult& result, const Model& model, const StepLapJoint& joint, JointAssessment& a) {
  const Body* const limb = model.find_body(joint.limb);
  a.weight = limb ? limb->mass * model.header.gravity.norm() : 0.0;
  for (const char* const part : {".fx", ".fy"}) {
    const ChannelRange* const range = find_range(result, a.joint + part);
    if (range && range->high.value - range->low.value > k_least_load * a.weight) a.is_loaded = true;
  }
}

// Reads slips from the modes at the ends of steps and from the events, because a slip may appear in only one of them.
void read_modes(const RunResult& result, JointAssessment& a) {
  const ChannelRange* mode = find_range(result, a.joint + ".mode");
  const double slip = static_cast<double>(FrictionPhase::slip);
  if (!mode || !(mode->high.value >= slip)) return;
  a.has_slipped = true;
  if (!a.first_slip) a.first_slip = mode->high.t;
  if (mode->high.value > slip) a.has_come_apart = true;
}

// Returns true if the fields of the element refer to these two bodies, directly or by markers, and to no others.
bool acts_between(const ElementEntry& entry, const Model& model, const std::string& a, const std::string& b) {
  bool has_a = false, has_b = false;
  for (const Field& field : entry.kind->fields.fields()) {
    if (field.type != FieldType::body && field.type != FieldType::marker) continue;
    const FieldValue value = field.get(entry.element.get());
    const auto* name = std::get_if<std::string>(&value);
    if (!name || name->empty()) continue;
    const auto marker = std::find_if(model.markers.begin(), model.markers.end(), [&](const Marker& m) { return m.name == *name; });
    const std::string& body = field.type == FieldType::marker && marker != model.markers.end() ? marker->body : *name;
    if (body != a && body != b) return false;
    has_a = has_a || body == a;
    has_b = has_b || body == b;
  }
  return has_a && has_b;
}

std::vector<SharedLoad> shared_with(const StepLapJoint& joint, const Model& model, const RunResult& result) {
  std::vector<SharedLoad> shared;
  for (const ElementEntry& entry : model.elements) {
    if (entry.element->name == joint.name || !acts_between(entry, model, joint.limb, joint.active_part)) continue;
    const ChannelRange* force = find_range(result, entry.element->name + ".force");
    shared.push_back({entry.element->name, force ? std::max(std::abs(force->low.value), std::abs(force->high.value)) : k_unknown});
  }
  return shared;
}

JointVerdict verdict_of(const JointAssessment& a, bool has_interfaces) {
  if (!has_interfaces) return JointVerdict::not_assessed;
  if (a.has_come_apart) return JointVerdict::came_apart;
  if (a.has_parted()) return JointVerdict::corner_parted;
  if (a.is_unpressed()) return JointVerdict::unpressed;
  if (a.has_slid_too_far()) return JointVerdict::slid_too_far;
  if (a.has_crushed_edges()) return JointVerdict::crushed_edges;
  if (a.has_left_range()) return JointVerdict::closed_clearance;
  if (a.has_slipped) return JointVerdict::slipped;
  if (!a.is_known()) return JointVerdict::not_known;
  if (a.is_monitored && a.smallest_margin < 1.0) return JointVerdict::would_slip;
  if (a.has_weak_part()) return JointVerdict::weak_part;
  return a.smallest_margin < a.least_margin ? JointVerdict::little_reserve : JointVerdict::holds;
}

} // namespace

JointAssessment assess_joint(const StepLapJoint& joint, const Model& model, const RunResult& result) {
  JointAssessment a;
  a.joint = joint.name;
  a.is_monitored = joint.mode == "monitor";
  a.least_margin = joint.least_margin;
  a.has_edges = joint.edge_stiffness.has_value();
  a.most_slide = joint.most_slide;
  a.allowed_line_load = joint.allowed_line_load;
  a.shared_with = shared_with(joint, model, result);
  a.is_elastic = is_elastic(joint);
  read_extremes(result, a);
  read_events(result.events, a);
  read_modes(result, a);
  read_load(result, model, joint, a);
  const bool has_interfaces = std::any_of(model.elements.begin(), model.elements.end(), [&](const ElementEntry& other) {
    const auto* face = dynamic_cast<const StepLapInterface*>(other.element.get());
    return face && face->joint == joint.name;
  });
  a.verdict = verdict_of(a, has_interfaces);
  return a;
}

std::vector<JointAssessment> assess_joints(const Model& model, const RunResult& result) {
  std::vector<JointAssessment> assessments;
  for (const ElementEntry& entry : model.elements)
    if (const auto* joint = dynamic_cast<const StepLapJoint*>(entry.element.get()))
      assessments.push_back(assess_joint(*joint, model, result));
  return assessments;
}

} // namespace steplap
