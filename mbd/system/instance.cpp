#include "mbd/system/instance.h"

#include "mbd/model/completion.h"
#include "mbd/model/model_path.h"
#include "mbd/model/placement.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <stdexcept>

namespace steplap {

namespace {

bool starts_with_any(const std::string& path, std::initializer_list<const char*> heads) {
  return std::any_of(heads.begin(), heads.end(), [&](const char* head) { return path.starts_with(head); });
}

bool may_place(const ElementEntry& entry) { return dynamic_cast<const PlacingElement*>(entry.element.get()) != nullptr; }

// Does completion (completion.h) read the field? Markers get places from bodies' centres of gravity, bodies from joints,
// elements from the tables of other rooms, which look at bodies and at what is completed before them; validation compares
// the settings of a run with each other.
bool is_read_by_completion(const Model& given, const std::string& path) {
  const auto any_table = [&](bool TableKind::*reads) {
    return std::any_of(given.tables.begin(), given.tables.end(), [&](const TableEntry& e) { return e.kind->*reads; });
  };
  if (starts_with_any(path, {"signal.", "gravity."})) return false;
  if (path.starts_with("parameters.")) {
    const std::optional<std::size_t> parameter = given.parameters.find(path.substr(std::string("parameters.").size()));
    return std::any_of(given.parameters.uses.begin(), given.parameters.uses.end(), [&](const ParameterUse& use) {
      return parameter && given.parameters.needs(use.formula, *parameter) && is_read_by_completion(given, use.path);
    });
  }
  if (path.starts_with("element.")) {
    const bool is_placing = std::any_of(given.elements.begin(), given.elements.end(), [&](const ElementEntry& e) {
      return may_place(e) && path.starts_with("element." + e.element->name + ".");
    });
    const std::size_t last = path.find_last_not_of("0123456789");
    const bool is_outline = last != std::string::npos && path[last] == '.' && std::isdigit(static_cast<unsigned char>(path[last - 1]));
    return is_placing || is_outline || any_table(&TableKind::reads_elements);
  }
  if (path.starts_with("body.")) {
    const bool is_mass = path.ends_with(".mass") || path.ends_with(".inertia");
    const bool is_rate = path.ends_with(".angular_velocity") || path.ends_with(".velocity.0") || path.ends_with(".velocity.1");
    const bool follows_joints = std::any_of(given.elements.begin(), given.elements.end(), may_place);
    return is_mass ? any_table(&TableKind::reads_masses) : !is_rate || follows_joints;
  }
  return true;
}

} // namespace

std::unique_ptr<System> instantiate(const Model& given, const ModelValues& values) {
  Model model = given;
  for (const auto& [path, value] : values) set_value(model, path, value);
  return compile(completed(model));
}

Variants::Variants(const Model& given, std::vector<std::string> paths, const std::vector<std::string>* channels)
    : given_(given), completed_(completed(given)), paths_(std::move(paths)) {
  if (channels) channels_ = *channels;
  for (const std::string& path : paths_) {
    static_cast<void>(number_of(given_, path)); // it is there, and a number
    if (is_read_by_completion(given_, path)) is_direct_ = false;
  }
}

std::unique_ptr<System> Variants::make(const std::vector<double>& values) {
  if (values.size() != paths_.size())
    throw std::invalid_argument(std::to_string(values.size()) + " values for " + std::to_string(paths_.size()) + " paths of a model");
  Model& model = is_direct_ ? completed_ : given_;
  for (std::size_t i = 0; i < paths_.size(); ++i) set_value(model, paths_[i], values[i]);
  const std::vector<std::string>* const wanted = channels_ ? &*channels_ : nullptr;
  if (!is_direct_) completed_ = completed(given_);
  return compile(completed_, wanted);
}

} // namespace steplap
