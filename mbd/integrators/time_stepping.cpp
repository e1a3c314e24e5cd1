#include "mbd/integrators/time_stepping.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr int k_max_mode_passes = 12;   // contacts that still change after so many keep their last mode
constexpr int k_max_force_passes = 30;  // repetitions for the normal forces of the step's end
constexpr int k_max_sweeps = 500;
constexpr int k_joint_sweeps = 10; // the first sweeps are followed by a common solution of all that stick
constexpr double k_settled = 1e-9;      // relative change of a wrench: far below the method's own error

double value_of_row(const RowSpec& row, const State& state) {
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  return evaluate_row<false>(row, motion.data()).value;
}

} // namespace

TimeStepping::TimeStepping(const System& system) : system_(system) {
  const std::size_t n = 6 * system.bodies.size() + 2;
  for (auto* v : {&y0_, &y1_, &dy_, &right_, &free_, &change_}) v->assign(n, 0.0);
}

// Stuck before this step at the same place: its anchor stays, and with it what an element has worked out there.
bool TimeStepping::has_held(const FrictionState& friction, int f) const {
  return start_.friction[f].phase == FrictionPhase::stick && start_.friction[f].foot == friction.foot;
}

// Elements that can bear anything, anchored where they are; their rows are forces here, not constraints.
void TimeStepping::collect_friction(Dynamics& dynamics, State& state) {
  parts_.clear();
  int first = 0;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    const FrictionElement& element = *system_.frictions[f].friction;
    FrictionState& friction = state.friction[f];
    if (friction.phase == FrictionPhase::apart || element.never_slips()) continue;
    FrictionState before = friction; // a joint that sticks cannot come apart: the phase counts
    before.phase = start_.friction[f].phase;
    if (element.watch_place(dynamics.evaluation(), before) < 0.0) element.change_place(dynamics.evaluation(), friction);
    if (friction.phase == FrictionPhase::apart) continue;
    const RowSpec* rows = element.rows(friction);
    for (int r = 0; r < element.dimension() && !has_held(friction, f); ++r)
      if (rows[r].memory >= 0) state.memory[rows[r].memory] = value_of_row(rows[r], state);
    parts_.push_back({f, first, element.dimension(), false, {}});
    first += element.dimension();
  }
  wrench_.assign(first, 0.0);
  gradient_.resize(first);
  response_.resize(first);
}

// Gradient of a friction row in the clusters' coordinates.
void TimeStepping::load_row(const Dynamics& dynamics, const RowSpec& spec, std::size_t r) {
  const Layout& layout = dynamics.layout();
  const std::vector<Motion<double>>& motion = dynamics.motion();
  const auto m = evaluate_row<false>(spec, motion.data());
  gradient_[r].assign(n_, 0.0);
  const int body[2] = {spec.a, spec.b};
  for (int side = 0; side < 2; ++side) {
    const Placement& place = layout.placements[body[side]];
    if (place.cluster < 0) continue;
    const Motion<double>& k = motion[layout.clusters[place.cluster].motion];
    const Pair<double> off{motion[body[side]].x - k.x, motion[body[side]].y - k.y};
    const double sign = side == 0 ? 1.0 : -1.0;
    double* g = gradient_[r].data() + 3 * place.cluster;
    g[0] += sign * m.direction.x;
    g[1] += sign * m.direction.y;
    g[2] += sign * (cross((side == 0 ? m.lever_a : m.lever_b) + off, m.direction) + m.couple);
  }
}

// Responses to unit forces along the friction rows, and the rows' rates at the end without them.
void TimeStepping::respond(const Dynamics& dynamics, const double* y0) {
  const std::size_t rows = gradient_.size();
  const std::vector<double>& w = linearization_.inverse_mass();
  std::size_t r = 0;
  for (const FrictionPart& part : parts_) {
    const RowSpec* specs = system_.frictions[part.friction].friction->rows(dynamics.evaluation().friction[part.friction]);
    for (int i = 0; i < part.dimension; ++i, ++r) load_row(dynamics, specs[i], r);
  }
  for (r = 0; r < rows; ++r) {
    std::fill(right_.begin(), right_.begin() + n_, 0.0);
    for (int i = 0; i < n_; ++i) right_[n_ + i] = w[i] * gradient_[r][i];
    response_[r].resize(2 * n_);
    stages_.solve(right_.data(), response_[r].data());
  }
  compliance_.assign(rows * rows, 0.0);
  rate_.assign(rows, 0.0);
  for (std::size_t i = 0; i < rows; ++i)
    for (int k = 0; k < n_; ++k) {
      rate_[i] += gradient_[i][k] * (y0[n_ + k] + free_[n_ + k]);
      for (std::size_t j = 0; j < rows; ++j) compliance_[i * rows + j] += gradient_[i][k] * response_[j][n_ + k];
    }
}

