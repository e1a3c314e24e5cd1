#include "mbd/dynamics/traced_evaluation.h"

#include "mbd/dynamics/equations.h"
#include "mbd/dynamics/joint_wrench.h"
#include "mbd/dynamics/traced_mechanism.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

namespace steplap {

namespace {

constexpr std::size_t k_of_lock = 3, k_of_driven_row = 2;

struct LockTarget {
  TapeNumber value, rate, acceleration;
};

// Largest number of coordinates. With some 80 instructions per coordinate, longer code would not fit into the instruction cache.
constexpr int k_most_coordinates = 100;

bool is_plain(const Layout& layout) {
  return layout.coordinate_count <= k_most_coordinates && layout.schur.can_be_traced() && !layout.is_singular() && !layout.sharing;
}

/// Memory of a recording, kept for the next one, because allocation would take a tenth of the time.
struct TracerMemory {
  std::vector<Motion<TapeNumber>> motion_;
  std::vector<BodyForceOf<TapeNumber>> force_, lack_;
  std::vector<TapeNumber> contact_force_, watch_, event_derivative_, friction_force_;
  std::vector<TapeNumber> q_, v_, inner_, inner_rate_, time_, a_, multiplier_, cluster_a_;
  std::vector<SchurRowOf<TapeNumber>> rows_;
  std::vector<EdgeGeometry> edges_;

  static TracerMemory& kept() {
    static thread_local TracerMemory memory;
    return memory;
  }
};

// Records an evaluation. The operations are in the same order as in Dynamics::rates_at and the functions that it calls.
class Tracer : private TracerMemory {
public:
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;
  ~Tracer() { kept() = std::move(static_cast<TracerMemory&>(*this)); }
  Tracer(const System& system, const Layout& layout, const State& state, const Evaluation& live)
      : TracerMemory(std::move(kept())), system_(system), layout_(layout), state_(state), live_(live) {
    motion_.assign(system.bodies.size() + system.links.slot_count(), {});
    force_.assign(motion_.size(), {});
    contact_force_.assign(system.contact_count, TapeNumber(0.0));
    watch_.assign(system.event_count, TapeNumber(1.0));
    event_derivative_.assign(system.event_count, TapeNumber(std::numeric_limits<double>::quiet_NaN()));
    friction_force_.assign(system.friction_row_count, TapeNumber(0.0));
    for (auto* const numbers : {&q_, &v_, &inner_, &time_, &a_, &multiplier_, &cluster_a_}) numbers->clear();
    if (layout.has_mechanisms()) cluster_a_.resize(3 * layout.clusters.size());
    rows_.clear();
    inner_rate_.assign(static_cast<std::size_t>(system.inner_count()), TapeNumber(0.0));
    e_.motion = motion_.data();
    e_.link_motion = motion_.data();
    e_.force = force_.data();
    e_.link_force = force_.data();
    e_.contact_force = contact_force_.data();
    e_.event_value = watch_.data();
    e_.event_derivative = event_derivative_.data();
    e_.mode = state.mode.data();
    e_.friction = state.friction.data();
  }

  // Records the evaluation. Throws NotTraceable if that is not possible.
  void trace(double t, const double* y, std::span<const double> time_inputs, double least_pivot, TracedRates& traced) {
    e_.t = t;
    traced.calls.clear();
    calls_ = &traced.calls;
    take_inputs(y, time_inputs);
    place();
    load_rows();
    apply_forces();
    accelerate();
    solve_rows(least_pivot);
    find_power();
    evaluate_friction_events();
    put_out(traced);
    TapeNumber::end_usual_outputs();
    put_out_wrenches(traced);
    put_out_pivots(traced);
  }

private:
  ElementCall& call_element() { return *calls_->emplace_back(std::make_unique<ElementCall>(system_, live_)); }

  // Records a friction element, with the arguments of FrictionElement::record_friction().
  void record_friction(int f, const TapeNumber* rate, TapeNumber* wrench) {
    const FrictionUnit& unit = system_.frictions[f];
    TapeNumber* const event_value = &watch_[unit.first_event];
    if (!unit.friction->record_friction(e_, state_.friction[f], rate, wrench, event_value))
      call_element().trace(f, e_, rate, wrench, event_value);
  }

