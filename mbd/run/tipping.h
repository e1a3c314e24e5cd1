// Computes the margin against tipping over: the tilt angle, and the acceleration of the support, that tip a part.
//
// A part is a set of bodies connected by joints, with everything that stands on it, treated as one rigid body on its feet. Springs and
// contacts keep their forces in the given pose, and the tipping foot is assumed not to slide. The part tips about a foot P if, in a
// rotation about P that lifts the other feet, the power of gravity turned by φ and of the other loads vanishes:
//
//   A cos φ + B sin φ + C = 0,
//
// with A from gravity, B from gravity turned by 90°, C from loads and springs. For a block of width 2b and height 2h on an incline α this
// gives φ = atan(b/h) − α. A freely hanging load counts as a point mass at its suspension point (tipping_hung.h). Parts that rest on
// several others are treated as blocks that collapse together (tipping_mechanism.h). Three kinds of parts are not judged, and the reason is
// reported: parts that joints prevent from tipping, parts whose shape only forces maintain (a servo), and parts tied to others by springs
// or ropes.
#pragma once

#include "mbd/run/loaded_model.h"

#include <optional>

namespace steplap {

/// Margin of a part against tipping.
struct Tipping {
  int body = 0;             ///< heaviest body of the part
  int others = 0;           ///< number of other bodies of the part
  std::string about, lifts; ///< names of the foot about which it tips and of the foot that lifts
  double margin = 0.0; ///< |φ|, rad; negative if the part tips in its present pose: it would be stable after tilting back by this angle
  bool is_clockwise = true;  ///< direction in which the ground is tilted
  double acceleration = 0.0; ///< smallest acceleration of the support that tips the part, m/s²; zero if none does
  /// Slope of the support in the present pose and at the limit, rad; empty unless all feet are on one plane.
  std::optional<double> slope, slope_at_most;
};

/// Returns the smallest margin of every part that can tip. Margins of more than a right angle are omitted.
[[nodiscard]] std::vector<Tipping> tipping_of(const LoadedModel& loaded, const State& state);

/// A part on feet whose margin cannot be computed.
struct UnjudgedPart {
  int body = 0;    ///< heaviest body of the part
  std::string why; ///< reason, as a clause after "because"
};
/// Returns all parts on feet that tipping_of() does not judge.
[[nodiscard]] std::vector<UnjudgedPart> not_judged_for_tipping(const LoadedModel& loaded, const State& state);

/// Returns a sentence for each part that tips in its present pose, with the foot about which it tips and the limit angle.
[[nodiscard]] std::vector<std::string> tipping_over(const LoadedModel& loaded, const State& state);

} // namespace steplap
