#pragma once

// The paper's transformer, hand-written for this scene in minimal coordinates.
//
// Bodies: the active part, including both outer limbs, as one rigid body; the lower tank with the vehicle, whose x follows the braking
// pulse; the upper tank, which slides on it. Six coordinates:
//   q = (X = x1 − x5(t), y1, θ1, y5, θ5, s4), state y = (q, q̇), SI and radians.
// Forces: feet, wooden blocks, arresting devices, suspension, tank flexibility, and Coulomb friction under the feet, with laws, signs and
// mode changes as on the physics page (compliant contacts without adhesion; sticking at the last contact foot; the direction of slip is
// part of the mode) and the values of the paper's scene. The limbs never slip, which is valid as long as their wrench is within the
// friction capacity of the joints, as in both conditions.
//
// The program shares no code with steplap, and serves as an independent check and as a comparison of speed.

#include <array>

namespace steplap::peers {

namespace transformer {
struct Kinematics;
}

enum class Condition { no_interference, interference };
enum class ContactMode { closed, held, open }; // `held`: δ < 0, but the force is zero
enum class FrictionMode { stick, slip_forward, slip_backward, none };

inline constexpr int k_states = 12;
inline constexpr int k_contacts = 4; // rear foot, front foot, rear wooden block, front wooden block
inline constexpr double k_end_time = 0.8;
inline constexpr std::array<double, 3> k_breakpoints = {0.05, 0.15, k_end_time};

// Indices of the event functions, each of which is positive during its mode.
inline constexpr int k_leave = 0;          // plus number of the contact: from closed to held, from held to open, from open to closed
inline constexpr int k_return = 4;         // plus number of the contact: from held to closed
inline constexpr int k_friction_upper = 8; // sticking: μN − λ; slip: σ ṡ
inline constexpr int k_friction_lower = 9; // sticking: μN + λ
inline constexpr int k_foot_switch = 10;
inline constexpr int k_switches = 11;

// Value of event functions that do not exist in the present mode; it never becomes negative.
inline constexpr double k_unwatched = 1.0;

using State = std::array<double, k_states>;
using Switches = std::array<double, k_switches>;

struct Outputs { // one row of the reference files
  double x1, y1, theta1, y5, theta5, s4, friction, normal, foot_front, foot_rear, wood_front, wood_rear, top_arrest, bottom_arrest, tank,
      slide, fx2, fy2, m2, fx3, fy3, m3;
};
inline constexpr int k_outputs = 22;

class Transformer {
public:
  explicit Transformer(Condition condition);

  [[nodiscard]] State initial_state() const;

  // Computes ẏ with the laws of the present modes, which are smooth also beyond the limits of the modes. Stores the normal forces of the
  // feet and, while sticking, the friction force.
  void rates(double t, const double* y, double* dydt);

  // Computes the event functions, scaled by 1e5 N, 1e-3 m and 0.1 m/s to be of order one. Requires an evaluation only while sticking.
  void switches(double t, const double* y, double* g);
  // As switches(), but without the functions of sticking, which need an evaluation.
  void kinematic_switches(const double* y, double* g) const;
  // Computes the event functions of sticking from the last evaluation.
  void stick_switches(double* g) const;
  [[nodiscard]] double switch_value(int slot, double t, const double* y);

  // Changes the mode after event function `slot` has reached zero.
  void cross(int slot, double t, State& y);

  [[nodiscard]] bool sticking() const { return friction_ == FrictionMode::stick; }
  [[nodiscard]] long evaluations() const { return evaluations_; }
  // Returns the smallest μN − |λ| over all evaluations since reset_stick_margin(). If it is negative, sticking ended within the step, even
  // if it is possible at both ends.
  [[nodiscard]] double stick_margin() const { return stick_margin_; }
  void reset_stick_margin() { stick_margin_ = 1e300; }

  [[nodiscard]] Outputs outputs(double t, const State& y);
  [[nodiscard]] static double bottom_arrest(const double* y);
  [[nodiscard]] const char* describe(int slot) const;

private:
  using Kinematics = transformer::Kinematics;
  [[nodiscard]] double effective_gap(int contact, const Kinematics& k, const double* y) const;
  [[nodiscard]] double force_law(int contact, const Kinematics& k, const double* y) const;
  [[nodiscard]] double slide_speed(const Kinematics& k) const;
  void try_stick(double t, State& y);
  void settle_friction(double t, State& y);

  double foot_offset_;
  double wood_offset_;
  std::array<ContactMode, k_contacts> contacts_;
  FrictionMode friction_ = FrictionMode::stick;
  int foot_ = 0;
  double lambda_ = 0.0;
  double normal_ = 0.0;
  double stick_margin_ = 1e300;
  long evaluations_ = 0;
};

} // namespace steplap::peers
