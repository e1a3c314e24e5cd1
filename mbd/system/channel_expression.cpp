#include "mbd/system/channel_expression.h"

#include "mbd/base/number_text.h"
#include "mbd/math/portable_math.h"

#include <algorithm>
#include <charconv>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>

namespace steplap {

struct ChannelExpression::Typed {
  std::array<double, 3> powers{};
  bool is_any = false;      ///< zero: of whatever it is added to
  bool is_constant = false; ///< its value is known
  double value = 0.0;
};

const std::vector<ChannelExpression::Function>& ChannelExpression::functions() {
  static const std::vector<Function> list = {
      {"abs", Code::abs, 1},   {"sqrt", Code::sqrt, 1}, {"hypot", Code::hypot, 2}, {"min", Code::min, 2},   {"max", Code::max, 2},
      {"sin", Code::sin, 1},   {"cos", Code::cos, 1},   {"tan", Code::tan, 1},     {"asin", Code::asin, 1}, {"acos", Code::acos, 1},
      {"atan", Code::atan, 1}, {"atan2", Code::atan2, 2}, {"exp", Code::exp, 1},   {"ln", Code::ln, 1},     {"log10", Code::log10, 1}};
  return list;
}

// Recursive descent; leaves the operations of a stack machine.
class ExpressionParser {
public:
  using Code = ChannelExpression::Code;
  explicit ExpressionParser(ChannelExpression& made) : made_(made), text_(made.text_) {}

  void run() {
    skip();
    if (at_ == text_.size()) fail("is empty");
    sum();
    if (at_ < text_.size()) fail("has '" + character() + "' where an operator or its end should be");
  }

private:
  [[noreturn]] void fail(const std::string& message) const {
    throw ModelError(made_.where_, made_.subject_ + ": the expression '" + text_ + "' " + message);
  }

  // All of its bytes.
  [[nodiscard]] std::string character() const {
    std::size_t end = at_ + 1;
    while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0U) == 0x80U) ++end;
    return text_.substr(at_, end - at_);
  }

  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }
  bool take(char c) {
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    skip();
    return true;
  }

  // The stack's depth rises by one with a value and falls by one with an operation on two.
  void add(ChannelExpression::Op op, std::size_t begin, int depth_change) {
    op.begin = begin;
    op.end = at_;
    depth_ += depth_change;
    if (depth_ > ChannelExpression::k_deepest) fail("is too deep: define parts of it as channels of their own");
    made_.ops_.push_back(op);
  }

  struct Nesting {
    explicit Nesting(ExpressionParser& parser) : parser_(parser) {
      if (++parser_.nesting_ > ChannelExpression::k_deepest) parser_.fail("is too deep: define parts of it as channels of their own");
    }
    ~Nesting() { --parser_.nesting_; }
    ExpressionParser& parser_;
  };

  void sum() {
    const Nesting nesting(*this);
    const std::size_t begin = at_;
    product();
    for (;;) {
      if (take('+')) {
        product();
        add({Code::add}, begin, -1);
      } else if (take('-')) {
        product();
        add({Code::subtract}, begin, -1);
      } else return;
    }
  }

  void product() {
    const std::size_t begin = at_;
    signed_power();
    for (;;) {
      if (take('*')) {
        signed_power();
        add({Code::multiply}, begin, -1);
      } else if (take('/')) {
        signed_power();
        add({Code::divide}, begin, -1);
      } else return;
    }
  }

  void signed_power() {
    const Nesting nesting(*this);
    const std::size_t begin = at_;
    if (take('-')) {
      signed_power();
      add({Code::negate}, begin, 0);
      return;
    }
    if (take('+')) return signed_power();
    value();
    if (take('^')) { // from the right, as written
      signed_power();
      add({Code::power}, begin, -1);
    }
  }

  void value() {
    if (at_ >= text_.size()) fail("ends where a value should be");
    const char c = text_[at_];
    const std::size_t begin = at_;
    if (take('(')) {
      sum();
      if (!take(')')) fail("lacks a ')'");
    } else if (c == '{') {
      in_braces();
    } else if (c == '\'') {
      quantity();
    } else if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.') {
      add({Code::number, number(text_, at_), 0, {}}, begin, 1);
      skip();
    } else if (std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_') {
      word();
    } else {
      fail("has '" + character() + "' where a value should be");
    }
  }

  double number(const std::string& text, std::size_t& at) const {
    double value = 0.0;
    const auto [rest, status] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    if (status != std::errc()) fail("has a number that cannot be read: '" + text.substr(at, 20) + "'");
    at = static_cast<std::size_t>(rest - text.data());
    return value;
  }

  // '12 kN'
  void quantity() {
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
      fail("has a unit that formulas do not know: '" + inside + "'; they know m s kg t N J W Pa bar rad deg min h gravity %, with prefixes, and products");
    at_ = end + 1;
    skip();
    add({Code::number, (is_negative ? -size : size) * dimension->factor, 0, dimension->powers}, begin, 1);
  }

  void in_braces() {
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
    operand(name, begin);
  }

  void operand(const std::string& name, std::size_t begin) {
    auto& names = made_.names_;
    const auto found = std::find(names.begin(), names.end(), name);
    ChannelExpression::Op op{Code::operand};
    op.operand = static_cast<int>(found - names.begin());
    if (found == names.end()) names.push_back(name);
    add(op, begin, 1);
  }

  void word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_' || text_[at_] == '.')) ++at_;
    const std::string word = text_.substr(begin, at_ - begin);
    skip();
    if (at_ < text_.size() && text_[at_] == '(') return call(word, begin);
    if (word == "pi") return add({Code::number, std::numbers::pi, 0, {}}, begin, 1);
    if (word == "t") return add({Code::time}, begin, 1);
    operand(word, begin);
  }

  void call(const std::string& word, std::size_t begin) {
    const auto& list = ChannelExpression::functions();
    const auto function = std::find_if(list.begin(), list.end(), [&](const auto& f) { return f.name == word; });
    if (function == list.end()) {
      std::vector<std::string> known;
      for (const auto& f : list) known.emplace_back(f.name);
      fail("calls '" + word + "', which is no function" + did_you_mean(word, known));
    }
    (void)take('(');
    for (int i = 0; i < function->arguments; ++i) {
      if (i > 0 && !take(',')) fail("gives '" + word + "' too few values: it takes " + std::to_string(function->arguments));
      sum();
    }
    if (!take(')')) fail("lacks a ')' after what '" + word + "' takes (" + std::to_string(function->arguments) + ")");
    add({function->code}, begin, 1 - function->arguments);
  }

  ChannelExpression& made_;
  const std::string& text_;
  std::size_t at_ = 0;
  int depth_ = 0, nesting_ = 0;
};

