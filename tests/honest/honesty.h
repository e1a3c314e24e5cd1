// How honest an estimated error is: against the error that a run has beside two much more accurate ones.
//
// The truth is dop853 at a tolerance of 1e-12, and it is known to what tsit5 at 1e-12 differs from it by: so much is
// taken off the error, for it may be the truth's own.
#pragma once

#include "mbd/trust/global_error.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap::testing {

/// Error over estimate of one kind of number: 1 or less where the estimate holds.
struct Honesty {
  std::string kind;
  double worst = 0.0;
  std::string where = {};
  double error = 0.0, estimate = 0.0;         ///< of the worst
  double most_range = 0.0;                    ///< of the worst: estimate over the channel's range, or the duration
  long count = 0, unknown = 0, too_small = 0; ///< numbers looked at; those whose error is unknown; worst > 1
  std::vector<double> tightness = {};         ///< estimate over error, of all numbers whose error is known not to be zero
};

struct Judged {
  std::vector<Honesty> kinds; ///< extremes, their times, ends, curves, event times, energies
  std::string failure;        ///< of the run or of a finer one: there is no estimate
};

/// A model and its truth; the model's run is cut off at `longest`, s.
class Truth {
public:
  Truth(const std::string& file, double longest);

  /// With step or tolerance.
  [[nodiscard]] Judged judged(const std::string& integrator, double setting) const;
  [[nodiscard]] const std::string& failure() const { return failure_; }
  [[nodiscard]] double cpu_seconds() const { return truth_.statistics.cpu_seconds; }

private:
  std::unique_ptr<System> system_;
  State initial_;
  SimulationOptions base_;
  RunResult truth_, second_;
  std::string failure_;
};

} // namespace steplap::testing
