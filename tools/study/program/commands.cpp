#include "tools/study/program/commands.h"

#include "mbd/base/limits.h"
#include "mbd/base/number_text.h"
#include "mbd/io/atomic_file.h"
#include "mbd/io/csv.h"
#include "mbd/model/model_path.h"
#include "tools/steplap/command_line.h"
#include "tools/steplap/commands.h"
#include "tools/steplap/log.h"
#include "tools/steplap/output_files.h"
#include "tools/study/export.h"
#include "tools/study/program/progress_line.h"
#include "tools/study/program/show.h"
#include "tools/study/program/whole_number.h"
#include "tools/study/report_about.h"
#include "tools/study/report_page.h"
#include "tools/study/run_study.h"

#include <filesystem>
#include <fstream>
#include <iostream>

namespace steplap::study {

namespace {

struct Options {
  std::string file;
  std::optional<std::string> store, sample, output, threads;
  bool is_restarted = false, is_changed = false, is_findings = false, is_growth = false, is_histories = false, is_posterior = false,
       is_variables = false;
  bool is_reported = false, is_overwriting = false;
};

std::string default_store(const std::string& file) {
  return (std::filesystem::path("out") / (std::filesystem::path(file).stem().string() + ".sqlite")).string();
}

bool is_database(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false; // a named pipe would block
  std::ifstream stream(file, std::ios::binary);
  char head[16]{};
  return stream.read(head, sizeof head) && std::string(head, 15) == "SQLite format 3";
}

// Converts a store error to a message that lists the options with which the store could be used.
FileError with_options(const StoreError& error) {
  std::string options;
  for (const StoreMode mode : error.usable_modes()) options += mode == StoreMode::changed ? "--changed, " : "--restart, ";
  return {error.path(), options.empty() ? error.what() : error.what() + (" (steplap study run: " + options + "-o)"), error.line()};
}

// Returns the store for an argument that names the study file or the store itself.
std::string store_of(const Options& o) {
  if (is_standard_output(o.file))
    throw UsageError(
        "FILE '-': a study is known by its file, or by the store of its results, which the standard input cannot be: name one of them");
  return o.store ? *o.store : is_database(o.file) ? o.file : default_store(o.file);
}

std::string page_of(const std::string& store) { return std::filesystem::path(store).replace_extension(".html").string(); }

std::string page_text(const std::string& path) {
  Store store(path);
  return report_page(store, path);
}

ExitCode code_of(Standing standing) {
  if (standing == Standing::not_met) return ExitCode::criterion_failed;
  return standing == Standing::done ? ExitCode::done : ExitCode::numerical_failure;
}

StudyOptions study_options(const Options& o, const Ranks& ranks, ProgressLine& line) {
  if (o.is_restarted && o.is_changed) throw UsageError("--restart and --changed exclude each other");
  StudyOptions options;
  options.threads = o.threads ? static_cast<int>(whole_number(*o.threads, "--threads", 1, k_most_threads)) : ranks.threads();
  options.mode = o.is_restarted ? StoreMode::restart : o.is_changed ? StoreMode::changed : StoreMode::run;
  options.progress = std::ref(line);
  options.note = [](const std::string& text) { log_info(text); };
  return options;
}

ExitCode tell(const Options& o, const LoadedStudy& loaded, const Answer& answer, Console& console) {
  const std::string path = store_of(o);
  const bool is_told = console.verbosity != Verbosity::quiet;
  if (is_told) {
    Store store(path);
    show(store, loaded.study.title, console.out);
    console.out << "Store: " << path << "\n";
  }
  if (o.is_reported) {
    write_file(page_of(path), page_text(path), IfExists::replace);
    if (is_told) console.out << "Page: " << page_of(path) << "\n";
  }
  return code_of(answer.standing);
}

ExitCode run_command_of(const Options& o, const Ranks& ranks, Console& console) {
  std::optional<LoadedStudy> loaded;
  try {
    loaded = read_study(o.file);
  } catch (const ModelError&) {
    if (ranks.is_first()) throw;
    return ExitCode::model_error; // rank 0 has reported the error
  }
  std::optional<Answer> answer;
  {
    ProgressLine line(console);
    answer = run_study(*loaded, store_of(o), ranks, study_options(o, ranks, line));
  }
  return answer ? tell(o, *loaded, *answer, console) : ExitCode::done;
}

Option store_option(const std::shared_ptr<Options>& o) {
  return {"-o,--output", &o->store, "STORE", "file of the results (default: out/<name of the study>.sqlite)"};
}

Command run_command(const Ranks& ranks) {
  const auto o = std::make_shared<Options>();
  Command command;
  command.name = "run";
  command.summary = "run a study, or go on with one (the word may be left out: steplap study FILE)";
  command.examples = R"(  steplap study friction.toml
  steplap study friction.toml -o friction.sqlite --restart
  mpirun -n 8 steplap study friction.toml
A study that was interrupted goes on when it is run again.
)";
  command.options = {{"FILE", &o->file, "FILE", "study file (TOML)", true},
                     store_option(o),
                     {"--restart", &o->is_restarted, "", "drop what the store holds"},
                     {"--changed", &o->is_changed, "", "the study has changed: keep the samples that are the same"},
                     {"--report", &o->is_reported, "", "write the page of the study next to the store (see steplap study report)"},
                     {"--threads", &o->threads, "N", "threads (default: all processors)"}};
  for (const char* const force : {"-f", "--force"}) // of other commands
    command.retired.push_back({force, std::string(force) + ": a study goes on where it stopped; --restart drops what its store holds"});
  command.prints_tables = true;
  command.run = [o, &ranks](Console& console) { return run_command_of(*o, ranks, console); };
  return command;
}

Command show_command() {
  const auto o = std::make_shared<Options>();
  Command command;
  command.name = "show";
  command.summary = "what a study has found so far";
  command.options = {{"FILE", &o->file, "FILE", "study file or store", true}, store_option(o)};
  command.prints_tables = true;
  command.run = [o](Console& console) {
    Store store(store_of(*o));
    show(store, "", console.out);
    return ExitCode::done;
  };
  return command;
}

Command report_command() {
  const auto o = std::make_shared<Options>();
  Command command;
  command.name = "report";
  command.summary = "one page of a study: estimates, curves, samples";
  command.examples = R"(  steplap study report friction.toml
  steplap study report out/friction.sqlite -o friction.html
The page is one file that opens in any browser without a network. All of it is read from the store; a study that
has not ended is shown as far as it is. Without -o it is written beside the store.
)";
  command.options = {{"FILE", &o->file, "FILE", "study file or store", true},
                     {"--store", &o->store, "STORE", "file of the results (default: out/<name of the study>.sqlite)"},
                     {"-o,--output", &o->output, "PAGE", "the page (default: next to the store); - is the standard output"},
                     {"-f,--force", &o->is_overwriting, "", "overwrite an earlier page"}};
  command.run = [o](Console& console) {
    const std::string store = store_of(*o), page = o->output.value_or(page_of(store));
    const OutputFiles files(console, {{"-o", page}}, o->is_overwriting);
    files.write(page, page_text(store));
    if (files.may_print()) console.out << "Written to " << page << "\n";
    return ExitCode::done;
  };
  return command;
}

