// The hard cases: models under models/benchmarks/hard, each with an answer known from elsewhere (a
// closed form, or a few lines of computation that share nothing with the program), for every
// integrator.
//
// A case's answer turns a finished run into one number, its error, scaled so that 1 is nothing
// right at all. Tests hold it against the case's bound; tools/hard_cases prints it beside the cost.
#pragma once

#include "mbd/simulation/simulation.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace steplap::hard {

/// A run as an answer sees it.
struct Finished {
  const System& system;
  const RunResult& result;

  [[nodiscard]] const std::vector<double>& times() const { return result.trajectory->times(); }
  [[nodiscard]] std::vector<double> series(const std::string& channel) const { return result.trajectory->series(channel); }
  [[nodiscard]] double last(const std::string& channel) const { return series(channel).back(); }
  /// Of one element with one description.
  [[nodiscard]] std::vector<double> event_times(const std::string& element, const std::string& what) const;
  /// Largest |channel − exact(t)| over the samples.
  [[nodiscard]] double worst(const std::string& channel, const std::function<double(double t)>& exact) const;
};

struct HardCase {
  int number;       ///< group, 1 to 12
  std::string name; ///< what is said of it in tables
  std::string file; ///< in models/benchmarks/hard, without ending
  std::vector<std::string> overrides;
  std::function<double(const Finished&)> error;
  double bound;     ///< of the error, for the settings in the file
  std::string unit; ///< what the error is relative to
  /// A method that is only of first order is held to this instead; 0: it is not fit for the case.
  double first_order_bound = 1e-2;
  std::vector<std::string> shortened = {}; ///< overrides for a test, where the whole case takes seconds
};

[[nodiscard]] const std::vector<HardCase>& hard_cases();

/// What came of one case with one integrator.
struct Outcome {
  std::string failure; ///< empty: finished
  double error = 0.0;
  double energy_residual = 0.0; ///< of the energy exchanged
  RunStatistics statistics;
  bool is_finite = false; ///< it reached its end, and no sample is NaN or infinite in a coordinate or velocity
};

/// The methods that are held to the answers.
[[nodiscard]] std::vector<std::string> integrators();
[[nodiscard]] bool is_first_order(const std::string& integrator);
[[nodiscard]] double bound_for(const HardCase& hard_case, const std::string& integrator);

/// Never throws NumericalFailure. `more`: overrides after those of the case.
[[nodiscard]] Outcome run(const HardCase& hard_case, const std::string& integrator, bool is_shortened,
                          const std::vector<std::string>& more = {});

} // namespace steplap::hard
