#include "mbd/io/overrides.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace steplap {

namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Removes the part before the first point from the path and returns it.
std::string take_segment(std::string& path) {
  const std::size_t point = path.find('.');
  std::string segment = path.substr(0, point);
  path = point == std::string::npos ? "" : path.substr(point + 1);
  return segment;
}

class Override {
public:
  Override(Document& document, const std::string& assignment, const TopLevelNames& names) : document_(document), names_(names) {
    const std::size_t equals = assignment.find('=');
    file_ = &document.sources->emplace_back(Document::Source{"override " + assignment, ""}).file;
    path_ = assignment.substr(0, equals);
    is_complete_ = equals != std::string::npos && !path_.empty();
    if (!is_complete_) return;
    is_unset_ = assignment.substr(equals + 1) == "unset";
    value_ = parse_value(assignment.substr(equals + 1));
  }

  void apply() {
    if (!is_complete_) return complain("expected path=value, for example simulation.step=1e-4");
    const std::string top = take_segment(path_);
    if (contains(names_.arrays, top)) return set_in_entry(top);
    if (contains(names_.tables, top) && !path_.empty()) return set_in_table(top);
    if (contains(names_.keys, top)) return set_below(document_.root, top);
    std::vector<std::string> known = names_.keys;
    known.insert(known.end(), names_.tables.begin(), names_.tables.end());
    known.insert(known.end(), names_.arrays.begin(), names_.arrays.end());
    if (contains(names_.tables, top)) complain("name a key of '" + top + "', as in " + top + ".key=value");
    else complain("a model has no '" + top + "'" + did_you_mean(top, known));
  }

private:
  void complain(const std::string& message) { document_.problems.push_back({Location{*file_, 0, 0}, message}); }

  Node parse_value(const std::string& text) const {
    try {
      Node root = parse_toml("value = " + text, file_);
      if (root.children.size() == 1) return stripped(std::move(root.children.front()));
    } catch (const ModelError&) { // not TOML: taken as a string
    }
    Node node;
    node.type = Node::Type::text;
    node.scalar = text;
    node.file = file_;
    return node;
  }

  // Removes locations, since a value from the command line is in no file.
  static Node stripped(Node node) {
    node.line = node.column = node.key_line = node.key_column = 0;
    for (Node& child : node.children) child = stripped(std::move(child));
    return node;
  }

  // Sets a parameter of the model. A new parameter is refused, because no formula would use it.
  void set_parameter() {
    Node* const table = document_.root.find("parameters");
    Node* const parameter = table ? table->find(path_) : nullptr;
    if (parameter && parameter->is_table()) {
      path_.clear();
      return set_below(*parameter, "value");
    }
    if (parameter) { // parameters of parts have points in their names: "wagon 2.wall"
      const std::string name = std::exchange(path_, "");
      return set_below(*table, name);
    }
    std::vector<std::string> known;
    if (table)
      for (const Node& child : table->children) known.push_back(child.key);
    complain("the model has no parameter '" + path_ + "'" + did_you_mean(path_, known));
  }

  void set_in_table(const std::string& name) {
    if (name == "parameters") return set_parameter();
    Node* table = document_.root.find(name);
    if (!table) {
      Node& added = document_.root.children.emplace_back();
      added.key = name;
      added.file = file_;
      table = &added;
    }
    set_below(*table, take_segment(path_));
  }

  void set_in_entry(const std::string& array_name) {
    Node* array = document_.root.find(array_name);
    Node* best = nullptr;
    std::vector<std::string> known;
    if (array)
      for (Node& entry : array->children) {
        const std::string name = entry_name(entry);
        known.push_back(name);
        const bool leads = path_.rfind(name + ".", 0) == 0;
        if (leads && !name.empty() && (!best || name.size() > entry_name(*best).size())) best = &entry;
      }
    if (!best) {
      const std::string wanted = path_.substr(0, path_.rfind('.'));
      if (contains(known, path_)) return complain("name a key of " + array_name + " '" + path_ + "'");
      return complain("there is no " + array_name + " '" + wanted + "'" + did_you_mean(wanted, known));
    }
    path_ = path_.substr(entry_name(*best).size() + 1);
    set_below(*best, take_segment(path_));
  }

  // Sets the value at `key` of the table `parent`, or the item below it to which the rest of the path leads.
  void set_below(Node& parent, const std::string& key) {
    Node* child = child_of(parent, key);
    if (!path_.empty()) {
      if (!child) return complain("there is no '" + key + "' to set '" + path_ + "' of");
      return set_below(*child, take_segment(path_));
    }
    if (!child && !parent.is_table()) return complain("'" + key + "' is not an item of a list");
    if (is_unset_) return unset(parent, key, child);
    if (!child) child = &parent.children.emplace_back();
    const std::string kept_key = parent.is_table() ? key : "";
    *child = value_;
    child->key = kept_key;
  }

  void unset(Node& parent, const std::string& key, const Node* child) {
    if (child && !parent.is_table()) return complain("'" + key + "' is an item of a list, which cannot be unset");
    if (child) return parent.erase(key);
    std::vector<std::string> known;
    for (const Node& other : parent.children)
      if (!other.is_table() && !other.is_array_of_tables()) known.push_back(other.key);
    complain("the model gives no '" + key + "' there to unset" + did_you_mean(key, known));
  }

  static Node* child_of(Node& parent, const std::string& key) {
    if (parent.is_table()) return parent.find(key);
    std::size_t index = 0;
    const char* end = key.data() + key.size();
    const auto [rest, status] = std::from_chars(key.data(), end, index);
    const bool is_index = status == std::errc() && rest == end && index < parent.children.size();
    return is_index ? &parent.children[index] : nullptr;
  }

  Document& document_;
  const TopLevelNames& names_;
  const std::string* file_ = nullptr;
  std::string path_;
  Node value_;
  bool is_complete_ = false, is_unset_ = false;
};

} // namespace

void apply_override(Document& document, const std::string& assignment, const TopLevelNames& names) {
  Override(document, assignment, names).apply();
}

} // namespace steplap
