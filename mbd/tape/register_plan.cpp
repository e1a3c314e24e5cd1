#include "mbd/tape/register_plan.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <unordered_map>
#include <utility>

namespace steplap {

namespace {

using enum TapeOperation;
using Kind = PlannedInstruction::Kind;

constexpr std::int32_t k_never = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t k_none = -1;
constexpr std::int64_t k_worth_of_store = 100; ///< steps; a value with a copy in memory is evicted even if needed sooner by this number
constexpr std::int32_t k_store_outputs = -1;   ///< marker in `order_`: store the outputs computed so far
constexpr std::int32_t k_leave = -2;           ///< marker in `order_`: the usual outputs are stored; the code may return

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

class Planner {
public:
  Planner(const Tape& tape, const std::vector<std::int32_t>& order, const RegisterRules& rules)
      : tape_(tape), rules_(rules), values_(tape.steps.size()), free_(rules.registers == 32 ? ~0u : (1u << rules.registers) - 1) {
    arrange(order);
    list_outputs();
    visit_steps();
    find_next_uses();
  }

  RegisterPlan plan() {
    plan_.instructions.reserve(2 * order_.size());
    for (std::size_t p = 0; p < order_.size(); ++p) {
      busy_ = 0;
      if (order_[p] == k_store_outputs) store_outputs(p);
      else if (order_[p] == k_leave) plan(Kind::leave);
      else plan_step(p, tape_.steps[at(order_[p])]);
    }
    plan_.call_slots = argument_slots_ + result_slots_;
    return std::move(plan_);
  }

private:
  struct alignas(32) Value {     // aligned so that its address is computed by a shift
    std::int32_t next = k_never; ///< position of the next use
    std::int32_t position = -1;  ///< in the order
    std::int8_t reg = -1;
    OperandPlace home;             ///< location in memory
    std::int32_t output = k_none;  ///< its first output
    std::int32_t partner = k_none; ///< for a sine the cosine of the same argument, and vice versa
  };
  struct Call {
    std::vector<std::int32_t> arguments; ///< steps
    std::vector<std::int32_t> next;      ///< position of the next use of each argument after the call
    std::int32_t first_result = 0;       ///< slot of the first result
  };
  struct NextUses {
    std::int32_t a = k_never, b = k_never, result = k_never;
  };

  void arrange(const std::vector<std::int32_t>& order) {
    std::size_t last = 0; // after the last condition
    for (std::size_t p = 0; p < order.size(); ++p)
      if (is_condition(tape_.steps[at(order[p])].operation)) last = p + 1;
    order_.reserve(order.size() + 1);
    order_.insert(order_.end(), order.begin(), order.begin() + static_cast<std::ptrdiff_t>(last));
    order_.push_back(k_store_outputs);
    stores_ = last;
    order_.insert(order_.end(), order.begin() + static_cast<std::ptrdiff_t>(last), order.end());
    for (std::size_t p = 0; p < order_.size(); ++p)
      if (order_[p] >= 0) values_[at(order_[p])].position = static_cast<std::int32_t>(p);
    if (tape_.usual_outputs > 0 && tape_.usual_outputs < tape_.outputs.size()) place_leave();
  }

  // Inserts k_leave into the order: after the last usual output, the last condition and k_store_outputs.
  void place_leave() {
    std::size_t last = stores_;
    for (std::size_t p = stores_; p < order_.size(); ++p)
      if (order_[p] >= 0 && is_condition(tape_.steps[at(order_[p])].operation)) last = p;
    for (std::size_t k = 0; k < tape_.usual_outputs; ++k) last = std::max(last, at(std::max(values_[at(tape_.outputs[k])].position, 0)));
    order_.insert(order_.begin() + static_cast<std::ptrdiff_t>(last) + 1, k_leave);
    for (std::size_t p = last + 2; p < order_.size(); ++p) ++values_[at(order_[p])].position;
  }

  void list_outputs() {
    next_output_.assign(tape_.outputs.size(), k_none);
    for (std::size_t k = tape_.outputs.size(); k-- > 0;)
      next_output_[k] = std::exchange(values_[at(tape_.outputs[k])].output, static_cast<std::int32_t>(k));
  }

  OperandPlace place_of_given(const TapeStep& s) {
    if (s.operation == constant && is_literal(s.a))
      return place(OperandPlace::Kind::literal, static_cast<std::int32_t>(literal_index(s.a)));
    if (s.operation == constant) return place(OperandPlace::Kind::constant, s.a);
    if (tape_.first_inputs == 0 || s.a < tape_.first_inputs) return place(OperandPlace::Kind::input, s.a);
    plan_.has_later_inputs = true;
    return place(OperandPlace::Kind::later_input, s.a - tape_.first_inputs);
  }