std::string variables_of(Store& store) {
  const std::string about = store.setting("about");
  if (about.empty()) throw UsageError("the store was made before units were kept in it: run the study again to have them");
  return variables_csv(about);
}

Command export_command() {
  const auto o = std::make_shared<Options>();
  Command command;
  command.name = "export";
  command.summary = "all samples as CSV, or all findings";
  command.examples = "  steplap study export friction.toml > samples.csv\n  steplap study export friction.toml --findings\n";
  command.options = {{"FILE", &o->file, "FILE", "study file or store", true},
                     store_option(o),
                     {"--findings", &o->is_findings, "", "what was found instead of the samples"},
                     {"--variables", &o->is_variables, "", "names, units and distributions of the columns of the samples"},
                     {"--growth", &o->is_growth, "", "estimates as they grew instead of the samples"},
                     {"--histories", &o->is_histories, "", "of a fit: what was measured, and what was found to fit it"},
                     {"--posterior", &o->is_posterior, "", "with [[evidence]]: values that agree with it"}};
  command.run = [o](Console& console) {
    Store store(store_of(*o));
    if (o->is_findings) export_findings(store.findings(), console.out);
    else if (o->is_variables) console.out << variables_of(store);
    else if (o->is_growth) export_findings(store.growth(), console.out);
    else if (o->is_histories) export_histories(store.histories(), console.out);
    else if (!o->is_posterior) export_samples(store, console.out);
    else if (export_posterior(store.findings(), console.out) == 0)
      throw UsageError("the store has no values that agree with evidence: a study with [[evidence]] that has ended keeps them");
    if (!console.out.flush()) throw UsageError("the export could not be written to its end");
    return ExitCode::done;
  };
  return command;
}

