#include "mbd/integrators/contact_impacts.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Accuracy of the share w, relative to 1, in a landing relative to w. Newton's method leaves an error of its square in the force: far below
// the error of the method.
constexpr double k_settled = 0.02;
// Passes in which w is adapted. From too large a w in a landing Newton's method halves it, so that contacts are resolved up to some hundred
// rad of their vibration in a step; stiffer ones come to rest.
constexpr int k_most_passes = 8;
// A contact rebounds if it closes faster than loads change its velocity in so many steps. With the change a h in a step, a slower rebound
// rises by at most 18 a h² and lasts 12 steps, in which implicit Euler errs by 6 a h².
constexpr double k_steps_of_rest = 6.0;

} // namespace

ContactImpacts::ContactImpacts(const System& system) {
  // Own states follow the motion of coordinates that move with the velocity at the end of a step.
  if (system.inner_count() > 0) return;
  for (std::size_t g = 0; g < system.groups.size(); ++g)
    if (const GapSource* const gaps = system.groups[g]->gap_source()) sources_.push_back({gaps, g, {}});
  for (std::size_t u = 0; u < system.units.size(); ++u)
    for (Source& source : sources_)
      if (system.units[u].group == system.groups[source.group].get()) {
        source.units.resize(std::max(source.units.size(), static_cast<std::size_t>(system.units[u].index) + 1), system.units.size());
        source.units[static_cast<std::size_t>(system.units[u].index)] = u;
      }
  if (sources_.empty()) return;
  phase_.assign(system.units.size(), Phase::none);
  next_phase_ = phase_;
  impact_.assign(system.units.size(), {});
  gap0_.assign(system.units.size(), 0.0);
  gap1_ = gap0_;
  // Nothing is allocated at the first impact, which may be late in a run.
  const auto coordinates = 3 * static_cast<std::size_t>(system.body_count());
  forces_.reserve(system.units.size());
  bounds_.reserve(system.units.size());
  mean_.reserve(coordinates);
  change_.reserve(2 * coordinates);
  sum_.reserve(coordinates + system.rows.size() + static_cast<std::size_t>(system.friction_row_count));
  vectors_.place.reserve(coordinates);
  vectors_.value.reserve(coordinates);
}

void ContactImpacts::read_gaps(const Motion<double>* motion, std::vector<double>& gaps) {
  for (const Source& source : sources_) {
    bounds_.clear();
    source.gaps->add_gaps(motion, bounds_);
    for (std::size_t i = 0; i < source.units.size() && i < bounds_.size(); ++i)
      if (source.units[i] < gaps.size()) gaps[source.units[i]] = bounds_[i].gap;
  }
}

void ContactImpacts::begin_part(Dynamics& dynamics, const State& start) {
  if (impact_.empty()) return;
  read_gaps(dynamics.motion().data(), gap0_);
  for (std::size_t u = 0; u < impact_.size(); ++u) {
    impact_[u] = {};
    impact_[u].is_on = phase_[u] != Phase::none && start.mode[u] == k_contact_pressed && gap0_[u] < 0.0;
  }
}

void ContactImpacts::end_pass(Dynamics& dynamics) {
  if (!impact_.empty()) read_gaps(dynamics.motion().data(), gap1_);
}

void ContactImpacts::land(std::size_t unit, double rate0, double rate1) {
  if (!(-rate0 > k_steps_of_rest * std::abs(rate1 - rate0))) return; // also for NaN: rate unknown
  Impact& impact = impact_[unit];
  impact.is_on = impact.lands = true;
  impact.share = -gap1_[unit] / (gap0_[unit] - gap1_[unit]);
}

bool ContactImpacts::refine(std::size_t unit, UnitMode mode) {
  Impact& impact = impact_[unit];
  const double used = impact.share, gap0 = gap0_[unit], gap1 = gap1_[unit];
  impact.end_mode = mode;
  if (!impact.lands) {
    impact.leaves = gap1 > 0.0;
    impact.share = impact.leaves ? -gap0 / (gap1 - gap0) : 1.0;
    return std::abs(impact.share - used) > k_settled && ++impact.passes < k_most_passes;
  }
  impact.share = -gap1 / (gap0 - gap1);
  if (gap1 < 0.0 && std::abs(impact.share - used) <= k_settled * used) return false;
  if (gap1 < 0.0 && ++impact.passes < k_most_passes) return true;
  impact = {}; // another contact keeps it open, or it is so stiff that Newton's method does not reach its small share
  impact.is_refused = true;
  return true;
}

bool ContactImpacts::acts_between(int a, int b) const {
  return std::any_of(forces_.begin(), forces_.end(), [&](const Force& force) {
    return (force.body[0] == a && force.body[1] == b) || (force.body[0] == b && force.body[1] == a);
  });
}

void ContactImpacts::set_force_modes(std::vector<UnitMode>& modes) const {
  for (std::size_t u = 0; u < impact_.size(); ++u)
    if (impact_[u].is_on) modes[u] = k_contact_pressed;
}