ChannelExpression::ChannelExpression(const std::string& text, const std::string& subject, const Location& where)
    : text_(text), subject_(subject), where_(where) {
  ExpressionParser(*this).run();
}

// --- units ----------------------------------------------------------------------------------------

namespace {

std::string said(const std::array<double, 3>& powers) {
  const std::string unit = unit_text(powers);
  return unit.empty() ? "no unit" : "the unit " + unit;
}

double raised(double base, double exponent) { return portable::pow(base, exponent); }

} // namespace

void ChannelExpression::fail(const Op& at, const std::string& message) const {
  throw ModelError(where_, subject_ + ": in '" + text_.substr(at.begin, at.end - at.begin) + "' " + message);
}

void ChannelExpression::same(const Op& op, const Typed& a, const Typed& b) const {
  if (a.is_any || b.is_any || a.powers == b.powers) return;
  std::string hint;
  if (a.is_constant != b.is_constant) { // a number that lacks its unit
    const Typed& other = a.is_constant ? b : a;
    const Typed& bare = a.is_constant ? a : b;
    if (bare.powers == std::array<double, 3>{}) hint = "; write it with its unit, '" + number_text(bare.value) + " " + unit_text(other.powers) + "'";
  }
  fail(op, "one side has " + said(a.powers) + ", the other " + said(b.powers) + hint);
}