// The wrenches of all elements that stick at once, those that slip as they are: where the guess of who sticks
// is right, the next sweep changes nothing.
void TimeStepping::hold_together() {
  std::vector<int> held;
  for (const FrictionPart& part : parts_)
    for (int i = 0; part.block.is_inside && i < part.dimension; ++i) held.push_back(part.first + i);
  const int count = static_cast<int>(held.size()), rows = static_cast<int>(rate_.size());
  if (count == 0) return;
  MatX a(count, count);
  VecX b(count);
  for (const int r : held) wrench_[r] = 0.0;
  for (int i = 0; i < count; ++i) {
    b[i] = -rate_[held[i]];
    for (int j = 0; j < rows; ++j) b[i] -= compliance_[held[i] * rows + j] * wrench_[j];
    for (int j = 0; j < count; ++j) a(i, j) = compliance_[held[i] * rows + held[j]];
  }
  const VecX w = a.completeOrthogonalDecomposition().solve(b); // least norm where rows depend on each other
  for (int i = 0; i < count; ++i) wrench_[held[i]] = w[i];
}

// Block Gauss–Seidel: each element's wrench for the others' as they are; those that slip get their kinetic
// coefficients and stay with them.
void TimeStepping::balance_friction(const Dynamics& dynamics) {
  const Evaluation& e = dynamics.evaluation();
  const std::size_t rows = gradient_.size();
  for (FrictionPart& part : parts_) part.is_kinetic = false;
  for (std::size_t pass = 0; pass <= parts_.size(); ++pass) {
    for (int sweep = 0; sweep < k_max_sweeps; ++sweep) {
      double change = 0.0, size = 1e-9;
      for (FrictionPart& part : parts_) {
        const FrictionElement& element = *system_.frictions[part.friction].friction;
        const FrictionState& friction = e.friction[part.friction];
        FrictionBlock block;
        block.is_inside = false;
        if (element.is_loaded(e, friction)) {
          double a[9], b[3];
          for (int i = 0; i < part.dimension; ++i) {
            const std::size_t row = part.first + i;
            b[i] = rate_[row];
            for (std::size_t j = 0; j < rows; ++j) b[i] += compliance_[row * rows + j] * wrench_[j];
            for (int j = 0; j < part.dimension; ++j) {
              a[i * part.dimension + j] = compliance_[row * rows + part.first + j];
              b[i] -= a[i * part.dimension + j] * wrench_[part.first + j];
            }
          }
          block = element.solve_block(e, friction, a, b, part.is_kinetic);
        }
        for (int i = 0; i < part.dimension; ++i) {
          change = std::max(change, std::abs(block.wrench[i] - wrench_[part.first + i]));
          size = std::max(size, std::abs(block.wrench[i]));
          wrench_[part.first + i] = block.wrench[i];
        }
        part.block = block;
      }
      if (change <= k_settled * size) break;
      if (sweep < k_joint_sweeps) hold_together();
    }
    bool is_changed = false;
    for (FrictionPart& part : parts_)
      if (!part.block.is_inside && !part.is_kinetic) part.is_kinetic = is_changed = true;
    if (!is_changed) break;
  }
}

// Modes that the end of the step asks for; true if some differ from those it was made with.
bool TimeStepping::update_modes(Dynamics& dynamics, State& state) {
  bool is_changed = false;
  for (std::size_t u = 0; u < system_.units.size(); ++u) {
    const Unit& unit = system_.units[u];
    const UnitMode mode = unit.group->initial_mode(unit.index, dynamics.evaluation());
    is_changed = is_changed || mode != state.mode[u];
    state.mode[u] = mode;
  }
  return is_changed;
}