  OperandPlace place_of_output(std::int32_t k) {
    const OutputLocation to = tape_.places.empty() ? OutputLocation{0, k} : tape_.places[at(k)];
    plan_.arrays |= 1u << static_cast<unsigned>(to.array);
    return {OperandPlace::Kind::output, static_cast<std::int8_t>(to.array), to.place};
  }

  static OperandPlace place(OperandPlace::Kind kind, std::int32_t index) { return {kind, 0, index}; }

  // Sets the memory locations of inputs and constants, and finds the sines and cosines of one argument, which are computed together.
  void visit_steps() {
    for (std::size_t i = 0; i < tape_.steps.size(); ++i) {
      const TapeStep& s = tape_.steps[i];
      if (s.operation == TapeOperation::call) visit_call(i);
      if (is_given(s.operation)) values_[i].home = place_of_given(s);
      if (s.operation != sine && s.operation != cosine) continue;
      if (call_of_.empty()) call_of_.assign(tape_.steps.size(), k_none);
      std::int32_t& other = call_of_[at(s.a)]; // sine or cosine of this argument without partner
      if (other != k_none && tape_.steps[at(other)].operation != s.operation) {
        values_[at(other)].partner = static_cast<std::int32_t>(i);
        values_[i].partner = std::exchange(other, k_none);
      } else {
        other = static_cast<std::int32_t>(i);
      }
    }
  }

  // Assigns stack slots to a call. All calls share the slots of arguments; results have their own slots, since later steps may use them.
  void visit_call(std::size_t i) {
    const TapeStep& s = tape_.steps[i];
    Call& call = calls_[static_cast<std::int32_t>(i)];
    call.arguments = arguments_of(tape_, s);
    call.next.resize(call.arguments.size());
    argument_slots_ = std::max(argument_slots_, static_cast<std::int32_t>(call.arguments.size()));
    call.first_result = result_slots_;
    result_slots_ += s.b;
  }

  bool is_before(std::int32_t step, std::size_t p) const { return values_[at(step)].position < static_cast<std::int32_t>(p); }

  // Determines the next use of each value, from the end. Operands of unused steps have no use.
  void find_next_uses() {
    next_.resize(order_.size());
    output_next_.resize(tape_.outputs.size());
    for (std::size_t p = order_.size(); p-- > 0;) {
      const auto here = static_cast<std::int32_t>(p);
      if (order_[p] == k_store_outputs) {
        for (std::size_t k = tape_.outputs.size(); k-- > 0;)
          if (is_before(tape_.outputs[k], p)) output_next_[k] = std::exchange(values_[at(tape_.outputs[k])].next, here);
        continue;
      }
      if (order_[p] == k_leave) continue;
      const TapeStep& s = tape_.steps[at(order_[p])];
      next_[p].result = values_[at(order_[p])].next;
      if (is_idle(p)) continue;
      if (s.operation == TapeOperation::call) {
        Call& call = calls_.at(order_[p]);
        for (std::size_t k = call.arguments.size(); k-- > 0;) call.next[k] = std::exchange(values_[at(call.arguments[k])].next, here);
        continue;
      }
      if (takes_two(s.operation)) next_[p].b = std::exchange(values_[at(s.b)].next, here);
      next_[p].a = std::exchange(values_[at(s.a)].next, here);
    }
  }

  bool is_idle(std::size_t p) const {
    const Value& v = values_[at(order_[p])];
    return next_[p].result == k_never && v.output == k_none && !is_condition(tape_.steps[at(order_[p])].operation);
  }

  void plan_step(std::size_t p, const TapeStep& s) {
    if (is_idle(p)) return;
    if (s.operation == TapeOperation::call) return call(calls_.at(order_[p]));
    Value& a = values_[at(s.a)];
    if (s.operation == TapeOperation::result) {
      a.next = next_[p].a;
      take_result(p, s);
    } else if (s.operation == sine || s.operation == cosine) {
      a.next = next_[p].a;
      plan_sine_or_cosine(p, s);
    } else if (takes_two(s.operation)) {
      Value& b = values_[at(s.b)];
      a.next = next_[p].a;
      b.next = next_[p].b; // after a's, since both may be the same step
      if (is_condition(s.operation)) condition(s);
      else binary(p, s);
    } else {
      a.next = next_[p].a;
      unary(p, s);
    }
  }

  // --- registers and slots ---

  // Returns a free register, evicting a value if necessary.
  int free_register() {
    if (free_ == 0) evict(farthest());
    return std::countr_zero(free_);
  }

