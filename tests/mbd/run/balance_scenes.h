// Random scenes of which closed forms say whether they balance: each as the text of a model, turned by a random angle with its gravity.
#pragma once

#include <cstdint>
#include <string>

namespace steplap {

/// A scene and what is known about it.
struct BalanceScene {
  std::string text;      ///< of the model
  std::string what;      ///< for messages: the kind with its numbers
  bool balances = false; ///< an exponential growth over the longer of a leg and one second has an exponent well above 3
  bool is_sound = true;  ///< nothing else speaks against a verdict of hold
};

/// The kinds in turn, with all sizes, loads and times drawn from `seed`.
[[nodiscard]] BalanceScene balance_scene(std::uint64_t seed);

} // namespace steplap