void TimeStepping::step(Dynamics& dynamics, State& state, double t1, double tolerance) {
  start_ = state;
  const double h = t1 - state.t;
  for (std::size_t f = 0; f < state.friction.size(); ++f)
    if (state.friction[f].phase != FrictionPhase::apart && !system_.frictions[f].friction->never_slips())
      state.friction[f].phase = FrictionPhase::free;
  const auto evaluate = [&](double t, const double* y) {
    dynamics.rates(t, y, dy_.data());
    (void)dynamics.snapshot(dy_.data()); // places bodies that only friction refers to
  };
  dynamics.set_state(state);
  n_ = dynamics.coordinate_count();
  dynamics.pack(state, y0_.data());
  evaluate(start_.t, y0_.data());
  collect_friction(dynamics, state);
  dynamics.set_state(state);
  for (int pass = 0; pass < k_max_mode_passes; ++pass) {
    linearization_.evaluate(dynamics, t1, y0_.data());
    stages_.set(linearization_, dynamics.layout());
    if (!stages_.factor(h)) throw NumericalFailure("the equations of a time step at t = " + std::to_string(state.t) + " s are singular");
    evaluate(t1, y0_.data());
    std::copy(dy_.begin(), dy_.begin() + 2 * n_, right_.begin());
    stages_.solve(right_.data(), free_.data());
    respond(dynamics, y0_.data());
    const auto move = [&] {
      std::copy(y0_.begin(), y0_.begin() + 2 * n_ + 2, y1_.begin());
      for (int i = 0; i < 2 * n_; ++i) {
        y1_[i] += free_[i];
        for (std::size_t r = 0; r < response_.size(); ++r) y1_[i] += response_[r][i] * wrench_[r];
      }
      evaluate(t1, y1_.data());
    };
    move();
    for (int repeat = 0; repeat < k_max_force_passes && !parts_.empty(); ++repeat) {
      const std::vector<double> before = wrench_;
      balance_friction(dynamics);
      move();
      double change = 0.0, size = 1e-9;
      for (std::size_t r = 0; r < before.size(); ++r) {
        change = std::max(change, std::abs(wrench_[r] - before[r]));
        size = std::max(size, std::abs(wrench_[r]));
      }
      if (change <= 1e-6 * size) break;
    }
    if (!update_modes(dynamics, state)) break;
  }
  for (int i = 0; i < 2 * n_; ++i)
    if (!std::isfinite(y1_[i])) throw NumericalFailure("the motion became infinite at t = " + std::to_string(state.t) + " s");
  residual_ = dynamics.project(t1, y1_.data(), tolerance);
  dynamics.unpack(t1, y1_.data(), state);
  finish_phases(dynamics, state, h);
}

// What became of each friction element, its anchor, and the power at the step's end.
void TimeStepping::finish_phases(Dynamics& dynamics, State& state, double h) {
  dynamics.rates(state.t, y1_.data(), dy_.data());
  (void)dynamics.snapshot(dy_.data());
  bool is_sliding_rigid = false;
  for (const FrictionPart& part : parts_) {
    const FrictionElement& element = *system_.frictions[part.friction].friction;
    FrictionState& friction = state.friction[part.friction];
    const RowSpec* rows = element.rows(friction);
    if (!element.is_loaded(dynamics.evaluation(), friction)) continue; // stays free
    double rate[3] = {0, 0, 0};
    const bool stays = part.block.is_inside && has_held(friction, part.friction);
    for (int r = 0; r < part.dimension; ++r) {
      const auto m = evaluate_row<false>(rows[r], dynamics.motion().data());
      rate[r] = m.rate;
      if (rows[r].memory >= 0 && !stays) state.memory[rows[r].memory] = m.value;
    }
    friction.is_starting = false;
    friction.phase = part.block.is_inside ? FrictionPhase::stick : FrictionPhase::slip;
    if (part.block.is_inside) continue;
    friction.has_slipped = true;
    friction.slid += h * std::abs(rate[0]);
    std::copy(part.block.direction, part.block.direction + 3, friction.direction);
    friction.sign = part.block.direction[0] > 0.0 ? 1 : -1;
    if (part.dimension == 3) element.aim(friction, rate);
    is_sliding_rigid = is_sliding_rigid || element.is_rigid();
  }
  if (is_sliding_rigid) dynamics.forget_layouts(); // bodies that a layout would merge have moved apart
  dynamics.set_state(state);
  dynamics.pack(state, y1_.data());
  dynamics.rates(state.t, y1_.data(), dy_.data());
  const int n = dynamics.dimension();
  state.dissipated += h * dy_[n - 2];
  state.work += h * dy_[n - 1];
}

} // namespace steplap
