// Unilateral distance constraint: an inextensible rope, which pulls but does not push. Its length is the distance of two points, or a sum
// of such distances if the rope runs over moving pulleys (RowSpec::next).
//
// The row becomes active and inactive like a friction row, so the class is a friction element with two phases:
//
//   stick   taut: the length is a constraint, the tension T = −λ its multiplier; valid while T ≥ 0
//   slip    slack: no force; valid while the length is below that of the rope
//
// The tension has no upper bound, so a taut rope never slips. When a slack rope becomes taut while its ends separate, velocities jump
// (mbd/events/blow.h); the impulse is stored in State::impacts.
#pragma once

#include "mbd/system/bounded_friction.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// The constraint of one rope.
class OneSidedRow final : public BoundedFriction {
public:
  static constexpr double k_at_length = 1e-9;  ///< relative: the rope starts taut if it is nearer than this to its full length
  static constexpr double k_too_long = 1e-6;   ///< relative: excess of length that is accepted as rounding in the model file
  static constexpr double k_least_part = 1e-6; ///< relative: a shorter straight part has run onto its pulley

  static constexpr FrictionWatch k_on_pulley = FrictionWatch::second;             ///< of a taut rope: a straight part is too short
  static constexpr FrictionWatch k_length_reached = FrictionWatch::contact_point; ///< of a slack rope: it has reached its length

  RowSpec row;               ///< the first distance; its base is the length of the rope
  double length = 0.0;       ///< length of the rope, m
  double dead_band = 0.0;    ///< excess of length, m, at which a slack rope becomes taut; far above the rounding of positions
  double rest_tension = 0.0; ///< N; smaller tensions are rounding
  int impact = 0;            ///< index in State::impacts
  std::vector<std::pair<std::string, std::string>> points; ///< names of the end points of each part

  /// Sets the distances whose sum is the length; at least one.
  void set_parts(std::vector<RowSpec> parts) {
    further_.assign(parts.begin() + 1, parts.end());
    row = parts.front();
    row.next = further_.empty() ? nullptr : further_.data();
    for (std::size_t i = 0; i + 1 < further_.size(); ++i) further_[i].next = &further_[i + 1];
  }
  [[nodiscard]] bool is_long() const { return row.next != nullptr; }
  /// Calls f for each straight part, in order.
  template <class F> void for_parts(const F& f) const {
    for (const RowSpec* part = &row; part; part = part->next) f(*part);
  }
  struct ShortestPart {
    double length = std::numeric_limits<double>::infinity();
    std::size_t place = 0;
  };
  [[nodiscard]] ShortestPart shortest_part(const Motion<double>* motion) const {
    ShortestPart shortest;
    std::size_t place = 0;
    for_parts([&](const RowSpec& part) {
      const double now = evaluate_row<false>(part, motion[part.a], motion[part.b]).value;
      if (now < shortest.length) shortest = {now, place};
      ++place;
    });
    return shortest;
  }
  /// Returns the sum of the absolute velocities of all end points of the parts, m/s. The rounding error of the row's rate is proportional
  /// to it.
  [[nodiscard]] double speed(const Motion<double>* motion) const {
    const auto of_point = [](const Motion<double>& m, const Pair<double>& lever) {
      return std::abs(m.vx - m.omega * lever.y) + std::abs(m.vy + m.omega * lever.x);
    };
    double sum = 0.0;
    for_parts([&](const RowSpec& part) {
      const Motion<double>&a = motion[part.a], &b = motion[part.b];
      sum += of_point(a, to_ground(a, part.point_a)) + of_point(b, to_ground(b, part.point_b));
    });
    return sum;
  }

  [[nodiscard]] MeasureValue<double> measured(const Motion<double>* motion) const { return evaluate_row<false>(row, motion); }
  [[nodiscard]] double left(const Motion<double>* motion) const { return length - measured(motion).value; }

  [[nodiscard]] const RowSpec* rows(const FrictionState&) const override { return &row; }
  [[nodiscard]] bool never_slips() const override { return true; }
  void mark_bodies(std::vector<char>& is_used) const override {
    for_parts([&is_used](const RowSpec& part) { is_used[part.a] = is_used[part.b] = 1; });
  }
  [[nodiscard]] bool is_loaded(const Evaluation&, const FrictionState&) const override { return true; }
  void slip_wrench(const Evaluation&, const FrictionState&, const double*, double* wrench) const override { wrench[0] = 0.0; }
  [[nodiscard]] WrenchBounds bounds(const Evaluation&, const FrictionState&, bool /*kinetic*/) const override {
    return {-std::numeric_limits<double>::infinity(), 0.0};
  }
  /// Returns the power of the rope, which is zero: a taut rope has no rate, a slack rope no force. The support function of (−∞, 0] would be
  /// infinite.
  [[nodiscard]] double support(const Evaluation&, const FrictionState&, const double*) const override { return 0.0; }
  void stick_events(const Evaluation& e, const FrictionState&, const double* wrench, double* event_value) const override {
    event_value[0] = rest_tension - wrench[0];
    event_value[1] = is_long() ? shortest_part(e.motion).length - k_least_part * length : 1.0;
  }
  void slip_events(const Evaluation&, const FrictionState&, const double*, double* event_value) const override {
    event_value[0] = event_value[1] = 1.0;
  }
  [[nodiscard]] double contact_point_event(const Evaluation& e, const FrictionState& state) const override {
    return state.phase == FrictionPhase::slip ? left(e.motion) + dead_band : 1.0;
  }
  void set_onset_direction(const Evaluation&, FrictionState&, const double*) const override {}
  void aim(FrictionState& state, const double*) const override { state.sign = 0; }
  /// Solves the mode problem as for any interval, except if drives determine the length (a = 0): then the tension is zero instead of
  /// infinite.
  [[nodiscard]] BlockSolution solve_block(const Evaluation&, const FrictionState&, const double* a, const double* b,
                                          bool /*kinetic*/) const override {
    BlockSolution block;
    const double wanted = a[0] > 0.0 ? -b[0] / a[0] : 0.0;
    block.sticks = a[0] > 0.0 ? wanted <= 0.0 : !(b[0] < 0.0);
    block.wrench[0] = std::min(wanted, 0.0);
    return block;
  }

private:
  std::vector<RowSpec> further_; ///< all parts but the first
};

/// A one-sided row with the index of its friction element.
struct OneSidedUnit {
  const OneSidedRow* row = nullptr;
  std::size_t friction = 0;
};
/// Returns a range over all ropes, in the order of the friction elements. `system` must outlive the range.
[[nodiscard]] inline auto one_sided_rows(const System& system) {
  const auto of = [&system](std::size_t f) { return OneSidedUnit{system.frictions[f].rope, f}; };
  return std::views::iota(std::size_t{0}, system.frictions.size()) | std::views::transform(of) |
         std::views::filter([](const OneSidedUnit& unit) { return unit.row != nullptr; });
}
/// Returns the first rope; null if there is none.
[[nodiscard]] inline const OneSidedRow* first_one_sided_row(const System& system) {
  for (const OneSidedUnit& unit : one_sided_rows(system)) return unit.row;
  return nullptr;
}

} // namespace steplap
