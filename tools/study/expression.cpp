#include "tools/study/expression.h"

#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>

namespace steplap::study {

namespace {

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  const mu::Parser parser; // a named object, because the loop refers to its data
  for (const auto& [name, function] : parser.GetFunDef()) names.push_back(name);
  return names;
}

// Returns true if the text contains a '=' that is not part of a comparison.
bool has_assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') ++i;
    else if (i == 0 || std::string("<>!").find(text[i - 1]) == std::string::npos) return true;
  }
  return false;
}

} // namespace

struct Expression::Parser {
  struct Used {
    std::size_t index;
    double value;
  };
  mu::Parser parser;
  std::vector<std::unique_ptr<Used>> used; // the parser stores pointers to these
};

Expression::Expression(const std::string& text, const std::vector<std::string>& names, const Location& where)
    : parser_(std::make_unique<Parser>()) {
  mu::Parser& parser = parser_->parser;
  if (has_assignment(text))
    throw ModelError(where, "the expression '" + text + "' assigns with '=': variables and responses are what they are; equality is '=='");
  try {
    parser.DefineConst("pi", std::numbers::pi);
    std::vector<double> all(names.size(), 1.0);
    for (std::size_t i = 0; i < names.size(); ++i) parser.DefineVar(names[i], &all[i]);
    parser.SetExpr(text);
    (void)parser.Eval();
    if (parser.GetNumResults() != 1) throw ModelError(where, "'" + text + "' is more than one expression");
    const auto found = parser.GetUsedVar();
    parser.ClearVar();
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!found.contains(names[i])) continue;
      parser_->used.push_back(std::make_unique<Parser::Used>(Parser::Used{i, 0.0}));
      parser.DefineVar(names[i], &parser_->used.back()->value);
    }
    parser.SetExpr(text);
    (void)parser.Eval();
  } catch (const mu::ParserError& error) {
    std::string hint;
    if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN) {
      std::vector<std::string> known = names;
      const std::vector<std::string> functions = function_names();
      known.insert(known.end(), functions.begin(), functions.end());
      hint = did_you_mean(error.GetToken(), known);
      throw ModelError(where, "'" + error.GetToken() + "' in the expression '" + text + "' is not known" + hint);
    }
    throw ModelError(where, "the expression '" + text + "' is wrong: " + error.GetMsg());
  }
}

Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::~Expression() = default;

double Expression::operator()(const double* values) const {
  bool is_known = true; // the parser's min, max and comparisons would choose a known value beside an unknown one
  for (const auto& used : parser_->used) {
    used->value = values[used->index];
    is_known = is_known && !std::isnan(used->value);
  }
  return is_known ? parser_->parser.Eval() : std::numeric_limits<double>::quiet_NaN();
}

std::string name_problem(const std::string& name) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  const auto is_fit = [&](char c) { return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0; };
  if (name.empty() || !is_letter(name.front()) || !std::all_of(name.begin(), name.end(), is_fit))
    return "must begin with a letter and hold letters, digits and _ only: expressions use it";
  static const std::vector<std::string> functions = function_names();
  if (name == "pi" || std::find(functions.begin(), functions.end(), name) != functions.end()) return "is taken by expressions";
  return "";
}

} // namespace steplap::study
