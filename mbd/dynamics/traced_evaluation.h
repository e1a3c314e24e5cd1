// An evaluation of one layout in one set of modes, written down (mbd/tape).
//
// The same templates that evaluate doubles run once on numbers that write down what is done with them: no second statement of
// the equations. Elements without such templates are called (element_call.h). What hangs on time alone (drives) is an input,
// computed as ever. What it leaves out is what nobody asks of a
// stage inside a step: reactions, but for those of joints inside clusters that may give way, and what happens near a singular
// position, where it refuses.
#pragma once

#include "mbd/dynamics/element_call.h"
#include "mbd/dynamics/layout.h"
#include "mbd/tape/tape.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace steplap {

struct TracedRates {
  /// Inputs: coordinates and rates, inner states, then the numbers of the layout that follow from time, then those of signals;
  /// outputs: accelerations, rates of inner states, dissipation, work, watch values, rates of watch values; then what a look at
  /// merged joints and the end of a step ask for: wrenches, and of each pivot that and its diagonal. Code takes coordinates, rates
  /// and inner states from where they are, and puts rates, watch values (k_watches) and rates of these (k_watch_rates) where they
  /// belong.
  Tape tape;
  static constexpr std::int32_t k_watches = 1, k_watch_rates = 2, k_rest = 3; ///< arrays of outputs (Tape::places)
  std::vector<TimeInput> signals;
  std::vector<int> watches;     ///< the slots of watch values
  std::vector<int> watch_rates; ///< those whose rate is no constant
  bool has_wrenches = false;    ///< else merged joints are not to be looked at by it
  std::vector<int> wrenches;    ///< the slots (Snapshot::friction_force) of merged joints that can slip
  std::vector<int> pivots;      ///< how many of the rows between absolute clusters, then of each mechanism

  /// Where in the outputs accelerations, watch values and their rates end.
  [[nodiscard]] std::size_t usual_outputs() const { return tape.usual_outputs; }
  std::vector<double> inputs, outputs;             ///< those traced
  std::vector<std::unique_ptr<ElementCall>> calls; ///< what the tape calls
};

/// The numbers of a layout that follow from time: of each lock value, rate and acceleration, of each driven row acceleration and
/// rate.
[[nodiscard]] std::size_t time_input_count(const Layout& layout);

/// At time t, coordinates, rates and inner states y and the layout's numbers of time. False if the scene is not traced: it has too
/// many coordinates or rows, or rows that depend on each other. `live`: the evaluation whose modes and memory calls of elements see;
/// it must outlive `traced`. `least_pivot`: the tape's condition. `known`: a tape that this one should be, which then is not
/// written once more (Traced::start); false, too, if it is another.
[[nodiscard]] bool trace_rates(const System& system, const Layout& layout, const State& state, const Evaluation& live, double t,
                               const double* y, std::span<const double> time_inputs, double least_pivot, TracedRates& traced,
                               const Tape* known = nullptr);

} // namespace steplap
