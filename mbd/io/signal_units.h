// Signals are of any unit, what elements take them for is of one: whether the units that a file writes fit.
//
// Known is what stands as text with a unit, "0.5 gravity"; a plain number says nothing. A sum and a scaled signal are
// of their parts' unit where no factor may have changed it, a product is of none that is known. A formula of parameters is of the
// unit that it gives.
#pragma once

#include "mbd/io/field_reader.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace steplap {

class SignalUnits {
public:
  /// `parameters` gives formulas their values, and has to outlive it.
  explicit SignalUnits(const ParametersReader& parameters) : parameters_(parameters) {}
  /// `given` has to stay as it is.
  void enter(const std::string& signal, const std::string& kind, const std::vector<GivenField>& given);
  /// What is wrong with `signal` as a value in `unit`: "its signal 's' (line 7): …"; "" if nothing is known to be.
  [[nodiscard]] std::string misfit(const std::string& signal, const std::string& unit) const;

private:
  struct Entry {
    std::string kind;
    const std::vector<GivenField>* given;
  };
  [[nodiscard]] std::string misfit(const std::string& signal, const std::string& unit, int depth) const;
  [[nodiscard]] std::string problem_of(const Node& node, const std::string& unit) const;
  const ParametersReader& parameters_;
  std::unordered_map<std::string, Entry> signals_;
};

} // namespace steplap
