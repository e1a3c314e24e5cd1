#include "tools/steplap/report.h"

#include "mbd/io/atomic_file.h"
#include "tools/pages/assessment_page.h"
#include "tools/pages/report_page.h"
#include "tools/pages/sheet_page.h"
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
  bool is_sheet = false, is_overwriting = false;
};

std::string page_of_results(const std::vector<std::string>& folders) {
  const auto assessment = std::find_if(folders.begin(), folders.end(), is_assessment);
  if (assessment != folders.end()) {
    if (folders.size() > 1)
      throw FileError(*assessment, "'" + *assessment + "' holds an assessment, which has its own page: name only its folder");
    return assessment_page(folders.front());
  }
  std::vector<Results> runs;
  for (const std::string& folder : folders) runs.push_back(read_results(folder));
  return report_page(runs);
}

std::string sheet_of_results(const std::vector<std::string>& folders) {
  if (folders.size() > 1)
    throw UsageError("--sheet makes the sheet of one result: name one folder instead of " + std::to_string(folders.size()));
  return is_assessment(folders.front()) ? assessment_sheet(folders.front()) : run_sheet(read_results(folders.front()));
}

// Returns the path in the folder of a single run, or next to the folders of several.
std::string default_path(const std::vector<std::string>& folders, const char* name) {
  std::filesystem::path place = folders.front();
  if (folders.size() > 1) place = (place / "").lexically_normal().parent_path().parent_path();
  return (place / name).string();
}

ExitCode report(const ReportOptions& options, Console& console) {
  const std::string file = options.output.value_or(default_path(options.results, options.is_sheet ? "sheet.html" : "report.html"));
  const OutputFiles files(console, {{"-o", file}}, options.is_overwriting);
  files.write(file, options.is_sheet ? sheet_of_results(options.results) : page_of_results(options.results));
  if (files.may_print()) console.out << "Written to " << file << "\n";
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
  command.summary = "one page of a run, or several side by side; or the sheet to be signed";
  command.examples = R"(  steplap report out/my
  steplap report out/paper/no_interference out/paper/interference -o paper.html
  steplap report out/my --sheet
RESULT is a folder that steplap simulate has written. The page is one file that opens in any browser
without a network, and prints with the verdict on the first sheet. Without -o it is written as
report.html into the folder of the run, or beside the folders of several. The folder of an assessment
gets a page whose first printed sheet holds the decision and has room for two signatures. --sheet writes
sheet.html instead: of a run, a static proof or an assessment the one page of A4 that is signed.
)";
  command.options = {{"RESULT", &o->results, "DIR", "folders of runs, or that of an assessment", true},
                     {"--sheet", &o->is_sheet, "", "one page of A4 to be signed, of one result, instead of the page of the report"},
                     {"-o,--output", &o->output, "FILE", "the page; - is the standard output"},
                     {"-f,--force", &o->is_overwriting, "", "overwrite an earlier page"}};
  command.run = [o](Console& console) { return report(*o, console); };
  return command;
}

} // namespace steplap
