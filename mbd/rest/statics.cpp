#include "mbd/rest/statics.h"

#include "mbd/base/dual.h"
#include "mbd/system/law_group.h"
#include "mbd/system/row_gradient.h"

#include <algorithm>

namespace steplap {

namespace {

using D12 = Dual<12>;

// Relative reduction of sliding friction below its bound. When the element comes to rest, it must stick with this force, which therefore
// has to be inside the bound by more than rounding errors.
constexpr double k_short_of_bound = 1e-6;

// Returns the index, in the vector of all coordinates, of coordinate k (0 … 5) of the row's bodies a and b; −1 for the ground.
int place_of(const RowSpec& row, int k) {
  const int body = k < 3 ? row.a : row.b;
  return body == k_ground ? -1 : 3 * (body - 1) + k % 3;
}

// Adds the entries w ∂²(measure)/∂q² of one part of a row to k.
void add_curvature(const RowSpec& row, const std::vector<Motion<double>>& motion, double w, std::vector<Statics::MatrixEntry>& k) {
  const RowGradient<D12> g = row_gradient(row, seeded(motion[row.a], 0), seeded(motion[row.b], 3));
  for (int i = 0; i < 6; ++i)
    for (int l = 0; l < 6; ++l)
      if (const int r = place_of(row, i), c = place_of(row, l); r >= 0 && c >= 0) k.emplace_back(r, c, w * g.j[i].d[l]);
}

void add_pair(int a, int b, const Eigen::Matrix<double, 6, 6>& part, std::vector<Statics::MatrixEntry>& whole) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      if (const int row = i < 3 ? a : b, column = j < 3 ? a : b; row != k_ground && column != k_ground)
        whole.emplace_back(3 * row - 3 + i % 3, 3 * column - 3 + j % 3, part(i, j));
}

MatX dense(const std::vector<Statics::MatrixEntry>& entries, Eigen::Index rows, Eigen::Index columns) {
  MatX matrix = MatX::Zero(rows, columns);
  for (const Statics::MatrixEntry& entry : entries) matrix(entry.row(), entry.col()) += entry.value();
  return matrix;
}

} // namespace

double static_target(const RowSpec& row, const State& state) { return row_target(row, state.bases.data(), state.t).value; }

void anchor_friction(const System& system, State& state, int f) {
  std::vector<Motion<double>> placed;
  place_bodies(state.q, state.v, placed);
  anchor_friction(system, state, f, placed.data());
}

Statics::Statics(const System& system)
    : system_(system), n_(3 * (system.body_count() - 1)), scratch_(system), motion_(static_cast<std::size_t>(system.links.slot_count())),
      arrays_(system) {
  force_ = VecX::Zero(n_);
  arrays_.connect(evaluation_, motion_);
  evaluation_.scratch = scratch_.pointers();
}

void Statics::set_modes(State& state) {
  for (std::size_t u = 0; u < system_.units.size(); ++u)
    state.mode[u] = system_.units[u].group->initial_mode(system_.units[u].index, evaluation_);
}

void Statics::evaluate(State& state) {
  ++evaluations_;
  state_ = &state;
  evaluation_.t = state.t;
  evaluation_.mode = state.mode.data();
  evaluation_.friction = state.friction.data();
  evaluation_.bases = state.bases.data();
  evaluation_.inner = state.inner.data();
  for (int i = 0; i < system_.body_count(); ++i) {
    Motion<double>& m = motion_[i];
    m = {};
    m.x = state.q[3 * i];
    m.y = state.q[3 * i + 1];
    set_angle(m, state.q[3 * i + 2]);
  }
  place_links(system_.links, motion_);
  std::fill(arrays_.force.begin(), arrays_.force.end(), BodyForce{});
  set_modes(state);
  for (const auto& group : system_.groups) group->add_forces(evaluation_);
  add_link_forces(system_.links, motion_, arrays_.force);
  for (int i = 1; i < system_.body_count(); ++i) {
    const double mass = system_.bodies[i].mass;
    force_[3 * i - 3] = arrays_.force[i].fx + mass * system_.gravity.x();
    force_[3 * i - 2] = arrays_.force[i].fy + mass * system_.gravity.y();
    force_[3 * i - 1] = arrays_.force[i].m;
  }
  add_sliding_forces();
}

void Statics::slip_wrench(int f, double* wrench) const {
  const FrictionElement& friction = *system_.frictions[f].friction;
  const double still[3] = {0.0, 0.0, 0.0};
  friction.slip_wrench(evaluation_, state_->friction[f], still, wrench);
  for (int r = 0; r < friction.dimension(); ++r) wrench[r] *= 1.0 - k_short_of_bound;
}

