// Loads models with all kinds of elements, tables and signals of the programs. Programs that use the library may instead pass a catalogue
// of their own to the functions of mbd/run/loaded_model.h.
#pragma once

#include "mbd/run/loaded_model.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap {

/// Returns the catalogue of all kinds of elements, tables and signals. It is created at first use and lives until the program ends.
[[nodiscard]] const RunCatalogue& program_catalogue();

// Functions of the same names as in mbd/run/loaded_model.h, with the kinds of program_catalogue(). Errors are thrown as described there.

/// Reads and compiles a model file.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_model(const std::string& path, const std::vector<std::string>& overrides = {});
/// Reads and compiles a model file with other kinds, such as transformer_catalog() and kinds of your own. Kinds unknown to
/// program_catalogue() are drawn by their markers.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_model(const std::string& path, const std::vector<std::string>& overrides,
                                                            const Catalogue& kinds);
/// Reads and compiles a model from its text. `path` is its name in messages.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_model_text(const std::string& text, const std::string& path,
                                                                 const std::vector<std::string>& overrides = {});
/// Completes, checks and compiles a model built in code.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_given(const Model& given, const std::string& name);
/// Wraps a model that has already been completed and compiled.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_completed(Model completed, std::shared_ptr<const System> system,
                                                                const std::string& path);
/// Loads several models. Throws one ModelError with the errors of all.
[[nodiscard]] std::vector<std::shared_ptr<const LoadedModel>> load_models(const std::vector<std::string>& paths,
                                                                          const std::vector<std::string>& overrides = {});

} // namespace steplap
