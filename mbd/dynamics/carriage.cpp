#include "mbd/dynamics/carriage.h"

#include <algorithm>

namespace steplap {

namespace {

// What places a carriage on its carrier.
struct Slide {
  Pair<double> e, n, lever;
};

STEPLAP_INLINE Slide slide_at(const Carriage& k, double c, double s, double place) {
  Slide now;
  now.e = {c * k.axis.x - s * k.axis.y, s * k.axis.x + c * k.axis.y};
  now.n = perp(now.e);
  now.lever = {place * now.e.x + k.across * now.n.x, place * now.e.y + k.across * now.n.y};
  return now;
}

// W of the coordinates that are not locked, of three by cofactors.
STEPLAP_INLINE void invert(Carrier& k) {
  const double* const m = k.m;
  double* const w = k.w;
  if (k.free_count == 2) [[likely]] {
    const int i = k.free[0], j = k.free[1], ij = Carrier::mixed(i, j);
    const double across = m[ij];
    const double inverse = 1.0 / (m[i] * m[j] - across * across);
    w[i] = inverse * m[j];
    w[j] = inverse * m[i];
    w[ij] = -(inverse * across);
  } else if (k.free_count == 3) {
    const double xx = m[1] * m[2] - m[5] * m[5], xy = m[4] * m[5] - m[3] * m[2], xt = m[3] * m[5] - m[4] * m[1];
    const double inverse = 1.0 / (m[0] * xx + m[3] * xy + m[4] * xt);
    w[0] = inverse * xx;
    w[1] = inverse * (m[0] * m[2] - m[4] * m[4]);
    w[2] = inverse * (m[0] * m[1] - m[3] * m[3]);
    w[3] = inverse * xy;
    w[4] = inverse * xt;
    w[5] = inverse * (m[3] * m[4] - m[0] * m[5]);
  } else if (k.free_count == 1) {
    w[k.free[0]] = 1.0 / m[k.free[0]];
  }
}

} // namespace

void Carriages::close(const std::vector<SchurRow>& rows) {
  sides_.clear();
  for (int r = 0; r < static_cast<int>(rows.size()); ++r)
    for (int side = 0; side < 2; ++side)
      if (const Carrier* k = rows[r].body[0] == rows[r].body[1] ? nullptr : find_carrier(rows[r].body[side]))
        sides_.push_back({r, side, static_cast<int>(k - carriers.data())});
}

const Carriage* Carriages::find(int cluster) const {
  const int i = cluster - carriages.front().cluster; // their clusters are the last ones, in their order
  return i >= 0 && i < static_cast<int>(carriages.size()) ? &carriages[i] : nullptr;
}

const Carrier* Carriages::find_carrier(int cluster) const {
  if (cluster < 0) return nullptr;
  const auto at = std::lower_bound(carriers.begin(), carriers.end(), cluster,
                                   [](const Carrier& k, int wanted) { return k.cluster < wanted; });
  return at == carriers.end() || at->cluster != cluster ? nullptr : &*at;
}

// --- poses --------------------------------------------------------------------------------------------

void Carriages::pack(const double* cluster_q, const double* cluster_v, double* q, double* v) const {
  constexpr double k_still[3] = {0.0, 0.0, 0.0};
  for (const Carriage& k : carriages) {
    const int on = k.carrier < 0 ? -1 : carriers[k.carrier].cluster;
    const double* const bq = on < 0 ? k_still : cluster_q + 3 * on;
    const double* const bv = on < 0 ? k_still : cluster_v + 3 * on;
    const double* const aq = cluster_q + 3 * k.cluster;
    const double* const av = cluster_v + 3 * k.cluster;
    Motion<double> turn;
    set_angle(turn, bq[2]);
    const Slide now = slide_at(k, turn.c, turn.s, 0.0);
    const Pair<double> reach{aq[0] - bq[0], aq[1] - bq[1]}, moved{av[0] - bv[0], av[1] - bv[1]};
    q[k.coordinate] = dot(now.e, reach);
    v[k.coordinate] = dot(now.e, moved) + bv[2] * dot(now.n, reach);
  }
}

void Carriages::unpack(const double* q, const double* v, double* cluster_q, double* cluster_v) const {
  constexpr double k_still[3] = {0.0, 0.0, 0.0};
  for (const Carriage& k : carriages) {
    const int on = k.carrier < 0 ? -1 : carriers[k.carrier].cluster;
    const double* const bq = on < 0 ? k_still : cluster_q + 3 * on;
    const double* const bv = on < 0 ? k_still : cluster_v + 3 * on;
    double* const aq = cluster_q + 3 * k.cluster;
    double* const av = cluster_v + 3 * k.cluster;
    Motion<double> turn;
    set_angle(turn, bq[2]);
    const Slide now = slide_at(k, turn.c, turn.s, q[k.coordinate]);
    aq[0] = bq[0] + now.lever.x;
    aq[1] = bq[1] + now.lever.y;
    aq[2] = bq[2] + k.angle;
    av[0] = bv[0] - bv[2] * now.lever.y + v[k.coordinate] * now.e.x;
    av[1] = bv[1] + bv[2] * now.lever.x + v[k.coordinate] * now.e.y;
    av[2] = bv[2];
  }
}

void Carriages::place(const double* q, const double* v, Motion<double>* motion) {
  for (Carriage& k : carriages) {
    const Motion<double>& on = motion[k.on_slot];
    Motion<double>& m = motion[k.slot];
    k.place = q[k.coordinate];
    k.rate = v[k.coordinate];
    const Slide now = slide_at(k, on.c, on.s, k.place);
    k.e = now.e;
    k.n = now.n;
    k.lever = now.lever;
    m.x = on.x + now.lever.x;
    m.y = on.y + now.lever.y;
    m.vx = on.vx - on.omega * now.lever.y + k.rate * now.e.x;
    m.vy = on.vy + on.omega * now.lever.x + k.rate * now.e.y;
    m.omega = on.omega;
    m.theta = on.theta + k.angle;
    if (k.turn_s == 0.0) {
      m.c = k.turn_c * on.c;
      m.s = k.turn_c * on.s;
    } else {
      m.c = on.c * k.turn_c - on.s * k.turn_s;
      m.s = on.s * k.turn_c + on.c * k.turn_s;
    }
    k.omega = on.omega;
    if (k.link < 0) continue;
    Motion<double>& seen = motion[k.link];
    seen.x = k.place * k.axis.x - k.across * k.axis.y;
    seen.y = k.place * k.axis.y + k.across * k.axis.x;
    seen.theta = k.angle;
    seen.c = k.turn_c;
    seen.s = k.turn_s;
    seen.vx = k.rate * k.axis.x;
    seen.vy = k.rate * k.axis.y;
    seen.omega = 0.0;
  }
  weigh();
}

bool Carriages::is_at(const double* q, const double* v) const {
  return std::all_of(carriages.begin(), carriages.end(),
                     [q, v](const Carriage& k) { return k.place == q[k.coordinate] && k.rate == v[k.coordinate]; });
}

// --- masses -------------------------------------------------------------------------------------------

void Carriages::weigh() {
  for (Carrier& carrier : carriers) {
    double xx = carrier.mass, xy = 0.0, yy = carrier.mass, xt = 0.0, yt = 0.0, tt = carrier.inertia;
    for (int i = carrier.begin; i < carrier.end; ++i) {
      const Carriage& k = carriages[i];
      const double mx = k.mass * k.n.x, my = k.mass * k.n.y;
      xx += mx * k.n.x;
      xy += mx * k.n.y;
      yy += my * k.n.y;
      xt += mx * k.place;
      yt += my * k.place;
      tt += k.inertia + k.mass * k.place * k.place;
    }
    double* const m = carrier.m;
    m[0] = xx;
    m[1] = yy;
    m[2] = tt;
    m[3] = xy;
    m[4] = xt;
    m[5] = yt;
    invert(carrier);
  }
}

void Carriages::weigh_row(SchurRow& row) const {
  for (int side = 0; side < 2; ++side)
    if (const Carrier* k = find_carrier(row.body[side])) k->multiply(row.j[side], row.wj[side]);
}

// --- accelerations ------------------------------------------------------------------------------------

void Carriages::accelerate(const BodyForce* force, double* a) {
  const auto add_weight = [force](int slot, const Pair<double>& weight) {
    return Pair<double>{weight.x + force[slot].fx, weight.y + force[slot].fy};
  };
  int i = 0;
  const int on_ground = carriers.empty() ? static_cast<int>(carriages.size()) : carriers.front().begin;
  for (; i < on_ground; ++i) {
    Carriage& k = carriages[i];
    k.pull = dot(k.e, add_weight(k.slot, k.weight)) / k.mass;
  }
  for (Carrier& carrier : carriers) {
    const Pair<double> own = add_weight(carrier.slot, carrier.weight);
    double x = own.x, y = own.y, couple = force[carrier.slot].m;
    for (; i < carrier.end; ++i) {
      Carriage& k = carriages[i];
      const Pair<double> on = add_weight(k.slot, k.weight);
      const double across = dot(k.n, on) - k.mass * k.omega * (2.0 * k.rate - k.omega * k.across);
      k.pull = dot(k.e, on) / k.mass + k.omega * k.omega * k.place;
      x += k.n.x * across;
      y += k.n.y * across;
      couple += k.place * across + force[k.slot].m;
    }
    double* const out = a + 3 * carrier.cluster;
    double* const f = carrier.force;
    f[0] = x;
    f[1] = y;
    f[2] = couple;
    double left[3] = {x, y, couple};
    for (int l = 0; l < carrier.locked_count; ++l) {
      const int at = carrier.locked[l];
      const double known = out[at];
      for (int r = 0; r < carrier.free_count; ++r)
        left[carrier.free[r]] -= carrier.m[Carrier::mixed(carrier.free[r], at)] * known;
    }
    carrier.multiply(left, out);
  }
}

void Carriages::follow(double* a) const {
  for (const Carriage& k : carriages)
    a[k.coordinate] = k.carrier < 0 ? k.pull : k.pull - k.along_e(a + 3 * carriers[k.carrier].cluster);
}

void Carriages::hold_back(double* change) const {
  for (const Carriage& k : carriages)
    if (k.carrier >= 0) change[k.coordinate] += k.along_e(change + 3 * carriers[k.carrier].cluster);
}

void Carriages::let_go(double* change) const {
  for (const Carriage& k : carriages)
    if (k.carrier >= 0) change[k.coordinate] -= k.along_e(change + 3 * carriers[k.carrier].cluster);
}

void Carriages::expand(const double* a, double* cluster_a) const {
  for (const Carriage& k : carriages) {
    double* const out = cluster_a + 3 * k.cluster;
    const double second = a[k.coordinate];
    if (k.carrier < 0) {
      out[0] = second * k.e.x;
      out[1] = second * k.e.y;
      out[2] = 0.0;
      continue;
    }
    const double* const on = cluster_a + 3 * carriers[k.carrier].cluster;
    const double w2 = k.omega * k.omega, turned = 2.0 * k.omega * k.rate, turn = on[2];
    out[0] = on[0] - turn * k.lever.y - w2 * k.lever.x + second * k.e.x + turned * k.n.x;
    out[1] = on[1] + turn * k.lever.x - w2 * k.lever.y + second * k.e.y + turned * k.n.y;
    out[2] = on[2];
  }
}

double Carriages::lack(const Carrier& carrier, int coordinate, const double* a) {
  double sum = carrier.m[coordinate] * a[coordinate] - carrier.force[coordinate];
  for (int c = 0; c < 3; ++c)
    if (c != coordinate) sum += carrier.m[Carrier::mixed(c, coordinate)] * a[c];
  return sum;
}

BodyForce Carriages::held_by(const Carriage& k, const double* cluster_a, const BodyForce* force) const {
  const double* const a = cluster_a + 3 * k.cluster;
  const BodyForce& f = force[k.slot];
  return {k.mass * a[0] - k.weight.x - f.fx, k.mass * a[1] - k.weight.y - f.fy, k.inertia * a[2] - f.m};
}

} // namespace steplap
