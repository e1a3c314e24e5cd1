#include "elements/action.h"

#include "elements/joints.h"
#include "mbd/base/number_text.h"
#include "mbd/formula/formula.h"
#include "mbd/io/units.h"
#include "mbd/model/field_units.h"
#include "mbd/system/actions.h"
#include "mbd/system/own_states.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace steplap {

namespace {

// Returns true for fields that an action may set to a value; other fields take a name.
bool is_number_or_list(const Field& field) {
  return field.type == FieldType::number || field.type == FieldType::vec2 || field.type == FieldType::numbers ||
         field.type == FieldType::points;
}

bool is_action(const ElementEntry& entry) { return as_action(*entry.element) != nullptr; }

// Returns true for elements that can be released: all except actions and states.
bool can_act(const ElementEntry& entry) { return !is_action(entry) && dynamic_cast<const OwnState*>(entry.element.get()) == nullptr; }

/// Parses one action for the model that it belongs to.
class ActionReader {
public:
  ActionReader(const Action& action, SystemBuilder& builder) : action_(action), builder_(builder) {}

  std::optional<ActionGroup::ElementData> entry() {
    ActionGroup::ElementData entry;
    entry.name = action_.name;
    entry.is_once = action_.once;
    entry.is_armed = action_.armed;
    if (action_.steps.empty()) builder_.error("'do' is empty: say what happens, as \"release hook\" or \"stop\"");
    std::vector<std::string> targets; // names after the verb: elements for release and hold, actions for arm and disarm
    for (const std::string& text : action_.steps) {
      try {
        const ActionStepText step = action_step(text);
        entry.text += (entry.text.empty() ? "" : ", ") + text_of(step);
        if (step.verb == ActionVerb::release || step.verb == ActionVerb::hold) {
          if (std::find(targets.begin(), targets.end(), step.name) != targets.end())
            throw std::invalid_argument("'" + step.name + "' is named in two steps: one action releases or holds an element once");
          targets.push_back(step.name);
        }
        if (!entry.steps.empty() && entry.steps.back().verb == ActionVerb::stop)
          throw std::invalid_argument("nothing happens behind \"stop\": it is the last step");
        entry.steps.push_back(made(step));
      } catch (const std::invalid_argument& error) {
        builder_.error("'do': " + std::string(error.what()));
      }
    }
    if (!read_trigger(entry.trigger)) return std::nullopt;
    return entry;
  }

private:
  [[nodiscard]] const Model& model() const { return builder_.model(); }

  template <class F> int find_element(const std::string& name, const F& counts, const std::string& what) const {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < model().elements.size(); ++i) {
      if (!counts(model().elements[i])) continue;
      if (model().elements[i].element->name == name) return static_cast<int>(i);
      known.push_back(model().elements[i].element->name);
    }
    throw std::invalid_argument("there is no " + what + " '" + name + "'" + did_you_mean(name, known));
  }

  [[nodiscard]] ActionStep made(const ActionStepText& text) const {
    ActionStep step;
    step.verb = text.verb;
    switch (text.verb) {
    case ActionVerb::stop: break;
    case ActionVerb::arm:
    case ActionVerb::disarm: {
      const int found = find_element(text.name, is_action, "action");
      step.target = static_cast<int>(std::count_if(model().elements.begin(), model().elements.begin() + found, is_action));
      break;
    }
    case ActionVerb::release:
    case ActionVerb::hold: step.target = find_element(text.name, can_act, "element"); break;
    case ActionVerb::set: read_set(text, step); break;
    }
    return step;
  }

  void read_set(const ActionStepText& text, ActionStep& step) const {
    step.target = find_element(text.name, can_act, "element");
    const ElementEntry& entry = model().elements[static_cast<std::size_t>(step.target)];
    const Field* const field = entry.kind->fields.find(text.field);
    std::vector<std::string> known;
    for (const Field& each : entry.kind->fields.fields())
      if (is_number_or_list(each) || each.type == FieldType::signal) known.push_back(each.name);
    if (!field)
      throw std::invalid_argument("'" + text.name + "' is a " + entry.kind->name + " and has no '" + text.field + "'" +
                                  did_you_mean(text.field, known));
    if (dynamic_cast<const Joint*>(entry.element.get()))
      throw std::invalid_argument("'" + text.field + "' of '" + text.name +
                                  "' cannot be set: it says where a run begins, and a joint goes on from there. A prescribed_motion or a "
                                  "motor moves it");
    if (field->is_limit)
      throw std::invalid_argument("'" + text.field + "' of '" + text.name +
                                  "' cannot be set: a run is judged by one limit from its start to its end");
    step.field = text.field;
    if (field->type == FieldType::signal) {
      std::vector<std::string> signals;
      for (const SignalEntry& signal : model().signals) signals.push_back(signal.definition->name);
      if (std::find(signals.begin(), signals.end(), text.value) == signals.end())
        throw std::invalid_argument("there is no signal '" + text.value + "'" + did_you_mean(text.value, signals));
      step.value = text.value;
      return;
    }
    if (!is_number_or_list(*field))
      throw std::invalid_argument("'" + text.field + "' of '" + text.name + "' cannot be set: only numbers, lists of them and signals can");
    step.value = value_of(text, *field, entry);
    if (field->type != FieldType::number) try_out(step, *field);
  }

