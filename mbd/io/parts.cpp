#include "mbd/io/parts.h"

#include "mbd/formula/unit_dimension.h"
#include "mbd/io/parameters_reader.h"
#include "mbd/io/part_entries.h"
#include "mbd/io/presentation.h"
#include "mbd/io/repetition.h"
#include "mbd/io/standalone_text.h"
#include "mbd/io/units.h"
#include "mbd/model/formula_fields.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace steplap {

namespace {

constexpr std::size_t k_deepest = 32; // nested parts; deeper nesting is an error

// Entry of an including file whose name refers to an entry of a part. It is merged into that entry.
struct Overlay {
  std::string array;
  Node entry;
};

// File of a part or of the model, after expansion of its repetitions.
struct PartFile {
  Node root;
  const std::string* name = nullptr;
  std::vector<Overlay> overlays; // removed from root
};

// Removes the entries of `root` that change entries of its parts, and returns them.
std::vector<Overlay> taken_overlays(Node& root) {
  std::vector<Overlay> overlays;
  const Node* const parts = root.find("part");
  if (!parts || !parts->is_array_of_tables()) return overlays;
  std::unordered_set<std::string> names;
  for (const Node& part : parts->children) names.insert(entry_name(part));
  const auto is_in_part = [&](const std::string& name) {
    for (std::size_t at = name.find('.'); at != std::string::npos; at = name.find('.', at + 1))
      if (names.count(name.substr(0, at)) > 0) return true;
    return false;
  };
  for (Node& array : root.children) {
    if (!array.is_array_of_tables() || array.key == "part") continue;
    std::vector<Node> kept;
    for (Node& entry : array.children)
      if (is_in_part(entry_name(entry))) overlays.push_back({array.key, std::move(entry)});
      else kept.push_back(std::move(entry));
    array.children = std::move(kept);
  }
  return overlays;
}

class PartWriter {
public:
  PartWriter(Document& document, const Catalogue& catalogue)
      : document_(document), problems_(document.problems), entries_(catalogue, problems_) {}

  void write_out() {
    write_out_repetitions(document_.root, made_, problems_);
    PartPlacement model;
    model.file = document_.root.file;
    files_on_the_way_.push_back(identity_of(*model.file));
    entries_.note_placing_joints(document_.root, model);
    const std::vector<Overlay> overlays = taken_overlays(document_.root);
    take_parts(taken_parts(document_.root), model);
    lay_over_parts(overlays, document_.root, model);
    if (!problems_.empty()) return; // the caller reports them together with earlier ones
    for (Node& array : added_) append(std::move(array));
    document_.root.erase("part");
  }

private:
  void add(const Location& where, std::string message) {
    if (reported_.insert(where.file + ":" + std::to_string(where.line) + ":" + std::to_string(where.column) + message).second)
      problems_.push_back({where, std::move(message)});
  }

  void add_too_many(const Node& at) {
    if (is_too_many_) return;
    is_too_many_ = true;
    add(at.where(), "parts and repetitions make more than " + std::to_string(k_most_entries) + " entries: a model may not have so many");
  }

  // Returns the [[part]] array of a file; an empty one if there is none or if it is invalid.
  Node taken_parts(const Node& root) {
    const Node* const parts = root.find("part");
    Node none;
    none.type = Node::Type::array;
    if (!parts || (parts->type == Node::Type::array && parts->children.empty())) return none;
    if (parts->is_array_of_tables()) return *parts;
    add(parts->where_key(), std::string("'part' must be an array of tables, each begun by [[part]], not ") + parts->type_name());
    return none;
  }

  // Returns a text that is equal for all names of the same file.
  const std::string& identity_of(const std::string& file) {
    const auto [known, is_new] = identities_.emplace(file, file);
    if (!is_new) return known->second;
    std::error_code error;
    const std::filesystem::path path = std::filesystem::weakly_canonical(file, error);
    if (!error) known->second = path.string();
    return known->second;
  }
  static std::string base_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

