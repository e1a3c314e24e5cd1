#include "mbd/dynamics/mechanism_work.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

using Link = MechanismWork::Link;

Pair<double> turned(double c, double s, const Pair<double>& p) { return {c * p.x - s * p.y, s * p.x + c * p.y}; }
double length(const Pair<double>& p) { return portable::hypot(p.x, p.y); }
STEPLAP_INLINE void add(Pair<double>& to, const Pair<double>& p) {
  to.x += p.x;
  to.y += p.y;
}

void read_motion(const Link& now, double theta, double* q, double* v) {
  q[0] = now.o.x + now.lever.x;
  q[1] = now.o.y + now.lever.y;
  q[2] = theta;
  v[0] = now.v.x - now.omega * now.lever.y;
  v[1] = now.v.y + now.omega * now.lever.x;
  v[2] = now.omega;
}

} // namespace

Mechanism::Mechanism() = default;
Mechanism::~Mechanism() = default;
Mechanism::Mechanism(Mechanism&&) noexcept = default;
Mechanism& Mechanism::operator=(Mechanism&&) noexcept = default;

Pair<double> Mechanism::arm(int member) const { return work_->links[member].arm; }
Pair<double> Mechanism::lever(int member) const { return work_->links[member].lever; }
double Mechanism::spin(int member) const { return work_->links[member].omega; }

// --- constants --------------------------------------------------------------------------------------

void Mechanism::close(int cluster_count, const Vec2& gravity, const SchurRow* rows) {
  work_ = std::make_unique<MechanismWork>();
  MechanismWork& w = *work_;
  w.gravity = {gravity.x(), gravity.y()};
  member_of_.assign(cluster_count, -1);
  path_.assign(members.size(), 0U);
  for (std::size_t i = 0; i < members.size(); ++i) {
    Member& m = members[i];
    if (m.cluster >= 0) member_of_[m.cluster - first_cluster] = static_cast<int>(i);
    int above = m.parent >= 0 ? members[m.parent].coordinate : -1;
    if (m.parent >= 0) path_[i] = path_[m.parent];
    for (int k = m.is_free ? 2 : 0; k >= 0; --k) {
      is_place_[n_] = k > 0 ? 1 : 0;
      w.up[n_] = static_cast<std::int8_t>(above);
      path_[i] |= 1U << n_;
      above = n_++;
    }
    m.coordinate = above;
  }
  w.n = n_;
  w.is_chain = true;
  for (int i = 0; i < n_; ++i) w.is_chain = w.is_chain && w.up[i] == i - 1;
  for (int i = 0; i < n_; ++i) w.all[i] = static_cast<std::uint8_t>(n_ - 1 - i);
  for (const Member& m : members) {
    Link link;
    link.parent = m.parent;
    link.coordinate = m.coordinate;
    link.slot = m.slot;
    link.cluster = m.cluster;
    link.is_free = m.is_free;
    link.mass = link.mass_below = m.mass;
    link.turning = m.inertia + m.mass * dot(m.centre, m.centre);
    link.pin = m.pin;
    link.centre = m.centre;
    link.moment = m.mass * m.centre;
    if (m.parent < 0 && !m.is_free) link.o = m.pin;
    w.links.push_back(link);
  }
  // `beyond`, computed from the leaves to the root: largest distance from a member's pin of anything attached to the member.
  std::vector<double> beyond(members.size(), 0.0);
  for (std::size_t i = members.size(); i-- > 0;) {
    const Link& link = w.links[i];
    reach_[link.coordinate] = std::max(beyond[i], length(link.centre));
    if (link.parent < 0) continue;
    Link& above = w.links[link.parent];
    above.mass_below += link.mass_below;
    above.turning += link.mass_below * dot(link.pin, link.pin);
    add(above.moment, link.mass_below * link.pin);
    beyond[link.parent] = std::max(beyond[link.parent], length(link.pin) + reach_[link.coordinate]);
  }
  w.packed = w.links;
  w.is_constant = std::all_of(w.links.begin(), w.links.end(), [](const Link& link) {
    return !link.is_free && (link.parent < 0 || (link.moment.x == 0.0 && link.moment.y == 0.0));
  });
  find_patterns(rows);
}

// --- poses ------------------------------------------------------------------------------------------

