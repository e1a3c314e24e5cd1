// Stores samples of a voyage in a file, so that an interrupted assessment can continue (tools/study/store.h).
#pragma once

#include "tools/assess/samples.h"
#include "tools/study/store.h"

#include <memory>

namespace steplap::assess {

/// The file with the samples of one assessment.
class SampleStore {
public:
  /// Opens the file named by the options, if any. A file of another assessment is replaced, because its samples belong to other models,
  /// records or values.
  SampleStore(const SamplingOptions& options, const std::vector<DrivenModel>& models,
              const std::vector<std::vector<DriveHistory>>& histories, const UncertainValues& uncertain);
  /// Fills the first entries with stored samples. Returns their number.
  [[nodiscard]] long load(std::vector<VoyageSample>& samples);
  /// Stores the samples with indices `begin` (from 0) to `end` − 1.
  void append(const std::vector<VoyageSample>& samples, long begin, long end);

private:
  std::unique_ptr<study::Store> store_;
};

} // namespace steplap::assess
