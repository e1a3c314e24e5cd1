#include "mbd/dynamics/load_sharing.h"

#include "mbd/base/decompositions.h"
#include "mbd/base/shown_text.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/row_gradient.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace steplap {

namespace {

// Rows whose independent part, relative to their length, is below these count as dependent: k_dependent for joints. Dependent friction rows
// are determined by the equations (SchurSolver::k_dependent); a friction row that is kept there depends on others only if it is exactly
// parallel to bilateral rows of a rigid joint (k_exactly_dependent).
constexpr double k_dependent = 1e-6, k_exactly_dependent = 1e-9;
constexpr double k_out_of_balance = 1e-6; // largest residual of Jᵀ n relative to its terms, for a null vector n
// Rounding errors of the relative motion along a group's rows: absolute, in m/s and m/s², and relative to its terms (k_discord).
// k_least_gap is the error of positions that projection accepts, m (IntegratorSettings).
constexpr double k_least_rate = 1e-12, k_least_acceleration = 1e-10, k_least_gap = 3e-13;
constexpr double k_place_rounding = 8.0 * std::numeric_limits<double>::epsilon(); // rounding of positions, relative to coordinates
constexpr double k_discord = 1e-9;
constexpr double k_open = 1e-6; // relative to the capacity: if the bounds of u differ by more, the iteration has not converged
// Components of a null vector below this are rounding.
constexpr double k_no_part = 1e-11;
// Largest number of connected bodies without friction that is analysed, because the algebra is dense. With more bodies the multipliers of
// the solver are reported.
constexpr int k_most_bodies = 200;

// Calls f(body, j) for both sides of every part of a row, except for the ground; j are the 3 components of the gradient.
template <class F> void for_sides(const RowSpec& row, const std::vector<Motion<double>>& motion, const F& f) {
  for (const RowSpec* part = &row; part; part = part->next) {
    const RowGradient<double> g = row_gradient(*part, motion[part->a], motion[part->b]);
    for (const int side : {0, 1})
      if (const int body = side == 0 ? part->a : part->b; body != k_ground) f(body, g.side(side));
  }
}

template <class F> void for_bodies(const RowSpec& row, const F& f) {
  for (const RowSpec* part = &row; part; part = part->next)
    for (const int body : {part->a, part->b})
      if (body != k_ground) f(body);
}

int first_body(const RowSpec& row) { return row.a != k_ground ? row.a : row.b; }

using NullSpace = PivotedQr::NullSpace;

// Returns the null vectors of `matrix`: those of the kept columns, and one for each column in `left_out`, which depends exactly or nearly
// on the kept ones.
NullSpace null_space_of(const MatX& matrix, const std::vector<char>& left_out) {
  std::vector<Eigen::Index> kept, out;
  for (Eigen::Index c = 0; c < matrix.cols(); ++c) (left_out[c] != 0 ? out : kept).push_back(c);
  const PivotedQr factor(matrix(Eigen::all, kept), k_exactly_dependent);
  const NullSpace exact = factor.null_space(k_no_part);
  const Eigen::Index known = exact.vectors.cols(), count = known + static_cast<Eigen::Index>(out.size());
  NullSpace found{MatX::Zero(matrix.cols(), count), {}};
  const MatX others = factor.solve_by_rank(-matrix(Eigen::all, out));
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (known > 0) found.vectors.row(kept[k]).head(known) = exact.vectors.row(i);
    if (out.empty()) continue;
    found.vectors.row(kept[k]).tail(count - known) = (others.row(i).array().abs() < k_no_part).select(0.0, others.row(i));
  }
  for (const int pivot : exact.pivots) found.pivots.push_back(static_cast<int>(kept[pivot]));
  for (std::size_t k = 0; k < out.size(); ++k) {
    found.vectors(out[k], known + static_cast<Eigen::Index>(k)) = 1.0;
    found.pivots.push_back(static_cast<int>(out[k]));
  }
  return found;
}

int find_root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

} // namespace