  int farthest() const {
    int best = -1;
    std::int64_t best_score = -1;
    for (int r = 0; r < rules_.registers; ++r) {
      if (busy_ >> r & 1) continue;
      const Value& v = values_[at(owner_[r])];
      const std::int64_t score = std::int64_t{v.next} + (v.home.kind == OperandPlace::Kind::nowhere ? 0 : k_worth_of_store);
      if (score > best_score) best_score = score, best = r;
    }
    return best;
  }

  void evict(int r) {
    Value& v = values_[at(owner_[r])];
    if (v.home.kind == OperandPlace::Kind::nowhere) {
      v.home = place(OperandPlace::Kind::slot, free_slot());
      store(r, v.home);
    }
    v.reg = -1;
    free_ |= 1u << r;
  }

  void take(int r, std::int32_t step) {
    free_ &= ~(1u << r);
    owner_[r] = step;
    values_[at(step)].reg = static_cast<std::int8_t>(r);
  }

  void release_register_if_dead(Value& v) {
    const bool goes = v.next == k_never && v.reg >= 0; // both cases are equally frequent, so branches are avoided
    free_ |= std::uint32_t{goes} << (v.reg & 31);
    v.reg = static_cast<std::int8_t>(goes ? -1 : v.reg);
  }

  void free_slot_of(Value& v) {
    if (v.next != k_never || v.home.kind != OperandPlace::Kind::slot) return;
    free_slots_.push_back(v.home.index);
    v.home = {};
  }

  std::int32_t free_slot() {
    if (free_slots_.empty()) return plan_.slots++;
    const std::int32_t slot = free_slots_.back();
    free_slots_.pop_back();
    return slot;
  }

  // --- instructions ---

  PlannedInstruction& plan(Kind kind) {
    PlannedInstruction& i = plan_.instructions.emplace_back();
    i.kind = kind;
    return i;
  }

  void load(int r, OperandPlace from) {
    PlannedInstruction& i = plan(Kind::load);
    i.destination = static_cast<std::int8_t>(r);
    i.second = from;
  }

  void store(int r, OperandPlace to) {
    PlannedInstruction& i = plan(Kind::store);
    i.first = static_cast<std::int8_t>(r);
    i.second = to;
  }

  void arithmetic(Kind kind, TapeOperation o, int destination, int first, OperandPlace second) {
    PlannedInstruction& i = plan(kind);
    i.operation = o;
    i.destination = static_cast<std::int8_t>(destination);
    i.first = static_cast<std::int8_t>(first);
    i.second = second;
  }

  // Protects the register of the value, if it has one, from eviction while this step is planned.
  void keep(std::int32_t step) {
    const int r = values_[at(step)].reg;
    busy_ |= std::uint32_t{r >= 0} << (r & 31);
  }

  // Returns a register that contains the value, loading it if necessary; the register is protected during this step.
  int in_register(std::int32_t step) {
    Value& v = values_[at(step)];
    if (v.reg < 0) {
      const int r = free_register();
      load(r, v.home);
      // A loaded value keeps its register for later uses only if registers are plentiful; otherwise the register is free after this step.
      if (rules_.has_three_operands && v.next != k_never && std::popcount(free_) > 2) take(r, step);
      else free_ &= ~(1u << r), passing_ |= 1u << r;
      busy_ |= 1u << r;
      return r;
    }
    busy_ |= 1u << v.reg;
    return v.reg;
  }

  OperandPlace in_register_or_memory(std::int32_t step) {
    const Value& v = values_[at(step)];
    if (v.reg >= 0) {
      busy_ |= 1u << v.reg;
      return place(OperandPlace::Kind::in_register, v.reg);
    }
    return v.home;
  }

  // Frees the registers of the step's operands that have no further use.
  void let_operands_go(const TapeStep& s) {
    release_register_if_dead(values_[at(s.a)]);
    if (takes_two(s.operation)) release_register_if_dead(values_[at(s.b)]);
    free_ |= std::exchange(passing_, 0u);
  }

  void let_slots_go(const TapeStep& s) {
    free_slot_of(values_[at(s.a)]);
    if (takes_two(s.operation)) free_slot_of(values_[at(s.b)]);
  }

  bool stays(int r) const { return (passing_ >> r & 1) == 0 && values_[at(owner_[r])].next != k_never; }

