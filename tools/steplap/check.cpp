#include "tools/steplap/commands.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/formula/unit_dimension.h"
#include "mbd/io/atomic_file.h"
#include "mbd/io/read_input.h"
#include "mbd/model/formula_fields.h"
#include "mbd/model/validate.h"
#include "mbd/rest/assembly.h"
#include "mbd/rest/freedom.h"
#include "mbd/run/findings.h"
#include "mbd/run/quantity_text.h"
#include "mbd/run/run.h"
#include "mbd/run/start_contacts.h"
#include "mbd/system/one_sided_row.h"
#include "tools/steplap/cross.h"
#include "tools/steplap/model_update.h"
#include "tools/steplap/text_table.h"
#include "transformer/program.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <ostream>

namespace steplap {

namespace {

using Align = TextTable::Align;

constexpr std::size_t k_shown_moves = 20, k_shown_contacts = 40;

struct CheckOptions {
  std::vector<std::string> models;
  std::vector<std::string> overrides;
  bool is_crossed = false;
  bool is_updated = false; ///< true: the files are updated
  std::optional<std::string> cpu_limit;
  std::optional<std::string> parameter; ///< parameter whose uses are listed
};

constexpr double k_usual_cpu_limit = 60.0; // CPU time for the runs of --cross together, s

double cpu_limit_of(const CheckOptions& options) {
  if (!options.cpu_limit) return k_usual_cpu_limit;
  char* end = nullptr;
  const double value = std::strtod(options.cpu_limit->c_str(), &end);
  if (options.cpu_limit->empty() || *end != '\0' || !(value > 0.0))
    throw UsageError("--cpu-limit: '" + *options.cpu_limit + "' should be a number of seconds above zero");
  return value;
}

// Returns "16: 2 unilateral_contact, 1 weld".
template <class Entries, class KindOf> std::string counts_text(const Entries& entries, KindOf kind_of) {
  std::map<std::string, int> counts;
  for (const auto& entry : entries) ++counts[kind_of(entry)];
  std::string text = std::to_string(entries.size());
  const char* separator = ": ";
  for (const auto& [kind, count] : counts) {
    text += separator + std::to_string(count) + " " + kind;
    separator = ", ";
  }
  return text;
}

std::string bodies_text(const Model& model) {
  double mass = 0.0;
  std::size_t fixed = 0;
  for (const Body& body : model.bodies) body.fixed ? static_cast<void>(++fixed) : static_cast<void>(mass += body.mass);
  std::string text = std::to_string(model.bodies.size());
  if (fixed > 0) text += ", " + std::to_string(fixed) + " of them fixed";
  char rounded[32]; // eight digits: the computed mass of sheets has more
  std::snprintf(rounded, sizeof rounded, "%.8g", mass);
  return text + "; " + rounded + " kg move";
}

std::string run_text(const Model& model) {
  const SimulationSettings& s = model.simulation;
  std::string text = s.integrator + ", 0 to " + number_text(s.end) + " s";
  if (s.step) {
    text += ", step " + number_text(*s.step) + " s";
    if (has_fixed_step(s.integrator))
      text += " (" + number_text(std::ceil(s.end / *s.step - 1e-9)) + (s.end / *s.step > 1.0 + 1e-9 ? " steps)" : " step)");
  }
  if (s.tolerance) text += ", tolerance " + number_text(*s.tolerance);
  return text + "; starts " + (s.initial == "equilibrium" ? "from equilibrium" : "as given");
}

void print_freedom(TextTable& table, const System& system) {
  const DegreesOfFreedom freedom = count_freedom(system);
  table.add_row({"coordinates", count_cell(static_cast<std::size_t>(freedom.coordinates))});
  std::string rows = std::to_string(freedom.rows);
  if (freedom.rank < freedom.rows) {
    rows += ", only " + std::to_string(freedom.rank) + " of them independent";
  }
  table.add_row({"constraint rows", rows});
  std::string degrees = std::to_string(freedom.degrees());
  if (!system.frictions.empty())
    degrees +=
        "; " + std::to_string(freedom.degrees_sticking()) +
        (first_one_sided_row(system) ? " while all friction sticks and all inextensible ropes are taut" : " while all friction sticks");
  table.add_row({"degrees of freedom", degrees});
}

// Prints the given values that assembly changed, and the initial state.
void print_assembly(std::ostream& out, const LoadedModel& loaded) {
  const System& system = *loaded.system;
  const auto moves = assembly_moves(system.initial_state(), loaded.assembled);
  if (moves.empty()) return;
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right});
  table.set_head("assembled", {"assembled", "moved", "turned", "velocity changed", "angular velocity"},
                 {"body", "moved", "turned", "velocity changed", "angular velocity"});
  for (std::size_t i = 0; i < std::min(moves.size(), k_shown_moves); ++i) {
    const AssemblyMove& m = moves[i];
    table.add_row({system.bodies[m.body].name, quantity_cell(m.shift, "m", 1e-3), quantity_cell(m.turn, "rad", 1e-3),
                   quantity_cell(m.velocity, "m/s", 1e-3), quantity_cell(m.angular_velocity, "rad/s", 1e-3)});
  }
  out << table;
  if (moves.size() > k_shown_moves) out << "  and " << counted(moves.size() - k_shown_moves, "body", "bodies") << " that moved less\n";
}

