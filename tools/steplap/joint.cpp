#include "tools/steplap/commands.h"

#include "elements/step_lap/joint_view.h"
#include "mbd/base/number_text.h"
#include "mbd/io/units.h"
#include "mbd/run/quantity_text.h"
#include "mbd/run/run.h"
#include "tools/steplap/text_table.h"
#include "transformer/program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <ostream>
#include <sstream>

namespace steplap {

namespace {

using Align = TextTable::Align;

struct JointOptions {
  std::string model;
  std::vector<std::string> overrides;
  std::vector<std::string> joints;
  std::optional<std::string> wrench;
};

std::vector<JointView> chosen_joints(const JointOptions& options, const LoadedModel& loaded) {
  std::vector<JointView> all = joint_views(loaded.model, *loaded.system), chosen;
  if (all.empty()) throw UsageError("'" + loaded.path + "' has no step-lap joint");
  if (options.joints.empty()) return all;
  std::vector<std::string> known;
  for (const JointView& view : all) known.push_back(view.joint->name);
  for (const std::string& name : options.joints) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) throw UsageError("'" + loaded.path + "' has no step-lap joint '" + name + "'" + did_you_mean(name, known));
    chosen.push_back(all[static_cast<std::size_t>(found - known.begin())]);
  }
  return chosen;
}

// Parses a wrench such as "53 kN, 0, 1.2e4"; SI if there is no unit.
Vec3 parse_wrench(const std::string& text) {
  static const std::array<const char*, 3> units = {"N", "N", "N m"};
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  if (parts.size() != 3 || text.back() == ',')
    throw UsageError("--wrench '" + text + "': expected three values Fx,Fy,M, as in \"53 kN,-88 kN,0\"");
  Vec3 wrench;
  for (std::size_t i = 0; i < 3; ++i) {
    std::istringstream number(parts[i]);
    std::string rest;
    if (number >> wrench[static_cast<int>(i)] && std::isfinite(wrench[static_cast<int>(i)]) && !(number >> rest)) continue;
    const Quantity quantity = parse_quantity(parts[i], units[i]);
    if (!quantity.problem.empty()) throw UsageError("--wrench '" + text + "': " + quantity.problem);
    wrench[static_cast<int>(i)] = quantity.value;
  }
  return wrench;
}

// --- on the screen -----------------------------------------------------------------------------------

Cell area_cell(double area) {
  return {area < 0.1 ? number_text(std::round(area * 1e10) / 1e4) + " mm²" : quantity_text(area, "m²"), area, "m^2"};
}

std::string point_text(const Vec2& point) {
  // Coordinates below 1e-10 m, the size of an atom, are rounding errors and shown as zero.
  const auto coordinate = [](double x) { return quantity_text(std::abs(x) < 1e-10 ? 0.0 : x, "m"); };
  return "(" + coordinate(point.x()) + ", " + coordinate(point.y()) + ")";
}

void print_interfaces(std::ostream& out, const JointView& view) {
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right, Align::right});
  table.set_head("interfaces", {"interface", "overlap", "number", "area", "pressure", "mu_s"});
  double area = 0.0, count = 0.0;
  for (std::size_t i = 0; i < view.interfaces.size(); ++i) {
    const StepLapInterface& e = *view.interfaces[i];
    table.add_row({e.name, area_cell(view.areas[i]), quantity_cell(e.count, ""), area_cell(view.areas[i] * e.count),
                   quantity_cell(view.pressure(i), "Pa"), quantity_cell(e.static_friction, "")});
    area += view.areas[i] * e.count;
    count += e.count;
  }
  table.add_row({"together", "", quantity_cell(count, ""), area_cell(area), "", ""});
  out << table;
}

void print_capacity(std::ostream& out, const JointView& view) {
  static const std::array<const char*, 3> rows = {"along x", "along y", "turning"};
  TextTable table({Align::left, Align::right, Align::right});
  table.set_head("capacity", {"capacity", "sliding", "alone"}, {"direction", "sliding", "alone"});
  for (int i = 0; i < 3; ++i) {
    const std::string what = i < 2 ? "N" : "N m";
    table.add_row({rows[static_cast<std::size_t>(i)], quantity_cell(view.sliding(i), what), quantity_cell(view.alone(i), what)});
  }
  out << table;
}

