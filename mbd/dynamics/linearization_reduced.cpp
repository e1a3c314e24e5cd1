// Linearization: conversion from the coordinates of clusters to those of mechanisms.
#include "mbd/dynamics/linearization.h"

#include <algorithm>
#include <array>
#include <utility>

namespace steplap {

Linearization::LeverRates Linearization::rates_of(const Lever& lever, int c) {
  if (lever.axis >= 0) return {lever.axis == c ? 1.0 : 0.0, 0.0, 0.0, 0.0};
  if (c == 2) return {lever.is_own ? 1.0 : 0.0, 0.0, 0.0, 0.0};
  const double along = c == 0 ? lever.arm.x : lever.arm.y, across = c == 0 ? -lever.arm.y : lever.arm.x;
  return {across, -lever.omega * along, -lever.alpha * along - lever.omega * lever.omega * across, -2.0 * lever.omega * along};
}

Linearization::Lever Linearization::place_lever(int coordinate, int axis) { return {coordinate, axis, false, 0.0, 0.0, {}}; }

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
        levers.push_back({coordinate, -1, at == static_cast<int>(i), m.spin(at), s[coordinate], arm});
        arm = m.arm(at);
        if (!member.is_free) continue;
        levers.push_back(place_lever(coordinate - 2, 0));
        levers.push_back(place_lever(coordinate - 1, 1));
      }
    }
}

// Calls f(coordinate, rates) for each coordinate that moves the cluster coordinate `at`. An absolute coordinate is moved by itself only.
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
    if (e.row() < absolute) for_levers(e.col(), [&](int at, const LeverRates& r) { put(kept_pose_, e.row(), at, e.value() * r.rate); });
  for (const Triplet& e : damping_)
    if (e.row() < absolute)
      for_levers(e.col(), [&](int at, const LeverRates& r) {
        put(kept_rate_, e.row(), at, e.value() * r.rate);
        if (e.col() >= absolute) put(kept_pose_, e.row(), at, e.value() * r.rate_by_pose);
      });
  for (const Mechanism& m : layout_->mechanisms) reduce_forces(m);
  stiffness_.swap(kept_pose_);
  damping_.swap(kept_rate_);
  // Gives all buffers the same capacity. They are swapped in the next call, and no step must allocate.
  std::size_t room = 0;
  const auto all = {&stiffness_, &damping_, &gradient_, &bias_q_, &bias_v_, &response_, &kept_gradient_, &kept_pose_, &kept_rate_};
  for (const auto* entries : all) room = std::max(room, entries->capacity());
  for (auto* entries : all) entries->reserve(room);
}

// Converts gradients and bias derivatives to joint coordinates. The accelerations of clusters at constant s̈ depend on the state, which
// adds terms.
void Linearization::reduce_rows() {
  const int absolute = 3 * layout_->absolute_count;
  for (auto* entries : {&kept_gradient_, &kept_pose_, &kept_rate_}) entries->clear();
  for (const Triplet& e : gradient_)
    for_levers(e.col(), [&](int at, const LeverRates& r) {
      kept_gradient_.emplace_back(e.row(), at, e.value() * r.rate);
      if (at < absolute) {
        response_.emplace_back(at, e.row(), (*inverse_mass_)[at] * e.value());
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

void Linearization::start_columns() {
  if (by_pose_.cols() != n_) {
    by_pose_.resize(Mechanism::k_most, n_);
    by_rate_.resize(Mechanism::k_most, n_);
  }
  by_pose_.setZero();
  by_rate_.setZero();
  is_touched_.assign(n_, 0);
}

// Computes M⁻¹ K_s and M⁻¹ D_s of one mechanism, column by column.
void Linearization::reduce_forces(const Mechanism& m) {
  start_columns();
  const auto is_here = [&m](int row) { return row / 3 >= m.first_cluster && row / 3 < m.first_cluster + m.cluster_count(); };
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

// Adds −Tᵀ m ∂a/∂s and (∂Tᵀ/∂s)(Q + Jᵀλ − m a) for one cluster. An angle changes only the directions of the vectors that it rotates.
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

} // namespace steplap
