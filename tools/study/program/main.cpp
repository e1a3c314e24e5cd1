// The program libexec/steplap-study, which `steplap study` starts. It is separate so that the other commands need not load the libraries
// for studies.
#include "tools/steplap/command_line.h"
#include "tools/study/program/assess.h"
#include "tools/study/program/commands.h"
#include "tools/study/program/mpi_session.h"

#include <unistd.h>

#include <algorithm>
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
  const auto is_own = [&program](const std::string& word) {
    return is_command(program, word) || word == "-h" || word == "--help" || word == "--version" || word == "--licences";
  };
  // The word "run" may be left out, before options, too.
  const bool is_option = !arguments.empty() && arguments.front().starts_with('-') && arguments.front() != "-";
  const bool is_run =
      is_option ? std::none_of(arguments.begin(), arguments.end(), is_own) : !arguments.empty() && !is_command(program, arguments.front());
  if (is_run) arguments.insert(arguments.begin(), "run");
  const int code = run_program(program, arguments, std::cout, std::cerr, isatty(STDERR_FILENO) == 1);
  return code_of_output(std::cout, std::cerr, code);
}
