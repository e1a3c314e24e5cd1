// Model table `[[action]]`: when a condition comes true during a run, an element is released or held, a value is set, or the run ends.
// Semantics: docs/reference/actions.md.
#pragma once

#include "mbd/base/event_kind.h"
#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// One table [[action]], texts as in the file.
struct Action : TableObject {
  std::string when;               ///< condition: a time, a comparison, or an event of an element
  std::vector<std::string> steps; ///< steps, executed in this order
  bool once = true;               ///< true: acts only the first time that the condition comes true; false: each time
  bool armed = true;              ///< true: armed from the start; false: after another action arms it
  std::string meaning;            ///< description for reports; may be empty
  std::string reason;             ///< reason why loads removed by this action are meant to end there; empty: not yet applied loads count as
                                  ///< missing
};

/// Returns the action if the element is one, otherwise nullptr.
[[nodiscard]] const Action* as_action(const Element& element);

/// Operation of one step of an action.
enum class ActionVerb { release, hold, set, arm, disarm, stop };

/// One parsed step. Examples: "release hook", "set brake.holds = 20 N m", "arm alarm", "stop".
struct ActionStepText {
  ActionVerb verb = ActionVerb::stop; ///< what it does
  std::string name;                   ///< element, or for arm and disarm the action; "" for stop
  std::string field, value;           ///< for set only
};

/// Parses a step. Throws std::invalid_argument with a list of the valid forms.
[[nodiscard]] ActionStepText action_step(const std::string& text);
/// Returns the text that action_step() parses to `step`.
[[nodiscard]] std::string text_of(const ActionStepText& step);

/// Event condition "ELEMENT EVENT", such as "left foot opens".
struct EventText {
  std::string element;              ///< its name
  EventKind kind = EventKind::none; ///< what happens to it
};
/// Parses an event condition. Returns nothing if the text is not one.
[[nodiscard]] std::optional<EventText> event_text(const std::string& when);

/// Splits a list value of a set step: "[a, [b, c]]" gives "a" and "[b, c]", without blanks and quotes around the items. Returns nullopt if
/// the value is not a list.
[[nodiscard]] std::optional<std::vector<std::string>> items_of_list(const std::string& value);

/// Returns true if the value of a `set` step is a name, for example of a signal, and not a number.
[[nodiscard]] bool is_name_in_step(const std::string& value);

} // namespace steplap