  void take_parts(const Node& parts, const PartPlacement& outer);
  void take(const Node& part, const PartPlacement& outer);
  [[nodiscard]] bool has_usable_name(const Node& part);
  [[nodiscard]] std::optional<NumberOrFormula> place_value(const Node& part, const char* key, const char* unit, const PartPlacement& outer);
  [[nodiscard]] const PartFile* file_of(const Node& part);
  [[nodiscard]] bool is_free_to_take(const Node& file, const std::string& path);
  void write(const PartFile& file, const PartPlacement& place);
  void lay_over_parts(const std::vector<Overlay>& overlays, const Node& root, const PartPlacement& place);
  void refuse_overlay(const Overlay& overlay, const std::string& name);
  void write_array(const Node& array, const Node& root, const PartPlacement& place);
  void refuse_array(const Node& array);
  void write_parameters(const Node& root, const Node& part, const PartPlacement& outer, const PartPlacement& place);
  void refuse_unknown_parameters(const Node& given, const std::vector<std::string>& known, const Node& part, const PartPlacement& place);
  [[nodiscard]] Node parameter_of(const Node& own, const Node* given, const PartPlacement& outer, const PartPlacement& place);
  void check_given(const Node& own, const Node& given, const Node& part);
  Node& output(const Node& array);
  void append(Node array);

