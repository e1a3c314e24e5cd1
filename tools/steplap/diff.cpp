#include "tools/steplap/commands.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/reader.h"
#include "mbd/run/model_changes.h"
#include "mbd/run/quantity_text.h"
#include "tools/steplap/diff_results.h"
#include "tools/steplap/text_table.h"
#include "transformer/program.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <ostream>

namespace steplap {

namespace {

namespace fs = std::filesystem;
using Align = TextTable::Align;

struct DiffOptions {
  std::string before, after;
  bool is_sameness_required = false;
};

constexpr std::size_t k_longest = 40; // longest text shown for a value that is not a number, in characters

std::string shortened(const std::string& text) {
  std::size_t length = 0, end = 0;
  for (; end < text.size(); ++end)
    if ((static_cast<unsigned char>(text[end]) & 0xC0) != 0x80 && ++length > k_longest) break;
  return end < text.size() ? text.substr(0, end) + "…" : text;
}

// Formats a value with six digits, or with all if six do not distinguish it from the other value.
Cell value_cell(const std::optional<double>& value, const std::optional<double>& other, const std::string& text, const std::string& unit) {
  if (!value) return text.empty() ? Cell("-") : Cell(shortened(shown(text)));
  const std::string usual = quantity_text(*value, unit);
  const bool is_told_apart = !other || quantity_text(*other, unit) != usual;
  return {is_told_apart ? usual : number_text(*value) + (unit.empty() ? "" : " " + unit), *value, unit};
}

std::string word_for(const ModelChange& change) {
  if (change.kind == ModelChange::Kind::added) return "added";
  return change.kind == ModelChange::Kind::removed ? "removed" : "";
}

void print_changes(std::ostream& out, const std::vector<ModelChange>& changes) {
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::left});
  table.set_head("values", {"value", "before", "after", "change", ""}, {"path", "before", "after", "change", "why"});
  for (const ModelChange& c : changes)
    table.add_row({c.path, value_cell(c.before, c.after, c.before_text, c.unit), value_cell(c.after, c.before, c.after_text, c.unit),
                   c.before && c.after ? change_cell(*c.before, *c.after) : Cell(word_for(c)), c.follows ? "follows from parameters" : ""});
  out << table;
}

std::size_t diff_models(const Model& before, const Model& after, std::ostream& out) {
  const std::vector<ModelChange> changes = changes_between(before, after);
  const auto follow =
      static_cast<std::size_t>(std::count_if(changes.begin(), changes.end(), [](const ModelChange& c) { return c.follows; }));
  if (changes.empty()) {
    out << "The models are the same, value by value.\n";
    return 0;
  }
  out << counted(changes.size(), "value differs", "values differ")
      << (follow > 0 ? "; " + std::to_string(follow) + " of them follow from parameters" : "") << "\n";
  print_changes(out, changes);
  return changes.size();
}

Model given_model(const std::string& path) { return read_given_model(path, program_catalogue()); }

// Returns the model of a run's folder. Reports it and returns nothing if this program cannot read the model.
std::optional<Model> model_of(const std::string& folder, std::ostream& out) {
  std::error_code ignored;
  const bool is_partial = !fs::exists(fs::path(folder) / "model.toml", ignored); // of a run that stopped early
  try {
    return given_model((fs::path(folder) / (is_partial ? "partial_model.toml" : "model.toml")).string());
  } catch (const ModelError& error) {
    out << "The model of '" << folder << "' cannot be read by this version: " << error.diagnostics().front().message << "\n";
    return std::nullopt;
  }
}

std::size_t diff_results(const DiffOptions& options, std::ostream& out) {
  const ShownRun before = shown_run(options.before), after = shown_run(options.after);
  std::size_t followed = print_limit_changes(out, before, after);
  const std::optional<Model> a = model_of(options.before, out), b = model_of(options.after, out);
  out << "\n";
  const std::size_t changed = a && b ? diff_models(*a, *b, out) : 0;
  followed += print_other_changes(out, before, after);
  if (followed == 0) out << "The runs agree: nothing differs by more than its error.\n";
  print_unknown_errors(out, before, after);
  return changed + followed;
}

ExitCode diff(const DiffOptions& options, Console& console) {
  std::error_code ignored;
  const bool is_first_folder = fs::is_directory(options.before, ignored), is_second_folder = fs::is_directory(options.after, ignored);
  if (is_first_folder != is_second_folder)
    throw UsageError("'" + (is_first_folder ? options.before : options.after) + "' is a folder, '" +
                     (is_first_folder ? options.after : options.before) + "' is none: compare two models, or two folders of runs");
  std::ostream silent(nullptr);
  std::ostream& out = console.verbosity == Verbosity::quiet ? silent : console.out;
  out << About{options.before + " → " + options.after};
  const std::size_t count =
      is_first_folder ? diff_results(options, out) : diff_models(given_model(options.before), given_model(options.after), out);
  return options.is_sameness_required && count > 0 ? ExitCode::criterion_failed : ExitCode::done;
}

} // namespace

Command diff_command() {
  const auto o = std::make_shared<DiffOptions>();
  Command command;
  command.name = "diff";
  command.summary = "what differs between two models, or between two runs: verdict and limits first";
  command.examples = R"(  steplap diff models/paper/no_interference.toml models/paper/interference.toml
  steplap diff out/first/no_interference out/weak/no_interference
  steplap diff --require-same mine.toml theirs.toml
Models are compared value by value, in SI, with what they extend and with defaults; a default that is written out is no change. Of two runs
verdict, criteria and shares of limits come first, then the models, joints, events and extremes: what differs by more than both error
estimates together.
Exit code 0, whether anything differs or not; with --require-same 5 if anything does.
)";
  command.options = {{"BEFORE", &o->before, "FILE|DIR", "a model file, - for the standard input, or the folder of a run", true},
                     {"AFTER", &o->after, "FILE|DIR", "another one of the same sort", true},
                     {"--require-same", &o->is_sameness_required, "", "exit code 5 if anything differs"}};
  command.prints_tables = true;
  command.run = [o](Console& console) { return diff(*o, console); };
  return command;
}

} // namespace steplap
