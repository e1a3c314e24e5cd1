// Variables and operations of the evaluation of a mechanism, as a template for doubles and recorded numbers (mbd/tape). Only the sources of
// mechanisms and of recording may include this header.
#pragma once

#include "mbd/dynamics/mechanism.h"

#include <cstdint>

namespace steplap {

template <class S> struct MechanismWorkOf {
  static constexpr int k_most = Mechanism::k_most;

  /// Constants and motion of a member.
  struct Link {
    int parent = -1, coordinate = 0, slot = -1, cluster = -1;
    bool is_free = false;
    double mass = 0.0, mass_below = 0.0, turning = 0.0;
    Pair<double> pin, centre, moment;

    S c{1.0}, s{0.0}, omega{0.0};
    Pair<S> o, v, bias; ///< o, v: position and velocity of its pin; bias: acceleration of its pin for s̈ = 0
    Pair<S> arm, lever, turned_moment;
    Pair<S> force; ///< scratch: total force of everything attached to it
    S couple{0.0};
  };

  STEPLAP_INLINE static Pair<S> turned(const S& c, const S& s, const Pair<double>& p) { return {c * p.x - s * p.y, s * p.x + c * p.y}; }
  STEPLAP_INLINE static void add(Pair<S>& to, const Pair<S>& p) {
    to.x += p.x;
    to.y += p.y;
  }

  /// Computes the motion of one member from q and v. Precondition: the members before it in `all` are computed.
  STEPLAP_INLINE static void turn(Link& now, const Link* all, const S* q, const S* v) {
    find_sin_cos(q[now.coordinate], now.s, now.c); // not set_angle(): pinned members rotate too far for its series
    now.omega = v[now.coordinate];
    if (now.parent >= 0) {
      const Link& above = all[now.parent];
      now.arm = {above.c * now.pin.x - above.s * now.pin.y, above.s * now.pin.x + above.c * now.pin.y};
      now.o = above.o + now.arm;
      now.v = {above.v.x - above.omega * now.arm.y, above.v.y + above.omega * now.arm.x};
      const S w2 = above.omega * above.omega;
      now.bias = {above.bias.x - w2 * now.arm.x, above.bias.y - w2 * now.arm.y};
    } else if (now.is_free) {
      now.o = {q[now.coordinate - 2], q[now.coordinate - 1]};
      now.v = {v[now.coordinate - 2], v[now.coordinate - 1]};
    }
    now.lever = {now.c * now.centre.x - now.s * now.centre.y, now.s * now.centre.x + now.c * now.centre.y};
  }

  /// Computes all members, and writes the motions of those that are clusters.
  STEPLAP_INLINE void place(const S* q, const S* v, Motion<S>* motion) {
    Link* const first = links.data();
    Link* const end = first + links.size();
    for (Link* now = first; now != end; ++now) {
      turn(*now, first, q, v);
      if (now->slot < 0) continue;
      Motion<S>& out = motion[now->slot];
      out.x = now->o.x + now->lever.x;
      out.y = now->o.y + now->lever.y;
      out.theta = q[now->coordinate];
      out.c = now->c;
      out.s = now->s;
      out.vx = now->v.x - now->omega * now->lever.y;
      out.vy = now->v.y + now->omega * now->lever.x;
      out.omega = now->omega;
    }
  }

  /// Computes x = L⁻ᵀ x in place, for x that is nonzero only at the coordinates in `pattern`, outermost first.
  STEPLAP_INLINE void whiten(S* x, const std::uint8_t* pattern, int count) const {
    for (int p = 0; p < count; ++p) {
      const int i = pattern[p];
      const S* const row = mass.data() + i * k_most;
      const S xi = x[i];
      for (int j = up[i]; j >= 0; j = up[j]) x[j] -= row[j] * xi;
    }
  }

  // Factorisation M = Lᵀ D L, and M⁻¹ x, for a chain, in which each coordinate is below the one before it. M is then full.
  template <int N> STEPLAP_INLINE void factor_chain() {
    const int size = N > 0 ? N : n;
    S* const h = mass.data();
    for (int r = size - 1; r >= 0; --r) {
      S* const row = h + r * k_most;
      const S inverse = inverse_d[r] = 1.0 / row[r];
      for (int i = r - 1; i >= 0; --i) {
        const S a = row[i] * inverse;
        S* const other = h + i * k_most;
        for (int j = 0; j <= i; ++j) other[j] -= a * row[j];
        row[i] = a;
      }
    }
  }
  template <int N> STEPLAP_INLINE void solve_chain(S* x) const {
    const int size = N > 0 ? N : n;
    const S* const h = mass.data();
    for (int i = size - 1; i > 0; --i)
      for (int j = 0; j < i; ++j) x[j] -= h[i * k_most + j] * x[i];
    for (int i = 0; i < size; ++i) {
      S sum = x[i] * inverse_d[i];
      for (int j = 0; j < i; ++j) sum -= h[i * k_most + j] * x[j];
      x[i] = sum;
    }
  }

  /// Computes the elements of M below the diagonal, at the present motion.
  STEPLAP_INLINE void fill_mass() {
    S* const h = mass.data();
    constexpr int k = k_most;
    Link* const first = links.data();
    for (std::size_t i = 0; i < links.size(); ++i) {
      Link& m = first[i];
      const Pair<S> moment = m.turned_moment = turned(m.c, m.s, m.moment);
      S* const row = h + m.coordinate * k;
      row[m.coordinate] = m.turning;
      const Link* at = &m;
      for (; at->parent >= 0; at = first + at->parent) row[first[at->parent].coordinate] = dot(at->arm, moment);
      if (!at->is_free) continue;
      const int x = at->coordinate - 2, y = x + 1;
      row[x] = -moment.y;
      row[y] = moment.x;
      h[x * k + x] = h[y * k + y] = at->mass_below;
      h[y * k + x] = 0.0;
    }
  }
  /// Factorises M = Lᵀ D L for a general tree.
  STEPLAP_INLINE void factor_tree() {
    S* const h = mass.data();
    for (int r = n - 1; r >= 0; --r) {
      S* const row = h + r * k_most;
      const S inverse = inverse_d[r] = 1.0 / row[r];
      for (int i = up[r]; i >= 0; i = up[i]) {
        const S a = row[i] * inverse;
        S* const other = h + i * k_most;
        for (int j = i; j >= 0; j = up[j]) other[j] -= a * row[j];
        row[i] = a;
      }
    }
  }
  STEPLAP_INLINE void solve_tree(S* x) const {
    whiten(x, all.data(), n);
    for (int i = 0; i < n; ++i) {
      const S* const row = mass.data() + i * k_most;
      S sum = x[i] * inverse_d[i];
      for (int j = up[i]; j >= 0; j = up[j]) sum -= row[j] * x[j];
      x[i] = sum;
    }
  }

  /// Computes the generalised forces Tᵀ(Q − m b); `body_force` has one entry per slot.
  STEPLAP_INLINE void load(const BodyForceOf<S>* body_force, S* s) {
    Link* const first = links.data();
    Link* const end = first + links.size();
    for (Link* now = first; now != end; ++now) {
      now->force = {};
      now->couple = 0.0;
      if (now->slot < 0) continue;
      const BodyForceOf<S>& f = body_force[now->slot];
      const S w2 = now->omega * now->omega;
      now->force = {f.fx + now->mass * (gravity.x - now->bias.x + w2 * now->lever.x),
                    f.fy + now->mass * (gravity.y - now->bias.y + w2 * now->lever.y)};
      now->couple = f.m + cross(now->lever, now->force);
    }
    for (Link* now = end; now-- != first;) {
      s[now->coordinate] = now->couple;
      if (now->is_free) {
        s[now->coordinate - 2] = now->force.x;
        s[now->coordinate - 1] = now->force.y;
      } else if (now->parent >= 0) {
        Link& above = first[now->parent];
        add(above.force, now->force);
        above.couple += cross(now->arm, now->force);
      }
    }
  }

  /// Computes the accelerations (x, y, θ) of all clusters for given s̈, including centripetal terms.
  STEPLAP_INLINE void expand(const S* s, S* cluster_a) {
    Link* const first = links.data();
    Link* const end = first + links.size();
    for (Link* now = first; now != end; ++now) { // `force` contains the acceleration of its pin here
      if (now->parent >= 0) {
        const Link& above = first[now->parent];
        const S alpha = s[above.coordinate], w2 = above.omega * above.omega;
        now->force = {above.force.x - alpha * now->arm.y - w2 * now->arm.x, above.force.y + alpha * now->arm.x - w2 * now->arm.y};
      } else if (now->is_free) {
        now->force = {s[now->coordinate - 2], s[now->coordinate - 1]};
      } else {
        now->force = {};
      }
      if (now->cluster < 0) continue;
      const S alpha = s[now->coordinate], w2 = now->omega * now->omega;
      S* const a = cluster_a + 3 * now->cluster;
      a[0] = now->force.x - alpha * now->lever.y - w2 * now->lever.x;
      a[1] = now->force.y + alpha * now->lever.x - w2 * now->lever.y;
      a[2] = alpha;
    }
  }

  // --- rows -----------------------------------------------------------------------------------------
  /// Converts the gradient of a row from cluster coordinates to the coordinates s. `member_of`: member index of the cluster on each side.
  STEPLAP_INLINE void reduce(const SchurRowOf<S>& row, const int* member_of, S* out) const {
    const Link* const first = links.data();
    for (int side = 0; side < 2; ++side) {
      if (row.body[side] < 0) continue;
      const S* const j = row.j[side];
      const Pair<S> force{j[0], j[1]};
      const Link* at = first + member_of[side];
      out[at->coordinate] += j[2] + cross(at->lever, force);
      for (; at->parent >= 0; at = first + at->parent) out[first[at->parent].coordinate] += cross(at->arm, force);
      if (!at->is_free) continue;
      out[at->coordinate - 2] += force.x;
      out[at->coordinate - 1] += force.y;
    }
  }
  STEPLAP_INLINE void clear_gradient(std::size_t r) {
    for (int p = 0; p < patterns[r].count; ++p) gradient[r * k_most + patterns[r].at[p]] = 0.0;
  }

  /// Computes L⁻ᵀJᵀ, D⁻¹L⁻ᵀJᵀ and the diagonal element J_c W J_cᵀ for row r.
  STEPLAP_INLINE void whiten_row(std::size_t r, const SchurRowOf<S>& row) {
    const S* const j = gradient.data() + r * k_most;
    S* const w = white.data() + r * k_most;
    S* const over_d = scaled.data() + r * k_most;
    const RowPattern& pattern = patterns[r];
    for (int p = 0; p < pattern.count; ++p) w[pattern.at[p]] = j[pattern.at[p]];
    whiten(w, pattern.at.data(), pattern.count);
    for (int p = 0; p < pattern.count; ++p) over_d[pattern.at[p]] = w[pattern.at[p]] * inverse_d[pattern.at[p]];
    S sum{0.0};
    for (int side = 0; side < 2; ++side)
      if (row.body[side] >= 0)
        for (int c = 0; c < 3; ++c) sum += row.wj[side][c] * row.j[side][c];
    own[r] = sum;
  }

  /// Factorises A = J M⁻¹ Jᵀ row by row; below the diagonal L D is stored first, then L. raise(d, own) returns a pivot with damping.
  /// invert(r, d, own) returns its inverse, or 0 to leave out row r. N is the number of rows if it is known at compile time, otherwise 0.
  template <int N, class Raise, class Invert> STEPLAP_INLINE void factor_rows(int count, const Raise& raise, const Invert& invert) {
    const int m = N > 0 ? N : count;
    const Shared* pair = shared.data();
    S* const a = factor.data();
    S* const inverse = inverse_pivot.data();
    for (int r = 0; r < m; ++r) {
      const S* const over_d = scaled.data() + r * k_most;
      S* const row = a + r * m;
      for (int t = 0; t <= r; ++t, ++pair) {
        const S* const other = white.data() + t * k_most;
        S sum{0.0};
        for (const std::uint8_t *at = shared_at.data() + pair->begin, *const end = at + pair->count; at != end; ++at)
          sum += over_d[*at] * other[*at];
        row[t] = sum;
      }
      S d = raise(row[r], own[r]);
      for (int j = 0; j < r; ++j) {
        const S* const before = a + j * m;
        S sum = row[j];
        for (int k = 0; k < j; ++k) sum -= row[k] * before[k];
        row[j] = sum;
      }
      for (int j = 0; j < r; ++j) {
        const S l = row[j] * inverse[j];
        d -= l * row[j];
        row[j] = l;
      }
      inverse[r] = invert(r, d, own[r]);
    }
  }
  template <int N> STEPLAP_INLINE void eliminate(int count, S* x) const {
    const S* const l = factor.data();
    const int m = N > 0 ? N : count;
    for (int i = 1; i < m; ++i) {
      S sum = x[i];
      for (int j = 0; j < i; ++j) sum -= l[i * m + j] * x[j];
      x[i] = sum;
    }
    for (int i = 0; i < m; ++i) x[i] *= inverse_pivot[i];
    for (int i = m - 1; i > 0; --i)
      for (int j = 0; j < i; ++j) x[j] -= l[i * m + j] * x[i];
  }
  /// Computes Jᵀ λ.
  STEPLAP_INLINE void pull_rows(int count, const S* lambda, S* pull) const {
    for (int i = 0; i < n; ++i) pull[i] = 0.0;
    for (int r = 0; r < count; ++r) {
      const S* const j = gradient.data() + r * k_most;
      const RowPattern& pattern = patterns[r];
      for (int p = 0; p < pattern.count; ++p) pull[pattern.at[p]] += j[pattern.at[p]] * lambda[r];
    }
  }

  int n = 0;
  bool is_chain = false;
  bool is_constant = false; ///< M is diagonal
  bool is_factored = false; ///< M has been factorised
  Pair<double> gravity;
  std::vector<Link> links;
  mutable std::vector<Link> packed; ///< scratch of pack() and unpack(), which do not change the placed pose
  std::array<S, k_most> placed_q{}, placed_v{};
  std::array<std::int8_t, k_most> up{};   ///< the coordinate next nearer to the root; −1: none
  std::array<std::uint8_t, k_most> all{}; ///< all coordinates, in descending order
  std::array<S, k_most * k_most> mass{};  ///< M, then L below the diagonal
  std::array<S, k_most> inverse_d{};      ///< 1/D of M

  // The coordinates that move one row.
  struct RowPattern {
    std::uint8_t count = 0;
    std::array<std::uint8_t, k_most> at{}; ///< coordinates of its gradient and those nearer to the root, in descending order
  };
  std::vector<RowPattern> patterns;
  struct Shared {
    std::uint16_t begin = 0, count = 0; ///< range in shared_at
  };
  std::vector<Shared> shared;                ///< per pair of rows (r, t ≤ r): index r (r + 1)/2 + t
  std::vector<std::uint8_t> shared_at;       ///< coordinates in both patterns
  std::vector<S> gradient, white, scaled;    ///< J, L⁻ᵀJᵀ and D⁻¹L⁻ᵀJᵀ
  std::vector<S> factor, inverse_pivot, own; ///< own: J_c W J_cᵀ of each row
  double shift = 0.0;
};

struct MechanismWork : MechanismWorkOf<double> {};

} // namespace steplap
