// The voyage under all that is uncertain: samples of the numbers through all events of all models, on all threads.
//
// Sample n of a seed is the same on every machine and for every number of threads. Samples that were made are kept in a store
// (tools/study/store.h), so that an assessment that was interrupted goes on where it was.
#pragma once

#include "tools/assess/shared_friction.h"
#include "tools/assess/uncertain_values.h"
#include "tools/assess/voyage_runner.h"

#include <functional>
#include <string>
#include <vector>

namespace steplap::assess {

/// A voyage with values of its own.
struct VoyageSample {
  std::vector<double> values; ///< of the uncertain numbers
  VoyageSummary summary;      ///< of all models
  std::vector<char> slips;    ///< per event of model 0, then of model 1, …
};

/// How samples are made.
struct SamplingOptions {
  long samples = 200;
  std::uint64_t seed = 1;
  int threads = 0;   ///< 0: OMP_NUM_THREADS, else as many as there are processors
  std::string store; ///< file that keeps them; "": none
  std::function<void(long done, long all)> progress;
  std::function<std::string()> stop; ///< what it says is why to stop; ""
};

/// A probability with its interval (Clopper and Pearson, 95 %): runs of which nothing is known count as harmless for its low end and
/// as harmful for its high end.
struct Probability {
  double value = 0.0, low = 0.0, high = 1.0;
  long runs = 0, unknown = 0;
};

/// `shared`: frictions that the models share. Throws NumericalFailure if it was stopped.
[[nodiscard]] std::vector<VoyageSample> sample_voyages(const std::vector<DrivenModel>& models,
                                                       const std::vector<std::vector<DriveHistory>>& histories,
                                                       const UncertainValues& uncertain, const SamplingOptions& options,
                                                       const std::vector<SharedFriction>& shared = {});
/// One voyage with these values; of all models.
[[nodiscard]] VoyageSample voyage_with(const std::vector<DrivenModel>& models, const std::vector<std::vector<DriveHistory>>& histories,
                                       const UncertainValues& uncertain, const std::vector<double>& values,
                                       const std::vector<SharedFriction>& shared = {});

/// Of a joint to slip in an event of a model.
[[nodiscard]] Probability slip_probability(const std::vector<VoyageSample>& samples, std::size_t model, std::size_t event,
                                           std::size_t events);
/// Of a joint to slip, or an acceptance not to be met, in the voyage.
[[nodiscard]] Probability damage_probability(const std::vector<VoyageSample>& samples);
/// Does the summary tell of damage?
[[nodiscard]] bool is_damaged(const VoyageSummary& summary);
/// Of each uncertain number: the square of its rank correlation with the least margin, 0 to 1. Empty without samples.
[[nodiscard]] std::vector<double> shares_of(const std::vector<VoyageSample>& samples);

} // namespace steplap::assess