void Mechanism::place(const double* q, const double* v, Motion<double>* motion) {
  MechanismWork& w = *work_;
  for (int i = 0; i < n_; ++i) {
    w.placed_q[i] = q[i];
    w.placed_v[i] = v[i];
  }
  w.place(q, v, motion);
}

bool Mechanism::is_at(const double* q, const double* v) const {
  return std::equal(q, q + n_, work_->placed_q.begin()) && std::equal(v, v + n_, work_->placed_v.begin());
}

void Mechanism::unpack(const double* q, const double* v, double* cluster_q, double* cluster_v) const {
  Link* const links = work_->packed.data();
  for (std::size_t i = 0; i < members.size(); ++i) {
    Link& now = links[i];
    MechanismWork::turn(now, links, q, v);
    if (now.cluster < 0) continue;
    read_motion(now, q[now.coordinate], cluster_q + 3 * members[i].cluster, cluster_v + 3 * members[i].cluster);
  }
}

// The angle of a rod is that from its own pin to the pin at its end.
void Mechanism::pack(const double* cluster_q, const double* cluster_v, double* q, double* v) const {
  Link* const links = work_->packed.data();
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Member& m = members[i];
    const int k = m.coordinate;
    if (m.cluster >= 0) {
      for (int c = m.is_free ? 2 : 0; c >= 0; --c) {
        q[k - c] = cluster_q[3 * m.cluster + 2 - c];
        v[k - c] = cluster_v[3 * m.cluster + 2 - c];
      }
    } else {
      q[k] = v[k] = 0.0;
      MechanismWork::turn(links[i], links, q, v); // the positions of pins of later members depend on this
      const Member& end = members[i + 1];
      const double* const bq = cluster_q + 3 * end.cluster;
      const double* const bv = cluster_v + 3 * end.cluster;
      Motion<double> turn;
      set_angle(turn, bq[2]);
      const Pair<double> lever = turned(turn.c, turn.s, end.centre), o = links[i].o, vo = links[i].v;
      const Pair<double> along{bq[0] - lever.x - o.x, bq[1] - lever.y - o.y};
      const Pair<double> rate{bv[0] + bv[2] * lever.y - vo.x, bv[1] - bv[2] * lever.x - vo.y};
      q[k] = portable::atan2(along.y, along.x);
      v[k] = cross(along, rate) / dot(along, along);
    }
    MechanismWork::turn(links[i], links, q, v);
  }
}

// --- forces and accelerations -----------------------------------------------------------------------

namespace {

void factor_chain(MechanismWork& w) {
  switch (w.n) {
  case 1: return w.factor_chain<1>();
  case 2: return w.factor_chain<2>();
  case 3: return w.factor_chain<3>();
  case 4: return w.factor_chain<4>();
  case 5: return w.factor_chain<5>();
  default: return w.factor_chain<0>();
  }
}

void solve_chain(const MechanismWork& w, double* x) {
  switch (w.n) {
  case 1: return w.solve_chain<1>(x);
  case 2: return w.solve_chain<2>(x);
  case 3: return w.solve_chain<3>(x);
  case 4: return w.solve_chain<4>(x);
  case 5: return w.solve_chain<5>(x);
  default: return w.solve_chain<0>(x);
  }
}

} // namespace

void Mechanism::factor_mass() {
  MechanismWork& w = *work_;
  if (w.is_constant && w.is_factored) return;
  w.is_factored = true;
  w.fill_mass();
  if (w.is_chain) factor_chain(w);
  else w.factor_tree();
}

void Mechanism::solve_mass(double* x) const {
  const MechanismWork& w = *work_;
  if (w.is_chain) solve_chain(w, x);
  else w.solve_tree(x);
}

void Mechanism::accelerate(const BodyForce* force, double* s) const {
  work_->load(force, s);
  solve_mass(s);
}

void Mechanism::expand(const double* s, double* cluster_a) const { work_->expand(s, cluster_a); }

void Mechanism::pin_forces(const double* cluster_a, const BodyForce* force, const SchurRow* rows, const double* lambda,
                           std::vector<Pair<double>>& on_member) const {
  const Pair<double> gravity = work_->gravity;
  on_member.assign(members.size(), {});
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Member& m = members[i];
    if (m.cluster < 0) continue;
    const double* const a = cluster_a + 3 * m.cluster;
    const BodyForce& f = force[m.slot];
    on_member[i] = {m.mass * (a[0] - gravity.x) - f.fx, m.mass * (a[1] - gravity.y) - f.fy};
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
