// Dynamics: projection of states onto the constraints; rates near singular positions; removal of the constrained part of error estimates
// there.
#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/system/element_failure.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr int k_max_projection_iterations = 60;
constexpr int k_iterations_per_factorization = 3;
// Largest damping of a projection near a singular position, as a fraction of the diagonal.
constexpr double k_largest_damping = 1e-3;
// Relative pivot below which the constrained part of error estimates is removed (remove_constrained_error). Near a singular position
// accelerations across the constraints are mostly rounding, and tight tolerances could not be reached otherwise.
constexpr double k_removal_pivot = 1e-2;
// A factorisation is used again if it reduced the residual to this fraction or less.
constexpr double k_chord_worth = 0.1;
// Relative pivot below which every iteration factorises again, and iterations are damped.
constexpr double k_chord_pivot = 1e-2;
// Rounding error of a residual, in units of epsilon times the size of the model: a position is a sum of a few terms.
constexpr double k_rounded_terms = 32.0;
// Fraction of the largest rate (or of 1 m/s) above which a velocity residual is not rounding.
constexpr double k_rate_left = 1e-6;
// A projection "as far as rounding allows" aims at the fraction k_close of the rounding error. It makes some more iterations after the
// first one without improvement.
constexpr double k_close = 1.0 / 16.0;
int patience_for(double tolerance, double rounding) { return tolerance <= k_close * rounding ? 3 : 0; }

} // namespace

// Return the rounding errors of positions at y, and of rates. Positions in mechanisms are those of the last evaluation.
double Dynamics::place_rounding(const double* y) const {
  double size = 0.0;
  for (int i = 0; i < coordinate_count(); ++i) size = std::max(size, std::abs(y[i]));
  for (int k = layout_->absolute_count; k < layout_->cluster_count(); ++k) {
    const Motion<double>& m = motion_[layout_->slots[k]];
    size = std::max({size, std::abs(m.x), std::abs(m.y)});
  }
  return k_rounded_terms * std::numeric_limits<double>::epsilon() * size;
}

double Dynamics::rate_rounding(const double* y) const {
  double size = 0.0;
  for (int i = 0; i < coordinate_count(); ++i) size = std::max(size, std::abs(y[coordinate_count() + i]));
  for (int k = layout_->absolute_count; k < layout_->cluster_count(); ++k) {
    const Motion<double>& m = motion_[layout_->slots[k]];
    size = std::max({size, std::abs(m.vx), std::abs(m.vy)});
  }
  return k_rounded_terms * std::numeric_limits<double>::epsilon() * size;
}

Residual Dynamics::constraint_values(double t, const double* y) {
  t = std::min(t, time_cap_);
  evaluation_.t = t;
  kinematics_.place(t, y, y + coordinate_count());
  level_ = ResultLevel::motion;
  rows_.compare(t);
  return rows_.residual();
}

Residual Dynamics::residual(double t, const double* y) {
  if (layout_->active.empty()) return {};
  pending_.end(); // by-products are invalid from now on
  rows_.forget_factors();
  return constraint_values(t, y);
}

void Dynamics::fail_projection(double t) const {
  const Layout& layout = *layout_;
  int worst = 0;
  for (std::size_t r = 1; r < layout.active.size(); ++r)
    if (!(std::abs(rows_.off()[r]) <= std::abs(rows_.off()[worst]))) worst = static_cast<int>(r);
  const RowSpec& spec = *layout.active[worst].spec;
  throw ConstraintFailure("constraint " + std::string(spec.quantity) + " of '" + system_.element_names[spec.element] +
                              "' cannot be met at t = " + number_text(t) + " s: residual " + rounded_text(rows_.off()[worst], 3) +
                              (spec.kind == MeasureKind::angle ? " rad" : " m"),
                          spec.element, rows_.off()[worst], spec.kind == MeasureKind::angle);
}

void Dynamics::fail_velocities(double t) const {
  const Layout& layout = *layout_;
  std::size_t worst = 0;
  for (std::size_t r = 1; r < layout.active.size(); ++r)
    if (!(std::abs(rows_.rate_off()[r]) <= std::abs(rows_.rate_off()[worst]))) worst = r;
  const RowSpec& spec = *layout.active[worst].spec;
  throw ElementFailure("the rate of constraint " + std::string(spec.quantity) + " of '" + system_.element_names[spec.element] +
                           "' cannot be met at t = " + number_text(t) + " s: " + rounded_text(rows_.rate_off()[worst], 3) +
                           (spec.kind == MeasureKind::angle ? " rad/s" : " m/s") + " are left. It contradicts other joints or drives there",
                       {system_.element_names[spec.element]});
}

bool Dynamics::is_near_singular() const {
  // The result is false after an evaluation by code, which has no factors. Code is not used so near a singular position.
  return !layout_->active.empty() && rows_.is_factored() && layout_->smallest_pivot() < k_removal_pivot;
}

void Dynamics::project_onto_null_space(double* change) {
  const Layout& layout = *layout_;
  if (layout.active.empty()) return;
  ensure_byproducts();
  if (!rows_.is_factored()) rows_.factor();
  for (std::size_t r = 0; r < layout.active.size(); ++r) row_scratch_[r] = rows_.along(r, change);
  rows_.take_away(row_scratch_.data(), change);
}

void Dynamics::remove_constrained_error(double* change) {
  if (!is_near_singular()) return;
  project_onto_null_space(change);
  project_onto_null_space(change + coordinate_count());
}

Residual Dynamics::project(double t, double* y, double tolerance) {
  const Residual found = project_rows(t, y, tolerance);
  if (inner_count() > 0) project_inner(t, y);
  return found;
}

