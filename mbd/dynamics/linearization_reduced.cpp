// Linearization: from the clusters' coordinates to those of mechanisms and carriages.
#include "mbd/dynamics/carriage.h"
#include "mbd/dynamics/linearization.h"

#include <algorithm>
#include <array>
#include <utility>

namespace steplap {

Linearization::LeverRates Linearization::rates_of(const Lever& lever, int c) {
  if (lever.axis >= 0) return {lever.axis == c ? 1.0 : 0.0, 0.0, 0.0, 0.0};
  if (c == 2) return {lever.is_own ? 1.0 : 0.0, 0.0, 0.0, 0.0};
  const double along = c == 0 ? lever.arm.x : lever.arm.y, across = c == 0 ? -lever.arm.y : lever.arm.x;
  LeverRates r{across, -lever.omega * along, -lever.alpha * along - lever.omega * lever.omega * across,
               -2.0 * lever.omega * along};
  if (!lever.has_slide) return r;
  r.rate_by_pose += c == 0 ? lever.rate_by_pose.x : lever.rate_by_pose.y;
  r.acceleration_by_pose += c == 0 ? lever.acceleration_by_pose.x : lever.acceleration_by_pose.y;
  r.acceleration_by_rate += c == 0 ? lever.acceleration_by_rate.x : lever.acceleration_by_rate.y;
  return r;
}

Linearization::Lever Linearization::place_lever(int coordinate, int axis) {
  return {coordinate, axis, false, 0.0, 0.0, {}, false, {}, {}, {}};
}

void Linearization::find_levers() {
  const double* const s = dy_.data() + n_;
  levers_.resize(layout_->clusters.size());
  for (std::vector<Lever>& levers : levers_) levers.clear();
  for (const Mechanism& m : layout_->mechanisms)
    for (std::size_t i = 0; i < m.members.size(); ++i) {
      if (m.members[i].cluster < 0) continue;
      std::vector<Lever>& levers = levers_[m.members[i].cluster];
      Pair<double> arm = m.lever(static_cast<int>(i));
      for (int at = static_cast<int>(i); at >= 0; at = m.members[at].parent) {
        const Member& member = m.members[at];
        const int coordinate = m.first_coordinate + member.coordinate;
        levers.push_back({coordinate, -1, at == static_cast<int>(i), m.spin(at), s[coordinate], arm, false, {}, {}, {}});
        arm = m.arm(at);
        if (!member.is_free) continue;
        levers.push_back(place_lever(coordinate - 2, 0));
        levers.push_back(place_lever(coordinate - 1, 1));
      }
    }
  if (layout_->carriages) find_carriage_levers();
}

// A slide s along e is as what an angle would do to −n, if it turned with the carrier: rate e, and the rest. The
// carrier's angle turns e with it: ṡ n, s̈ n − 2ω ṡ e.
void Linearization::find_carriage_levers() {
  const double* const s = dy_.data() + n_;
  for (const Carriage& k : layout_->carriages->carriages) {
    std::vector<Lever>& levers = levers_[k.cluster];
    double alpha = 0.0;
    if (k.carrier >= 0) {
      const int on = 3 * layout_->carriages->carriers[k.carrier].cluster;
      alpha = s[on + 2];
      levers.push_back(place_lever(on, 0));
      levers.push_back(place_lever(on + 1, 1));
      const double turned = 2.0 * k.omega * k.rate;
      levers.push_back({on + 2, -1, true, k.omega, alpha, k.lever, true, k.rate * k.n,
                        s[k.coordinate] * k.n - turned * k.e, (2.0 * k.rate) * k.n});
    }
    levers.push_back({k.coordinate, -1, false, k.omega, alpha, -1.0 * k.n, false, {}, {}, {}});
  }
}

// Calls f(coordinate, rates) for whatever moves a cluster's coordinate; one that is absolute moves itself.
template <class F> void Linearization::for_levers(int at, const F& f) const {
  if (at < 3 * layout_->absolute_count) return f(at, LeverRates{1.0, 0.0, 0.0, 0.0});
  for (const Lever& lever : levers_[at / 3]) f(lever.coordinate, rates_of(lever, at % 3));
}

void Linearization::reduce() {
  find_levers();
  reduce_rows();
  kept_pose_.clear();
  kept_rate_.clear();
  const int absolute = 3 * layout_->absolute_count;
  for (const Triplet& e : stiffness_)
    if (e.row() < absolute && !is_of_carrier(e.row()))
      for_levers(e.col(), [&](int at, const LeverRates& r) { put(kept_pose_, e.row(), at, e.value() * r.rate); });
  for (const Triplet& e : damping_)
    if (e.row() < absolute && !is_of_carrier(e.row()))
      for_levers(e.col(), [&](int at, const LeverRates& r) {
        put(kept_rate_, e.row(), at, e.value() * r.rate);
        if (e.col() >= absolute) put(kept_pose_, e.row(), at, e.value() * r.rate_by_pose);
      });
  for (const Mechanism& m : layout_->mechanisms) reduce_forces(m);
  if (layout_->carriages) {
    const Carriages& all = *layout_->carriages;
    for (int i = 0; i < static_cast<int>(all.carriages.size()) && all.carriages[i].carrier < 0; ++i)
      reduce_carriages(nullptr, i, i + 1);
    for (const Carrier& k : all.carriers) reduce_carriages(&k, k.begin, k.end);
  }
  stiffness_.swap(kept_pose_);
  damping_.swap(kept_rate_);
  // They take each other's places, the next time, too: with the same room none grows within a step.
  std::size_t room = 0;
  const auto all = {&stiffness_, &damping_, &gradient_, &bias_q_, &bias_v_, &response_, &kept_gradient_, &kept_pose_, &kept_rate_};
  for (const auto* entries : all) room = std::max(room, entries->capacity());
  for (auto* entries : all) entries->reserve(room);
}

// Gradients, and what the rows' slack changes by: the clusters' accelerations at constant s̈ change with the state.
void Linearization::reduce_rows() {
  const int absolute = 3 * layout_->absolute_count;
  for (auto* entries : {&kept_gradient_, &kept_pose_, &kept_rate_}) entries->clear();
  for (const Triplet& e : gradient_)
    for_levers(e.col(), [&](int at, const LeverRates& r) {
      kept_gradient_.emplace_back(e.row(), at, e.value() * r.rate);
      if (at < absolute) {
        if (!is_of_carrier(at)) response_.emplace_back(at, e.row(), (*inverse_mass_)[at] * e.value());
        return;
      }
      kept_pose_.emplace_back(e.row(), at, -e.value() * r.acceleration_by_pose);
      kept_rate_.emplace_back(e.row(), at, -e.value() * r.acceleration_by_rate);
    });
  for (const Triplet& e : bias_q_)
    for_levers(e.col(), [&](int at, const LeverRates& r) { kept_pose_.emplace_back(e.row(), at, e.value() * r.rate); });
  for (const Triplet& e : bias_v_)
    for_levers(e.col(), [&](int at, const LeverRates& r) {
      kept_rate_.emplace_back(e.row(), at, e.value() * r.rate);
      if (at >= absolute) kept_pose_.emplace_back(e.row(), at, e.value() * r.rate_by_pose);
    });
  if (layout_->carriages) respond_on_carriers();
  gradient_.swap(kept_gradient_);
  bias_q_.swap(kept_pose_);
  bias_v_.swap(kept_rate_);
  for (const Mechanism& m : layout_->mechanisms)
    for (int r = 0; r < m.row_count; ++r) {
      std::array<double, Mechanism::k_most> x{};
      std::copy_n(m.gradient(r), m.size(), x.begin());
      m.solve_mass(x.data());
      for (int i = 0; i < m.size(); ++i) response_.emplace_back(m.first_coordinate + i, m.first_row + r, x[i]);
    }
}

void Linearization::start_columns(int rows) {
  if (by_pose_.cols() != n_ || by_pose_.rows() < rows) {
    by_pose_.resize(std::max(rows, Mechanism::k_most), n_);
    by_rate_.resize(by_pose_.rows(), n_);
  }
  by_pose_.setZero();
  by_rate_.setZero();
  is_touched_.assign(n_, 0);
}

// M⁻¹ K_s and M⁻¹ D_s of one mechanism, column by column.
void Linearization::reduce_forces(const Mechanism& m) {
  start_columns(Mechanism::k_most);
  const auto is_here = [&m](int row) {
    return row / 3 >= m.first_cluster && row / 3 < m.first_cluster + m.cluster_count();
  };
  const auto add = [&](const Triplet& e, bool is_damping) {
    if (!is_here(e.row())) return;
    for (const Lever& lever : levers_[e.row() / 3]) {
      const int i = lever.coordinate - m.first_coordinate;
      const double v = rates_of(lever, e.row() % 3).rate * e.value();
      for_levers(e.col(), [&](int at, const LeverRates& r) {
        is_touched_[at] = 1;
        (is_damping ? by_rate_ : by_pose_)(i, at) += v * r.rate;
        if (is_damping) by_pose_(i, at) += v * r.rate_by_pose;
      });
    }
  };
  for (const Triplet& e : stiffness_) add(e, false);
  for (const Triplet& e : damping_) add(e, true);
  for (const Member& member : m.members)
    if (member.cluster >= 0) add_inertia(m, member);
  std::array<double, Mechanism::k_most> x{};
  for (int column = 0; column < n_; ++column) {
    if (is_touched_[column] == 0) continue;
    for (auto [matrix, entries] : {std::pair{&by_pose_, &kept_pose_}, std::pair{&by_rate_, &kept_rate_}}) {
      for (int i = 0; i < m.size(); ++i) x[i] = (*matrix)(i, column);
      m.solve_mass(x.data());
      for (int i = 0; i < m.size(); ++i) put(*entries, m.first_coordinate + i, column, x[i]);
    }
  }
}

// −Tᵀ m ∂a/∂s and (∂Tᵀ/∂s)(Q + Jᵀλ − m a) of one cluster: what an angle turns changes its direction by the angle.
void Linearization::add_inertia(const Mechanism& m, const Member& member) {
  const BodyForce& f = dynamics_->evaluation().force[member.slot];
  const double* const a = acceleration_ + 3 * member.cluster;
  const Vec2& gravity = dynamics_->system().gravity;
  Pair<double> net{f.fx + member.mass * (gravity.x() - a[0]), f.fy + member.mass * (gravity.y() - a[1])};
  for (int r = m.first_row; r < m.first_row + m.row_count; ++r)
    for (int side = 0; side < 2; ++side) {
      const SchurRow& row = layout_->schur_rows[r];
      if (row.body[side] != member.cluster) continue;
      net = net + dynamics_->multipliers()[r] * Pair<double>{row.j[side][0], row.j[side][1]};
    }
  const std::vector<Lever>& levers = levers_[member.cluster];
  for (const Lever& lever : levers) {
    const int i = lever.coordinate - m.first_coordinate;
    is_touched_[lever.coordinate] = 1;
    if (lever.axis < 0) by_pose_(i, lever.coordinate) -= dot(lever.arm, net);
    for (int c = 0; c < 2; ++c) {
      const double pull = member.mass * rates_of(lever, c).rate;
      for (const Lever& other : levers) {
        const LeverRates r = rates_of(other, c);
        by_pose_(i, other.coordinate) -= pull * r.acceleration_by_pose;
        by_rate_(i, other.coordinate) -= pull * r.acceleration_by_rate;
      }
    }
  }
}

// --- carriages ----------------------------------------------------------------------------------------

bool Linearization::is_of_carrier(int coordinate) const {
  return layout_->carriages && layout_->carriages->find_carrier(coordinate / 3);
}

// Rows act on carriers alone; what stands on them gives way along its guide.
void Linearization::respond_on_carriers() {
  const Carriages& all = *layout_->carriages;
  for (int r = 0; r < layout_->schur.size(); ++r)
    for (int side = 0; side < 2; ++side) {
      const SchurRow& row = layout_->schur_rows[r];
      const Carrier* const carrier = all.find_carrier(row.body[side]);
      if (!carrier) continue;
      for (int c = 0; c < 3; ++c) response_.emplace_back(3 * carrier->cluster + c, r, row.wj[side][c]);
      for (int i = carrier->begin; i < carrier->end; ++i)
        response_.emplace_back(all.carriages[i].coordinate, r, -all.carriages[i].along_e(row.wj[side]));
    }
}

// M⁻¹ K_s and M⁻¹ D_s of a carrier, if there is one, and of what stands on it.
void Linearization::reduce_carriages(const Carrier* carrier, int begin, int end) {
  const Carriages& all = *layout_->carriages;
  const int first = carrier ? 3 : 0, rows = first + end - begin;
  start_columns(rows);
  const auto place_of = [&](int coordinate) {
    return carrier && coordinate < 3 * layout_->absolute_count ? coordinate - 3 * carrier->cluster
                                                              : first + coordinate - all.carriages[begin].coordinate;
  };
  const auto add_at = [&](int i, double v, const Triplet& e, bool is_damping) {
    for_levers(e.col(), [&](int at, const LeverRates& r) {
      is_touched_[at] = 1;
      (is_damping ? by_rate_ : by_pose_)(i, at) += v * r.rate;
      if (is_damping) by_pose_(i, at) += v * r.rate_by_pose;
    });
  };
  const auto add = [&](const Triplet& e, bool is_damping) {
    const int cluster = e.row() / 3;
    if (carrier && cluster == carrier->cluster) return add_at(e.row() % 3, e.value(), e, is_damping);
    if (cluster < all.carriages[begin].cluster || cluster >= all.carriages[begin].cluster + end - begin) return;
    for (const Lever& lever : levers_[cluster])
      add_at(place_of(lever.coordinate), rates_of(lever, e.row() % 3).rate * e.value(), e, is_damping);
  };
  for (const Triplet& e : stiffness_) add(e, false);
  for (const Triplet& e : damping_) add(e, true);
  for (int i = begin; i < end; ++i) add_carriage_inertia(all.carriages[i], 0, first + i - begin);
  for (int column = 0; column < n_; ++column) {
    if (is_touched_[column] == 0) continue;
    for (auto [matrix, entries] : {std::pair{&by_pose_, &kept_pose_}, std::pair{&by_rate_, &kept_rate_}}) {
      double on[3] = {0.0, 0.0, 0.0}, force[3] = {0.0, 0.0, 0.0};
      for (int c = 0; c < first; ++c) force[c] = (*matrix)(c, column);
      for (int i = begin; i < end && carrier; ++i) {
        const Carriage& k = all.carriages[i];
        const double along = (*matrix)(first + i - begin, column);
        force[0] -= along * k.e.x;
        force[1] -= along * k.e.y;
        force[2] += along * k.across;
      }
      if (carrier) carrier->multiply(force, on);
      for (int c = 0; c < first; ++c) put(*entries, 3 * carrier->cluster + c, column, on[c]);
      for (int i = begin; i < end; ++i) {
        const Carriage& k = all.carriages[i];
        put(*entries, k.coordinate, column, (*matrix)(first + i - begin, column) / k.mass - k.along_e(on));
      }
    }
  }
}

// As of a mechanism's member; the guide turns with the carrier. `at`, `slide`: rows of the carrier's x and of the slide.
void Linearization::add_carriage_inertia(const Carriage& k, int at, int slide) {
  const BodyForce& f = dynamics_->evaluation().force[k.slot];
  const double* const a = acceleration_ + 3 * k.cluster;
  const Pair<double> net{f.fx + k.weight.x - k.mass * a[0], f.fy + k.weight.y - k.mass * a[1]};
  const std::vector<Lever>& levers = levers_[k.cluster];
  const auto row_of = [&](const Lever& lever) {
    return lever.coordinate == k.coordinate ? slide : at + lever.coordinate % 3;
  };
  for (const Lever& lever : levers) {
    const int i = row_of(lever);
    is_touched_[lever.coordinate] = 1;
    if (lever.has_slide) {
      by_pose_(i, lever.coordinate) -= dot(lever.arm, net);
      by_pose_(i, k.coordinate) += dot(k.n, net);
      by_pose_(slide, lever.coordinate) += dot(k.n, net);
    }
    for (int c = 0; c < 2; ++c) {
      const double pull = k.mass * rates_of(lever, c).rate;
      for (const Lever& other : levers) {
        const LeverRates r = rates_of(other, c);
        by_pose_(i, other.coordinate) -= pull * r.acceleration_by_pose;
        by_rate_(i, other.coordinate) -= pull * r.acceleration_by_rate;
      }
    }
  }
}

} // namespace steplap
