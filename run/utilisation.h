// How near everything that has a limit came to it: criteria, joints, ties, friction. 1 is the limit.
//
//   at most L > 0       value / L                        a force of 274 kN of 300 kN: 91 %
//   at least L > 0      L / value                        a margin of 1.32, at least 1.2: 91 %; a margin of friction is 1 / share
//   L of another sign   the way from the value at the start to the limit, how much of it was gone
//   friction            the largest value of its channel "share": force over what holds at the same instant; 1 from where it slips
#pragma once

#include "run/range_index.h"
#include "run/report.h"
#include "run/shown_quantity.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// What one thing used of what it may.
struct Utilisation {
  std::string name;                   ///< "front joint: friction", or that of the criterion
  std::string channel;                ///< whose extreme it is
  double share = 0.0;                 ///< 1: the limit; more: beyond it; at most k_most_share
  std::optional<double> value, limit; ///< SI; none of friction, of which both change
  std::string unit;                   ///< of both
  std::optional<double> at;           ///< s
  bool is_judged = false;             ///< a criterion of the verdict
  bool beyond = false;                ///< the limit is passed: the criterion is not met, or it slipped or broke
  std::optional<double> error;        ///< of the share; not-a-number: unknown
  std::string detail;                 ///< "274 kN of 300 kN", "1.32, at least 1.2"
  std::string text;                   ///< "91 % of the limit: 274 kN of 300 kN"

  static constexpr double k_most_share = 1000.0; ///< of what has nothing left to hold by
};

/// The worst first; of friction only the worst hundred.
[[nodiscard]] std::vector<Utilisation> utilisations_of(const Report& report, const RangeIndex& ranges, ShownDigits digits = {});

} // namespace steplap
