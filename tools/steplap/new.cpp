#include "tools/steplap/new.h"

#include "mbd/io/reader.h"
#include "mbd/run/findings.h"
#include "mbd/run/run.h"
#include "tools/steplap/commands.h"
#include "tools/steplap/log.h"
#include "tools/steplap/output_files.h"
#include "transformer/program.h"

#include <algorithm>
#include <map>
#include <memory>
#include <ostream>

namespace steplap {

namespace {

struct NewOptions {
  std::string kind;
  std::optional<std::string> output;
  bool is_overwriting = false;
  std::map<std::string, std::optional<std::string>> values; ///< values given by the user, by option name
};

// Returns the text between the next pair of quotes after `at`, and moves `at` behind the closing quote.
std::string_view quoted(std::string_view line, std::size_t& at) {
  const std::size_t begin = line.find('"', at), end = begin == std::string_view::npos ? begin : line.find('"', begin + 1);
  if (end == std::string_view::npos) return {};
  at = end + 1;
  return line.substr(begin + 1, end - begin - 1);
}

// Parses "name = { value = "1 m", range = ["0.5 m", "2 m"], meaning = "…" } # source".
std::optional<TemplateParameter> parameter_in(std::string_view line, std::size_t offset) {
  const std::size_t table = line.find(" = { value = \"");
  if (table == std::string_view::npos || line.find(' ') != table) return std::nullopt;
  TemplateParameter parameter;
  parameter.name = line.substr(0, table);
  std::size_t at = table;
  const std::string_view value = quoted(line, at);
  parameter.value = value;
  parameter.begin = offset + static_cast<std::size_t>(value.data() - line.data());
  parameter.end = parameter.begin + value.size();
  parameter.low = quoted(line, at);
  parameter.high = quoted(line, at);
  parameter.meaning = quoted(line, at);
  if (const std::size_t source = line.find("# ", at); source != std::string_view::npos) parameter.source = line.substr(source + 2);
  return parameter;
}

const ModelTemplate& template_called(const std::string& kind) {
  std::vector<std::string> names;
  for (const ModelTemplate& one : model_templates()) {
    if (one.name == kind) return one;
    names.push_back(one.name);
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  throw UsageError("there is no kind '" + kind + "' to start from" + did_you_mean(kind, names) + "; there are " + list);
}

// Returns the template with the values given by the user. If `only` names an option, the other parameters keep the template's values.
std::string filled(const ModelTemplate& one, const NewOptions& options, const std::string& only = "") {
  std::string text(one.text);
  std::vector<TemplateParameter> parameters = one.parameters();
  std::reverse(parameters.begin(), parameters.end()); // replaced from the end, so that earlier positions remain valid
  for (const TemplateParameter& p : parameters) {
    const auto given = options.values.find(p.option());
    if (given != options.values.end() && given->second && (only.empty() || only == p.option()))
      text.replace(p.begin, p.end - p.begin, *given->second);
  }
  return text;
}

void refuse_wrong_values(const ModelTemplate& one, const NewOptions& options) {
  const std::vector<TemplateParameter> known = one.parameters();
  for (const auto& [option, value] : options.values) {
    if (!value) continue;
    const auto parameter = std::find_if(known.begin(), known.end(), [&option](const TemplateParameter& p) { return p.option() == option; });
    if (parameter == known.end()) {
      std::string list;
      for (const TemplateParameter& p : known) list += (list.empty() ? "" : ", ") + p.option();
      throw UsageError("a " + one.name + " has no " + option + "; it takes " + list);
    }
    const std::string problem = option + " \"" + *value + "\": give a value from " + parameter->low + " to " + parameter->high;
    if (value->find_first_of("\"\\\n") != std::string::npos || value->starts_with("=")) throw UsageError(problem);
    try {
      (void)parse_given_model(filled(one, options, option), one.name + ".toml", program_catalogue());
    } catch (const ModelError&) {
      throw UsageError(problem);
    }
  }
}

ExitCode write_model(const NewOptions& options, Console& console) {
  const ModelTemplate& one = template_called(options.kind);
  refuse_wrong_values(one, options);
  const std::string text = filled(one, options);
  // Values that are valid individually may be incompatible. Reading the new model now reports this before the file is written.
  const auto loaded = load_given(parse_given_model(text, one.name + ".toml", program_catalogue()), one.name);
  for (const Finding& finding : findings_of(*loaded))
    if (finding.level == FindingLevel::warning) log_warning(finding.text);
  const std::string output = options.output.value_or("-");
  const OutputFiles files(console, {{"-o", output}}, options.is_overwriting);
  files.write(output, text);
  if (files.may_print()) console.out << "Written to " << output << ". Look at it, then: steplap simulate " << output << " --report\n";
  return ExitCode::done;
}

} // namespace

std::string TemplateParameter::option() const {
  std::string text = "--" + name;
  std::replace(text.begin(), text.end(), '_', '-');
  return text;
}

std::vector<TemplateParameter> ModelTemplate::parameters() const {
  std::vector<TemplateParameter> found;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (auto parameter = parameter_in(text.substr(begin, end - begin), begin)) found.push_back(std::move(*parameter));
    begin = end + 1;
  }
  return found;
}

Command new_command() {
  const auto o = std::make_shared<NewOptions>();
  Command command;
  command.name = "new";
  command.summary = "a commented model to start from: a block, a machine on mounts, a transformer on a trailer";
  command.examples = R"(  steplap new block -o block.toml
  steplap new transformer --window-height "1.9 m" --pressure "0.1 MPa" -o mine.toml
  steplap new machine > machine.toml
Each dimension becomes a line of [parameters] with its meaning and its source, and fields follow from it by formulas: change the file, or set
parameters.NAME for one run. Values are SI or carry a unit.
)";
  command.options = {{"KIND", &o->kind, "KIND", "block, machine or transformer", true},
                     {"-o,--output", &o->output, "FILE", "the file to write (default: the standard output)"},
                     {"-f,--force", &o->is_overwriting, "", "overwrite an earlier file"}};
  std::map<std::string, std::string> docs; // help texts by option; several templates may have the same option
  std::vector<std::string> order;
  for (const ModelTemplate& one : model_templates())
    for (const TemplateParameter& p : one.parameters()) {
      const std::string doc = one.name + ": " + p.meaning + " (default: " + p.value + "; " + p.low + " to " + p.high + ")";
      if (docs.contains(p.option())) docs[p.option()] += "; " + doc;
      else {
        docs[p.option()] = doc;
        order.push_back(p.option());
      }
    }
  for (const std::string& option : order) command.options.push_back({option, &o->values[option], "VALUE", docs[option]});
  command.run = [o](Console& console) { return write_model(*o, console); };
  return command;
}

} // namespace steplap