  Document& document_;
  std::vector<Diagnostic>& problems_;
  PartEntries entries_;
  std::map<std::string, std::unique_ptr<PartFile>> files_;  // by identity; null: could not be read
  std::unordered_map<std::string, std::string> identities_; // identity by file name, because asking the file system is slow
  std::vector<std::string> files_on_the_way_;               // chain of included files from the model's to the present part's, by identity
  std::vector<Node> added_;                                 // arrays of the parts' entries, and their [parameters]
  std::unordered_map<std::string, std::size_t> made_at_;    // index in the array of added_, by name: "body wagon 2.box"
  std::unordered_set<std::string> removed_;                 // entries of added_ that an including file removed
  std::unordered_set<std::string> reported_;
  std::size_t made_ = 0;
  bool is_too_many_ = false;
};

void PartWriter::take_parts(const Node& parts, const PartPlacement& outer) {
  std::unordered_map<std::string, Location> seen;
  for (const Node& part : parts.children) {
    if (!has_usable_name(part)) continue;
    const auto [first, is_new] = seen.emplace(entry_name(part), part.where());
    if (is_new) take(part, outer);
    else
      add(part.find("name")->where(),
          "a part named '" + entry_name(part) + "' exists already (line " + std::to_string(first->second.line) + "): choose another name");
  }
}

bool PartWriter::has_usable_name(const Node& part) {
  const Node* const name = part.find("name");
  const std::size_t before = problems_.size();
  if (!name) add(part.where(), "a part needs 'name' (unique name)");
  else if (name->text().empty()) add(name->where(), "'name' of a part: expected a name");
  else if (name->text().find_first_of("{}[]*?'\"=\n") != std::string::npos || name->text() == "ground")
    add(name->where(),
        "'" + name->text() +
            "' is no name of a part: names have no brackets, braces, quotes, * ? or =, since formulas and patterns hold them, and 'ground' "
            "is taken");
  const FieldTable& fields = PartEntry::fields();
  for (const Node& child : part.children) {
    if (fields.find(child.key) || child.key == "parameters") continue;
    std::vector<std::string> known = fields.names();
    known.emplace_back("parameters");
    add(child.where_key(), "unknown key '" + child.key + "' in part '" + entry_name(part) + "'" + did_you_mean(child.key, known));
  }
  return name && problems_.size() == before;
}

// Returns x, y or angle of a part, relative to the including file. Reports an error and returns nothing if the value is invalid.
std::optional<NumberOrFormula> PartWriter::place_value(const Node& part, const char* key, const char* unit, const PartPlacement& outer) {
  const Node* const given = part.find(key);
  if (!given) return NumberOrFormula{};
  Node own = *given;
  prefix_formulas(own, outer.prefix);
  const std::optional<NumberOrFormula> number = number_or_formula(own, unit);
  if (number && !number->is_number())
    document_.part_places.push_back({own, unit, std::string("'") + key + "' of part '" + outer.prefix + entry_name(part) + "'"});
  if (number) return number;
  const std::string subject = std::string("'") + key + "' of part '" + entry_name(part) + "': ";
  const Quantity quantity = given->type == Node::Type::text ? parse_quantity(given->text(), unit) : Quantity{};
  const std::string expected = std::string("expected a number or a string with a unit like '") + unit + "', got " + given->type_name();
  add(given->where(), subject + (quantity.problem.empty() ? expected : quantity.problem));
  return std::nullopt;
}

// Returns true if the file may be included here. Reports an error if it would include itself, or if parts are nested too deeply.
bool PartWriter::is_free_to_take(const Node& file, const std::string& path) {
  const std::string id = identity_of(path);
  if (const auto again = std::find(files_on_the_way_.begin(), files_on_the_way_.end(), id); again != files_on_the_way_.end()) {
    std::string ring;
    for (auto k = again; k != files_on_the_way_.end(); ++k) ring += base_name(*k) + " -> ";
    add(file.where(), "parts go round in circles: " + ring + base_name(path) + ": a file cannot be a part of itself");
    return false;
  }
  if (files_on_the_way_.size() <= k_deepest) return true;
  add(file.where(), "more than " + std::to_string(k_deepest) + " files are parts of each other: this is hardly meant");
  return false;
}

// Returns the file of the part, read at its first use. Reports an error and returns null if it cannot be read.
const PartFile* PartWriter::file_of(const Node& part) {
  const Node* const file = part.find("file");
  const std::string subject = "part '" + entry_name(part) + "'";
  if (!file || file->text().empty()) {
    if (!file) add(part.where(), subject + " needs 'file' (the model file that it takes)");
    else
      add(file->where(), "'file' of " + subject + ": expected the name of a model file, got " +
                             (file->type == Node::Type::text ? "an empty string" : file->type_name()));
    return nullptr;
  }
  const std::string path = std::filesystem::path(path_named_by(*file, file->text())).lexically_normal().string();
  const std::string id = identity_of(path);
  if (!is_free_to_take(*file, path)) return nullptr;
  const auto [found, is_new] = files_.emplace(id, nullptr);
  if (!is_new) return found->second.get();
  try {
    auto read = std::make_unique<PartFile>();
    read->root = load_into(document_, path, file->where());
    read->name = read->root.file;
    std::size_t made = 0; // not used: entries are counted each time that a part is expanded
    write_out_repetitions(read->root, made, problems_);
    read->overlays = taken_overlays(read->root);
    found->second = std::move(read);
  } catch (const ModelError& error) {
    for (const Diagnostic& d : error.diagnostics()) add(d.where, subject + ": " + d.message);
  }
  return found->second.get();
}

void PartWriter::take(const Node& part, const PartPlacement& outer) {
  const auto x = place_value(part, "x", "m", outer), y = place_value(part, "y", "m", outer),
             angle = place_value(part, "angle", "rad", outer);
  const PartFile* const file = file_of(part);
  if (!x || !y || !angle || !file || made_ > k_most_entries) return;
  PartPlacement place;
  place.prefix = outer.prefix + entry_name(part) + ".";
  place.frame = PartFrame(outer.frame, *x, *y, *angle);
  place.file = file->name;
  document_.parts.push_back({place.prefix, file->name, part.where()});
  if (++made_ > k_most_entries) return add_too_many(part); // counted although it may be empty: nested parts multiply exponentially
  write_parameters(file->root, part, outer, place);
  files_on_the_way_.push_back(identity_of(*file->name));
  write(*file, place);
  files_on_the_way_.pop_back();
}

void PartWriter::write(const PartFile& file, const PartPlacement& place) {
  const Node& root = file.root;
  entries_.note_placing_joints(root, place);
  for (const Node& child : root.children) {
    const bool is_of_file = child.key == "part" || child.key == "parameters" || child.key == "simulation" || child.key == "output" ||
                            ModelHeader::fields().find(child.key);
    if (is_of_file || (child.type == Node::Type::array && child.children.empty())) continue;
    if (entries_.are_known(child.key) && child.is_array_of_tables()) write_array(child, root, place);
    else refuse_array(child);
  }
  take_parts(taken_parts(root), place);
  lay_over_parts(file.overlays, root, place);
}

void PartWriter::lay_over_parts(const std::vector<Overlay>& overlays, const Node& root, const PartPlacement& place) {
  for (const Overlay& overlay : overlays) {
    const std::string name = place.prefix + entry_name(overlay.entry);
    const auto found = made_at_.find(overlay.array + " " + name);
    if (found == made_at_.end()) {
      refuse_overlay(overlay, name);
      continue;
    }
    const auto array = std::find_if(added_.begin(), added_.end(), [&](const Node& node) { return node.key == overlay.array; });
    Node& target = array->children[found->second];
    Node entry = overlay.entry;
    const bool is_of_own_kind = entry.find("kind") != nullptr;
    if (const Node* const kind = target.find("kind"); kind && !is_of_own_kind) entry.children.push_back(*kind);
    Node over = entries_.made(overlay.array, entry, root, place, false);
    if (!merge_entry(target, std::move(over), overlay.array, problems_)) removed_.insert(found->first);
  }
}

void PartWriter::refuse_overlay(const Overlay& overlay, const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [made, index] : made_at_)
    if (made.starts_with(overlay.array + " ")) known.push_back(made.substr(overlay.array.size() + 1));
  std::sort(known.begin(), known.end());
  const Node* const at = overlay.entry.find("name");
  add(at->where(), "a name with the name of a part before a point is that of something in the part, but there is no " + overlay.array +
                       " '" + name + "'" + did_you_mean(name, known));
}

