// Relative angles on which forces, event functions or channels depend nonlinearly, as pairs of bodies (including the ground).
//
// Rotation at constant velocity is integrated exactly, so error control would allow steps of many turns, although the tip of the body may
// pass an obstacle in each turn. Step control therefore limits the change of these angles in one step (mbd/integrators/turn_limit.h), so
// that samples within a step resolve the turn. Groups declare their pairs (ForceGroup::register_turns); those of rows follow from the
// measure. A curve over such an angle, for example the lift of a cam, may have features between any two knots; therefore a step also ends
// at each knot.
#pragma once

#include "mbd/system/row.h"

#include <cstdint>
#include <initializer_list>
#include <span>
#include <unordered_map>
#include <vector>

namespace steplap {

/// The bodies on whose angle a measure depends nonlinearly.
struct Turning {
  bool a = false, b = false;
};

/// Returns true if the point moves when the body turns. Points within 1 nm of the centre of gravity count as its centre.
[[nodiscard]] inline bool moves_by_turning(const Vec2& point) { return point.squaredNorm() > 1e-18; }

[[nodiscard]] inline Turning turning_of(const AxisMeasure& m) { return {moves_by_turning(m.point_a), true}; }
template <int K> [[nodiscard]] Turning turning_of(const CoordinateMeasure<K>& m) { return {moves_by_turning(m.point_a), true}; }
[[nodiscard]] inline Turning turning_of(const DistanceMeasure& m) { return {moves_by_turning(m.point_a), moves_by_turning(m.point_b)}; }
[[nodiscard]] inline Turning turning_of(const AngleMeasure&) { return {}; }
[[nodiscard]] inline Turning turning_of(const GapMeasure& m) { return {m.is_axis_in_a || moves_by_turning(m.point_a), true}; }
/// Returns the bodies on whose angle the row's measure depends nonlinearly. Further parts of the row (RowSpec::next) are not included.
[[nodiscard]] Turning turning_of(const RowSpec& row);

/// Knots of a curve over the angle θ_a − θ_b + zero, rad.
struct TurnKnots {
  double zero = 0.0;
  std::vector<double> at; ///< ascending, at least two; for a periodic curve the last is the first plus one turn
  bool is_periodic = false;

  /// The knots below and above an angle, infinite if there is none. `direction` is positive if the angle increases. A knot ahead that is
  /// very near counts as passed, and the next one is returned.
  struct Interval {
    double low, high;
  };
  [[nodiscard]] Interval about(double x, double direction) const;
};

/// A pair of bodies with the curves over its angle.
struct Turn {
  int a = k_ground, b = k_ground; ///< a > b
  std::vector<TurnKnots> knots = {};
};

/// All pairs of a system, each listed once.
class TurnTable {
public:
  explicit TurnTable(std::size_t body_count) : body_count_(body_count) {}

  /// Adds the relative angle of a and b, unless they are the same body.
  void add(int a, int b);
  /// Adds the relative angle of a and b with the knots of a curve over it.
  void add(int a, int b, TurnKnots knots);
  /// Adds the angles on which a measure of a and b depends: the angle of each body in `turning`, and the relative angle if both are in it.
  void add(int a, int b, Turning turning);
  /// Adds the angles of all listed bodies relative to each other and to the ground.
  void add_all(std::span<const int> bodies);
  void add_all(std::initializer_list<int> bodies) { add_all(std::span(bodies.begin(), bodies.size())); }

  /// Adds the relative angles of all pairs of marked bodies. If many are marked, only the angle of each is added.
  void add_marked(const std::vector<char>& is_marked);

  [[nodiscard]] const std::vector<Turn>& turns() const { return turns_; }
  /// Returns the number of bodies including the ground.
  [[nodiscard]] std::size_t body_count() const { return body_count_; }

private:
  Turn& entry(int a, int b);
  std::size_t body_count_;
  std::vector<Turn> turns_;
  std::unordered_map<std::uint64_t, std::size_t> index_;
};

class System;
/// Returns the table for all elements, joints and friction elements of a system.
[[nodiscard]] TurnTable turn_table_of(const System& system);

} // namespace steplap
