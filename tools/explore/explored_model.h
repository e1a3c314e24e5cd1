// A model that is run again and again with other values than its file gives.
#pragma once

#include "mbd/io/input_files.h"
#include "mbd/system/instance.h"
#include "run/report.h"
#include "tools/explore/slider.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace steplap {

/// Numbers of a model by their paths, SI.
using ExploredValues = std::map<std::string, double>;

/// One model file. Not for several threads at a time.
class ExploredModel {
public:
  /// `overrides`: "path=value", laid over the file whatever else is varied. Reads nothing yet.
  ExploredModel(std::string path, std::vector<std::string> overrides) : path_(std::move(path)), overrides_(std::move(overrides)) {}

  /// Reads the file. Throws ModelError with all that is wrong with it; then what was read before stays in use.
  void read();
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::vector<std::string>& overrides() const { return overrides_; }
  /// Of the file as it was read last.
  [[nodiscard]] const std::vector<Slider>& sliders() const { return sliders_; }
  /// Title of the model, "" without one.
  [[nodiscard]] const std::string& title() const { return title_; }
  /// All files that the last reading looked at, also one that failed.
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }
  /// Is there a model that was read without errors?
  [[nodiscard]] bool is_read() const { return given_ != nullptr; }

  /// The judged run of the model with these values. Its model has no text and no overrides. Throws ModelError for a path that is no
  /// slider's and for values that make no model, NumericalFailure if nothing could be run.
  [[nodiscard]] Report run(const ExploredValues& values, const RunOptions& options);
  /// The same by way of the file, as `steplap simulate` makes it with these values as overrides.
  [[nodiscard]] Report run_from_file(const ExploredValues& values, const RunOptions& options) const;
  /// "path=value" for each of the values. Throws ModelError for a path that is no slider's, and for a value that is not finite.
  [[nodiscard]] std::vector<std::string> assignments(const ExploredValues& values) const;

private:
  [[nodiscard]] std::shared_ptr<const LoadedModel> loaded_with(const ExploredValues& values);
  [[nodiscard]] std::shared_ptr<const LoadedModel> loaded_from_file(const ExploredValues& values) const;
  [[nodiscard]] const Slider& slider_at(const std::string& path) const;

  std::string path_, title_;
  std::vector<std::string> overrides_, files_;
  std::unique_ptr<const Model> given_;
  std::vector<Slider> sliders_;
  std::map<std::string, std::size_t> by_path_; ///< of the sliders
  std::vector<std::string> varied_;            ///< paths that `variants_` were prepared for
  std::unique_ptr<Variants> variants_;
};

} // namespace steplap
