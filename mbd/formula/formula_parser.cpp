#include "mbd/formula/formula.h"

#include "mbd/base/number_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <initializer_list>
#include <numbers>

namespace steplap {

namespace {

struct Function {
  std::string_view name;
  FormulaOp op;
  int arguments;
  bool takes_more = false; ///< true: accepts more arguments than two, combined from the left
};

constexpr Function k_functions[] = {{"abs", FormulaOp::abs, 1},       {"sqrt", FormulaOp::sqrt, 1},     {"hypot", FormulaOp::hypot, 2},
                                    {"min", FormulaOp::min, 2, true}, {"max", FormulaOp::max, 2, true}, {"sin", FormulaOp::sin, 1},
                                    {"cos", FormulaOp::cos, 1},       {"tan", FormulaOp::tan, 1},       {"asin", FormulaOp::asin, 1},
                                    {"acos", FormulaOp::acos, 1},     {"atan", FormulaOp::atan, 1},     {"atan2", FormulaOp::atan2, 2},
                                    {"exp", FormulaOp::exp, 1},       {"ln", FormulaOp::ln, 1},         {"log10", FormulaOp::log10, 1}};

constexpr int k_deepest = 64; // largest nesting of brackets and signs; each level is a recursive call

} // namespace

// Recursive-descent parser. The function for each grammar rule returns the index of the node that it added.
class FormulaParser {
public:
  explicit FormulaParser(Formula& made) : made_(made), text_(made.text_) {}

  void run() {
    skip();
    if (at_ == text_.size()) fail("is empty");
    (void)choice();
    if (at_ < text_.size()) fail("has '" + character() + "' where an operator or its end should be");
  }

private:
  [[noreturn]] void fail(const std::string& message) const {
    throw ModelError(made_.where_, made_.subject_ + ": the expression '" + text_ + "' " + message);
  }