void PartWriter::refuse_array(const Node& array) {
  if (entries_.are_known(array.key))
    return add(array.where_key(),
               "'" + array.key + "' must be an array of tables, each begun by [[" + array.key + "]], not " + array.type_name());
  if (entries_.are_model_only(array.key)) {
    const Node& first = array.is_array_of_tables() ? array.children.front() : array;
    return add(first.where(), "[[" + array.key +
                                  "]] concerns the whole model and is not allowed in the file of a part: write it into the model, "
                                  "with the names that things of the part have there");
  }
  std::vector<std::string> known = entries_.arrays();
  for (const char* name : {"part", "parameters", "simulation", "output", "title", "source", "gravity"}) known.emplace_back(name);
  add(array.where_key(), "unknown key '" + array.key + "' in the file of a part" + did_you_mean(array.key, known));
}

void PartWriter::write_array(const Node& array, const Node& root, const PartPlacement& place) {
  made_ += array.children.size();
  if (made_ > k_most_entries) return add_too_many(array.children.front());
  Node& target = output(array);
  for (const Node& entry : array.children) {
    target.children.push_back(entries_.made(array.key, entry, root, place));
    made_at_.emplace(array.key + " " + entry_name(target.children.back()), target.children.size() - 1);
  }
}

Node& PartWriter::output(const Node& array) {
  for (Node& known : added_)
    if (known.key == array.key) return known;
  Node& made = added_.emplace_back();
  made.type = array.type;
  made.key = array.key;
  made.file = array.file;
  made.line = array.line;
  made.column = array.column;
  made.key_line = array.key_line;
  made.key_column = array.key_column;
  return made;
}

// Appends the entries of the array, except removed ones, to those of the model.
void PartWriter::append(Node array) {
  Node* own = document_.root.find(array.key);
  std::vector<Node> entries = std::exchange(array.children, {});
  if (!own) own = &document_.root.children.emplace_back(array);
  if (own->type != array.type) return; // the reader reports the wrong type
  for (Node& entry : entries)
    if (removed_.empty() || removed_.count(array.key + " " + entry_name(entry)) == 0) own->children.push_back(std::move(entry));
}

void PartWriter::refuse_unknown_parameters(const Node& given, const std::vector<std::string>& known, const Node& part,
                                           const PartPlacement& place) {
  for (const Node& child : given.children) {
    if (std::find(known.begin(), known.end(), child.key) != known.end()) continue;
    std::string hint = did_you_mean(child.key, known);
    if (hint.empty()) {
      for (const std::string& name : known) hint += (hint.empty() ? "; it has '" : ", '") + name + "'";
      if (known.empty()) hint = ", nor any other: its [parameters] would declare it";
    }
    add(child.where_key(), "part '" + entry_name(part) + "': '" + base_name(*place.file) + "' has no parameter '" + child.key + "'" + hint);
  }
}

