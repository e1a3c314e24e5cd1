// Reads study files (TOML). All errors are reported together, with their locations, before anything runs.
#pragma once

#include "mbd/io/input_files.h"
#include "mbd/io/load_case.h"
#include "mbd/system/system.h"
#include "tools/study/study.h"

#include <functional>
#include <memory>

namespace steplap::study {

/// A model of a study: as given, to which values of variables are applied, and completed and compiled, for checks.
struct StudyModel {
  std::string path, name;             ///< name: file name without extension, or name of the load case
  std::string file_name;              ///< name of the model file, for a load case
  std::optional<LoadCase> load;       ///< the load case, if it is one; the criteria of this case apply
  std::vector<std::string> overrides; ///< "path=value" with which the model was read
  Model given;
  std::string text;             ///< self-contained TOML text of the model with overrides and extensions
  std::vector<InputFile> files; ///< files that were read for the model: the model, extended files, records
  std::unique_ptr<System> system;
  std::vector<double> base; ///< value of each variable's first path in this model; NaN if this model has none
};

/// A structural change of a model, as used by the study kind "needs".
struct ModelVariant {
  std::string name;
  std::function<void(Model&)> apply; ///< changes the model as given
  std::string gone{};                ///< name of the removed element; "" if none
};

/// A study that has been read and checked.
struct LoadedStudy {
  Study study;
  std::vector<std::shared_ptr<const StudyModel>> models;
  std::vector<double> nominal;        ///< nominal value of each variable
  std::vector<InputFile> files;       ///< study file and the files that it extends
  std::vector<ModelVariant> variants; ///< if not empty, the last variable selects the variant, from 1; 0 is the unchanged model

  /// Names that expressions may use: variables, then responses, then limit states.
  [[nodiscard]] std::vector<std::string> variable_names() const;
  [[nodiscard]] std::vector<std::string> number_names() const; ///< responses, then limit states
  [[nodiscard]] std::vector<std::string> number_units() const;
  /// Returns the number of values of all histories.
  [[nodiscard]] std::size_t curve_size() const;
  [[nodiscard]] std::size_t number_count() const { return study.responses.size() + study.limit_states.size(); }
  /// Returns the name of a measured record whose file changed since the study was read; "" if none did.
  [[nodiscard]] std::string changed_record() const;
  /// Returns the index of a response or limit state in the list of both; −1 if there is none.
  [[nodiscard]] int index_of_number(const std::string& name) const;
};

/// Reads a model of a study, with overrides "path=value". Throws ModelError.
[[nodiscard]] std::shared_ptr<StudyModel> read_study_model(const std::string& path, const std::vector<std::string>& overrides = {});
/// Reads a study file. Throws ModelError with all errors.
[[nodiscard]] LoadedStudy read_study(const std::string& path);
/// As read_study(), for a text in memory.
[[nodiscard]] LoadedStudy parse_study(std::string text, const std::string& file_name);

/// Returns true if variable `v` is set in `model`.
[[nodiscard]] bool is_set_in(const Variable& v, const StudyModel& model);

/// Returns the channels to which a response refers.
[[nodiscard]] std::vector<const Channel*> channels_of(const Response& response, const System& system);

} // namespace steplap::study
