// [parameters] of a model: numbers with a name, and formulas of them in its fields.
//
//   [parameters]
//   wall = "12 mm"
//   bore = { value = "80 mm", range = ["60 mm", "100 mm"], meaning = "inner width" }
//   width = "= 2*wall + bore"
//
//   [[body]]
//   mass = "= '7850 kg/m^3' * width^2 * '1 m'"
//
// The language is that of channels (mbd/formula/formula.h); names are those of parameters. Values are in SI. A parameter that is
// given as a formula follows from others; the others are free, and a model may be given other values of them.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/formula/formula.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// A formula of parameters.
struct ParameterFormula {
  Formula formula;             ///< its names() are parameters
  std::vector<std::size_t> of; ///< these parameters, as indices into Parameters::entries, in the order of names()

  /// In SI, from the values of all parameters. Not-a-number where there is no finite value.
  [[nodiscard]] double value(const std::vector<double>& values) const;
};

/// One named number.
struct Parameter {
  std::string name;                        ///< letters, digits and _
  std::string text;                        ///< as given: "12 mm", "= 2*wall + bore"
  std::array<double, 3> powers{};          ///< of kg, m and s in its unit
  std::optional<ParameterFormula> formula; ///< what it follows from; nothing of a free one
  std::optional<double> least, most;       ///< SI, the range that makes sense
  std::string meaning;                     ///< one line; may be empty
  Location where;                          ///< of its value, in the model's file
};

/// A field that a formula of parameters gives.
struct ParameterUse {
  std::string path;         ///< of the field (model_path.h)
  std::string text;         ///< the formula as given
  std::string unit;         ///< SI unit of what it gives
  ParameterFormula formula; ///< in SI
  Location where;           ///< in the model's file
  bool can_be_set = true;   ///< false: the path leads to what has no path of a number, such as a ring of points
};

/// All parameters of a model with their values, and where they are used.
struct Parameters {
  std::vector<Parameter> entries; ///< in the order of the file
  std::vector<double> values;     ///< of the entries, SI
  std::vector<std::size_t> order; ///< of the entries that are formulas: each after those that it needs
  std::vector<ParameterUse> uses; ///< in the order of the file

  /// Its index, or nothing.
  [[nodiscard]] std::optional<std::size_t> find(const std::string& name) const;
  /// Does the formula need that parameter, itself or through other parameters?
  [[nodiscard]] bool needs(const ParameterFormula& formula, std::size_t parameter) const;
  /// Finds all values that follow from others.
  void evaluate();
};

/// Why the parameter cannot have this value, "" if it can: it is not finite, or out of its range.
[[nodiscard]] std::string problem_with(const Parameter& parameter, double value);

} // namespace steplap
