// Simulates the voyage for samples of all uncertain numbers, in parallel threads.
//
// Sample n of a seed is the same on every computer and for every number of threads. Finished samples are stored in a file
// (tools/study/store.h), so that an interrupted assessment can continue.
#pragma once

#include "tools/assess/shared_friction.h"
#include "tools/assess/uncertain_values.h"
#include "tools/assess/voyage_runner.h"

#include <functional>
#include <string>
#include <vector>

namespace steplap::assess {

/// A voyage with one set of sampled values.
struct VoyageSample {
  std::vector<double> values; ///< values of all uncertain numbers
  VoyageSummary summary;      ///< worst over all models
  std::vector<char> slips;    ///< true if a joint slipped: first all events of model 0, then those of model 1, …
};

/// Options of the sampling.
struct SamplingOptions {
  long samples = 200;
  std::uint64_t seed = 1;
  int threads = 0;   ///< 0: OMP_NUM_THREADS if set, otherwise the number of processors
  std::string store; ///< name of the sample file; "": none
  std::function<void(long done, long all)> progress;
  std::function<std::string()> stop; ///< called repeatedly; a non-empty text stops the work and becomes its reason
};

/// A probability with its 95 % confidence interval (Clopper and Pearson). Runs without a result count as harmless for the lower bound and
/// as harmful for the upper bound.
struct Probability {
  double value = 0.0, low = 0.0, high = 1.0;
  long runs = 0, unknown = 0;
};

/// Simulates the samples. `shared` are frictions shared by models of two planes. Throws NumericalFailure if stopped.
[[nodiscard]] std::vector<VoyageSample> sample_voyages(const std::vector<DrivenModel>& models,
                                                       const std::vector<std::vector<DriveHistory>>& histories,
                                                       const UncertainValues& uncertain, const SamplingOptions& options,
                                                       const std::vector<SharedFriction>& shared = {});
/// Simulates one voyage in all models with these values.
[[nodiscard]] VoyageSample voyage_with(const std::vector<DrivenModel>& models, const std::vector<std::vector<DriveHistory>>& histories,
                                       const UncertainValues& uncertain, const std::vector<double>& values,
                                       const std::vector<SharedFriction>& shared = {});

/// Returns the probability that a joint slips in this event of this model.
[[nodiscard]] Probability slip_probability(const std::vector<VoyageSample>& samples, std::size_t model, std::size_t event,
                                           std::size_t events);
/// Limits to be considered: all limits, or only those that are not assumed.
enum class LimitsJudged { all, known };
/// Returns the probability that a joint slips or a limit of an [[acceptance]] is exceeded during the voyage.
[[nodiscard]] Probability damage_probability(const std::vector<VoyageSample>& samples, LimitsJudged limits = LimitsJudged::all);
/// Returns true if the summary contains damage: a slip or an acceptance that is not met.
[[nodiscard]] bool is_damaged(const VoyageSummary& summary, LimitsJudged limits = LimitsJudged::all);
/// Returns the influence of each uncertain number: the square of its rank correlation with the smallest margin, 0 to 1. Empty without
/// samples.
[[nodiscard]] std::vector<double> shares_of(const std::vector<VoyageSample>& samples);

} // namespace steplap::assess
