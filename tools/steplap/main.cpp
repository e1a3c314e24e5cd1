#include "tools/steplap/assess.h"
#include "tools/steplap/command_line.h"
#include "tools/steplap/interruption.h"
#include "tools/steplap/study.h"

#include <unistd.h>

#include <iostream>
#include <utility>

int main(int argc, char** argv) {
  steplap::report_write_errors();
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() > 1 && arguments[0] == "help" && arguments[1] == "study") { // equivalent to "study help"
    std::swap(argv[1], argv[2]);
    return steplap::run_study_program(argv + 1);
  }
  if (!arguments.empty() && arguments.front() == "study") return steplap::run_study_program(argv + 1);
  if (steplap::is_record_assessment(arguments)) return steplap::run_study_program(argv);
  const int code = steplap::run_command_line(arguments, std::cout, std::cerr, isatty(STDERR_FILENO) == 1);
  if (!std::cout.flush()) steplap::end_if_pipe_is_closed(STDOUT_FILENO); // a reader such as "| head" has closed the pipe: no error
  const int said = steplap::code_of_output(std::cout, std::cerr, code);
  steplap::end_by_recorded_signal();
  return said;
}
