#include "mbd/io/reader.h"

#include "mbd/base/shown_text.h"
#include "mbd/io/field_reader.h"
#include "mbd/io/parameters_reader.h"
#include "mbd/io/parts.h"
#include "mbd/io/signal_units.h"
#include "mbd/io/standalone_text.h"
#include "mbd/io/toml_writer.h"
#include "mbd/model/completion.h"
#include "mbd/model/field_units.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

namespace steplap {

namespace {

TopLevelNames top_level_names(const Catalogue& catalogue) {
  TopLevelNames names;
  names.keys = ModelHeader::fields().names();
  names.tables = {"simulation", "output", "parameters"};
  names.arrays = {"part", "body", "marker", "signal", "element"};
  for (const TableKind* kind : catalogue.tables) names.arrays.push_back(kind->name);
  return names;
}

// Applies the overrides and expands parts and repetitions. Overrides of [[part]] entries and of `repeat` are applied before the expansion,
// all others after it.
void settle(Document& document, const std::vector<std::string>& overrides, const TopLevelNames& names, const Catalogue& catalogue) {
  const auto is_of_part = [](const std::string& change) {
    return change.starts_with("part.") || change.substr(0, change.find('=')).ends_with(".repeat");
  };
  for (const std::string& change : overrides)
    if (is_of_part(change)) apply_override(document, change, names);
  write_out_parts(document, catalogue);
  for (const std::string& change : overrides)
    if (!is_of_part(change)) apply_override(document, change, names);
}

Field named_field(const std::string& name) {
  Field field;
  field.name = name;
  return field;
}

template <class Kind> const Kind* find_kind(const std::vector<const Kind*>& kinds, const std::string& name) {
  for (const Kind* kind : kinds)
    if (kind->name == name) return kind;
  return nullptr;
}

bool is_mass(const Field& field) { return field.name == "mass" || field.name == "inertia"; }

// The given fields of an entry of Model::tables, and whether all could be read.
struct TableSource {
  std::vector<GivenField> given;
  bool is_usable = true;
};

// Refuses files of other kinds by a key that a model has not; each of their tables would be an unknown key of its own.
void refuse_other_files(const Document& document) {
  const Node* const kind = document.root.find("kind");
  if (kind && kind->type == Node::Type::text)
    throw ModelError(
        {{kind->where_key(), "this is a study of kind '" + kind->text() +
                                 "', not a model: `steplap study` reads and runs it; check the model that its key 'model' names"}});
  constexpr std::pair<const char*, const char*> k_of_assess[] = {
      {"criterion", "these are criteria of a decision, not a model: `steplap assess` reads them"},
      {"handover", "this is a shipment, not a model: `steplap assess` reads it"}};
  for (const auto& [key, what] : k_of_assess)
    if (const Node* const table = document.root.find(key))
      throw ModelError({{table->where_key(), std::string(what) + " together with a model"}});
}

class Reader {
public:
  Reader(Document document, const Catalogue& catalogue)
      : document_(std::move(document)), catalogue_(catalogue), names_(top_level_names(catalogue)) {}

  /// Returns the completed model. `text`, if not null, receives the text of the document, `as_given` the model before completion.
  Model read(const std::vector<std::string>& overrides, std::string* text = nullptr, Model* as_given = nullptr) {
    refuse_other_files(document_);
    settle(document_, overrides, names_, catalogue_);
    if (text) *text = standalone_text(document_, catalogue_);
    refuse_control_characters(document_);
    problems_ = std::move(document_.problems);
    parameters_.emplace(document_.root, problems_);
    check_part_places();
    read_header();
    read_settings("simulation", Section::simulation, SimulationSettings::fields(), model_.simulation);
    read_settings("output", Section::output, OutputSettings::fields(), model_.output);
    read_bodies();
    read_markers();
    read_signals();
    read_elements();
    read_tables();
    check_signal_units();
    model_.parameters = parameters_->parameters(document_.root, model_);
    model_.files_without_format = document_.files_without_format;
    model_.renamed_keys = std::move(renamed_);
    if (as_given) *as_given = model_;
    complete_model();
    finish();
    return std::move(model_);
  }

private:
  void add(const Location& where, std::string message) { problems_.push_back({where, std::move(message)}); }

