// Random models of parts in parts, and the same models written out by a second hand: places, angles, formulas and names worked out
// here in plain arithmetic, in the order of operations that mbd/io/part_frame.h gives.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace steplap::testing {

struct PartTree {
  std::map<std::string, std::string> files; ///< by name; "model.toml" takes the others
  std::string written_out;                  ///< the same model without a part, a repetition or a parameter
  int depth = 0, parts = 0;                 ///< how deep, and how many parts in all
};

[[nodiscard]] PartTree random_part_tree(std::uint64_t seed);

} // namespace steplap::testing
