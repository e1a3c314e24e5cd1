// Results of a study.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace steplap::study {

/// A number found by a study, with its confidence interval, if there is one, and its status.
struct Finding {
  std::string method;   ///< method by which it was computed: "monte_carlo", "form", …
  std::string subject;  ///< variable, response or limit state to which it refers
  std::string quantity; ///< "probability", "beta", "first order", ...
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN(), high = std::numeric_limits<double>::quiet_NaN();
  long samples = 0;     ///< number of samples from which it was computed
  std::string status{}; ///< "" if valid; otherwise the reason why it is not reliable
};

/// Reliability of an answer.
enum class Standing { done, not_met, not_trusted };
[[nodiscard]] const char* name_of(Standing standing);

/// Answer of a study.
struct Answer {
  std::vector<Finding> findings;
  std::vector<std::string> notes; ///< lines for the user
  Standing standing = Standing::done;

  /// Sets the standing to the worse of the present one and `to`.
  void degrade(Standing to) { standing = std::max(standing, to); }
};

} // namespace steplap::study
