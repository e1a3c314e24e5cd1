#include "mbd/io/standalone_text.h"

#include "mbd/io/input_files.h"
#include "mbd/io/overrides.h"
#include "mbd/io/toml_writer.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace steplap {

namespace {

namespace fs = std::filesystem;

// Calls `visit` with the entry for every file that it names.
template <class Entry, class Visit> void visit_files_of(Entry& entry, const FieldTable& fields, const Visit& visit) {
  for (const Field& field : fields.fields())
    if (auto* const name = entry.find(field.name); field.type == FieldType::file && name && !name->text().empty()) visit(entry, *name);
}

// Calls `visit` with every entry of a signal or table in `root` that names a file, and with that name.
template <class Root, class Visit> void visit_named_files(Root& root, const Catalogue& catalogue, const Visit& visit) {
  for (const TableKind* kind : catalogue.tables)
    if (auto* const tables = root.find(kind->name); tables && tables->is_array_of_tables())
      for (auto& entry : tables->children) visit_files_of(entry, kind->fields, visit);
  auto* const signals = root.find("signal");
  if (!signals || !signals->is_array_of_tables()) return;
  for (auto& entry : signals->children) {
    const Node* const kind_name = entry.find("kind");
    const auto kind = std::find_if(catalogue.signals.begin(), catalogue.signals.end(),
                                   [&](const SignalKind* k) { return kind_name && k->name == kind_name->text(); });
    if (kind != catalogue.signals.end()) visit_files_of(entry, (*kind)->fields, visit);
  }
}

std::string absolute(const std::string& file) {
  std::error_code ignored;
  return fs::weakly_canonical(fs::absolute(file), ignored).string();
}

Node text_node(const std::string& key, const std::string& text) {
  Node node;
  node.type = Node::Type::text;
  node.key = key;
  node.scalar = text;
  return node;
}

// Returns the document as TOML, with the key `format` added, which is not part of the document (document.h).
std::string written(const Node& root) { return "format = " + std::to_string(k_file_format) + "\n" + write_toml(root); }

} // namespace

std::string path_named_by(const Node& node, const std::string& name) {
  const fs::path given = name;
  const bool on_command_line = node.line == 0;
  if (given.is_absolute() || on_command_line || !node.file) return given.string();
  return (fs::path(*node.file).parent_path() / given).lexically_normal().string();
}

std::string standalone_text(const Document& document, const Catalogue& catalogue) {
  bool names_files = false;
  visit_named_files(document.root, catalogue, [&names_files](const Node&, const Node&) { names_files = true; });
  if (!names_files) return written(document.root); // without a copy: the tree of a large model takes a quarter of a gigabyte
  Node root = document.root;
  std::vector<std::pair<Node*, std::string>> found; // entries and checksums; stored because adding keys moves nodes
  visit_named_files(root, catalogue, [&found](Node& entry, Node& name) {
    const std::string path = absolute(path_named_by(name, name.text()));
    found.emplace_back(&entry, sha256_of_file(path));
    name.scalar = path;
  });
  for (const auto& [entry, checksum] : found) {
    if (checksum.empty()) continue; // unreadable files are reported when they are needed
    entry->erase("sha256");
    entry->children.push_back(text_node("sha256", checksum));
  }
  return written(root);
}

std::string text_with_settings(const std::string& text, const std::vector<std::string>& assignments) {
  Document document = parse_document(text, "the model");
  for (const std::string& assignment : assignments) apply_override(document, assignment, {{}, {"simulation", "output"}, {}});
  if (!document.problems.empty()) throw ModelError(std::move(document.problems));
  return written(document.root);
}

} // namespace steplap
