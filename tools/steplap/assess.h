// steplap assess: from recorders' files and models to a decision. What the command line takes; the work is done by the program of
// studies (tools/study/program/assess.h), whose libraries it needs, or, with --static, here.
#pragma once

#include "tools/steplap/record_options.h"

#include <functional>
#include <memory>

namespace steplap {

/// As given on the command line.
struct AssessOptions : ReadingOptions {
  std::vector<std::string> records, models, overrides, accepted;
  Text criteria, print_criteria, samples, seed, threads, pulse, pulse_axis, voyage, budget;
  Text static_preset, plane, directions, largest;
  Text output;
  bool is_json = false, is_overwriting = false, is_estimate_left_out = false;
};

/// `work` does what was asked.
[[nodiscard]] Command assess_command(const std::function<ExitCode(const AssessOptions& options, Console& console)>& work);
/// That of `steplap`: --static, and help.
[[nodiscard]] Command assess_command();
/// Is it for the program of studies?
[[nodiscard]] bool asks_for_assessment(const std::vector<std::string>& arguments);

} // namespace steplap
