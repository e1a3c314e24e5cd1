// Units of signals. A signal may have any unit; the field of an element or table that names it takes a certain one. A sum or a scaled signal
// has the unit of its parts, unless it has factors, which may change the unit. The unit of a product says nothing about its parts.
#pragma once

#include "mbd/model/model.h"

#include <functional>

namespace steplap {

/// Returns true if the field of a combining signal holds factors of its parts.
[[nodiscard]] bool is_factor(const Field& field);
/// Returns true if the values in `field` of a signal of this kind have the signal's unit.
[[nodiscard]] bool is_in_unit_of_signal(const SignalKind& kind, const Field& field);
/// Returns the signal and all others whose values have its unit: its parts, their parts, and so on. `has_factors` says which signals have
/// factors. Empty if there is no such signal.
[[nodiscard]] std::vector<const SignalEntry*> signals_in_unit_of(const Model& model, const std::string& signal,
                                                                 const std::function<bool(const SignalEntry&)>& has_factors);
/// Returns the unit in which elements and tables take the values of `signal`, directly or as part of another signal: "" for a factor or for
/// several units, of which only a number without a unit can be all; "*" if none is known. A factor of 1 keeps the unit.
[[nodiscard]] std::string unit_taken(const Model& model, const std::string& signal);

} // namespace steplap
