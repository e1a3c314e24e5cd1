#include "mbd/io/document.h"

#include "mbd/base/limits.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/input_files.h"
#include "mbd/io/read_input.h"
#include "mbd/io/units.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <unordered_map>
#include <unordered_set>

namespace steplap {

std::string entry_name(const Node& entry) {
  const Node* name = entry.find("name");
  return name ? name->text() : "";
}

namespace {

std::string read_layer(const std::string& path, const Location& where) {
  std::string text = read_input(path, where);
  note_input(path, text, false);
  return text;
}

// Merges the tree of a file into the tree of the file that it extends.
class Merger {
public:
  explicit Merger(std::vector<Diagnostic>& problems) : problems_(problems) {}

  void merge_root(Node& base, Node& over) {
    part_names_.clear();
    note_parts(base);
    note_parts(over);
    for (Node& child : over.children) {
      Node* inherited = base.find(child.key);
      if (child.is_array_of_tables() && (!inherited || inherited->type == Node::Type::array)) {
        if (!inherited) inherited = &base.children.emplace_back(without_children(child));
        merge_entries(*inherited, child);
      } else if (child.is_table()) {
        if (!inherited) inherited = &base.children.emplace_back(without_children(child));
        if (inherited->is_table()) merge_table(*inherited, child, "[" + child.key + "]");
        else *inherited = std::move(child);
      } else {
        replace(base, child);
      }
    }
    base.file = over.file;
    base.line = over.line;
    base.column = over.column;
  }

  // Merges `over` into `base`. Returns false if `over` removes the entry.
  bool merge_entry(Node& base, Node& over, const std::string& array) {
    if (take_flag(over, "remove")) return false;
    merge_table(base, over, array + " '" + entry_name(over) + "'");
    return true;
  }

private:
  // Records the names of parts with a point appended, as prefixes of the names in them. For a repeated part this is the text before the
  // index.
  void note_parts(const Node& root) {
    const Node* const parts = root.find("part");
    if (!parts || !parts->is_array_of_tables()) return;
    for (const Node& part : parts->children) {
      const std::string name = entry_name(part);
      const std::size_t brace = name.find('{');
      part_names_.push_back(!part.find("repeat") ? name + "." : brace == std::string::npos ? name + " " : name.substr(0, brace));
    }
  }
  [[nodiscard]] bool is_in_part(const std::string& name) const {
    const std::size_t point = name.rfind('.');
    return point != std::string::npos && std::any_of(part_names_.begin(), part_names_.end(), [&](const std::string& part) {
             return !part.empty() && part.size() <= point + 1 && name.starts_with(part);
           });
  }

  static Node without_children(const Node& node) {
    Node result;
    result.type = node.type;
    result.key = node.key;
    result.file = node.file;
    result.line = node.line;
    result.column = node.column;
    result.key_line = node.key_line;
    result.key_column = node.key_column;
    return result;
  }

  static void replace(Node& base, Node& child) {
    if (Node* inherited = base.find(child.key)) *inherited = std::move(child);
    else base.children.push_back(std::move(child));
  }

  // Sets a parameter to another value. A range and a description that it inherits are kept.
  static void replace_parameter(Node& base, Node& child) {
    Node* const inherited = base.find(child.key);
    if (!inherited || !inherited->is_table() || !inherited->find("value")) return replace(base, child);
    if (child.is_table()) {
      for (Node& key : child.children) replace(*inherited, key);
    } else {
      child.key = "value";
      replace(*inherited, child);
    }
  }

  void merge_table(Node& base, Node& over, const std::string& subject) {
    if (take_flag(over, "replace")) {
      if (base.children.empty()) problems_.push_back({over.where(), subject + " inherits nothing to replace"});
      base.children.clear();
    }
    if (const Node* unset = over.find("unset")) {
      unset_keys(base, *unset, subject);
      over.erase("unset");
    }
    const bool has_parameters = base.key == "parameters";
    for (Node& child : over.children) has_parameters ? replace_parameter(base, child) : replace(base, child);
    base.file = over.file;
    base.line = over.line;
    base.column = over.column;
  }

  void unset_keys(Node& base, const Node& unset, const std::string& subject) {
    if (unset.type != Node::Type::array) {
      problems_.push_back({unset.where(), "'unset' must be a list of keys, as in [\"step\"]"});
      return;
    }
    for (const Node& item : unset.children) {
      std::vector<std::string> known;
      for (const Node& child : base.children) known.push_back(child.key);
      if (!base.find(item.text()))
        problems_.push_back({item.where(), subject + " inherits no key '" + item.text() + "' to unset" + did_you_mean(item.text(), known)});
      base.erase(item.text());
    }
  }

