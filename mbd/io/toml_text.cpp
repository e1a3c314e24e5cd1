#include "mbd/io/toml_text.h"

#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <tuple>
#include <utility>

namespace steplap {

const Node* Node::find(const std::string& child_key) const {
  if (type != Type::table) return nullptr;
  for (const Node& child : children)
    if (child.key == child_key) return &child;
  return nullptr;
}

Node* Node::find(const std::string& child_key) { return const_cast<Node*>(static_cast<const Node*>(this)->find(child_key)); }

void Node::erase(const std::string& child_key) {
  std::erase_if(children, [&](const Node& child) { return child.key == child_key; });
}

bool Node::is_array_of_tables() const {
  return type == Type::array && !children.empty() &&
         std::all_of(children.begin(), children.end(), [](const Node& n) { return n.is_table(); });
}

std::string Node::text() const { return type == Type::text ? std::get<std::string>(scalar) : ""; }

Location Node::where() const { return {file ? *file : "", line, column}; }

Location Node::where_key() const { return key_line > 0 ? Location{file ? *file : "", key_line, key_column} : where(); }

const char* Node::type_name() const {
  switch (type) {
  case Type::boolean: return std::get<bool>(scalar) ? "true" : "false";
  case Type::integer: return "an integer";
  case Type::number: return "a number";
  case Type::text: return "a string";
  case Type::date: return "a date or time";
  case Type::array: return is_array_of_tables() ? "an array of tables" : "an array";
  case Type::table: break;
  }
  return "a table";
}

namespace {

int line_of(const toml::source_region& region) { return static_cast<int>(region.begin.line); }
int column_of(const toml::source_region& region) { return static_cast<int>(region.begin.column); }

Node from_toml(toml::node& source, const std::string* file);

// Moves the members to `node`. The table is emptied, so that a large file is not in memory twice.
void add_members(toml::table& table, Node& node) {
  std::vector<std::pair<const toml::key*, toml::node*>> members; // sorted before nodes are made of them, because these are large
  members.reserve(table.size());
  for (auto&& [key, value] : table) members.emplace_back(&key, &value);
  const auto place = [](const auto& member) { return std::pair(line_of(member.first->source()), column_of(member.first->source())); };
  std::stable_sort(members.begin(), members.end(), [&place](const auto& a, const auto& b) { return place(a) < place(b); });
  node.children.reserve(members.size());
  for (const auto& [key, value] : members) {
    Node& child = node.children.emplace_back(from_toml(*value, node.file));
    child.key = key->str();
    std::tie(child.key_line, child.key_column) = place(std::pair(key, value));
  }
  table.clear();
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

Node from_toml(toml::node& source, const std::string* file) {
  Node node;
  node.file = file;
  node.line = line_of(source.source());
  node.column = column_of(source.source());
  if (toml::table* table = source.as_table()) {
    add_members(*table, node);
  } else if (toml::array* array = source.as_array()) {
    node.type = Node::Type::array;
    node.children.reserve(array->size());
    for (toml::node& item : *array) node.children.push_back(from_toml(item, file));
  } else {
    set_scalar(source, node);
  }
  return node;
}

// Refuses keys with too many parts before parsing. The TOML library and this program process nested tables by recursion. The library limits
// the nesting of brackets, but a key with 30000 parts, "a.a.a…", creates as many nested tables and would exhaust the stack. Quoted text and
// comments may contain any number of points.
class DottedKeys {
public:
  DottedKeys(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  void check() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') skip_to("\n");
      else if (c == '"' || c == '\'') skip_quoted(starts("\"\"\"") || starts("'''") ? 3 : 1);
      else {
        if (c == '\n') start_line();
        if (c == '.') count();
        if (c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}') parts_ = 1;
        ++at_;
      }
    }
  }

private:
  static constexpr int k_most_parts = 256; // the same limit as the library has for brackets

  [[nodiscard]] bool starts(const char* mark) const { return text_.compare(at_, 3, mark) == 0; }

  void start_line() {
    ++line_;
    line_start_ = at_ + 1;
    parts_ = 1;
  }

  void count() {
    if (++parts_ <= k_most_parts) return;
    throw ModelError(Location{file_, line_, static_cast<int>(at_ - line_start_) + 1},
                     "a key of more than " + std::to_string(k_most_parts) + " parts: tables are not nested so deeply");
  }

  void skip_to(const char* end) {
    const std::size_t found = text_.find(end, at_);
    at_ = found == std::string::npos ? text_.size() : found;
  }

  // Skips a quoted text, from its opening mark of `quotes` characters to the end of the closing one.
  void skip_quoted(std::size_t quotes) {
    const char quote = text_[at_];
    const std::string mark(quotes, quote);
    for (at_ += quotes; at_ < text_.size() && text_.compare(at_, quotes, mark) != 0; ++at_) {
      if (quote == '"' && text_[at_] == '\\') ++at_;
      else if (text_[at_] == '\n') {
        if (quotes == 1) return; // not closed: the library reports it
        start_line();
      }
    }
    at_ = std::min(at_ + quotes, text_.size());
  }

  const std::string& text_;
  const std::string& file_;
  std::size_t at_ = 0, line_start_ = 0;
  int line_ = 1, parts_ = 1;
};

std::string_view line_at(std::string_view text, int line) {
  for (; line > 1; --line) {
    const auto end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find('\n'));
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' || static_cast<unsigned char>(c) >= 0x80; }

// Returns a hint for numbers that TOML does not accept: ".5", "5.", "05", "0,5", 0.5 kg. Empty if the value at `column` (from 1) is not
// such a number.
std::string number_hint(std::string_view line, int column) {
  constexpr std::string_view k_before = "=[{ \t", k_behind = " \t\r,]}#";
  const auto at = std::min(line.size(), static_cast<std::size_t>(std::max(column, 2) - 2));
  auto begin = line.find_last_of('=', at);
  begin = begin == std::string_view::npos ? line.size() : line.find_first_not_of(k_before, begin);
  if (begin == std::string_view::npos || begin >= line.size()) return "";
  std::string_view rest = line.substr(begin);
  const std::string sign = rest.front() == '-' || rest.front() == '+' ? std::string(1, rest.front()) : "";
  rest.remove_prefix(sign.size());
  const std::string number(rest.substr(0, rest.find_first_of(k_behind)));
  const auto instead = [&](const std::string& right) { return ": write " + sign + right + " instead of " + sign + number; };
  if (number.size() > 1 && number[0] == '.' && is_digit(number[1])) return instead("0" + number);
  if (number.empty() || !is_digit(number[0])) return "";
  const auto other = number.find_first_not_of("0123456789");
  if (other == number.size() - 1 && number.back() == '.') return instead(number + "0");
  const auto significant = number.find_first_not_of('0');
  if (number[0] == '0' && significant != 0 && significant != std::string::npos && is_digit(number[significant]))
    return instead(number.substr(significant));
  const auto behind = rest.find_first_not_of("0123456789");
  if (behind != std::string_view::npos && rest[behind] == ',' && behind + 1 < rest.size() && is_digit(rest[behind + 1]))
    return ": the decimal sign is a point: " + sign + std::string(rest.substr(0, behind)) + "." +
           std::string(rest.substr(behind + 1, rest.find_first_not_of("0123456789", behind + 1) - behind - 1));
  double value = 0.0;
  const auto [end, status] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  const auto unit = rest.find_first_not_of(" \t", static_cast<std::size_t>(end - rest.data()));
  if (status == std::errc() && unit != std::string_view::npos && is_letter(rest[unit]))
    return ": a number with a unit needs quotes, as in \"0.5 kg\"";
  return "";
}

// Returns a hint for a text without quotes, as in "signal = thing". Empty if the word at `column` (from 1) is not the whole of a value, or
// is none. TOML takes a value that begins with t, f, i or n for true, false, inf or nan, and reports the first letter that differs.
std::string text_hint(std::string_view line, int column) {
  const auto is_of_word = [](char c) { return is_letter(c) || is_digit(c) || c == '_' || c == '-' || c == '.'; };
  std::size_t begin = std::min(line.size(), static_cast<std::size_t>(std::max(column, 1) - 1));
  if (begin > 0 && (begin == line.size() || !is_of_word(line[begin]))) --begin;
  while (begin > 0 && is_of_word(line[begin - 1])) --begin;
  const auto before = begin == 0 ? std::string_view::npos : line.find_last_not_of(" \t", begin - 1);
  if (before == std::string_view::npos || std::string_view("=[,").find(line[before]) == std::string_view::npos ||
      line.substr(0, before + 1).find('=') == std::string_view::npos)
    return ""; // it belongs to a key or to the name of a table
  const std::string word(line.substr(begin, line.find_first_of(" \t\r,]}#=", begin) - begin));
  for (const std::string_view open : {"\u201c", "\u201d", "\u201e", "\u2018", "\u2019"}) // typographic quotes
    if (word.starts_with(open)) return ": quotes must be straight, as in \"box\"";
  const bool is_value = word.empty() || !is_letter(word.front()) || word == "true" || word == "false" || word == "inf" || word == "nan";
  return is_value ? "" : ": a text needs quotes: \"" + word + "\"";
}

// Returns what a text is that begins like a result in JSON or like a table of numbers; empty if it begins like neither.
std::string other_format_hint(std::string_view text, int line) {
  constexpr std::string_view k_blank = " \t\r\n";
  std::string_view first = text;
  for (auto at = first.find_first_not_of(k_blank); at != std::string_view::npos && first[at] == '#'; at = first.find_first_not_of(k_blank))
    first.remove_prefix(std::min(first.size(), first.find('\n', at)));
  const auto begin = first.find_first_not_of(k_blank);
  if (begin == std::string_view::npos) return "";
  if (first[begin] == '{') return ". It is JSON, not a model: `steplap show` takes the folder of a run, and its model.toml is the model";
  first = first.substr(begin, first.find('\n', begin) - begin);
  const bool is_table = first == line_at(text, line).substr(0, first.size()) && first.find('=') == std::string_view::npos &&
                        first.find_first_of(",;\t") != std::string_view::npos && first[0] != '[';
  return is_table
             ? ". It is a table of numbers, not a model: `steplap assess` reads recorders' files, and a signal of kind 'record' names one"
             : "";
}

} // namespace

Node parse_toml(const std::string& text, const std::string* file) {
  DottedKeys(text, *file).check();
  try {
    toml::table root = toml::parse(text, *file);
    return from_toml(root, file);
  } catch (const toml::parse_error& error) {
    const toml::source_region& region = error.source();
    const std::string_view line = line_at(text, line_of(region));
    const std::string of_number = number_hint(line, column_of(region));
    throw ModelError(Location{*file, line_of(region), column_of(region)},
                     "not valid TOML: " + std::string(error.description()) +
                         (of_number.empty() ? text_hint(line, column_of(region)) : of_number) + other_format_hint(text, line_of(region)));
  }
}

} // namespace steplap
