#include "mbd/formula/formula_tree.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_none = std::numeric_limits<double>::quiet_NaN();

// Returns 1 for true and 0 for false; NaN if an operand of the comparison is NaN.
double truth(bool is_true, double a, double b = 0.0) { return std::isnan(a) || std::isnan(b) ? k_none : is_true ? 1.0 : 0.0; }

struct PlainNumbers {
  using Value = double;
  static double number(double a) { return a; }
  static double add(double a, double b) { return a + b; }
  static double subtract(double a, double b) { return a - b; }
  static double multiply(double a, double b) { return a * b; }
  static double divide(double a, double b) { return a / b; }
  static double power(double a, double b) { return std::isnan(a) || std::isnan(b) ? k_none : portable::pow(a, b); }
  static double negate(double a) { return -a; }
  static double abs(double a) { return std::abs(a); }
  static double sqrt(double a) { return std::sqrt(a); }
  static double hypot(double a, double b) { return std::isnan(a) || std::isnan(b) ? k_none : portable::hypot(a, b); }
  static double min(double a, double b) { return std::isnan(b) ? b : std::min(a, b); }
  static double max(double a, double b) { return std::isnan(b) ? b : std::max(a, b); }
  static double sin(double a) { return portable::sin(a); }
  static double cos(double a) { return portable::cos(a); }
  static double tan(double a) {
    const portable::SinCos both = portable::sin_cos(a);
    return both.sin / both.cos;
  }
  static double asin(double a) { return portable::atan2(a, std::sqrt((1.0 - a) * (1.0 + a))); }
  static double acos(double a) { return portable::atan2(std::sqrt((1.0 - a) * (1.0 + a)), a); }
  static double atan(double a) { return portable::atan2(a, 1.0); }
  static double atan2(double a, double b) { return portable::atan2(a, b); }
  static double exp(double a) { return portable::pow(std::numbers::e, a); }
  static double ln(double a) { return portable::log10(a) * std::numbers::ln10; }
  static double log10(double a) { return portable::log10(a); }
  static double less(double a, double b) { return truth(a < b, a, b); }
  static double less_or_equal(double a, double b) { return truth(a <= b, a, b); }
  static double equal(double a, double b) { return truth(a == b, a, b); }
  static double both(double a, double b) { return truth(a != 0.0 && b != 0.0, a, b); }
  static double either(double a, double b) { return truth(a != 0.0 || b != 0.0, a, b); }
  static double negation(double a) { return truth(a == 0.0, a); }
  static double choice(double a, double b, double c) { return std::isnan(a) ? a : a != 0.0 ? b : c; }
  static double finite(double a) { return std::isfinite(a) ? a : k_none; }
};

} // namespace

double value_of(const FormulaTree& tree, const double* operands, double t, double* values) {
  return PlainNumbers::finite(evaluate<PlainNumbers>(tree, operands, t, values));
}

} // namespace steplap
