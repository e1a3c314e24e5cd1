#include "mbd/system/instance.h"

#include "mbd/model/body_builder.h"
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

bool is_same(const FieldTable& fields, const void* a, const void* b) {
  return std::all_of(fields.fields().begin(), fields.fields().end(), [&](const Field& field) { return field.get(a) == field.get(b); });
}

bool is_in_range(const ElementEntry& entry) {
  const std::vector<Field>& fields = entry.kind->fields.fields();
  return std::all_of(fields.begin(), fields.end(), [&](const Field& field) { return is_in_range(field, entry.element.get()); });
}

bool is_in_range(const Body& body) {
  const std::vector<Field>& fields = Body::fields().fields();
  return std::all_of(fields.begin(), fields.end(),
                     [&](const Field& field) { return is_excused(body, field) || is_in_range(field, &body); });
}

} // namespace

std::unique_ptr<System> instantiate(const Model& given, const ModelValues& values) {
  Model model = given;
  for (const auto& [path, value] : values) set_value(model, path, value);
  return compile(completed(model));
}

// Returns which parts of completion (completion.h) read the field at `path`. Markers depend on centres of gravity, poses of bodies on
// joints. Elements from tables such as [[core]] depend on bodies and on everything completed before them. The settings of a run are
// validated against each other.
Variants::RecompilationScope Variants::recompilation_for(const std::string& path) const {
  const auto if_any_table = [&](bool TableKind::*reads) {
    const bool is_any = std::any_of(given_.tables.begin(), given_.tables.end(), [&](const TableEntry& e) { return e.kind->*reads; });
    return is_any ? RecompilationScope::tables : RecompilationScope::nothing;
  };
  if (starts_with_any(path, {"signal.", "gravity."})) return RecompilationScope::nothing;
  if (path.starts_with("parameters.")) {
    const std::optional<std::size_t> parameter = given_.parameters.find(path.substr(std::string("parameters.").size()));
    RecompilationScope redone = RecompilationScope::nothing;
    for (const ParameterUse& use : given_.parameters.uses)
      if (parameter && given_.parameters.needs(use.formula, *parameter)) redone = std::max(redone, recompilation_for(use.path));
    return redone;
  }
  if (path.starts_with("element.")) {
    const bool is_placing = std::any_of(given_.elements.begin(), given_.elements.end(), [&](const ElementEntry& e) {
      return may_place(e) && path.starts_with("element." + e.element->name + ".");
    });
    const std::size_t last = path.find_last_not_of("0123456789");
    const bool is_outline = last != std::string::npos && path[last] == '.' && std::isdigit(static_cast<unsigned char>(path[last - 1]));
    if (is_placing) return RecompilationScope::all;
    return is_outline ? RecompilationScope::tables : if_any_table(&TableKind::reads_elements);
  }
  if (path.starts_with("body.")) {
    const bool is_mass = path.ends_with(".mass") || path.ends_with(".inertia");
    const bool is_rate = path.ends_with(".angular_velocity") || path.ends_with(".velocity.0") || path.ends_with(".velocity.1");
    if (is_mass) return if_any_table(&TableKind::reads_masses);
    if (std::any_of(given_.elements.begin(), given_.elements.end(), may_place)) return RecompilationScope::all;
    return is_rate ? RecompilationScope::nothing : RecompilationScope::tables;
  }
  const auto leads_to = [&](const TableEntry& e) { return path.starts_with(e.kind->name + "."); };
  return std::any_of(given_.tables.begin(), given_.tables.end(), leads_to) ? RecompilationScope::tables : RecompilationScope::all;
}

Variants::Variants(const Model& given, std::vector<std::string> paths, const std::vector<std::string>* channels)
    : given_(given), completed_(completed(given)), paths_(std::move(paths)) {
  if (channels) channels_ = *channels;
  for (const std::string& path : paths_) {
    static_cast<void>(number_of(given_, path)); // throws unless the path leads to a number
    recompilation_ = std::max(recompilation_, recompilation_for(path));
  }
  const bool is_any_builder =
      std::any_of(given_.tables.begin(), given_.tables.end(), [](const TableEntry& e) { return body_builder(e) != nullptr; });
  // Bodies and markers that tables add cannot be replaced alone, so everything is completed again.
  if (recompilation_ == RecompilationScope::tables && is_any_builder) recompilation_ = RecompilationScope::all;
  if (recompilation_ == RecompilationScope::tables) note_tables();
}