// Returns the initial state: at rest if the model asks for equilibrium, otherwise as assembled. If no equilibrium exists, returns the
// assembled state; the run reports the error.
State start_to_show(const LoadedModel& loaded, std::string& title) {
  const bool is_at_rest = loaded.model.simulation.initial == "equilibrium";
  title = is_at_rest ? "contact at rest" : "contact at the start";
  try {
    return beginning_of(loaded, !is_at_rest);
  } catch (const NumericalFailure&) {
    title = "contact as given";
    return beginning_of(loaded, true);
  }
}

// Prints all contacts with their gaps or forces.
void print_contacts(std::ostream& out, const LoadedModel& loaded) {
  std::string title;
  if (loaded.system->contact_count == 0) return;
  const State start = start_to_show(loaded, title);
  const std::vector<ContactAtStart> contacts = contacts_at(loaded, start);
  double largest = 0.0;
  for (const ContactAtStart& contact : contacts) largest = std::max(largest, contact.force);
  TextTable table({Align::left, Align::left, Align::right, Align::right, Align::right, Align::right});
  table.set_head("contacts", {title, "between", "gap", "force", "at x", "y"}, {"contact", "between", "gap", "force", "x", "y"});
  const auto name = [&](int body) { return body == k_ground ? std::string("ground") : loaded.system->bodies[body].name; };
  for (std::size_t i = 0; i < std::min(contacts.size(), k_shown_contacts); ++i) {
    const ContactAtStart& c = contacts[i];
    const double size = size_of_pair(*loaded.system, c.a, c.b);
    table.add_row({c.entry->element->name, name(c.a) + ", " + name(c.b), quantity_cell(c.gap, "m", size),
                   c.force > 0.0 ? quantity_cell(c.force, "N", largest) : Cell("-", 0.0, "N"), quantity_cell(c.place.x(), "m", size),
                   quantity_cell(c.place.y(), "m", size)});
  }
  out << table;
  if (contacts.size() > k_shown_contacts)
    out << "  and " << counted(contacts.size() - k_shown_contacts, "contact", "contacts") << " more\n";
}

// Formats a value with its unit. Six digits suffice to recognise it; values of formulas have all.
std::string with_unit(double value, const std::string& unit) {
  char rounded[32];
  std::snprintf(rounded, sizeof rounded, "%.6g", value);
  return rounded + (unit.empty() ? "" : " " + unit);
}

Cell parameter_value(const Parameters& parameters, std::size_t i) {
  const std::string unit = unit_text(parameters.entries[i].powers);
  return {with_unit(parameters.values[i], unit), parameters.values[i], unit};
}

std::string parameter_range(const Parameter& parameter) {
  if (!parameter.least || !parameter.most) return "";
  const std::string unit = unit_text(parameter.powers);
  return number_text(*parameter.least) + " to " + number_text(*parameter.most) + (unit.empty() ? "" : " " + unit);
}

