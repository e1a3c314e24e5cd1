// The program libexec/steplap-study, which `steplap study` starts. It is separate so that the other commands need not load the libraries
// for studies.
#include "tools/steplap/command_line.h"
#include "tools/study/program/assess.h"
#include "tools/study/program/commands.h"
#include "tools/study/program/mpi_session.h"

#include <unistd.h>

#include <iostream>

int main(int argc, char** argv) {
  using namespace steplap;
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const study::MpiSession mpi;
  if (is_record_assessment(arguments)) {
    const Program assessment{"steplap", "from a shock recorder's file to a decision", {assess_command(run_assessment)}};
    return code_of_output(std::cout, std::cerr, run_program(assessment, arguments, std::cout, std::cerr, isatty(STDERR_FILENO) == 1));
  }
  const Program program = study::study_program(mpi.ranks());
  const bool is_file =
      !arguments.empty() && (arguments.front() == "-" || !arguments.front().starts_with('-')) && !is_command(program, arguments.front());
  if (is_file) arguments.insert(arguments.begin(), "run");
  const int code = run_program(program, arguments, std::cout, std::cerr, isatty(STDERR_FILENO) == 1);
  return code_of_output(std::cout, std::cerr, code);
}
