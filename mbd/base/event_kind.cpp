#include "mbd/base/event_kind.h"

#include "mbd/base/name_pattern.h"

#include <array>

namespace steplap {

namespace {

struct EventKindText {
  EventKind kind;
  const char* words;
  const char* doc;
};

constexpr std::array<EventKindText, k_event_kinds> k_table{{
    {EventKind::none, "", "no event"},
    {EventKind::opens, "opens", "a contact lifts off"},
    {EventKind::closes, "closes", "a contact touches down"},
    {EventKind::force_reaches_zero, "force reaches zero", "a contact that is still closed presses no more"},
    {EventKind::force_returns, "force returns", "a contact that had stayed closed presses again"},
    {EventKind::reaches_lower_stop, "reaches its lower stop", "a coordinate arrives at its lower limit"},
    {EventKind::reaches_upper_stop, "reaches its upper stop", "a coordinate arrives at its upper limit"},
    {EventKind::leaves_stop, "leaves its stop", "a coordinate is between its limits again"},
    {EventKind::enters_gap, "enters its gap", "a spring with a gap acts no more, a rope goes slack"},
    {EventKind::closes_gap, "closes its gap",
     "a spring with a gap begins to act, a rope becomes taut; of an inextensible one with the impulse of the blow and the energy lost"},
    {EventKind::passes_kink, "passes a kink",
     "a tabulated spring or damper passes to the next line of its table; a formula of a force or a state passes to its next smooth "
     "piece; one end of a line of sheet edges begins or ceases to press"},
    {EventKind::slips, "slips", "a step-lap joint slides; at the start of a run if it slides from there"},
    {EventKind::slips_forward, "slips forward",
     "friction along a line slides to its positive side; at the start of a run if it slides from there"},
    {EventKind::slips_backward, "slips backward", "the same to its negative side"},
    {EventKind::changes_slip_direction, "slips another way", "a joint that slides begins to slide in a new direction without having held"},
    {EventKind::sticks, "sticks", "friction holds"},
    {EventKind::loses_normal_force, "loses its normal force", "nothing presses any more: friction neither holds nor drags"},
    {EventKind::changes_foot, "changes foot", "friction acts at another of its contacts"},
    {EventKind::loses_interface, "loses an interface", "the sheets of a step-lap interface have parted"},
    {EventKind::meets_interface, "meets at an interface again", "the sheets of a step-lap interface overlap again"},
    {EventKind::storm, "changes too often to be followed: time stepping",
     "events crowd: time stepping goes over the interval that follows"},
    {EventKind::event_storm_ends, "is followed event by event again", "the end of such an interval"},
    {EventKind::happens, "happens", "an action of the model is executed, with its effects"},
    {EventKind::breaks, "breaks", "a tie's force has reached its strength: it carries no load from then on"},
    {EventKind::comes_apart, "comes apart", "a step-lap joint has no overlap left: no friction for good"},
}};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < k_table.size(); ++i)
    if (k_table[i].kind != static_cast<EventKind>(i)) return false;
  return true;
}
static_assert(is_in_order(), "the table has a line for each kind, in their order");

const EventKindText& entry_of(EventKind kind) { return k_table[static_cast<std::size_t>(kind)]; }

} // namespace

const char* words_of(EventKind kind) { return entry_of(kind).words; }

const char* doc_of(EventKind kind) { return entry_of(kind).doc; }

std::optional<EventKind> event_kind_called(std::string_view words) {
  for (const EventKindText& entry : k_table)
    if (entry.kind != EventKind::none && words == entry.words) return entry.kind;
  return {};
}

std::optional<EventKind> event_kind_of_entry(std::string_view text) {
  for (;;) {
    if (const auto kind = event_kind_called(text)) return kind;
    const std::size_t end = text.rfind(' ');
    if (end == std::string_view::npos) return {};
    text = text.substr(0, end);
  }
}

EventKinds event_kinds_matching(const std::string& pattern) {
  EventKinds kinds;
  for (const EventKindText& entry : k_table)
    if (entry.kind != EventKind::none && matches_pattern(entry.words, pattern)) kinds.set(static_cast<std::size_t>(entry.kind));
  return kinds;
}

} // namespace steplap
