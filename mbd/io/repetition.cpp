#include "mbd/io/repetition.h"

#include "mbd/base/limits.h"
#include "mbd/base/number_text.h"
#include "mbd/formula/formula.h"
#include "mbd/formula/renamed_formula.h"
#include "mbd/io/parameters_reader.h"
#include "mbd/model/formula_fields.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace steplap {

namespace {

const char* const k_index = "i";
constexpr std::size_t k_shown_name = 60; // bytes of a name in a message that is about its length

// Creates one copy of a repeated entry, in which the index i has a given value.
class RepeatedEntry {
public:
  RepeatedEntry(long index, std::vector<Diagnostic>& problems) : index_(index), text_(std::to_string(index)), problems_(problems) {}

  [[nodiscard]] Node entry(const Node& entry) {
    Node result = entry;
    result.erase("repeat");
    Node* const name = result.find("name");
    const bool is_named_by_index = name && name->text().find('{') != std::string::npos;
    for (Node& child : result.children) put_into(child);
    if (name && name->type == Node::Type::text && !is_named_by_index) name->scalar = name->text() + " " + text_;
    return result;
  }

private:
  void put_into(Node& node) {
    if (node.type == Node::Type::text) {
      const std::string text = node.text();
      if (is_formula(node)) node.scalar = in_formula(text, text.find('=') + 1);
      else node.scalar = is_formula_key(node.key) ? in_formula(with_numbered_names(text), 0) : in_text(text, node.where());
    }
    for (Node& child : node.children) put_into(child);
  }

  [[nodiscard]] std::string in_formula(const std::string& text, std::size_t begin) const {
    if (text.find(k_index, begin) == std::string::npos) return text;
    return text.substr(0, begin) + with_operands(text.substr(begin), [this](const std::string& name) {
             const bool is_plain = name.find_first_of(" {}[]") == std::string::npos;
             return name == k_index ? text_ : is_plain ? name : "{" + name + "}";
           });
  }

  // Replaces the index in braces by its number within names of a formula, such as {link {i+1}.x}. Other braces enclose names.
  [[nodiscard]] std::string with_numbered_names(std::string text) const {
    for (std::size_t close = text.find('}'); close != std::string::npos; close = text.find('}', close)) {
      const std::size_t open = text.rfind('{', close);
      const std::optional<std::string> number =
          open == std::string::npos ? std::nullopt : index_number(text.substr(open + 1, close - open - 1));
      if (!number) {
        ++close;
        continue;
      }
      text.replace(open, close + 1 - open, *number);
      close = open;
    }
    return text;
  }

  // Returns the value of a formula of the index as text; nothing if it is not a whole number.
  [[nodiscard]] std::optional<std::string> index_number(const std::string& inside) const {
    try {
      const Formula formula(inside, "", {});
      if (std::any_of(formula.names().begin(), formula.names().end(), [](const std::string& name) { return name != k_index; }))
        return std::nullopt;
      const std::vector<double> operands(formula.names().size(), static_cast<double>(index_));
      std::vector<double> nodes(formula.tree().size());
      const double value = value_of(formula.tree(), operands.data(), 0.0, nodes.data());
      if (!(std::abs(value) < 1e15) || std::nearbyint(value) != value) return std::nullopt;
      return std::to_string(static_cast<long>(value));
    } catch (const ModelError&) {
      return std::nullopt;
    }
  }

  [[nodiscard]] std::string in_text(const std::string& text, const Location& where) {
    std::string result;
    std::size_t done = 0;
    for (std::size_t open = text.find('{'); open != std::string::npos; open = text.find('{', done)) {
      const std::size_t close = text.find('}', open);
      if (close == std::string::npos) {
        problems_.push_back(
            {where, "'" + text + "' lacks a '}': braces in a repeated entry contain an expression of its index, as in \"link {i+1}\""});
        return text;
      }
      result += text.substr(done, open - done) + number(text.substr(open + 1, close - open - 1), where);
      done = close + 1;
    }
    return result + text.substr(done);
  }

