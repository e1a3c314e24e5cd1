// Checks units of signals. A signal may have any unit, but an element that uses it requires a certain one, that of its field: "" for a
// factor, "*" for any. The unit of a signal is known if a value is given as text with a unit, "0.5 gravity", or if the file of a record
// states it; a plain number does not determine the unit. A sum or a scaled signal has the unit of its parts, unless it has factors, which may
// change the unit. The unit of a product is unknown. A formula of parameters has the unit of its result.
#pragma once

#include "mbd/io/field_reader.h"
#include "mbd/model/model.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace steplap {

class SignalUnits {
public:
  /// `parameters` evaluates formulas and must outlive this object.
  explicit SignalUnits(const ParametersReader& parameters) : parameters_(parameters) {}
  /// Adds a signal. `entry` and `given` must not change afterwards.
  void enter(const SignalEntry& entry, const std::vector<GivenField>& given);
  /// Returns why `signal` cannot be used as a value in `unit`, as a message: "its signal 's' (line 7): …". Returns "" if it can, or if its
  /// unit is unknown.
  [[nodiscard]] std::string misfit(const std::string& signal, const std::string& unit) const;

private:
  struct GivenSignal {
    const SignalEntry* entry;
    const std::vector<GivenField>* given;
  };
  [[nodiscard]] std::string misfit(const std::string& signal, const std::string& unit, int depth) const;
  [[nodiscard]] std::string problem_of(const Node& node, const std::string& unit) const;
  const ParametersReader& parameters_;
  std::unordered_map<std::string, GivenSignal> signals_;
};

} // namespace steplap
