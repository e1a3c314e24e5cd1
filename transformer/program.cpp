#include "transformer/program.h"

#include "elements/views/element_views.h"
#include "transformer/catalog.h"
#include "transformer/core/core.h"
#include "transformer/core/core_drawing.h"
#include "transformer/core/core_windows.h"
#include "transformer/core/left_out_of_cores.h"
#include "transformer/core/plausible.h"
#include "transformer/recorder/recorder_signal.h"

#include <utility>

namespace steplap {

namespace {

std::string sheet_of_core(const Element& table, const Model& model) { return core_svg(static_cast<const Core&>(table), model); }

std::vector<Finding> unusual_cores(const Model& model) {
  std::vector<Finding> findings;
  for (CoreRemark& remark : implausible_cores(model))
    findings.push_back({remark.is_note ? "mitre_not_45_degrees" : "unusual_core",
                        remark.is_note ? FindingLevel::note : FindingLevel::warning, std::move(remark.text), std::move(remark.where)});
  return findings;
}

KindViews program_views() {
  KindViews views = element_views();
  views.sheets[&core_kind()] = sheet_of_core;
  views.openings = {core_windows};
  views.left_out = {left_out_of_cores};
  views.value_checks.insert(views.value_checks.begin(), unusual_cores);
  return views;
}

} // namespace

const RunCatalogue& program_catalogue() {
  static const RunCatalogue catalogue = [] {
    RunCatalogue c{transformer_catalog(), std::make_shared<const KindViews>(program_views())};
    c.signals.push_back(&recorder_signal_kind());
    return c;
  }();
  return catalogue;
}

std::shared_ptr<const LoadedModel> load_model(const std::string& path, const std::vector<std::string>& overrides) {
  return load_model(path, overrides, program_catalogue());
}

std::shared_ptr<const LoadedModel> load_model(const std::string& path, const std::vector<std::string>& overrides, const Catalogue& kinds) {
  return load_model(path, overrides, RunCatalogue{kinds, program_catalogue().views});
}

std::shared_ptr<const LoadedModel> load_model_text(const std::string& text, const std::string& path,
                                                   const std::vector<std::string>& overrides) {
  return load_model_text(text, path, overrides, program_catalogue());
}

std::shared_ptr<const LoadedModel> load_given(const Model& given, const std::string& name) {
  return load_given(given, name, program_catalogue().views);
}

std::shared_ptr<const LoadedModel> load_completed(Model completed, std::shared_ptr<const System> system, const std::string& path) {
  return load_completed(std::move(completed), std::move(system), path, program_catalogue().views);
}

std::vector<std::shared_ptr<const LoadedModel>> load_models(const std::vector<std::string>& paths,
                                                            const std::vector<std::string>& overrides) {
  return load_models(paths, overrides, program_catalogue());
}

} // namespace steplap
