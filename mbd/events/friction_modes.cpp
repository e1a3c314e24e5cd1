#include "mbd/events/friction_modes.h"

#include "mbd/base/shown_text.h"
#include "mbd/events/anchor.h"
#include "mbd/events/box_problem.h"
#include "mbd/events/rest_rate.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/one_sided_row.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr int k_max_sweeps = 20000;
// Relative change below which wrenches have converged to rounding. The remaining error is determined by the conditioning of A.
constexpr double k_settled = 1e-15;
// Blocks of three-dimensional elements are solved only to about 1e-11, and sweeps fluctuate at that level. Sweeps therefore also end after
// this many without a smaller change, if the change is below k_small_change.
constexpr int k_stalled_sweeps = 20;
constexpr double k_small_change = 1e-9;
// Relative velocity, m/s, that counts as rest if an event or a drive stops several elements at once. It covers the rounding of the event
// time and the error of the projection.
constexpr double k_rest_at_event = 1e-11;
// Accelerations have converged if one more sweep changes them by less than this, relative to their terms.
constexpr double k_settled_acceleration = 1e-7;
// Elements of a group (LoadSharing) rejoin only if the group's second event function is above this value. It is 1 if the rows are exactly
// compatible. At a limit of zero, rows that begin to separate would be held and released endlessly by rounding.
constexpr double k_surely_together = 0.5;
// Factor on the residual rate with which an element came to rest. It covers the error of rows that depend on the element.
constexpr double k_rest_error = 2.0;

// Dual problem for a set of candidates (friction_modes.h). If all are one-dimensional, an active-set method gives the exact solution
// (box_problem.h). Otherwise block Gauss–Seidel solves each element's block exactly in turn; this converges for every positive semidefinite
// A. The accelerations are unique even if the wrenches are not.
class DualProblem {
public:
  DualProblem(const System& system, const State& state, const std::vector<int>& elements, const Evaluation& evaluation,
              const Dynamics::ModeProblem& candidates)
      : system_(system), state_(state), elements_(elements), evaluation_(evaluation), candidates_(candidates), n_(candidates.rows.size()),
        wrench_(n_, 0.0), blocks_(elements.size()), is_kinetic_(elements.size(), 0) {
    for (const int f : elements) is_flat_ = is_flat_ && system.frictions[f].bounded;
  }

  // Solves with μ_s first; slipping elements then get μ_k and the problem is solved again. The slipping set only grows (theory.md §3).
  const std::vector<BlockSolution>& solve() {
    for (std::size_t pass = 0; pass <= elements_.size(); ++pass) {
      if (is_flat_) solve_flat();
      else sweep_until_settled();
      bool is_changed = false;
      for (std::size_t e = 0; e < elements_.size(); ++e)
        if (!blocks_[e].sticks && !is_kinetic_[e]) is_kinetic_[e] = is_changed = true;
      if (!is_changed) break;
    }
    return blocks_;
  }

private:
  void solve_flat() {
    const auto n = static_cast<Eigen::Index>(n_);
    MatX a(n, n);
    VecX b(n), lower(n), upper(n), rounding(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      b[i] = candidates_.acceleration[i];
      rounding[i] = candidates_.rounding[i];
      const int f = elements_[i];
      const WrenchBounds bounds = system_.frictions[f].bounded->bounds(evaluation_, state_.friction[f], is_kinetic_[i] != 0);
      lower[i] = bounds.low;
      upper[i] = bounds.high;
      for (Eigen::Index j = 0; j < n; ++j) a(i, j) = candidates_.compliance[i * n + j];
    }
    const BoxSolution solution = solve_box_problem(a, b, lower, upper, rounding);
    if (!solution.is_solved) return sweep_until_settled(); // rounding made the active sets repeat
    for (Eigen::Index i = 0; i < n; ++i) {
      BlockSolution& block = blocks_[i];
      block = {};
      block.wrench[0] = solution.w[i];
      block.sticks = solution.is_free[i] != 0;
      block.direction[0] = solution.g[i] > 0.0 ? 1.0 : -1.0;
    }
  }

  [[nodiscard]] BlockSolution block_of(std::size_t e, const double* a, const double* b) const {
    return system_.frictions[elements_[e]].friction->solve_block(evaluation_, state_.friction[elements_[e]], a, b, is_kinetic_[e] != 0);
  }

  [[noreturn]] void fail(const std::string& why) const {
    std::string message = "which friction sticks cannot be decided at t = " + rounded_text(state_.t, 12) + " s (" + why + "):";
    std::vector<std::string> names;
    for (const int f : elements_) {
      names.push_back(system_.element_names[system_.frictions[f].element]);
      message += " '" + names.back() + "'";
    }
    throw ElementFailure(message + ". Give feet of one pair of bodies a common coulomb_stick, or check their normal forces",
                         std::move(names));
  }