  [[nodiscard]] std::size_t coordinate_count() const { return static_cast<std::size_t>(layout_.coordinate_count); }

  [[nodiscard]] std::size_t absolute_count() const { return static_cast<std::size_t>(layout_.absolute_count); }

  void take_inputs(const double* y, std::span<const double> time_inputs) {
    const std::size_t n = coordinate_count();
    for (std::size_t i = 0; i < n; ++i) q_.push_back(TapeNumber::input(y[i]));
    for (std::size_t i = 0; i < n; ++i) v_.push_back(TapeNumber::input(y[n + i]));
    for (std::size_t i = 0; i < inner_rate_.size(); ++i) inner_.push_back(TapeNumber::input(y[2 * n + i]));
    e_.inner = inner_.data();
    e_.inner_rate = inner_rate_.data();
    for (const double x : time_inputs) time_.push_back(TapeNumber::input(x));
    first_inputs_ = static_cast<std::int32_t>(2 * n + inner_rate_.size());
  }
  [[nodiscard]] auto target_of_lock() const {
    return [this](std::size_t lock) {
      const TapeNumber* const of_lock = time_.data() + k_of_lock * lock;
      return LockTarget{of_lock[0], of_lock[1], of_lock[2]};
    };
  }
  [[nodiscard]] const TapeNumber* of_driven_row(std::size_t i) const {
    return time_.data() + k_of_lock * layout_.locks.size() + k_of_driven_row * i;
  }

  void place() {
    for (const Mechanism& m : layout_.mechanisms) {
      const auto first = static_cast<std::size_t>(m.first_coordinate);
      mechanisms_.emplace_back(m).place(&q_[first], &v_[first], motion_.data());
    }
    place_all(layout_, q_.data(), v_.data(), target_of_lock(), motion_.data());
  }

  // Records gradients and γ of all rows. The parts of rows over more than two bodies follow all rows.
  void load_rows() {
    for (const SchurRow& known : layout_.schur_rows) {
      SchurRowOf<TapeNumber>& row = rows_.emplace_back();
      row.is_constant = known.is_constant;
      for (int side = 0; side < 2; ++side) {
        row.body[side] = known.body[side];
        for (int c = 0; c < 3; ++c) {
          row.w[side][c] = known.w[side][c];
          if (!known.is_constant) continue;
          row.j[side][c] = known.j[side][c];
          row.wj[side][c] = known.wj[side][c];
        }
      }
    }
    multiplier_.resize(layout_.active.size());
    pull_rows(layout_, 0, layout_.active.size(), motion_.data(), rows_.data(), multiplier_.data());
    pull_parts(layout_, motion_.data(), rows_.data(), multiplier_.data());
  }

  void apply_forces() {
    for (const auto& group : system_.groups)
      if (!group->record_forces(e_)) call_element().trace(*group, e_);
    for (std::size_t i = 0; i < layout_.sliding.size(); ++i) apply_sliding(layout_.sliding[i], layout_.sliding_link[i]);
    gather_forces(layout_, motion_.data(), force_.data());
  }

  void apply_sliding(int f, int link) {
    const FrictionUnit& unit = system_.frictions[f];
    const SlidingRows<TapeNumber> rows(unit.friction->rows(state_.friction[f]), unit.friction->dimension(), motion_[link]);
    TapeNumber wrench[3];
    record_friction(f, rows.rate, wrench);
    rows.pull(wrench, force_[link], e_.dissipation);
  }

  void accelerate() {
    a_.resize(coordinate_count());
    accelerate_clusters(layout_, force_.data(), target_of_lock(), a_.data());
  }