  [[nodiscard]] std::string number(const std::string& inside, const Location& where) {
    const std::string subject = "'{" + inside + "}'";
    try {
      const Formula formula(inside, subject, where);
      for (const std::string& name : formula.names())
        if (name != k_index)
          throw ModelError(where, subject + ": in a name only the index i and numbers make a number, not '" + name + "'");
      const std::vector<double> operands(formula.names().size(), static_cast<double>(index_));
      std::vector<double> nodes(formula.tree().size());
      const double value = value_of(formula.tree(), operands.data(), 0.0, nodes.data());
      if (!(std::abs(value) < 1e15) || std::nearbyint(value) != value)
        throw ModelError(where, subject + " is " + number_text(value) + " where i is " + text_ + ": a name takes a whole number");
      return std::to_string(static_cast<long>(value));
    } catch (const ModelError& error) {
      problems_.push_back(error.diagnostics().front());
      return inside;
    }
  }

  long index_;
  std::string text_;
  std::vector<Diagnostic>& problems_;
};

// Returns the number of repetitions. Reports an error and returns nothing if the value is invalid.
std::optional<long> repeats(const Node& repeat, const std::string& subject, std::vector<Diagnostic>& problems) {
  const auto fail = [&](const std::string& message) {
    problems.push_back({repeat.where(), "'repeat' of " + subject + ": " + message});
    return std::nullopt;
  };
  if (repeat.type == Node::Type::text && is_formula(repeat))
    return fail("a formula cannot say how many there are, since parameters may change while a model is in use: write a number, which may "
                "be overridden for one run");
  if (repeat.type != Node::Type::integer) return fail(std::string("expected a whole number, got ") + repeat.type_name());
  const long count = std::get<long>(repeat.scalar);
  if (count < 0) return fail("expected a whole number, 0 or larger, got " + std::to_string(count));
  if (static_cast<std::size_t>(count) > k_most_entries)
    return fail(std::to_string(count) + " repetitions are more than the " + std::to_string(k_most_entries) +
                " entries that a model may have: is a digit too many?");
  return count;
}

// Returns the size of all texts of an entry, bytes.
std::size_t text_size(const Node& node) {
  std::size_t size = node.type == Node::Type::text ? node.text().size() : 0;
  for (const Node& child : node.children) size += text_size(child);
  return size;
}

} // namespace

const std::vector<std::string>& repeated_arrays() {
  static const std::vector<std::string> names = {"part", "body", "marker", "signal", "element", "action", "look"};
  return names;
}

void write_out_repetitions(Node& root, std::size_t& made, std::vector<Diagnostic>& problems) {
  for (const std::string& name : repeated_arrays()) {
    Node* const array = root.find(name);
    if (!array || !array->is_array_of_tables()) continue;
    if (std::none_of(array->children.begin(), array->children.end(), [](const Node& entry) { return entry.find("repeat"); })) continue;
    std::vector<Node> entries;
    for (Node& entry : array->children) {
      const Node* const repeat = entry.find("repeat");
      if (!repeat) {
        entries.push_back(std::move(entry));
        continue;
      }
      const std::string subject = entry_name(entry).empty() ? "the " + name : name + " '" + entry_name(entry) + "'";
      const std::optional<long> count = repeats(*repeat, subject, problems);
      if (!count) continue;
      if (made + static_cast<std::size_t>(*count) > k_most_entries) {
        problems.push_back({repeat->where(),
                            "'repeat' of " + subject + ": with it the model has more than " + std::to_string(k_most_entries) + " entries"});
        continue;
      }
      if (const std::size_t size = text_size(entry) * static_cast<std::size_t>(*count); size > k_most_repeated_text) {
        problems.push_back({repeat->where(), "'repeat' of " + subject.substr(0, k_shown_name) + ": its texts would have " +
                                                 std::to_string(size) + " bytes, more than the " + std::to_string(k_most_repeated_text) +
                                                 " that an entry may make: shorten its name"});
        continue;
      }
      made += static_cast<std::size_t>(*count);
      const std::size_t before = problems.size(), begin = entries.size();
      for (long i = 0; i < *count && problems.size() == before; ++i) entries.push_back(RepeatedEntry(i, problems).entry(entry));
      if (problems.size() != before) entries.resize(begin);
    }
    array->children = std::move(entries);
  }
}

} // namespace steplap
