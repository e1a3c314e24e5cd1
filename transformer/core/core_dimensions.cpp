#include "transformer/core/core_dimensions.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "transformer/core/core_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace steplap {

namespace {

// Range of the mitre's angle relative to the yoke; beyond it limb and yoke would meet edge to edge.
constexpr double k_least_angle = 10.0 * std::numbers::pi / 180.0;
constexpr double k_largest_angle = 80.0 * std::numbers::pi / 180.0;
constexpr long k_most_sheets = 10'000'000; // a larger number of sheets is probably a mistake, and could overflow a long

// Formats a computed length with a reasonable number of digits.
std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g m", value);
  return text;
}

class DimensionCheck {
public:
  explicit DimensionCheck(const Core& core) : core_(core) {}

  std::vector<Diagnostic> run() {
    check_section();
    check_friction();
    check_pressure();
    check_elastic();
    if (core_.is_counted()) check_counted();
    else check_stack();
    check_strips();
    check_holes();
    if (!problems_.empty()) return std::move(problems_); // the following checks require valid values
    check_angles();
    if (problems_.empty() && !core_.is_counted()) check_books();
    if (problems_.empty() && !core_.has_strips()) check_cuts();
    if (problems_.empty() && core_.has_strips()) check_tongue();
    return std::move(problems_);
  }

private:
  // Adds an error with the location of `field`, or of the table if the field is not given.
  void error(const std::string& message, const std::string& field = "") {
    problems_.push_back({core_.place(field), "core '" + core_.name + "': " + message});
  }
  void need(bool is_given, const char* field, const char* why) {
    if (!is_given) error("needs '" + std::string(field) + "' (" + why + ")");
  }

  void check_section();
  void check_friction();
  void check_pressure();
  void check_elastic();
  void check_counted();
  void check_stack();
  void check_strips();
  void check_holes();
  void check_places_of_holes();
  void check_angles();
  void check_angle(std::size_t packet, bool is_middle);
  void check_books();
  void check_ducts(const Stack& stack);
  void check_laps(const Stack& stack, const CoreGeometry& geometry);
  void check_cuts();
  void check_cut(std::size_t packet, bool is_middle, double lowest, double highest);
  void check_tongue();

  const Core& core_;
  std::vector<Diagnostic> problems_;
};

void DimensionCheck::check_section() {
  if (core_.packets.empty()) {
    need(core_.limb_width.has_value(), "limb_width", "width of a limb's sheets; in m; or 'packets' for a stepped section");
    need(core_.yoke_height.has_value(), "yoke_height", "height of a yoke's sheets; in m; or 'yoke_heights' in addition to 'packets'");
    if (!core_.yoke_heights.empty()) error("'yoke_heights' is for 'packets', and none are given", "yoke_heights");
    if (!core_.pressure_shares.empty()) error("'pressure_shares' is for 'packets', and none are given", "pressure_shares");
  } else {
    for (const char* field : {"limb_width", "yoke_height", "stack_depth"})
      if ((field == std::string("limb_width") && core_.limb_width) || (field == std::string("yoke_height") && core_.yoke_height) ||
          (field == std::string("stack_depth") && core_.stack_depth))
        error("'" + std::string(field) + "' and 'packets' say the same: give one of them", field);
    if (core_.yoke_heights.size() != core_.packets.size())
      error("'yoke_heights' must give one height for each of the " + std::to_string(core_.packets.size()) + " packets, got " +
                std::to_string(core_.yoke_heights.size()) + "; round yokes have the limb's widths",
            core_.yoke_heights.empty() ? "packets" : "yoke_heights");
    if (!core_.pressure_shares.empty() && core_.pressure_shares.size() != core_.packets.size())
      error("'pressure_shares' must give one share for each of the " + std::to_string(core_.packets.size()) + " packets, got " +
                std::to_string(core_.pressure_shares.size()),
            "pressure_shares");
    if (core_.is_counted())
      error("'packets' and '" + std::string(core_.overlap ? "overlap" : "interfaces") +
                "' exclude each other: counted overlaps are those of one packet",
            "packets");
  }
  const Stack stack = stack_of(core_);
  double highest = 0.0;
  for (const Packet& p : stack.packets) highest = std::max(highest, p.yoke_height);
  if (2.0 * highest >= core_.core_height)
    error("two yokes of " + metres(highest) + " leave no window in a core of " + metres(core_.core_height) +
              ": 'core_height' is from the bottom of the lower yoke to the top of the upper",
          "core_height");
}

