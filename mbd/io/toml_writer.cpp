#include "mbd/io/toml_writer.h"

#include "mbd/base/number_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <utility>

namespace steplap {

namespace {

void append_quoted(std::string& text, const std::string& content) {
  text += '"';
  for (const char c : content) {
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (c == '\n') {
      text += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", static_cast<unsigned>(c));
      text += escape;
    } else {
      text += c;
    }
  }
  text += '"';
}

void append_key(std::string& text, const std::string& key) {
  const auto is_bare = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; };
  if (!key.empty() && std::all_of(key.begin(), key.end(), is_bare)) text += key;
  else append_quoted(text, key);
}

// Appends a number with a point or an exponent. Without either it would be read as an integer.
void append_float(std::string& text, double value) {
  if (std::isnan(value)) text += "nan";
  else if (std::isinf(value)) text += value > 0 ? "inf" : "-inf";
  else {
    const std::size_t begin = text.size();
    append_number(text, value);
    if (text.find_first_of(".e", begin) == std::string::npos) text += ".0";
  }
}

void append_member(std::string& text, const Node& node);

void append_value(std::string& text, const Node& node) {
  const char* separator = "";
  switch (node.type) {
  case Node::Type::boolean: text += std::get<bool>(node.scalar) ? "true" : "false"; return;
  case Node::Type::integer: text += std::to_string(std::get<long>(node.scalar)); return;
  case Node::Type::number: return append_float(text, std::get<double>(node.scalar));
  case Node::Type::text: return append_quoted(text, std::get<std::string>(node.scalar));
  case Node::Type::date: text += "\"\""; return;
  case Node::Type::array:
    text += '[';
    for (const Node& child : node.children) {
      text += std::exchange(separator, ", ");
      append_value(text, child);
    }
    text += ']';
    return;
  case Node::Type::table: break;
  }
  text += '{';
  for (const Node& child : node.children) {
    text += *separator == '\0' ? " " : separator;
    separator = ", ";
    append_member(text, child);
  }
  text += " }";
}

void append_member(std::string& text, const Node& node) {
  append_key(text, node.key);
  text += " = ";
  append_value(text, node);
}

void append_line(std::string& text, const Node& node) {
  append_member(text, node);
  text += '\n';
}

void append_table(std::string& text, const std::string& open, const std::string& key, const std::string& close, const Node& table) {
  text += open;
  append_key(text, key);
  text += close;
  for (const Node& child : table.children) append_line(text, child);
}

} // namespace

std::string write_toml(const Node& root) {
  std::string text;
  for (const Node& child : root.children)
    if (!child.is_table() && !child.is_array_of_tables()) append_line(text, child);
  for (const Node& child : root.children)
    if (child.is_table()) append_table(text, "\n[", child.key, "]\n", child);
  for (const Node& child : root.children) {
    if (!child.is_array_of_tables()) continue;
    for (const Node& entry : child.children) append_table(text, "\n[[", child.key, "]]\n", entry);
  }
  return text;
}

} // namespace steplap
