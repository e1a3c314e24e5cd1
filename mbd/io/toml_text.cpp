#include "mbd/io/toml_text.h"

#include <toml++/toml.h>

#include <algorithm>

namespace steplap {

const Node* Node::find(const std::string& child_key) const {
  if (type != Type::table) return nullptr;
  for (const Node& child : children)
    if (child.key == child_key) return &child;
  return nullptr;
}

Node* Node::find(const std::string& child_key) {
  return const_cast<Node*>(static_cast<const Node*>(this)->find(child_key));
}

void Node::erase(const std::string& child_key) {
  std::erase_if(children, [&](const Node& child) { return child.key == child_key; });
}

bool Node::is_array_of_tables() const {
  return type == Type::array && !children.empty() &&
         std::all_of(children.begin(), children.end(), [](const Node& n) { return n.is_table(); });
}

std::string Node::text() const {
  return type == Type::text ? std::get<std::string>(scalar) : "";
}

Location Node::where() const {
  return {file ? *file : "", line, column};
}

Location Node::where_key() const {
  return key_line > 0 ? Location{file ? *file : "", key_line, key_column} : where();
}

const char* Node::type_name() const {
  switch (type) {
  case Type::boolean:
    return std::get<bool>(scalar) ? "true" : "false";
  case Type::integer:
    return "an integer";
  case Type::number:
    return "a number";
  case Type::text:
    return "a string";
  case Type::date:
    return "a date or time";
  case Type::array:
    return is_array_of_tables() ? "an array of tables" : "an array";
  case Type::table:
    break;
  }
  return "a table";
}

namespace {

int line_of(const toml::source_region& region) {
  return static_cast<int>(region.begin.line);
}
int column_of(const toml::source_region& region) {
  return static_cast<int>(region.begin.column);
}

Node from_toml(const toml::node& source, const std::string* file);

void add_members(const toml::table& table, Node& node) {
  node.children.reserve(table.size());
  for (const auto& [key, value] : table) {
    Node child = from_toml(value, node.file);
    child.key = std::string(key.str());
    child.key_line = line_of(key.source());
    child.key_column = column_of(key.source());
    node.children.push_back(std::move(child));
  }
  std::stable_sort(node.children.begin(), node.children.end(), [](const Node& a, const Node& b) {
    return std::pair(a.key_line, a.key_column) < std::pair(b.key_line, b.key_column);
  });
}

void set_scalar(const toml::node& source, Node& node) {
  if (const auto* b = source.as_boolean()) {
    node.type = Node::Type::boolean;
    node.scalar = b->get();
  } else if (const auto* i = source.as_integer()) {
    node.type = Node::Type::integer;
    node.scalar = static_cast<long>(i->get());
  } else if (const auto* d = source.as_floating_point()) {
    node.type = Node::Type::number;
    node.scalar = d->get();
  } else if (const auto* s = source.as_string()) {
    node.type = Node::Type::text;
    node.scalar = s->get();
  } else {
    node.type = Node::Type::date;
  }
}

Node from_toml(const toml::node& source, const std::string* file) {
  Node node;
  node.file = file;
  node.line = line_of(source.source());
  node.column = column_of(source.source());
  if (const toml::table* table = source.as_table()) {
    add_members(*table, node);
  } else if (const toml::array* array = source.as_array()) {
    node.type = Node::Type::array;
    node.children.reserve(array->size());
    for (const toml::node& item : *array)
      node.children.push_back(from_toml(item, file));
  } else {
    set_scalar(source, node);
  }
  return node;
}

} // namespace

Node parse_toml(const std::string& text, const std::string* file) {
  try {
    return from_toml(toml::parse(text, *file), file);
  } catch (const toml::parse_error& error) {
    const toml::source_region& region = error.source();
    throw ModelError(Location{*file, line_of(region), column_of(region)},
                     "not valid TOML: " + std::string(error.description()));
  }
}

} // namespace steplap