// Repeats one sample by the command for models, with the sample's values as overrides.
ExitCode replay(const Options& o, Console& console) {
  const LoadedStudy loaded = read_study(o.file);
  Store store(store_of(o));
  const long number = whole_number(*o.sample, "--sample", 1);
  if (number > store.size())
    throw UsageError("the store has " + std::to_string(store.size()) + " samples: there is no sample " + *o.sample);
  if (store.identity().scene != identity_of(loaded).scene)
    throw StoreError(o.file, "the models, variables or responses of '" + o.file +
                                 "' are not those of the store any more: its samples cannot be replayed");
  if (!loaded.variants.empty())
    throw UsageError("a sample of the kind 'needs' is another model, not other values of one: it cannot be replayed");
  if (loaded.models.empty()) throw UsageError("the study has no model: its samples are numbers only");
  std::vector<StoredSample> rows;
  store.read(number, 1, rows);
  int worst = 0;
  for (const auto& model : loaded.models) {
    std::vector<std::string> arguments{"simulate", model->path, "-o", o.output.value_or("out/replay"), "--force", "--report"};
    for (const std::string& setting : model->overrides) arguments.insert(arguments.end(), {"--set", setting});
    for (std::size_t i = 0; i < loaded.study.variables.size(); ++i) {
      const Variable& v = loaded.study.variables[i];
      if (!is_set_in(v, *model)) continue;
      for (const std::string& path : v.paths) {
        const double factor = v.is_factor ? number_of(model->given, path) : 1.0;
        arguments.insert(arguments.end(), {"--set", path + "=" + number_text(factor * rows[0].values[i])});
      }
    }
    std::string line = "steplap";
    for (const std::string& argument : arguments)
      line += argument.find(' ') == std::string::npos ? " " + argument : " \"" + argument + "\"";
    console.out << line << "\n";
    worst = std::max(worst, run_command_line(arguments, console.out, console.err, console.is_terminal));
  }
  return static_cast<ExitCode>(worst);
}

Command replay_command() {
  const auto o = std::make_shared<Options>();
  o->sample = "";
  Command command;
  command.name = "replay";
  command.summary = "the full run of one sample, with its report";
  command.examples = "  steplap study replay friction.toml --sample 17\n";
  command.options = {{"FILE", &o->file, "FILE", "study file", true},
                     {"--sample", &o->sample, "N", "its number, as show and export say", true},
                     {"--store", &o->store, "STORE", "file of the results (default: out/<name of the study>.sqlite)"},
                     {"-o,--output", &o->output, "DIR", "folder for the run (default: out/replay)"}};
  command.run = [o](Console& console) { return replay(*o, console); };
  return command;
}

Command schema_command() {
  Command command;
  command.name = "schema";
  command.summary = "a JSON Schema of study files, for editors";
  command.run = [](Console& console) {
    console.out << study_schema();
    return ExitCode::done;
  };
  return command;
}

} // namespace

std::vector<Command> study_commands(const Ranks& ranks) {
  std::vector<Command> commands = {run_command(ranks), show_command(),   report_command(), export_command(),
                                   replay_command(),   schema_command(), help_command()};
  for (Command& command : commands)
    command.run = [run = std::move(command.run)](Console& console) {
      try {
        return run(console);
      } catch (const StoreError& error) {
        throw with_options(error);
      }
    };
  return commands;
}

Program study_program(const Ranks& ranks) {
  return {"steplap study", "studies: what if, how likely, how much does it matter; see docs/reference/studies.md", study_commands(ranks),
          R"(Exit codes:
  0  done
  1  a fault of the program itself
  2  wrong command line, or a store that cannot be used: of another study, damaged, held by another process
  3  a study file or a model that cannot be used as it stands
  4  an answer that is not to be trusted, or a study that was to stop at a failed run and did
  5  done, but the wanted accuracy was not reached, or there is nothing to be found
)"};
}

} // namespace steplap::study
