// Determines whether two versions of a study give the same samples.
#include "mbd/base/number_text.h"
#include "mbd/run/version.h"
#include "tools/study/store.h"

#include <filesystem>

namespace steplap::study {

namespace {

// Records are identified by their contents, not by their location.
std::string records_text(const std::vector<InputFile>& files) {
  std::string text;
  for (const InputFile& file : files)
    if (file.is_record) text += "# record " + std::filesystem::path(file.path).filename().string() + " " + file.sha256 + "\n";
  return text;
}

} // namespace

StoreIdentity identity_of(const LoadedStudy& loaded) {
  const Study& study = loaded.study;
  StoreIdentity identity;
  identity.version = k_version;
  identity.study = study.text + records_text(loaded.files);
  identity.kind = study.kind;
  identity.variables = loaded.variable_names();
  identity.numbers = loaded.number_names();
  std::string& scene = identity.scene;
  for (const auto& m : loaded.models) scene += "# model " + m->name + "\n" + m->text + "\n" + records_text(m->files);
  for (const Variable& v : study.variables) {
    scene += "# variable " + v.name + (v.is_factor ? " factor" : "") + " " + v.model;
    for (const std::string& path : v.paths) scene += " | " + path;
    scene += "\n";
  }
  for (const ModelVariant& v : loaded.variants) scene += "# variant " + v.name + "\n";
  for (const Response& r : study.responses) {
    scene += "# response " + r.name + " | " + r.model + " | " + r.channel + " | " + r.what + " | " + r.event + " | " + r.element + " | " +
             r.expression;
    if (r.otherwise) scene += " | " + number_text(*r.otherwise);
    scene += "\n";
  }
  for (const LimitState& l : study.limit_states) scene += "# limit state " + l.name + " | " + l.expression + "\n";
  identity.has_curves = !study.histories.empty();
  for (const History& h : study.histories) {
    scene += "# history " + h.name + " | " + h.model + " | " + h.channel + (h.noise ? " | " + number_text(*h.noise) : "") + "\n";
    for (std::size_t i = 0; i < h.t.size(); ++i) scene += number_text(h.t[i]) + " " + number_text(h.measured[i]) + "\n";
  }
  identity.files = loaded.files;
  for (const auto& m : loaded.models) identity.files.insert(identity.files.end(), m->files.begin(), m->files.end());
  return identity;
}

} // namespace steplap::study
