// Table [parameters] of a model: named numbers, and field values that are formulas of them.
//
//   [parameters]
//   wall = "12 mm"
//   bore = { value = "80 mm", range = ["60 mm", "100 mm"], meaning = "inner width" }
//   width = "= 2*wall + bore"
//
//   [[body]]
//   mass = "= '7850 kg/m^3' * width^2 * '1 m'"
//
// The formula language is that of channels (mbd/formula/formula.h), with parameters as names. Values are in SI units. A parameter given as
// a formula depends on others; all other parameters are free and may be changed.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/formula/formula.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// A formula whose names are parameters.
struct ParameterFormula {
  Formula formula;             ///< its names() are parameters
  std::vector<std::size_t> of; ///< indices into Parameters::entries of names(), in the same order

  /// Returns the result of the formula in SI units, given the values of all parameters; NaN if there is no finite result.
  [[nodiscard]] double value(const std::vector<double>& values) const;
};

/// One named number.
struct Parameter {
  std::string name;                        ///< letters, digits and _
  std::string text;                        ///< as given: "12 mm", "= 2*wall + bore"
  std::array<double, 3> powers{};          ///< exponents of kg, m and s in its unit
  std::optional<ParameterFormula> formula; ///< formula that gives its value; nothing for a free parameter
  std::optional<double> least, most;       ///< range of sensible values, SI
  std::string meaning;                     ///< one line; may be empty
  Location where;                          ///< location of the value in the model file
};

/// A field whose value is a formula of parameters.
struct ParameterUse {
  std::string path;         ///< path of the field (model_path.h)
  std::string text;         ///< the formula as given
  std::string unit;         ///< SI unit of the result
  ParameterFormula formula; ///< formula with result in SI
  Location where;           ///< in the model's file
  bool can_be_set = true;   ///< false if no path leads to the target, such as a point of a ring
};

/// All parameters of a model with their values, and the fields that use them.
struct Parameters {
  std::vector<Parameter> entries; ///< in the order of the file
  std::vector<double> values;     ///< values of the entries, SI
  std::vector<std::size_t> order; ///< indices of the entries that are formulas; each comes after those on which it depends
  std::vector<ParameterUse> uses; ///< fields that use parameters, in the order of the file

  /// Returns the index of the parameter in `entries`, or nothing.
  [[nodiscard]] std::optional<std::size_t> find(const std::string& name) const;
  /// Returns true if the formula depends on the parameter, directly or through other parameters.
  [[nodiscard]] bool needs(const ParameterFormula& formula, std::size_t parameter) const;
  /// Recomputes the values of all parameters that are formulas.
  void evaluate();
};

/// Returns the reason why the parameter cannot have this value (not finite, or outside its range); "" if it can.
[[nodiscard]] std::string problem_with(const Parameter& parameter, double value);

} // namespace steplap
