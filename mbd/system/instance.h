// Compiles variants of one model that differ in some numbers, for parameter studies.
#pragma once

#include "mbd/system/system.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// Paths (model_path.h) with the numbers to be set, in SI.
using ModelValues = std::vector<std::pair<std::string, double>>;

/// Returns the system of `given` with `values` set. `given` is not changed, and the system keeps no reference to it. Reads no files. Throws
/// ModelError for an invalid path, value or model. Thread-safe.
[[nodiscard]] std::unique_ptr<System> instantiate(const Model& given, const ModelValues& values);

/// Compiles one model for many sets of values. Only those parts of completion and validation are repeated that depend on the varied fields.
/// If only array tables such as [[core]] depend on them, only these are applied again. This is valid because such tables may only add
/// elements, set missing properties of bodies, or add plots, criteria and channels. Owns copies of everything; one object per thread.
class Variants {
public:
  /// `paths` are the numbers that vary; `channels` the channels of the systems, null: all. Throws ModelError for an invalid path or model.
  Variants(const Model& given, std::vector<std::string> paths, const std::vector<std::string>* channels = nullptr);

  /// Returns the same system as instantiate(given, …), byte for byte except for omitted channels. `values` has one number per path, in SI.
  /// Throws ModelError for a value that is out of range or gives an invalid model.
  [[nodiscard]] std::unique_ptr<System> make(const std::vector<double>& values);
  /// Returns the completed model of the last system, for its start values, settings and verdicts.
  [[nodiscard]] const Model& model() const { return completed_; }

private:
  /// Parts of completion that must be repeated for new values: none, the tables, or everything.
  enum class RecompilationScope { nothing, tables, all };
  [[nodiscard]] RecompilationScope recompilation_for(const std::string& path) const;
  [[nodiscard]] bool is_set_by(const std::string& path, const std::string& head) const;
  void note_tables();
  void place_at_centres();
  [[nodiscard]] bool apply_tables();

  Model given_, completed_;
  std::vector<std::string> paths_;
  std::optional<std::vector<std::string>> channels_;
  RecompilationScope recompilation_ = RecompilationScope::nothing;
  // Used for RecompilationScope::tables only:
  std::vector<std::size_t> applied_;                              ///< tables to be applied again: all except plots, criteria and channels
  std::vector<Body> bodies_;                                      ///< bodies before tables were applied
  std::vector<std::size_t> at_centres_;                           ///< indices of the markers at the centres of gravity of their bodies
  std::vector<std::pair<const ElementKind*, std::string>> added_; ///< kinds and names of elements added by tables
};

} // namespace steplap
