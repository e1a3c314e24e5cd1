#include "mbd/events/blow.h"

#include "mbd/base/shown_text.h"
#include "mbd/events/box_problem.h"
#include "mbd/events/rest_rate.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/one_way_lock.h"

#include <cmath>
#include <utility>

namespace steplap {

namespace {

constexpr double k_projection_tolerance = 1e-12; // largest remaining constraint error, m, rad
// Ropes within this distance of their length, relative to the length, take part in an impact even if they do not lengthen before it. A gap
// of this size is rounding.
constexpr double k_same_length = 1e-9;
constexpr double k_rounded_share = 1e-13;
// A rope that would be slack for a distance smaller than this, relative to its length, after an impact stays taut if its tension allows.
// Otherwise two ropes that become taut alternately would come to rest only after infinitely many ever smaller impacts.
constexpr double k_shortest_flight = 1e-9;

double rest_rate(const OneSidedRow& rope, const std::vector<Motion<double>>& motion) {
  return k_rest_velocity + k_rest_share * rope.speed(motion.data());
}

// Elements that may take part in an impact, with lower and upper bounds of their impulses.
struct ImpactElements {
  std::vector<int> elements;
  std::vector<double> rate, rounding, lower, upper;
  std::vector<double> acceleration; ///< relative acceleration of each row without any of these elements

