// What a study answers.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace steplap::study {

/// A number that a study found. It never stands alone: an interval where there is one, and a status.
struct Finding {
  std::string method;   ///< "monte_carlo", "form", ...
  std::string subject;  ///< variable, response or limit state it is about
  std::string quantity; ///< "probability", "beta", "first order", ...
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN(), high = std::numeric_limits<double>::quiet_NaN();
  long samples = 0;     ///< it took
  std::string status{}; ///< "" is well; else what is to be known about the number
};

/// How far an answer is to be relied on.
enum class Standing { done, not_met, not_trusted };
[[nodiscard]] const char* name_of(Standing standing);

struct Answer {
  std::vector<Finding> findings;
  std::vector<std::string> notes; ///< lines for people
  Standing standing = Standing::done;

  /// To the worse of both.
  void degrade(Standing to) { standing = std::max(standing, to); }
};

} // namespace steplap::study