void DimensionCheck::check_friction() {
  const double bottom_static = core_.bottom_static_friction.value_or(core_.static_friction);
  if (core_.kinetic_friction.value_or(0.0) > core_.static_friction)
    error("'kinetic_friction' must not exceed 'static_friction'", "kinetic_friction");
  if (core_.bottom_kinetic_friction.value_or(0.0) > bottom_static)
    error("'bottom_kinetic_friction' must not exceed the static friction there, " + number_text(bottom_static), "bottom_kinetic_friction");
  if (core_.kinetic_friction && core_.bottom_static_friction && !core_.bottom_kinetic_friction)
    error("needs 'bottom_kinetic_friction' in addition to 'bottom_static_friction'", "bottom_static_friction");
}

void DimensionCheck::check_pressure() {
  const std::size_t limbs = core_.all_limbs().size();
  if (!core_.joint_pressure_shares.empty() && core_.joint_pressure_shares.size() != limbs)
    error("'joint_pressure_shares' must give one share for each of the " + std::to_string(limbs) + " joints, got " +
              std::to_string(core_.joint_pressure_shares.size()),
          "joint_pressure_shares");
  if (core_.bottom_pressure_gradient && !core_.pressure_gradient)
    error("'bottom_pressure_gradient' needs 'pressure_gradient', that at the top ([0, 0] if there is none)", "bottom_pressure_gradient");
  if (core_.transverse_acceleration.empty()) {
    for (const char* field : {"transverse_support", "transverse_slices"})
      if (field == std::string("transverse_support") ? !core_.transverse_support.empty() : core_.transverse_slices.has_value())
        error("'" + std::string(field) + "' needs 'transverse_acceleration', a signal", field);
    return;
  }
  if (core_.is_counted())
    return error("'transverse_acceleration' needs how the stack is built, and '" + std::string(core_.overlap ? "overlap" : "interfaces") +
                     "' says that overlaps are counted",
                 "transverse_acceleration");
  if (core_.transverse_support.empty())
    return error("'transverse_acceleration' needs 'transverse_support', what holds the stack across: \"both\" faces alike, "
                 "\"front\" or \"back\"; it has no default: between them lies all that a corner gains or loses",
                 "transverse_acceleration");
  if (core_.transverse_support == "both" && core_.packets.size() < 2 && core_.transverse_slices.value_or(1) < 2)
    error("'transverse_acceleration' changes nothing: held by both faces, a stack of one packet gains in front what it loses "
          "behind; give 'transverse_slices' to see when its sheets come loose, or another 'transverse_support'",
          "transverse_acceleration");
}

void DimensionCheck::check_elastic() {
  if (core_.tangential_stiffness && core_.contact_stiffness)
    error("'tangential_stiffness' and 'contact_stiffness' say the same: give one of them", "contact_stiffness");
  if (core_.shear_modulus && !core_.contact_stiffness)
    error("'shear_modulus' is in series with 'contact_stiffness', which is not given", "shear_modulus");
  if (core_.shear_modulus && core_.is_counted())
    error("'shear_modulus' is of sheets of 'sheet_thickness', and 'overlap' says that overlaps are counted: give the whole as "
          "'contact_stiffness'",
          "shear_modulus");
  if (core_.allowed_line_load && !core_.edge_stiffness)
    error("'allowed_line_load' needs 'edge_stiffness': without it edges carry no load", "allowed_line_load");
  if (core_.edge_stiffness && !core_.clearance)
    error("'edge_stiffness' needs 'clearance', which has to close before edges carry load", "edge_stiffness");
  if (!core_.is_elastic()) return;
  const std::string stiffness = core_.tangential_stiffness ? "tangential_stiffness" : "contact_stiffness";
  if (core_.mode == "monitor")
    error("'mode' = \"monitor\" contradicts '" + stiffness + "': a joint that is only monitored is rigid", "mode");
  const double at_bottom = core_.bottom_static_friction.value_or(core_.static_friction);
  if (core_.kinetic_friction.value_or(core_.static_friction) != core_.static_friction)
    error("'kinetic_friction' contradicts '" + stiffness +
              "': an elastic joint has one coefficient, 'static_friction' (the "
              "kinetic one is on the safe side)",
          "kinetic_friction");
  if (core_.bottom_kinetic_friction.value_or(at_bottom) != at_bottom)
    error("'bottom_kinetic_friction' contradicts '" + stiffness +
              "': an elastic joint has one coefficient, "
              "'bottom_static_friction' or 'static_friction'",
          "bottom_kinetic_friction");
}

