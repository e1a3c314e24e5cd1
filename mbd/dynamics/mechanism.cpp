#include "mbd/dynamics/mechanism.h"

#include "mbd/math/portable_math.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

Pair<double> turned(double c, double s, const Pair<double>& p) { return {c * p.x - s * p.y, s * p.x + c * p.y}; }
double length(const Pair<double>& p) { return portable::hypot(p.x, p.y); }
void add(Pair<double>& to, const Pair<double>& p) {
  to.x += p.x;
  to.y += p.y;
}

} // namespace

// --- constants --------------------------------------------------------------------------------------

void Mechanism::close(int cluster_count, const Vec2& gravity) {
  gravity_ = {gravity.x(), gravity.y()};
  member_of_.assign(cluster_count, -1);
  moving_.assign(members.size(), {});
  packed_.assign(members.size(), {});
  path_.assign(members.size(), 0U);
  n_ = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    Member& m = members[i];
    if (m.cluster >= 0) member_of_[m.cluster - first_cluster] = static_cast<int>(i);
    int above = m.parent >= 0 ? members[m.parent].coordinate : -1;
    if (m.parent >= 0) path_[i] = path_[m.parent];
    for (int k = m.is_free ? 2 : 0; k >= 0; --k) {
      is_place_[n_] = k > 0 ? 1 : 0;
      up_[n_] = above;
      path_[i] |= 1U << n_;
      above = n_++;
    }
    m.coordinate = above;
    m.mass_below = m.mass;
    m.turning = m.inertia + m.mass * dot(m.centre, m.centre);
    m.moment = m.mass * m.centre;
  }
  // Inward; `beyond`: how far what hangs on a member can be from its pin.
  std::vector<double> beyond(members.size(), 0.0);
  for (std::size_t i = members.size(); i-- > 0;) {
    const Member& m = members[i];
    reach_[m.coordinate] = std::max(beyond[i], length(m.centre));
    if (m.parent < 0) continue;
    Member& above = members[m.parent];
    above.mass_below += m.mass_below;
    above.turning += m.mass_below * dot(m.pin, m.pin);
    add(above.moment, m.mass_below * m.pin);
    beyond[m.parent] = std::max(beyond[m.parent], length(m.pin) + reach_[m.coordinate]);
  }
  const auto rows = static_cast<std::size_t>(row_count);
  gradient_.assign(rows * n_, 0.0);
  white_.assign(rows * n_, 0.0);
  factor_.assign(rows * rows, 0.0);
  inverse_d_.assign(rows, 0.0);
  own_.assign(rows, 0.0);
}

// --- poses ------------------------------------------------------------------------------------------

STEPLAP_INLINE void Mechanism::turn_member(std::size_t i, const double* q, const double* v, Moving* all) const {
  const Member& m = members[i];
  Moving& now = all[i];
  Motion<double> turn;
  set_angle(turn, q[m.coordinate]);
  now.c = turn.c;
  now.s = turn.s;
  now.omega = v[m.coordinate];
  if (m.parent >= 0) {
    const Moving& above = all[m.parent];
    now.arm = turned(above.c, above.s, m.pin);
    now.o = above.o + now.arm;
    now.v = {above.v.x - above.omega * now.arm.y, above.v.y + above.omega * now.arm.x};
    now.bias = above.bias - (above.omega * above.omega) * now.arm;
  } else if (m.is_free) {
    now.o = {q[m.coordinate - 2], q[m.coordinate - 1]};
    now.v = {v[m.coordinate - 2], v[m.coordinate - 1]};
  } else {
    now.o = m.pin;
  }
  now.lever = turned(now.c, now.s, m.centre);
  now.moment = turned(now.c, now.s, m.moment);
}

void Mechanism::place(const double* q, const double* v, Motion<double>* motion) {
  std::copy(q, q + n_, placed_q_.begin());
  std::copy(v, v + n_, placed_v_.begin());
  for (std::size_t i = 0; i < members.size(); ++i) {
    turn_member(i, q, v, moving_.data());
    const Member& m = members[i];
    if (m.cluster < 0) continue;
    const Moving& now = moving_[i];
    Motion<double>& out = motion[m.slot];
    out.x = now.o.x + now.lever.x;
    out.y = now.o.y + now.lever.y;
    out.theta = q[m.coordinate];
    out.c = now.c;
    out.s = now.s;
    out.vx = now.v.x - now.omega * now.lever.y;
    out.vy = now.v.y + now.omega * now.lever.x;
    out.omega = now.omega;
  }
}

