#include "mbd/model/completion.h"

#include "mbd/model/body_builder.h"

#include <set>
#include <string>
#include <utility>

namespace steplap {

namespace {

// For each element or table that names a body where a marker is needed, adds a marker with the body's name. Its position, the centre of
// gravity, is set by place_at_centres().
void add_body_markers(Model& model) {
  std::unordered_map<std::string, const Body*> bodies{{"ground", nullptr}};
  for (const Body& body : model.bodies) bodies.emplace(body.name, &body);
  std::unordered_set<std::string> known;
  for (const Marker& marker : model.markers) known.insert(marker.name);
  const auto add_for = [&](const FieldTable& table, const void* object) {
    for (const Field& field : table.fields()) {
      if (field.type != FieldType::marker) continue;
      const std::string name = std::get<std::string>(field.get(object));
      const auto body = bodies.find(name);
      if (body == bodies.end() || !known.insert(name).second) continue;
      Marker& marker = model.markers.emplace_back();
      marker.name = marker.body = name;
      if (body->second) marker.where = body->second->where;
    }
  };
  for (const ElementEntry& entry : model.elements) add_for(entry.kind->fields, entry.element.get());
  for (const TableEntry& entry : model.tables) add_for(entry.kind->fields, entry.table.get());
}

// Returns the indices of the markers without a position, which are placed at the centre of gravity of their body.
std::vector<std::size_t> unplaced_markers(const Model& model) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < model.markers.size(); ++i)
    if (!model.markers[i].point && !model.markers[i].at) found.push_back(i);
  return found;
}

void place_at_centres(Model& model, const std::vector<std::size_t>& markers) {
  std::unordered_map<std::string, const Body*> bodies;
  for (const Body& body : model.bodies) bodies.emplace(body.name, &body);
  for (const std::size_t i : markers) {
    Marker& marker = model.markers[i];
    const auto body = bodies.find(marker.body);
    marker.point = body == bodies.end() ? Vec2(Vec2::Zero()) : body->second->cg;
  }
}

// Names of the tables of each kind. They must be unique, since messages, overrides and studies refer to tables by name.
using KnownTables = std::set<std::pair<const TableKind*, std::string>>;

// Returns true if the table could be read, its fields are within their ranges, and its name is unique in its kind.
bool is_sound(const Model& model, std::size_t table, const ModelPlaces& places, KnownTables& known, std::vector<Diagnostic>& problems) {
  const TableEntry& entry = model.tables[table];
  const std::size_t before = problems.size();
  if (!known.emplace(entry.kind, entry.table->name).second) {
    const auto* const object = dynamic_cast<const TableObject*>(entry.table.get());
    problems.push_back({object ? object->place("name") : entry.table->where,
                        entry.kind->name + " named '" + entry.table->name + "' exists already: choose another name"});
  }
  FieldChecker(model, problems)
      .check(entry.kind->fields, entry.table.get(), subject_text(entry.kind->name, entry.table->name), [&](const std::string& field) {
        return places.locate_in_table ? places.locate_in_table(table, field) : std::optional(entry.table->where);
      });
  return problems.size() == before && (!places.is_table_usable || places.is_table_usable(table));
}

// Applies the tables that add bodies (`are_builders`), or all others. Tables with bodies must be applied before references to bodies are
// resolved, all others after the bodies have poses. Returns false if a table is invalid or a builder failed.
bool apply_tables(Model& model, bool are_builders, const ModelPlaces& places, std::vector<Diagnostic>& problems) {
  bool is_every_one = true;
  KnownTables known;
  for (std::size_t i = 0; i < model.tables.size(); ++i) {
    const TableEntry& entry = model.tables[i];
    const BodyBuilder* const builder = body_builder(entry);
    if ((builder != nullptr) != are_builders) continue;
    if (!is_sound(model, i, places, known, problems)) {
      is_every_one = false;
      continue;
    }
    try {
      if (builder) builder->add_bodies(model);
      else entry.kind->apply(*entry.table, model);
    } catch (const ModelError& error) {
      problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
      if (builder) is_every_one = false; // its bodies are missing
    }
  }
  return is_every_one;
}

// Returns a function that tells whether a field of a body was given: in the file, or by code as a value that differs from the default.
GivenBodyField given_in_model(const Model& model) {
  return [&model](std::size_t index, const std::string& name) -> std::optional<Location> {
    const Field* const field = Body::fields().find(name);
    if (!field) return std::nullopt;
    const Body &body = model.bodies[index], usual;
    const bool is_in_file = (body.given >> (field - Body::fields().fields().data()) & 1U) != 0;
    if (!is_in_file && field->get(&body) == field->get(&usual)) return std::nullopt;
    return body.where;
  };
}

FieldLocator own_places(const Model& model) {
  return [&model](Section section, std::size_t index, const std::string&) -> std::optional<Location> {
    switch (section) {
    case Section::header: return model.header.where;
    case Section::simulation: return model.simulation.where;
    case Section::output: return model.output.where;
    case Section::body: return model.bodies[index].where;
    case Section::marker: return model.markers[index].where;
    case Section::signal: return model.signals[index].definition->where;
    case Section::element: return model.elements[index].element->where;
    }
    return std::nullopt;
  };
}

} // namespace

bool complete(Model& model, const ModelPlaces& places, std::vector<Diagnostic>& problems) {
  if (model.is_completed) throw std::logic_error("a model is completed twice: it would have all that its tables stand for twice");
  const bool is_every_body_there = apply_tables(model, true, places, problems);
  add_body_markers(model);
  const std::vector<std::size_t> at_centres = unplaced_markers(model);
  place_at_centres(model, at_centres);
  place_by_joints(model, places.given ? places.given : given_in_model(model), places.locate ? places.locate : own_places(model), problems);
  const bool is_every_table_applied = apply_tables(model, false, places, problems);
  place_at_centres(model, at_centres); // tables may have changed the centre of gravity
  model.is_completed = true;
  return is_every_body_there && is_every_table_applied;
}

Model completed(const Model& given) {
  Model model = given;
  std::vector<Diagnostic> problems;
  complete(model, {}, problems);
  const std::vector<Diagnostic> found = validate(model);
  problems.insert(problems.end(), found.begin(), found.end());
  if (!problems.empty()) throw ModelError(std::move(problems));
  return model;
}

} // namespace steplap