void ChannelExpression::derive(const Op& op, std::vector<Typed>& stack) const {
  const bool is_binary = op.code == Code::add || op.code == Code::subtract || op.code == Code::multiply || op.code == Code::divide ||
                         op.code == Code::power || op.code == Code::hypot || op.code == Code::min || op.code == Code::max || op.code == Code::atan2;
  Typed b;
  if (is_binary) {
    b = stack.back();
    stack.pop_back();
  }
  Typed& a = stack.back();
  switch (op.code) {
  case Code::add:
  case Code::subtract:
  case Code::hypot:
  case Code::min:
  case Code::max:
  case Code::atan2:
    same(op, a, b);
    if (a.is_any) a.powers = b.powers;
    a.is_any = a.is_any && b.is_any;
    a.is_constant = false;
    if (op.code == Code::atan2) a = {};
    return;
  case Code::multiply:
  case Code::divide:
    for (std::size_t k = 0; k < 3; ++k) a.powers[k] += op.code == Code::divide ? -b.powers[k] : b.powers[k];
    a.is_any = a.is_any && op.code == Code::divide;
    if (a.is_constant && b.is_constant) a.value = op.code == Code::divide ? a.value / b.value : a.value * b.value;
    else a.is_constant = false;
    return;
  case Code::power:
    if (b.powers != std::array<double, 3>{}) fail(op, "the exponent has " + said(b.powers));
    if (a.powers != std::array<double, 3>{} && !b.is_constant) fail(op, "what has a unit takes a number as its exponent");
    for (double& power : a.powers)
      if (power != 0.0) power *= b.value;
    a.is_constant = a.is_any = false;
    return;
  case Code::negate:
    a.value = -a.value;
    return;
  case Code::abs:
    a.is_constant = false;
    return;
  case Code::sqrt:
    for (double& power : a.powers) power *= 0.5;
    a.is_constant = false;
    return;
  default: // functions of numbers
    if (a.powers != std::array<double, 3>{}) fail(op, "the function takes what has no unit, not " + said(a.powers) + ": divide by some '1 …' first");
    a = {};
  }
}

UnitDimension ChannelExpression::dimension(const std::vector<std::string>& units) const {
  std::vector<Typed> stack;
  for (const Op& op : ops_) {
    Typed value;
    if (op.code == Code::number) {
      value.powers = op.powers;
      value.value = op.number;
      value.is_constant = true;
      value.is_any = op.number == 0.0;
    } else if (op.code == Code::time) {
      value.powers = {0.0, 0.0, 1.0};
    } else if (op.code == Code::operand) {
      const std::string& unit = units[static_cast<std::size_t>(op.operand)];
      const std::optional<UnitDimension> known = dimension_of(unit);
      if (!known) fail(op, "the unit '" + unit + "' of the channel is not known to formulas");
      value.powers = known->powers;
    } else {
      derive(op, stack);
      continue;
    }
    stack.push_back(value);
  }
  return {1.0, stack.back().powers};
}

// --- values ---------------------------------------------------------------------------------------

double ChannelExpression::value(const double* operands, double t) const {
  std::array<double, k_deepest + 1> stack; // NOLINT: filled before it is read
  std::size_t top = 0;
  for (const Op& op : ops_) {
    double& a = stack[top > 0 ? top - 1 : 0];
    switch (op.code) {
    case Code::number: stack[top++] = op.number; break;
    case Code::operand: stack[top++] = operands[op.operand]; break;
    case Code::time: stack[top++] = t; break;
    case Code::add: stack[top - 2] += a; --top; break;
    case Code::subtract: stack[top - 2] -= a; --top; break;
    case Code::multiply: stack[top - 2] *= a; --top; break;
    case Code::divide: stack[top - 2] /= a; --top; break;
    case Code::power: stack[top - 2] = raised(stack[top - 2], a); --top; break;
    case Code::hypot: stack[top - 2] = portable::hypot(stack[top - 2], a); --top; break;
    case Code::min: stack[top - 2] = std::isnan(a) ? a : std::min(stack[top - 2], a); --top; break;
    case Code::max: stack[top - 2] = std::isnan(a) ? a : std::max(stack[top - 2], a); --top; break;
    case Code::atan2: stack[top - 2] = portable::atan2(stack[top - 2], a); --top; break;
    case Code::negate: a = -a; break;
    case Code::abs: a = std::abs(a); break;
    case Code::sqrt: a = std::sqrt(a); break;
    case Code::sin: a = portable::sin(a); break;
    case Code::cos: a = portable::cos(a); break;
    case Code::tan: {
      const portable::SinCos both = portable::sin_cos(a);
      a = both.sin / both.cos;
      break;
    }
    case Code::asin: a = portable::atan2(a, std::sqrt((1.0 - a) * (1.0 + a))); break;
    case Code::acos: a = portable::atan2(std::sqrt((1.0 - a) * (1.0 + a)), a); break;
    case Code::atan: a = portable::atan2(a, 1.0); break;
    case Code::exp: a = raised(std::numbers::e, a); break;
    case Code::ln: a = portable::log10(a) * std::numbers::ln10; break;
    case Code::log10: a = portable::log10(a); break;
    }
  }
  return std::isfinite(stack[0]) ? stack[0] : std::numeric_limits<double>::quiet_NaN();
}

} // namespace steplap