  // Returns the register for the result of the step. With two-operand instructions `first` is moved or copied to it.
  int destination(const TapeStep& s, int first) {
    if (rules_.has_three_operands) {
      let_operands_go(s);
      return free_register();
    }
    int r = first;
    if (stays(first)) {
      r = free_register();
      PlannedInstruction& i = plan(Kind::move);
      i.destination = static_cast<std::int8_t>(r);
      i.second = place(OperandPlace::Kind::in_register, first);
    }
    let_operands_go(s);
    return r;
  }

  void binary(std::size_t p, const TapeStep& s) {
    std::int32_t a = s.a, b = s.b;
    if (s.operation == maximum) std::swap(a, b);
    if (is_commutative(s.operation)) {
      const Value &va = values_[at(a)], &vb = values_[at(b)];
      const bool swaps = (vb.reg >= 0) & ((va.reg < 0) | ((va.next != k_never) & (vb.next == k_never)));
      a = swaps ? s.b : s.a;
      b = swaps ? s.a : s.b;
    }
    keep(b);
    const int first = in_register(a);
    const OperandPlace second = in_register_or_memory(b);
    const int r = destination(s, first);
    arithmetic(Kind::arithmetic, s.operation, r, rules_.has_three_operands ? first : r, second);
    let_slots_go(s);
    define(p, r);
  }

  void unary(std::size_t p, const TapeStep& s) {
    const int first = in_register(s.a);
    OperandPlace second;
    if (s.operation == negate) second.kind = OperandPlace::Kind::sign_bits;
    if (s.operation == absolute) second.kind = OperandPlace::Kind::value_bits;
    const int r = destination(s, first);
    arithmetic(Kind::arithmetic, s.operation, r, rules_.has_three_operands ? first : r, second);
    let_slots_go(s);
    define(p, r);
  }

  void condition(const TapeStep& s) {
    ++plan_.conditions;
    keep(s.a);
    const int first = in_register(s.b);
    const OperandPlace second = in_register_or_memory(s.a);
    let_operands_go(s);
    arithmetic(Kind::condition, s.operation, first, first, second);
    let_slots_go(s);
  }

  void let_registers_go() {
    for (int r = 0; r < rules_.registers; ++r)
      if ((free_ >> r & 1) == 0) evict(r);
  }

  void call(const Call& call) {
    plan_.has_calls = true;
    for (std::size_t k = 0; k < call.arguments.size(); ++k) {
      Value& v = values_[at(call.arguments[k])];
      const OperandPlace to = place(OperandPlace::Kind::call_slot, static_cast<std::int32_t>(k));
      if (v.reg >= 0) {
        store(v.reg, to);
      } else {
        const int r = free_register();
        load(r, v.home);
        store(r, to);
      }
      v.next = call.next[k];
      release_register_if_dead(v);
      free_slot_of(v);
    }
    let_registers_go();
    PlannedInstruction& i = plan(Kind::call);
    i.second = place(OperandPlace::Kind::call_slot, 0);
    i.result_slot = argument_slots_ + call.first_result;
  }

  void take_result(std::size_t p, const TapeStep& s) {
    Value& v = values_[at(order_[p])];
    v.next = next_[p].result;
    v.home = place(OperandPlace::Kind::call_slot, argument_slots_ + calls_.at(s.a).first_result + s.b);
    store_known(order_[p]);
  }

  // Plans the call that computes sine and cosine of one angle together. If the partner was planned before, nothing is left to compute.
  void plan_sine_or_cosine(std::size_t p, const TapeStep& s) {
    Value& v = values_[at(order_[p])];
    if (v.home.kind != OperandPlace::Kind::nowhere) { // already computed with its partner
      v.next = next_[p].result;
      store_known(order_[p]);
      let_operands_go(s);
      return let_slots_go(s);
    }
    plan_.has_calls = true;
    let_registers_go();
    const std::int32_t slots[2] = {free_slot(), free_slot()};
    PlannedInstruction& i = plan(Kind::sin_cos);
    i.second = values_[at(s.a)].home;
    i.sine_slot = slots[0];
    i.cosine_slot = slots[1];
    let_slots_go(s);
    const bool is_sine = s.operation == sine;
    v.next = next_[p].result;
    v.home = place(OperandPlace::Kind::slot, slots[is_sine ? 0 : 1]);
    const OperandPlace other = place(OperandPlace::Kind::slot, slots[is_sine ? 1 : 0]);
    if (v.partner != k_none && !is_idle(at(values_[at(v.partner)].position))) values_[at(v.partner)].home = other;
    else free_slots_.push_back(other.index);
    store_known(order_[p]);
  }

  // --- outputs ---

