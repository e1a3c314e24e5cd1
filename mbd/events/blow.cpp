#include "mbd/events/blow.h"

#include "mbd/base/shown_text.h"
#include "mbd/friction/box_problem.h"
#include "mbd/system/element_failure.h"

#include <cmath>
#include <utility>

namespace steplap {

namespace {

constexpr double k_projection_tolerance = 1e-12; // m, rad
constexpr double k_rest_velocity = 1e-12;        // m/s: far above the rounding of a projected one
constexpr double k_rest_share = 1e-9;            // of the velocities that make up a rate
// Ropes that are this near to their lengths, of these, share a blow, whether or not they lengthen before it: as far as a
// flight that is none.
constexpr double k_same_length = 1e-9;
constexpr double k_rounded_share = 1e-13;
// Of its length: a taut rope that would leave it by no more than this before it is pulled back stays taut, if its tension lets
// it. Two ropes that are caught in turn, each blow shortening the other, would else come to rest after infinitely many ever
// smaller blows; and no nearer than the dead band, which gives each flight a little speed.
constexpr double k_shortest_flight = 1e-9;

double rest_rate(const OneSidedRow& rope, const std::vector<Motion<double>>& motion) {
  return k_rest_velocity + k_rest_share * rope.speed(motion.data());
}

struct Struck {
  std::vector<OneSidedUnit> ropes;
  std::vector<double> rate, rounding;
  std::vector<double> acceleration; ///< with all of them slack
};

// Those that can take a part in the blow.
Struck ropes_at_length(const System& system, const State& state) {
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  Struck struck;
  for (const OneSidedUnit& unit : one_sided_rows(system)) {
    const OneSidedRow& rope = *unit.row;
    const auto m = rope.measured(motion.data());
    const bool is_reached = rope.length - m.value <= k_same_length * rope.length;
    if (state.friction[unit.friction].phase != FrictionPhase::stick && !is_reached) continue;
    struck.ropes.push_back(unit);
    struck.rate.push_back(m.rate);
    struck.rounding.push_back(k_rest_velocity + k_rounded_share * rope.speed(motion.data()));
  }
  return struck;
}

BoxSolution impulses_of(const System& system, Dynamics& dynamics, const State& loose, Struck& struck) {
  std::vector<double> y(static_cast<std::size_t>(system.largest_dimension())), dy(y.size());
  dynamics.set_state(loose);
  dynamics.pack(loose, y.data());
  dynamics.rates(loose.t, y.data(), dy.data());
  Dynamics::Candidates answer;
  for (const OneSidedUnit& rope : struck.ropes) answer.rows.push_back(&rope.row->row);
  dynamics.respond(answer, dy.data());
  struck.acceleration = answer.acceleration;
  const auto n = static_cast<Eigen::Index>(struck.ropes.size());
  const MatX a = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(answer.compliance.data(), n, n);
  const VecX u = Eigen::Map<const VecX>(struck.rate.data(), n), rounding = Eigen::Map<const VecX>(struck.rounding.data(), n);
  BoxSolution solution = solve_box_problem(a, u, VecX::Constant(n, -std::numeric_limits<double>::infinity()), VecX::Zero(n), rounding);
  if (solution.is_solved) return solution;
  throw ElementFailure("at t = " + rounded_text(loose.t, 12) + " s it cannot be decided which ropes take the blow",
                       {system.element_names[struck.ropes.front().row->row.element]});
}

// What holds in the modes of `state` is met by its places and velocities.
void meet(Dynamics& dynamics, State& state) {
  std::vector<double> y(static_cast<std::size_t>(dynamics.system().largest_dimension()));
  dynamics.set_state(state);
  dynamics.pack(state, y.data());
  dynamics.project(state.t, y.data(), k_projection_tolerance);
  dynamics.close_velocities(state.t, y.data());
  dynamics.unpack(state.t, y.data(), state);
}

bool is_any_driven(const System& system) {
  for (const RowSpec& row : system.rows)
    if (row.drive) return true;
  return false;
}

// What slips beyond a bound bears none of a blow.
void free_friction(const System& system, State& state) {
  for (std::size_t f = 0; f < system.frictions.size(); ++f)
    if (!system.frictions[f].friction->never_slips() && state.friction[f].phase != FrictionPhase::apart)
      state.friction[f].phase = FrictionPhase::free;
}

// Dissipation and work of a blow that leaves `after`: of the change of velocities where drives move, else what motion has lost.
void book_blow(const System& system, bool is_driven, State& after, State& state) {
  const double gained = system.kinetic_energy(after) - system.kinetic_energy(state);
  State jump = after;
  for (std::size_t i = 0; i < jump.v.size(); ++i) jump.v[i] -= state.v[i];
  const double lost = is_driven ? system.kinetic_energy(jump) : -gained;
  state.dissipated += lost;
  state.work += gained + lost;
  state.q = std::move(after.q);
  state.v = std::move(after.v);
}

} // namespace

bool set_ropes(const System& system, State& state) {
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  bool is_any_pulled = false;
  for (const auto& [rope, f] : one_sided_rows(system)) {
    FrictionState& friction = state.friction[f];
    state.memory[rope->blow] = state.memory[rope->blow + 1] = 0.0;
    const auto m = rope->measured(motion.data());
    if (m.value > rope->length * (1.0 + OneSidedRow::k_too_long)) {
      const std::string& name = system.element_names[rope->row.element];
      throw ElementFailure("the ends of rope '" + name + "' are " + rounded_text(m.value - rope->length, 4) +
                               " m farther apart at the start than its length lets them be",
                           {name});
    }
    const double rest = rest_rate(*rope, motion);
    const bool is_at_length = m.value >= rope->length * (1.0 - OneSidedRow::k_at_length);
    friction = {};
    friction.phase = is_at_length && m.rate >= -rest ? FrictionPhase::stick : FrictionPhase::slip;
    is_any_pulled = is_any_pulled || (is_at_length && m.rate > rest);
  }
  return is_any_pulled;
}

void take_blow(const System& system, Dynamics& dynamics, State& state) {
  Struck struck = ropes_at_length(system, state);
  if (struck.ropes.empty()) return;
  State after = state;
  free_friction(system, after);
  for (const OneSidedUnit& rope : struck.ropes) after.friction[rope.friction].phase = FrictionPhase::slip;
  const BoxSolution solution = impulses_of(system, dynamics, after, struck);
  for (std::size_t i = 0; i < struck.ropes.size(); ++i) {
    const OneSidedRow& rope = *struck.ropes[i].row;
    FrictionState& friction = after.friction[struck.ropes[i].friction];
    const double left_with = solution.g[static_cast<Eigen::Index>(i)];
    const bool hardly_leaves = left_with * left_with <= 2.0 * k_shortest_flight * rope.length * std::abs(struck.acceleration[i]);
    friction.phase = solution.is_free[i] != 0 || hardly_leaves ? FrictionPhase::stick : FrictionPhase::slip;
    friction.sign = 0;
    const double impulse = -solution.w[static_cast<Eigen::Index>(i)];
    if (!(impulse > 0.0)) continue;
    state.memory[rope.blow] = impulse;
    state.memory[rope.blow + 1] += 0.5 * impulse * std::max(struck.rate[i], 0.0);
  }
  meet(dynamics, after);
  book_blow(system, is_any_driven(system), after, state);
  for (const OneSidedUnit& rope : struck.ropes) state.friction[rope.friction] = after.friction[rope.friction];
}

void close_rows(const System& system, Dynamics& dynamics, State& state) {
  State after = state;
  free_friction(system, after);
  for (const OneSidedUnit& rope : one_sided_rows(system)) after.friction[rope.friction].phase = FrictionPhase::slip;
  meet(dynamics, after);
  book_blow(system, true, after, state);
}

bool was_struck(const OneSidedRow& rope, const std::vector<double>& before, const State& state) {
  return before[rope.blow + 1] != state.memory[rope.blow + 1];
}

std::string blow_text(const OneSidedRow& rope, const std::vector<double>& before, const State& state) {
  if (!was_struck(rope, before, state)) return {};
  const double impulse = state.memory[rope.blow], lost = state.memory[rope.blow + 1] - before[rope.blow + 1];
  return "with " + rounded_text(impulse, 4) + " N s, " + rounded_text(lost, 4) + " J lost";
}

} // namespace steplap
