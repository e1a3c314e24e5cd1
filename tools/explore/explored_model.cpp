#include "tools/explore/explored_model.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/reader.h"
#include "transformer/program.h"

#include <algorithm>
#include <cmath>

namespace steplap {

void ExploredModel::read() {
  const InputFiles reading;
  const auto note_files = [&] {
    for (const InputFile& file : reading.files())
      if (std::find(files_.begin(), files_.end(), file.path) == files_.end()) files_.push_back(file.path);
  };
  std::unique_ptr<const Model> given;
  try {
    given = std::make_unique<const Model>(read_given_model(path_, program_catalogue(), overrides_));
  } catch (...) {
    note_files(); // watches the files that were read, also after an error
    throw;
  }
  files_.clear();
  note_files();
  given_ = std::move(given);
  title_ = given_->header.title;
  sliders_ = sliders_of(*given_);
  by_path_.clear();
  for (std::size_t i = 0; i < sliders_.size(); ++i) by_path_.emplace(sliders_[i].path, i);
  variants_.reset();
}

const Slider& ExploredModel::slider_at(const std::string& path) const {
  const auto found = by_path_.find(path);
  if (found == by_path_.end()) throw ModelError({path_, 0, 0}, "'" + shown(path) + "' is no number of the model that can be varied");
  return sliders_[found->second];
}

std::vector<std::string> ExploredModel::assignments(const ExploredValues& values) const {
  std::vector<std::string> all;
  for (const auto& [path, value] : values) {
    (void)slider_at(path);
    if (!std::isfinite(value)) throw ModelError({path, 0, 0}, "the value is not finite");
    all.push_back(path + "=" + number_text(value));
  }
  return all;
}

std::shared_ptr<const LoadedModel> ExploredModel::loaded_from_file(const ExploredValues& values) const {
  std::vector<std::string> all = overrides_;
  for (std::string& assignment : assignments(values)) all.push_back(std::move(assignment));
  return load_model(path_, all);
}

// Returns the model with these values. Sets them in the loaded model where possible, because reading a file takes longer than most runs.
std::shared_ptr<const LoadedModel> ExploredModel::loaded_with(const ExploredValues& values) {
  if (!given_) throw ModelError({path_, 0, 0}, "the file has not been read without errors yet");
  std::vector<std::string> paths;
  std::vector<double> numbers;
  bool needs_file = false;
  for (const auto& [path, value] : values) {
    needs_file = needs_file || slider_at(path).needs_file;
    if (!std::isfinite(value)) throw ModelError({path, 0, 0}, "the value is not finite");
    paths.push_back(path);
    numbers.push_back(value);
  }
  if (needs_file) return loaded_from_file(values);
  if (!variants_ || paths != varied_) {
    variants_ = std::make_unique<Variants>(*given_, paths);
    varied_ = std::move(paths);
  }
  std::shared_ptr<const System> system = variants_->make(numbers);
  return load_completed(variants_->model(), std::move(system), path_);
}

Report ExploredModel::run(const ExploredValues& values, const RunOptions& options) { return judged_run(loaded_with(values), options); }

Report ExploredModel::run_from_file(const ExploredValues& values, const RunOptions& options) const {
  return judged_run(loaded_from_file(values), options);
}

} // namespace steplap
