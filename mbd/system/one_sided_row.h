// A way that pulls and never pushes: the row of an inextensible rope, which comes and goes. The way is a distance of two
// points, or a sum of such (RowSpec::next) over pulleys that move.
//
// Among the friction elements, for its row holds and lets go as those of friction do; of their phases it has two:
//   stick   taut: the length is a constraint, the tension T = −λ its multiplier, admissible while T ≥ 0
//   slip    slack: no force, admissible while the length is below the rope's
// What a taut rope bears has no bound, so it never slips in the sense of friction. A slack rope that reaches its length
// while that grows is caught: velocities jump (mbd/events/blow.h), and the memory notes the blow.
#pragma once

#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

class OneSidedRow final : public FrictionElement {
public:
  static constexpr double k_at_length = 1e-9;  ///< of its length: nearer than this it starts taut
  static constexpr double k_too_long = 1e-6;   ///< of its length: what the digits of a file may be off by
  static constexpr double k_least_part = 1e-6; ///< of its length: a straight part that is shorter has run onto its pulley

  RowSpec row;               ///< a distance, or the first of several; its memory holds what they may be at most
  double length = 0.0;       ///< the same, m
  double dead_band = 0.0;    ///< m: a slack rope is caught beyond it; far above the rounding of places
  double rest_tension = 0.0; ///< N: less than it is rounding
  int blow = 0;              ///< slots of the memory: impulse of the last blow, N s; energy lost in all of them, J
  std::vector<std::pair<std::string, std::string>> points; ///< names of the ends of each part

  /// The ways between bodies, one at least.
  void set_parts(std::vector<RowSpec> parts) {
    further_.assign(parts.begin() + 1, parts.end());
    row = parts.front();
    row.next = further_.empty() ? nullptr : further_.data();
    for (std::size_t i = 0; i + 1 < further_.size(); ++i) further_[i].next = &further_[i + 1];
  }
  [[nodiscard]] bool is_long() const { return row.next != nullptr; }
  /// Between moving points, one after the other, as of RowSpec::next.
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
  /// Sum of the speeds of all points that it joins, m/s: rounding of its rate is a share of it.
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

  [[nodiscard]] int dimension() const override { return 1; }
  [[nodiscard]] const RowSpec* rows(const FrictionState&) const override { return &row; }
  [[nodiscard]] bool never_slips() const override { return true; }
  void mark_bodies(std::vector<char>& is_used) const override {
    for_parts([&is_used](const RowSpec& part) { is_used[part.a] = is_used[part.b] = 1; });
  }
  [[nodiscard]] bool is_loaded(const Evaluation&, const FrictionState&) const override { return true; }
  void slip_wrench(const Evaluation&, const FrictionState&, const double*, double* wrench) const override { wrench[0] = 0.0; }
  [[nodiscard]] double support(const Evaluation&, const FrictionState&, const double*) const override { return 0.0; }
  void watch_stick(const Evaluation& e, const FrictionState&, const double* wrench, double* watch) const override {
    watch[0] = rest_tension - wrench[0];
    watch[1] = is_long() ? shortest_part(e.motion).length - k_least_part * length : 1.0;
  }
  void watch_slip(const Evaluation&, const FrictionState&, const double*, double* watch) const override { watch[0] = watch[1] = 1.0; }
  [[nodiscard]] double watch_place(const Evaluation& e, const FrictionState& state) const override {
    return state.phase == FrictionPhase::slip ? left(e.motion) + dead_band : 1.0;
  }
  void begin_slip(const Evaluation&, FrictionState&, const double*) const override {}
  void aim(FrictionState& state, const double*) const override { state.sign = 0; }
  /// w ≤ 0: it pulls.
  [[nodiscard]] FrictionBlock solve_block(const Evaluation&, const FrictionState&, const double* a, const double* b,
                                          bool /*kinetic*/) const override {
    FrictionBlock block;
    const double wanted = a[0] > 0.0 ? -b[0] / a[0] : 0.0;
    block.is_inside = a[0] > 0.0 ? wanted <= 0.0 : !(b[0] < 0.0);
    block.wrench[0] = std::min(wanted, 0.0);
    return block;
  }

private:
  std::vector<RowSpec> further_; ///< parts beyond the first
};

/// Null where a friction element is none.
[[nodiscard]] inline const OneSidedRow* one_sided_row(const FrictionElement& friction) {
  return friction.never_slips() ? dynamic_cast<const OneSidedRow*>(&friction) : nullptr;
}
/// One of a system's one-sided rows, and which of its friction elements it is.
struct OneSidedUnit {
  const OneSidedRow* row = nullptr;
  std::size_t friction = 0;
};
/// All of them, in the order of the friction elements. `system` must outlive what is made of it.
[[nodiscard]] inline auto one_sided_rows(const System& system) {
  const auto of = [&system](std::size_t f) { return OneSidedUnit{one_sided_row(*system.frictions[f].friction), f}; };
  return std::views::iota(std::size_t{0}, system.frictions.size()) | std::views::transform(of) |
         std::views::filter([](const OneSidedUnit& unit) { return unit.row != nullptr; });
}
/// Null where there is none.
[[nodiscard]] inline const OneSidedRow* first_one_sided_row(const System& system) {
  for (const OneSidedUnit& unit : one_sided_rows(system)) return unit.row;
  return nullptr;
}

} // namespace steplap