  std::vector<std::vector<GivenField>>& given(Section section) { return given_[static_cast<std::size_t>(section)]; }

  void check_part_places();
  void read_header();
  template <class T> void read_settings(const std::string& name, Section section, const FieldTable& fields, T& target);
  const Node* array_named(const std::string& name);
  void excuse_empty_scene();
  void read_bodies();
  void read_markers();
  void read_signals();
  void read_elements();
  void read_tables();
  void check_signal_units();
  std::string read_name(const Node& entry, const std::string& noun, std::vector<GivenField>& given);
  std::string near_inherited(const std::string& array, const Node& entry) const;
  template <class Kind> const Kind* read_kind(const Node& entry, const std::string& noun, const std::vector<const Kind*>& kinds);
  TableReading reading(std::string subject, std::string owner = "");
  std::string add_inline_marker(const Node& table, const Field& field, const std::string& owner);
  void complete_model();
  void report_missing_masses(bool is_certain);
  std::optional<Location> locate(Section section, std::size_t index, const std::string& field);
  std::optional<Location> place_of(const std::vector<GivenField>& fields, const std::string& name, const Location& object) const;
  const Location& where_of(Section section, std::size_t index) const;
  void finish();

  Document document_;
  const Catalogue& catalogue_;
  TopLevelNames names_;
  Model model_;
  std::vector<Diagnostic> problems_;
  std::optional<ParametersReader> parameters_;
  std::vector<RenamedKey> renamed_;
  std::vector<std::vector<GivenField>> given_[7]; // by section and index
  std::vector<TableSource> tables_;               // for model_.tables
  // Names of signals and elements of unknown kind. They are reported once, and references to them are not.
  std::unordered_set<std::string> unread_signals_, unread_elements_;
};

TableReading Reader::reading(std::string subject, std::string owner) {
  TableReading result;
  result.subject = std::move(subject);
  result.parameters = &*parameters_;
  result.renamed = &renamed_;
  result.add_marker = [this, owner = std::move(owner)](const Node& table, const Field& field) {
    return add_inline_marker(table, field, owner);
  };
  return result;
}

// Checks the units of formulas for positions of parts before anything else. Otherwise one error would appear in all fields that are
// computed from the position.
void Reader::check_part_places() {
  const std::size_t before = problems_.size();
  for (const Document::PartPlace& place : document_.part_places) {
    const Quantity quantity = parameters_->value(place.node, place.unit);
    if (!quantity.problem.empty()) add(place.node.where(), place.subject + ": " + quantity.problem);
  }
  if (problems_.size() == before) return;
  name_parts(problems_, document_);
  throw ModelError(std::move(problems_));
}

void Reader::read_header() {
  model_.header.where = {document_.sources->front().file, 0, 0};
  TableReading r = reading("the model");
  r.known_keys = names_.tables;
  r.known_keys.insert(r.known_keys.end(), names_.arrays.begin(), names_.arrays.end());
  given(Section::header) = {read_fields(document_.root, ModelHeader::fields(), &model_.header, r, problems_)};
  if (!document_.root.find("body"))
    for (const Node& child : document_.root.children)
      if (nearest_name(child.key, {"body"}) == "body") excuse_empty_scene(); // reported as an unknown key
}

template <class T> void Reader::read_settings(const std::string& name, Section section, const FieldTable& fields, T& target) {
  target.where = model_.header.where;
  given(section).resize(1);
  const Node* table = document_.root.find(name);
  if (!table) return;
  if (!table->is_table()) {
    for (const Field& field : fields.fields()) given(section)[0].push_back({&field, nullptr, false});
    return add(table->where_key(), "'" + name + "' must be a table, [" + name + "], not " + table->type_name());
  }
  target.where = table->where();
  given(section)[0] = read_fields(*table, fields, &target, reading("[" + name + "]"), problems_);
}

// Prevents the error "no bodies" if another error may be the reason for it.
void Reader::excuse_empty_scene() {
  static const Field body = named_field("body");
  given(Section::header)[0].push_back({&body, nullptr, false});
}

// Returns the array [[name]]; null if there is none, or if it is invalid, which is then reported.
const Node* Reader::array_named(const std::string& name) {
  const Node* array = document_.root.find(name);
  if (!array || array->is_array_of_tables()) return array;
  if (array->type == Node::Type::array && array->children.empty()) return nullptr;
  excuse_empty_scene();
  add(array->where_key(), "'" + name + "' must be an array of tables, each begun by [[" + name + "]], not " + array->type_name());
  return nullptr;
}

void Reader::read_bodies() {
  const Node* array = array_named("body");
  if (!array) return;
  model_.bodies.reserve(array->children.size());
  for (const Node& entry : array->children) {
    Body& body = model_.bodies.emplace_back();
    body.where = entry.where();
    const Node* fixed = entry.find("fixed");
    body.fixed = fixed && fixed->type == Node::Type::boolean && std::get<bool>(fixed->scalar);
    TableReading r = reading(subject_text("body", entry_name(entry)));
    r.is_excused = [](const Field& field) { return is_mass(field); }; // tables may define the mass: see report_missing_masses()
    given(Section::body).push_back(read_fields(entry, Body::fields(), &body, r, problems_));
    for (const GivenField& field : given(Section::body).back())
      if (field.node) body.given |= std::uint32_t{1} << (field.field - Body::fields().fields().data());
  }
}

void Reader::read_markers() {
  const Node* array = array_named("marker");
  if (!array) return;
  for (const Node& entry : array->children) {
    Marker marker;
    marker.where = entry.where();
    const TableReading r = reading(subject_text("marker", entry_name(entry)));
    given(Section::marker).push_back(read_fields(entry, Marker::fields(), &marker, r, problems_));
    model_.markers.push_back(std::move(marker));
  }
}

std::string Reader::add_inline_marker(const Node& table, const Field& field, const std::string& owner) {
  Marker marker;
  marker.where = table.where();
  TableReading r = reading(subject_text("marker", owner + "." + field.name));
  r.is_excused = [](const Field& f) { return f.name == "name"; };
  std::vector<GivenField> fields = read_fields(table, Marker::fields(), &marker, r, problems_);
  if (marker.name.empty()) marker.name = owner + "." + field.name;
  given(Section::marker).push_back(std::move(fields));
  model_.markers.push_back(marker);
  return marker.name;
}

std::string Reader::read_name(const Node& entry, const std::string& noun, std::vector<GivenField>& fields) {
  static const Field name_field = named_field("name");
  const Node* name = entry.find("name");
  if (name && name->type == Node::Type::text) {
    fields.push_back({&name_field, name, true});
    return name->text();
  }
  if (name) add(name->where(), "'name' of " + subject_text(noun, "") + ": expected a string, got " + name->type_name());
  else add(entry.where(), subject_text(noun, "") + " needs 'name' (unique name)");
  fields.push_back({&name_field, name, false});
  return "";
}

// Returns the end of a message on an entry that has no kind, and perhaps is meant to change one of another file, under a misspelt name; ""
// if no entry of another file has a similar name.
std::string Reader::near_inherited(const std::string& array, const Node& entry) const {
  std::vector<std::string> names;
  for (const Node& other : document_.root.find(array)->children)
    if (other.file != entry.file) names.push_back(entry_name(other));
  const std::string near = nearest_name(entry_name(entry), names);
  for (const Node& other : document_.root.find(array)->children)
    if (!near.empty() && other.file != entry.file && entry_name(other) == near)
      return "as nothing of this name is inherited: did you mean '" + near + "' (" + other.where().file + ":" +
             std::to_string(other.where().line) + ")?";
  return "";
}

template <class Kind> const Kind* Reader::read_kind(const Node& entry, const std::string& noun, const std::vector<const Kind*>& kinds) {
  const Node* name = entry.find("kind");
  if (name && name->type == Node::Type::text)
    if (const Kind* kind = find_kind(kinds, name->text())) return kind;
  std::vector<std::string> known;
  std::string list;
  for (const Kind* kind : kinds) {
    known.push_back(kind->name);
    list += (list.empty() ? "'" : ", '") + kind->name + "'";
  }
  const std::string subject = subject_text(noun, entry_name(entry));
  if (!name) {
    const std::string inherited = near_inherited(noun, entry);
    add(entry.where(), subject + " needs 'kind', " + (inherited.empty() ? "one of " + list : inherited));
  } else if (name->type != Node::Type::text) {
    add(name->where(), "'kind' of " + subject + ": expected a string, got " + name->type_name());
  } else {
    std::string hint = did_you_mean(name->text(), known);
    if (hint.empty()) hint = "; known are " + list;
    add(name->where(), subject + " is of the unknown kind '" + name->text() + "'" + hint);
  }
  return nullptr;
}

void Reader::read_signals() {
  const Node* array = array_named("signal");
  if (!array) return;
  for (const Node& entry : array->children) {
    const SignalKind* kind = read_kind(entry, "signal", catalogue_.signals);
    std::vector<GivenField> fields;
    const std::string name = read_name(entry, kind ? kind->name : "signal", fields);
    if (!kind) {
      unread_signals_.insert(name);
      continue;
    }
    const auto definition = kind->create();
    definition->name = name;
    definition->where = entry.where();
    TableReading r = reading(subject_text(kind->name, name), name);
    r.known_keys = {"name", "kind"};
    const auto read = read_fields(entry, kind->fields, definition.get(), r, problems_);
    fields.insert(fields.end(), read.begin(), read.end());
    given(Section::signal).push_back(std::move(fields));
    model_.signals.push_back({kind, definition});
  }
}

void Reader::read_elements() {
  const Node* array = array_named("element");
  if (!array) return;
  model_.elements.reserve(array->children.size());
  given(Section::element).reserve(array->children.size());
  std::vector<std::string> keys_of_all = Element::common_fields().names();
  keys_of_all.insert(keys_of_all.begin(), {"name", "kind"});
  for (const Node& entry : array->children) {
    const ElementKind* kind = read_kind(entry, "element", catalogue_.elements);
    std::vector<GivenField> fields;
    const std::string name = read_name(entry, kind ? kind->name : "element", fields);
    if (!kind) {
      unread_elements_.insert(name);
      continue;
    }
    const auto element = kind->create();
    element->name = name;
    element->where = entry.where();
    TableReading r = reading(subject_text(kind->name, name), name);
    r.known_keys = keys_of_all;
    const auto own = read_fields(entry, kind->fields, element.get(), r, problems_);
    r.knows_all_keys = true; // unknown keys are already reported
    const auto common = read_fields(entry, Element::common_fields(), element.get(), r, problems_);
    fields.reserve(fields.size() + own.size() + common.size()); // they are kept
    fields.insert(fields.end(), own.begin(), own.end());
    fields.insert(fields.end(), common.begin(), common.end());
    given(Section::element).push_back(std::move(fields));
    model_.elements.push_back({kind, element});
  }
}

void Reader::read_tables() {
  for (const TableKind* kind : catalogue_.tables) {
    const Node* array = array_named(kind->name);
    if (!array) continue;
    for (const Node& entry : array->children) {
      TableSource& source = tables_.emplace_back();
      const std::shared_ptr<Element> table = kind->create();
      const std::size_t before = problems_.size();
      table->name = read_name(entry, kind->name, source.given);
      table->where = entry.where();
      TableReading r = reading(subject_text(kind->name, table->name), table->name);
      r.known_keys = {"name"};
      const auto read = read_fields(entry, kind->fields, table.get(), r, problems_);
      source.given.insert(source.given.end(), read.begin(), read.end());
      source.is_usable =
          problems_.size() == before && std::all_of(read.begin(), read.end(), [](const GivenField& g) { return g.is_usable; });
      if (auto* object = dynamic_cast<TableObject*>(table.get()))
        for (const GivenField& field : source.given)
          if (field.node) object->places[field.field->name] = field.node->where();
      model_.tables.emplace_back(kind, table);
    }
  }
}

// Checks that the signals of elements have fitting units: "0.5 gravity" is not a force, "20 deg" not a displacement.
void Reader::check_signal_units() {
  SignalUnits units(model_, *parameters_);
  for (std::size_t i = 0; i < model_.signals.size(); ++i) units.enter(model_.signals[i], given(Section::signal)[i]);
  const auto check = [&](const std::vector<GivenField>& fields, const FieldTable& table, const void* object, const std::string& subject) {
    for (const GivenField& field : fields) {
      if (!field.node || !field.is_usable || field.field->type != FieldType::signal) continue;
      const std::string misfit = units.misfit(field.node->text(), unit_in(table, *field.field, object)); // without a unit it is a factor
      if (!misfit.empty()) add(field.node->where(), "'" + field.field->name + "' of " + subject + ": " + misfit);
    }
  };
  for (std::size_t i = 0; i < model_.elements.size(); ++i) {
    const ElementEntry& entry = model_.elements[i];
    check(given(Section::element)[i], entry.kind->fields, entry.element.get(), subject_text(entry.kind->name, entry.element->name));
  }
  for (std::size_t i = 0; i < model_.tables.size(); ++i) {
    const TableEntry& entry = model_.tables[i];
    check(tables_[i].given, entry.kind->fields, entry.table.get(), subject_text(entry.kind->name, entry.table->name));
  }
}

void Reader::complete_model() {
  ModelPlaces places;
  places.given = [this](std::size_t body, const std::string& name) -> std::optional<Location> {
    if (body >= given(Section::body).size()) return std::nullopt;
    for (const GivenField& field : given(Section::body)[body])
      if (field.field->name == name && field.node) return field.node->where();
    return std::nullopt;
  };
  places.locate = [this](Section section, std::size_t index, const std::string& field) { return locate(section, index, field); };
  places.locate_in_table = [this](std::size_t table, const std::string& field) {
    return place_of(tables_[table].given, field, model_.tables[table].table->where);
  };
  places.is_table_usable = [this](std::size_t table) { return tables_[table].is_usable; };
  const std::size_t before = problems_.size();
  if (!complete(model_, places, problems_)) excuse_empty_scene();
  // A table that could not be applied might have set the masses. Then its own errors are reported instead of missing masses.
  const bool are_tables_usable = std::all_of(tables_.begin(), tables_.end(), [](const TableSource& t) { return t.is_usable; });
  report_missing_masses(model_.tables.empty() || (are_tables_usable && problems_.size() == before));
}

void Reader::report_missing_masses(bool is_certain) {
  const std::size_t count =
      std::min(model_.bodies.size(), given(Section::body).size()); // further bodies are made by tables, with their masses
  for (std::size_t i = 0; i < count; ++i)
    for (const Field& field : Body::fields().fields()) {
      const Body& body = model_.bodies[i];
      if (!is_mass(field) || is_excused(body, field) || std::get<double>(field.get(&body)) != 0.0) continue;
      std::vector<GivenField>& given_fields = given(Section::body)[i];
      if (std::any_of(given_fields.begin(), given_fields.end(), [&](const GivenField& g) { return g.field->name == field.name; })) continue;
      given_fields.push_back({&field, nullptr, false});
      if (is_certain) add(body.where, missing_field_message(field, subject_text("body", body.name)));
    }
}

// Returns the location of a field, or of the object if the field is not given. Returns nothing if an error of the field was reported.
std::optional<Location> Reader::place_of(const std::vector<GivenField>& fields, const std::string& name, const Location& object) const {
  for (const GivenField& given : fields) {
    if (given.field->name != name) continue;
    const auto is_unread_signal = [this](const Node& node) { return unread_signals_.count(node.text()) > 0; };
    const bool refers_to_unread =
        given.node && ((given.field->type == FieldType::signal && is_unread_signal(*given.node)) ||
                       (given.field->type == FieldType::signals &&
                        std::any_of(given.node->children.begin(), given.node->children.end(), is_unread_signal)) ||
                       (given.field->type == FieldType::element && unread_elements_.count(given.node->text()) > 0));
    if (!given.is_usable || refers_to_unread) return std::nullopt;
    return given.node->where();
  }
  return object;
}

const Location& Reader::where_of(Section section, std::size_t index) const {
  switch (section) {
  case Section::header: break;
  case Section::simulation: return model_.simulation.where;
  case Section::output: return model_.output.where;
  case Section::body: return model_.bodies[index].where;
  case Section::marker: return model_.markers[index].where;
  case Section::signal: return model_.signals[index].definition->where;
  case Section::element: return model_.elements[index].element->where;
  }
  return model_.header.where;
}

std::optional<Location> Reader::locate(Section section, std::size_t index, const std::string& field) {
  const auto& objects = given(section);
  static const std::vector<GivenField> none;
  return place_of(index < objects.size() ? objects[index] : none, field, where_of(section, index));
}

// Validates the model and throws all problems, in the order of files, lines and columns.
void Reader::finish() {
  constexpr std::size_t k_most_reported = 50;
  const auto found =
      validate(model_, [this](Section section, std::size_t index, const std::string& field) { return locate(section, index, field); });
  problems_.insert(problems_.end(), found.begin(), found.end());
  if (problems_.empty()) return;
  name_parts(problems_, document_);
  std::map<std::string, std::size_t> order;
  for (const Document::Source& source : *document_.sources) order.emplace(source.file, order.size());
  const auto key = [&](const Diagnostic& d) {
    const auto file = order.find(d.where.file);
    return std::tuple(file == order.end() ? order.size() : file->second, d.where.line, d.where.column);
  };
  std::stable_sort(problems_.begin(), problems_.end(), [&](const Diagnostic& a, const Diagnostic& b) { return key(a) < key(b); });
  if (problems_.size() > k_most_reported) {
    const std::size_t rest = problems_.size() - k_most_reported;
    problems_.resize(k_most_reported);
    add(model_.header.where, "and " + counted(rest, "more error", "more errors"));
  }
  throw ModelError(std::move(problems_));
}

} // namespace

Model read_model(const std::string& path, const Catalogue& catalogue, const std::vector<std::string>& overrides, std::string* text) {
  return Reader(load_document(path), catalogue).read(overrides, text);
}

Model read_given_model(const std::string& path, const Catalogue& catalogue, const std::vector<std::string>& overrides) {
  Model given;
  (void)Reader(load_document(path), catalogue).read(overrides, nullptr, &given);
  return given;
}

std::string effective_model_text(const std::string& path, const Catalogue& catalogue, const std::vector<std::string>& overrides) {
  Document document = load_document(path);
  settle(document, overrides, top_level_names(catalogue), catalogue);
  if (!document.problems.empty()) throw ModelError(std::move(document.problems));
  return write_toml(document.root);
}

Model parse_model(std::string text, const std::string& file_name, const Catalogue& catalogue, const std::vector<std::string>& overrides) {
  return Reader(parse_document(std::move(text), file_name), catalogue).read(overrides);
}

Model parse_model_text(std::string text, const std::string& file_name, const Catalogue& catalogue,
                       const std::vector<std::string>& overrides, std::string& standalone) {
  return Reader(parse_document(std::move(text), file_name), catalogue).read(overrides, &standalone);
}

Model parse_given_model(std::string text, const std::string& file_name, const Catalogue& catalogue,
                        const std::vector<std::string>& overrides) {
  Model given;
  (void)Reader(parse_document(std::move(text), file_name), catalogue).read(overrides, nullptr, &given);
  return given;
}

} // namespace steplap