  void solve_rows(double least_pivot) {
    const auto of_absolute = static_cast<std::size_t>(layout_.schur.size());
    take_accelerations(rows_.data(), 0, of_absolute, a_.data(), multiplier_.data());
    subtract_part_accelerations(layout_, rows_.data(), a_.data(), multiplier_.data());
    for (TracedMechanism& m : mechanisms_) accelerate(m);
    for (std::size_t i = 0; i < layout_.driven_rows.size(); ++i) multiplier_[layout_.driven_rows[i]] += of_driven_row(i)[0];
    if (rows_.empty()) return;
    for (TracedMechanism& m : mechanisms_) {
      const Mechanism& of = m.constants();
      if (of.row_count > 0)
        m.solve_rows(&rows_[static_cast<std::size_t>(of.first_row)], least_pivot, &multiplier_[static_cast<std::size_t>(of.first_row)],
                     &a_[static_cast<std::size_t>(of.first_coordinate)], pivots_.emplace_back());
    }
    if (of_absolute == 0) return;
    layout_.schur.trace(rows_, least_pivot, multiplier_.data(), pivots_.emplace_back());
    add_responses(rows_.data(), of_absolute, multiplier_.data(), a_.data());
    add_part_responses(layout_, rows_.data(), multiplier_.data(), a_.data());
  }

  // Records the accelerations of a mechanism without its rows, and γ − J a of its rows.
  void accelerate(TracedMechanism& m) {
    const Mechanism& of = m.constants();
    TapeNumber* const s = &a_[static_cast<std::size_t>(of.first_coordinate)];
    m.accelerate(force_.data(), s);
    if (of.row_count == 0) return;
    m.expand(s, cluster_a_.data());
    const auto first = static_cast<std::size_t>(of.first_row);
    take_accelerations(rows_.data(), first, first + static_cast<std::size_t>(of.row_count), cluster_a_.data(), multiplier_.data());
  }

  void find_power() {
    const auto row_rate = [this](std::size_t i) { return of_driven_row(i)[1]; };
    add_power_of_drives(layout_, force_.data(), rows_.data(), multiplier_.data(), a_.data(), row_rate, target_of_lock(), e_.work);
  }

  void evaluate_friction_events() {
    for (const HeldRow& held : layout_.held_rows) friction_force_[held.friction_row] = multiplier_[held.row];
    for (const int f : layout_.holding) {
      const FrictionUnit& unit = system_.frictions[f];
      record_friction(f, nullptr, &friction_force_[unit.row]);
    }
  }

  // Clears the result and reserves the capacity that most layouts need; otherwise each vector would be reallocated five times.
  void clear(TracedRates& traced) {
    traced.outputs.clear();
    traced.tape.places.clear();
    traced.event_values.clear();
    traced.event_derivatives.clear();
    traced.inputs.clear();
    const std::size_t rates = a_.size() + inner_rate_.size() + 2, most = rates + 2 * watch_.size() + 3 * layout_.merged.size();
    traced.outputs.reserve(most);
    traced.tape.places.reserve(most);
    traced.event_values.reserve(watch_.size());
    traced.inputs.reserve(q_.size() + v_.size() + inner_.size() + time_.size() + e_.time_inputs.size());
  }

  void put_out(TracedRates& traced) {
    clear(traced);
    for (const auto* rates : {&a_, &inner_rate_})
      for (const TapeNumber& rate : *rates) put_next(rate, 0, traced);
    put_next(e_.dissipation, 0, traced);
    put_next(e_.work, 0, traced);
    for (std::size_t i = 0; i < watch_.size(); ++i) {
      if (watch_[i].is_constant()) continue; // constants keep the values that the evaluation before has written
      traced.event_values.push_back(static_cast<int>(i));
      put_out(watch_[i], {TracedRates::k_event_count, static_cast<std::int32_t>(i)}, traced);
    }
    for (std::size_t i = 0; i < event_derivative_.size(); ++i) {
      if (event_derivative_[i].is_constant()) continue;
      traced.event_derivatives.push_back(static_cast<int>(i));
      put_out(event_derivative_[i], {TracedRates::k_event_derivatives, static_cast<std::int32_t>(i)}, traced);
    }
    traced.tape.first_inputs = first_inputs_;
    traced.signals = e_.time_inputs;
    for (const auto* given : {&q_, &v_, &inner_, &time_})
      for (const TapeNumber& x : *given) traced.inputs.push_back(value_of(x));
    for (const SignalInput& signal : e_.time_inputs) traced.inputs.push_back(signal.at(e_.t));
  }

