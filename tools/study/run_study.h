// A study run from its file to its answer, as the command line does it.
#pragma once

#include "tools/study/evaluator.h"
#include "tools/study/finding.h"
#include "tools/study/store.h"
#include "tools/study/study_reader.h"

#include <functional>
#include <optional>
#include <string>

namespace steplap::study {

struct StudyOptions {
  int threads = 1;                              ///< of this process, at least 1
  StoreMode mode = StoreMode::run;              ///< what becomes of samples that the store holds already
  std::function<void(const Pace&)> progress;    ///< told how far the study is, after each batch of samples
  std::function<std::string()> stop;            ///< asked after each batch; what it says is why the study ends there, "" lets it go on
  std::function<void(const std::string&)> note; ///< told of what whoever waits may want to know, a sentence
};

/// Runs the study, or goes on with it, and keeps samples and answer in the store at `path`. Of several ranks the first asks and
/// answers; the others run samples for it and answer nothing. Throws FileError for a store that cannot be used, NumericalFailure for
/// a study that was stopped, or was to stop at a failed run and did.
[[nodiscard]] std::optional<Answer> run_study(const LoadedStudy& loaded, const std::string& path, const Ranks& ranks,
                                              const StudyOptions& options);

} // namespace steplap::study
