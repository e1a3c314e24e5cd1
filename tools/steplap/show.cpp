#include "tools/steplap/commands.h"

#include "tools/steplap/overview_screen.h"
#include "tools/steplap/run_screen.h"

#include <memory>

namespace steplap {

namespace {

ExitCode show(const std::vector<std::string>& folders, Console& console) {
  std::vector<ShownRun> runs;
  for (const std::string& folder : folders) runs.push_back(shown_run(folder));
  if (put_runs(console.out, runs)) return ExitCode::done;
  if (console.verbosity == Verbosity::verbose) print_tables(console.out, runs);
  else if (console.verbosity == Verbosity::normal) print_overviews(console.out, runs);
  return ExitCode::done;
}

} // namespace

Command show_command() {
  const auto results = std::make_shared<std::vector<std::string>>();
  Command command;
  command.name = "show";
  command.summary = "what simulate said of earlier runs, from their folders";
  command.examples = R"(  steplap show out/my
  steplap show -v out/paper/no_interference out/paper/interference
RESULT is a folder that steplap simulate has written. It shows the screen of that run again: the verdict, what happened and what came
nearest to its limit; with -v it shows tables of all events and extremes, of several runs beside each other. Nothing is computed anew.
Folders whose files are missing or not as they were written are refused. With -q it says nothing and tells by its exit code whether
they are whole: 0, or 2.
)";
  command.options = {{"RESULT", results.get(), "DIR", "folders of runs", true}};
  command.prints_tables = true;
  command.run = [results](Console& console) { return show(*results, console); };
  return command;
}

} // namespace steplap
