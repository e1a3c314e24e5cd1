// Interface of a study kind, implemented by one file pair each: its table in the study file, its computation, and the presentation of its
// findings.
//
// Reader, schema, store and page use kinds through this interface only. kinds.cpp lists them.
#pragma once

#include "tools/study/finding_part.h"
#include "tools/study/study_run.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace steplap::study {

/// How samples were drawn: independently from the distributions, from them by a design such as Latin hypercube, or otherwise (searches,
/// lines, grids). Distributions are not shown for the last kind.
enum class Drawn { independently, by_design, otherwise };

/// Settings of a study as stored for its page: the texts of each field, by name. The list is empty for numbers.
using ShownSettings = std::map<std::string, std::vector<std::string>>;

/// Description and functions of one kind.
struct StudyKind {
  std::string name; ///< name of the kind, and of its table in the study file
  std::string doc;
  FieldTable fields; ///< fields of its table
  std::shared_ptr<KindSettings> (*create)() = nullptr;
  std::vector<std::string> shown{};  ///< names of the settings that the page shows
  bool takes_histories = false;      ///< true if the kind uses measured records
  bool takes_evidence = false;       ///< true if the kind uses past loads
  bool draws_jointly = false;        ///< true if variables are drawn from their joint distribution with correlations, not set one by one
  bool seeks_a_mean = false;         ///< true if the searched variable may be the mean of a distribution
  bool begins_with_sentence = false; ///< true if the first note of the answer is a complete sentence with the result
  bool shows_running_means = false;  ///< true if samples are independent, so that the page can show the convergence of fractions and means
  std::vector<FindingPart> parts{};  ///< presentation of its findings, by quantity
  std::vector<PointRole> points{};   ///< findings that are points in the space of the variables
  /// Adds data that the kind needs and the file does not contain: limit states, variables, variants of models. May be nullptr.
  void (*prepare)(LoadedStudy& loaded) = nullptr;
  /// Appends errors of the study for this kind to `problems`. Called before anything runs.
  void (*check)(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) = nullptr;
  Answer (*run)(StudyRun& run) = nullptr;
  /// Returns how samples were drawn, for the page. nullptr means Drawn::otherwise.
  Drawn (*drawn)(const ShownSettings& settings) = nullptr;

  /// Sets T as the type of the kind's settings.
  template <class T> void holds() {
    create = []() -> std::shared_ptr<KindSettings> { return std::make_shared<T>(); };
  }
};

/// Returns true if the setting has exactly this one text.
[[nodiscard]] inline bool is_only(const ShownSettings& settings, const std::string& key, const std::string& text) {
  const auto found = settings.find(key);
  return found != settings.end() && found->second == std::vector<std::string>{text};
}

/// Returns the address of the most derived settings object, which the field table expects.
[[nodiscard]] inline void* fields_of(KindSettings& settings) { return dynamic_cast<void*>(&settings); }
[[nodiscard]] inline const void* fields_of(const KindSettings& settings) { return dynamic_cast<const void*>(&settings); }

} // namespace steplap::study
