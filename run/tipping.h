// How far what stands is from tipping over: the angle by which it can be tilted, and the acceleration that does the same.
//
// What joints hold together, with all that stands on it, is taken as one rigid part on its feet: springs and contacts keep
// the forces that they have in the pose looked at, friction at the foot that it turns about holds. It tips about a foot P when
// the power of gravity g(φ), turned by φ, and of the other loads in a rotation about P that lifts the other feet vanishes:
//   A cos φ + B sin φ + C = 0,
// A of gravity, B of gravity turned by a right angle, C of loads and springs. For a block of width 2b and height 2h on an
// incline α: φ = atan(b/h) − α. What hangs freely counts with its mass in the point that it hangs from (tipping_hung.h). What
// stands on several others, and these with it, are blocks that come down together (tipping_mechanism.h). Parts that joints keep
// from turning over, that forces alone hold in shape (a servo) or that springs and ropes tie to others are not judged, and it is
// said why.
#pragma once

#include "run/loaded_model.h"

#include <optional>

namespace steplap {

/// How near a part is to tipping over, and about what.
struct Tipping {
  int body = 0;                               ///< the heaviest of the part
  int others = 0;                             ///< bodies that tip with it
  std::string about, lifts;                   ///< feet
  double margin = 0.0;                        ///< |φ|, rad; negative: it tips over as it is, and would stand if tilted back by so much
  bool is_clockwise = true;                   ///< the tilt of the ground that makes it tip
  double acceleration = 0.0;                  ///< of what it stands on that makes it tip, m/s²; zero: none does
  std::optional<double> slope, slope_at_most; ///< of what it stands on, now and where it tips, rad; where all feet stand on one
};

/// Of every part that can tip over, the nearest way for each; margins of more than a right angle are left out.
[[nodiscard]] std::vector<Tipping> tipping_of(const LoadedModel& loaded, const State& state);

/// What stands on feet and is not judged.
struct Unjudged {
  int body = 0;    ///< the heaviest of the part
  std::string why; ///< follows "because"
};
/// Of every such part; parts that are judged are not among them.
[[nodiscard]] std::vector<Unjudged> not_judged_for_tipping(const LoadedModel& loaded, const State& state);

/// A sentence for each part that tips over as it is: about what, and from which angle on.
[[nodiscard]] std::vector<std::string> tipping_over(const LoadedModel& loaded, const State& state);

} // namespace steplap
