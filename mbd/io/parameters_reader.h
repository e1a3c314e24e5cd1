// Reads [parameters] of a document, and evaluates formulas of parameters, "= 2*wall + bore", in other fields.
#pragma once

#include "mbd/io/document.h"
#include "mbd/io/units.h"
#include "mbd/model/model.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace steplap {

/// Returns true if the value is a text that begins with '='.
[[nodiscard]] bool is_formula(const Node& node);

/// Reads the table [parameters], and evaluates formulas as fields that contain them are read.
class ParametersReader {
public:
  /// Reads [parameters] of `root`, if there is one, and appends errors to `problems`.
  ParametersReader(const Node& root, std::vector<Diagnostic>& problems);

  /// Returns the value of the formula in `node` for a field with this `unit` ("*": any). On error `problem` of the result is set. If the
  /// formula uses a parameter whose error was reported already, `problem` stays empty and is_excused() becomes true.
  [[nodiscard]] Quantity value(const Node& node, const std::string& unit);
  /// Returns the value of a formula that value() evaluated, as text with its unit: "0.024 m". For fields that accept such a text.
  [[nodiscard]] std::string text_of(const Node& node) const;
  /// Returns true if the last formula has no value because a parameter in it is wrong, which was reported already.
  [[nodiscard]] bool is_excused() const { return is_excused_; }

  /// Returns all parameters, and the formulas that value() evaluated. `root` is their document, `model` the model read from it.
  [[nodiscard]] Parameters parameters(const Node& root, const Model& model) const;

private:
  struct Found {
    ParameterUse use;
    double value = 0.0;
  };

  void read_entry(const Node& entry);
  void read_value(const Node& node, Parameter& parameter, double& value);
  void read_range(const Node& range, Parameter& parameter);
  bool resolve(std::size_t index, std::vector<std::size_t>& chain);
  void check_ranges();
  [[nodiscard]] ParameterFormula formula_of(const std::string& text, const Location& where) const;
  [[nodiscard]] std::array<double, 3> dimension_exponents(const ParameterFormula& formula) const;
  [[nodiscard]] std::string turns_problem(const ParameterFormula& formula, const std::string& unit) const;
  void add(const Location& where, std::string message) { problems_.push_back({where, std::move(message)}); }

  std::vector<Diagnostic>& problems_;
  Parameters parameters_;
  std::unordered_map<std::string, std::size_t> by_name_; ///< index in entries, by name
  enum class AngleUnit { none, turns, radians };
  std::vector<AngleUnit> turns_; ///< for each entry with unit 1/s, whether its unit means turns or radians
  std::vector<bool> is_wrong_, is_resolved_;
  std::unordered_map<const Node*, Found> found_;
  bool is_excused_ = false;
};

} // namespace steplap
