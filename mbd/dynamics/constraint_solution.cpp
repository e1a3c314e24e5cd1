#include "mbd/dynamics/constraint_solution.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

ConstraintSolution::ConstraintSolution(const Kinematics& kinematics) : motion_(kinematics.motion().data()) {}

void ConstraintSolution::use(Layout& layout, const State& state) {
  layout_ = &layout;
  state_ = &state;
  is_factored_ = false;
  const std::size_t rows = layout.active.size();
  if (multiplier_.size() < rows)
    for (std::vector<double>* v : {&multiplier_, &target_rate_, &off_, &rate_off_, &response_}) v->resize(rows);
  if (layout.has_mechanisms()) cluster_a_.resize(3 * layout.clusters.size());
}

// --- rows ---------------------------------------------------------------------------------------------

MeasureValue<double> ConstraintSolution::load(const RowSpec& spec, SchurRow& row) const {
  MeasureValue<double> m = evaluate_row<true>(spec, motion_[spec.a], motion_[spec.b]);
  row.body[0] = layout_->placements[spec.a].cluster;
  row.body[1] = layout_->placements[spec.b].cluster;
  for (int side = 0; side < 2; ++side)
    if (row.body[side] >= 0) std::copy_n(layout_->clusters[row.body[side]].w, 3, row.w[side]);
  put_in_clusters<true>(*layout_, spec, motion_, m, row);
  return m;
}

// --- an evaluation ------------------------------------------------------------------------------------

void ConstraintSolution::prepare() {
  Layout& layout = *layout_;
  const auto count = static_cast<std::size_t>(layout.schur.size());
  if (count == 0) return;
  pull_rows(layout, 0, count, motion_, layout.schur_rows.data(), multiplier_.data());
  if (layout.has_long_rows()) [[unlikely]]
    pull_parts();
  layout.schur.factor(layout.schur_rows);
}

STEPLAP_INLINE void ConstraintSolution::accelerate_mechanism(Mechanism& m, const BodyForce* force, double* a) {
  m.factor_mass();
  m.accelerate(force, a + m.first_coordinate);
  if (m.row_count == 0) return;
  m.expand(a + m.first_coordinate, cluster_a_.data());
  const auto first = static_cast<std::size_t>(m.first_row), end = first + static_cast<std::size_t>(m.row_count);
  pull_rows(*layout_, first, end, motion_, layout_->schur_rows.data(), multiplier_.data());
  take_accelerations(layout_->schur_rows.data(), first, end, cluster_a_.data(), multiplier_.data());
}

void ConstraintSolution::solve_mechanisms(const BodyForce* force, double* a) {
  for (Mechanism& m : layout_->mechanisms) accelerate_mechanism(m, force, a);
}

STEPLAP_INLINE void ConstraintSolution::solve_multipliers(Mechanism& m, double* a) {
  if (m.row_count == 0) return;
  double* const right = multiplier_.data() + m.first_row;
  const SchurRow* const rows = layout_->schur_rows.data() + m.first_row;
  m.reduce_rows(rows);
  m.factor_rows(rows, 0.0);
  m.solve_rows(right);
  m.add_response(right, a + m.first_coordinate);
}

// Adds the prescribed accelerations of driven rows to γ, and stores their prescribed rates.
STEPLAP_INLINE void ConstraintSolution::drive(double t) {
  for (const int r : layout_->driven_rows) {
    const SignalJet target = row_target(*layout_->active[r].spec, state_->bases.data(), t);
    multiplier_[r] += target.acceleration;
    target_rate_[r] = target.rate;
  }
}

