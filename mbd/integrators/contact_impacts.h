// Impacts of contacts in time stepping: from the step in which a contact closes with a velocity until it opens again or has rebounded.
//
// Implicit Euler removes a vibration within a few of its steps, so a body whose impact lasts a few steps would not rebound. The mean force
// of a step in an impact is therefore the one whose work is the change of the stored energy U (a discrete gradient):
//
//   f̄ = −(U(δ₁) − U(δ₀)) / (δ₁ − δ₀),   δ₁ = δ₀ + h (δ̇₀ + δ̇₁)/2.
//
// The spring of the contact then neither adds nor removes energy, however long the step is. For a linear law f = −kδ, δ < 0, and w the
// closed share of the displacement |δ₁ − δ₀|,
//
//   closed at both ends   f̄ = ½ (f₀ + f₁)
//   lands                 f̄ = ½ w f₁,   w = −δ₁/(δ₀ − δ₁)
//   leaves                f̄ = ½ w f₀,   w = −δ₀/(δ₁ − δ₀)
//
// The linearised step continues f beyond δ = 0. Newton's method for δ₁ is a mean force f̄ = α f₀ + β (f₁ − f₀), α = w, with
// β = ½, ½ w (2 − w) and ½ w². The passes of the step (time_stepping.h) iterate w. Both bodies move with the mean of their velocities.
//
// A contact that closes no faster than loads change its velocity in a few steps does not rebound: it comes to rest as implicit Euler has
// it, as does one that has rebounded without opening. Sources: O. Gonzalez, Comput. Methods Appl. Mech. Eng. 190 (2000) 1763 (discrete
// gradients).
#pragma once

#include "mbd/integrators/stage_system.h"
#include "mbd/system/gap_source.h"

#include <vector>

namespace steplap {

/// Impacts of one system, in the part of a step that is being computed.
class ContactImpacts {
public:
  /// Resolves no impacts: all functions do nothing.
  ContactImpacts() = default;
  /// Resolves the impacts of all contacts of `system`; none if it has inner states.
  explicit ContactImpacts(const System& system);

  /// Begins a part. Precondition: the last evaluation of `dynamics` was at `start`.
  void begin_part(Dynamics& dynamics, const State& start);
  /// Returns true if contact `unit` is in an impact in this pass; it is then in mode pressed.
  [[nodiscard]] bool contains(std::size_t unit) const { return !impact_.empty() && impact_[unit].is_on; }
  /// Reads the gaps at the end of a pass, at the last evaluation of `dynamics`.
  void end_pass(Dynamics& dynamics);
  /// Returns true if the contact was apart at the start of the part and has closed in the pass.
  [[nodiscard]] bool has_closed(std::size_t unit) const {
    return !impact_.empty() && !impact_[unit].is_refused && gap0_[unit] > 0.0 && gap1_[unit] < 0.0;
  }
  /// Makes an impact of a contact that has_closed(), unless it closes too slowly. `rate0` and `rate1`: rates of the gap at the ends of the
  /// part, m/s.
  void land(std::size_t unit, double rate0, double rate1);
  /// Adapts the share of an impact to the end of the pass, which leaves the contact in `mode`, or ends the impact if none is possible.
  /// Returns true if another pass is necessary.
  [[nodiscard]] bool refine(std::size_t unit, UnitMode mode);
  /// Returns true if an impact between two bodies acted in the last pass.
  [[nodiscard]] bool acts_between(int a, int b) const;
  /// Sets the modes of impacts for the forces at the start of the part: pressed.
  void set_force_modes(std::vector<UnitMode>& modes) const;
  /// Sets the modes of impacts for the normal forces at the end of the part: open where the contact leaves.
  void set_friction_modes(std::vector<UnitMode>& modes) const;
  /// Sets the modes of impacts to those at the end of the part.
  void set_end_modes(std::vector<UnitMode>& modes) const;
  /// Notes the impacts that continue after the part just computed. They apply from the next commit() on.
  void note_end();
  void commit() { phase_.swap(next_phase_); }

  /// Multiplies the derivatives of the forces of impacts by β, and notes these forces at the start of the part. For Linearization.
  void weigh(const Evaluation& e, std::vector<PairJacobian>& parts, const std::vector<std::size_t>& first_of_group);
  /// Sets the coordinates of `stages` that move with the mean of their velocities.
  void set_mean_motion(const Layout& layout, StageSystem& stages);
  /// Adds the changes by the forces (α − 1) f₀ to the change u of coordinates and velocities. Precondition: `stages` is factorised.
  void add_forces(const Layout& layout, const std::vector<Motion<double>>& motion, StageSystem& stages, double* u);

private:
  enum class Phase : unsigned char { none, approach, rebound };
  struct Impact {
    bool is_on = false, lands = false, leaves = false;
    bool is_refused = false; ///< no impact in this part
    double share = 1.0;      ///< w
    int passes = 0;          ///< number of times that w was adapted
    UnitMode end_mode = 0;
    [[nodiscard]] double slope() const { return lands ? 0.5 * share * (2.0 - share) : leaves ? 0.5 * share * share : 0.5; } ///< β
  };
  struct Source {
    const GapSource* gaps = nullptr;
    std::size_t group = 0;
    std::vector<std::size_t> units; ///< per contact of the group
  };
  /// Force f₀ of an impact on bodies a and b.
  struct Force {
    int body[2] = {0, 0};
    double missing = 0.0; ///< α − 1
    Eigen::Matrix<double, 6, 1> value;
  };

  void read_gaps(const Motion<double>* motion, std::vector<double>& gaps);

  std::vector<Source> sources_;
  std::vector<Phase> phase_, next_phase_; ///< per unit: at the start of the part, and after it
  std::vector<Impact> impact_;            ///< per unit; empty if the system has no contact that can be in an impact
  std::vector<double> gap0_, gap1_;       ///< per unit, m
  std::vector<GapBounds> bounds_;
  std::vector<Force> forces_;
  std::vector<double> mean_; ///< per coordinate: 0.5 where it moves with the mean velocity, otherwise 1
  SparseVectors vectors_;
  std::vector<double> sum_, change_;
};

} // namespace steplap