  // Checks a new list already when the model is compiled if the element itself validates it (for example ascending points), not only when
  // the action is executed.
  void try_out(const ActionStep& step, const Field& field) const {
    Model trial = model();
    ElementEntry& entry = trial.elements[static_cast<std::size_t>(step.target)];
    field.set(entry.element.get(), step.value);
    const std::string name = entry.element->name;
    std::erase_if(trial.elements, is_action);
    try {
      (void)compile(trial);
    } catch (const ModelError& error) {
      const std::string& message = error.diagnostics().front().message;
      if (message.find("'" + name + "'") != std::string::npos) throw std::invalid_argument("with that, " + message);
    }
  }

  [[nodiscard]] static FieldValue value_of(const ActionStepText& text, const Field& field, const ElementEntry& entry) {
    const std::string unit = unit_in(entry.kind->fields, field, entry.element.get());
    if (field.type == FieldType::number) return number(text, field, unit);
    if (field.type == FieldType::vec2) return point(text, field, unit, unit, text.value);
    std::vector<double> numbers;
    std::vector<Vec2> points;
    for (const std::string& item : items(text, field, text.value))
      if (field.type == FieldType::numbers) numbers.push_back(number(with_value(text, item), field, unit));
      else points.push_back(point(text, field, unit, field.unit2.empty() ? unit : field.unit2, item));
    return field.type == FieldType::numbers ? FieldValue(numbers) : FieldValue(points);
  }

  [[nodiscard]] static ActionStepText with_value(ActionStepText text, const std::string& value) {
    text.value = value;
    return text;
  }

  [[nodiscard]] static std::vector<std::string> items(const ActionStepText& text, const Field& field, const std::string& list) {
    const auto found = items_of_list(list);
    if (!found) fail_as_list(text, field);
    return *found;
  }

  [[noreturn]] static void fail_as_list(const ActionStepText& text, const Field& field) {
    throw std::invalid_argument("'" + text.name + "." + text.field + "' cannot be '" + text.value + "': write a list, as " +
                                (field.type == FieldType::points ? "[[0, 0], [1, 2]]" : "[1, 2]"));
  }

  [[nodiscard]] static Vec2 point(const ActionStepText& text, const Field& field, const std::string& unit, const std::string& unit2,
                                  const std::string& list) {
    const std::vector<std::string> parts = items(text, field, list);
    if (parts.size() != 2) fail_as_list(text, field);
    return {number(with_value(text, parts[0]), field, unit), number(with_value(text, parts[1]), field, unit2)};
  }

  [[nodiscard]] static double number(const ActionStepText& text, const Field& field, const std::string& unit) {
    double plain = 0.0; // number in SI units, like one without unit in a file
    const char *const begin = text.value.data(), *const end = begin + text.value.size();
    if (const auto read = std::from_chars(begin, end, plain); read.ec == std::errc() && read.ptr == end) return checked(plain, text, field);
    const Quantity quantity = parse_quantity(text.value, unit);
    if (!quantity.problem.empty()) throw std::invalid_argument("'" + text.name + "." + text.field + "': " + quantity.problem);
    return checked(quantity.value, text, field);
  }

  [[nodiscard]] static double checked(double value, const ActionStepText& text, const Field& field) {
    const std::string subject = "'" + text.name + "." + text.field + "'";
    const bool is_low = value < field.minimum || (field.is_minimum_excluded && value <= field.minimum);
    if (!std::isfinite(value)) throw std::invalid_argument(subject + " cannot be " + text.value + ": it is a finite number");
    if (is_low || value > field.maximum)
      throw std::invalid_argument(subject + " cannot be " + text.value + ": it is " +
                                  (is_low ? (field.is_minimum_excluded ? "larger than " : "at least ") + number_text(field.minimum)
                                          : "at most " + number_text(field.maximum)));
    return value;
  }

