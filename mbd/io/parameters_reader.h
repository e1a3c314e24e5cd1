// [parameters] of a document, and the formulas of them that stand where a field wants a number: "= 2*wall + bore".
#pragma once

#include "mbd/io/document.h"
#include "mbd/io/units.h"
#include "mbd/model/model.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace steplap {

/// Does a value begin with '=', as formulas do?
[[nodiscard]] bool is_formula(const Node& node);

/// Reads the table, and formulas as they are met in fields.
class ParametersReader {
public:
  /// Reads [parameters] of `root`, if there is one. What is wrong is appended to `problems`.
  ParametersReader(const Node& root, std::vector<Diagnostic>& problems);

  /// What the formula in `node` gives, in a field's `unit` ("*": any). `problem` is what is wrong with it; where it needs a parameter
  /// that is wrong itself, which has been told, value and problem say nothing: see is_excused().
  [[nodiscard]] Quantity value(const Node& node, const std::string& unit);
  /// The same as text with its unit, for fields that take one: "0.024 m".
  [[nodiscard]] std::string text_of(const Node& node) const;
  /// Was the last formula left without a value because a parameter that it needs is wrong?
  [[nodiscard]] bool is_excused() const { return is_excused_; }

  /// All parameters, and what was found with value(): `root` is the document they were found in, `model` what was made of it.
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
  [[nodiscard]] std::array<double, 3> powers_of(const ParameterFormula& formula) const;
  [[nodiscard]] std::string turns_problem(const ParameterFormula& formula, const std::string& unit) const;
  void add(const Location& where, std::string message) { problems_.push_back({where, std::move(message)}); }

  std::vector<Diagnostic>& problems_;
  Parameters parameters_;
  std::unordered_map<std::string, std::size_t> by_name_; ///< of the entries
  enum class Turns { none, turns, radians };
  std::vector<Turns> turns_; ///< what an entry in 1/s counts, as its unit is written
  std::vector<bool> is_wrong_, is_resolved_;
  std::unordered_map<const Node*, Found> found_;
  bool is_excused_ = false;
};

} // namespace steplap