bool Mechanism::is_at(const double* q, const double* v) const {
  return std::equal(q, q + n_, placed_q_.begin()) && std::equal(v, v + n_, placed_v_.begin());
}

void Mechanism::unpack(const double* q, const double* v, double* cluster_q, double* cluster_v) const {
  for (std::size_t i = 0; i < members.size(); ++i) {
    turn_member(i, q, v, packed_.data());
    const Member& m = members[i];
    if (m.cluster < 0) continue;
    const Moving& now = packed_[i];
    double* const bq = cluster_q + 3 * m.cluster;
    double* const bv = cluster_v + 3 * m.cluster;
    bq[0] = now.o.x + now.lever.x;
    bq[1] = now.o.y + now.lever.y;
    bq[2] = q[m.coordinate];
    bv[0] = now.v.x - now.omega * now.lever.y;
    bv[1] = now.v.y + now.omega * now.lever.x;
    bv[2] = now.omega;
  }
}

// A rod points from its own pin to that of its end.
void Mechanism::pack(const double* cluster_q, const double* cluster_v, double* q, double* v) const {
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Member& m = members[i];
    const int k = m.coordinate;
    if (m.cluster >= 0) {
      const double* const bq = cluster_q + 3 * m.cluster;
      const double* const bv = cluster_v + 3 * m.cluster;
      for (int c = m.is_free ? 2 : 0; c >= 0; --c) {
        q[k - c] = bq[2 - c];
        v[k - c] = bv[2 - c];
      }
    } else {
      q[k] = v[k] = 0.0;
      turn_member(i, q, v, packed_.data()); // for the place of its pin
      const Member& end = members[i + 1];
      const double* const bq = cluster_q + 3 * end.cluster;
      const double* const bv = cluster_v + 3 * end.cluster;
      Motion<double> turn;
      set_angle(turn, bq[2]);
      const Pair<double> lever = turned(turn.c, turn.s, end.centre), o = packed_[i].o, vo = packed_[i].v;
      const Pair<double> along{bq[0] - lever.x - o.x, bq[1] - lever.y - o.y};
      const Pair<double> rate{bv[0] + bv[2] * lever.y - vo.x, bv[1] - bv[2] * lever.x - vo.y};
      q[k] = portable::atan2(along.y, along.x);
      v[k] = cross(along, rate) / dot(along, along);
    }
    turn_member(i, q, v, packed_.data());
  }
}

// --- forces and accelerations -----------------------------------------------------------------------

void Mechanism::factor_mass() {
  double* const h = mass_.data();
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Member& m = members[i];
    const Pair<double>& moment = moving_[i].moment;
    double* const row = h + static_cast<std::ptrdiff_t>(m.coordinate) * k_most;
    row[m.coordinate] = m.turning;
    std::size_t at = i;
    for (; members[at].parent >= 0; at = members[at].parent)
      row[members[members[at].parent].coordinate] = dot(moving_[at].arm, moment);
    const Member& root = members[at];
    if (!root.is_free) continue;
    const int x = root.coordinate - 2, y = x + 1;
    row[x] = -moment.y;
    row[y] = moment.x;
    h[x * k_most + x] = h[y * k_most + y] = root.mass_below;
    h[y * k_most + x] = 0.0;
  }
  for (int k = n_ - 1; k >= 0; --k) {
    double* const row = h + static_cast<std::ptrdiff_t>(k) * k_most;
    const double inverse = inverse_mass_[k] = 1.0 / row[k];
    for (int i = up_[k]; i >= 0; i = up_[i]) {
      const double a = row[i] * inverse;
      double* const other = h + static_cast<std::ptrdiff_t>(i) * k_most;
      for (int j = i; j >= 0; j = up_[j]) other[j] -= a * row[j];
      row[i] = a;
    }
  }
}

