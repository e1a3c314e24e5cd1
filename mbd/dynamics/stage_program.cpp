#include "mbd/dynamics/stage_program.h"

#include "mbd/dynamics/layout_store.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace steplap {

StageProgram::StageProgram(const Layout& layout, const State& state, StageCode choice)
    : layout_(&layout), modes_(state.mode.begin(), state.mode.end()), coordinate_count_(static_cast<std::size_t>(layout.coordinate_count)),
      inner_count_(state.inner.size()), time_count_(time_input_count(layout)), choice_(choice), is_hopeless_(!MachineCode::is_available()) {
  time_inputs_.resize(time_count_);
  for (const FrictionState& f : state.friction) frictions_.push_back({f.phase, f.sign, f.foot});
  family_ = tape_family(key());
  stages_ = family_->made();
  find_candidate();
}

// Returns a hash of the layout with its modes, and of the model's sizes.
std::uint64_t StageProgram::key() const {
  std::uint64_t hash = 14695981039346656037ULL;
  const auto add = [&hash](std::uint64_t x) { hash = (hash ^ x ^ x >> 29U) * 1099511628211ULL; };
  const Layout& l = *layout_;
  for (const std::size_t size : {coordinate_count_, inner_count_, time_count_, l.clusters.size(), l.placements.size(), l.active.size(),
                                 l.links.size(), l.locks.size(), l.merged.size()})
    add(size);
  for (const std::uint64_t part : l.key) add(part);
  for (const UnitMode mode : modes_) add(mode);
  for (const Friction& f : frictions_)
    add(static_cast<std::uint64_t>(f.foot) << 16U | static_cast<std::uint64_t>(f.phase) << 8U | static_cast<std::uint8_t>(f.sign));
  return hash;
}

void StageProgram::find_candidate() {
  if (choice_ == StageCode::when_it_pays && !tape_code_ && tapes_ == 0 && !is_hopeless_) candidate_ = family_->coded();
}

bool StageProgram::is_of(const State& state) const {
  return std::equal(modes_.begin(), modes_.end(), state.mode.begin(), state.mode.end()) &&
         std::equal(frictions_.begin(), frictions_.end(), state.friction.begin(), state.friction.end(),
                    [](const Friction& a, const FrictionState& b) {
                      return a == Friction{b.phase, b.sign, b.foot};
                    });
}

void StageProgram::adopt_code() {
  if (code_ || !tape_code_ || !tape_code_->code()) return;
  const MachineCode& made = *tape_code_->code();
  const double *const inputs = traced_.inputs.data(), *const constants = traced_.tape.constants.data();
  // The friction states that called elements read may have changed since the recording, so the tape is evaluated again.
  const bool is_as_ever = traced_.calls.empty() || replay(tape_code_->tape(), inputs, constants, traced_.outputs.data());
  if (is_as_ever && makes_what_was_traced(made)) {
    code_ = &made;
  } else {
    tape_code_.reset();
    is_hopeless_ = true;
  }
}

// Returns true if the code reproduces the recorded stage bit by bit.
bool StageProgram::makes_what_was_traced(const MachineCode& made) const {
  const Tape& tape = traced_.tape;
  std::size_t size[CodeArrays::k_more + 1] = {};
  for (const OutputLocation& p : tape.places) size[p.array] = std::max(size[p.array], static_cast<std::size_t>(p.place) + 1);
  std::vector<double> found(size[0] + size[1] + size[2] + size[3]);
  double* const begin[] = {found.data(), found.data() + size[0], found.data() + size[0] + size[1], found.data() + found.size() - size[3]};
  const CodeArrays arrays{tape.constants.data(), traced_.inputs.data() + tape.first_inputs, {begin[1], begin[2], begin[3]}};
  if (!made.run(traced_.inputs.data(), arrays, begin[0], true) || has_call_failed()) return false;
  for (std::size_t k = 0; k < tape.places.size(); ++k)
    if (std::memcmp(begin[tape.places[k].array] + tape.places[k].place, &traced_.outputs[k], sizeof(double)) != 0) return false;
  return true;
}

void StageProgram::note_failure() {
  if (++failures_ > k_most_failures) give_up();
}

void StageProgram::give_up() {
  code_ = nullptr;
  tape_code_.reset();
  failures_ = 0;
  stages_ = 0;
  is_hopeless_ = tapes_ >= k_most_tapes;
}