void Dynamics::project_inner(double t, double* y) {
  double* const inner = y + 2 * coordinate_count();
  evaluation_.t = std::min(t, time_cap_);
  if (!kinematics_.is_placed(evaluation_.t, y)) {
    kinematics_.place(evaluation_.t, y, y + coordinate_count());
    level_ = ResultLevel::motion;
  }
  take_inner(inner);
  for (const ForceGroup* group : system_.inner_groups) inner[inner_count()] += group->project_inner(evaluation_, inner);
  take_inner(inner);
}

Residual Dynamics::project_rows(double t, double* y, double tolerance) {
  const Layout& layout = *layout_;
  const int n = coordinate_count();
  if (!layout.active.empty()) ensure_byproducts(); // the projection starts with the factors of the last evaluation
  kinematics_.aim_locks(std::min(t, time_cap_));
  for (std::size_t i = 0; i < layout.locks.size(); ++i) {
    const int k = 3 * layout.locks[i].cluster + layout.locks[i].coordinate;
    y[k] = kinematics_.lock_target(i).value;
    y[n + k] = kinematics_.lock_target(i).rate;
  }
  if (layout.active.empty()) return {};
  // Far from the origin, positions are accurate only to their rounding: at kilometres not to a picometre.
  const bool is_close = tolerance == 0.0;
  const Residual first = constraint_values(t, y);
  double farthest = 0.0;
  for (const int slot : layout.slots) farthest = std::max({farthest, std::abs(motion_[slot].x), std::abs(motion_[slot].y)});
  const double least = 8.0 * std::numeric_limits<double>::epsilon() * farthest;
  Residual now = first;
  if (!reach_positions(t, y, is_close ? k_close * place_rounding(y) : std::max(tolerance, least), now)) fail_projection(t);
  reach_velocities(t, y, now, is_close ? k_close * rate_rounding(y) : std::max(tolerance, least));
  return first;
}

void Dynamics::project_velocities(double t, double* y) {
  if (!layout_->active.empty()) {
    ensure_byproducts();
    const Residual now = constraint_values(t, y);
    reach_velocities(t, y, now, k_close * rate_rounding(y));
  }
}

// Brings positions to the constraints by Newton's method, with the factorisation of the last evaluation while convergence is fast. Near a
// singular position each iteration factorises. Undamped iterations would then have the length residual / distance from the singularity.
// Damping by the residual keeps them short and preserves quadratic convergence (J. Fan, Y. Yuan, Computing 74 (2005) 23, for
// Levenberg–Marquardt with this choice).
bool Dynamics::reach_positions(double t, double* y, double tolerance, Residual& now) {
  Layout& layout = *layout_;
  int patience = patience_for(tolerance, place_rounding(y));
  for (int iteration = 0; now.position > tolerance; ++iteration) {
    if (iteration == k_max_projection_iterations || !std::isfinite(now.position)) return false;
    if (rows_.is_factored() && layout.smallest_pivot() < k_chord_pivot) rows_.forget_factors();
    if (!rows_.is_factored() || iteration % k_iterations_per_factorization == k_iterations_per_factorization - 1) {
      rows_.factor();
      if (layout.smallest_pivot() < k_chord_pivot) rows_.factor(std::min(now.position, k_largest_damping));
    }
    const double before = now.position;
    rows_.take_away(rows_.off().data(), y);
    now = constraint_values(t, y);
    if (now.position > k_chord_worth * before) rows_.forget_factors();
    if (now.position >= 0.5 * before && now.position <= place_rounding(y) && --patience < 0) break;
  }
  return true;
}

// Brings velocities to the constraints. The correction solves a linear system, so that with few rows far from a singular position one
// iteration leaves only rounding, and the residual is not computed again.
void Dynamics::reach_velocities(double t, double* y, Residual now, double tolerance) {
  int patience = patience_for(tolerance, rate_rounding(y));
  for (int iteration = 0; now.velocity > tolerance && iteration < k_max_projection_iterations; ++iteration) {
    rows_.factor();
    const double before = now.velocity;
    rows_.take_away(rows_.rate_off().data(), y + coordinate_count());
    if (layout_->schur.is_small() && layout_->smallest_pivot() >= SchurSolver::k_refined_pivot && !layout_->is_singular()) return;
    now = constraint_values(t, y);
    if (now.velocity >= 0.5 * before && --patience < 0) break; // the rest is rounding of fast motions
  }
  double fastest = 0.0;
  for (int i = 0; i < coordinate_count(); ++i) fastest = std::max(fastest, std::abs(y[coordinate_count() + i]));
  if (!(now.velocity <= tolerance + k_rate_left * (1.0 + fastest))) fail_velocities(t);
}

// Computes the rates of the nearest state on the constraints. Near a singular position, accelerations at the stage itself would be
// unbounded, because the distance of a stage from the constraints, a power of the step size, is divided by the distance from the
// singularity. The rates of the nearest state are as smooth, and at the ends of the step they are the rates proper.
void Dynamics::rates_nearby(double t, const double* y, double* dy) {
  std::copy(y, y + dimension(), projected_state_.begin());
  Residual off = constraint_values(t, y);
  if (off.position <= place_rounding(y) && off.velocity <= rate_rounding(y)) {
    rates_at(t, y, dy);
    return;
  }
  bool is_placed = reach_positions(t, projected_state_.data(), place_rounding(y), off);
  try {
    if (is_placed) reach_velocities(t, projected_state_.data(), off, rate_rounding(y));
  } catch (const ElementFailure&) { // a stage far off the constraints; if this matters, the error estimate rejects the step
    is_placed = false;
  }
  rates_at(t, is_placed ? projected_state_.data() : y, dy);
}

} // namespace steplap
