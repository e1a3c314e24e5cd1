// Taylor models of formulas hold what the formulas take, roundings included, and close in on it as spans become shorter.
#include "mbd/formula/enclosure.h"
#include "mbd/formula/formula.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <sstream>

using namespace steplap;
using steplap::random::RandomNumber;

namespace {

using Bounds = Enclosure<k_enclosure_degree>;
using Numbers = EnclosingNumbers<k_enclosure_degree>;

std::string exactly(double value) {
  std::ostringstream text;
  text.precision(17);
  text << "(" << value << ")";
  return text.str();
}

// A formula of x and y, as deep as said.
std::string random_formula(RandomNumber& random, int depth) {
  if (depth == 0) {
    const int leaf = random.below(3);
    return leaf == 0 ? "x" : leaf == 1 ? "y" : exactly(random.either(0.0, 3.0));
  }
  const std::string a = random_formula(random, depth - 1);
  const std::string b = random_formula(random, depth - 1);
  const std::vector<std::string> of_one = {"abs", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "exp", "ln", "log10"};
  const std::vector<std::string> of_two = {"hypot", "min", "max", "atan2"};
  const std::vector<std::string> between = {" + ", " - ", " * ", " / "};
  switch (random.below(8)) {
  case 0:
  case 1: return "(" + a + random.one_of(between) + b + ")";
  case 2:
  case 3: return random.one_of(of_one) + "(" + a + ")";
  case 4: return random.one_of(of_two) + "(" + a + ", " + b + ")";
  case 5: return "(" + a + ")^" + exactly(random.chance(0.5) ? random.below(7) - 3.0 : random.either(0.0, 3.0));
  case 6: return "(" + a + " < " + b + " || !(" + b + " != 1) ? " + a + " : " + random_formula(random, depth - 1) + ")";
  default: return "(" + a + ")^(" + b + ")";
  }
}

// Values of a formula of x and y.
class Tried {
public:
  explicit Tried(const std::string& text) : formula_(text, "test", {}), numbers_(formula_.tree().size()), models_(numbers_.size()) {}

  double at(double x, double y) {
    std::vector<double> operands;
    for (const std::string& name : formula_.names()) operands.push_back(name == "x" ? x : y);
    return value_of(formula_.tree(), operands.data(), 0.0, numbers_.data());
  }
  Bounds over(const Bounds& x, const Bounds& y) {
    std::vector<Bounds> operands;
    for (const std::string& name : formula_.names()) operands.push_back(name == "x" ? x : y);
    return evaluate<Numbers>(formula_.tree(), operands.data(), Bounds::of_number(0.0), models_.data());
  }

private:
  Formula formula_;
  std::vector<double> numbers_;
  std::vector<Bounds> models_;
};

// A curve over a span of this width, and the rounding of its own evaluation.
Bounds random_curve(RandomNumber& random, double width) {
  std::array<double, k_enclosure_degree + 1> c{};
  c[0] = random.either(0.0, 3.0);
  double power = width;
  for (int k = 1; k <= 3; ++k, power *= width) c[k] = random.either(0.0, 1.0) * power;
  return Bounds::of_polynomial(c, 2e-15);
}

} // namespace

TEST_CASE("an enclosure holds every value of random formulas") {
  RandomNumber random(7);
  int outside = 0, values = 0;
  for (int n = 0; n < 8000; ++n) {
    const std::string text = random_formula(random, 1 + n % 4);
    CAPTURE(text);
    Tried formula(text);
    const double width = random.decades(-6.0, 0.0);
    const Bounds x = random_curve(random, width), y = random_curve(random, width);
    const Bounds all = formula.over(x, y);
    for (int i = 0; i < 20; ++i) {
      const double u = i < 2 ? 2.0 * i - 1.0 : random.between(-1.0, 1.0);
      const double value = formula.at(x.polynomial(u), y.polynomial(u));
      ++values;
      if (std::isnan(value)) { // infinite, or none
        const bool says_so = all.is_partial || all.range.is_empty() || !all.range.is_bounded();
        outside += !says_so;
        CHECK(says_so);
        continue;
      }
      const bool is_inside =
          all.range.holds(value) && (!all.has_polynomial() || std::abs(value - all.polynomial(u)) <= all.rest * (1.0 + 1e-9));
      outside += !is_inside;
      CHECK(is_inside);
    }
    if (outside > 10) break; // enough to be read
  }
  CHECK(values > 100000);
}

TEST_CASE("bounds of what is smooth close in by a power of the span, of a kink with it") {
  const auto slack = [](const std::string& text, double width) { // of the range, beyond the values met
    Tried formula(text);
    std::array<double, k_enclosure_degree + 1> c{};
    c[0] = 0.3;
    c[1] = width;
    const Bounds x = Bounds::of_polynomial(c, 0.0), all = formula.over(x, x);
    double least = formula.at(0.3, 0.3), most = least;
    for (int i = 0; i <= 2000; ++i) {
      const double value = formula.at(0.3 + width * (i / 1000.0 - 1.0), 0.0);
      least = std::min(least, value);
      most = std::max(most, value);
    }
    return std::max(all.range.high - most, least - all.range.low);
  };
  for (const char* text : {"exp(-(x - 0.31)^2)", "1 / (1 + (x - 0.29)^2)", "sin(5 * x) * cos(x)", "sqrt(x) - ln(x)", "x^2.5 - x^-1.5",
                           "atan2(x, 1 - x)", "asin(x) * acos(x)", "hypot(x, 1)", "tan(x)"}) {
    CAPTURE(std::string(text));
    CHECK(slack(text, 1e-2) < slack(text, 1e-1) / 100.0 + 1e-13); // of roundings
  }
  // A difference of what is large and the same is not taken for large: 1e-13 is the rounding of its terms.
  CHECK(slack("(x + 100)^2 - x^2 - 200 * x - 10000", 1e-2) < 1e-10);
  CHECK(slack("abs(x - 0.3)", 1e-3) < 1e-15);
}
