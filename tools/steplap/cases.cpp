#include "tools/steplap/commands.h"

#include "mbd/run/findings.h"
#include "mbd/run/load_cases.h"
#include "mbd/run/summary.h"
#include "tools/pages/sheet_page.h"
#include "tools/steplap/cases_screen.h"
#include "tools/steplap/interruption.h"
#include "tools/steplap/json_screen.h"
#include "tools/steplap/log.h"
#include "tools/steplap/output_files.h"
#include "tools/steplap/required_hold.h"
#include "transformer/program.h"

#include <memory>

namespace steplap {

namespace {

struct CasesOptions {
  std::string model;
  std::vector<std::string> overrides;
  std::optional<std::string> sheet;
  bool is_error_estimated = false, is_hold_required = false, is_overwriting = false;
};

RunOptions run_options(const CasesOptions& options) {
  RunOptions run;
  run.estimating = options.is_error_estimated ? Estimating::always : Estimating::cheap;
  run.has_second_opinion = options.is_hold_required;
  run.stop = interruption;
  return run;
}

void log_findings(const LoadCaseResults& results) {
  const std::string subject = "'" + results.model->path + "': ";
  for (const Finding& finding : findings_before(*results.model))
    if (finding.level == FindingLevel::warning) log_warning(subject + text_with_place(finding));
  for (const CaseResult& one : results.cases)
    if (!one.failure.empty()) log_error(subject + "case '" + one.load.name + "': " + one.failure);
}

ExitCode code_of(const LoadCaseResults& results, bool is_hold_required) {
  std::vector<const Judgement*> judgements;
  bool has_failed = !interruption().empty();
  for (const CaseResult& one : results.cases) {
    has_failed = has_failed || !one.failure.empty();
    judgements.push_back(&one.judgement);
  }
  if (has_failed) return ExitCode::numerical_failure;
  return is_hold_required ? required_hold(judgements) : ExitCode::done;
}

ExitCode cases(const CasesOptions& options, Console& console) {
  const OutputFiles files(console, {{"-o", options.sheet}}, options.is_overwriting);
  const InterruptionGuard guard;
  const LoadCaseResults results = run_load_cases(options.model, options.overrides, program_catalogue(), run_options(options));
  log_findings(results);
  const OrderedJson document = load_cases_document(results);
  if (options.sheet) files.write(options.sheet, cases_sheet(*results.model, document));
  if (JsonScreen* const screen = json_screen(console.out)) {
    screen->begin(About{results.model->path});
    screen->put("load_cases", document);
  } else if (files.has_words()) print_load_cases(console.out, results);
  if (options.sheet && files.has_words()) console.out << "\nWritten to " << *options.sheet << "\n";
  return code_of(results, options.is_hold_required);
}

} // namespace

Command cases_command() {
  const auto o = std::make_shared<CasesOptions>();
  Command command;
  command.name = "cases";
  command.summary = "run all load cases of a model: which one governs each limit, and a sheet to be signed";
  command.examples = R"(  steplap cases models/cases/lorry.toml
  steplap cases models/cases/lorry.toml -o sheet.html --require-hold
Each [[case]] is run as steplap simulate runs the model with the same --set, on all processors. The verdict is the
worst of all cases. The sheet is one page of A4 with drawing, cases with their sources, limits and room for two
signatures; --json has all numbers.
)";
  command.options = {{"MODEL", &o->model, "FILE", "model file (TOML) with [[case]] tables; - is the standard input", true},
                     {"-o,--output", &o->sheet, "FILE", "also write the sheet, a page (HTML) to be printed; or -"},
                     {"--set", &o->overrides, "PATH=VALUE", "lay a value over the model in all cases; may be repeated"},
                     {"--estimate-error", &o->is_error_estimated, "", "estimate the error of all numbers, however long it takes"},
                     {"--require-hold", &o->is_hold_required, "",
                      "exit code 5 unless the verdict on every case is hold, 4 if one is not to be trusted; as for steplap simulate"},
                     {"-f,--force", &o->is_overwriting, "", "overwrite an earlier sheet"}};
  command.prints_tables = true;
  command.run = [o](Console& console) { return cases(*o, console); };
  return command;
}

} // namespace steplap