  void merge_entries(Node& base, Node& over) {
    std::unordered_map<std::string, std::size_t> inherited;
    for (std::size_t i = 0; i < base.children.size(); ++i) inherited.emplace(entry_name(base.children[i]), i);
    std::unordered_set<std::string> removed, seen;
    base.children.reserve(base.children.size() + over.children.size());
    for (Node& entry : over.children) {
      const std::string name = entry_name(entry);
      if (over.key != "part" && is_in_part(name)) { // merged when the part's entries are known (parts.h)
        base.children.push_back(std::move(entry));
        continue;
      }
      const auto found = name.empty() ? inherited.end() : inherited.find(name);
      const bool is_new = found == inherited.end() || !seen.insert(name).second;
      if (take_flag(entry, "remove")) {
        if (is_new) report_missing(entry, over.key, "removed", inherited);
        else removed.insert(name);
      } else if (is_new) {
        if (take_flag(entry, "replace")) report_missing(entry, over.key, "replaced", inherited);
        if (!entry.find("unset")) { // a new entry inherits nothing and reports nothing, so it is moved
          base.children.push_back(std::move(entry));
          continue;
        }
        Node& added = base.children.emplace_back(without_children(entry));
        merge_table(added, entry, over.key + " '" + name + "'");
      } else {
        merge_table(base.children[found->second], entry, over.key + " '" + name + "'");
      }
    }
    if (!removed.empty()) std::erase_if(base.children, [&](const Node& n) { return removed.count(entry_name(n)) > 0; });
  }

  // Returns the value of a boolean key, false if it is missing, and removes the key from the entry.
  bool take_flag(Node& entry, const std::string& key) {
    const Node* given = entry.find(key);
    if (!given) return false;
    const bool* flag = std::get_if<bool>(&given->scalar);
    const bool result = given->type == Node::Type::boolean && *flag;
    if (given->type != Node::Type::boolean)
      problems_.push_back({given->where(), "'" + key + "' must be true or false, got " + given->type_name()});
    entry.erase(key);
    return result;
  }

  void report_missing(const Node& entry, const std::string& array, const std::string& what,
                      const std::unordered_map<std::string, std::size_t>& inherited) {
    std::vector<std::string> known;
    for (const auto& [name, index] : inherited) known.push_back(name);
    const std::string name = entry_name(entry);
    problems_.push_back({entry.where(), "no " + array + " '" + name + "' is inherited that could be " + what + did_you_mean(name, known)});
  }

  std::vector<Diagnostic>& problems_;
  std::vector<std::string> part_names_; // names of both trees
};

void refuse_long_tables(const Node& node) {
  if (node.is_table() && node.children.size() > k_most_keys)
    throw ModelError(node.where_key(), (node.key.empty() ? "the file" : "'" + node.key + "'") + " has " +
                                           std::to_string(node.children.size()) + " keys, more than the " + std::to_string(k_most_keys) +
                                           " that a table may have");
  for (const Node& child : node.children) refuse_long_tables(child);
}

class Loader {
public:
  Document load(std::string text, const std::string& file) {
    document_.sources = std::make_shared<std::deque<Document::Source>>();
    document_.root = load_layer(std::move(text), file);
    return std::move(document_);
  }

  static Node load_into(Document& document, std::string text, const std::string& file) {
    Loader loader;
    loader.document_.sources = document.sources;
    Node root = loader.load_layer(std::move(text), file);
    document.problems.insert(document.problems.end(), loader.document_.problems.begin(), loader.document_.problems.end());
    for (const std::string& name : loader.document_.files_without_format) add_once(document.files_without_format, name);
    return root;
  }

private:
  Node load_layer(std::string text, const std::string& file) {
    const std::string id = identity_of(file);
    Document::Source& source = document_.sources->emplace_back(Document::Source{file, std::move(text)});
    chain_.push_back(id);
    names_.push_back(file);
    Node over = parse_toml(source.text, &source.file);
    refuse_long_tables(over);
    take_format(over, source.file);
    take_outline_unit(over);
    Node base;
    base.file = &source.file;
    if (const Node* extends = over.find("extends")) base = load_base(*extends, file);
    over.erase("extends");
    Merger(document_.problems).merge_root(base, over);
    refuse_long_tables(base);
    return base;
  }

  // Checks the key `format` and removes it. It belongs to the file: a file and the one that it extends may have different formats.
  void take_format(Node& root, const std::string& file) {
    if (const Node* format = root.find("format")) check_format(*format);
    else add_once(document_.files_without_format, file);
    root.erase("format");
  }

  // So is `outline_unit`: plain numbers of its outlines and shapes are in that unit.
  void take_outline_unit(Node& root) {
    const Node* const unit = root.find("outline_unit");
    if (!unit) return;
    const Quantity one = parse_quantity("1 " + unit->text(), "m");
    const double factor = unit->text().empty() ? 0.0 : one.value;
    if (!(factor > 0.0)) document_.problems.push_back({unit->where(), "'outline_unit' must be a unit of length, as in \"mm\""});
    else scale_outlines(root, factor);
    root.erase("outline_unit");
  }

