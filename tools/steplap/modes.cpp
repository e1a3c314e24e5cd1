#include "tools/steplap/commands.h"

#include "mbd/io/csv.h"
#include "mbd/rest/modes.h"
#include "mbd/run/run.h"
#include "tools/pages/modes_page.h"
#include "tools/steplap/log.h"
#include "tools/steplap/output_files.h"
#include "tools/steplap/text_table.h"
#include "transformer/program.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <ostream>

namespace steplap {

namespace {

using Align = TextTable::Align;

struct ModesOptions {
  std::string model;
  std::vector<std::string> overrides;
  std::optional<std::string> output, page, count, near;
  bool is_overwriting = false;
};

std::string fixed_text(double value, const char* format) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

// Returns the coordinates with the largest amplitudes: "active part.theta 1.00, upper tank.x 0.42".
std::string shape_text(const System& system, const VibrationMode& mode) {
  struct Part {
    std::string name;
    double size, value;
  };
  std::vector<Part> parts;
  for (int i = 1; i < system.body_count(); ++i) {
    const BodyData& body = system.bodies[i];
    const double gyration = std::sqrt(body.inertia / body.mass);
    static constexpr const char* names[] = {".x", ".y", ".theta"};
    for (int c = 0; c < 3; ++c) {
      const std::complex<double> part = (c < 2 ? 1.0 : gyration) * mode.shape[3 * i + c];
      const double size = size_of(part);
      parts.push_back({body.name + names[c], size, std::copysign(size, part.real())});
    }
  }
  constexpr std::size_t k_shown = 3;
  const std::size_t shown = std::min(k_shown, parts.size());
  std::partial_sort(parts.begin(), parts.begin() + shown, parts.end(), [](const Part& a, const Part& b) { return a.size > b.size; });
  std::string text;
  for (std::size_t i = 0; i < shown && parts[i].size >= 0.05; ++i)
    text += (i ? ", " : "") + parts[i].name + " " + fixed_text(parts[i].value, "%.2f");
  return text;
}

WantedModes wanted_modes(const ModesOptions& options) {
  WantedModes wanted;
  const auto number = [](const char* option, const std::string& text, const char* what) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value > 0.0) || std::isinf(value))
      throw UsageError(std::string(option) + ": '" + text + "' should be " + what);
    return value;
  };
  if (options.count) {
    const char* const what = "a whole number from 1 to 500";
    const double count = number("--count", *options.count, what);
    if (count != std::floor(count) || count > 500.0) throw UsageError("--count: '" + *options.count + "' should be " + what);
    wanted.count = static_cast<int>(count);
  }
  if (options.near) wanted.near = number("--near", *options.near, "a frequency in Hz above zero");
  return wanted;
}

// Describes which part of the modes was computed and how accurate they are, if not all were computed.
std::string choice_text(const VibrationModes& found, const WantedModes& wanted) {
  double worst = 0.0;
  for (const VibrationMode& mode : found.modes) worst = std::max(worst, mode.residual);
  return "The " + std::to_string(found.modes.size()) +
         (wanted.near ? " nearest to " + fixed_text(*wanted.near, "%g Hz") : std::string(" slowest")) +
         " (--count N: more of them). None is out of balance by more than " + fixed_text(worst, "%.1g") + " of its own acceleration; " +
         (found.is_counted ? "that none is missing was counted"
                           : "whether one is missing was not counted, since there is damping or a stiffness that is not symmetric");
}

// Prints the reason why there are no modes.
void print_none(std::ostream& out, const VibrationModes& found) {
  out << "None: "
      << (found.rigid_motions > 0 ? "of what can move nothing is held" : "joints, drives and friction that sticks leave no motion free")
      << "\n";
}

void print_modes(std::ostream& out, const LoadedModel& loaded, const VibrationModes& found, const WantedModes& wanted) {
  out << About{loaded.path} << loaded.name << ": small vibrations about equilibrium, closed contacts and sticking joints held\n\n";
  TextTable table({Align::right, Align::right, Align::right, Align::right, Align::left});
  table.set_head("modes", {"mode", "frequency", "damped", "damping", "what moves most (turning as at the radius of gyration)"},
                 {"mode", "frequency", "damped", "damping", "what moves most"});
  for (std::size_t i = 0; i < found.modes.size(); ++i) {
    const VibrationMode& mode = found.modes[i];
    table.add_row({count_cell(i + 1), Cell(fixed_text(mode.natural_frequency(), "%.4f Hz"), mode.natural_frequency(), "Hz"),
                   mode.oscillates() ? Cell(fixed_text(mode.frequency(), "%.4f Hz"), mode.frequency(), "Hz") : Cell("-"),
                   mode.oscillates() ? Cell(fixed_text(std::round(1e5 * mode.damping_ratio()) / 1e3 + 0.0, "%.3f %%"),
                                            100.0 * mode.damping_ratio(), "%") // avoids "-0.000"
                                     : Cell(fixed_text(mode.eigenvalue.real(), "%.4g /s"), mode.eigenvalue.real(), "1/s"),
                   shape_text(*loaded.system, mode)});
  }
  if (found.modes.empty()) print_none(out, found);
  else out << table;
  if (!found.is_all) out << "\n" << choice_text(found, wanted) << "\n";
  if (found.rigid_motions > 0)
    out << "\n"
        << (found.rigid_motions == 1 ? std::string("1 coordinate moves freely: nothing holds the scene along it")
                                     : std::to_string(found.rigid_motions) + " coordinates move freely: nothing holds the scene along them")
        << "\n";
}

