// Evaluates formulas of a study file with muParser: + - * / ^, comparisons, && ||, a ? b : c, and the usual functions.
#pragma once

#include "mbd/base/diagnostics.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap::study {

/// A compiled formula. Not thread-safe: each thread needs its own.
class Expression {
public:
  /// `names` are the names that the formula may use. Throws ModelError at `where`, with the most similar name for an unknown one.
  Expression(const std::string& text, const std::vector<std::string>& names, const Location& where);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;
  ~Expression();

  /// Evaluates the formula. `values` has one entry per name, in their order.
  [[nodiscard]] double operator()(const double* values) const;

private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

/// Returns "" if the name is valid for a variable, response or limit state, otherwise the error.
[[nodiscard]] std::string name_problem(const std::string& name);

} // namespace steplap::study