void Statics::add_sliding_forces() {
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    if (state_->friction[f].phase != FrictionPhase::slip) continue;
    const RowSpec& row = *system_.frictions[f].friction->rows(state_->friction[f]);
    double wrench[3];
    slip_wrench(f, wrench);
    const RowGradient<double> g = row_gradient(row, motion_[row.a], motion_[row.b]);
    for (int k = 0; k < 6; ++k)
      if (const int at = place_of(row, k); at >= 0) force_[at] += wrench[0] * g.j[k];
  }
}

void Statics::collect_rows(const State& state, const std::vector<char>& left_out) {
  rows_.clear();
  for (int r = 0; r < static_cast<int>(system_.rows.size()); ++r) rows_.push_back({&system_.rows[r], r, -1, 0});
  bilateral_count_ = static_cast<int>(rows_.size());
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    if (state.friction[f].phase != FrictionPhase::stick) continue;
    const FrictionUnit& unit = system_.frictions[f];
    for (int r = 0; r < unit.friction->dimension(); ++r)
      if (left_out.empty() || left_out[unit.row + r] == 0)
        rows_.push_back({unit.friction->rows(state.friction[f]) + r, -1, f, unit.row + r});
  }
}

MatX Statics::gradient() const {
  std::vector<MatrixEntry> entries;
  gradient(entries);
  return dense(entries, static_cast<Eigen::Index>(rows_.size()), n_);
}

void Statics::gradient(std::vector<MatrixEntry>& entries) const {
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    for (const RowSpec* part = rows_[r].spec; part; part = part->next) {
      const RowGradient<double> g = row_gradient(*part, motion_[part->a], motion_[part->b]);
      for (int k = 0; k < 6; ++k)
        if (const int at = place_of(*part, k); at >= 0) entries.emplace_back(static_cast<int>(r), at, g.j[k]);
    }
  }
}

VecX Statics::off() const {
  VecX off(static_cast<Eigen::Index>(rows_.size()));
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const RowSpec& row = *rows_[r].spec;
    double& own = off[static_cast<Eigen::Index>(r)];
    own = off_target(row, evaluate_row<false>(row, motion_[row.a], motion_[row.b]).value, static_target(row, *state_));
    for (const RowSpec* part = row.next; part; part = part->next)
      own += evaluate_row<false>(*part, motion_[part->a], motion_[part->b]).value;
  }
  return off;
}

MatX Statics::stiffness(const VecX& lambda) const {
  std::vector<MatrixEntry> entries;
  stiffness(lambda, entries);
  return dense(entries, n_, n_);
}

void Statics::stiffness(const VecX& lambda, std::vector<MatrixEntry>& k, bool with_sliding) const {
  std::vector<PairJacobian> parts;
  for (const auto& group : system_.groups) group->add_jacobian(evaluation_, parts);
  for (const PairJacobian& part : parts) add_pair(part.a, part.b, part.stiffness, k);
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (const RowSpec* part = rows_[r].spec; part; part = part->next)
      add_curvature(*part, motion_, lambda[static_cast<Eigen::Index>(r)], k);
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f)
    if (state_->friction[f].phase == FrictionPhase::slip) add_sliding_stiffness(f, parts, with_sliding, k);
}

MatX Statics::damping() const {
  std::vector<MatrixEntry> entries;
  damping(entries);
  return dense(entries, n_, n_);
}

void Statics::damping(std::vector<MatrixEntry>& d) const {
  std::vector<PairJacobian> parts;
  for (const auto& group : system_.groups) group->add_jacobian(evaluation_, parts);
  for (const PairJacobian& part : parts) add_pair(part.a, part.b, part.damping, d);
}

// Adds the derivatives of a sliding friction force w(N): w ∂²(measure)/∂q² along its row, and the change of w with the normal forces N, on
// which it depends linearly.
void Statics::add_sliding_stiffness(int f, const std::vector<PairJacobian>& parts, bool with_sliding, std::vector<MatrixEntry>& k) const {
  const RowSpec& row = *system_.frictions[f].friction->rows(state_->friction[f]);
  double wrench[3], more[3];
  slip_wrench(f, wrench);
  add_curvature(row, motion_, wrench[0], k);
  if (!with_sliding) return;
  const RowGradient<double> g = row_gradient(row, motion_[row.a], motion_[row.b]);
  for (const PairJacobian& part : parts) {
    if (part.contact < 0) continue;
    double& normal = arrays_.contact_force[part.contact];
    const double before = normal, step = std::max(1.0, before);
    normal = before + step;
    slip_wrench(f, more);
    normal = before;
    const double slope = (more[0] - wrench[0]) / step;
    if (slope == 0.0) continue;
    for (int i = 0; i < 6; ++i)
      for (int l = 0; l < 6; ++l) {
        const int r = place_of(row, i), body = l < 3 ? part.a : part.b;
        if (r >= 0 && body != k_ground) k.emplace_back(r, 3 * body - 3 + l % 3, slope * g.j[i] * part.normal[l]);
      }
  }
}

} // namespace steplap
