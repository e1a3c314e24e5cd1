#pragma once

// The paper's transformer, hand-written for this one scene in minimal coordinates.
//
// Models: the active part with both outer limbs stuck to it (one rigid body),
// the lower tank with the vehicle, whose x follows the braking pulse, and the
// upper tank that slides on it. Six coordinates:
//   q = (X = x1 − x5(t), y1, θ1, y5, θ5, s4), state y = (q, q̇), SI and radians.
// Joined by feet, wooden blocks, arresting devices, suspension, tank flexibility
// and Coulomb friction under the feet, with the laws, signs and switching rules of
// the physics page (compliant contacts without adhesion; stick located at the last
// contact foot; direction of slip is part of the mode) and the values of the
// paper scene. The limbs never slip here: valid while their wrench stays inside
// the joint's friction capacity, as in both conditions.
//
// Shares no code with steplap: an independent check of it as well as a rival.

#include <array>

namespace steplap::peers {

namespace transformer {
struct Kinematics;
}

enum class Condition { no_interference, interference };
enum class ContactMode { closed, held, open }; // held: δ < 0 with the force held at zero
enum class FrictionMode { stick, slip_forward, slip_backward, none };

inline constexpr int k_states = 12;
inline constexpr int k_contacts = 4; // feet rear, front; wooden blocks rear, front
inline constexpr double k_end_time = 0.8;
inline constexpr std::array<double, 3> k_breakpoints = {0.05, 0.15, k_end_time};

// Slots of the switching functions. Each is positive while its mode lasts.
inline constexpr int k_leave = 0;          // + contact: closed → held, held → open, open → closed
inline constexpr int k_return = 4;         // + contact: held → closed
inline constexpr int k_friction_upper = 8; // stick: μN − λ; slip: σ ṡ
inline constexpr int k_friction_lower = 9; // stick: μN + λ
inline constexpr int k_foot_switch = 10;
inline constexpr int k_switches = 11;

// Value of switching functions that are not monitored in the present mode: positive, so that they never fire.
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

  // Computes ẏ in the present modes, smoothly extended beyond their limits. Stores the normal force of the feet and, while sticking, the
  // multiplier.
  void rates(double t, const double* y, double* dydt);

  // Switching functions; forces scaled by 1e5 N, lengths by 1e-3 m, speeds by
  // 0.1 m/s, so that all are of order one. Costs an evaluation in stick only.
  void switches(double t, const double* y, double* g);
  // As switches(), but without the functions of sticking, which need an evaluation.
  void kinematic_switches(const double* y, double* g) const;
  // Only the functions of sticking, from the last evaluation.
  void stick_switches(double* g) const;
  [[nodiscard]] double switch_value(int slot, double t, const double* y);

  // Changes the mode for a switching function that has reached zero.
  void cross(int slot, double t, State& y);

  [[nodiscard]] bool sticking() const { return friction_ == FrictionMode::stick; }
  [[nodiscard]] long evaluations() const { return evaluations_; }
  // Returns the smallest μN − |λ| of all evaluations since the last reset. It shows that sticking ended inside a step even if it holds at
  // both ends.
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
