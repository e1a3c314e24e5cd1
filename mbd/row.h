// One scalar constraint row: a measure of two bodies that is held at a target.
//
//   measure(q) = base + base_rate·t + drive(t)
// base (and base_rate for a row driven by its acceleration) live in the state's memory: they are set
// when the row begins to hold (at the start of a run; at the begin of sticking).
#pragma once

#include "mbd/measure.h"
#include "mbd/signal.h"

#include <string>

namespace steplap {

enum class MeasureKind : unsigned char { axis, distance, angle, slide };

struct RowSpec {
  MeasureKind kind = MeasureKind::axis;
  int a = k_ground, b = k_ground; ///< bodies of the compiled system
  Vec2 point_a = Vec2::Zero(), point_b = Vec2::Zero();
  Vec2 direction = Vec2::Zero(); ///< axis, or the normal of a slide row, in the frame of b
  Vec2 contact_axis = Vec2::Zero();
  bool is_axis_in_a = false;
  int memory = -1;               ///< slot of base in the state's memory; base_rate is the next one
  const Signal* drive = nullptr; ///< null: not driven
  DriveLevel level = DriveLevel::position;
  const char* quantity = "";     ///< what the row holds, for messages and channels: "x", "angle"
  int element = -1;              ///< index of the element it belongs to
};

/// The row's measure of a against b: another body's motion, or Origin where a is seen from b.
template <bool WithBias, class B>
STEPLAP_INLINE MeasureValue<double> evaluate_row(const RowSpec& row, const Motion<double>& a, const B& b) {
  switch (row.kind) {
  case MeasureKind::axis:
    return AxisMeasure{row.point_a, row.point_b, row.direction}.at<WithBias>(a, b);
  case MeasureKind::distance:
    return DistanceMeasure{row.point_a, row.point_b}.at<WithBias>(a, b);
  case MeasureKind::angle:
    return AngleMeasure{}.at<WithBias>(a, b);
  case MeasureKind::slide:
    break;
  }
  return SlideMeasure{row.point_a, row.point_b, row.direction, row.contact_axis, row.is_axis_in_a}
      .at<WithBias>(a, b);
}

template <bool WithBias>
STEPLAP_INLINE MeasureValue<double> evaluate_row(const RowSpec& row, const Motion<double>* motion) {
  return evaluate_row<WithBias>(row, motion[row.a], motion[row.b]);
}

/// Where the row is held at time t: value, rate, acceleration of the target.
inline SignalJet row_target(const RowSpec& row, const double* memory, double t) {
  SignalJet target;
  if (row.memory >= 0) target.value = memory[row.memory];
  if (row.drive) {
    const SignalJet jet = row.drive->drive(t, row.level);
    const double base_rate = memory[row.memory + 1];
    target.value += base_rate * t + jet.value;
    target.rate = base_rate + jet.rate;
    target.acceleration = jet.acceleration;
  }
  return target;
}

} // namespace steplap
