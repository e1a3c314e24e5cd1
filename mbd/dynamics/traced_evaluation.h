// An evaluation of one layout in one set of modes, written down (mbd/tape).
//
// The same templates that evaluate doubles run once on numbers that write down what is done with them: no second statement of
// the equations. What hangs on time alone (drives) is an input, computed as ever. What it leaves out is what nobody asks of a
// stage inside a step: reactions, but for those of joints inside clusters that may give way, and what happens near a singular
// position, where it refuses.
#pragma once

#include "mbd/dynamics/layout.h"
#include "mbd/tape/tape.h"

#include <span>
#include <vector>

namespace steplap {

struct TracedRates {
  /// Inputs: coordinates and rates, then the numbers of the layout that follow from time, then those of signals; outputs:
  /// accelerations, dissipation, work, watch values, rates of watch values; then what a look at merged joints and the end of a step
  /// ask for: wrenches, and of each pivot that and its diagonal.
  Tape tape;
  std::vector<TimeInput> signals;
  std::vector<int> watches;      ///< the slots of watch values
  std::vector<int> watch_rates;  ///< those whose rate is no constant
  bool has_wrenches = false;     ///< else merged joints are not to be looked at by it
  std::vector<int> wrenches;     ///< the slots (Snapshot::friction_force) of merged joints that can slip
  std::vector<int> pivots;       ///< how many of the rows between absolute clusters, then of each mechanism

  /// Where in the outputs accelerations, watch values and their rates end.
  [[nodiscard]] std::size_t usual_outputs() const { return tape.usual_outputs; }
  std::vector<double> inputs, outputs; ///< those traced
};

/// The numbers of a layout that follow from time: of each lock value, rate and acceleration, of each driven row acceleration and
/// rate.
[[nodiscard]] std::size_t time_input_count(const Layout& layout);

/// At time t, coordinates and rates y and the layout's numbers of time. False if some part of the scene is not traced: elements with laws of
/// their own, joint coordinates, more than a few rows, rows that depend on each other. `least_pivot`: the tape's condition. `known`:
/// a tape that this one should be, which then is not written once more (Traced::start); false, too, if it is another.
[[nodiscard]] bool trace_rates(const System& system, const Layout& layout, const State& state, double t, const double* y,
                               std::span<const double> time_inputs, double least_pivot, TracedRates& traced, const Tape* known = nullptr);

} // namespace steplap
