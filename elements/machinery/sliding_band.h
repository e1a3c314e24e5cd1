// A rope, band or belt with two free parts that are connected on a drum, where it sticks or slides.
//
// Tensions T_0, T_1 of the free parts, which are springs with dampers of equal time constant τ = c/k:
//
//   T_i = τ_i ± c_i ṡ,   τ_i = k_i e_i + c_i ρ_i,   e_0 = g_0 + s,  e_1 = g_1 − s,   ρ_i = ġ_i
//
// g_i is the elongation of part i by the motion of drum and ends (wound_measure.h), s the distance that the band has slid over the drum
// from part 0 to part 1. For a wrap angle α and a coefficient of friction μ (Euler 1762, Eytelwein 1808)
//
//   E^{-1} ≤ T_1/T_0 ≤ E,   E = e^{μ α}.
//
// With several drums the smallest E applies to all, because the band slides first on that drum. While the ratio is within the bounds the
// band sticks, ṡ = 0; when a bound is reached it slides with the ratio at the bound:
//
//   T_1 = E T_0:  ṡ = (τ_1 − E τ_0)/(c_1 + E c_0),        T_0 = E T_1:  ṡ = (E τ_1 − τ_0)/(c_0 + E c_1)
//
// s is an inner state whose rate starts and ends at zero. Without tension the band is loose: e_0 + e_1 plus τ times its rate, in which s
// cancels, is not positive. s then has the value for equal tensions of both parts. The part on the drum has no mass and no elasticity;
// friction does not depend on velocity.
//
// Energy: ½ Σ k_i e_i² while taut; ½ k_0 k_1/(k_0 + k_1) (e_0 + e_1)² if the band is released faster than the dampers recover. Dissipation:
// Σ (T_i − k_i e_i) ė_i in the dampers and (T_1 − T_0) ṡ on the drum.
#pragma once

#include "elements/body_blocks.h"
#include "elements/contact_laws.h"
#include "elements/machinery/wound_measure.h"

#include <array>
#include <string>
#include <vector>

namespace steplap {

/// All bands and belts, as one force group.
class SlidingBandGroup final : public ForceGroup {
public:
  static constexpr int k_event_count = 2;
  static constexpr double k_place = 1e-12; ///< accuracy of positions, m; tensions that differ by the corresponding force are equal
  static constexpr UnitMode k_loose = 0, k_let_go = 1, k_sticks = 2, k_to_second = 3, k_to_first = 4;

  /// A free part, from the drum to the body at its other end.
  struct Part {
    int end = k_ground;
    WoundMeasure measure;
    double stiffness = 0.0;
    double free = 0.0;     ///< elongation without load, m
    double shortest = 0.0; ///< smallest length, m; below it the part has vanished
  };
  struct ElementData {
    int drum = k_ground;
    std::array<Part, 2> parts;
    double time = 0.0; ///< time constant τ = c/k of the dampers, s
    /// Friction of the drum and of a belt's other wheel. Wrap angle α = angle + sense·(turned_1 − turned_0), or for a belt π ± 2
    /// atan(c/length).
    std::array<double, 2> friction{0.0, 0.0};
    double angle = 0.0, sense = 1.0;
    bool is_belt = false;
    double far_sign = -1.0; ///< sign of ± for the belt's other wheel
    std::string name;
    int inner = 0, unit = 0, first_event = 0;

    [[nodiscard]] std::array<int, 3> bodies() const { return {drum, parts[0].end, parts[1].end}; }
  };
  /// All quantities that depend on the motion and on s.
  template <class S> struct Flow {
    std::array<typename WoundMeasure::Straight<S>, 2> straight;
    std::array<MeasureValue<S>, 2> measured;
    std::array<S, 2> stretch, rate, resting, tension; ///< per free part: elongation e_i, rate ρ_i, tension without slip τ_i, tension T_i
    std::array<S, 2> angles;                          ///< wrap angles α of the drum and of a belt's other wheel, rad
    S ratio{1.0};                                     ///< bound E of the ratio of the tensions
    S slip{0.0};                                      ///< slip velocity ṡ, m/s
  };

  std::vector<ElementData> entries;

  [[nodiscard]] static Flow<double> flow_of(const ElementData& entry, const Motion<double>* motion, double s, UnitMode mode);
  [[nodiscard]] Flow<double> flow_now(int i, const Evaluation& e) const {
    return flow_of(entries[static_cast<std::size_t>(i)], e.motion, e.inner[entries[static_cast<std::size_t>(i)].inner],
                   e.mode[entries[static_cast<std::size_t>(i)].unit]);
  }
  /// Returns the value of s for which both parts have the same tension, m.
  [[nodiscard]] static double balanced(const ElementData& entry, const Flow<double>& flow, double s);

  void add_forces(Evaluation& e) const override;
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }
  [[nodiscard]] double inner_energy(const Motion<double>* motion, const double* inner) const override;
  double project_inner(const Evaluation& e, double* inner) const override;
  double jump_inner(int element, UnitMode to, const Evaluation& e, double* inner) const override;
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override;
  void add_state_jacobian(const Evaluation& e, StateJacobian& out) const override;
  void mark_bodies(std::vector<char>& is_used) const override;
  void register_turns(TurnTable& turns) const override;
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override;
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override;
  [[nodiscard]] bool is_armed_at_entry(int element, UnitMode mode, int slot, const Evaluation& e) const override;
  [[nodiscard]] EventKind event_kind(UnitMode from, UnitMode to) const override;

private:
  [[nodiscard]] static KelvinVoigtContact whole(const ElementData& entry) { return {1.0, entry.time, 0.0}; }
  [[nodiscard]] static bool is_taut(UnitMode mode) { return mode >= k_sticks; }
  [[nodiscard]] static UnitMode contact_mode(UnitMode mode);
  [[nodiscard]] static UnitMode mode_by_ratio(const ElementData& entry, const Flow<double>& flow);
  /// Returns the force, N, by which the tensions may exceed the ratio, so that a slide that has decayed to rounding ends.
  [[nodiscard]] static double slack_of(const ElementData& entry, const Flow<double>& flow) {
    return k_place * (1.0 + flow.ratio) * (entry.parts[0].stiffness + entry.parts[1].stiffness);
  }
  [[nodiscard]] static double rounding_of(const ElementData& entry, const Evaluation& e, const Flow<double>& flow);
  static void check(const ElementData& entry, const Flow<double>& flow);
  static void event_value(const ElementData& entry, const Flow<double>& flow, UnitMode mode, Evaluation& e);
};

} // namespace steplap