void ConstraintSolution::solve(double t, const BodyForce* force, double* a) {
  Layout& layout = *layout_;
  const auto count = static_cast<std::size_t>(layout.schur.size());
  double* const right = multiplier_.data();
  take_accelerations(layout.schur_rows.data(), 0, count, a, right);
  if (layout.has_long_rows()) [[unlikely]]
    subtract_part_accelerations(a, right);
  if (layout.has_mechanisms()) solve_mechanisms(force, a);
  if (layout.active.empty()) return;
  drive(t);
  is_factored_ = true;
  for (Mechanism& m : layout.mechanisms) solve_multipliers(m, a);
  if (count == 0) return;
  layout.schur.solve(layout.schur_rows, right);
  add_responses(layout.schur_rows.data(), count, right, a);
  if (layout.has_long_rows()) [[unlikely]]
    add_part_responses(right, a);
}

// --- projection ---------------------------------------------------------------------------------------

STEPLAP_INLINE void ConstraintSolution::compare_row(std::size_t r, double t) {
  const SignalJet target = row_target(*layout_->active[r].spec, state_->bases.data(), t);
  const MeasureValue<double> m = load_row<false>(*layout_, layout_->active[r], motion_, layout_->schur_rows[r]);
  off_[r] = off_target(*layout_->active[r].spec, m.value, target.value);
  rate_off_[r] = m.rate - target.rate;
}

void ConstraintSolution::compare(double t) {
  for (std::size_t r = 0; r < layout_->active.size(); ++r) compare_row(r, t);
  if (layout_->has_long_rows()) [[unlikely]]
    compare_parts();
  for (Mechanism& m : layout_->mechanisms) m.reduce_rows(layout_->schur_rows.data() + m.first_row);
}

namespace {

// Sets `largest` to the larger of the two; a value that is not a number counts as infinite.
void take_larger(double value, double& largest) {
  if (!(value <= largest)) largest = std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}

} // namespace

Residual ConstraintSolution::residual() const {
  Residual residual;
  for (std::size_t r = 0; r < layout_->active.size(); ++r) {
    if (layout_->is_left_out(static_cast<int>(r))) continue;
    take_larger(std::abs(off_[r]), residual.position);
    take_larger(std::abs(rate_off_[r]), residual.velocity);
  }
  return residual;
}

void ConstraintSolution::factor(double shift) {
  Layout& layout = *layout_;
  layout.schur.factor(layout.schur_rows, shift);
  for (Mechanism& m : layout.mechanisms) {
    m.factor_mass();
    m.factor_rows(layout.schur_rows.data() + m.first_row, shift);
  }
  is_factored_ = true;
}

void ConstraintSolution::take_away(const double* r, double* change) {
  const Layout& layout = *layout_;
  double* const response = response_.data();
  for (std::size_t i = 0; i < layout.active.size(); ++i) response[i] = -r[i];
  layout.schur.solve(layout.schur_rows, response);
  for (std::size_t i = 0; i < static_cast<std::size_t>(layout.schur.size()); ++i)
    for (int side = 0; side < 2; ++side)
      if (layout.schur_rows[i].body[side] >= 0) add_response(layout.schur_rows[i], side, response[i], change);
  if (layout.has_long_rows()) [[unlikely]]
    add_part_responses(response, change);
  for (const Mechanism& m : layout.mechanisms) {
    if (m.row_count == 0) continue;
    m.solve_rows(response + m.first_row);
    m.add_response(response + m.first_row, change + m.first_coordinate);
  }
}

double ConstraintSolution::along(std::size_t r, const double* change) const {
  const Layout& layout = *layout_;
  if (r >= static_cast<std::size_t>(layout.schur.size())) {
    const Mechanism& m = layout.mechanism_of_row(static_cast<int>(r));
    return m.along(static_cast<int>(r) - m.first_row, change + m.first_coordinate);
  }
  const SchurRow& row = layout.schur_rows[r];
  double sum = 0.0;
  for (int side = 0; side < 2; ++side)
    if (row.body[side] >= 0)
      for (int c = 0; c < 3; ++c) sum += row.j[side][c] * change[3 * row.body[side] + c];
  if (layout.has_long_rows()) [[unlikely]]
    sum += along_parts(r, change);
  return sum;
}

} // namespace steplap