void print_usage(std::ostream& out, const JointView& view, const Vec3& wrench) {
  const RequiredPressure required = view.required(wrench);
  TextTable table({Align::left, Align::left});
  table.set_name("usage");
  table.add_row({"wrench", "Fx " + quantity_text(wrench[0], "N") + ", Fy " + quantity_text(wrench[1], "N") + ", M " +
                               quantity_text(wrench[2], "N m")});
  table.add_row({"u", Cell(quantity_text(required.u, "") + (required.u > 1.0 ? ": slides" : ": holds"), required.u)});
  const double pressure = required.u * view.pressure(0);
  table.add_row({"p_req", Cell(quantity_text(pressure, "Pa") + " of " + quantity_text(view.pressure(0), "Pa") +
                                   (view.interfaces.size() > 1 ? " at the first interface" : ""),
                               pressure, "Pa")});
  table.add_row({"margin", quantity_cell(required.margin(), "")});
  table.add_row({"centre of rotation", required.centre ? point_text(*required.centre) : "at infinity"});
  out << table;
}

// Prints how the joint shares its load with parallel elements. A rigid joint carries the whole load until it slides.
void print_sharing(std::ostream& out, const JointView& view) {
  if (is_elastic(*view.joint)) out << "elastic: yields before it slides";
  if (view.beside.empty()) {
    if (is_elastic(*view.joint)) out << "; no other element carries load in parallel\n";
    return;
  }
  std::string names;
  for (const std::string& name : view.beside) names += (names.empty() ? "" : ", ") + name;
  if (is_elastic(*view.joint)) out << ", shares its load with " << names << ": the capacity is the joint's part alone\n";
  else out << "rigid: carries the whole load until it slides; only then load is taken by " << names << "\n";
}

void print_joint(std::ostream& out, const JointView& view, const std::optional<Vec3>& wrench) {
  out << About{view.joint->name} << view.joint->name << ": '" << view.joint->limb << "' on '" << view.joint->active_part << "'"
      << (view.joint->mode == "monitor" ? ", never slides (monitor)" : "") << "\n";
  if (view.interfaces.empty()) {
    out << "  no interfaces: holds whatever it takes\n";
    return;
  }
  print_interfaces(out, view);
  out << "\n";
  print_capacity(out, view);
  TextTable table({Align::left, Align::left});
  table.set_name("friction");
  table.add_row({"centre of friction", point_text(view.centre())});
  table.add_row({"radius of gyration", quantity_cell(view.patch.gyration(), "m")});
  out << table;
  print_sharing(out, view);
  if (!wrench) return;
  out << "\n";
  print_usage(out, view, *wrench);
}

ExitCode joint(const JointOptions& options, Console& console) {
  std::optional<Vec3> wrench;
  if (options.wrench) wrench = parse_wrench(*options.wrench);
  const auto loaded = load_model(options.model, options.overrides);
  const std::vector<JointView> views = chosen_joints(options, *loaded);
  if (console.verbosity == Verbosity::quiet) return ExitCode::done;
  console.out << "Step-lap joints in the reference pose at t = 0. Wrenches and twists are about the limb's centre of gravity,\n"
                 "in the active part's axes; points are from the active part's centre of gravity.\n";
  for (const JointView& view : views) {
    console.out << "\n";
    print_joint(console.out, view, wrench);
  }
  return ExitCode::done;
}

} // namespace

Command joint_command() {
  const auto o = std::make_shared<JointOptions>();
  Command command;
  command.name = "joint";
  command.summary = "capacity of the step-lap joints of a model, and the pressure that a wrench requires";
  command.examples = R"(  steplap joint models/paper/no_interference.toml
  steplap joint my.toml --joint "front joint" --wrench "53 kN,-88 kN,0"
  steplap joint my.toml --wrench 0,-88290,-2e3 --set core.core.pressure="60 kPa"
Capacity "sliding": the friction while the limb slides that way and no other; "alone": the largest such
force through the limb's centre of gravity, or couple, that the joint holds. A wrench is the one on the limb.
)";
  command.options = {{"MODEL", &o->model, "FILE", "model file (TOML); - is the standard input", true},
                     {"--joint", &o->joints, "NAME", "this joint; may be repeated (default: all)"},
                     {"--wrench", &o->wrench, "FX,FY,M", "force and couple on the limb: say u, p_req, margin, centre of rotation"},
                     {"--set", &o->overrides, "PATH=VALUE", "lay a value over the model; may be repeated"}};
  command.prints_tables = true;
  command.run = [o](Console& console) { return joint(*o, console); };
  return command;
}

} // namespace steplap
