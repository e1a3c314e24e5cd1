#include "tools/steplap/warnings.h"

#include "mbd/freedom.h"
#include "mbd/signal_network.h"
#include "mbd/validate.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace steplap {

namespace {

using Names = std::unordered_set<std::string>;

// Names that fields of elements refer to, by what they refer to.
struct References {
  Names signals, markers, bodies;
};

References references_of(const Model& model) {
  References found;
  const auto use_signals = [&](const FieldTable& fields, const void* object) {
    for (const std::string& name : parts_of(fields, object)) found.signals.insert(name);
  };
  for (const SignalEntry& entry : model.signals) use_signals(entry.kind->fields, entry.definition.get());
  for (const ElementEntry& entry : model.elements) use_signals(entry.kind->fields, entry.element.get());
  for (const ElementEntry& entry : model.elements)
    for (const Field& field : entry.kind->fields.fields()) {
      Names* names = nullptr;
      if (field.type == FieldType::marker) names = &found.markers;
      if (field.type == FieldType::body) names = &found.bodies;
      if (names) names->insert(std::get<std::string>(field.get(entry.element.get())));
    }
  for (const Marker& marker : model.markers)
    if (found.markers.count(marker.name) > 0) found.bodies.insert(marker.body);
  return found;
}

std::string place(const Location& where) {
  return where.line > 0 ? " (line " + std::to_string(where.line) + ")" : "";
}

constexpr std::size_t k_most_names = 8;

// "'a' (force_x), 'b' and 'c'"
std::string list_of(const System& system, const std::vector<SharedReaction>& reactions) {
  std::string text;
  const std::size_t shown = std::min(reactions.size(), k_most_names);
  for (std::size_t i = 0; i < shown; ++i) {
    text += i == 0 ? "'" : i + 1 == reactions.size() ? " and '" : ", '";
    text += system.element_names[reactions[i].element] + "'";
    const char* before = " (";
    for (const std::string& quantity : reactions[i].quantities) {
      text += before + quantity;
      before = ", ";
    }
    if (!reactions[i].quantities.empty()) text += ")";
  }
  return shown < reactions.size()
             ? text + " and " + std::to_string(reactions.size() - shown) + " more"
             : text;
}

// Loads that constraints can share in more than one way.
void warn_of_shared_reactions(const System& system, std::vector<std::string>& warnings) {
  const Freedom freedom = count_freedom(system);
  if (!freedom.shared.empty())
    warnings.push_back(
        "the reactions of " + list_of(system, freedom.shared) +
        " are not unique: their constraints depend on each other, and how they share a load is not "
        "determined; the motion is. Reported is the sharing with the least forces");
  if (freedom.shared_sticking.size() > freedom.shared.size())
    warnings.push_back("while all friction sticks the reactions of " +
                       list_of(system, freedom.shared_sticking) +
                       " are not unique: they hold together as long as any way to share the load is "
                       "admissible. Reported is one of those ways, in proportion to the capacities where that will do");
}

} // namespace

std::vector<std::string> warnings_about(const LoadedModel& loaded) {
  const Model& model = loaded.model;
  const References used = references_of(model);
  std::vector<std::string> warnings;
  for (const SignalEntry& entry : model.signals)
    if (used.signals.count(entry.definition->name) == 0)
      warnings.push_back("signal '" + entry.definition->name + "'" +
                         place(entry.definition->where) + " is used by nothing");
  Names body_names;
  for (const Body& body : model.bodies)
    body_names.insert(body.name);
  for (const Marker& marker : model.markers) // a marker named as its body is the reader's own
    if (used.markers.count(marker.name) == 0 && body_names.count(marker.name) == 0 &&
        marker.name != "ground")
      warnings.push_back("marker '" + marker.name + "'" + place(marker.where) +
                         " is used by nothing");
  for (const Body& body : model.bodies)
    if (used.bodies.count(body.name) == 0)
      warnings.push_back("no element is attached to body '" + body.name + "'" + place(body.where));
  const SimulationSettings& s = model.simulation;
  if (s.step && !s.tolerance && !has_fixed_step(s.integrator))
    warnings.push_back("'step' of [simulation] is not used: '" + s.integrator +
                       "' chooses its steps by 'tolerance'; for steps of a fixed size choose \"rk4\"");
  warn_of_shared_reactions(*loaded.system, warnings);
  const Trajectory written(*loaded.system, model.output.channels);
  if (written.channels().empty())
    warnings.push_back(
        "no channel matches 'channels' of [output]: the trajectory will hold the time only");
  for (const std::string& name : loaded.plots_left_out)
    warnings.push_back("plot '" + name + "' is left out: not all of its channels are in 'channels' of [output]");
  return warnings;
}

} // namespace steplap
