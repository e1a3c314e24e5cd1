// Random machines of several bodies that rub on each other, whose friction falls when it slides: some of it slides, and what it then
// no longer bears decides whether its neighbours hold.
#pragma once

#include "tests/random/random_number.h"

#include <string>
#include <vector>

namespace steplap::testing {

struct RubbingBodies {
  std::string text;                   ///< of the model, without [simulation]
  std::vector<std::string> frictions; ///< names of the friction elements
  std::vector<std::string> places;    ///< channels of what they slide along
  double end = 0.0;                   ///< s
  double acceleration = 0.0;          ///< m/s², which no body exceeds
};

/// How a scene is written: each of these leaves its physics as it is.
struct Writing {
  double sign = 1.0;        ///< −1: mirrored
  bool is_reversed = false; ///< bodies and elements in the opposite order
  double grip = 1.0;        ///< all friction is multiplied by this: to see what hangs by a hair
};

/// Up to five bodies on guides along one line, each held by the friction of one or two joints to the driven deck, the ground or another
/// body, and pushed by loads that begin at random times. `seed`: which of them.
[[nodiscard]] RubbingBodies rubbing_on_guides(int seed, const Writing& writing = {});
/// Two or three crates, one on the other, on a deck that brakes, with the friction of their feet; wind pushes them.
[[nodiscard]] RubbingBodies stacked_crates(int seed, const Writing& writing = {});
/// One or two limbs, held by the friction of sheets on a base that slides on the ground.
[[nodiscard]] RubbingBodies limbs_on_sliding_base(int seed, const Writing& writing = {});

} // namespace steplap::testing