std::string modes_csv(const System& system, const VibrationModes& found) {
  std::vector<std::string> names{"natural frequency [Hz]", "frequency [Hz]",       "damping ratio",
                                 "real part [1/s]",        "imaginary part [1/s]", "residual"};
  for (int i = 1; i < system.body_count(); ++i)
    for (const char* coordinate : {"x", "y", "theta"})
      for (const char* part : {"real", "imaginary"}) names.push_back(system.bodies[i].name + "." + coordinate + " " + part);
  CsvText csv(names);
  for (const VibrationMode& mode : found.modes) {
    std::vector<double> row{mode.natural_frequency(), mode.frequency(),       mode.damping_ratio(),
                            mode.eigenvalue.real(),   mode.eigenvalue.imag(), mode.residual};
    for (std::size_t k = 3; k < mode.shape.size(); ++k) {
      row.push_back(mode.shape[k].real());
      row.push_back(mode.shape[k].imag());
    }
    csv.add_row(row);
  }
  return csv.text();
}

std::vector<std::string> all_remarks(const LoadedModel& loaded, const Equilibrium& rest) {
  std::vector<std::string> remarks = remarks_on(*loaded.system, rest);
  for (std::string& remark : remarks_on_modes(*loaded.system, rest.state)) remarks.push_back(std::move(remark));
  return remarks;
}

std::string page_of(const LoadedModel& loaded, const Equilibrium& rest, const VibrationModes& found, const WantedModes& wanted) {
  std::vector<std::string> moves_most;
  for (const VibrationMode& mode : found.modes) moves_most.push_back(shape_text(*loaded.system, mode));
  std::vector<std::string> remarks = all_remarks(loaded, rest);
  if (!found.is_all) remarks.push_back(choice_text(found, wanted));
  return modes_page(loaded, rest, found, moves_most, remarks);
}

ExitCode modes(const ModesOptions& options, Console& console) {
  const WantedModes wanted = wanted_modes(options);
  const OutputFiles files(console, {{"-o", options.output}, {"--report", options.page}}, options.is_overwriting);
  const auto loaded = load_model(options.model, options.overrides);
  try {
    const Equilibrium rest = equilibrium_of(*loaded);
    State state = rest.state;
    std::fill(state.v.begin(), state.v.end(), 0.0);
    const VibrationModes found = vibration_modes(*loaded->system, state, wanted);
    if (options.output) files.write(options.output, modes_csv(*loaded->system, found));
    if (options.page) files.write(options.page, page_of(*loaded, rest, found, wanted));
    if (files.may_print()) print_modes(console.out, *loaded, found, wanted);
    for (const std::string& remark : all_remarks(*loaded, rest)) log_warning("'" + loaded->path + "': " + remark);
  } catch (const NumericalFailure& failure) {
    log_error("'" + loaded->path + "': " + failure.what());
    return ExitCode::numerical_failure;
  }
  return ExitCode::done;
}

} // namespace

Command modes_command() {
  const auto o = std::make_shared<ModesOptions>();
  Command command;
  command.name = "modes";
  command.summary = "natural frequencies, damping and shapes of small vibrations about equilibrium";
  command.examples = R"(  steplap modes models/paper/no_interference.toml
  steplap modes my.toml -o modes.csv
  steplap modes my.toml --report modes.html
  steplap modes large.toml --count 10 --near 12.5
Of more than 1500 coordinates (three a body) the slowest 20 modes are found, or as many as --count says; of fewer all, unless asked otherwise.
A mode that does not oscillate shows its rate of decay instead of a damping ratio.
)";
  command.options = {{"MODEL", &o->model, "FILE", "model file (TOML); - is the standard input", true},
                     {"-o,--output", &o->output, "FILE",
                      "also write frequencies and shapes as CSV; - is the standard output, which then holds nothing else"},
                     {"--report", &o->page, "FILE", "also write a page that shows each mode in motion; or -"},
                     {"--count", &o->count, "N", "only so many modes: the slowest, or the nearest to --near"},
                     {"--near", &o->near, "HZ", "modes near this frequency instead of the slowest"},
                     {"--set", &o->overrides, "PATH=VALUE", "lay a value over the model; may be repeated"},
                     {"-f,--force", &o->is_overwriting, "", "overwrite the file"}};
  command.prints_tables = true;
  command.run = [o](Console& console) { return modes(*o, console); };
  return command;
}

} // namespace steplap