  // Makes the wrenches in joints inside clusters outputs if event functions depend on them; the operations are those of
  // Reactions::find_joints().
  void put_out_wrenches(TracedRates& traced) {
    traced.wrenches.clear();
    traced.has_wrenches = !layout_.is_carried_by_pins; // pin forces are not recorded
    if (!traced.has_wrenches || !layout_.has_rigid_joint_events) return;
    lack_.assign(system_.bodies.size(), {});
    find_lacks(system_, layout_, motion_.data(), force_.data(), cluster_accelerations(), multiplier_.data(), lack_.data());
    compute_edge_geometry(system_, layout_, state_, edges_);
    hand_on_lack(layout_, edges_, lack_.data(), [&](const RigidEdge& edge, const TapeNumber* along) {
      if (edge.friction < 0 || system_.frictions[edge.friction].friction->never_slips()) return;
      for (int r = 0; r < 3; ++r) {
        traced.wrenches.push_back(system_.frictions[edge.friction].row + r);
        put_next(along[r], TracedRates::k_rest, traced);
      }
    });
  }

  [[nodiscard]] const TapeNumber* cluster_accelerations() {
    if (mechanisms_.empty()) return a_.data();
    std::copy_n(a_.begin(), 3 * absolute_count(), cluster_a_.begin());
    for (TracedMechanism& m : mechanisms_) m.expand(&a_[static_cast<std::size_t>(m.constants().first_coordinate)], cluster_a_.data());
    return cluster_a_.data();
  }

  void put_out_pivots(TracedRates& traced) {
    traced.pivots.clear();
    for (const std::vector<TracedPivot>& of_solver : pivots_) {
      traced.pivots.push_back(static_cast<int>(of_solver.size()));
      for (const TracedPivot& p : of_solver) {
        put_next(p.pivot, TracedRates::k_rest, traced);
        put_next(p.diagonal, TracedRates::k_rest, traced);
      }
    }
  }

  static void put_out(const TapeNumber& x, OutputLocation place, TracedRates& traced) {
    TapeNumber::output(x);
    traced.outputs.push_back(value_of(x));
    traced.tape.places.push_back(place);
  }

  // Records x as the next output in the array with this number.
  void put_next(const TapeNumber& x, std::int32_t array, TracedRates& traced) { put_out(x, {array, put_[array == 0 ? 0 : 1]++}, traced); }

  const System& system_;
  const Layout& layout_;
  const State& state_;
  const Evaluation& live_;
  std::vector<std::unique_ptr<ElementCall>>* calls_ = nullptr; ///< calls made in this trace
  std::vector<TracedMechanism> mechanisms_;
  std::vector<std::vector<TracedPivot>> pivots_; ///< pivots of each solver
  std::int32_t put_[2] = {0, 0};                 ///< number of outputs so far in the first array and in the rest
  std::int32_t first_inputs_ = 0;                ///< number of coordinates, rates and inner states
  TracedEvaluation e_;
};

} // namespace

std::size_t time_input_count(const Layout& layout) { return k_of_lock * layout.locks.size() + k_of_driven_row * layout.driven_rows.size(); }

bool trace_rates(const System& system, const Layout& layout, const State& state, const Evaluation& live, double t, const double* y,
                 std::span<const double> time_inputs, double least_pivot, TracedRates& traced, const Tape* known) {
  if (!is_plain(layout)) return false;
  TapeNumber::start(known);
  try {
    Tracer(system, layout, state, live).trace(t, y, time_inputs, least_pivot, traced);
  } catch (const NotTraceable&) {
    (void)TapeNumber::finish(nullptr);
    return false;
  }
  const bool is_known = TapeNumber::finish(&traced.tape);
  return is_known && (!known || (traced.tape.first_inputs == known->first_inputs && traced.tape.places == known->places));
}

} // namespace steplap
