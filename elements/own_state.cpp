#include "elements/own_state.h"

#include "mbd/formula/unit_dimension.h"
#include "mbd/system/own_states.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace steplap {

namespace {

constexpr const char* k_reserved[] = {"value", "rate", "t", "pi"};

// Checks that formulas can distinguish the state's name from operators and numbers.
void check_state(const OwnState& state) {
  const auto fail = [&](const char* field, const std::string& message) {
    throw ModelError(state.place(field), "state '" + state.name + "': " + message);
  };
  if (state.name.empty() || state.name.find_first_of("{}[]") != std::string::npos)
    fail("name", "a state's name has letters, and no braces or brackets");
  if (std::any_of(std::begin(k_reserved), std::end(k_reserved), [&](const char* word) { return state.name == word; }))
    fail("name", "'value', 'rate', 't' and 'pi' mean something else in formulas: choose another name");
  if (!dimension_of(state.unit)) fail("unit", "the unit '" + state.unit + "' is not known to formulas");
}

std::string unit_of_rate(const OwnState& state) {
  std::array<double, 3> powers{};
  if (const auto known = dimension_of(state.unit)) powers = known->powers;
  powers[2] -= 1.0;
  return unit_text(powers);
}

void compile_state(const Element& element, SystemBuilder& builder) {
  const auto& state = static_cast<const OwnState&>(element);
  OwnStateGroup& group = builder.group<OwnStateGroup>();
  OwnStateGroup::ElementData entry{MotionFormula(builder, {state.rate, "rate", unit_of_rate(state), "-", "-"}),
                                   place_of_state(builder, state), builder.element_index()};
  if (!entry.rate.is_valid()) return;
  const std::vector<double> inner = start_of_states(builder);
  Evaluation start;
  start.motion = &builder.reference(k_ground);
  start.inner = inner.data();
  FormulaProgram::Bits bits{0, 0};
  entry.rate.find_bits(start, {}, bits);
  if (!std::isfinite(entry.rate.value<double>(start, {}, NumericSignalEvaluator{0.0}, bits.values, nullptr)))
    return builder.error(
        "'rate' has no finite value at the start: something is divided by zero, or a root or logarithm is taken of what has none");
  entry.switches = scales_of(entry.rate, start, {});
  const int switch_count = entry.rate.program().switch_count();
  const StatePlace place = entry.place;
  group.entries.push_back(std::move(entry));
  if (switch_count > 0) builder.add_unit(group, switch_count);
  const double shown = place.unit / state.factor();
  const std::string meaning = state.meaning.empty() ? "follows from its rate: " + state.rate : state.meaning;
  builder.add_channel("value", state.unit, ChannelText(meaning, state.sign),
                      [inner_at = place.inner, shown](const Snapshot& s) { return shown * s.evaluation->inner[inner_at]; });
}

} // namespace

const ElementKind& own_state_element_kind() {
  static const ElementKind kind = [] {
    ElementKind k;
    k.name = "state";
    k.doc = "A state of the model.";
    k.fields = own_state_kind().fields;
    k.stage = 1;
    k.holds<OwnState>();
    k.compile = compile_state;
    return k;
  }();
  return kind;
}

const TableKind& own_state_kind() {
  static const TableKind kind = [] {
    using T = OwnState;
    TableKind k;
    k.name = "state";
    k.doc = "A number with its own differential equation: a filter, the integral of a controller, a current, a temperature. "
            "Formulas of forces and of other states read it by its name. Methods that step over events do not follow it.";
    FieldTable& f = k.fields;
    f.add("unit", &T::unit).doc("unit of its value, one that formulas know; A and K count as numbers there, as radians do");
    f.add("start", &T::start).doc("initial value, in its unit; it is constant in the search for equilibrium");
    f.add("rate", &T::rate).required().doc("formula of its change per second: \"(target - filtered) / '0.2 s'\"");
    f.add("scale", &T::scale).positive().doc("typical size, in its unit, for error control; default: the size of its start, or 1");
    f.add("meaning", &T::meaning).doc("what it is, for lists and reports; the formula if not given");
    f.add("sign", &T::sign).doc("when it is positive");
    k.holds<T>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element& table, Model& model) {
      check_state(static_cast<const T&>(table));
      model.elements.emplace_back(&own_state_element_kind(), std::make_shared<T>(static_cast<const T&>(table)));
    };
    return k;
  }();
  return kind;
}

} // namespace steplap
