#include "mbd/run/edges.h"

#include "mbd/model/action.h"
#include "mbd/run/body_reach.h"
#include "mbd/run/quantity_text.h"
#include "mbd/run/range_index.h"
#include "mbd/system/contact_description.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace steplap {

namespace {

constexpr double k_at_end = 1e-9; // tolerance relative to the duration: the last step may end short of the end of the run
constexpr double k_beyond = 1e-3; // tolerance relative to the length of the outline along the face, for feet that stand on an edge

// Returns the finding for a contact that pressed `beyond` metres beyond the end of its part; nothing if this is within tolerance.
std::optional<Finding> beyond_edge(const LoadedModel& loaded, const EndlessFace& face, double beyond, const std::string& when) {
  if (beyond <= k_beyond * (face.high - face.low)) return std::nullopt;
  const ElementEntry& entry = loaded.model.elements[static_cast<std::size_t>(face.element)];
  return Finding{"foot_beyond_edge", FindingLevel::warning,
                 when + " '" + entry.element->name + "' presses " + quantity_text(beyond, "m", 1e-3) + " beyond the edge of '" + face.part +
                     "': the face of a " + entry.kind->name + " has no ends, the part has; " + face.remedy,
                 entry.element->where};
}

// Returns true if the contact does not act at the end although its parts overlap there: an action has let go of it, and what it lay on
// passes through. Its depth is then no penetration.
bool is_let_go(const Model& model, const RangeIndex& ranges, const std::string& contact) {
  const ChannelRange *const gap = ranges.find(contact + ".gap"), *const force = ranges.find(contact + ".force");
  if (!gap || !force || force->final != 0.0 || !(gap->final < 0.0)) return false;
  return std::any_of(model.elements.begin(), model.elements.end(), [&contact](const ElementEntry& entry) {
    const auto* const action = as_action(*entry.element);
    return action && std::any_of(action->steps.begin(), action->steps.end(), [&contact](const std::string& text) {
             const ActionStepText step = action_step(text);
             return step.name == contact && (step.verb == ActionVerb::release || step.verb == ActionVerb::hold);
           });
  });
}

// Returns the finding for a contact whose parts give no limit of its depth, for example on bare ground, and that was pressed `depth` metres
// deep, more than a fifth of the size of the smaller body that it carries. Such a depth is the stroke of a spring, or a wrong stiffness.
std::optional<Finding> sunk(const LoadedModel& loaded, const ElementEntry& entry, const ContactDescription& contact,
                            const ChannelRange& gap, const std::vector<double>& reaches) {
  constexpr double k_deep = 0.2; // share of the distance of the farthest point from the centre of gravity, or of the radius of gyration
  if (contact.is_preloaded || contact.has_ends) return std::nullopt; // a soft spring may be preloaded over a long way
  const Body* smaller = nullptr;
  double size = std::numeric_limits<double>::infinity();
  for (const std::string& marker : {contact.a, contact.b}) {
    const Body* const body = place_of(loaded.model, marker).body;
    if (!body || body->fixed || !(body->mass > 0.0)) continue;
    const double reach = reaches[static_cast<std::size_t>(body - loaded.model.bodies.data())];
    if (!(reach > 0.0)) continue; // a lumped mass, whose size the model does not tell
    const double own = std::max(reach, std::sqrt(body->inertia / body->mass));
    if (own >= size) continue;
    smaller = body;
    size = own;
  }
  if (!smaller || !(-gap.low.value > k_deep * size)) return std::nullopt;
  return Finding{"contact_sinks", FindingLevel::warning,
                 "'" + entry.element->name + "' was pressed " + quantity_text(-gap.low.value, "m", 1e-3) + " deep at t = " +
                     time_text(gap.low.t) + " s, and '" + smaller->name + "' reaches only " + quantity_text(size, "m", 1e-3) +
                     " from its centre of gravity: it sinks in. Check 'stiffness', force over depth; a bed that is as soft as this is a " +
                     "fixed body with an outline, which says how thick it is",
                 entry.element->where};
}

} // namespace

std::vector<Finding> contacts_too_deep(const LoadedModel& loaded, const std::vector<ChannelRange>& ranges) {
  const RangeIndex range_of(ranges);
  std::vector<Finding> found;
  std::vector<double> reaches; // of the model's bodies; computed if a contact needs them
  for (const ElementEntry& entry : loaded.model.elements) {
    const Element& element = *entry.element;
    const auto contact = contact_of(entry, loaded.model);
    const ChannelRange* const gap = contact ? range_of.find(element.name + ".gap") : nullptr;
    if (!gap || !(gap->low.value < 0.0) || is_let_go(loaded.model, range_of, element.name)) continue;
    if (!contact->depth_limit) {
      if (reaches.empty()) reaches = body_reaches(loaded.model);
      if (auto finding = sunk(loaded, entry, *contact, *gap, reaches)) found.push_back(std::move(*finding));
      continue;
    }
    const double most = *contact->depth_limit;
    if (!(-gap->low.value > most)) continue;
    found.push_back({"contact_too_deep", FindingLevel::warning,
                     "'" + element.name + "' was pressed " + quantity_text(-gap->low.value, "m", 1e-3) +
                         " deep at t = " + time_text(gap->low.t) + " s; beyond " + quantity_text(most, "m", 1e-3) +
                         " one part is through the other, and what came after is not to be trusted. A larger 'stiffness' keeps them apart",
                     element.where});
  }
  return found;
}

std::vector<Finding> contacts_beyond_edges(const LoadedModel& loaded, const State& state) {
  const System& system = *loaded.system;
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  std::vector<Finding> found;
  for (const EndlessFace& face : system.endless_faces) {
    if (!is_closed(system, state, system.element_names[static_cast<std::size_t>(face.element)])) continue;
    if (auto finding = beyond_edge(loaded, face, distance_beyond(face, place_on(face, motion.data()).along), "at rest"))
      found.push_back(std::move(*finding));
  }
  return found;
}

std::vector<Finding> contacts_beyond_edges(const LoadedModel& loaded, const RunResult& result) {
  std::map<int, const FaceTravel*> farthest; // largest travel by element, over all legs
  for (const FaceTravel& travel : result.face_travels) {
    const FaceTravel*& known = farthest[travel.face.element];
    if (!known || travel.beyond > known->beyond) known = &travel;
  }
  std::vector<Finding> found;
  for (const auto& [element, travel] : farthest) {
    const bool is_at_end = travel->t >= result.final_state.t * (1.0 - k_at_end);
    if (auto finding =
            beyond_edge(loaded, travel->face, travel->beyond, is_at_end ? "at the end" : "at t = " + time_text(travel->t) + " s"))
      found.push_back(std::move(*finding));
  }
  return found;
}

} // namespace steplap