void print_parameters(std::ostream& out, const Parameters& parameters) {
  if (parameters.entries.empty()) return;
  TextTable table({Align::left, Align::left, Align::right, Align::left, Align::left});
  table.set_head("parameters", {"parameter", "given as", "value", "range", "meaning"});
  for (std::size_t i = 0; i < parameters.entries.size(); ++i) {
    const Parameter& p = parameters.entries[i];
    table.add_row({p.name, p.text, parameter_value(parameters, i), parameter_range(p), p.meaning});
  }
  out << table;
}

// Lists formulas of forces and states that use a parameter directly or indirectly, and returns their number.
std::size_t add_formulas(TextTable& table, const Model& model, std::size_t asked) {
  const Parameters& parameters = model.parameters;
  const auto follows = [&](const std::string& name) {
    const std::optional<std::size_t> found = parameters.find(name);
    if (!found) return false;
    const Parameter& parameter = parameters.entries[*found];
    return *found == asked || (parameter.formula && parameters.needs(*parameter.formula, asked));
  };
  std::size_t count = 0;
  for (const ElementEntry& entry : model.elements) {
    const std::vector<std::string> names = names_in_formulas(entry);
    if (std::none_of(names.begin(), names.end(), follows)) continue;
    for (const Field& field : entry.kind->fields.fields()) {
      if (!is_formula_field(field)) continue;
      ++count;
      const Location& where = entry.element->where;
      table.add_row({entry.element->name + "." + field.name, std::get<std::string>(field.get(entry.element.get())), "",
                     where.file + ":" + std::to_string(where.line)});
    }
  }
  return count;
}

// Lists everything that depends on a parameter: other parameters, then fields, with their values.
void print_uses(std::ostream& out, const LoadedModel& loaded, const std::string& name) {
  const Parameters& parameters = loaded.model.parameters;
  const std::optional<std::size_t> asked = parameters.find(name);
  if (!asked) {
    std::vector<std::string> known;
    for (const Parameter& parameter : parameters.entries) known.push_back(parameter.name);
    throw UsageError("--uses: " + loaded.path + " has no parameter '" + name + "'" + did_you_mean(name, known));
  }
  TextTable table({Align::left, Align::left, Align::right, Align::left});
  table.set_head("uses", {"what follows", "formula", "value", "place"}, {"path", "formula", "value", "place"});
  const auto place = [](const Location& where) { return where.file + ":" + std::to_string(where.line); };
  for (std::size_t i = 0; i < parameters.entries.size(); ++i) {
    const Parameter& p = parameters.entries[i];
    if (p.formula && parameters.needs(*p.formula, *asked))
      table.add_row({"parameters." + p.name, p.text, parameter_value(parameters, i), place(p.where)});
  }
  std::size_t uses = 0;
  for (const ParameterUse& use : parameters.uses) {
    if (!parameters.needs(use.formula, *asked)) continue;
    ++uses;
    const double value = use.formula.value(parameters.values);
    table.add_row({use.path, use.text, Cell(with_unit(value, use.unit), value, use.unit), place(use.where)});
  }
  uses += add_formulas(table, loaded.model, *asked);
  out << About{loaded.path} << loaded.path << ": '" << name << "' is " << parameter_value(parameters, *asked).text << "; "
      << counted(uses, "field follows", "fields follow") << " from it\n"
      << table;
}

void print_model(std::ostream& out, const LoadedModel& loaded) {
  const Model& model = loaded.model;
  out << About{loaded.path} << loaded.path << ": fine\n";
  TextTable table({Align::left, Align::left});
  table.set_name("model");
  if (!model.header.title.empty()) table.add_row({"title", model.header.title});
  table.add_row({"bodies", bodies_text(model)});
  table.add_row({"signals", counts_text(model.signals, [](const SignalEntry& e) { return e.kind->name; })});
  table.add_row({"elements", counts_text(model.elements, [](const ElementEntry& e) { return e.kind->name; })});
  print_freedom(table, *loaded.system);
  table.add_row({"run", run_text(model)});
  const Trajectory channels(*loaded.system, model.output.channels);
  table.add_row({"output", counted(channels.channels().size(), "channel", "channels") + " every " + number_text(model.output.step) +
                               " s, " + number_text(trajectory_rows(model)) + " rows"});
  out << table;
  print_parameters(out, model.parameters);
  print_assembly(out, loaded);
  print_contacts(out, loaded);
  for (const Finding& finding : findings_of(loaded))
    out << (finding.level == FindingLevel::warning ? "  warning: " : "  note: ") << text_with_place(finding) << "\n";
}

