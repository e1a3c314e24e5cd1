// A channel that is a measure of two bodies, or its rate: what a formula in the equations of motion may read.
//
// Such a formula needs its operands as numbers of other kinds, too: with derivatives, or written down. A channel whose value is made
// by MeasuredValue says how.
#pragma once

#include "mbd/system/row.h"
#include "mbd/system/system.h"

#include <functional>
#include <utility>

namespace steplap {

/// What a channel calls: `shown` gives its value, which is that of `measure` less `zero`, or its rate.
struct MeasuredValue {
  std::function<double(const Snapshot&)> shown;
  RowSpec measure;   ///< a measure of two bodies and no more
  double zero = 0.0; ///< in the measure's unit
  bool is_rate = false;

  double operator()(const Snapshot& snapshot) const { return shown(snapshot); }
};

/// What a channel measures; null where it says nothing.
[[nodiscard]] inline const MeasuredValue* measured_by(const Channel& channel) { return channel.value.target<MeasuredValue>(); }

/// The measures as rows.
[[nodiscard]] inline RowSpec row_of(int a, int b, const AxisMeasure& m) {
  RowSpec row;
  row.a = a;
  row.b = b;
  row.point_a = m.point_a;
  row.point_b = m.point_b;
  row.direction = m.axis;
  return row;
}
template <int K> [[nodiscard]] RowSpec row_of(int a, int b, const CoordinateMeasure<K>& m) { return row_of(a, b, m.along_axis()); }
[[nodiscard]] inline RowSpec row_of(int a, int b, const DistanceMeasure& m) {
  RowSpec row = row_of(a, b, AxisMeasure{m.point_a, m.point_b, Vec2::Zero()});
  row.kind = MeasureKind::distance;
  return row;
}
[[nodiscard]] inline RowSpec row_of(int a, int b, const AngleMeasure&) {
  RowSpec row = row_of(a, b, AxisMeasure{Vec2::Zero(), Vec2::Zero(), Vec2::Zero()});
  row.kind = MeasureKind::angle;
  return row;
}

} // namespace steplap