  // In a shape all lengths are scaled, so that a plate and its holes, or a disc, have one unit.
  static void scale_outlines(Node& table, double factor, bool is_shape = false) {
    const auto is_one_of = [](const std::string& key, std::initializer_list<const char*> keys) {
      return std::find(keys.begin(), keys.end(), key) != keys.end();
    };
    for (Node& child : table.children) {
      const bool is_length =
          is_one_of(child.key, {"outline", "outline_a", "outline_b"}) ||
          (is_shape && is_one_of(child.key, {"holes", "hole_centres", "hole_diameters", "centre", "diameter", "thickness"}));
      is_length ? scale_numbers(child, factor) : scale_outlines(child, factor, is_shape || child.key == "shape");
    }
  }

  static void scale_numbers(Node& node, double factor) {
    if (const long* const whole = std::get_if<long>(&node.scalar); whole && node.type == Node::Type::integer) {
      node.scalar = static_cast<double>(*whole);
      node.type = Node::Type::number;
    }
    if (node.type == Node::Type::number) node.scalar = factor * std::get<double>(node.scalar);
    for (Node& child : node.children) scale_numbers(child, factor);
  }

  void check_format(const Node& format) {
    const std::string known = std::to_string(k_file_format);
    const long* const given = format.type == Node::Type::integer ? std::get_if<long>(&format.scalar) : nullptr;
    if (given && *given == k_file_format) return;
    std::string message = "'format' must be " + known + ", the version of the file format";
    if (!given) message += std::string(", got ") + format.type_name();
    else if (*given > k_file_format)
      message = "'format' is " + std::to_string(*given) + ", and this version of steplap reads format " + known +
                ": use a later version of steplap";
    document_.problems.push_back({format.where(), message});
  }

  static void add_once(std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }

  Node load_base(const Node& extends, const std::string& file) {
    const std::string name = extends.text();
    if (name.empty())
      throw ModelError(extends.where(), std::string("'extends' must be the name of a model file, got ") +
                                            (extends.type == Node::Type::text ? "an empty string" : extends.type_name()));
    const std::string path = (std::filesystem::path(file).parent_path() / name).lexically_normal().string();
    check_no_cycle(path, extends.where());
    return load_layer(read_layer(path, extends.where()), path);
  }

  void check_no_cycle(const std::string& path, const Location& where) const {
    if (chain_.size() >= k_longest_chain)
      throw ModelError(where, "more than " + std::to_string(k_longest_chain) + " files extend each other: this is hardly meant");
    const std::string id = identity_of(path);
    for (std::size_t k = 0; k < chain_.size(); ++k) {
      if (chain_[k] != id) continue;
      std::string text = "'extends' goes round in circles: ";
      for (std::size_t i = k; i < names_.size(); ++i) text += base_name(names_[i]) + " -> ";
      throw ModelError(where, text + base_name(path));
    }
  }

  // Returns a text that is equal for all names of the same file. For a pipe this is the name itself.
  static std::string identity_of(const std::string& file) {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::weakly_canonical(file, error);
    return error ? file : path.string();
  }

  // Longest chain of files that extend each other: longer than any that is meant, and safe for the stack.
  static constexpr std::size_t k_longest_chain = 100;

  static std::string base_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

  Document document_;
  std::vector<std::string> chain_, names_;
};

std::string without_line_ends(std::string text) {
  std::erase_if(text, [](char c) { return c == '\n' || c == '\r' || c == '\t'; });
  return text;
}

void find_control_characters(const Node& node, std::vector<Diagnostic>& problems) {
  const auto is_allowed = [&node](const std::string& text) {
    return !has_control_character(text) || (node.key == "source" && !has_control_character(without_line_ends(text)));
  };
  if (has_control_character(node.key)) problems.push_back({node.where_key(), "the key '" + node.key + "' holds a control character"});
  else if (node.type == Node::Type::text && !is_allowed(std::get<std::string>(node.scalar)))
    problems.push_back({node.where(), (node.key.empty() ? "the text" : "'" + node.key + "',") + std::string(" '") + node.text() +
                                          "', holds a control character (a line break, a tab or the like): write it without"});
  for (const Node& child : node.children) find_control_characters(child, problems);
}

} // namespace

void refuse_control_characters(Document& document) { find_control_characters(document.root, document.problems); }

Document load_document(const std::string& path) { return Loader().load(read_layer(path, Location{}), shown_input(path)); }

Document parse_document(std::string text, const std::string& file_name) { return Loader().load(std::move(text), file_name); }

bool merge_entry(Node& base, Node over, const std::string& array, std::vector<Diagnostic>& problems) {
  return Merger(problems).merge_entry(base, over, array);
}

Node load_into(Document& document, const std::string& path, const Location& where) {
  return Loader::load_into(document, read_layer(path, where), path);
}

std::string model_source_text(const std::string& path) {
  std::string result;
  const Document document = load_document(path);
  for (const Document::Source& source : *document.sources)
    result += "# ---- " + std::filesystem::path(source.file).filename().string() + " ----\n" + source.text +
              (source.text.ends_with('\n') ? "" : "\n");
  return result;
}

} // namespace steplap
