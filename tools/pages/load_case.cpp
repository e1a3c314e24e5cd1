#include "tools/pages/load_case.h"

#include "mbd/base/number_text.h"
#include "mbd/io/toml_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace steplap {

namespace {

constexpr std::size_t k_most_entries = 8; ///< largest number of list entries that are written out

std::string text_of(const Node& node);

std::string joined(const Node& node, const std::set<std::string>& skipped = {}) {
  std::string text;
  for (const Node& child : node.children) {
    if (skipped.contains(child.key)) continue;
    text += (text.empty() ? "" : ", ") + (child.key.empty() ? "" : child.key + " = ") + text_of(child);
  }
  return text;
}

std::string text_of(const Node& node) {
  switch (node.type) {
  case Node::Type::boolean: return std::get<bool>(node.scalar) ? "true" : "false";
  case Node::Type::integer: return std::to_string(std::get<long>(node.scalar));
  case Node::Type::number: return number_text(std::get<double>(node.scalar));
  case Node::Type::text:
  case Node::Type::date: return node.text();
  case Node::Type::table: return "{" + joined(node) + "}";
  case Node::Type::array: break;
  }
  return node.children.size() > k_most_entries ? std::to_string(node.children.size()) + " values" : "[" + joined(node) + "]";
}

// Adds a row with the value of `key` in a table, if it is given.
void add_value(OrderedJson& rows, const Node* table, const std::string& key, const std::string& words) {
  if (const Node* const value = table ? table->find(key) : nullptr) rows.push_back({words, text_of(*value)});
}

// Adds a row for each entry of an array of tables for which `is_chosen(name)` is true.
template <class Choice> void add_entries(OrderedJson& rows, const Node& model, const std::string& array, Choice is_chosen) {
  const Node* const entries = model.find(array);
  for (const Node& entry : entries ? entries->children : std::vector<Node>()) {
    const Node *const name = entry.find("name"), *const kind = entry.find("kind");
    if (!name || !is_chosen(name->text())) continue;
    const std::string kind_text = kind ? kind->text() + ", " : "";
    rows.push_back({array + " '" + name->text() + "'", kind_text + joined(entry, {"name", "kind"})});
  }
}

// Collects all texts of a node and its descendants, except names and kinds. They include references to signals.
void add_texts(const Node& node, std::set<std::string>& texts) {
  if (node.key == "name" || node.key == "kind") return;
  if (node.type == Node::Type::text) texts.insert(node.text());
  for (const Node& child : node.children) add_texts(child, texts);
}

// Returns the names of the elements that the drawing shows as arrows.
std::set<std::string> arrows_in(const OrderedJson& drawing) {
  std::set<std::string> names;
  for (const OrderedJson& element : drawing.value("elements", OrderedJson::array()))
    for (const OrderedJson& shape : element.value("shapes", OrderedJson::array()))
      if (shape.value("type", "") == "arrow") names.insert(element.value("name", ""));
  return names;
}

} // namespace

OrderedJson load_case_json(const std::string& model_text, const OrderedJson& drawing) {
  const std::string file = "model.toml";
  const Node model = parse_toml(model_text, &file);
  const std::set<std::string> arrows = arrows_in(drawing);
  std::set<std::string> texts;
  add_texts(model, texts);
  OrderedJson rows = OrderedJson::array();
  add_value(rows, &model, "gravity", "gravity");
  add_value(rows, model.find("simulation"), "velocity", "initial velocity");
  add_entries(rows, model, "element", [&arrows](const std::string& name) { return arrows.contains(name); });
  add_entries(rows, model, "signal", [&texts](const std::string& name) { return texts.contains(name); });
  add_value(rows, &model, "source", "source of the values");
  return rows;
}

} // namespace steplap