void PartWriter::write_parameters(const Node& root, const Node& part, const PartPlacement& outer, const PartPlacement& place) {
  const Node* const own = root.find("parameters");
  const Node* const given = part.find("parameters");
  const std::string subject = "part '" + entry_name(part) + "'";
  if (given && !given->is_table())
    return add(given->where(), "'parameters' of " + subject + " must be a table, as in { load = \"3 t\" }, not " + given->type_name());
  std::vector<std::string> known;
  if (own)
    for (const Node& parameter : own->children) known.push_back(parameter.key);
  if (given) refuse_unknown_parameters(*given, known, part, place);
  if (!own || !own->is_table()) {
    if (own) add(own->where_key(), std::string("'parameters' must be a table, [parameters], not ") + own->type_name());
    return;
  }
  made_ += own->children.size();
  Node& target = output(*own);
  for (const Node& parameter : own->children) {
    const Node* const value = given ? given->find(parameter.key) : nullptr;
    if (value) check_given(parameter, *value, part);
    target.children.push_back(parameter_of(parameter, value, outer, place));
  }
}

// Checks that the value given for a part's parameter has the dimension of the value that it replaces. The reader checks this for formulas.
void PartWriter::check_given(const Node& own, const Node& given, const Node& part) {
  const Node* const usual = own.is_table() ? own.find("value") : &own;
  const std::string subject = "parameter '" + own.key + "' of part '" + entry_name(part) + "'";
  if (given.is_table() || given.type == Node::Type::array || given.type == Node::Type::boolean)
    return add(given.where(),
               subject + ": expected a number, a text such as \"12 mm\" or a formula such as \"= 2*wall\", got " + given.type_name());
  if (!usual || is_formula(*usual) || is_formula(given)) return;
  const auto powers = [](const Node& node) {
    return node.type == Node::Type::text ? powers_in(node.text()) : std::optional(std::array<double, 3>{});
  };
  const auto wanted = powers(*usual), has = powers(given);
  if (!wanted || !has || *wanted == *has) return;
  const auto shown = [](const Node& node, const std::array<double, 3>& p) {
    const std::string unit = unit_text(p);
    return node.type == Node::Type::text ? "'" + node.text() + "'" : unit.empty() ? std::string("a number without a unit") : unit;
  };
  const std::string unit = unit_text(*wanted);
  add(given.where(), subject + " is " + shown(given, *has) + ", but " +
                         (unit.empty() ? "has no unit there" : "has a unit like '" + unit + "' there, " + shown(*usual, *wanted)));
}

Node PartWriter::parameter_of(const Node& own, const Node* given, const PartPlacement& outer, const PartPlacement& place) {
  Node made = own;
  prefix_formulas(made, place.prefix);
  made.key = place.prefix + own.key;
  if (!given) return made;
  Node value = *given;
  prefix_formulas(value, outer.prefix);
  if (Node* const held = made.is_table() ? made.find("value") : &made) {
    value.key = held->key;
    value.key_line = held->key_line;
    value.key_column = held->key_column;
    *held = std::move(value);
  }
  return made;
}

// Returns the message without digits, and with names without the prefixes of parts. Messages about copies of one entry then become equal.
std::string without_instance(const std::string& whole) {
  const std::string message = whole.substr(0, whole.find(" (did you mean")); // only the first of many messages has a suggestion
  std::string result;
  bool is_quoted = false;
  std::size_t begin = 0;
  for (const char c : message) {
    if (c == '\'') {
      is_quoted = !is_quoted;
      begin = result.size() + 1;
    }
    if (c == '.' && is_quoted) result.resize(std::min(begin, result.size())); // removes the name of the part
    else if (std::isdigit(static_cast<unsigned char>(c)) == 0) result += c;
  }
  return result;
}

// Returns a text on how the part was included, innermost part first: "part 'buffer', wagon.toml:8:1, of part 'wagon 2', train.toml:12:1".
std::string chain_text(const Document& document, const Document::Part& part) {
  const Document::Part* outer = nullptr;
  for (const Document::Part& other : document.parts) {
    const bool holds = other.prefix.size() < part.prefix.size() && part.prefix.starts_with(other.prefix);
    if (holds && (!outer || other.prefix.size() > outer->prefix.size())) outer = &other;
  }
  const std::size_t begin = outer ? outer->prefix.size() : 0;
  const std::string name = part.prefix.substr(begin, part.prefix.size() - begin - 1);
  const std::string place = part.where.file + ":" + std::to_string(part.where.line) + ":" + std::to_string(part.where.column);
  return "part '" + name + "', " + place + (outer ? ", of " + chain_text(document, *outer) : "");
}

