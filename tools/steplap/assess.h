// Command `steplap assess`: makes a decision from recorder files and models. This file parses the command line. The study program
// (tools/study/program/assess.h), which links the required libraries, does the work; `--static` runs in this program.
#pragma once

#include "tools/steplap/record_options.h"

#include <functional>
#include <memory>

namespace steplap {

/// Arguments as given on the command line.
struct AssessOptions : ReadingOptions {
  std::vector<std::string> records, models, overrides, accepted, second_records;
  Text criteria, print_criteria, samples, seed, threads, pulse, pulse_axis, voyage, shipment, budget;
  Text static_preset, plane, directions, largest;
  Text output;
  bool is_json = false, is_overwriting = false, is_estimate_left_out = false;
};

/// Returns the command; `work` executes it.
[[nodiscard]] Command assess_command(const std::function<ExitCode(const AssessOptions& options, Console& console)>& work);
/// Returns true if these arguments request an assessment of recorder files, which the study program executes.
[[nodiscard]] bool is_record_assessment(const std::vector<std::string>& arguments);

} // namespace steplap
