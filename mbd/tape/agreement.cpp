#include "mbd/tape/machine_code.h"

#include <bit>
#include <cmath>

namespace steplap {

namespace {

// What begins at `from`, once for each lane.
std::vector<double> in_all_lanes(const double* from, std::size_t count, int lanes) {
  std::vector<double> all;
  all.reserve(count * static_cast<std::size_t>(lanes));
  for (std::size_t i = 0; i < count; ++i) all.insert(all.end(), static_cast<std::size_t>(lanes), from[i]);
  return all;
}

bool are_equal(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

} // namespace

bool agrees_with_replay(const MachineCode& code, const Tape& tape, const double* inputs) {
  const int lanes = code.lanes();
  std::vector<double> expected(tape.outputs.size(), 0.0);
  const bool holds = replay(tape, inputs, tape.constants.data(), expected.data());
  const std::vector<double> lane_inputs = in_all_lanes(inputs, static_cast<std::size_t>(tape.input_count), lanes);
  const std::vector<double> constants = in_all_lanes(tape.constants.data(), tape.constants.size(), lanes);
  std::vector<double> outputs(expected.size() * static_cast<std::size_t>(lanes), 0.0);
  const unsigned all = (1u << lanes) - 1;
  if (code.run(lane_inputs.data(), constants.data(), outputs.data()) != (holds ? all : 0u)) return false;
  for (std::size_t i = 0; holds && i < outputs.size(); ++i)
    if (!are_equal(outputs[i], expected[i / static_cast<std::size_t>(lanes)])) return false;
  return true;
}

} // namespace steplap
