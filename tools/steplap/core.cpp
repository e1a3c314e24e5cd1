#include "tools/steplap/commands.h"

#include "mbd/base/number_text.h"
#include "mbd/model/entries.h"
#include "mbd/run/findings.h"
#include "mbd/run/quantity_text.h"
#include "mbd/run/run.h"
#include "tools/steplap/output_files.h"
#include "tools/steplap/text_table.h"
#include "transformer/core/clamp.h"
#include "transformer/core/core_builder.h"
#include "transformer/core/core_drawing.h"
#include "transformer/core/core_geometry.h"
#include "transformer/core/plausible.h"
#include "transformer/program.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <ostream>

namespace steplap {

namespace {

using Align = TextTable::Align;

struct CoreOptions {
  std::string model;
  std::vector<std::string> overrides;
  std::vector<std::string> cores;
  std::optional<std::string> image;
};

std::vector<const Core*> chosen_cores(const CoreOptions& options, const LoadedModel& loaded) {
  std::vector<const Core*> all, chosen;
  std::vector<std::string> known;
  for (const Core* core : tables_of<Core>(loaded.model)) {
    all.push_back(core);
    known.push_back(core->name);
  }
  if (all.empty()) throw UsageError("'" + loaded.path + "' has no [[core]]");
  if (options.cores.empty()) return all;
  for (const std::string& name : options.cores) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) throw UsageError("'" + loaded.path + "' has no core '" + name + "'" + did_you_mean(name, known));
    chosen.push_back(all[static_cast<std::size_t>(found - known.begin())]);
  }
  return chosen;
}

std::string metres(double value) { return quantity_text(value, "m"); }
std::string whole(double value) { return number_text(std::round(value)); }
Cell metres_cell(double value) { return quantity_cell(value, "m"); }
Cell degrees_cell(double angle) { return {number_text(std::round(angle * 1800.0 / std::numbers::pi) / 10.0) + "°", angle, "rad"}; }

std::string book_text(const Core& core, const CoreGeometry& geometry) {
  const Book& book = geometry.stack().book;
  const std::string kind = book.kind == BookKind::saw_tooth ? "saw-tooth book"
                           : book.kind == BookKind::zig_zag ? "zig-zag book"
                                                            : "zig-zag book, ends doubled";
  std::string text = kind + " of " + std::to_string(book.steps) + " steps of " + metres(book.pitch) + " ";
  text += core.pitch_direction == "across"       ? "across the mitre"
          : core.pitch_direction == "along_limb" ? "along the limb"
                                                 : "along the yoke";
  return text + ", " + std::to_string(book.sheets_per_layer) + (book.sheets_per_layer > 1 ? " sheets" : " sheet") +
         " in a layer, clearance " + metres(book.clearance);
}

void print_packets(std::ostream& out, const Core& core, const CoreGeometry& geometry) {
  const Stack& stack = geometry.stack();
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right});
  table.set_head("packets", {"packet", "limb", "yoke", "depth", "sheets", "layers", "mitre", "angle"});
  for (std::size_t p = 0; p < stack.packets.size(); ++p) {
    const Packet& packet = stack.packets[p];
    const bool is_middle = core.limbs.empty();
    const Mitre m = geometry.mitre(p, is_middle);
    const CornerFrame frame = is_middle ? notch_frame(m, 1.0, 1.0) : corner_frame(m, 1.0, 1.0);
    table.add_row({count_cell(p + 1), metres_cell(packet.width), metres_cell(packet.yoke_height), metres_cell(packet.depth),
                   count_cell(static_cast<std::size_t>(sheets_in(stack, packet))),
                   count_cell(static_cast<std::size_t>(layers_in(stack, packet))), metres_cell(frame.length),
                   degrees_cell(geometry.angle(p, is_middle))});
  }
  table.add_row({"together", "", "", metres_cell(depth_of(stack)), count_cell(static_cast<std::size_t>(sheets_in(stack))),
                 count_cell(static_cast<std::size_t>(layers_in(stack))), "", ""});
  out << table;
  for (const Duct& duct : stack.ducts)
    out << "  duct of " << metres(duct.width) << " behind " << metres(duct.place) << " of stack, " << sheets_before(stack, duct)
        << " sheets\n";
}

// Returns the number of interfaces between layers, with and without overlap.
double interfaces_between_layers(const Stack& stack) {
  double count = 0.0;
  for (const LayerPair& pair : layer_pairs(stack)) count += static_cast<double>(pair.count);
  return count;
}