  void sweep_until_settled() {
    double least = std::numeric_limits<double>::infinity();
    int stalled = 0;
    for (int sweep = 0; sweep < k_max_sweeps; ++sweep) {
      double change = 0.0, size = 0.0;
      std::size_t row = 0;
      for (std::size_t e = 0; e < elements_.size(); ++e) {
        const FrictionElement& friction = *system_.frictions[elements_[e]].friction;
        const std::size_t m = friction.dimension();
        solve_element(e, row, m, change, size);
        row += m;
      }
      if (change <= k_settled * size || elements_.size() == 1) return;
      stalled = change < least ? 0 : stalled + 1;
      least = std::min(least, change);
      if (stalled >= k_stalled_sweeps && least <= k_small_change * size) return;
    }
    // If wrenches are not unique they may change endlessly although the accelerations have converged, so one more sweep tests the
    // accelerations.
    const std::vector<double> before = wrench_;
    double change = 0.0, size = 0.0;
    std::size_t row = 0;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      const FrictionElement& friction = *system_.frictions[elements_[e]].friction;
      solve_element(e, row, friction.dimension(), change, size);
      row += friction.dimension();
    }
    for (std::size_t i = 0; i < n_; ++i) {
      double moved = 0.0, terms = std::abs(candidates_.acceleration[i]);
      for (std::size_t j = 0; j < n_; ++j) {
        moved += candidates_.compliance[i * n_ + j] * (wrench_[j] - before[j]);
        terms += std::abs(candidates_.compliance[i * n_ + j] * wrench_[j]);
      }
      if (std::abs(moved) > k_settled_acceleration * terms) fail("accelerations do not settle");
    }
  }

  void solve_element(std::size_t e, std::size_t row, std::size_t m, double& change, double& size) {
    double a[9], b[3];
    for (std::size_t i = 0; i < m; ++i) {
      b[i] = candidates_.acceleration[row + i];
      for (std::size_t j = 0; j < n_; ++j)
        if (j < row || j >= row + m) b[i] += candidates_.compliance[(row + i) * n_ + j] * wrench_[j];
      for (std::size_t j = 0; j < m; ++j) a[i * m + j] = candidates_.compliance[(row + i) * n_ + row + j];
    }
    blocks_[e] = block_of(e, a, b);
    for (std::size_t i = 0; i < m; ++i) {
      change = std::max(change, std::abs(blocks_[e].wrench[i] - wrench_[row + i]));
      size = std::max(size, std::abs(blocks_[e].wrench[i]));
      wrench_[row + i] = blocks_[e].wrench[i];
    }
  }

  const System& system_;
  const State& state_;
  const std::vector<int>& elements_;
  const Evaluation& evaluation_;
  const Dynamics::ModeProblem& candidates_;
  std::size_t n_;
  std::vector<double> wrench_;
  std::vector<BlockSolution> blocks_;
  std::vector<char> is_kinetic_;
  bool is_flat_ = true; ///< all elements are one-dimensional
};

// Releases one rope with negative tension (other ropes carry its load). Returns true if there was one.
bool slacken_idle(const System& system, const Dynamics& dynamics, State& state) {
  for (const auto& [rope, f] : one_sided_rows(system)) {
    if (state.friction[f].phase != FrictionPhase::stick || dynamics.event_value()[system.frictions[f].slot(FrictionWatch::first)] >= 0.0)
      continue;
    state.friction[f].phase = FrictionPhase::slip;
    state.friction[f].sign = 0;
    return true;
  }
  return false;
}

} // namespace

FrictionModes::FrictionModes(const System& system, Dynamics& dynamics)
    : system_(system), dynamics_(dynamics), y_(static_cast<std::size_t>(system.largest_dimension())), dy_(y_.size()),
      rest_error_(system.frictions.size(), 0.0) {}

// Returns the error of the rate of element f at rest. In a group dependent rows are omitted from the equations, so they keep the residual
// rates of the other rows.
double FrictionModes::rest_error(int f) const {
  const LoadSharing* const sharing = dynamics_.sharing();
  const int group = sharing ? sharing->group_of(f) : -1;
  double error = rest_error_[f];
  if (group >= 0)
    for (const int other : sharing->groups()[group].frictions) error = std::max(error, rest_error_[other]);
  return k_rest_error * error;
}

void FrictionModes::set_anchor(State& state, int f) const {
  place_bodies(state.q, state.v, motion_);
  anchor_friction(system_, state, f, motion_.data());
}

