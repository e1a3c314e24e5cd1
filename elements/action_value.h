// What `set NAME.field = value` of an action gives a field: a number, or a list of them as a model file has it.
#pragma once

#include "mbd/model/action.h"
#include "mbd/model/model.h"

namespace steplap {

/// Can an action set it? Signals are names, and no value that is read here.
[[nodiscard]] bool can_be_set(const Field& field);
/// In SI, within the field's range; lists are [1, 2 mm] or [[0, 0], [10 mm, 5 kN]]. Throws std::invalid_argument with what is wrong.
[[nodiscard]] FieldValue action_value(const ActionStepText& step, const Field& field, const ElementEntry& entry);

} // namespace steplap
