#include "mbd/io/toml_writer.h"

#include "mbd/base/number_text.h"

#include <cctype>
#include <cmath>
#include <cstdio>

namespace steplap {

namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (c == '\n') {
      result += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", static_cast<unsigned>(c));
      result += escape;
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string key_text(const std::string& key) {
  for (const char c : key)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') return quoted(key);
  return key.empty() ? "\"\"" : key;
}

// Returns a number with a point or an exponent. Without either it would be read as an integer.
std::string float_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  const std::string text = number_text(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string value_text(const Node& node) {
  std::string text;
  switch (node.type) {
  case Node::Type::boolean: return std::get<bool>(node.scalar) ? "true" : "false";
  case Node::Type::integer: return std::to_string(std::get<long>(node.scalar));
  case Node::Type::number: return float_text(std::get<double>(node.scalar));
  case Node::Type::text:
  case Node::Type::date: return quoted(node.text());
  case Node::Type::array:
    for (const Node& child : node.children) text += (text.empty() ? "" : ", ") + value_text(child);
    return "[" + text + "]";
  case Node::Type::table: break;
  }
  for (const Node& child : node.children) text += (text.empty() ? " " : ", ") + key_text(child.key) + " = " + value_text(child);
  return "{" + text + " }";
}

void write_values(const Node& table, std::string& text) {
  for (const Node& child : table.children) text += key_text(child.key) + " = " + value_text(child) + "\n";
}

} // namespace

std::string write_toml(const Node& root) {
  std::string text;
  for (const Node& child : root.children)
    if (!child.is_table() && !child.is_array_of_tables()) text += key_text(child.key) + " = " + value_text(child) + "\n";
  for (const Node& child : root.children) {
    if (!child.is_table()) continue;
    text += "\n[" + key_text(child.key) + "]\n";
    write_values(child, text);
  }
  for (const Node& child : root.children) {
    if (!child.is_array_of_tables()) continue;
    for (const Node& entry : child.children) {
      text += "\n[[" + key_text(child.key) + "]]\n";
      write_values(entry, text);
    }
  }
  return text;
}

} // namespace steplap
