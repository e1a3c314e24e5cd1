// A scalar constraint row: a measure of two bodies with a prescribed value,
//
//   measure(q) = base + base_rate·t + drive(t)
//
// `base` (and `base_rate` of a row driven by acceleration) are in State::bases. They are set when the row becomes active: at the start of a
// run, or at the onset of sticking. The row of a skate constrains only velocities; its value is always zero.
//
// A row over more than two bodies (a rope over a moving pulley) is a list of such measures, called parts, whose sum is constrained. Its
// gradient and second derivative are the sums over the parts.
#pragma once

#include "mbd/model/signal.h"
#include "mbd/system/measure.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace steplap {

enum class MeasureKind : unsigned char { axis, distance, angle, slide, roll_line, roll_round, skate };

/// Constants of a row that are set when it becomes active.
struct RowBase {
  double value = 0.0; ///< of the measure, m or rad
  double rate = 0.0;  ///< of the measure of a row driven by acceleration, m/s or rad/s; 0 of all others
};

/// One constraint row between two bodies: measure, and for a driven row its target.
struct RowSpec {
  MeasureKind kind = MeasureKind::axis;
  int a = k_ground, b = k_ground; ///< bodies of the compiled system
  Vec2 point_a = Vec2::Zero(), point_b = Vec2::Zero();
  Vec2 direction = Vec2::Zero(); ///< axis, or normal of a slide or roll_line, or start of a roll_round, in the frame of b; normal of a
                                 ///< skate, in the frame of a
  double radius_a = 0.0, radius_b = 0.0; ///< for rolling
  Vec2 contact_axis = Vec2::Zero();
  bool is_axis_in_a = false;
  int base = -1;                 ///< index in State::bases; −1: none
  const Signal* drive = nullptr; ///< null if the row is not driven
  DriveLevel level = DriveLevel::position;
  const char* quantity = "";     ///< constrained quantity, for messages and channels: "x", "angle"
  int element = -1;              ///< index of its element
  const RowSpec* next = nullptr; ///< next part of the same row; of a part only bodies and measure are used
};

/// Evaluates rolling and skates. These are rare and therefore not inlined, so that loops over other rows remain short.
template <bool WithBias, class S, class B>
[[gnu::noinline]] MeasureValue<S> evaluate_rare(const RowSpec& row, const Motion<S>& a, const B& b) {
  if (row.kind == MeasureKind::skate) return SkateMeasure{row.point_a, row.direction}.at<WithBias>(a, b);
  if (row.kind == MeasureKind::roll_line) return RollLineMeasure{row.point_a, row.point_b, row.direction, row.radius_a}.at<WithBias>(a, b);
  return RollRoundMeasure{row.point_a, row.point_b, row.direction, row.radius_a, row.radius_b}.at<WithBias>(a, b);
}

/// Returns the measure of the row for the motions a and b. If a is given relative to b, pass Origin as b.
template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> evaluate_row(const RowSpec& row, const Motion<S>& a, const B& b) {
  switch (row.kind) {
  case MeasureKind::axis: return AxisMeasure{row.point_a, row.point_b, row.direction}.at<WithBias>(a, b);
  case MeasureKind::distance: return DistanceMeasure{row.point_a, row.point_b}.at<WithBias>(a, b);
  case MeasureKind::angle: return AngleMeasure{}.at<WithBias>(a, b);
  case MeasureKind::roll_line:
  case MeasureKind::roll_round:
  case MeasureKind::skate: return evaluate_rare<WithBias>(row, a, b);
  case MeasureKind::slide: break;
  }
  return SlideMeasure{row.point_a, row.point_b, row.direction, row.contact_axis, row.is_axis_in_a}.at<WithBias>(a, b);
}

/// Returns the sums of value, rate and bias over the parts of a row. The direction is NaN, since the parts have different ones; gradients
/// must be taken from the parts.
template <bool WithBias> [[gnu::noinline]] MeasureValue<double> evaluate_parts(const RowSpec& row, const Motion<double>* motion) {
  MeasureValue<double> sum;
  for (const RowSpec* part = &row; part; part = part->next) {
    const MeasureValue<double> m = evaluate_row<WithBias>(*part, motion[part->a], motion[part->b]);
    sum.value += m.value;
    sum.rate += m.rate;
    sum.bias += m.bias;
  }
  sum.direction.x = sum.direction.y = std::numeric_limits<double>::quiet_NaN();
  return sum;
}

template <bool WithBias> STEPLAP_INLINE MeasureValue<double> evaluate_row(const RowSpec& row, const Motion<double>* motion) {
  if (row.next) [[unlikely]]
    return evaluate_parts<WithBias>(row, motion);
  return evaluate_row<WithBias>(row, motion[row.a], motion[row.b]);
}

/// Returns value, rate and acceleration that the row prescribes for its measure at time t.
inline SignalJet row_target(const RowSpec& row, const RowBase* bases, double t) {
  SignalJet target;
  if (row.base >= 0) target.value = bases[row.base].value;
  if (row.drive) {
    const SignalJet jet = row.drive->drive(t, row.level);
    const double base_rate = bases[row.base].rate;
    target.value += base_rate * t + jet.value;
    target.rate = base_rate + jet.rate;
    target.acceleration = jet.acceleration;
  }
  return target;
}

/// Returns value − target. In rolling of two circles the value is known only up to whole turns, so the result is reduced to the range of ±
/// half a turn.
inline double off_target(const RowSpec& row, double value, double target) {
  if (row.kind != MeasureKind::roll_round) return value - target;
  return std::remainder(value - target, 2.0 * std::numbers::pi * (row.radius_a + row.radius_b));
}

} // namespace steplap