bool StageProgram::run(double t, const double* y, double* dy, double* event_value, double* event_derivative, bool all) {
  double* of_signal = time_inputs_.data() + time_count_;
  for (const SignalInput& signal : traced_.signals) *of_signal++ = signal.at(t);
  arrays_.outputs[0] = event_value;
  arrays_.outputs[1] = event_derivative;
  if (!code_->run(y, arrays_, dy, all)) {
    note_failure();
    return false;
  }
  if (has_call_failed()) return false; // the evaluation without code will throw the same exception as the element
  failures_ = 0;
  return true;
}

void StageProgram::count_stage() {
  ++stages_;
  family_->count_evaluation();
  if (!tape_code_) return;
  tape_code_->count_uses(1);
  adopt_code();
}

void StageProgram::put_wrenches(double* friction_force) const {
  const double* at = rest_.data();
  for (const int slot : traced_.wrenches) friction_force[slot] = *at++;
}

bool StageProgram::has_call_failed() const {
  bool is_any = false;
  for (const auto& call : traced_.calls) is_any = call->has_failed() || is_any;
  return is_any;
}

// Returns the smallest relative pivot of the constraint solvers. Comparisons are made as in the solvers and in the same order, so that the
// result is bit-identical.
double StageProgram::smallest_pivot_in(const double* rest) const {
  const double* at = rest + traced_.wrenches.size();
  double smallest = 1.0;
  for (const int count : traced_.pivots) {
    double of_solver = 1.0;
    for (int i = 0; i < count; ++i, at += 2)
      if (at[0] < of_solver * at[1]) of_solver = at[0] / at[1];
    smallest = std::min(smallest, of_solver);
  }
  return smallest;
}

// Returns true if the results of the tape equal those of the recorded stage, `found`, bit by bit.
bool StageProgram::has_found(const StageFound& found) const {
  const double* out = traced_.outputs.data();
  const auto is_same = [&out](double x) { return std::memcmp(out++, &x, sizeof x) == 0; };
  const auto are_same = [&is_same](const std::vector<int>& slots, const double* x) {
    return std::all_of(slots.begin(), slots.end(), [&](int slot) { return is_same(x[slot]); });
  };
  return std::all_of(found.dy, found.dy + coordinate_count_ + inner_count_ + 2, is_same) &&
         are_same(traced_.event_values, found.event_value) && are_same(traced_.event_derivatives, found.event_derivative) &&
         are_same(traced_.wrenches, found.friction_force) &&
         smallest_pivot_in(traced_.outputs.data() + traced_.usual_outputs()) == found.smallest_pivot;
}

void StageProgram::record(const System& system, const State& state, const Evaluation& live, double t, const double* y,
                          const StageFound& found) {
  ++tapes_;
  const std::shared_ptr<TapeCode> known = std::exchange(candidate_, nullptr);
  // Only the store keeps the list of steps. Its memory is reused for the next tape, since a run has dozens of sets of modes.
  static thread_local std::vector<TapeStep> steps;
  traced_.tape.steps.swap(steps);
  struct SwapBack {
    std::vector<TapeStep>& from;
    ~SwapBack() { from.swap(steps); }
  } const give_back{traced_.tape.steps};
  const bool is_traced = trace_rates(system, *layout_, state, live, t, y, {time_inputs(), time_count_}, k_traced_pivot, traced_,
                                     known ? &known->tape() : nullptr);
  // The candidate was wrong: its key was equal by chance, or another branch was taken. The stage will be recorded if the modes persist.
  if (known && !is_traced) return;
  is_hopeless_ = !is_traced || !has_found(found); // compares bit by bit
  if (is_hopeless_) return;
  time_inputs_.resize(time_count_ + traced_.signals.size());
  rest_.resize(traced_.outputs.size() - traced_.usual_outputs());
  arrays_ = {traced_.tape.constants.data(), time_inputs_.data(), {nullptr, nullptr, rest_.data()}};
  tape_code_ = known ? known : shared_code(traced_.tape);
  if (!known) family_->keep(tape_code_);
  if (choice_ == StageCode::at_once) tape_code_->make();
  adopt_code();
}

void StagePrograms::enter(Layout& layout, const State& state, LayoutStore& kept) {
  const auto known =
      std::find_if(layout.programs.begin(), layout.programs.end(), [&state](const auto& program) { return program->is_of(state); });
  if (known != layout.programs.end()) {
    now_ = known->get();
    now_->adopt_code();
    now_->find_candidate();
    return;
  }
  now_ = nullptr;
  if (choice_ == StageCode::never || kept.program_count() >= k_most_programs) return;
  now_ = layout.programs.emplace_back(std::make_unique<StageProgram>(layout, state, choice_)).get();
  kept.count_program();
}

} // namespace steplap