void DimensionCheck::check_counted() {
  if (!core_.overlap || !core_.interfaces)
    error(std::string("needs '") + (core_.overlap ? "interfaces" : "overlap") + "' besides '" + (core_.overlap ? "overlap" : "interfaces") +
              "'",
          core_.overlap ? "overlap" : "interfaces");
  const std::pair<const char*, bool> built[] = {{"stack_depth", core_.stack_depth.has_value()},
                                                {"sheet_thickness", core_.sheet_thickness.has_value()},
                                                {"stacking_factor", core_.stacking_factor.has_value()},
                                                {"sheets_per_layer", core_.sheets_per_layer.has_value()},
                                                {"steps", core_.steps.has_value()},
                                                {"step_pitch", core_.step_pitch.has_value()},
                                                {"pitch_direction", !core_.pitch_direction.empty()},
                                                {"book", !core_.book.empty()},
                                                {"bands", core_.bands != "each"},
                                                {"ducts", !core_.ducts.empty()}};
  for (const auto& [field, is_given] : built)
    if (is_given)
      error("give either 'overlap' and 'interfaces', or how the stack is built: '" + std::string(field) + "' is of the other, not both",
            field);
}

void DimensionCheck::check_stack() {
  if (core_.packets.empty() && !core_.stack_depth && !core_.sheet_thickness && !core_.steps && !core_.step_pitch) {
    error("needs either 'overlap' and 'interfaces', or how the stack is built: 'stack_depth', 'stacking_factor', "
          "'sheet_thickness', 'sheets_per_layer', 'steps', 'step_pitch', 'pitch_direction', 'book' and 'clearance'");
    return;
  }
  if (core_.packets.empty()) need(core_.stack_depth.has_value(), "stack_depth", "of steel and insulation; in m");
  need(core_.stacking_factor.has_value(), "stacking_factor", "steel's share of the stack; usual are 0.91 to 0.98");
  need(core_.sheet_thickness.has_value(), "sheet_thickness", "of the steel; in m; usual are 0.18 to 0.35 mm");
  need(core_.sheets_per_layer.has_value(), "sheets_per_layer",
       "equal sheets laid at once: 1 or 2; it has no default, since 2 halve the capacity of the joint");
  need(core_.steps.has_value(), "steps", "layers from one end of a book to the other; usual are 3 to 7");
  need(core_.step_pitch.has_value(), "step_pitch", "from layer to layer; in m");
  need(!core_.pitch_direction.empty(), "pitch_direction",
       "\"across\" the mitre, \"along_limb\" or \"along_yoke\", the sheets' own length; it has no "
       "default: at 45° the two "
       "differ by a factor of 1.41");
  need(!core_.book.empty(), "book",
       "\"saw_tooth\", \"zig_zag\" or \"zig_zag_doubled\"; it has no default: a zig-zag has about "
       "0.6 of a saw tooth's overlap");
  need(core_.clearance.has_value(), "clearance",
       "between the sheets of one layer, across the mitre; in m; it has no default: usual are 0.2 to 3 mm");
}

void DimensionCheck::check_strips() {
  if (core_.has_strips() && !core_.is_counted())
    error("'sheet_outlines' = \"strips\" is for counted overlaps, 'overlap' and 'interfaces': a "
          "stack has its sheets' real "
          "outlines",
          "sheet_outlines");
  for (const char* field : {"tongue", "margin"})
    if ((field == std::string("tongue") ? core_.tongue : core_.margin) && !core_.has_strips())
      error("'" + std::string(field) +
                "' is of strips only, sheet_outlines = \"strips\": real sheets go as far as limb "
                "and yoke",
            field);
}

