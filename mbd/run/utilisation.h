// Computes the utilisation of everything that has a limit: criteria, joints, ties, friction. 1 is the limit.
//
//   at most L > 0         value / L             a force of 274 kN with a limit of 300 kN: 91 %
//   at least L > 0        L / value             a margin of 1.32 with a limit of 1.2: 91 %; a margin of friction is 1 / share
//   other sign of L       (value at start − value) / (value at start − limit)
//   friction              largest value of the channel "share": force over capacity at the same time; 1 once it slips
#pragma once

#include "mbd/run/range_index.h"
#include "mbd/run/report.h"
#include "mbd/run/shown_quantity.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Utilisation of one limit.
struct Utilisation {
  std::string name;                     ///< "front joint: friction", or the name of the criterion
  std::string channel;                  ///< channel whose extreme was used
  double share = 0.0;                   ///< utilisation: 1 at the limit, above if exceeded; at most k_most_share
  std::optional<double> value, limit;   ///< SI; empty for friction, whose force and capacity both change with time
  std::string unit;                     ///< unit of value and limit
  std::optional<double> at;             ///< time of the extreme, s
  std::optional<std::size_t> criterion; ///< index in Judgement::criteria; empty for friction and ties that no criterion limits
  bool beyond = false;                  ///< the limit was exceeded: criterion not met, slipped or broke
  std::optional<double> error;          ///< error of the share; NaN: unknown
  std::string detail;                   ///< "274 kN of 300 kN", "1.32, at least 1.2"
  std::string text;                     ///< "91 % of the limit: 274 kN of 300 kN"

  static constexpr double k_most_share = 1000.0; ///< utilisation if the capacity is zero
};

/// Returns utilisations in descending order, with at most a hundred friction elements.
[[nodiscard]] std::vector<Utilisation> utilisations_of(const Report& report, const RangeIndex& ranges, ShownDigits digits = {});

/// Returns the reserve of a run: the least of 1 − utilisation − its estimated error over all criteria (0.2 means 20 %); 1 if no criterion
/// has a utilisation. It is positive if the verdict is "hold", and negative otherwise.
[[nodiscard]] double reserve_of(const Report& report);

} // namespace steplap
