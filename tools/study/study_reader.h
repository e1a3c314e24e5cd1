// Study files (TOML), as strict as model files: every error with its place, all of them at once, before anything runs.
#pragma once

#include "mbd/io/input_files.h"
#include "mbd/system/system.h"
#include "tools/study/study.h"

#include <functional>
#include <memory>

namespace steplap::study {

/// A model of a study: as given, for setting values, and completed and compiled once for checking.
struct StudyModel {
  std::string path, name; ///< name: the file's without ending
  Model given;
  std::string text;             ///< effective model, as TOML that stands alone
  std::vector<InputFile> files; ///< that it was read from: the model, what it extends, its records
  std::unique_ptr<System> system;
  std::vector<double> base; ///< per variable: what the first of its paths holds; not-a-number if it has none here
};

/// A model changed in another way than by values.
struct ModelVariant {
  std::string name;
  std::function<void(Model&)> apply; ///< to the model as given
  std::string gone{};                ///< element that is to be there no more
};

struct LoadedStudy {
  Study study;
  std::vector<std::shared_ptr<const StudyModel>> models;
  std::vector<double> nominal;        ///< per variable
  std::vector<InputFile> files;       ///< that the study was read from, without its models
  std::vector<ModelVariant> variants; ///< not empty: the last variable says which, from 1; 0 is the model as it is

  /// Values, responses and limit states: the names that expressions may use, in the order of the numbers.
  [[nodiscard]] std::vector<std::string> variable_names() const;
  [[nodiscard]] std::vector<std::string> number_names() const; ///< responses, then limit states
  [[nodiscard]] std::vector<std::string> number_units() const;
  /// Values of all histories, one after the other.
  [[nodiscard]] std::size_t curve_size() const;
  [[nodiscard]] std::size_t number_count() const { return study.responses.size() + study.limit_states.size(); }
  /// A record that does not hold any more what it held when the study was read; "" if there is none.
  [[nodiscard]] std::string changed_record() const;
  /// Place among the numbers of a response or limit state; −1 if there is none.
  [[nodiscard]] int index_of_number(const std::string& name) const;
};

/// Throws ModelError with all that is wrong.
[[nodiscard]] LoadedStudy read_study(const std::string& path);
/// The same for text at hand.
[[nodiscard]] LoadedStudy parse_study(std::string text, const std::string& file_name);

/// Paths of the model that variable `v` sets in `model`.
[[nodiscard]] bool is_set_in(const Variable& v, const StudyModel& model);

/// Channels that a response looks at.
[[nodiscard]] std::vector<const Channel*> channels_of(const Response& response, const System& system);

} // namespace steplap::study
