// Limit states without dynamics whose probability is known exactly: closed forms, or quadrature in double precision.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace steplap::testing {

struct KnownCase {
  const char* name;
  std::vector<std::string> variables; ///< what follows the name in a [[variable]]
  const char* g;
  double probability;
  double form_beta = 0.0; ///< of the nearest design point; 0: there is none to be found
  std::vector<std::string> methods;
};

inline std::string normal(double mean, double deviation) {
  return "distribution = \"normal\"\nmean = " + std::to_string(mean) + "\nstandard_deviation = " + std::to_string(deviation) + "\n";
}

inline std::string text_of_case(const KnownCase& c, const std::vector<std::string>& methods, const std::string& settings) {
  std::string text = "kind = \"reliability\"\n[reliability]\nmethods = [";
  for (const std::string& m : methods) text += "\"" + m + "\", ";
  text += "]\n" + settings;
  for (std::size_t i = 0; i < c.variables.size(); ++i) text += "[[variable]]\nname = \"x" + std::to_string(i + 1) + "\"\n" + c.variables[i];
  return text + "[[limit_state]]\nname = \"g\"\nexpression = \"" + c.g + "\"\n";
}

inline std::vector<KnownCase> known_cases() {
  const std::string standard = normal(0, 1);
  const std::vector<std::string> ten(10, standard), twenty(20, "distribution = \"exponential\"\nmean = 1\n");
  std::string series = "min(4.5 - x1"; // independent: 1 − Φ(4.5)^20
  for (int i = 2; i <= 20; ++i) series += ", 4.5 - x" + std::to_string(i);
  static const std::string twenty_in_series = series + ")";
  return {
      {"resistance and load",
       {normal(4, 1), normal(2, 1)},
       "x1 - x2",
       7.86496035e-2,
       std::sqrt(2.0),
       {"monte_carlo", "importance_sampling", "subset"}},
      {"axial beam",
       {"distribution = \"lognormal\"\nmean = 300\nstandard_deviation = 30\n", normal(75000, 5000)},
       "x1 - x2/(100*pi)",
       2.91982e-2,
       0.0,
       {"monte_carlo", "importance_sampling", "subset"}},
      {"RP22",
       {standard, standard},
       "2.5 - (x1 + x2)/sqrt(2) + 0.1*(x1 - x2)^2",
       4.207305e-3,
       2.5,
       {"monte_carlo", "importance_sampling", "subset"}},
      {"four branches",
       {standard, standard},
       "min(3 + 0.1*(x1-x2)^2 - (x1+x2)/sqrt(2), 3 + 0.1*(x1-x2)^2 + (x1+x2)/sqrt(2), x1 - x2 + 7/sqrt(2), x2 - x1 + "
       "7/sqrt(2))",
       2.222795e-3,
       3.0,
       {"importance_sampling", "subset"}},
      {"RP28", {normal(78064, 11710), normal(0.0104, 0.00156)}, "x1*x2 - 146.14", 1.4533e-7, 0.0, {"importance_sampling", "subset"}},
      {"RP54",
       twenty,
       "sum(x1,x2,x3,x4,x5,x6,x7,x8,x9,x10,x11,x12,x13,x14,x15,x16,x17,x18,x19,x20) - 8.951",
       9.90603e-4,
       0.0,
       {"monte_carlo", "subset"}},
      {"RP77", {normal(10, 0.5), standard, normal(4, 1)}, "x3 <= 5 ? x1 - x2 - x3 : x3 - x2", 2.69128e-7, 0.0, {"importance_sampling"}},
      {"RP89", {standard, standard}, "min(8 - x1^2 - x2, 6 - x1/5 - x2)", 5.4713e-3, 0.0, {"monte_carlo", "importance_sampling"}},
      {"RP107", ten, "5*sqrt(10) - sum(x1,x2,x3,x4,x5,x6,x7,x8,x9,x10)", 2.866516e-7, 5.0, {"importance_sampling", "subset"}},
      {"RP111", {standard, standard}, "12.5 - abs(x1*x2)", 8.035e-7, 5.0, {"importance_sampling"}},
      {"RP35",
       {standard, standard},
       "min(2 - x2 + exp(-0.1*x1^2) + (0.2*x1)^4, 4.5 - x1*x2)",
       3.478946321e-3, // by Simpson's rule over x1, cut where both branches meet
       0.0,
       {"importance_sampling", "subset"}},
      {"twenty in series", std::vector<std::string>(20, standard), twenty_in_series.c_str(), 6.795127e-5, 0.0, {"importance_sampling"}},
  };
}

} // namespace steplap::testing
