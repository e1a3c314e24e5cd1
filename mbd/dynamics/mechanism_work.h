// What an evaluation of a mechanism changes, beside the constants that it reads: to be included by its own sources
// alone.
#pragma once

#include "mbd/dynamics/mechanism.h"

#include <cstdint>

namespace steplap {

struct MechanismWork {
  static constexpr int k_most = Mechanism::k_most;

  /// A member's constants, and its motion.
  struct Link {
    int parent = -1, coordinate = 0, slot = -1, cluster = -1;
    bool is_free = false;
    double mass = 0.0, mass_below = 0.0, turning = 0.0;
    Pair<double> pin, centre, moment;

    double c = 1.0, s = 0.0, omega = 0.0;
    Pair<double> o, v, bias; ///< of its pin; bias: its acceleration at s̈ = 0
    Pair<double> arm, lever, turned_moment;
    Pair<double> force;      ///< scratch: of all that hangs on it
    double couple = 0.0;
  };

  /// q and v of the coordinates to the link's own motion; `all`: those before it are placed.
  STEPLAP_INLINE static void turn(Link& now, const Link* all, const double* q, const double* v) {
    Motion<double> turn;
    set_angle(turn, q[now.coordinate]);
    now.c = turn.c;
    now.s = turn.s;
    now.omega = v[now.coordinate];
    if (now.parent >= 0) {
      const Link& above = all[now.parent];
      now.arm = {above.c * now.pin.x - above.s * now.pin.y, above.s * now.pin.x + above.c * now.pin.y};
      now.o = above.o + now.arm;
      now.v = {above.v.x - above.omega * now.arm.y, above.v.y + above.omega * now.arm.x};
      const double w2 = above.omega * above.omega;
      now.bias = {above.bias.x - w2 * now.arm.x, above.bias.y - w2 * now.arm.y};
    } else if (now.is_free) {
      now.o = {q[now.coordinate - 2], q[now.coordinate - 1]};
      now.v = {v[now.coordinate - 2], v[now.coordinate - 1]};
    }
    now.lever = {now.c * now.centre.x - now.s * now.centre.y, now.s * now.centre.x + now.c * now.centre.y};
  }

  /// x = L⁻ᵀ x, where x is zero but for the coordinates of `pattern`, the outermost first.
  STEPLAP_INLINE void whiten(double* x, const std::uint8_t* pattern, int count) const {
    for (int p = 0; p < count; ++p) {
      const int i = pattern[p];
      const double* const row = mass.data() + i * k_most;
      const double xi = x[i];
      for (int j = up[i]; j >= 0; j = up[j]) x[j] -= row[j] * xi;
    }
  }

  // The same, M = Lᵀ D L and M⁻¹ x where every coordinate but the first is below the one before it, so that M is full.
  template <int N> STEPLAP_INLINE void factor_chain() {
    const int size = N > 0 ? N : n;
    double* const h = mass.data();
    for (int r = size - 1; r >= 0; --r) {
      double* const row = h + r * k_most;
      const double inverse = inverse_d[r] = 1.0 / row[r];
      for (int i = r - 1; i >= 0; --i) {
        const double a = row[i] * inverse;
        double* const other = h + i * k_most;
        for (int j = 0; j <= i; ++j) other[j] -= a * row[j];
        row[i] = a;
      }
    }
  }
  template <int N> STEPLAP_INLINE void solve_chain(double* x) const {
    const int size = N > 0 ? N : n;
    const double* const h = mass.data();
    for (int i = size - 1; i > 0; --i)
      for (int j = 0; j < i; ++j) x[j] -= h[i * k_most + j] * x[i];
    for (int i = 0; i < size; ++i) {
      double sum = x[i] * inverse_d[i];
      for (int j = 0; j < i; ++j) sum -= h[i * k_most + j] * x[j];
      x[i] = sum;
    }
  }

  int n = 0;
  bool is_chain = false;
  bool is_constant = false; ///< M: nothing couples one member's turning with another's
  bool is_factored = false; ///< M has been once
  Pair<double> gravity;
  std::vector<Link> links;
  mutable std::vector<Link> packed; ///< scratch of pack and unpack, which leave the pose placed as it is
  std::array<double, k_most> placed_q{}, placed_v{};
  std::array<std::int8_t, k_most> up{};          ///< the coordinate next above
  std::array<std::uint8_t, k_most> all{};        ///< coordinates, the last first
  std::array<double, k_most * k_most> mass{};    ///< M, then L below the diagonal
  std::array<double, k_most> inverse_d{};        ///< of M

  // Rows, k_most numbers each.
  struct RowPattern {
    std::uint8_t count = 0;
    std::array<std::uint8_t, k_most> at{}; ///< coordinates that it depends on or that are above those, the last first
  };
  std::vector<RowPattern> patterns;
  struct Shared {
    std::uint16_t begin = 0, count = 0; ///< of shared_at
  };
  std::vector<Shared> shared;            ///< per pair of rows (r, t ≤ r): r (r + 1)/2 + t
  std::vector<std::uint8_t> shared_at;   ///< coordinates in both patterns
  std::vector<double> gradient, white, scaled; ///< J, L⁻ᵀJᵀ and that over D
  std::vector<double> factor, inverse_pivot, own; ///< own: J_c W J_cᵀ of each row
  double shift = 0.0;
};

} // namespace steplap
