#include "tools/steplap/report.h"

#include "mbd/io/atomic_file.h"
#include "tools/pages/assessment_page.h"
#include "tools/pages/report_page.h"
#include "tools/steplap/commands.h"
#include "tools/steplap/output_files.h"

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

std::string page_of_results(const std::vector<std::string>& folders) {
  const auto assessment = std::find_if(folders.begin(), folders.end(), is_assessment);
  if (assessment != folders.end()) {
    if (folders.size() > 1)
      throw FileError(*assessment, "'" + *assessment + "' holds an assessment, which has a page of its own: name its folder alone");
    return assessment_page(folders.front());
  }
  std::vector<Results> runs;
  for (const std::string& folder : folders) runs.push_back(read_results(folder));
  return report_page(runs);
}

// Returns the path in the folder of a single run, or next to the folders of several.
std::string usual_place(const std::vector<std::string>& folders) {
  std::filesystem::path place = folders.front();
  if (folders.size() > 1) place = (place / "").lexically_normal().parent_path().parent_path();
  return (place / "report.html").string();
}

ExitCode report(const ReportOptions& options, Console& console) {
  const std::string file = options.output.value_or(usual_place(options.results));
  const OutputFiles files(console, {{"-o", file}}, options.is_overwriting);
  files.write(file, page_of_results(options.results));
  if (files.has_words()) console.out << "Written to " << file << "\n";
  return ExitCode::done;
}

} // namespace

void write_report(const std::vector<std::string>& folders, const std::string& file, bool is_overwriting) {
  write_file(file, page_of_results(folders), is_overwriting ? IfExists::replace : IfExists::refuse);
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
                     {"-o,--output", &o->output, "FILE", "the page; - is the standard output"},
                     {"-f,--force", &o->is_overwriting, "", "overwrite an earlier page"}};
  command.run = [o](Console& console) { return report(*o, console); };
  return command;
}

} // namespace steplap
