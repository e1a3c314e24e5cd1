// Channels whose value is a measure of two bodies, or the rate of one. Formulas in the equations of motion may use them.
//
// Such formulas also need their operands as dual numbers and on a tape. The channel's value therefore contains the measure, from which any
// number type can be computed.
#pragma once

#include "mbd/system/row.h"
#include "mbd/system/system.h"

#include <functional>
#include <utility>

namespace steplap {

/// Type of Channel::value for a channel that is a measure or the rate of one. `shown` returns the value of the channel: the value of
/// `measure` minus `zero`, or the rate of `measure`.
struct MeasuredValue {
  std::function<double(const Snapshot&)> shown;
  RowSpec measure;   ///< single measure of two bodies
  double zero = 0.0; ///< in the unit of the measure
  bool is_rate = false;

  double operator()(const Snapshot& snapshot) const { return shown(snapshot); }
};

/// Type of Channel::value for any other channel that depends on the motion of the bodies only. It owns what it reads, so it keeps its value
/// while the element is inactive.
struct MotionValue {
  std::function<double(const Motion<double>*)> of;

  double operator()(const Snapshot& snapshot) const { return of(snapshot.motion); }
};

/// Returns the channel value get(m), with m value and rate of `measure` of bodies a and b.
template <class Measure, class Get> [[nodiscard]] MotionValue motion_value(int a, int b, const Measure& measure, const Get& get) {
  return {[=](const Motion<double>* motion) { return get(measure.template at<false, double>(motion[a], motion[b])); }};
}

/// Returns the measure behind a channel; null if the channel is not a measure.
[[nodiscard]] inline const MeasuredValue* measured_by(const Channel& channel) { return channel.value.target<MeasuredValue>(); }

/// The functions row_of() return a measure of bodies a and b as a row.
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