// Prints one note that lists the model files without `format = 1`.
void note_missing_format(std::ostream& out, const std::vector<std::shared_ptr<const LoadedModel>>& models) {
  std::vector<std::string> files;
  for (const auto& loaded : models)
    for (const std::string& file : loaded->model.files_without_format)
      if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  if (files.empty()) return;
  out << "  note: " << shown_input(files.front());
  if (files.size() > 1) out << " and " << counted(files.size() - 1, "other file", "other files");
  out << (files.size() > 1 ? " do" : " does") << " not say `format = 1`, which later versions of steplap ask for: check --update adds it\n";
}

ExitCode update_files(const CheckOptions& options, Console& console) {
  if (!options.overrides.empty()) throw UsageError("--update rewrites the file itself, so --set is not allowed: leave --set out");
  for (const std::string& path : options.models)
    if (is_standard_input(path)) throw UsageError("--update rewrites a file, and the standard input is none: name the file");
  for (const auto& loaded : load_models(options.models)) {
    const ModelUpdate update = updated(read_input(loaded->path, {}), loaded->path, loaded->model);
    if (update.adds_format || update.renamed_keys > 0) write_file(loaded->path, update.text, IfExists::replace);
    console.out << loaded->path << ": ";
    if (update.adds_format) console.out << "format = 1 added";
    if (update.renamed_keys > 0)
      console.out << (update.adds_format ? ", " : "") << counted(update.renamed_keys, "key", "keys") << " renamed";
    if (!update.adds_format && update.renamed_keys == 0) console.out << "up to date";
    console.out << "\n";
    for (const std::string& file : loaded->model.files_without_format)
      if (file != loaded->path) console.out << "  note: " << file << ", which it uses, does not say `format = 1`: update it as well\n";
    if (update.missing_keys > 0)
      console.out << "  note: " << counted(update.missing_keys, "key", "keys")
                  << " with an earlier name in other files: update these as well\n";
  }
  return ExitCode::done;
}

ExitCode check(const CheckOptions& options, Console& console) {
  if (options.is_updated) return update_files(options, console);
  const double cpu_limit = cpu_limit_of(options);
  const auto models = load_models(options.models, options.overrides);
  if (options.is_crossed) return cross_check_models(models, cpu_limit, console);
  if (options.parameter) {
    for (const auto& loaded : models) print_uses(console.out, *loaded, *options.parameter);
    return ExitCode::done;
  }
  if (console.verbosity == Verbosity::quiet) return ExitCode::done;
  for (const auto& loaded : models) print_model(console.out, *loaded);
  note_missing_format(console.out, models);
  return ExitCode::done;
}

} // namespace

Command check_command() {
  const auto o = std::make_shared<CheckOptions>();
  Command command;
  command.name = "check";
  command.summary = "read models, report all errors, count what is in them; with --cross run them by several methods";
  command.examples = R"(  steplap check my.toml
  steplap check models/paper/*.toml
  steplap check --cross my.toml
--update adds `format = 1` and gives renamed keys their present names; comments and layout stay.
Without --cross nothing is run. With it each model is run by explicit, implicit and time stepping methods, each at
two or three settings, and what they differ by is compared with their own error estimates: exit code 4 if anything
disagrees beyond these.
)";
  command.options = {{"MODEL", &o->models, "FILE", "model files (TOML); - is the standard input", true},
                     {"--set", &o->overrides, "PATH=VALUE", "lay a value over the model; may be repeated"},
                     {"--uses", &o->parameter, "NAME", "show all that follows from this parameter, instead of the counts"},
                     {"--update", &o->is_updated, "", "rewrite the files for this version of steplap"},
                     {"--cross", &o->is_crossed, "", "run each model by methods that share little, and compare"},
                     {"--cpu-limit", &o->cpu_limit, "S",
                      "with --cross: CPU time of all runs together, s; each method may take an even part of what is left (default: 60)"}};
  command.prints_tables = true;
  command.run = [o](Console& console) { return check(*o, console); };
  return command;
}

} // namespace steplap