void ContactImpacts::set_friction_modes(std::vector<UnitMode>& modes) const {
  for (std::size_t u = 0; u < impact_.size(); ++u)
    if (impact_[u].is_on && impact_[u].leaves) modes[u] = k_contact_open;
}

void ContactImpacts::set_end_modes(std::vector<UnitMode>& modes) const {
  for (std::size_t u = 0; u < impact_.size(); ++u)
    if (impact_[u].is_on) modes[u] = impact_[u].end_mode;
}

void ContactImpacts::note_end() {
  for (std::size_t u = 0; u < impact_.size(); ++u) {
    next_phase_[u] = Phase::none;
    if (!impact_[u].is_on || impact_[u].end_mode != k_contact_pressed) continue;
    const bool approaches = gap1_[u] < gap0_[u];
    if (approaches && phase_[u] == Phase::rebound) continue; // it has rebounded without opening
    next_phase_[u] = approaches ? Phase::approach : Phase::rebound;
  }
}

// The direction G of the normal force N, with the force F = N G on both bodies, follows from the derivatives by the velocities of the bodies,
// of which G is independent: ∂F/∂v = G ∂N/∂v. Without damping it follows from those by the poses, up to the change of G within the
// penetration.
void ContactImpacts::weigh(const Evaluation& e, std::vector<PairJacobian>& parts, const std::vector<std::size_t>& first_of_group) {
  forces_.clear();
  for (const Source& source : sources_) {
    const std::size_t first = first_of_group[source.group];
    for (std::size_t i = 0; i < source.units.size(); ++i) {
      if (source.units[i] >= impact_.size() || !impact_[source.units[i]].is_on) continue;
      Impact& impact = impact_[source.units[i]];
      PairJacobian& part = parts[first + i];
      const Eigen::Matrix<double, 6, 1> by_pose = part.normal.head<6>(), by_velocity = part.normal.tail<6>();
      const bool is_damped = by_velocity.squaredNorm() > 0.0;
      const Eigen::Matrix<double, 6, 1>& x = is_damped ? by_velocity : by_pose;
      const double square = x.squaredNorm();
      if (impact.lands && !(square > 0.0)) { // its law has no force before it closes: penetrating without one would add energy
        impact = {};
        impact.is_refused = true;
        continue;
      }
      Force& force = forces_.emplace_back();
      force.body[0] = part.a;
      force.body[1] = part.b;
      force.missing = impact.share - 1.0;
      force.value.setZero();
      if (square > 0.0) force.value = e.contact_force[part.contact] / square * ((is_damped ? part.damping : part.stiffness) * x);
      part.stiffness *= impact.slope();
      part.damping *= impact.slope();
    }
  }
}

void ContactImpacts::set_mean_motion(const Layout& layout, StageSystem& stages) {
  mean_.clear();
  for (const Force& force : forces_)
    for (const int body : force.body)
      if (const int cluster = layout.placements[body].cluster; cluster >= 0) {
        mean_.resize(layout.inverse_mass.size(), 1.0);
        std::fill_n(mean_.begin() + 3 * cluster, 3, 0.5);
      }
  stages.set_position_shares(mean_);
}

void ContactImpacts::add_forces(const Layout& layout, const std::vector<Motion<double>>& motion, StageSystem& stages, double* u) {
  const bool is_any = std::any_of(forces_.begin(), forces_.end(), [](const Force& force) { return force.missing != 0.0; });
  if (!is_any) return;
  sum_.assign(static_cast<std::size_t>(stages.places()), 0.0);
  for (const Force& force : forces_) {
    if (force.missing == 0.0 || layout.placements[force.body[0]].cluster == layout.placements[force.body[1]].cluster) continue;
    ForceRow row;
    const int lower = layout.placements[force.body[1]].cluster < layout.placements[force.body[0]].cluster ? 1 : 0;
    for (const int side : {lower, 1 - lower}) { // coordinates are ascending
      const Placement& place = layout.placements[force.body[side]];
      if (place.cluster < 0) continue;
      Vec3 f = force.value.segment<3>(3 * side);
      if (!place.is_trivial) {
        const Motion<double>&m = motion[force.body[side]], &centre = motion[layout.clusters[place.cluster].motion];
        f[2] += (m.x - centre.x) * f[1] - (m.y - centre.y) * f[0];
      }
      for (int c = 0; c < 3; ++c) {
        if (!(layout.inverse_mass[3 * place.cluster + c] > 0.0)) continue;
        row.coordinate[row.count] = 3 * place.cluster + c;
        row.gradient[row.count++] = f[c];
      }
    }
    vectors_.clear();
    stages.append_force(row, vectors_);
    for (std::size_t k = 0; k < vectors_.place.size(); ++k) sum_[vectors_.place[k]] += force.missing * vectors_.value[k];
  }
  const int n = static_cast<int>(layout.inverse_mass.size());
  change_.resize(2 * static_cast<std::size_t>(n));
  stages.finish_forces(sum_.data(), change_.data());
  for (int i = 0; i < 2 * n; ++i) u[i] += change_[i];
}

} // namespace steplap