// Describes the elasticity of the joint, if given; `area` is the total overlap area, m².
void print_compliance(std::ostream& out, const Core& core, const CoreGeometry& geometry, double area) {
  if (core.is_elastic()) {
    double compliance = core.contact_stiffness ? 1.0 / *core.contact_stiffness : 0.0;
    if (core.shear_modulus) compliance += core.sheet_thickness.value_or(0.0) / *core.shear_modulus;
    out << "  yields by " << quantity_text(core.tangential_stiffness.value_or(area / compliance), "N/m") << " before it slides\n";
  }
  if (!core.edge_stiffness) return;
  out << "  edges carry " << quantity_text(*core.edge_stiffness, "N/m^2") << " along the mitre once "
      << metres(core.clearance.value_or(0.0)) << " have closed";
  if (core.allowed_line_load) out << ", allowed " << quantity_text(*core.allowed_line_load, "N/m");
  if (const long sheets = core.is_counted() ? 0 : sheets_in(geometry.stack()); core.allowed_line_load && sheets > 0)
    out << ", " << quantity_text(*core.allowed_line_load / (static_cast<double>(sheets) * *core.sheet_thickness), "Pa");
  out << "\n";
}

// Prints the increase in pressure per acceleration across the stack, smallest and largest over the laps of the corner.
void print_transverse(std::ostream& out, const Core& core, const CoreGeometry& geometry, const CoreCorner& corner) {
  if (core.transverse_acceleration.empty()) return;
  double most = -1e300, least = 1e300;
  for (const Lap& lap : corner.laps) {
    const double gain = geometry.pressure(corner, lap, 1.0).transverse;
    most = std::max(most, gain);
    least = std::min(least, gain);
  }
  out << "  pressed by " << number_text(std::round(least)) << " to " << number_text(std::round(most))
      << " Pa more for every m/s² from the front face to the back\n";
}

void print_corners(std::ostream& out, const Core& core, const CoreGeometry& geometry, std::size_t limb, const Model& model) {
  const Body &body = *model.find_body(core.all_limbs()[limb]), &part = *model.find_body(core.active_part);
  const double reach = std::abs(middle_of_limb(core, body, part).x());
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right, Align::right});
  table.set_head("corners", {"corner", "kinds", "interfaces", "overlap, mean", "area", "capacity"});
  double all = 0.0, capacity = 0.0;
  const std::vector<CoreCorner> corners = geometry.corners(core.is_middle(limb), side_of_limb(core, body, part), reach);
  for (const CoreCorner& corner : corners) {
    double count = 0.0, area = 0.0, width = 0.0, pressed = 0.0; // area in m², width in m; `pressed`: normal force, N
    for (const Lap& lap : corner.laps) {
      count += lap.count;
      area += lap.count * lap.area;
      pressed +=
          lap.count * lap.area * geometry.pressure(corner, lap, core.joint_share(limb, corner.is_top)).middle * (1.0 - core.pressure_loss);
      width += lap.count * (lap.outer - lap.inner);
    }
    const double friction = corner.is_top ? core.static_friction : core.bottom_static_friction.value_or(core.static_friction);
    table.add_row({corner.place, count_cell(corner.laps.size()), Cell(whole(count), count), metres_cell(width / count),
                   Cell(quantity_text(area, "m²"), area, "m^2"), quantity_cell(pressed * friction, "N")});
    all += area;
    capacity += pressed * friction;
  }
  table.add_row({"together", "", "", "", Cell(quantity_text(all, "m²"), all, "m^2"), quantity_cell(capacity, "N")});
  out << table;
  print_compliance(out, core, geometry, all);
  print_transverse(out, core, geometry, corners.front());
}

void print_steel(std::ostream& out, const Core& core, std::size_t limb, const Model& model) {
  const Body& body = *model.find_body(core.all_limbs()[limb]);
  const std::optional<LimbSteel> known = steel_of(model, body.name);
  const LimbSteel steel = known.value_or(LimbSteel());
  const bool is_shared = cores_of(model, body.name).size() > 1;
  TextTable table({Align::left, Align::right, Align::right});
  table.set_head("steel", {"", is_shared ? "of the sheets in all tables" : "of the sheets", "of the body"},
                 {"what", "of the sheets", "of the body"});
  const auto inertia = [](double value) { return Cell(quantity_text(value, "kg m²"), value, "kg m^2"); };
  table.add_row({"mass", steel.mass > 0.0 ? quantity_cell(steel.mass, "kg") : Cell("-"), quantity_cell(body.mass, "kg")});
  table.add_row({"inertia", steel.mass > 0.0 ? inertia(steel.inertia) : Cell("-"), inertia(body.inertia)});
  table.add_row({"centre of gravity, off the axis", known ? quantity_cell(steel.centre.x(), "m", 1.0) : Cell("-"),
                 quantity_cell(body.cg.x(), "m", 1.0)});
  out << table;
}

// Prints the effect of the clamps of the yokes.
void print_clamping(std::ostream& out, const Core& core, const Model& model) {
  if (!is_clamped(core, model)) return;
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right});
  table.set_head("clamping", {"yoke", "force", "on", "pressure", "from end to end"});
  for (const bool is_top : {true, false}) {
    const YokeClamping yoke = clamping_of(core, model, is_top);
    const double half = 0.5 * yoke.length, area = yoke.length * yoke.height;
    table.add_row({is_top ? "top" : "bottom", quantity_cell(yoke.force, "N"), Cell(quantity_text(area, "m²"), area, "m^2"),
                   quantity_cell(yoke.pressure(), "Pa"), quantity_cell(yoke.pressure() * (yoke.share(half) - yoke.share(-half)), "Pa")});
  }
  out << table;
}

