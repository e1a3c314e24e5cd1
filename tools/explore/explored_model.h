// A model that is run repeatedly with values that differ from its file.
#pragma once

#include "mbd/io/input_files.h"
#include "mbd/run/report.h"
#include "mbd/system/instance.h"
#include "tools/explore/slider.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace steplap {

/// Numbers of a model by their paths, SI.
using ExploredValues = std::map<std::string, double>;

/// One model file. Not thread-safe.
class ExploredModel {
public:
  /// `overrides`: settings "path=value", applied to the file first. The file is read by read().
  ExploredModel(std::string path, std::vector<std::string> overrides) : path_(std::move(path)), overrides_(std::move(overrides)) {}

  /// Reads the file. Throws ModelError with all errors; the previously read model then remains in use.
  void read();
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::vector<std::string>& overrides() const { return overrides_; }
  /// Returns the sliders of the file, as it was when last read.
  [[nodiscard]] const std::vector<Slider>& sliders() const { return sliders_; }
  /// Returns the title of the model; "" if it has none.
  [[nodiscard]] const std::string& title() const { return title_; }
  /// Returns all files accessed by the last call of read(), even if it failed.
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }
  /// Returns true if a model has been read without errors.
  [[nodiscard]] bool is_read() const { return given_ != nullptr; }

  /// Runs and judges the model with these values, SI. The report contains neither the model's text nor overrides. Throws ModelError if a
  /// path has no slider or a value is invalid, NumericalFailure if the run could not start.
  [[nodiscard]] Report run(const ExploredValues& values, const RunOptions& options);
  /// As run(), but reads the file with these values as overrides, like `steplap simulate`.
  [[nodiscard]] Report run_from_file(const ExploredValues& values, const RunOptions& options) const;
  /// Returns "path=value" for each value. Throws ModelError if a path has no slider or a value is not finite.
  [[nodiscard]] std::vector<std::string> assignments(const ExploredValues& values) const;

private:
  [[nodiscard]] std::shared_ptr<const LoadedModel> loaded_with(const ExploredValues& values);
  [[nodiscard]] std::shared_ptr<const LoadedModel> loaded_from_file(const ExploredValues& values) const;
  [[nodiscard]] const Slider& slider_at(const std::string& path) const;

  std::string path_, title_;
  std::vector<std::string> overrides_, files_;
  std::unique_ptr<const Model> given_;
  std::vector<Slider> sliders_;
  std::map<std::string, std::size_t> by_path_; ///< index in `sliders_` by path
  std::vector<std::string> varied_;            ///< paths for which `variants_` was prepared
  std::unique_ptr<Variants> variants_;
};

} // namespace steplap
