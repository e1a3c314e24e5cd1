// One scalar constraint row: a measure of two bodies that is held at a target.
//
//   measure(q) = base + base_rate·t + drive(t)
// A skate's row has a rate and no value: of it only the second line of f = 0, ḟ = 0, f̈ = 0 means anything, and it is never off.
// base (and base_rate for a row driven by its acceleration) live in the state's memory: they are set when the row begins
// to hold (at the start of a run; at the begin of sticking).
//
// A row over more than two bodies (a rope over a pulley that moves) is a list of such measures, its parts, whose sum is held:
// everything linear in a row, its gradient and second rate, is a sum over parts of two bodies each.
#pragma once

#include "mbd/model/signal.h"
#include "mbd/system/measure.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace steplap {

enum class MeasureKind : unsigned char { axis, distance, angle, slide, roll_line, roll_round, skate };

struct RowSpec {
  MeasureKind kind = MeasureKind::axis;
  int a = k_ground, b = k_ground; ///< bodies of the compiled system
  Vec2 point_a = Vec2::Zero(), point_b = Vec2::Zero();
  Vec2 direction = Vec2::Zero(); ///< axis, or a slide's or roll's normal, or its start, in the frame of b; a skate's normal in that of a
  double radius_a = 0.0, radius_b = 0.0; ///< of a roll row
  Vec2 contact_axis = Vec2::Zero();
  bool is_axis_in_a = false;
  int memory = -1;               ///< slot of base in the state's memory; base_rate is the next one
  const Signal* drive = nullptr; ///< null: not driven
  DriveLevel level = DriveLevel::position;
  const char* quantity = "";     ///< what the row holds, for messages and channels: "x", "angle"
  int element = -1;              ///< index of the element it belongs to
  const RowSpec* next = nullptr; ///< a further part of the same row; of a part only the bodies and the measure count
};

/// Rolls and skates are rare: out of line, so that the loops over the other rows stay short.
template <bool WithBias, class S, class B>
[[gnu::noinline]] MeasureValue<S> evaluate_rare(const RowSpec& row, const Motion<S>& a, const B& b) {
  if (row.kind == MeasureKind::skate) return SkateMeasure{row.point_a, row.direction}.at<WithBias>(a, b);
  if (row.kind == MeasureKind::roll_line) return RollLineMeasure{row.point_a, row.point_b, row.direction, row.radius_a}.at<WithBias>(a, b);
  return RollRoundMeasure{row.point_a, row.point_b, row.direction, row.radius_a, row.radius_b}.at<WithBias>(a, b);
}

/// The row's measure of a against b: another body's motion, or Origin where a is seen from b.
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

/// The sum over the parts of a row: value, rate and bias. No one direction stands for all of them: it is not a number, for
/// whoever would use it; gradients are those of each part.
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

/// value − target. The roll of two circles is known up to whole turns of one round the other only (gears turn in
/// place, but seen from b a goes round): a sticking or bilateral row is never half a turn off.
inline double off_target(const RowSpec& row, double value, double target) {
  if (row.kind != MeasureKind::roll_round) return value - target;
  return std::remainder(value - target, 2.0 * std::numbers::pi * (row.radius_a + row.radius_b));
}

} // namespace steplap
