// Distance of two points in space, for chains and springs that lead out of the plane of motion.
//
// The points move in parallel planes at the distance c. With the distance l in the plane:
//
//   L = √(l² + c²)    ∂L/∂q = (l/L) ∂l/∂q    L̇ = (l/L) l̇
//
// The component of the force in the plane is therefore l/L of the force. A second chain on the other side balances the component across the
// plane.
#pragma once

#include "mbd/system/measure.h"
#include "mbd/system/system.h"
#include "mbd/system/turn_table.h"

#include <cmath>

namespace steplap {

/// Returns L, m.
template <class S> [[nodiscard]] S length_in_space(const S& in_plane, double across) {
  using std::sqrt;
  return across == 0.0 ? in_plane : sqrt(in_plane * in_plane + S(across * across));
}

/// Measure with the value L, for LawGroup.
struct SpaceDistance {
  DistanceMeasure plane;
  double across = 0.0; ///< distance c of the planes, m

  /// Without the acceleration bias, which only constraints need.
  template <bool WithBias, class S, class B> MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    static_assert(!WithBias);
    MeasureValue<S> m = plane.at<false, S>(a, b);
    if (across == 0.0) return m;
    const S length = length_in_space(m.value, across), share = m.value / length;
    m.value = length;
    m.rate = share * m.rate;
    m.direction = share * m.direction;
    return m;
  }
};

[[nodiscard]] inline Turning turning_of(const SpaceDistance& m) { return turning_of(m.plane); }

/// Returns true and reports an error if a force has both an axis and a distance `across` the plane.
[[nodiscard]] inline bool refuses_across(SystemBuilder& builder, bool has_axis, double across) {
  const bool is_wrong = has_axis && across > 0.0;
  if (is_wrong) builder.error("'across' is the offset of two points, and 'axis' fixes the direction: give one of them");
  return is_wrong;
}

/// Calls use(measure) with the distance of two markers whose planes are `across` apart, m: a DistanceMeasure if `across` is zero. Reports
/// an error instead if the markers coincide in the plane.
template <class Use>
void with_distance(SystemBuilder& builder, const CompiledMarker& a, const CompiledMarker& b, double across, Use&& use) {
  if ((builder.marker_position(a) - builder.marker_position(b)).norm() < 1e-12)
    return builder.error("its ends coincide, so its direction is undefined: move a marker, or give an 'axis'");
  const DistanceMeasure in_plane{a.point, b.point};
  if (across > 0.0) use(SpaceDistance{in_plane, across});
  else use(in_plane);
}

} // namespace steplap