// Returns true if other tables have yokes in the same active part.
bool is_one_of_several(const Core& core, const Model& model) {
  const std::vector<const Core*> all = tables_of<Core>(model);
  return std::count_if(all.begin(), all.end(), [&core](const Core* other) { return other->active_part == core.active_part; }) > 1;
}

void print_core(std::ostream& out, const Core& core, const Model& model) {
  const CoreGeometry geometry(core);
  out << About{core.name} << core.name << ": ";
  if (core.is_counted()) {
    out << "counted overlaps of " << metres(*core.overlap) << ", " << number_text(*core.interfaces) << " a corner; "
        << (core.has_strips() ? "strips with square ends" : "ends as limb and yoke have them") << "\n";
  } else {
    out << book_text(core, geometry) << "\n";
    print_packets(out, core, geometry);
    out << "  interfaces between layers: " << whole(interfaces_between_layers(geometry.stack())) << " at every corner\n";
  }
  if (const auto steel = yoke_steel(model, core.active_part))
    out << "  yokes: " << quantity_text(*steel, "kg") << " of the " << quantity_text(model.find_body(core.active_part)->mass, "kg")
        << " of '" << core.active_part << "'" << (is_one_of_several(core, model) ? ", those of all its tables together" : "") << "\n";
  print_clamping(out, core, model);
  for (std::size_t i = 0; i < core.all_limbs().size(); ++i) {
    out << About{core.joint_name(i)} << "\n"
        << core.joint_name(i) << ": '" << core.all_limbs()[i] << "'" << (core.is_middle(i) ? ", T-joint" : "") << "\n";
    print_corners(out, core, geometry, i, model);
    print_steel(out, core, i, model);
  }
}

// Writes the drawing of core number `index` to FILE.svg, FILE-2.svg, ….
void write_image(const std::string& path, std::size_t index, const Core& core, const Model& model, std::ostream& out) {
  std::filesystem::path file(path);
  if (index > 0) file.replace_filename(file.stem().string() + "-" + std::to_string(index + 1) + file.extension().string());
  std::ofstream image(file);
  image << core_svg(core, model);
  image.close();
  if (!image) throw UsageError("cannot write '" + file.string() + "'");
  out << "\n  drawn: " << file.string() << "\n";
}

ExitCode core(const CoreOptions& options, Console& console) {
  const OutputFiles files(console, {{"--svg", options.image}});
  const auto loaded = load_model(options.model, options.overrides);
  const std::vector<const Core*> cores = chosen_cores(options, *loaded);
  std::ostream silent(nullptr);
  std::ostream& out = files.may_print() ? console.out : silent;
  const bool is_drawn_there = options.image && is_standard_output(*options.image);
  if (is_drawn_there && cores.size() > 1)
    throw UsageError("--svg -: there are " + std::to_string(cores.size()) + " cores with one drawing each: choose one with --core");
  for (std::size_t i = 0; i < cores.size(); ++i) {
    if (i > 0) out << "\n";
    print_core(out, clamped(*cores[i], loaded->model), loaded->model);
    if (is_drawn_there) files.write(options.image, core_svg(*cores[i], loaded->model));
    else if (options.image) write_image(*options.image, i, *cores[i], loaded->model, out);
  }
  for (const CoreRemark& remark : implausible_cores(loaded->model))
    out << (remark.is_note ? "\n  note: " : "\n  warning: ") << text_with_place({"", FindingLevel::warning, remark.text, remark.where})
        << "\n";
  return ExitCode::done;
}

} // namespace

Command core_command() {
  const auto o = std::make_shared<CoreOptions>();
  Command command;
  command.name = "core";
  command.summary = "what a model's cores are made of: sheets, layers, overlaps, capacity, masses; and their drawing";
  command.examples = R"(  steplap core models/layouts/three_limb.toml
  steplap core my.toml --svg core.svg
  steplap core my.toml --core "wound limbs" --set core.wound limbs.steps=7
Capacity is the friction of a corner in translation, mu_s p times the area of all its overlaps. "Kinds" of interface
differ in the sheets that overlap; "interfaces" are those that carry an overlap. More on a joint: steplap joint.
)";
  command.options = {{"MODEL", &o->model, "FILE", "model file (TOML); - is the standard input", true},
                     {"--core", &o->cores, "NAME", "this core; may be repeated (default: all)"},
                     {"--svg", &o->image, "FILE",
                      "draw elevation, section, corner and book into an SVG image; of further cores FILE-2 …; - is the standard output, "
                      "which then holds nothing else"},
                     {"--set", &o->overrides, "PATH=VALUE", "lay a value over the model; may be repeated"}};
  command.prints_tables = true;
  command.run = [o](Console& console) { return core(*o, console); };
  return command;
}

} // namespace steplap
