// A kind of study, as its own file pair describes it: its table in the study file, what it asks, what pages say of what it finds.
//
// The reader, the schema, the store and the page know kinds only by this; the list of them is in kinds.cpp.
#pragma once

#include "tools/study/finding_part.h"
#include "tools/study/study_run.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace steplap::study {

/// Whether samples are distributed as the study's variables are: drawn one by one, in a design, or neither (searches,
/// lines, grids: of these no distribution can be shown).
enum class Drawn { independently, by_design, otherwise };

/// What a store tells of a study's settings: for each that is shown its texts; of one that holds no text, none.
using ShownSettings = std::map<std::string, std::vector<std::string>>;

struct StudyKind {
  std::string name; ///< also of its table
  std::string doc;
  FieldTable fields; ///< of its table
  std::shared_ptr<KindSettings> (*create)() = nullptr;
  std::vector<std::string> shown{}; ///< fields of its table that the page tells
  bool takes_histories = false;     ///< measured records
  bool draws_jointly = false;       ///< variables are drawn with their correlations, not set one by one
  bool shows_running_means = false; ///< samples drawn one by one: the page shows how shares of failures and means settled
  std::vector<FindingPart> parts{}; ///< of its findings, by their quantities
  std::vector<PointRole> points{};  ///< its findings that are places in the space of the variables
  /// Adds what the kind needs besides what the file says: limit states, variables, variants of the model.
  void (*prepare)(LoadedStudy& loaded) = nullptr;
  /// Appends what is wrong with the study for this kind; nothing has run.
  void (*check)(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) = nullptr;
  Answer (*run)(StudyRun& run) = nullptr;
  /// How samples were drawn, for the page. Not given: otherwise.
  Drawn (*drawn)(const ShownSettings& settings) = nullptr;

  /// Its settings are of type T.
  template <class T> void holds() {
    create = []() -> std::shared_ptr<KindSettings> { return std::make_shared<T>(); };
  }
};

/// That one text is all that the setting holds.
[[nodiscard]] inline bool is_only(const ShownSettings& settings, const std::string& key, const std::string& text) {
  const auto found = settings.find(key);
  return found != settings.end() && found->second == std::vector<std::string>{text};
}

/// The settings as their fields take them: at the address of what was derived from KindSettings.
[[nodiscard]] inline void* fields_of(KindSettings& settings) { return dynamic_cast<void*>(&settings); }
[[nodiscard]] inline const void* fields_of(const KindSettings& settings) { return dynamic_cast<const void*>(&settings); }

} // namespace steplap::study