  // Records that register r holds the value of step number p of the order, and stores the outputs that have this value.
  void define(std::size_t p, int r) {
    const std::int32_t step = order_[p];
    Value& v = values_[at(step)];
    take(r, step);
    v.next = next_[p].result;
    if (p > stores_)
      for (std::int32_t k = v.output; k != k_none; k = next_output_[at(k)]) store_output(v, r, k);
    release_register_if_dead(v);
  }

  void store_output(Value& v, int r, std::int32_t k) {
    const OperandPlace to = place_of_output(k);
    store(r, to);
    if (v.home.kind == OperandPlace::Kind::nowhere) v.home = to;
  }

  // Copies a value that is in memory to the outputs that have this value.
  void store_known(std::int32_t step) {
    Value& v = values_[at(step)];
    if (v.position > static_cast<std::int32_t>(stores_))
      for (std::int32_t k = v.output; k != k_none; k = next_output_[at(k)]) copy_output(v, k);
    free_slot_of(v);
  }

  void copy_output(Value& v, std::int32_t k) {
    const int r = free_register();
    load(r, v.home);
    store(r, place_of_output(k));
  }

  void store_outputs(std::size_t p) {
    for (std::size_t k = 0; k < tape_.outputs.size(); ++k) {
      if (!is_before(tape_.outputs[k], p)) continue;
      Value& v = values_[at(tape_.outputs[k])];
      v.next = output_next_[k];
      if (v.reg >= 0) store_output(v, v.reg, static_cast<std::int32_t>(k));
      else copy_output(v, static_cast<std::int32_t>(k));
      release_register_if_dead(v);
      free_slot_of(v);
    }
  }

  const Tape& tape_;
  const RegisterRules rules_;
  std::vector<std::int32_t> order_;
  std::size_t stores_ = 0; ///< position in the order at which all outputs computed so far are stored; later ones are stored immediately
  std::vector<Value> values_;
  std::vector<NextUses> next_;
  std::vector<std::int32_t> next_output_;        ///< next output with the same value
  std::vector<std::int32_t> output_next_;        ///< next use of the value of an output after `stores_`
  std::vector<std::int32_t> call_of_;            ///< per argument: its sine or cosine without partner
  std::unordered_map<std::int32_t, Call> calls_; ///< by step
  std::int32_t argument_slots_ = 0, result_slots_ = 0;
  std::uint32_t free_;        ///< bit set of registers
  std::uint32_t busy_ = 0;    ///< operands of this step, which must not be evicted
  std::uint32_t passing_ = 0; ///< loaded for this step only
  std::int32_t owner_[32] = {};
  std::vector<std::int32_t> free_slots_;
  RegisterPlan plan_;
};

} // namespace

std::vector<std::int32_t> order_of_steps(const Tape& tape) {
  const auto n = static_cast<std::int32_t>(tape.steps.size());
  std::vector<std::int32_t> order;
  order.reserve(tape.steps.size());
  const auto is_call = [](const TapeStep& s) { return s.operation == sine || s.operation == cosine || s.operation == call; };
  const auto is_done = [](const TapeStep& s) { return !is_given(s.operation) && s.operation != argument; };
  const bool has_rest = tape.usual_outputs > 0 && tape.usual_outputs < tape.outputs.size();
  if (!has_rest && std::none_of(tape.steps.begin(), tape.steps.end(), is_call)) {
    for (std::int32_t i = 0; i < n; ++i)
      if (is_done(tape.steps[at(i)])) order.push_back(i);
    return order;
  }
  // Rank of each step in the order: 0 if calls depend on it, 1 if conditions or usual outputs do, otherwise 2.
  std::vector<char> turn(tape.steps.size(), has_rest ? char{2} : char{1});
  for (std::size_t k = 0; has_rest && k < tape.usual_outputs; ++k) turn[at(tape.outputs[k])] = 1;
  for (std::int32_t i = n; i-- > 0;) {
    const TapeStep& s = tape.steps[at(i)];
    char& own = turn[at(i)];
    if (is_condition(s.operation)) own = std::min<char>(own, 1);
    if (is_call(s)) own = 0;
    if (is_given(s.operation)) continue;
    turn[at(s.a)] = std::min(turn[at(s.a)], own);
    if (has_second_step(s)) turn[at(s.b)] = std::min(turn[at(s.b)], own);
  }
  for (char now = 0; now <= 2; ++now)
    for (std::int32_t i = 0; i < n; ++i)
      if (turn[at(i)] == now && is_done(tape.steps[at(i)])) order.push_back(i);
  return order;
}

RegisterPlan plan_registers(const Tape& tape, const std::vector<std::int32_t>& order, const RegisterRules& rules) {
  return Planner(tape, order, rules).plan();
}

} // namespace steplap
