// Formulas of a study file, by muParser: + - * / ^, comparisons, && ||, a ? b : c, and the usual functions.
#pragma once

#include "mbd/base/diagnostics.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap::study {

/// One thread's: make one for each.
class Expression {
public:
  /// `names`: what the formula may use. Throws ModelError at `where`, with the nearest name for an unknown one.
  Expression(const std::string& text, const std::vector<std::string>& names, const Location& where);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;
  ~Expression();

  /// `values`: of all names, in their order.
  [[nodiscard]] double operator()(const double* values) const;

private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

/// "" if a variable, a response or a limit state may be called that, else what is wrong.
[[nodiscard]] std::string name_problem(const std::string& name);

} // namespace steplap::study