// Returns true if the path begins with `head`, or names a parameter on which a field whose path begins with `head` depends.
bool Variants::is_set_by(const std::string& path, const std::string& head) const {
  if (path.starts_with(head)) return true;
  if (!path.starts_with("parameters.")) return false;
  const std::optional<std::size_t> parameter = given_.parameters.find(path.substr(std::string("parameters.").size()));
  return std::any_of(given_.parameters.uses.begin(), given_.parameters.uses.end(), [&](const ParameterUse& use) {
    return use.path.starts_with(head) && parameter && given_.parameters.needs(use.formula, *parameter);
  });
}

void Variants::note_tables() {
  const std::size_t count = given_.elements.size();
  for (std::size_t i = 0; i < count; ++i)
    if (!is_same(given_.elements[i].kind->fields, given_.elements[i].element.get(), completed_.elements[i].element.get()))
      recompilation_ = RecompilationScope::all;
  Model without = given_;
  without.tables.clear();
  std::vector<Diagnostic> problems; // none, since completed() has reported them
  complete(without, {}, problems);
  bodies_ = without.bodies;
  without.tables = given_.tables; // tables may read each other
  for (std::size_t i = 0; i < given_.tables.size(); ++i) {
    const auto count_others = [&] { return without.plots.size() + without.criteria.size() + without.channels.size(); };
    const std::size_t before = count_others();
    const TableEntry& entry = given_.tables[i];
    entry.kind->apply(*entry.table, without);
    if (count_others() == before) applied_.push_back(i);
    else if (std::any_of(paths_.begin(), paths_.end(), [&](const std::string& path) { return is_set_by(path, entry.kind->name + "."); }))
      recompilation_ = RecompilationScope::all;
  }
  for (std::size_t i = 0; i < completed_.markers.size(); ++i) // markers made for bodies come after the given ones
    if (i >= given_.markers.size() || (!given_.markers[i].point && !given_.markers[i].at)) at_centres_.push_back(i);
  for (std::size_t i = count; i < completed_.elements.size(); ++i)
    added_.emplace_back(completed_.elements[i].kind, completed_.elements[i].element->name);
}

void Variants::place_at_centres() {
  for (const std::size_t i : at_centres_) {
    Marker& marker = completed_.markers[i];
    const Body* const body = completed_.find_body(marker.body);
    marker.point = body ? body->cg : Vec2(Vec2::Zero());
  }
}

// Applies the tables to the completed model again. Returns false if an error occurs, if elements differ from those added before, or if a
// value is out of range; then everything must be completed again.
bool Variants::apply_tables() {
  place_at_centres();
  try {
    for (const std::size_t i : applied_) completed_.tables[i].kind->apply(*completed_.tables[i].table, completed_);
  } catch (const ModelError&) {
    return false;
  }
  place_at_centres();
  const auto first = completed_.elements.begin() + static_cast<std::ptrdiff_t>(given_.elements.size());
  const auto is_known = [](const ElementEntry& e, const auto& known) { return e.kind == known.first && e.element->name == known.second; };
  return std::equal(first, completed_.elements.end(), added_.begin(), added_.end(), is_known) &&
         std::all_of(first, completed_.elements.end(), [](const ElementEntry& e) { return is_in_range(e); }) &&
         std::all_of(completed_.bodies.begin(), completed_.bodies.end(), [](const Body& body) { return is_in_range(body); });
}

std::unique_ptr<System> Variants::make(const std::vector<double>& values) {
  if (values.size() != paths_.size())
    throw std::invalid_argument(std::to_string(values.size()) + " values for " + std::to_string(paths_.size()) + " paths of a model");
  const auto set_all = [&](Model& model) {
    for (std::size_t i = 0; i < paths_.size(); ++i) set_value(model, paths_[i], values[i]);
  };
  bool is_completed = recompilation_ != RecompilationScope::all;
  if (recompilation_ == RecompilationScope::tables) {
    completed_.elements.erase(completed_.elements.begin() + static_cast<std::ptrdiff_t>(given_.elements.size()), completed_.elements.end());
    completed_.bodies = bodies_;
  }
  if (is_completed) set_all(completed_);
  if (recompilation_ == RecompilationScope::tables) is_completed = apply_tables();
  if (!is_completed) {
    set_all(given_);
    completed_ = completed(given_);
  }
  return compile(completed_, channels_ ? &*channels_ : nullptr);
}

} // namespace steplap