void DimensionCheck::check_holes() {
  if (core_.bolt_holes.empty() != !core_.bolt_hole_diameter)
    error(core_.bolt_holes.empty() ? "'bolt_hole_diameter' needs 'bolt_holes', their places" : "'bolt_holes' needs 'bolt_hole_diameter'",
          core_.bolt_holes.empty() ? "bolt_hole_diameter" : "bolt_holes");
  if (core_.bolt_holes.empty()) return;
  check_places_of_holes();
  if (core_.has_strips()) error("'bolt_holes' need real sheets, and 'sheet_outlines' is \"strips\"", "bolt_holes");
  for (std::size_t i = 0; i < core_.bolt_holes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (core_.bolt_hole_diameter && (core_.bolt_holes[i] - core_.bolt_holes[j]).norm() <= 1.05 * *core_.bolt_hole_diameter)
        error("bolt holes " + std::to_string(j + 1) + " and " + std::to_string(i + 1) +
                  " run into each other: " + metres((core_.bolt_holes[i] - core_.bolt_holes[j]).norm()) + " apart, 'bolt_hole_diameter' " +
                  metres(*core_.bolt_hole_diameter),
              "bolt_holes");
}

// Checks that each bolt hole is in at least one sheet.
void DimensionCheck::check_places_of_holes() {
  const Stack stack = stack_of(core_);
  double width = 0.0, height = 0.0;
  for (const Packet& p : stack.packets) {
    width = std::max(width, p.width);
    height = std::max(height, p.yoke_height);
  }
  for (std::size_t i = 0; i < core_.bolt_holes.size(); ++i)
    if (const Vec2& hole = core_.bolt_holes[i]; std::abs(hole.x()) >= 0.5 * width && std::abs(hole.y()) >= 0.5 * height)
      error("bolt hole " + std::to_string(i + 1) + " at (" + metres(hole.x()) + ", " + metres(hole.y()) + ") lies outside a limb of " +
                metres(width) + " and a yoke of " + metres(height) + ": places are from where their axes cross",
            "bolt_holes");
}

void DimensionCheck::check_angles() {
  const Stack stack = stack_of(core_);
  for (std::size_t p = 0; p < stack.packets.size(); ++p) {
    if (likeness(stack, p) != p) continue;
    if (!core_.limbs.empty()) check_angle(p, false);
    if (!core_.middle_limbs.empty()) check_angle(p, true);
  }
}

void DimensionCheck::check_angle(std::size_t packet, bool is_middle) {
  const CoreGeometry geometry(core_);
  const double angle = geometry.angle(packet, is_middle);
  const Mitre m = geometry.mitre(packet, is_middle);
  if (angle < k_least_angle || angle > k_largest_angle)
    return error(std::string("a ") + (is_middle ? "notch" : "mitre") + " at " +
                     number_text(std::round(angle * 1800.0 / std::numbers::pi) / 10.0) + "° to the yoke: must be 10° to 80°" +
                     (m.angle ? ""
                              : "; it follows from the yoke's height of " + metres(m.yoke_height) + " and the limb's width of " +
                                    metres(m.limb_width) + " unless 'mitre_angle' is given"),
                 is_middle           ? "notch_angle"
                 : core_.mitre_angle ? "mitre_angle"
                                     : "yoke_height");
  if (!is_middle) return;
  const auto [s, c] = portable::sin_cos(angle);
  if (const double depth = 0.5 * m.limb_width * s / c; depth > m.yoke_height)
    error("the point of a middle limb, " + metres(depth) + " high, is higher than the yoke of " + metres(m.yoke_height) +
              ": take a smaller 'notch_angle'",
          "notch_angle");
}

void DimensionCheck::check_books() {
  const Stack stack = stack_of(core_);
  const Book& book = stack.book;
  const CoreGeometry geometry(core_);
  double widest = 0.0;
  for (const Packet& p : stack.packets) {
    const double sheets = p.depth * stack.stacking_factor / stack.sheet_thickness;
    if (sheets > static_cast<double>(k_most_sheets))
      return error("a packet of " + metres(p.depth) + " would hold " + number_text(std::floor(sheets)) + " sheets of " +
                       metres(stack.sheet_thickness) + ": 'sheet_thickness' is that of one sheet, some 0.3 mm",
                   "sheet_thickness");
    widest = std::max(widest, p.width);
    if (layers_in(stack, p) < book.steps)
      error("a packet of " + std::to_string(sheets_in(stack, p)) + " sheets (" + metres(p.depth) + " · " +
                number_text(stack.stacking_factor) + " / " + metres(stack.sheet_thickness) + ") holds no book of " +
                std::to_string(book.steps) + " layers of " + std::to_string(book.sheets_per_layer),
            core_.packets.empty() ? "stack_depth" : "packets");
  }
  for (const bool is_middle : {false, true})
    if (!(is_middle ? core_.middle_limbs : core_.limbs).empty())
      if (const double pitch = geometry.pitch(geometry.largest(), is_middle); book.clearance >= pitch)
        return error("a clearance of " + metres(book.clearance) + " leaves no overlap at steps of " + metres(pitch) +
                         " across the mitre ('step_pitch' " + metres(book.pitch) + " " + core_.pitch_direction + ")",
                     "clearance");
  check_ducts(stack);
  if (problems_.empty()) check_laps(stack, geometry);
}

// Checks that layers overlap: packets with different mitres have different pitches, and a duct may be between any two layers of a thin
// packet.
void DimensionCheck::check_laps(const Stack& stack, const CoreGeometry& geometry) {
  for (const bool is_middle : {false, true}) {
    if ((is_middle ? core_.middle_limbs : core_.limbs).empty()) continue;
    for (std::size_t p = 0; p < stack.packets.size(); ++p)
      if (!geometry.overlaps_within(p, is_middle))
        return error("no two layers of packet " + std::to_string(p + 1) + " overlap at " + (is_middle ? "a middle" : "an outer") +
                         " limb: its steps are " + metres(geometry.pitch(p, is_middle)) + " across the mitre, 'clearance' is " +
                         metres(stack.book.clearance) + (stack.ducts.empty() ? "" : ", and 'ducts' part layers") +
                         "; nothing would hold its " + std::to_string(sheets_in(stack, stack.packets[p])) + " sheets",
                     core_.packets.empty() ? "clearance" : "packets");
  }
}

void DimensionCheck::check_ducts(const Stack& stack) {
  double depth = 0.0;
  for (const Packet& p : stack.packets) depth += p.depth;
  for (const Duct& duct : stack.ducts) {
    if (!(duct.width > 0.0)) error("a duct needs a place and a width above 0 m: 'ducts' = [[place, width], …]", "ducts");
    if (duct.place <= 0.0 || duct.place >= depth)
      error("a duct at " + metres(duct.place) + " lies outside the stack of " + metres(depth) +
                ": its place is the depth of steel and insulation in front of it",
            "ducts");
  }
}

// Checks that each line at which sheets meet crosses limb and yoke.
void DimensionCheck::check_cuts() {
  const CoreGeometry geometry(core_);
  const Stack& stack = geometry.stack();
  for (std::size_t p = 0; p < stack.packets.size(); ++p)
    for (const bool is_middle : {false, true}) {
      if (likeness(stack, p) != p || (is_middle ? core_.middle_limbs : core_.limbs).empty()) continue;
      double half = 0.5 * core_.overlap.value_or(0.0);
      if (!core_.is_counted())
        half = 0.5 * (geometry.pitch(p, is_middle) * static_cast<double>(stack.book.steps - 1) + stack.book.clearance);
      check_cut(p, is_middle, -half, half);
      if (!problems_.empty()) return; // one error suffices
    }
}

void DimensionCheck::check_cut(std::size_t packet, bool is_middle, double lowest, double highest) {
  const CoreGeometry geometry(core_);
  const Mitre m = geometry.mitre(packet, is_middle);
  const std::string what = core_.is_counted() ? "an overlap of " + metres(highest - lowest)
                                              : "a book that reaches " + metres(highest - lowest) + " across the mitre";
  const std::string field = core_.is_counted() ? "overlap" : "step_pitch";
  if (highest >= cut_distance_limit(m))
    return error(what + " is wider than the sheets: where a limb of " + metres(m.limb_width) + " and a yoke of " + metres(m.yoke_height) +
                     " cross there are " + metres(cut_distance_limit(m)) + " on either side of the mitre",
                 field);
  if (!is_middle) return;
  const auto [s, c] = portable::sin_cos(*m.angle);
  const double depth = 0.5 * m.limb_width * s / c, tip = depth - lowest / c;
  if (0.5 * m.limb_width * s <= highest || tip > m.yoke_height)
    error(what + " does not fit the point of a middle limb, " + metres(depth) + " high: its layers reach " + metres(tip) +
              " into a yoke of " + metres(m.yoke_height),
          field);
}

void DimensionCheck::check_tongue() {
  const double half = 0.5 * core_.overlap.value_or(0.0), tongue = core_.tongue.value_or(0.05);
  if (half >= tongue)
    error("an overlap of " + metres(2.0 * half) + " is wider than the strips: 'tongue', " + metres(tongue) +
              " on either side of the middle of the mitre, must be more than " + metres(half),
          "overlap");
}

} // namespace

std::vector<Diagnostic> check_dimensions(const Core& core) { return DimensionCheck(core).run(); }

} // namespace steplap
