#include "mbd/system/own_states.h"

#include "mbd/formula/unit_dimension.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr OwnCoordinate<double> k_no_coordinate{};

// Returns the largest radius of gyration of the bodies, m, which error scales use; 1 if there are no masses.
double length_of(const Model& model) {
  double length = 0.0;
  for (const Body& body : model.bodies)
    if (!body.fixed && body.mass > 0.0) length = std::max(length, std::sqrt(body.inertia / body.mass));
  return length > 0.0 ? length : 1.0;
}

} // namespace

double OwnState::factor() const {
  const auto known = dimension_of(unit);
  return known ? known->factor : 1.0;
}

std::vector<const OwnState*> own_states(const Model& model) {
  std::vector<const OwnState*> states;
  for (const ElementEntry& entry : model.elements)
    if (const auto* const state = dynamic_cast<const OwnState*>(entry.element.get())) states.push_back(state);
  return states;
}

const OwnState* find_own_state(const Model& model, const std::string& name) {
  for (const OwnState* state : own_states(model))
    if (state->name == name) return state;
  return nullptr;
}

// Integrators take 1/1000 of the characteristic length, at most 1 m, as error scale of inner states (Integrator::update_weights). The
// stored value is therefore scaled so that `scale` corresponds to this length.
StatePlace place_of_state(SystemBuilder& builder, const OwnState& state) {
  auto& group = builder.group<OwnStateGroup>();
  const std::vector<const OwnState*> states = own_states(builder.model());
  const double length = std::min(length_of(builder.model()), 1.0);
  const auto unit_of = [length](const OwnState& s) {
    const double scale = s.scale.value_or(s.start != 0.0 ? std::abs(s.start) : 1.0);
    return s.factor() * scale / length;
  };
  if (group.first_inner < 0)
    for (const OwnState* each : states) {
      const int inner = builder.add_inner(group, each->factor() * each->start / unit_of(*each));
      if (group.first_inner < 0) group.first_inner = inner;
    }
  const auto at = std::find(states.begin(), states.end(), &state) - states.begin();
  return {group.first_inner + static_cast<int>(at), unit_of(state)};
}

std::vector<double> start_of_states(SystemBuilder& builder) {
  std::vector<double> inner;
  for (const OwnState* state : own_states(builder.model())) {
    const StatePlace place = place_of_state(builder, *state);
    inner.resize(static_cast<std::size_t>(place.inner) + 1, 0.0);
    inner.back() = state->factor() * state->start / place.unit;
  }
  return inner;
}

const OwnStateGroup* own_state_group(const System& system) {
  for (const ForceGroup* group : system.inner_groups)
    if (const auto* const found = dynamic_cast<const OwnStateGroup*>(group)) return found;
  return nullptr;
}

void OwnStateGroup::add_forces(Evaluation& e) const { add_rates(e, NumericSignalEvaluator{e.t}); }

bool OwnStateGroup::record_forces(TracedEvaluation& e) const {
  add_rates<TapeNumber>(e, TracedSignalEvaluator{e});
  return true;
}

template <class S, class AtTime> void OwnStateGroup::add_rates(EvaluationData<S>& e, const AtTime& at_time) const {
  S quantity[k_most_switches];
  for (const ElementData& entry : entries) {
    const SwitchBits bits = entry.unit < 0 ? 0 : e.mode[entry.unit];
    preset_quantities(entry.rate.program().switch_count(), bits, quantity);
    const S rate = entry.rate.value(e, OwnCoordinate<S>{}, at_time, bits, quantity);
    e.inner_rate[entry.place.inner] = rate / S(entry.place.unit);
    if (entry.unit >= 0)
      switch_events(bits, quantity, entry.switches, e.event_value + entry.first_event, e.event_derivative + entry.first_event);
  }
}

void OwnStateGroup::add_state_jacobian(const Evaluation& e, StateJacobian& out) const {
  static thread_local std::vector<double> derivatives;
  for (const ElementData& entry : entries) {
    const auto& operands = entry.rate.operands();
    derivatives.resize(std::max(derivatives.size(), operands.size()));
    (void)entry.rate.differentiate(e, k_no_coordinate, entry.unit < 0 ? 0 : e.mode[entry.unit], derivatives.data());
    for (std::size_t i = 0; i < operands.size(); ++i) {
      const double slope = derivatives[i] / entry.place.unit;
      if (operands[i].kind == MotionOperand::Kind::signal) continue;
      if (operands[i].kind == MotionOperand::Kind::state) {
        out.by_state.push_back({entry.place.inner, operands[i].inner, slope * operands[i].unit});
        continue;
      }
      for (const MotionShare& share : shares_of(operands[i], e, {}, k_ground, k_ground))
        if (share.body != k_ground) out.by_motion.push_back({entry.place.inner, share.body, slope * share.pose, slope * share.velocity});
    }
  }
}

void OwnStateGroup::register_formulas(std::vector<FormulaInMotion>& out) const {
  for (const ElementData& entry : entries) out.push_back({&entry.rate, nullptr, entry.unit, entry.element});
}

void OwnStateGroup::mark_bodies(std::vector<char>& is_used) const {
  for (const ElementData& entry : entries)
    for (const int body : entry.rate.bodies()) is_used[body] = 1;
}

void OwnStateGroup::register_turns(TurnTable& turns) const {
  for (const ElementData& entry : entries) entry.rate.register_turns(turns);
}

UnitMode OwnStateGroup::initial_mode(int element, const Evaluation& e) const {
  FormulaProgram::Bits bits{0, 0};
  entries[element].rate.find_bits(e, k_no_coordinate, bits);
  return bits.values;
}

UnitMode OwnStateGroup::next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const {
  return next_bits(entries[element].rate, mode, slot, e, k_no_coordinate);
}

} // namespace steplap
