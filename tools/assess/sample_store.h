// Samples of a voyage kept in a file, so that an assessment that was interrupted goes on (tools/study/store.h).
#pragma once

#include "tools/assess/samples.h"
#include "tools/study/store.h"

#include <memory>

namespace steplap::assess {

class SampleStore {
public:
  /// No file if the options name none. One of another assessment is replaced: its samples are of other models, records or values.
  SampleStore(const SamplingOptions& options, const std::vector<DrivenModel>& models,
              const std::vector<std::vector<DriveHistory>>& histories, const UncertainValues& uncertain);
  /// Fills the first samples with those that are there; returns how many.
  [[nodiscard]] long load(std::vector<VoyageSample>& samples);
  /// Keeps samples from number `begin` (from 0) to before `end`.
  void append(const std::vector<VoyageSample>& samples, long begin, long end);

private:
  std::unique_ptr<study::Store> store_;
};

} // namespace steplap::assess