// Returns chain_text() for the part to whose file the message belongs; "" if it belongs to no part.
std::string inclusion_chain(const Document& document, const Diagnostic& problem) {
  const Document::Part* found = nullptr;
  bool is_named = false;
  for (const Document::Part& part : document.parts) {
    if (*part.file != problem.where.file) continue;
    const bool names_it = problem.message.find("'" + part.prefix) != std::string::npos;
    if (!found || (names_it && (!is_named || part.prefix.size() > found->prefix.size()))) found = &part;
    is_named = is_named || names_it;
  }
  return found ? chain_text(document, *found) : "";
}

} // namespace

const FieldTable& PartEntry::fields() {
  static const FieldTable table = [] {
    FieldTable f;
    f.add("name", &PartEntry::name).required().doc("unique name: what the file calls 'buffer' the model calls 'name.buffer'");
    f.add("file", &PartEntry::file).as(FieldType::file).required().doc("the model file that it takes");
    f.add("x", &PartEntry::x).in("m").doc("where the origin of the file's ground lies");
    f.add("y", &PartEntry::y).in("m").doc("likewise");
    f.add("angle", &PartEntry::angle).in("rad").doc("by which the file's axes are turned, counter-clockwise");
    f.add("repeat", &PartEntry::repeat)
        .not_negative()
        .at_most(static_cast<double>(k_most_entries))
        .doc("how often, with the index i from 0 in formulas and in names");
    return f;
  }();
  return table;
}

PartTreatment part_treatment(const FieldTable& kind, const Field& field) {
  if (field.type == FieldType::texts) return PartTreatment::name;
  if (!kind.find("frame")) return PartTreatment::none;
  const bool is_vector = field.type == FieldType::vec2;
  const bool is_list = field.type == FieldType::points || field.type == FieldType::rings;
  if ((is_vector || is_list) && field.unit == "m") return PartTreatment::place;
  if (is_vector) return PartTreatment::direction;
  if (field.type == FieldType::signal && (field.name.ends_with("_x") || field.name.ends_with("_y"))) return PartTreatment::fixed_axis;
  return PartTreatment::none;
}

bool is_allowed_in_part(const TableKind& kind) {
  if (&kind == &channel_kind() || &kind == &plot_kind() || &kind == &acceptance_kind()) return true;
  const auto& fields = kind.fields.fields();
  const auto belongs_there = [](const Field& field) {
    return field.type == FieldType::body || field.name == "frame" || is_formula_field(field);
  };
  return std::any_of(fields.begin(), fields.end(), belongs_there);
}

void write_out_parts(Document& document, const Catalogue& catalogue) {
  const auto is_repeated = [&](const std::string& name) {
    const Node* const array = document.root.find(name);
    return array && std::any_of(array->children.begin(), array->children.end(), [](const Node& entry) { return entry.find("repeat"); });
  };
  document.is_repeated = std::any_of(repeated_arrays().begin(), repeated_arrays().end(), is_repeated);
  if (!document.is_repeated && !document.root.find("part")) return;
  const std::size_t before = document.problems.size();
  PartWriter(document, catalogue).write_out();
  if (document.problems.size() == before) return;
  name_parts(document.problems, document);
  throw ModelError(std::move(document.problems));
}

void name_parts(std::vector<Diagnostic>& problems, const Document& document) {
  if (document.parts.empty() && !document.is_repeated) return;
  std::map<std::string, std::size_t> first; // index in `kept` of the first message of those that are equal
  std::vector<Diagnostic> kept;
  std::vector<std::size_t> more;
  for (Diagnostic& problem : problems) {
    const std::string place = problem.where.file + ":" + std::to_string(problem.where.line) + ":" + std::to_string(problem.where.column);
    const auto [alike, is_new] = first.emplace(place + " " + without_instance(problem.message), kept.size());
    if (!is_new) {
      ++more[alike->second];
      continue;
    }
    kept.push_back(std::move(problem));
    more.push_back(0);
  }
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const std::string way = inclusion_chain(document, kept[k]);
    std::string& message = kept[k].message;
    if (!way.empty()) message += " (" + way + (more[k] > 0 ? "; and " + std::to_string(more[k]) + " more like it" : "") + ")";
    else if (more[k] > 0) message += " (and " + std::to_string(more[k]) + " more like it)";
  }
  problems = std::move(kept);
}

} // namespace steplap