  // refuses: sign of the rate that the element prevents; its impulse has the opposite sign
  void add(int f, double at_rate, double rounding_of_it, int refuses) {
    constexpr double k_any = std::numeric_limits<double>::infinity();
    elements.push_back(f);
    rate.push_back(at_rate);
    rounding.push_back(rounding_of_it);
    lower.push_back(refuses > 0 ? -k_any : 0.0);
    upper.push_back(refuses > 0 ? 0.0 : k_any);
  }
};

struct LockRate {
  int refuses = 0;
  double rate = 0.0, rounding = 0.0, rest = 0.0; ///< rad/s; rounding: error of the rate; rest: largest rate that counts as zero
  [[nodiscard]] bool is_against() const { return refuses * rate > rest; }
};

LockRate rate_of(const OneWayLock& lock, const FrictionState& friction, const std::vector<Motion<double>>& motion) {
  const RowSpec& row = *lock.rows(friction);
  const auto m = evaluate_row<false>(row, motion.data());
  const double speed = point_speed(motion[row.a], m.lever_a, m.couple) + point_speed(motion[row.b], m.lever_b, m.couple);
  return {lock.refuses(), m.rate, k_rest_velocity + k_rounded_share * speed, rest_rate(row, m, motion.data())};
}

// Returns the ropes that are at their length, and all clutches, because an impact may turn any of them against its lock. Returns no
// elements if no rope is at its length and no clutch turns against its lock.
ImpactElements struck_in(const System& system, const State& state) {
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  ImpactElements struck;
  bool is_any_rope = false;
  for (std::size_t f = 0; f < system.frictions.size(); ++f) {
    if (const OneWayLock* const lock = one_way_lock(system.frictions[f])) {
      const LockRate now = rate_of(*lock, state.friction[f], motion);
      struck.add(static_cast<int>(f), now.rate, now.rounding, now.refuses);
    }
    const OneSidedRow* const rope = system.frictions[f].rope;
    if (!rope) continue;
    const auto m = rope->measured(motion.data());
    const bool is_reached = rope->length - m.value <= k_same_length * rope->length;
    if (state.friction[f].phase != FrictionPhase::stick && !is_reached) continue;
    struck.add(static_cast<int>(f), m.rate, k_rest_velocity + k_rounded_share * rope->speed(motion.data()), 1);
    is_any_rope = true;
  }
  return is_any_rope || turns_against_lock(system, state) ? struck : ImpactElements{};
}

BoxSolution impulses_of(const System& system, Dynamics& dynamics, const State& loose, ImpactElements& struck) {
  std::vector<double> y(static_cast<std::size_t>(system.largest_dimension())), dy(y.size());
  dynamics.set_state(loose);
  dynamics.pack(loose, y.data());
  dynamics.rates(loose.t, y.data(), dy.data());
  Dynamics::ModeProblem answer;
  for (const int f : struck.elements) answer.rows.push_back(system.frictions[f].friction->rows(loose.friction[f]));
  dynamics.compute_mode_problem(answer, dy.data());
  struck.acceleration = answer.acceleration;
  const auto n = static_cast<Eigen::Index>(struck.elements.size());
  const MatX a = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(answer.compliance.data(), n, n);
  const VecX u = Eigen::Map<const VecX>(struck.rate.data(), n), rounding = Eigen::Map<const VecX>(struck.rounding.data(), n);
  const VecX lower = Eigen::Map<const VecX>(struck.lower.data(), n), upper = Eigen::Map<const VecX>(struck.upper.data(), n);
  BoxSolution solution = solve_box_problem(a, u, lower, upper, rounding);
  if (solution.is_solved) return solution;
  throw ElementFailure("at t = " + rounded_text(loose.t, 12) + " s it cannot be decided which ropes and one-way clutches take the blow",
                       {system.element_names[system.frictions[struck.elements.front()].element]});
}

// Projects positions and velocities onto all rows that are constraints in the modes of `state`.
void meet(Dynamics& dynamics, State& state) {
  std::vector<double> y(static_cast<std::size_t>(dynamics.system().largest_dimension()));
  dynamics.set_state(state);
  dynamics.pack(state, y.data());
  dynamics.project(state.t, y.data(), k_projection_tolerance);
  dynamics.project_velocities(state.t, y.data());
  dynamics.unpack(state.t, y.data(), state);
}

bool is_any_driven(const System& system) {
  for (const RowSpec& row : system.rows)
    if (row.drive) return true;
  return false;
}

// Locks a clutch that took an impulse (phase stick, at its present angle in `after`), and records the impulse in `state`.
void note_lock(const OneWayLock& lock, int f, double impulse, double rate, State& state, State& after) {
  if (!(std::abs(impulse) > 0.0)) return;
  Impact& impact = state.impacts[lock.impact];
  impact.impulse = std::abs(impulse);
  impact.lost -= 0.5 * impulse * rate;
  FrictionState& friction = after.friction[static_cast<std::size_t>(f)];
  friction.phase = FrictionPhase::stick;
  std::vector<Motion<double>> motion;
  place_bodies(after.q, after.v, motion);
  const RowSpec& row = *lock.rows(friction);
  after.bases[row.base].value = evaluate_row<false>(row, motion.data()).value;
}

// Throws if joints and drives turn a clutch against its lock. Their motion is prescribed, so no impulse can prevent that.
void check_locks(const System& system, const State& state) {
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  for (std::size_t f = 0; f < system.frictions.size(); ++f) {
    const OneWayLock* const lock = one_way_lock(system.frictions[f]);
    if (!lock || !rate_of(*lock, state.friction[f], motion).is_against()) continue;
    const std::string& name = system.element_names[system.frictions[f].element];
    throw ElementFailure("at t = " + rounded_text(state.t, 12) + " s drives turn the bodies of the one-way clutch '" + name +
                             "' against its lock, and no blow can join them: turn 'free' round, give it 'holds', or drive one of them only",
                         {name});
  }
}

// Sets friction to phase free, because its impulse in an impact is zero.
void free_friction(const System& system, State& state) {
  for (std::size_t f = 0; f < system.frictions.size(); ++f)
    if (!system.frictions[f].friction->never_slips() && state.friction[f].phase != FrictionPhase::apart)
      state.friction[f].phase = FrictionPhase::free;
}

// Adds dissipation and work of the impact that leads to `after`. With moving drives the dissipation is the kinetic energy of the velocity
// change, otherwise the loss of kinetic energy.
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
    state.impacts[rope->impact] = {};
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

bool turns_against_lock(const System& system, const State& state) {
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  for (std::size_t f = 0; f < system.frictions.size(); ++f)
    if (const OneWayLock* const lock = one_way_lock(system.frictions[f]); lock && rate_of(*lock, state.friction[f], motion).is_against())
      return true;
  return false;
}

void apply_impact(const System& system, Dynamics& dynamics, State& state) {
  ImpactElements struck = struck_in(system, state);
  if (struck.elements.empty()) return;
  State after = state;
  free_friction(system, after);
  for (const int f : struck.elements)
    if (system.frictions[f].rope) after.friction[f].phase = FrictionPhase::slip;
  const BoxSolution solution = impulses_of(system, dynamics, after, struck);
  for (std::size_t i = 0; i < struck.elements.size(); ++i) {
    const int f = struck.elements[i];
    const auto at = static_cast<Eigen::Index>(i);
    if (const OneWayLock* const lock = one_way_lock(system.frictions[f])) {
      note_lock(*lock, f, solution.w[at], struck.rate[i], state, after);
      continue;
    }
    FrictionState& friction = after.friction[f];
    const OneSidedRow& rope = *system.frictions[f].rope;
    const double left_with = solution.g[at];
    const bool hardly_leaves = left_with * left_with <= 2.0 * k_shortest_flight * rope.length * std::abs(struck.acceleration[i]);
    friction.phase = solution.is_free[i] != 0 || hardly_leaves ? FrictionPhase::stick : FrictionPhase::slip;
    friction.sign = 0;
    const double impulse = -solution.w[at];
    if (!(impulse > 0.0)) continue;
    Impact& impact = state.impacts[rope.impact];
    impact.impulse = impulse;
    impact.lost += 0.5 * impulse * std::max(struck.rate[i], 0.0);
  }
  meet(dynamics, after);
  check_locks(system, after);
  book_blow(system, is_any_driven(system), after, state);
  for (const int f : struck.elements)
    if (system.frictions[f].rope) state.friction[f] = after.friction[f];
}

void close_rows(const System& system, Dynamics& dynamics, State& state) {
  State after = state;
  free_friction(system, after);
  for (const OneSidedUnit& rope : one_sided_rows(system)) after.friction[rope.friction].phase = FrictionPhase::slip;
  meet(dynamics, after);
  book_blow(system, true, after, state);
}

bool had_impact(const System& system, std::size_t f, const std::vector<Impact>& before, const State& state) {
  const int impact = impact_index(system.frictions[f]);
  return impact >= 0 && before[impact].lost != state.impacts[impact].lost;
}

std::string impact_text(const System& system, std::size_t f, const std::vector<Impact>& before, const State& state) {
  if (!had_impact(system, f, before, state)) return {};
  const FrictionUnit& unit = system.frictions[f];
  const int impact = impact_index(unit);
  return "with " + rounded_text(state.impacts[impact].impulse, 4) + (unit.rope ? " N s, " : " N m s, ") +
         rounded_text(state.impacts[impact].lost - before[impact].lost, 4) + " J lost";
}

} // namespace steplap
