// Angles on which something of a scene depends other than linearly: pairs of bodies, the ground among them.
//
// A rotation at a constant rate is a straight line in its angle: no error estimate shortens a step for it, however many turns the step
// takes, while the tip of a body passes whatever stands in its way twice a turn. Step control therefore bounds the angle by which
// such a pair turns within one step (mbd/integrators/turn_limit.h), so that every sine in a gap is resolved by the places inside a step.
// Groups declare their pairs (ForceGroup::enter_turns); those of rows follow from the measure.
//
// A curve over such an angle, as the lift of a cam, may do between two of its knots whatever it likes: each knot also ends a step.
#pragma once

#include "mbd/system/row.h"

#include <cstdint>
#include <initializer_list>
#include <span>
#include <unordered_map>
#include <vector>

namespace steplap {

/// On the angles of which of its bodies, a and b, a measure depends other than linearly.
struct Turning {
  bool a = false, b = false;
};

/// Does a point of a body, from its centre of gravity, move when the body turns? What is nearer than a nanometre is rounding of its place.
[[nodiscard]] inline bool moves_by_turning(const Vec2& point) { return point.squaredNorm() > 1e-18; }

[[nodiscard]] inline Turning turning_of(const AxisMeasure& m) { return {moves_by_turning(m.point_a), true}; }
template <int K> [[nodiscard]] Turning turning_of(const CoordinateMeasure<K>& m) { return {moves_by_turning(m.point_a), true}; }
[[nodiscard]] inline Turning turning_of(const DistanceMeasure& m) { return {moves_by_turning(m.point_a), moves_by_turning(m.point_b)}; }
[[nodiscard]] inline Turning turning_of(const AngleMeasure&) { return {}; }
[[nodiscard]] inline Turning turning_of(const GapMeasure& m) { return {m.is_axis_in_a || moves_by_turning(m.point_a), true}; }
/// Considers a row's own measure, without its further parts.
[[nodiscard]] Turning turning_of(const RowSpec& row);

/// Knots of a curve over an angle θ_a − θ_b + zero, rad.
struct TurnKnots {
  double zero = 0.0;
  std::vector<double> at; ///< ascending, at least two; of a periodic curve the last is the first one a whole turn later
  bool is_periodic = false;

  /// Knots between which x lies; infinite where there is none. `direction`: positive if x grows. x nearer to the knot ahead than a
  /// share of the interval counts as having passed it.
  struct Interval {
    double low, high;
  };
  [[nodiscard]] Interval about(double x, double direction) const;
};

/// A pair of bodies, and the curves over its angle.
struct Turn {
  int a = k_ground, b = k_ground; ///< a > b
  std::vector<TurnKnots> knots = {};
};

/// The pairs of a system's bodies, each once.
class TurnTable {
public:
  explicit TurnTable(std::size_t body_count) : body_count_(body_count) {}

  /// Adds the angle of a against b, unless they are the same body.
  void add(int a, int b);
  /// Adds the pair with the knots of a curve over its relative angle.
  void add(int a, int b, TurnKnots knots);
  /// Adds the angles on which a measure between a and b depends: of each body that turns it, against the ground, and against each other
  /// if both do.
  void add(int a, int b, Turning turning);
  /// Adds the angles of all these bodies against each other and against the ground.
  void add_all(std::span<const int> bodies);
  void add_all(std::initializer_list<int> bodies) { add_all(std::span(bodies.begin(), bodies.size())); }

  /// Adds all pairs of the marked bodies; if there are many, only each body against the ground.
  void add_marked(const std::vector<char>& is_marked);

  [[nodiscard]] const std::vector<Turn>& turns() const { return turns_; }
  /// Number of bodies of the system, the ground among them.
  [[nodiscard]] std::size_t body_count() const { return body_count_; }

private:
  Turn& entry(int a, int b);
  std::size_t body_count_;
  std::vector<Turn> turns_;
  std::unordered_map<std::uint64_t, std::size_t> index_;
};

class System;
/// Returns the pairs of all elements, joints and frictions of a system.
[[nodiscard]] TurnTable turn_table_of(const System& system);

} // namespace steplap