// Returns all active rows, those with bounds (friction) last.
std::vector<LoadSharing::HeldRow> LoadSharing::held_rows(const State& state) const {
  std::vector<HeldRow> rows, bounded;
  for (int r = 0; r < static_cast<int>(system_.rows.size()); ++r) rows.push_back({&system_.rows[r], -1, r});
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    if (state.friction[f].phase != FrictionPhase::stick) continue;
    const FrictionUnit& unit = system_.frictions[f];
    const RowSpec* specs = unit.friction->rows(state.friction[f]);
    const bool is_bounded = !unit.friction->never_slips();
    for (int r = 0; r < unit.friction->dimension(); ++r) (is_bounded ? bounded : rows).push_back({specs + r, f, unit.row + r, is_bounded});
  }
  rows.insert(rows.end(), bounded.begin(), bounded.end());
  return rows;
}

LoadSharing::LoadSharing(const System& system, const State& state, const std::vector<Motion<double>>& motion, std::vector<char> left_out)
    : system_(system), group_of_(system.frictions.size(), -1), left_out_(std::move(left_out)) {
  // Divide the bodies into sets connected by rows. The ground does not connect.
  const std::vector<HeldRow> rows = held_rows(state);
  std::vector<int> parent(system.bodies.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const HeldRow& row : rows) {
    const int first = first_body(*row.spec);
    for_bodies(*row.spec, [&](int body) {
      if (body != first) parent[find_root(parent, first)] = find_root(parent, body);
    });
  }
  std::vector<int> part_of(system.bodies.size(), -1), size(system.bodies.size(), 0);
  for (int i = 1; i < system.body_count(); ++i) ++size[find_root(parent, i)];
  std::vector<ConnectedRows> parts;
  for (const HeldRow& row : rows) {
    const int root = find_root(parent, first_body(*row.spec));
    if (root == k_ground) continue;
    if (part_of[root] < 0) {
      part_of[root] = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    parts[part_of[root]].rows.push_back(row);
  }
  std::vector<int> body_index(system.bodies.size());
  for (ConnectedRows& part : parts) {
    const bool has_friction = part.rows.back().is_bounded;
    has_friction_ = has_friction_ || has_friction;
    const int bodies = size[find_root(parent, first_body(*part.rows.front().spec))];
    if (!has_friction && bodies > k_most_bodies) continue;
    analyze(part, motion, body_index);
    if (part.null.cols() == 0) continue;
    part.off = off_balance(part, motion);
    parts_.push_back(std::move(part));
  }
}

void LoadSharing::analyze(ConnectedRows& part, const std::vector<Motion<double>>& motion, std::vector<int>& body_index) {
  std::fill(body_index.begin(), body_index.end(), -1);
  int bodies = 0;
  for (const HeldRow& row : part.rows)
    for_bodies(*row.spec, [&](int body) {
      if (body_index[body] < 0) body_index[body] = bodies++;
    });
  const auto count = static_cast<Eigen::Index>(part.rows.size());
  MatX gradient = MatX::Zero(3 * bodies, count);
  VecX inverse_norm = VecX::Zero(count), mobility = VecX::Zero(count);
  for (Eigen::Index r = 0; r < count; ++r) {
    for_sides(*part.rows[r].spec, motion, [&](int body, const double* side) {
      const BodyData& data = system_.bodies[body];
      for (int c = 0; c < 3; ++c) {
        // Several parts of a row may act on the same body. The square of their sum is needed for `mobility`.
        double& sum = gradient(3 * body_index[body] + c, r);
        const double before = sum;
        sum += side[c];
        mobility[r] += side[c] * (side[c] + 2.0 * before) / (c < 2 ? data.mass : data.inertia);
      }
    });
    const double norm = gradient.col(r).norm();
    inverse_norm[r] = norm > 0.0 ? 1.0 / norm : 0.0;
    if (!part.rows[r].is_bounded) part.free_count = static_cast<int>(r) + 1;
  }
  gradient = gradient * inverse_norm.asDiagonal();
  const Eigen::Index free = part.free_count, bounded = count - free;

  // Find the null vectors of the joints alone, then those combinations of sticking wrenches that do no work on the motions which the joints
  // leave free.
  const PivotedQr joints(gradient.leftCols(free), k_dependent);
  const NullSpace idle = joints.null_space(k_no_part);
  NullSpace shared;
  if (bounded > 0) {
    MatX held = joints.complement().transpose() * gradient.rightCols(bounded);
    held = (held.array().abs() < k_exactly_dependent).select(0.0, held);
    std::vector<char> is_out;
    for (Eigen::Index r = free; r < count; ++r) is_out.push_back(left_out_[part.rows[r].slot]);
    shared = null_space_of(held, is_out);
  }
  const Eigen::Index k = shared.vectors.cols();
  part.shared_count = static_cast<int>(k);
  part.null.setZero(count, k + idle.vectors.cols());
  part.null.topRightCorner(free, idle.vectors.cols()) = idle.vectors;
  if (k > 0) {
    part.null.bottomLeftCorner(bounded, k) = shared.vectors;
    if (joints.rank() > 0) part.null.topLeftCorner(free, k) = joints.solve(-gradient.rightCols(bounded) * shared.vectors);
  }
  part.null = inverse_norm.asDiagonal() * part.null;
  const auto vectors = part.null.topRightCorner(free, idle.vectors.cols());
  const MatX weighted = vectors.transpose() * mobility.head(free).asDiagonal();
  if (vectors.cols() > 0) part.settle = -solve_symmetric(MatX(weighted * vectors), weighted);
  if (k > 0) make_groups(part, shared.pivots, shared.vectors);
}

// Makes the groups: elements with components in the same null vector belong to one group.
void LoadSharing::make_groups(ConnectedRows& part, const std::vector<int>& pivots, const MatX& basis) {
  const auto element_of = [&](Eigen::Index row) { return part.rows[part.free_count + row].friction; };
  std::vector<int> parent(system_.frictions.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (Eigen::Index j = 0; j < basis.cols(); ++j)
    for (Eigen::Index r = 0; r < basis.rows(); ++r)
      if (basis(r, j) != 0.0) parent[find_root(parent, element_of(r))] = find_root(parent, element_of(pivots[j]));
  std::vector<int> roots;
  for (Eigen::Index j = 0; j < basis.cols(); ++j) roots.push_back(find_root(parent, element_of(pivots[j])));
  std::vector<int> distinct = roots;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  for (const int root : distinct) {
    std::vector<int> rows, frictions, slots, dimension, columns, own_pivots;
    std::vector<double> length;
    double gyration = 0.0;
    for (Eigen::Index r = 0; r < basis.rows(); ++r) {
      const HeldRow& row = part.rows[part.free_count + r];
      if (find_root(parent, row.friction) != root) continue;
      if (frictions.empty() || frictions.back() != row.friction) {
        frictions.push_back(row.friction);
        dimension.push_back(0);
        group_of_[row.friction] = static_cast<int>(groups_.size());
      }
      ++dimension.back();
      rows.push_back(static_cast<int>(r));
      slots.push_back(row.slot);
      for (const int body : {row.spec->a, row.spec->b})
        if (body != k_ground) gyration = std::max(gyration, std::sqrt(system_.bodies[body].inertia / system_.bodies[body].mass));
    }
    for (const int r : rows) length.push_back(part.rows[part.free_count + r].spec->kind == MeasureKind::angle ? gyration : 1.0);
    for (std::size_t j = 0; j < roots.size(); ++j)
      if (roots[j] == root) {
        columns.push_back(static_cast<int>(j));
        own_pivots.push_back(static_cast<int>(std::find(rows.begin(), rows.end(), pivots[j]) - rows.begin()));
      }
    MatX own(rows.size(), columns.size());
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t j = 0; j < columns.size(); ++j)
        own(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(j)) = part.null(part.free_count + rows[r], columns[j]);
    part.groups.push_back(static_cast<int>(groups_.size()));
    part.columns.push_back(std::move(columns));
    groups_.push_back({std::move(frictions), std::move(slots),
                       LeastUsage(std::move(dimension), std::move(own), std::move(own_pivots), std::move(length))});
  }
}

// Returns for each null vector n the residual of Jᵀ n at the poses `motion`, relative to its terms.
VecX LoadSharing::off_balance(const ConnectedRows& part, const std::vector<Motion<double>>& motion) const {
  const Eigen::Index vectors = part.null.cols();
  MatX sum = MatX::Zero(3 * static_cast<Eigen::Index>(system_.bodies.size()), vectors);
  VecX size = VecX::Zero(vectors);
  for (std::size_t r = 0; r < part.rows.size(); ++r) {
    const auto row = part.null.row(static_cast<Eigen::Index>(r));
    for_sides(*part.rows[r].spec, motion, [&](int body, const double* side) {
      for (int c = 0; c < 3; ++c) {
        sum.row(3 * body + c) += side[c] * row;
        size += std::abs(side[c]) * row.cwiseAbs().transpose();
      }
    });
  }
  for (Eigen::Index j = 0; j < vectors; ++j) size[j] = size[j] > 0.0 ? sum.col(j).lpNorm<Eigen::Infinity>() / size[j] : 0.0;
  return size;
}

// Null vectors of nearly dependent rows have a residual from the start (`off`), so only its change counts.
bool LoadSharing::holds_at(const std::vector<Motion<double>>& motion, const std::vector<char>& left_out) const {
  if (left_out != left_out_) return false;
  return std::all_of(parts_.begin(), parts_.end(),
                     [&](const ConnectedRows& part) { return ((off_balance(part, motion) - part.off).array() <= k_out_of_balance).all(); });
}

namespace {

class FrictionGauges final : public Gauges {
public:
  FrictionGauges(const System& system, const Evaluation& evaluation, const std::vector<int>& frictions)
      : system_(system), evaluation_(evaluation), frictions_(frictions) {}
  [[nodiscard]] double support(int part, const double* rate) const override {
    const int f = frictions_[part];
    return system_.frictions[f].friction->support(evaluation_, evaluation_.friction[f], rate);
  }
  double gauge(int part, const double* wrench, double* normal) const override {
    const int f = frictions_[part];
    return system_.frictions[f].friction->gauge(evaluation_, evaluation_.friction[f], wrench, normal);
  }

private:
  const System& system_;
  const Evaluation& evaluation_;
  const std::vector<int>& frictions_;
};

} // namespace

namespace {

// Returns an upper bound of |J c| for a gradient J with the length and lever of j in any direction. The direction of a row is known to
// k_discord rad only, so k_discord times this bound is rounding.
double across(const double* j, const double* c) {
  return (std::abs(j[0]) + std::abs(j[1])) * (std::abs(c[0]) + std::abs(c[1])) + std::abs(j[2] * c[2]);
}

// Sums over the rows of a null vector, and sums of the absolute terms, which give the rounding errors.
struct Discord {
  double gap = 0.0, rate = 0.0, second = 0.0; ///< incompatibility of position, m, velocity, m/s, and acceleration, m/s²
  double moved = 0.0, rate_terms = 0.0, second_terms = 0.0;
  double length = 0.0, farthest = 0.0;

  [[nodiscard]] double size() const {
    const double known_gap = (k_least_gap + k_place_rounding * farthest) * length + k_discord * moved;
    return std::max({std::abs(gap) / known_gap, std::abs(rate) / (k_discord * rate_terms + k_least_rate * length),
                     std::abs(second) / (k_discord * second_terms + k_least_acceleration * length)});
  }
};

// Adds a row, whose factor in the null vector is n, to `sum`. `is_led`: the null vector contains joints or drives, so that rounding of the
// displacement since the start counts, too.
void add_row(const System& system, const RowSpec& spec, double n, bool is_led, const Evaluation& e, const double* acceleration,
             Discord& sum) {
  const auto m = evaluate_row<true>(spec, e.motion);
  const SignalJet target = row_target(spec, e.bases, e.t);
  double along = m.bias - target.acceleration, terms = std::abs(m.bias) + std::abs(target.acceleration);
  double rate_terms = std::abs(m.rate) + std::abs(target.rate), moved = 0.0;
  for (const RowSpec* piece = &spec; piece; piece = piece->next) {
    const RowGradient<double> gradient = gradient_of(spec.next ? evaluate_row<true>(*piece, e.motion[piece->a], e.motion[piece->b]) : m);
    for (const int side : {0, 1}) {
      const int body = side == 0 ? piece->a : piece->b;
      if (body == k_ground) continue;
      const Motion<double>& motion = e.motion[body];
      const Vec3& start = system.bodies[body].pose;
      const double* const j = gradient.side(side);
      const double way[3] = {motion.x - start[0], motion.y - start[1], motion.theta - start[2]};
      const double v[3] = {motion.vx, motion.vy, motion.omega};
      for (int c = 0; c < 3; ++c) along += j[c] * acceleration[3 * body + c];
      terms += across(j, acceleration + 3 * static_cast<std::ptrdiff_t>(body));
      rate_terms += across(j, v);
      if (is_led) moved += across(j, way);
      sum.farthest = std::max({sum.farthest, std::abs(motion.x), std::abs(motion.y)});
    }
  }
  sum.gap += n * off_target(spec, m.value, target.value);
  sum.rate += n * (m.rate - target.rate);
  sum.second += n * along;
  sum.moved += std::abs(n) * moved;
  sum.rate_terms += std::abs(n) * rate_terms;
  sum.second_terms += std::abs(n) * terms;
  sum.length += std::abs(n);
}

} // namespace

double LoadSharing::discord(int group, const Evaluation& e, const double* acceleration) const {
  double worst = 0.0;
  for (const ConnectedRows& part : parts_)
    for (std::size_t g = 0; g < part.groups.size(); ++g) {
      if (part.groups[g] != group) continue;
      for (const int column : part.columns[g]) {
        const auto n = part.null.col(column);
        const bool is_led = part.free_count > 0 && n.head(part.free_count).cwiseAbs().maxCoeff() > 0.0;
        Discord sum;
        for (std::size_t r = 0; r < part.rows.size(); ++r)
          if (const double share = n[static_cast<Eigen::Index>(r)]; share != 0.0)
            add_row(system_, *part.rows[r].spec, share, is_led, e, acceleration, sum);
        worst = std::max(worst, sum.size());
      }
    }
  return worst;
}

void LoadSharing::solve(const Evaluation& evaluation, const double* friction_force) {
  for (SharingGroup& group : groups_) {
    VecX wrench(group.slot.size());
    for (std::size_t r = 0; r < group.slot.size(); ++r) wrench[static_cast<Eigen::Index>(r)] = friction_force[group.slot[r]];
    group.least.solve(FrictionGauges(system_, evaluation, group.frictions), wrench);
    // If the iteration limit was reached, u is known only between two bounds; if 1 lies between them, it is unknown whether the group
    // sticks.
    if (group.least.usage() > 1.0 && group.least.lower() < 1.0 - k_open)
      throw ElementFailure("whether '" + system_.element_names[system_.frictions[group.frictions.front()].element] +
                               "' and what shares its load hold cannot be told at t = " + rounded_text(evaluation.t, 12) + " s: between " +
                               rounded_text(group.least.lower()) + " and " + rounded_text(group.least.usage()) +
                               " of the capacity are needed. Give feet of one pair of bodies a common coulomb_stick",
                           {system_.element_names[system_.frictions[group.frictions.front()].element]});
  }
}

std::vector<Release> LoadSharing::releases(int index) const {
  const SharingGroup& group = groups_[index];
  std::vector<Release> found;
  Eigen::Index row = 0;
  for (const int f : group.frictions) {
    Release release;
    release.friction = f;
    bool moves = false;
    for (int r = 0; r < system_.frictions[f].friction->dimension(); ++r, ++row) {
      release.wrench[r] = group.least.wrench()[row];
      moves = moves || group.least.rates()[row] != 0.0;
    }
    if (moves) found.push_back(release);
  }
  return found;
}

void LoadSharing::settle(double* row_force, double* friction_force) const {
  for (const ConnectedRows& part : parts_) {
    const auto slot = [&](Eigen::Index r) -> double& {
      const HeldRow& row = part.rows[r];
      return row.friction < 0 ? row_force[row.slot] : friction_force[row.slot];
    };
    VecX z = VecX::Zero(part.null.cols());
    for (std::size_t g = 0; g < part.groups.size(); ++g) {
      const VecX& own = groups_[part.groups[g]].least.settled();
      for (std::size_t j = 0; j < part.columns[g].size(); ++j) z[part.columns[g][j]] = own[static_cast<Eigen::Index>(j)];
    }
    VecX force(part.null.rows());
    for (Eigen::Index r = 0; r < force.size(); ++r) force[r] = slot(r);
    force += part.null.leftCols(part.shared_count) * z.head(part.shared_count);
    if (part.settle.rows() > 0) force += part.null.rightCols(part.settle.rows()) * (part.settle * force.head(part.free_count));
    for (Eigen::Index r = 0; r < force.size(); ++r) slot(r) = force[r];
  }
}

} // namespace steplap
