#include "mbd/run/action_findings.h"

#include "mbd/base/shown_text.h"
#include "mbd/model/action.h"
#include "mbd/system/actions.h"

#include <algorithm>
#include <string>
#include <unordered_set>

namespace steplap {

namespace {

// Returns the names after one verb in all steps of `group`, or of all actions if it is null: NAME in "hold NAME", "arm NAME".
std::unordered_set<std::string> names_after(const ActionGroup* group, const Model& model, ActionVerb verb) {
  std::unordered_set<std::string> names;
  if (!group) return names;
  for (const ActionGroup::ElementData& entry : group->entries)
    for (const ActionStep& step : entry.steps)
      if (step.verb == verb)
        names.insert(verb == ActionVerb::arm ? group->entries[static_cast<std::size_t>(step.target)].name
                                             : model.elements[static_cast<std::size_t>(step.target)].element->name);
  return names;
}

const Location& place_of(const Model& model, const std::string& name) {
  static const Location k_nowhere;
  for (const ElementEntry& entry : model.elements)
    if (entry.element->name == name) return entry.element->where;
  return k_nowhere;
}

} // namespace

std::vector<Finding> idle_actions(const LoadedModel& loaded) {
  const Model& model = loaded.model;
  const ActionGroup* const group = action_group(*loaded.system);
  const auto held = names_after(group, model, ActionVerb::hold), armed = names_after(group, model, ActionVerb::arm);
  std::vector<Finding> findings;
  for (const ElementEntry& entry : model.elements)
    if (!entry.element->active && !held.contains(entry.element->name))
      findings.push_back(
          {"never_acts", FindingLevel::warning,
           entry.kind->name + " '" + entry.element->name + "' does not act from the start, and no [[action]] holds it: it has no effect",
           entry.element->where});
  if (!group) return findings;
  for (const ActionGroup::ElementData& entry : group->entries) {
    const Location& where = place_of(model, entry.name);
    if (!entry.is_armed && !armed.contains(entry.name))
      findings.push_back({"never_armed", FindingLevel::warning,
                          "action '" + entry.name + "' is not armed at the start, and no other action arms it: it never happens", where});
    if (entry.trigger.time && *entry.trigger.time >= model.simulation.end)
      findings.push_back({"late_action", FindingLevel::warning,
                          "action '" + entry.name + "' is due at " + rounded_text(*entry.trigger.time) + " s, and the run ends at " +
                              rounded_text(model.simulation.end) + " s: it does not happen",
                          where});
  }
  return findings;
}

std::vector<Finding> actions_that_wait(const LoadedModel& loaded, const RunResult& result) {
  const ActionGroup* const group = action_group(*loaded.system);
  if (!group) return {};
  std::unordered_set<std::string> happened;
  for (const Event& event : result.events)
    if (event.kind == EventKind::happens) happened.insert(std::string(event.element));
  std::string names;
  std::size_t count = 0;
  for (const ActionGroup::ElementData& entry : group->entries) {
    if (happened.contains(entry.name)) continue;
    names += (count++ == 0 ? "'" : ", '") + entry.name + "'";
  }
  if (count == 0) return {};
  return {{"action_waits",
           FindingLevel::note,
           count == 1 ? "action " + names + " has not happened" : std::to_string(count) + " actions have not happened: " + names,
           {}}};
}

} // namespace steplap