// Adds the distance to the slid path; within one slip the direction is constant.
void FrictionModes::end_slip(State& state, int f) const {
  const RowSpec* rows = system_.frictions[f].friction->rows(state.friction[f]);
  const double before = rows[0].base >= 0 ? state.bases[rows[0].base].value : 0.0;
  set_anchor(state, f);
  if (rows[0].base >= 0) state.friction[f].slid += std::abs(state.bases[rows[0].base].value - before);
}

void FrictionModes::evaluate(const State& state) {
  dynamics_.set_state(state);
  dynamics_.pack(state, y_.data());
  dynamics_.rates(state.t, y_.data(), dy_.data());
  dynamics_.evaluate_rigid_joint_events(dy_.data());
  is_evaluated_ = true;
}

std::vector<int> FrictionModes::violated(const State& state) {
  evaluate(state);
  return sticking_beyond_bound(state);
}

// Returns the sticking elements with a negative event function at the last evaluation.
std::vector<int> FrictionModes::sticking_beyond_bound(const State& state) const {
  std::vector<int> result;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    if (state.friction[f].phase != FrictionPhase::stick) continue;
    const double* event_value = &dynamics_.event_value()[system_.frictions[f].first_event];
    if (event_value[0] < 0.0 || event_value[1] < 0.0) result.push_back(f);
  }
  return result;
}

// Solves the mode problem for the candidates, with the phases of all other elements unchanged, and sets the candidates' phases.
void FrictionModes::solve(State& state, const std::vector<int>& candidates) {
  for (const int f : candidates) state.friction[f].phase = FrictionPhase::free;
  dynamics_.set_state(state);
  dynamics_.pack(state, y_.data());
  dynamics_.rates(state.t, y_.data(), dy_.data());
  Dynamics::ModeProblem problem;
  for (const int f : candidates) {
    const FrictionElement& friction = *system_.frictions[f].friction;
    for (int r = 0; r < friction.dimension(); ++r) problem.rows.push_back(friction.rows(state.friction[f]) + r);
  }
  dynamics_.compute_mode_problem(problem, dy_.data());
  DualProblem dual(system_, state, candidates, dynamics_.evaluation(), problem);
  const std::vector<BlockSolution>& blocks = dual.solve();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    FrictionState& friction = state.friction[candidates[i]];
    friction.phase = blocks[i].sticks ? FrictionPhase::stick : FrictionPhase::slip;
    std::copy(blocks[i].direction, blocks[i].direction + 3, friction.direction);
    if (system_.frictions[candidates[i]].rope) {
      friction.sign = 0;
      continue;
    }
    friction.sign = blocks[i].direction[0] > 0.0 ? 1 : -1;
    friction.is_onset = !blocks[i].sticks;
    if (!blocks[i].sticks) friction.has_slipped = true;
  }
}

void FrictionModes::release(State& state, int group) const {
  for (const Release& r : dynamics_.sharing()->releases(group)) {
    FrictionState& friction = state.friction[r.friction];
    friction.phase = FrictionPhase::slip;
    friction.has_slipped = friction.is_onset = true;
    system_.frictions[r.friction].friction->set_onset_direction(dynamics_.evaluation(), friction, r.wrench);
  }
}

bool FrictionModes::release_overloaded(State& state) const {
  const LoadSharing* const sharing = dynamics_.sharing();
  if (!sharing) return false;
  bool is_any = false;
  for (std::size_t g = 0; g < sharing->groups().size(); ++g) {
    const int first = sharing->groups()[g].frictions.front();
    if (dynamics_.event_value()[system_.frictions[first].slot(FrictionWatch::first)] >= 0.0) continue;
    release(state, static_cast<int>(g));
    is_any = true;
  }
  return is_any;
}

bool FrictionModes::is_at_rest(const State& state, int f) const {
  const FrictionElement& friction = *system_.frictions[f].friction;
  const RowSpec* rows = friction.rows(state.friction[f]);
  place_bodies(state.q, state.v, motion_);
  const double error = rest_error(f);
  for (int r = 0; r < friction.dimension(); ++r) {
    const auto m = evaluate_row<false>(rows[r], motion_.data());
    if (std::abs(m.rate) > rest_rate(rows[r], m, motion_.data()) + error) return false;
  }
  return true;
}

bool FrictionModes::rejoin(State& state) {
  bool is_any = false;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    if (state.friction[f].phase != FrictionPhase::slip || system_.frictions[f].friction->never_slips() || !is_at_rest(state, f)) continue;
    State trial = state;
    end_slip(trial, f);
    trial.friction[f].phase = FrictionPhase::stick;
    (void)violated(trial);
    const LoadSharing* const sharing = dynamics_.sharing();
    const double* event_value = &dynamics_.event_value()[system_.frictions[f].first_event];
    const bool is_held = sharing && sharing->group_of(f) >= 0 && event_value[0] >= 0.0 && event_value[1] >= k_surely_together;
    if (is_held) std::swap(state, trial);
    dynamics_.set_state(state);
    is_any = is_any || is_held;
    is_evaluated_ = false;
  }
  return is_any;
}

