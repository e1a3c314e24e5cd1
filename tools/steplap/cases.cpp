#include "tools/steplap/commands.h"

#include "mbd/run/findings.h"
#include "mbd/run/load_cases.h"
#include "mbd/run/summary.h"
#include "tools/pages/sheet_page.h"
#include "tools/steplap/case_planes.h"
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
  std::vector<std::string> models;
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
  for (const auto& model : results.models)
    for (const Finding& finding : findings_before(*model))
      if (finding.level == FindingLevel::warning) log_warning("'" + model->path + "': " + text_with_place(finding));
  for (const CaseResult& one : results.cases)
    if (!one.failure.empty()) log_error("'" + one.load.where.file + "': case '" + one.load.name + "': " + one.failure);
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

LoadCaseResults run(const CasesOptions& options) {
  const std::vector<std::string>& models = options.models;
  if (models.size() > 2) throw UsageError("a machine has two planes, lengthwise and transverse: give at most two models");
  if (models.size() == 1) return run_load_cases(models.front(), options.overrides, program_catalogue(), run_options(options));
  return run_planes({models[0], models[1]}, options.overrides, program_catalogue(), run_options(options));
}

ExitCode cases(const CasesOptions& options, Console& console) {
  const OutputFiles files(console, {{"-o", options.sheet}}, options.is_overwriting);
  const InterruptionGuard guard;
  const LoadCaseResults results = run(options);
  log_findings(results);
  const OrderedJson document = load_cases_document(results);
  if (options.sheet) files.write(options.sheet, cases_sheet(results.models, document));
  if (JsonScreen* const screen = json_screen(console.out)) {
    screen->begin(About{results.models.front()->path});
    screen->put("load_cases", document);
  } else if (files.may_print()) print_load_cases(console.out, results);
  if (options.sheet && files.may_print()) console.out << "\nWritten to " << *options.sheet << "\n";
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
  steplap cases along.toml across.toml
Each [[case]] is run as steplap simulate runs the model with the same --set, on all processors. The verdict is the
worst of all cases. Two models show one machine in both planes: cases of one name act at the same time, and frictions of
one name, or of one 'shared_friction', carry the loads of both. The sheet is one page of A4 with drawing, cases with their sources, limits and room for two
signatures; --json has all numbers.
)";
  command.options = {
      {"MODEL", &o->models, "FILE", "model file (TOML) with [[case]] tables, or two of different planes; - is the standard input", true},
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
