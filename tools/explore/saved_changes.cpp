#include "tools/explore/saved_changes.h"

#include "mbd/base/shown_text.h"
#include "mbd/io/atomic_file.h"
#include "mbd/io/document.h"
#include "mbd/io/reader.h"
#include "mbd/io/toml_writer.h"
#include "mbd/run/loaded_model.h"
#include "mbd/run/model_changes.h"
#include "transformer/program.h"

#include <algorithm>
#include <filesystem>

namespace steplap {

namespace {

namespace fs = std::filesystem;

Node text_node(const std::string& key, const std::string& text) {
  Node node;
  node.type = Node::Type::text;
  node.key = key;
  node.scalar = text;
  return node;
}

// Returns the child with this key, and adds it if there is none.
Node& child_of(Node& parent, const std::string& key, Node::Type type) {
  if (Node* found = parent.find(key)) return *found;
  Node& added = parent.children.emplace_back();
  added.key = key;
  added.type = type;
  return added;
}

void put(Node& table, const Node& value) {
  if (Node* found = table.find(value.key)) *found = value;
  else table.children.push_back(value);
}

const Node* longest_entry(const Node& array, const std::string& rest) {
  const Node* best = nullptr;
  for (const Node& entry : array.children) {
    const std::string name = entry_name(entry);
    if (!name.empty() && rest.starts_with(name + ".") && (!best || name.size() > entry_name(*best).size())) best = &entry;
  }
  return best;
}

// Copies the top-level key that contains `path` from `whole` to `changes`, with its complete value. Returns false if the key does not
// exist.
bool copy_key(const Node& whole, const std::string& path, Node& changes) {
  const std::size_t point = path.find('.');
  const std::string top = path.substr(0, point), rest = point == std::string::npos ? "" : path.substr(point + 1);
  const Node* const source = whole.find(top);
  if (!source) return false;
  if (source->is_array_of_tables()) {
    const Node* const entry = longest_entry(*source, rest);
    if (!entry) return false;
    const std::string name = entry_name(*entry), below = rest.substr(name.size() + 1), key = below.substr(0, below.find('.'));
    const Node* const value = entry->find(key);
    if (!value) return false;
    Node& array = child_of(changes, top, Node::Type::array);
    const auto same =
        std::find_if(array.children.begin(), array.children.end(), [&](const Node& other) { return entry_name(other) == name; });
    Node& over = same == array.children.end() ? array.children.emplace_back() : *same;
    over.type = Node::Type::table;
    put(over, text_node("name", name));
    put(over, *value);
    return true;
  }
  if (!source->is_table()) {
    put(changes, *source);
    return true;
  }
  // Names of parameters may contain points.
  const Node* const value = source->find(rest) ? source->find(rest) : source->find(rest.substr(0, rest.find('.')));
  if (value) put(child_of(changes, top, Node::Type::table), *value);
  return value != nullptr;
}

std::string path_in(const std::string& assignment) { return assignment.substr(0, assignment.find('=')); }

// Returns true if reading `text` as the file `file` gives the model `wanted`.
bool gives_model(const std::string& text, const std::string& file, const Model& wanted) {
  try {
    return changes_between(parse_given_model(text, file, program_catalogue()), wanted).empty();
  } catch (const ModelError&) {
    return false; // the text is not a valid model
  }
}

const std::string k_format_line = "format = " + std::to_string(k_file_format) + "\n";

} // namespace

std::string text_of_changes(const ExploredModel& model, const ExploredValues& values) {
  std::vector<std::string> all = model.overrides();
  for (std::string& assignment : model.assignments(values)) all.push_back(std::move(assignment));
  const std::string alone = load_model(model.path(), all)->text;
  const Node whole = parse_toml(alone, &model.path());
  Node changes;
  const fs::path model_file(model.path());
  changes.children.push_back(text_node("extends", model_file.filename().string()));
  bool is_whole = true;
  for (const std::string& assignment : all) is_whole = copy_key(whole, path_in(assignment), changes) && is_whole;
  const std::string text =
      "# Saved by steplap explore: what was changed of " + model_file.filename().string() + ".\n" + k_format_line + write_toml(changes);
  const Model wanted = read_given_model(model.path(), program_catalogue(), all);
  if (is_whole && gives_model(text, (model_file.parent_path() / "changes.toml").string(), wanted)) return text;
  return "# Saved by steplap explore. What was changed lies in parts of " + model_file.filename().string() +
         ", where a file that extends it does not reach:\n# this one stands alone.\n" + alone;
}

std::string save_changes(const ExploredModel& model, const ExploredValues& values, const std::string& name) {
  const fs::path folder = fs::path(model.path()).parent_path();
  const bool is_name = name.size() > 5 && name.size() <= 200 && name.ends_with(".toml") && name.front() != '.' &&
                       name.find_first_of("/\\") == std::string::npos && !has_control_character(name);
  if (!is_name) throw FileError(name, "'" + shown(name) + "' is no name to save under: give one without a folder that ends with .toml");
  const std::string file = (folder / name).string();
  write_file(file, text_of_changes(model, values));
  return file;
}

} // namespace steplap
