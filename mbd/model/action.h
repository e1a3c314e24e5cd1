// `[[action]]`: something that happens in a run, when a condition comes true: an element is released or held, something is set, the
// run ends. What it means is said in docs/reference/actions.md.
#pragma once

#include "mbd/base/event_kind.h"
#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// The table as a file has it.
struct Action : TableObject {
  std::string when;               ///< a time, a comparison, or an event of an element
  std::vector<std::string> steps; ///< what is done, one after the other
  bool once = true;               ///< else each time that the condition comes true
  bool armed = true;              ///< from the start; else from where another action arms it
  std::string meaning;            ///< for people; may be empty
  std::string reason;             ///< why loads that it cuts off are meant to end there; empty: they have not acted
};

/// The action that the element is; nullptr if it is another element.
[[nodiscard]] const Action* as_action(const Element& element);

/// What one step does.
enum class ActionVerb { release, hold, set, arm, disarm, stop };

/// A step as it is written: "release hook", "set brake.holds = 20 N m", "arm alarm", "stop".
struct ActionStepText {
  ActionVerb verb = ActionVerb::stop; ///< what it does
  std::string name;                   ///< of an element, or of an action to be armed or disarmed; "" of stop
  std::string field, value;           ///< of set
};

/// Throws std::invalid_argument that says what a step may be.
[[nodiscard]] ActionStepText action_step(const std::string& text);
/// As action_step() reads it.
[[nodiscard]] std::string text_of(const ActionStepText& step);

/// An event of an element: "left foot opens". Nothing where the text is none.
struct EventText {
  std::string element;              ///< its name
  EventKind kind = EventKind::none; ///< what happens to it
};
/// Reads one.
[[nodiscard]] std::optional<EventText> event_text(const std::string& when);

/// Of a value of set that is a list, "[a, [b, c]]", the items "a" and "[b, c]", without blanks and quotes around them; nullopt if it is none.
[[nodiscard]] std::optional<std::vector<std::string>> items_of_list(const std::string& value);

/// A value of set that names something, as a signal, and is no number.
[[nodiscard]] bool is_name_in_step(const std::string& value);

} // namespace steplap
