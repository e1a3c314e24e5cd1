// Records one evaluation of a layout with fixed modes on a tape (mbd/tape).
//
// The templates that evaluate doubles are executed once with recorded numbers, so the equations exist only once. Elements without templates
// are recorded as calls (element_call.h). Functions of time alone (drives) are inputs of the tape. Not recorded are reactions, except
// wrenches of merged joints that may slip, and the treatment of singular positions, near which the tape is invalid.
#pragma once

#include "mbd/dynamics/element_call.h"
#include "mbd/dynamics/layout.h"
#include "mbd/tape/tape.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace steplap {

/// A recorded evaluation, and the meaning of its inputs and outputs.
struct TracedRates {
  /// Inputs: coordinates and rates, inner states, time-dependent numbers of the layout, values of signals. Outputs: accelerations, rates of
  /// inner states, dissipated power, power of loads, event functions and their rates; then, for event functions of merged joints and for
  /// the end of a step, wrenches, and each pivot with its diagonal element. Compiled code reads coordinates, rates and inner states
  /// directly from the state, and writes rates, event functions (array k_event_count) and their rates (k_event_derivatives) directly to
  /// their arrays.
  Tape tape;
  static constexpr std::int32_t k_event_count = 1, k_event_derivatives = 2, k_rest = 3; ///< arrays of outputs (Tape::places)
  std::vector<SignalInput> signals;
  std::vector<int> event_values;      ///< indices of the event functions
  std::vector<int> event_derivatives; ///< indices of the event functions whose rate is not constant
  bool has_wrenches = false;          ///< false: event functions of merged joints cannot be computed from the outputs
  std::vector<int> wrenches;          ///< indices in Snapshot::friction_force of merged joints that can slip
  std::vector<int> pivots;            ///< number of pivots of the rows between absolute clusters, then of each mechanism

  /// Returns the number of outputs that every stage needs: accelerations, event functions and their rates.
  [[nodiscard]] std::size_t usual_outputs() const { return tape.usual_outputs; }
  std::vector<double> inputs, outputs;             ///< values in the recorded evaluation
  std::vector<std::unique_ptr<ElementCall>> calls; ///< elements called by the tape
};

/// Returns the number of time-dependent numbers of a layout: value, rate and acceleration of each lock, then acceleration and rate of each
/// driven row.
[[nodiscard]] std::size_t time_input_count(const Layout& layout);

/// Records the evaluation at time t and at y (coordinates, rates, inner states). Returns false if it cannot be recorded: too many
/// coordinates or rows, or dependent rows. `live`: evaluation whose modes and caches called elements read; it must outlive `traced`.
/// `least_pivot`: smallest relative pivot for which the tape is valid. `known`: a tape that this evaluation probably equals; the evaluation
/// is then only compared with it (TapeNumber::start), and the function also returns false if they differ.
[[nodiscard]] bool trace_rates(const System& system, const Layout& layout, const State& state, const Evaluation& live, double t,
                               const double* y, std::span<const double> time_inputs, double least_pivot, TracedRates& traced,
                               const Tape* known = nullptr);

} // namespace steplap