  // Returns the character at the current position with all bytes of its UTF-8 code.
  [[nodiscard]] std::string character() const {
    std::size_t end = at_ + 1;
    while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0U) == 0x80U) ++end;
    return text_.substr(at_, end - at_);
  }

  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }
  bool take(std::string_view sign) {
    if (text_.compare(at_, sign.size(), sign) != 0) return false;
    at_ += sign.size();
    skip();
    return true;
  }

  int add(FormulaOp op, std::size_t begin, std::initializer_list<int> of) {
    FormulaNode node;
    node.op = op;
    std::copy(of.begin(), of.end(), node.of.begin());
    return add(node, begin);
  }
  int add(FormulaNode node, std::size_t begin) {
    node.begin = begin;
    node.end = at_;
    made_.tree_.push_back(node);
    return static_cast<int>(made_.tree_.size()) - 1;
  }
  int add_number(double number, const std::array<double, 3>& powers, std::size_t begin) {
    FormulaNode node;
    node.number = number;
    node.powers = powers;
    return add(node, begin);
  }

  struct Nesting {
    explicit Nesting(FormulaParser& parser) : parser_(parser) {
      if (++parser_.nesting_ > k_deepest) parser_.fail("is too deep: define parts of it as channels of their own");
    }
    ~Nesting() { --parser_.nesting_; }
    FormulaParser& parser_;
  };

  int choice() {
    const Nesting nesting(*this);
    const std::size_t begin = at_;
    const int condition = either();
    if (!take("?")) return condition;
    const int yes = choice();
    if (!take(":")) fail("lacks the ':' that belongs to its '?'");
    const int no = choice();
    return add(FormulaOp::choice, begin, {condition, yes, no});
  }

  int either() {
    const std::size_t begin = at_;
    int value = both();
    while (take("||")) {
      const int other = both();
      value = add(FormulaOp::either, begin, {value, other});
    }
    return value;
  }

  int both() {
    const std::size_t begin = at_;
    int value = comparison();
    while (take("&&")) {
      const int other = comparison();
      value = add(FormulaOp::both, begin, {value, other});
    }
    return value;
  }

  int comparison() {
    const std::size_t begin = at_;
    const int a = sum();
    struct Sign {
      std::string_view text;
      FormulaOp op;
      bool is_turned, is_negated;
    };
    static constexpr Sign k_signs[] = {{"<=", FormulaOp::less_or_equal, false, false}, {">=", FormulaOp::less_or_equal, true, false},
                                       {"==", FormulaOp::equal, false, false},         {"!=", FormulaOp::equal, false, true},
                                       {"<", FormulaOp::less, false, false},           {">", FormulaOp::less, true, false}};
    for (const Sign& sign : k_signs) {
      if (!take(sign.text)) continue;
      const int b = sum();
      int value = sign.is_turned ? add(sign.op, begin, {b, a}) : add(sign.op, begin, {a, b});
      if (sign.is_negated) value = add(FormulaOp::negation, begin, {value});
      if (at_ < text_.size() && std::string_view("<>=!").find(text_[at_]) != std::string_view::npos)
        fail("compares three values in one: say 'a < b && b < c'");
      return value;
    }
    if (at_ < text_.size() && text_[at_] == '=') fail("has a single '=': equality is '=='");
    return a;
  }

  int sum() {
    const std::size_t begin = at_;
    int value = product();
    for (;;) {
      const FormulaOp op = take("+") ? FormulaOp::add : take("-") ? FormulaOp::subtract : FormulaOp::number;
      if (op == FormulaOp::number) return value;
      const int other = product();
      value = add(op, begin, {value, other});
    }
  }

  int product() {
    const std::size_t begin = at_;
    int value = signed_power();
    for (;;) {
      const FormulaOp op = take("*") ? FormulaOp::multiply : take("/") ? FormulaOp::divide : FormulaOp::number;
      if (op == FormulaOp::number) return value;
      const int other = signed_power();
      value = add(op, begin, {value, other});
    }
  }

  int signed_power() {
    const Nesting nesting(*this);
    const std::size_t begin = at_;
    if (take("-")) {
      const int value = signed_power();
      return add(FormulaOp::negate, begin, {value});
    }
    if (take("!")) {
      const int value = signed_power();
      return add(FormulaOp::negation, begin, {value});
    }
    if (take("+")) return signed_power();
    const int base = value();
    if (!take("^")) return base;
    const int exponent = signed_power(); // right-associative
    return add(FormulaOp::power, begin, {base, exponent});
  }

  int value() {
    if (at_ >= text_.size()) fail("ends where a value should be");
    const char c = text_[at_];
    const std::size_t begin = at_;
    if (take("(")) {
      const int inside = choice();
      if (!take(")")) fail("lacks a ')'");
      return inside;
    }
    if (c == '{') return in_braces();
    if (c == '\'') return quantity();
    if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.') {
      const double size = number(text_, at_);
      const int made = add_number(size, {}, begin);
      skip();
      return made;
    }
    if (std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_') return word();
    fail("has '" + character() + "' where a value should be");
  }

  double number(const std::string& text, std::size_t& at) const {
    double value = 0.0;
    const auto [rest, status] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    if (status != std::errc()) fail("has a number that cannot be read: '" + text.substr(at, 20) + "'");
    at = static_cast<std::size_t>(rest - text.data());
    return value;
  }

  // Parses a quantity such as '12 kN'.
  int quantity() {
    const std::size_t begin = at_, end = text_.find('\'', at_ + 1);
    if (end == std::string::npos) fail("lacks the second ' of a number with a unit");
    const std::string inside = text_.substr(at_ + 1, end - at_ - 1);
    std::size_t at = inside.find_first_not_of(' ');
    if (at == std::string::npos) fail("has nothing between ' and '");
    const bool is_negative = inside[at] == '-';
    if (is_negative) ++at;
    const double size = number(inside, at);
    std::string unit = inside.substr(std::min(inside.find_first_not_of(' ', at), inside.size()));
    if (unit.starts_with('/')) unit.insert(0, 1, '1'); // '3/s'
    const std::optional<UnitDimension> dimension = dimension_of(unit);
    if (!dimension)
      fail("has a unit that formulas do not know: '" + inside +
           "'; they know m s kg t N J W Pa bar rad deg min h gravity %, with prefixes, and products");
    at_ = end + 1;
    skip();
    return add_number((is_negative ? -size : size) * dimension->factor, dimension->powers, begin);
  }

  int in_braces() {
    const std::size_t begin = at_;
    int open = 0;
    std::size_t end = at_;
    for (; end < text_.size(); ++end) {
      if (text_[end] == '{') ++open;
      if (text_[end] == '}' && --open == 0) break;
    }
    if (end == text_.size()) fail("lacks a '}'");
    const std::string name = text_.substr(at_ + 1, end - at_ - 1);
    if (name.find_first_not_of(' ') == std::string::npos) fail("has no name between { and }");
    at_ = end + 1;
    skip();
    return operand(name, begin);
  }

  int operand(const std::string& name, std::size_t begin) {
    auto& names = made_.names_;
    const auto found = std::find(names.begin(), names.end(), name);
    FormulaNode node;
    node.op = FormulaOp::operand;
    node.operand = static_cast<int>(found - names.begin());
    if (found == names.end()) names.push_back(name);
    return add(node, begin);
  }

  int word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_' || text_[at_] == '.'))
      ++at_;
    const std::string word = text_.substr(begin, at_ - begin);
    skip();
    if (at_ < text_.size() && text_[at_] == '(') return call(word, begin);
    if (word == "pi") return add_number(std::numbers::pi, {}, begin);
    if (word == "t") return add(FormulaOp::time, begin, {});
    return operand(word, begin);
  }

  int call(const std::string& word, std::size_t begin) {
    const auto* const function =
        std::find_if(std::begin(k_functions), std::end(k_functions), [&](const Function& f) { return f.name == word; });
    if (function == std::end(k_functions)) {
      std::vector<std::string> known;
      for (const Function& f : k_functions) known.emplace_back(f.name);
      fail("calls '" + word + "', which is no function" + did_you_mean(word, known));
    }
    (void)take("(");
    const int first = choice();
    if (function->arguments == 1) {
      close_call(*function);
      return add(function->op, begin, {first});
    }
    if (!take(",")) fail("gives '" + word + "' too few values: it takes " + count_of(*function));
    const int second = choice();
    int value = -1;
    if (!function->takes_more) {
      close_call(*function);
      return add(function->op, begin, {first, second});
    }
    value = add(function->op, begin, {first, second});
    while (take(",")) {
      const int next = choice();
      value = add(function->op, begin, {value, next});
    }
    close_call(*function);
    return value;
  }

  void close_call(const Function& function) {
    if (take(")")) return;
    fail("lacks a ')' after what '" + std::string(function.name) + "' takes (" + count_of(function) + ")");
  }

  // Returns how many values the function takes: "2", or "2 or more".
  static std::string count_of(const Function& function) {
    return std::to_string(function.arguments) + (function.takes_more ? " or more" : "");
  }

  Formula& made_;
  const std::string& text_;
  std::size_t at_ = 0;
  int nesting_ = 0;
};

Formula::Formula(const std::string& text, const std::string& subject, const Location& where)
    : text_(text), subject_(subject), where_(where) {
  FormulaParser(*this).run();
}

} // namespace steplap