// x = L⁻ᵀ x.
void Mechanism::whiten(double* x) const {
  for (int i = n_ - 1; i > 0; --i) {
    const double* const row = mass_.data() + static_cast<std::ptrdiff_t>(i) * k_most;
    const double xi = x[i];
    for (int j = up_[i]; j >= 0; j = up_[j]) x[j] -= row[j] * xi;
  }
}

void Mechanism::solve_mass(double* x) const {
  whiten(x);
  for (int i = 0; i < n_; ++i) {
    const double* const row = mass_.data() + static_cast<std::ptrdiff_t>(i) * k_most;
    double sum = x[i] * inverse_mass_[i];
    for (int j = up_[i]; j >= 0; j = up_[j]) sum -= row[j] * x[j];
    x[i] = sum;
  }
}

void Mechanism::accelerate(const BodyForce* force, double* s) const {
  std::array<Pair<double>, k_most> carried{}; // from what hangs on the member
  std::array<double, k_most> couple{};
  for (std::size_t i = members.size(); i-- > 0;) {
    const Member& m = members[i];
    const Moving& now = moving_[i];
    Pair<double> sum = carried[i];
    double about = couple[i];
    if (m.cluster >= 0) {
      const BodyForce& f = force[m.slot];
      const Pair<double> bias = now.bias - (now.omega * now.omega) * now.lever;
      const Pair<double> own{f.fx + m.mass * (gravity_.x - bias.x), f.fy + m.mass * (gravity_.y - bias.y)};
      about += f.m + cross(now.lever, own);
      sum = sum + own;
    }
    s[m.coordinate] = about;
    if (m.is_free) {
      s[m.coordinate - 2] = sum.x;
      s[m.coordinate - 1] = sum.y;
    } else if (m.parent >= 0) {
      add(carried[m.parent], sum);
      couple[m.parent] += cross(now.arm, sum);
    }
  }
  solve_mass(s);
}

void Mechanism::expand(const double* s, double* cluster_a) const {
  std::array<Pair<double>, k_most> at_pin{};
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Member& m = members[i];
    const Moving& now = moving_[i];
    if (m.parent >= 0) {
      const Moving& above = moving_[m.parent];
      const double alpha = s[members[m.parent].coordinate], w2 = above.omega * above.omega;
      at_pin[i] = at_pin[m.parent] + Pair<double>{-alpha * now.arm.y - w2 * now.arm.x, alpha * now.arm.x - w2 * now.arm.y};
    } else if (m.is_free) {
      at_pin[i] = {s[m.coordinate - 2], s[m.coordinate - 1]};
    }
    if (m.cluster < 0) continue;
    const double alpha = s[m.coordinate], w2 = now.omega * now.omega;
    double* const a = cluster_a + 3 * m.cluster;
    a[0] = at_pin[i].x - alpha * now.lever.y - w2 * now.lever.x;
    a[1] = at_pin[i].y + alpha * now.lever.x - w2 * now.lever.y;
    a[2] = alpha;
  }
}

void Mechanism::pin_forces(const double* cluster_a, const BodyForce* force, const SchurRow* rows, const double* lambda,
                           std::vector<Pair<double>>& on_member) const {
  on_member.assign(members.size(), {});
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Member& m = members[i];
    if (m.cluster < 0) continue;
    const double* const a = cluster_a + 3 * m.cluster;
    const BodyForce& f = force[m.slot];
    on_member[i] = {m.mass * (a[0] - gravity_.x) - f.fx, m.mass * (a[1] - gravity_.y) - f.fy};
  }
  for (int r = 0; r < row_count; ++r)
    for (int side = 0; side < 2; ++side) {
      if (rows[r].body[side] < 0) continue;
      const double* const j = rows[r].j[side];
      add(on_member[member_of(rows[r].body[side])], {-lambda[r] * j[0], -lambda[r] * j[1]});
    }
  for (std::size_t i = members.size(); i-- > 0;)
    if (members[i].parent >= 0) add(on_member[members[i].parent], on_member[i]);
}

} // namespace steplap
