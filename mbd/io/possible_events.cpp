#include "mbd/io/possible_events.h"

#include "mbd/base/diagnostics.h"
#include "mbd/base/name_pattern.h"
#include "mbd/model/action.h"

#include <algorithm>
#include <unordered_set>
#include <vector>

namespace steplap {

namespace {

void add(EventKinds& kinds, EventKind kind) { kinds.set(static_cast<std::size_t>(kind)); }

// Adds the events of all possible changes of mode in a group. Modes are bit sets, of which element kinds use at most the lowest six bits.
void add_transitions(const ForceGroup& group, EventKinds& kinds) {
  constexpr UnitMode k_modes = 64;
  for (UnitMode from = 0; from < k_modes; ++from)
    for (UnitMode to = 0; to < k_modes; ++to)
      if (from != to) add(kinds, group.event_kind(from, to));
}

void add_friction(const FrictionElement& friction, EventKinds& kinds) {
  FrictionState here, there;
  there.foot = 1;
  for (const EventKind kind : {EventKind::sticks, EventKind::loses_normal_force, friction.contact_switch_event(here, there),
                               friction.contact_switch_event(there, here)})
    add(kinds, kind);
  if (friction.dimension() == 3)
    for (const EventKind kind : {EventKind::slips, EventKind::changes_slip_direction, EventKind::comes_apart}) add(kinds, kind);
  else
    for (const EventKind kind : {EventKind::slips_forward, EventKind::slips_backward}) add(kinds, kind);
}

EventKinds events_of(const System& system, const std::string& element) {
  EventKinds kinds;
  const auto matches = [&](int index) { return matches_pattern(system.element_names[static_cast<std::size_t>(index)], element); };
  std::unordered_set<const ForceGroup*> known;
  for (const Unit& unit : system.units)
    if (matches(unit.element) && known.insert(unit.group).second) add_transitions(*unit.group, kinds);
  for (const FrictionUnit& unit : system.frictions)
    if (matches(unit.element)) add_friction(*unit.friction, kinds);
  return kinds;
}

std::vector<std::string> words_of(const EventKinds& kinds) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (kinds.test(i)) words.emplace_back(words_of(static_cast<EventKind>(i)));
  std::sort(words.begin(), words.end());
  return words;
}

std::string list_of(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "'" : ", '") + word + "'";
  return text;
}

} // namespace

EventKinds possible_events(const Model& model, const System& system, const std::string& element) {
  EventKinds kinds = events_of(system, element);
  Model all = model;
  bool is_any_asleep = false;
  for (ElementEntry& entry : all.elements) {
    if (!matches_pattern(entry.element->name, element)) continue;
    if (as_action(*entry.element)) add(kinds, EventKind::happens);
    if (entry.element->active) continue;
    entry.element->active = true;
    is_any_asleep = true;
  }
  if (is_any_asleep) {
    try {
      const std::vector<std::string> no_channels;
      kinds |= events_of(*compile(all, &no_channels), element);
    } catch (const ModelError&) { // the elements cannot be active at the same time, so any event is taken as possible
      kinds.set();
    }
  }
  kinds.reset(static_cast<std::size_t>(EventKind::none));
  return kinds;
}

std::string why_no_event(const Model& model, const System& system, const std::string& element, const std::string& event) {
  const EventKinds kinds = possible_events(model, system, element.empty() ? "*" : element);
  if ((kinds & event_kinds_matching(event)).any()) return "";
  const std::vector<std::string> words = words_of(kinds);
  const std::string whose = element.empty() ? "of the model" : "of '" + element + "'";
  if (words.empty()) return "nothing " + whose + " has events";
  return "no event " + whose + " is called '" + event + "'" + did_you_mean(event, words) + "; there are " + list_of(words);
}

} // namespace steplap
