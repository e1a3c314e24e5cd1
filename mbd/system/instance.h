// One model, many values: systems of a model as given, with some of its numbers changed.
#pragma once

#include "mbd/system/system.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// A path (model_path.h) and the number it is to have, in SI.
using ModelValues = std::vector<std::pair<std::string, double>>;

/// A system of `given` with `values`, which does not refer to the model; `given` stays as it is. Reads no text and no
/// file. Throws ModelError for what is wrong with a path, a value or the model. May be called from several threads.
[[nodiscard]] std::unique_ptr<System> instantiate(const Model& given, const ModelValues& values);

/// The same model with other values many times: completion and validation are done once where they do not hang on the values, and of what tables
/// stand for ([[core]]) no more than that where only tables hang on them: kinds of tables add elements and give bodies what they lack, or add what is
/// shown and judged, and change nothing else. Refers to nothing but its own copies; one object per thread.
class Variants {
public:
  /// `given` as in instantiate(); `paths` of the numbers that vary; `channels`: those that its systems have, null: all.
  /// Throws ModelError for what is wrong with a path or the model.
  Variants(const Model& given, std::vector<std::string> paths, const std::vector<std::string>* channels = nullptr);

  /// The system that instantiate(given, …) gives, byte for byte but for the channels left out. `values`: one per path, in SI.
  /// Throws ModelError for a value that is out of range, or makes no model with the others.
  [[nodiscard]] std::unique_ptr<System> make(const std::vector<double>& values);
  /// The completed model of the system made last: what starts, options and verdicts are read from.
  [[nodiscard]] const Model& model() const { return completed_; }

private:
  /// What has to be done anew for other values.
  enum class Redone { nothing, tables, all };
  [[nodiscard]] Redone redone_for(const std::string& path) const;
  [[nodiscard]] bool is_set_by(const std::string& path, const std::string& head) const;
  void note_tables();
  void place_at_centres();
  [[nodiscard]] bool apply_tables();

  Model given_, completed_;
  std::vector<std::string> paths_;
  std::optional<std::vector<std::string>> channels_;
  Redone redone_ = Redone::nothing;
  // Where tables are applied anew:
  std::vector<std::size_t> applied_;    ///< tables but those of plots, criteria and channels, which are as they were
  std::vector<Body> bodies_;            ///< without what tables give them
  std::vector<std::size_t> at_centres_; ///< markers that lie at their bodies' centres of gravity
  std::vector<std::pair<const ElementKind*, std::string>> added_; ///< kinds and names of elements that tables have added
};

} // namespace steplap
