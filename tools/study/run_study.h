// Runs a study from its file to its answer, as the command line does.
#pragma once

#include "tools/study/evaluator.h"
#include "tools/study/finding.h"
#include "tools/study/store.h"
#include "tools/study/study_reader.h"

#include <functional>
#include <optional>
#include <string>

namespace steplap::study {

/// Options of run_study().
struct StudyOptions {
  int threads = 1;                              ///< number of threads of this process, at least 1
  StoreMode mode = StoreMode::run;              ///< what to do if the store already contains samples
  std::function<void(const Pace&)> progress;    ///< called after each batch of samples
  std::function<std::string()> stop;            ///< called after each batch; a non-empty text stops the study and becomes its reason
  std::function<void(const std::string&)> note; ///< receives messages for the user, one sentence each
};

/// Runs or continues a study and stores samples and answer in the store at `path`. Returns the answer on rank 0; other ranks run samples
/// and return nothing. Throws FileError if the store cannot be used, NumericalFailure if the study was stopped, or if a run failed and the
/// study is to stop then.
[[nodiscard]] std::optional<Answer> run_study(const LoadedStudy& loaded, const std::string& path, const Ranks& ranks,
                                              const StudyOptions& options);

} // namespace steplap::study
