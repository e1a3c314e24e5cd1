// Carriages: clusters that a guide (a prismatic joint) holds to another cluster, their *carrier*, or to the ground, and
// that nothing else holds. Each is described by one coordinate, how far it has slid; the guide's two rows are gone.
//
// With e the guide's axis and n = ẑ×e, both fixed in the carrier, s the place along e and h that across it (constant):
//   x_c = x + R (s e + h n),  θ_c = θ + const
//   v_c = v + ω ẑ×ρ + ṡ e,    ρ = s e + h n
//   a_c·n = v_nᵀ a + b_n,     v_n = (n_x, n_y, s),   b_n = 2 ω ṡ − ω² h
//   a_c·e = v_eᵀ a + s̈ − ω² s, v_e = (e_x, e_y, −h)     with a = (ẍ, ÿ, θ̈) of the carrier
// Nothing holds a carriage along e, and so its slide is eliminated first (R. Featherstone, Rigid Body Dynamics
// Algorithms, §7.3, with a tree two high):
//   m (a_c·e) = F·e,  that is  s̈ = F·e/m + ω² s − v_eᵀ a
//   M a = f,  M = diag(m, m, J) of the carrier + Σ m_c v_n v_nᵀ + J_c,   f = f_carrier + Σ v_n (F·n − m_c b_n) + couple
// Rows see the carrier alone, with W = M⁻¹ in place of a diagonal of inverse masses; what they make of a carrier's
// coordinates moves s by −v_eᵀ of that. Coordinates that drives prescribe have no part in W. What the guide bears is what the
// carriage lacks, found where somebody looks (Reactions::find_pins).
#pragma once

#include "mbd/dynamics/schur.h"
#include "mbd/system/motion.h"

#include <vector>

namespace steplap {

struct Carriage {
  int cluster = 0, slot = 0;
  int carrier = -1;        ///< −1: the ground
  int on_slot = 0;         ///< of the carrier's motion
  int coordinate = 0;      ///< in the packed coordinates
  int block = 0;           ///< rows of the guide
  double mass = 0.0, inertia = 0.0;
  Pair<double> weight;     ///< m g
  Pair<double> axis;       ///< e, in the carrier's axes
  double across = 0.0;     ///< h, m
  double angle = 0.0, turn_c = 1.0, turn_s = 0.0; ///< against the carrier
  int link = -1;           ///< slot of how the carrier sees it, −1: nobody asks

  // At the pose last placed; ground axes.
  Pair<double> e, n, lever; ///< lever: ρ
  double place = 0.0, rate = 0.0, omega = 0.0; ///< s, ṡ; of the carrier
  double pull = 0.0;        ///< s̈ where the carrier does not accelerate

  [[nodiscard]] double along_e(const double* a) const { return e.x * a[0] + e.y * a[1] - across * a[2]; }
};

struct Carrier {
  int cluster = 0, slot = 0;
  int begin = 0, end = 0;  ///< carriages
  double mass = 0.0, inertia = 0.0;
  Pair<double> weight;
  double m[6] = {};        ///< M: xx, yy, θθ, xy, xθ, yθ
  double w[6] = {};        ///< its inverse, likewise; of the coordinates that are free, the rest is not used
  double force[3] = {};    ///< f
  int free[3] = {}, free_count = 0, locked[3] = {}, locked_count = 0;

  /// Where the entry of two different coordinates is.
  [[nodiscard]] static constexpr int mixed(int i, int j) { return i + j + 2; }

  /// a = W f; locked coordinates stay as they are.
  STEPLAP_INLINE void multiply(const double* f, double* a) const {
    if (free_count == 2) [[likely]] {
      const int i = free[0], j = free[1];
      const double fi = f[i], fj = f[j], across = w[mixed(i, j)];
      a[i] = w[i] * fi + across * fj;
      a[j] = across * fi + w[j] * fj;
    } else if (free_count == 3) {
      const double x = f[0], y = f[1], t = f[2];
      a[0] = w[0] * x + w[3] * y + w[4] * t;
      a[1] = w[3] * x + w[1] * y + w[5] * t;
      a[2] = w[4] * x + w[5] * y + w[2] * t;
    } else if (free_count == 1) {
      a[free[0]] = w[free[0]] * f[free[0]];
    }
  }
};

class Carriages {
public:
  // --- made by the layout; those of one carrier side by side, those of the ground first -------------
  std::vector<Carriage> carriages;
  std::vector<Carrier> carriers;
  std::vector<int> carrier_of_lock; ///< per lock of the layout, −1: none
  int plain_links = 0;              ///< of the layout's, the first ones: those between others than carriages and carriers
  /// Rows that act on carriers; what is free of them.
  void close(const std::vector<SchurRow>& rows);

  [[nodiscard]] const Carriage* find(int cluster) const;      ///< null: it is none
  [[nodiscard]] const Carrier* find_carrier(int cluster) const;

  // --- poses and rates: 3 numbers per cluster, packed coordinates -----------------------------------
  void pack(const double* cluster_q, const double* cluster_v, double* q, double* v) const;
  void unpack(const double* q, const double* v, double* cluster_q, double* cluster_v) const;
  /// With M and W. Carriers must be placed.
  void place(const double* q, const double* v, Motion<double>* motion);
  [[nodiscard]] bool is_at(const double* q, const double* v) const;

  // --- at the pose last placed ----------------------------------------------------------------------
  /// W Jᵀ of the rows, whose gradients are filled in, where they act on carriers; of one that is not the layout's.
  STEPLAP_INLINE void weigh_rows(SchurRow* rows) const {
    for (const Side& at : sides_) carriers[at.carrier].multiply(rows[at.row].j[at.side], rows[at.row].wj[at.side]);
  }
  void weigh_row(SchurRow& row) const;
  /// Accelerations of carriers without rows, those of locked coordinates being known; `force` per slot.
  void accelerate(const BodyForce* force, double* a);
  /// s̈, where the carriers' accelerations are known.
  void follow(double* a) const;
  /// The same of a small change along the carriers' coordinates, in two calls about what changes them.
  void hold_back(double* change) const;
  void let_go(double* change) const;
  /// 3 each, of carriages, in `cluster_a`, which holds those of carriers.
  void expand(const double* a, double* cluster_a) const;
  /// What is missing in the equation of motion of a locked coordinate of a carrier, before rows.
  [[nodiscard]] static double lack(const Carrier& carrier, int coordinate, const double* a);
  /// Force and couple of the guide on a carriage, about its centre.
  [[nodiscard]] BodyForce held_by(const Carriage& carriage, const double* cluster_a, const BodyForce* force) const;

private:
  void weigh();

  struct Side {
    int row = 0, side = 0, carrier = 0;
  };
  std::vector<Side> sides_;
};

} // namespace steplap
