// Checks units of signals against the fields that use them (mbd/model/signal_use.h): "" for a factor, "*" for any. The unit of a signal is
// known if a value is given as text with a unit, "0.5 gravity", or if the file of a record states it; a plain number does not determine the
// unit. A formula of parameters has the unit of its result.
#pragma once

#include "mbd/io/field_reader.h"
#include "mbd/model/model.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace steplap {

class SignalUnits {
public:
  /// `parameters` evaluates formulas; it and the signals of `model` must outlive this object.
  SignalUnits(const Model& model, const ParametersReader& parameters) : model_(model), parameters_(parameters) {}
  /// Adds what the file gives of a signal. `given` must not change afterwards.
  void enter(const SignalEntry& entry, const std::vector<GivenField>& given) { given_[&entry] = &given; }
  /// Returns why `signal` cannot be used as a value in `unit`, as a message: "its signal 's' (line 7): …". Returns "" if it can, or if its
  /// unit is unknown.
  [[nodiscard]] std::string misfit(const std::string& signal, const std::string& unit) const;

private:
  [[nodiscard]] std::string problem_of(const Node& node, const std::string& unit) const;
  [[nodiscard]] std::string misfit_of(const SignalEntry& entry, const std::string& unit) const;
  const Model& model_;
  const ParametersReader& parameters_;
  std::unordered_map<const SignalEntry*, const std::vector<GivenField>*> given_;
};

} // namespace steplap
