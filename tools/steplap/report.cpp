#include "tools/steplap/report.h"

#include "mbd/io/atomic_file.h"
#include "report/assessment_page.h"
#include "report/report_page.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <ostream>

namespace steplap {

namespace {

struct ReportOptions {
  std::vector<std::string> results;
  std::optional<std::string> output;
  bool is_overwriting = false;
};

// Into the folder of a single run; beside the folders of several.
std::string usual_place(const std::vector<std::string>& folders) {
  std::filesystem::path place = folders.front();
  if (folders.size() > 1) place = (place / "").lexically_normal().parent_path().parent_path();
  return (place / "report.html").string();
}

ExitCode report(const ReportOptions& options, Console& console) {
  const std::string file = options.output.value_or(usual_place(options.results));
  write_report(options.results, file, options.is_overwriting);
  if (console.verbosity != Verbosity::quiet) console.out << "Written to " << file << "\n";
  return ExitCode::done;
}

} // namespace

void write_report(const std::vector<std::string>& folders, const std::string& file, bool is_overwriting) {
  const IfExists if_exists = is_overwriting ? IfExists::replace : IfExists::refuse;
  const auto assessment = std::find_if(folders.begin(), folders.end(), is_assessment);
  if (assessment != folders.end()) {
    if (folders.size() > 1)
      throw FileError(*assessment, "'" + *assessment + "' holds an assessment, which has a page of its own: name its folder alone");
    return write_file(file, assessment_page(folders.front()), if_exists);
  }
  std::vector<Results> runs;
  for (const std::string& folder : folders)
    runs.push_back(read_results(folder));
  write_file(file, report_page(runs), if_exists);
}

Command report_command() {
  const auto o = std::make_shared<ReportOptions>();
  Command command;
  command.name = "report";
  command.summary = "one page of a run, or several side by side: verdict, moving machine, curves";
  command.examples = R"(  steplap report out/my
  steplap report out/paper/no_interference out/paper/interference -o paper.html
RESULT is a folder that steplap simulate has written. The page is one file that opens in any browser
without a network, and prints with the verdict on the first sheet. Without -o it is written as
report.html into the folder of the run, or beside the folders of several. The folder of an assessment
gets a page whose first printed sheet holds the decision and has room for two signatures.
)";
  command.options = {{"RESULT", &o->results, "DIR", "folders of runs, or that of an assessment", true},
                     {"-o,--output", &o->output, "FILE", "the page"},
                     {"-f,--force", &o->is_overwriting, "", "overwrite an earlier page"}};
  command.run = [o](Console& console) { return report(*o, console); };
  return command;
}

} // namespace steplap
