#include "tools/steplap/commands.h"

#include "mbd/base/shown_text.h"
#include "mbd/run/edges.h"
#include "mbd/run/prominence.h"
#include "mbd/run/quantity_text.h"
#include "mbd/run/rest_values.h"
#include "mbd/run/run.h"
#include "mbd/system/actions.h"
#include "tools/steplap/log.h"
#include "tools/steplap/text_table.h"
#include "tools/steplap/tipping_text.h"
#include "transformer/program.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <ostream>

namespace steplap {

namespace {

using Align = TextTable::Align;

constexpr double k_unit = 1e-3; // scale of displacements, m and rad: values below 1e-9 times this are shown as zero

const char* const k_of_one_rest = " at this rest, which is one of many: they depend on the path, since friction holds the machine";

struct EquilibriumOptions {
  std::vector<std::string> models;
  std::vector<std::string> overrides;
};

void print_poses(std::ostream& out, const System& system, const State& start, const State& found) {
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right});
  table.set_head("poses", {"body", "x", "y", "angle", "moved x", "moved y", "turned"});
  for (std::size_t i = 1; i < system.bodies.size(); ++i) {
    const double* q = &found.q[3 * i];
    const double* q0 = &start.q[3 * i];
    TextTable::Row row{system.bodies[i].name};
    for (int k = 0; k < 3; ++k) row.push_back(quantity_cell(q[k], k < 2 ? "m" : "rad", k_unit));
    for (int k = 0; k < 3; ++k) row.push_back(quantity_cell(q[k] - q0[k], k < 2 ? "m" : "rad", k_unit));
    table.add_row(row);
  }
  out << table;
}

void print_reactions(std::ostream& out, const System& system, const std::vector<double>& values, const Equilibrium& found) {
  std::map<std::string, double> scale; // largest absolute value per unit
  for (std::size_t i = 0; i < values.size(); ++i)
    scale[system.channels[i].unit] = std::max(scale[system.channels[i].unit], std::abs(values[i]));
  TextTable table({Align::left, Align::right});
  table.set_name("reactions");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Channel& channel = system.channels[i];
    if (is_reaction(channel)) table.add_row({channel.name, quantity_cell(values[i], channel.unit, scale[channel.unit])});
  }
  if (!table.is_empty()) out << "\nReactions" << (found.depends_on_path ? k_of_one_rest : "") << "\n" << table;
}

// Prints by which factor the present load could grow before each friction element slips.
void print_margins(std::ostream& out, const System& system, const std::vector<FrictionMargin>& margins, bool depends_on_path) {
  TextTable table({Align::left, Align::right, Align::right});
  table.set_head("friction", {"friction", "used", "slips at"});
  for (const FrictionMargin& margin : margins)
    table.add_row({system.element_names[system.frictions[margin.friction].element],
                   Cell(quantity_text(100.0 * margin.used, "%", 1.0), 100.0 * margin.used, "%"),
                   margin.used > 0.0 ? Cell(quantity_text(1.0 / margin.used, "times its load", 1.0), 1.0 / margin.used, "times its load")
                                     : Cell("carries no load at rest")});
  if (!margins.empty()) out << "\nDistance from slipping" << (depends_on_path ? k_of_one_rest : "") << "\n" << table;
}

void print_equilibrium(std::ostream& out, const LoadedModel& loaded, const Equilibrium& found) {
  out << About{loaded.path} << loaded.name << ": in stable equilibrium, "
      << (found.is_settled ? "where the machine settles from the pose given when it is strongly damped, after " +
                                 counted(static_cast<std::size_t>(found.settling_steps), "time step", "time steps") + " and "
                           : "the nearest downhill, after ")
      << counted(static_cast<std::size_t>(found.iterations), "iteration", "iterations") << "; acceleration left "
      << small_text(found.residual) << " m/s²; moved at most " << quantity_text(found.moved, "m", k_unit) << "\n\n";
  print_poses(out, *loaded.system, loaded.system->initial_state(), found.state);
  const std::unique_ptr<System> system = compile(loaded.model); // a copy, because drives are held fixed in it
  const std::vector<double> values = values_at_rest(*system, found.state);
  print_reactions(out, *system, values, found);
  print_margins(out, *loaded.system, found.margins, found.depends_on_path);
  print_tipping(out, loaded, found.state);
  std::vector<std::string> remarks = remarks_on(*loaded.system, found);
  for (std::string& text : tipping_over(loaded, loaded.assembled)) remarks.push_back(std::move(text));
  if (const std::string action = action_met_at(*loaded.system, found.state); !action.empty())
    remarks.push_back("the condition of action '" + action + "' is met here: this is the rest before it");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Channel& channel = system->channels[i];
    if (channel.role == ChannelRole::strength_use && values[i] >= 1.0)
      remarks.push_back("'" + channel.name.substr(0, channel.name.rfind('.')) + "' breaks: it would have to carry " +
                        quantity_text(100.0 * values[i], "%", 1.0) + " of its strength");
  }
  if (!remarks.empty()) out << "\n";
  for (const std::string& remark : remarks) out << "Note: " << remark << "\n";
}

ExitCode equilibrium(const EquilibriumOptions& options, Console& console) {
  ExitCode code = ExitCode::done;
  for (const auto& loaded : load_models(options.models, options.overrides)) {
    try {
      const Equilibrium found = equilibrium_of(*loaded);
      if (console.verbosity != Verbosity::quiet) print_equilibrium(console.out, *loaded, found);
      for (const Finding& finding : contacts_beyond_edges(*loaded, found.state))
        log_warning("'" + loaded->path + "': " + text_with_place(finding));
    } catch (const NumericalFailure& failure) {
      log_error("'" + loaded->path + "': " + failure.what());
      code = ExitCode::numerical_failure;
    }
  }
  return code;
}

} // namespace

Command equilibrium_command() {
  const auto o = std::make_shared<EquilibriumOptions>();
  Command command;
  command.name = "equilibrium";
  command.summary = "the pose in which models rest, and the reactions there";
  command.examples = R"(  steplap equilibrium models/paper/no_interference.toml
From the poses given the machine gives way downhill along its joints; friction that is loaded holds where it is.
Where there is no rest, what moves and why is told.
)";
  command.options = {{"MODEL", &o->models, "FILE", "model files (TOML); - is the standard input", true},
                     {"--set", &o->overrides, "PATH=VALUE", "lay a value over the model; may be repeated"}};
  command.prints_tables = true;
  command.run = [o](Console& console) { return equilibrium(*o, console); };
  return command;
}

} // namespace steplap