bool FrictionModes::catch_reversals(State& state, const std::vector<FrictionState>& before) {
  std::vector<int> slow;
  bool is_placed = false;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    const FrictionElement& friction = *system_.frictions[f].friction;
    if (friction.dimension() != 1 || state.friction[f].phase != FrictionPhase::slip || before[f].phase != FrictionPhase::slip ||
        friction.never_slips())
      continue;
    if (!is_placed) place_bodies(state.q, state.v, motion_);
    is_placed = true;
    const double rate = evaluate_row<false>(*friction.rows(state.friction[f]), motion_.data()).rate;
    if (state.friction[f].sign * rate <= k_rest_at_event) slow.push_back(f);
  }
  if (slow.empty()) return false;
  is_evaluated_ = false;
  dynamics_.set_state(state);
  dynamics_.pack(state, y_.data());
  dynamics_.rates(state.t, y_.data(), dy_.data());
  bool is_any = false;
  for (const int f : slow) {
    double rate = 0.0, acceleration = 0.0, rounding = 0.0;
    dynamics_.relative_motion(f, dy_.data(), &rate, &acceleration, &rounding);
    if (state.friction[f].sign * acceleration > rounding) continue; // the element begins to slide
    end_slip(state, f);
    state.friction[f].phase = FrictionPhase::stick;
    is_any = true;
  }
  return is_any;
}

// Handles groups whose rows are no longer compatible: releases the elements that move, in the direction of their motion.
void FrictionModes::release_moving(State& state) {
  bool is_any = false;
  const LoadSharing* const sharing = dynamics_.sharing();
  if (!sharing) return;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    const bool is_discordant = state.friction[f].phase == FrictionPhase::stick && sharing->group_of(f) >= 0 &&
                               dynamics_.event_value()[system_.frictions[f].slot(FrictionWatch::second)] < 0.0;
    const FrictionElement& friction = *system_.frictions[f].friction;
    if (!is_discordant || friction.dimension() != 1) continue;
    if (is_at_rest(state, f)) continue;
    const double rate = evaluate_row<false>(*friction.rows(state.friction[f]), motion_.data()).rate;
    state.friction[f].phase = FrictionPhase::slip;
    state.friction[f].has_slipped = true;
    state.friction[f].is_onset = false;
    friction.aim(state.friction[f], &rate);
    is_any = true;
  }
  if (is_any) (void)violated(state);
}

// Handles groups whose rows are compatible but have drifted since they were anchored, by less than counts as motion: anchors the rows at
// the present pose.
void FrictionModes::anchor_resting(State& state) const {
  const LoadSharing* const sharing = dynamics_.sharing();
  if (!sharing) return;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    const bool is_discordant = state.friction[f].phase == FrictionPhase::stick && sharing->group_of(f) >= 0 &&
                               dynamics_.event_value()[system_.frictions[f].slot(FrictionWatch::second)] < 0.0;
    if (is_discordant && is_at_rest(state, f)) set_anchor(state, f);
  }
}

bool FrictionModes::decide(State& state) {
  if (!is_evaluated_) evaluate(state);
  std::vector<int> candidates = sticking_beyond_bound(state);
  if (candidates.empty()) return true;
  anchor_resting(state);
  release_moving(state);
  candidates = violated(state);
  if (!candidates.empty()) {
    settle_candidates(state, std::move(candidates));
    rejoin(state);
  }
  is_evaluated_ = false;
  return false;
}

void FrictionModes::settle_candidates(State& state, std::vector<int> candidates) {
  // The set of candidates only grows, except when a group is released, which happens at most once to each element.
  const std::size_t most = (system_.frictions.size() + 1) * (system_.frictions.size() + 1);
  for (std::size_t pass = 0; !candidates.empty(); ++pass) {
    if (pass > most) throw NumericalFailure("friction modes cannot be decided at t = " + rounded_text(state.t, 12) + " s");
    solve(state, candidates);
    std::vector<int> more = violated(state);
    const bool is_any_over = !more.empty();
    std::erase_if(more, [&](int f) { return std::find(candidates.begin(), candidates.end(), f) != candidates.end(); });
    // Candidates that stick in the mode problem but exceed their bounds: by rounding, or in a group, which limit analysis decides.
    if (more.empty() && is_any_over && slacken_idle(system_, dynamics_, state)) {
      candidates = violated(state);
    } else if (more.empty()) {
      if (!is_any_over || !release_overloaded(state)) return;
      candidates = violated(state);
    } else {
      candidates.insert(candidates.end(), more.begin(), more.end());
    }
  }
}

} // namespace steplap