  bool read_trigger(ActionTrigger& trigger) {
    if (const auto event = event_text(action_.when)) {
      try {
        trigger.element = find_element(
            event->element, [](const ElementEntry&) { return true; }, "element");
        trigger.event = event->kind;
      } catch (const std::invalid_argument& error) {
        builder_.error("'when': " + std::string(error.what()));
        return false;
      }
      return true;
    }
    const Quantity time = parse_quantity(action_.when, "s");
    if (time.problem.empty()) {
      if (time.value >= 0.0 && std::isfinite(time.value)) trigger.time = time.value;
      else builder_.error("'when': a run begins at 0 s");
      return trigger.time.has_value();
    }
    return is_comparison() && read_formula(trigger);
  }

  bool is_comparison() {
    try {
      const FormulaOp op = Formula(action_.when, "'when'", {}).tree().back().op;
      if (op == FormulaOp::less || op == FormulaOp::less_or_equal || op == FormulaOp::both || op == FormulaOp::either ||
          op == FormulaOp::negation)
        return true;
      builder_.error("'when' compares nothing: write \"a > b\", a time as \"2 s\", or an event of an element as \"foot opens\"");
    } catch (const ModelError& error) {
      builder_.error("'when' is no time as \"2 s\", no event of an element as \"foot opens\", and as a comparison: " +
                     error.diagnostics().front().message);
    }
    return false;
  }

  bool read_formula(ActionTrigger& trigger) {
    MotionFormula formula(builder_, {action_.when, "when", "", "-", "-"});
    if (!formula.is_valid()) return false;
    const bool is_constant = formula.operands().empty() && !formula.program().uses_time();
    if (is_constant || formula.program().switch_count() == 0) {
      builder_.error("'when' is the same at all times: compare what moves, or a time");
      return false;
    }
    const std::vector<double> inner = start_of_states(builder_);
    Evaluation start;
    start.motion = &builder_.reference(k_ground);
    start.inner = inner.data();
    trigger.switches = scales_of(formula, start, {});
    trigger.formula = std::move(formula);
    return true;
  }

  const Action& action_;
  SystemBuilder& builder_;
};

void compile_action(const Element& element, SystemBuilder& builder) {
  ActionGroup& group = builder.group<ActionGroup>();
  if (!group.model) {
    group.model = std::make_shared<Model>(builder.model());
    group.channels = builder.requested_channel_names();
  }
  std::optional<ActionGroup::ElementData> entry = ActionReader(static_cast<const Action&>(element), builder).entry();
  if (!entry) return;
  if (entry->trigger.time && *entry->trigger.time > 0.0) builder.add_breakpoint(*entry->trigger.time);
  const int switch_count = entry->trigger.formula ? entry->trigger.formula->program().switch_count() : 0;
  group.entries.push_back(std::move(*entry));
  if (switch_count > 0) builder.add_unit(group, switch_count);
}

// Returns the kind of the element that is made from the table; elements in files cannot have this kind.
const ElementKind& compiled_kind() {
  static const ElementKind kind = [] {
    ElementKind k;
    k.name = "action";
    k.doc = "An action of the model.";
    k.fields = action_kind().fields;
    k.stage = 1;
    k.holds<Action>();
    k.compile = compile_action;
    return k;
  }();
  return kind;
}

} // namespace

const TableKind& action_kind() {
  static const TableKind kind = [] {
    using T = Action;
    TableKind k;
    k.name = "action";
    k.doc = "Something that happens when a condition comes true: an element is released or begins to act, a brake is set, the run ends. "
            "Syntax: `docs/reference/actions.md`.";
    FieldTable& f = k.fields;
    f.add("when", &T::when)
        .required()
        .doc("a time, \"2 s\"; a comparison as formulas of forces make them, \"arm.theta > '60 deg'\"; or an event of an element, \"foot "
             "opens\"");
    f.add("do", &T::steps)
        .required()
        .doc("one after the other: \"release NAME\", \"hold NAME\", \"set NAME.field = value\", \"arm ACTION\", \"disarm ACTION\", "
             "\"stop\"");
    f.add("once", &T::once).doc("it happens once each time that it is armed; false: each time that its condition comes true");
    f.add("armed", &T::armed).doc("from the start; false: from where another action arms it");
    f.add("meaning", &T::meaning).doc("what it is, for lists and reports");
    f.add("reason", &T::reason)
        .doc("why loads that it cuts off, by stop, release or set, are meant to end there: \"the car has stopped\"; without it the verdict "
             "is open");
    k.holds<T>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element& table, Model& model) {
      const auto& action = static_cast<const T&>(table);
      if (action.name.empty()) throw ModelError(action.place("name"), "an action needs a name");
      model.elements.emplace_back(&compiled_kind(), std::make_shared<T>(action));
    };
    return k;
  }();
  return kind;
}

} // namespace steplap
