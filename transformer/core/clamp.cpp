#include "transformer/core/clamp.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/model/entries.h"
#include "mbd/model/validate.h"
#include "transformer/core/core_builder.h"
#include "transformer/core/core_geometry.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_most_warming = 200.0; // temperature rise, K, above which the value is probably a temperature

[[noreturn]] void wrong(const Clamp& clamp, const std::string& field, const std::string& message) {
  throw ModelError(clamp.place(field), "clamp '" + clamp.name + "': " + message);
}

std::vector<const Clamp*> clamps_of(const Core& core, const Model& model) {
  std::vector<const Clamp*> found;
  for (const TableEntry& entry : model.tables)
    if (entry.kind == &clamp_kind())
      if (const auto& clamp = static_cast<const Clamp&>(*entry.table); clamp.core == core.name) found.push_back(&clamp);
  return found;
}

// Determines the outer faces of the yoke and its middle, in the axes of the active part from its centre of gravity, m.
void measure_yoke(const Core& core, const Model& model, const std::vector<const Clamp*>& clamps, YokeClamping& yoke) {
  double widest = 0.0;
  for (const Packet& packet : stack_of(core).packets) {
    widest = std::max(widest, packet.width);
    yoke.height = std::max(yoke.height, packet.yoke_height);
  }
  std::vector<double> outer;
  for (const LimbPlace& place : places_of_limbs(core, model))
    if (!place.is_middle) outer.push_back(place.x);
  const auto given = std::find_if(clamps.begin(), clamps.end(), [](const Clamp* clamp) { return clamp->yoke_length.has_value(); });
  if (outer.size() < 2 && given == clamps.end())
    wrong(*clamps.front(), "core",
          "needs 'yoke_length', over which its forces press: core '" + core.name + "' has no outer limb at either end");
  if (!outer.empty()) {
    const auto [rear, front] = std::minmax_element(outer.begin(), outer.end());
    yoke.middle = 0.5 * (*rear + *front);
    yoke.length = *front - *rear + widest;
  }
  if (given == clamps.end()) return;
  for (const Clamp* clamp : clamps)
    if (clamp->yoke_length && *clamp->yoke_length != *(*given)->yoke_length)
      wrong(*clamp, "yoke_length",
            "clamp '" + (*given)->name + "' gives the same yokes another 'yoke_length', " + number_text(*(*given)->yoke_length) + " m");
  yoke.length = *(*given)->yoke_length;
  for (const double x : outer)
    if (std::abs(x - yoke.middle) > 0.5 * yoke.length)
      wrong(**given, "yoke_length",
            "forces that press on " + number_text(yoke.length) + " m do not reach the axis of the limb " +
                rounded_text(std::abs(x - yoke.middle)) + " m from the middle: nothing would press its sheets");
}

double force_now(const Clamp& clamp, const Core& core) {
  const double depth = core.stack_depth || !core.packets.empty() ? depth_of(stack_of(core)) : 0.0;
  if (clamp.warming != 0.0 && !clamp.length && depth == 0.0)
    wrong(clamp, "warming", "needs 'length', of what is clamped: core '" + core.name + "' does not say how deep its stack is");
  const double force = clamp.force(depth);
  if (!(force > 0.0))
    wrong(clamp, "preload",
          "of its preload of " + number_text(clamp.preload) + " N nothing is left (" + rounded_text(force) +
              " N): it is loose, and presses nothing");
  return force;
}

void add_forces(const Clamp& clamp, const Core& core, YokeClamping& yoke) {
  const double force = force_now(clamp, core);
  for (const double x : clamp.places) {
    if (std::abs(x) > 0.5 * yoke.length)
      wrong(clamp, "places",
            "the place " + number_text(x) + " m lies beyond the yoke, which reaches " + rounded_text(0.5 * yoke.length) +
                " m to either side of the middle between the outer limbs");
    yoke.force += force;
    yoke.moment += force * x;
  }
  if (clamp.places.empty()) yoke.force += force * static_cast<double>(clamp.count.value_or(1));
}

void check(const Clamp& clamp, const Model& model) {
  std::vector<std::string> known;
  const Core* core = nullptr;
  for (const Core* one : tables_of<Core>(model)) {
    known.push_back(one->name);
    if (one->name == clamp.core) core = one;
  }
  if (!core) wrong(clamp, "core", "there is no core '" + clamp.core + "'" + did_you_mean(clamp.core, known));
  if (clamp.count && !clamp.places.empty() && static_cast<std::size_t>(*clamp.count) != clamp.places.size())
    wrong(clamp, "count",
          "'count' says " + std::to_string(*clamp.count) + " clamps, 'places' gives " + std::to_string(clamp.places.size()));
  if (clamp.stiffness.has_value() != clamp.stack_stiffness.has_value())
    wrong(clamp, clamp.stiffness ? "stiffness" : "stack_stiffness", "'stiffness' and 'stack_stiffness' are in series: give both");
  if ((clamp.settling != 0.0 || clamp.warming != 0.0) && !clamp.stiffness)
    wrong(clamp, clamp.settling != 0.0 ? "settling" : "warming", "needs 'stiffness' and 'stack_stiffness', by which it changes the force");
  if (clamp.warming != 0.0 && !clamp.expansion)
    wrong(clamp, "warming", "needs 'expansion' of the clamp; steel has 12e-6 1/K, glass fibre along it some 6e-6 1/K");
  if (std::abs(clamp.warming) > k_most_warming)
    wrong(clamp, "warming",
          "is the warming of the core since it was clamped, in K: " + rounded_text(clamp.warming) +
              " K look like a temperature and not like a difference");
}

} // namespace

double Clamp::force(double depth) const {
  double force = (1.0 - relaxation) * preload;
  if (!stiffness || !stack_stiffness) return force;
  const double k = *stiffness * *stack_stiffness / (*stiffness + *stack_stiffness);
  return force - k * settling + k * length.value_or(depth) * (stack_expansion - expansion.value_or(stack_expansion)) * warming;
}

bool has_sound_clamps(const Core& core, const Model& model) {
  const std::vector<Field>& fields = clamp_kind().fields.fields();
  const std::vector<const Clamp*> clamps = clamps_of(core, model);
  return std::all_of(clamps.begin(), clamps.end(), [&](const Clamp* clamp) {
    return std::all_of(fields.begin(), fields.end(), [&](const Field& field) { return is_in_range(field, clamp); });
  });
}

bool is_clamped(const Core& core, const Model& model) { return !clamps_of(core, model).empty(); }

YokeClamping clamping_of(const Core& core, const Model& model, bool is_top) {
  const std::vector<const Clamp*> clamps = clamps_of(core, model);
  YokeClamping yoke;
  if (clamps.empty()) return yoke;
  measure_yoke(core, model, clamps, yoke);
  const char* const end = is_top ? "top" : "bottom";
  for (const Clamp* clamp : clamps)
    if (clamp->at == "both" || clamp->at == end) add_forces(*clamp, core, yoke);
  if (yoke.force == 0.0)
    wrong(*clamps.front(), "at",
          "the " + std::string(end) + " yoke of core '" + core.name + "' is pressed by nothing: give it a clamp with 'at' = \"" + end +
              "\"");
  if (std::abs(yoke.moment) * 6.0 >= yoke.force * yoke.length)
    wrong(*clamps.front(), "places",
          "the forces on the " + std::string(end) + " yoke of core '" + core.name + "' act " + rounded_text(yoke.moment / yoke.force) +
              " m from its middle, beyond a sixth of its length: at its other end nothing would press the sheets");
  return yoke;
}

Core clamped(const Core& core, const Model& model) {
  if (!is_clamped(core, model)) return core;
  for (const char* field : {"pressure", "bottom_pressure"})
    if (core.places.count(field) > 0)
      throw ModelError(core.place(field), "core '" + core.name + "': '" + field + "' and clamp '" + clamps_of(core, model).front()->name +
                                              "' say the same: give one of them");
  const YokeClamping top = clamping_of(core, model, true), bottom = clamping_of(core, model, false);
  Core pressed = core;
  pressed.pressure = top.pressure();
  if (bottom.pressure() != top.pressure()) pressed.bottom_pressure = bottom.pressure();
  if (core.pressure_shares.empty() && core.packets.size() > 1)
    for (const Packet& packet : stack_of(core).packets) pressed.pressure_shares.push_back(top.height / packet.yoke_height);
  const std::vector<LimbPlace> limbs = places_of_limbs(core, model);
  if (top.moment == 0.0 && bottom.moment == 0.0) return pressed;
  pressed.joint_pressure_shares.clear();
  for (std::size_t i = 0; i < limbs.size(); ++i) {
    const double x = limbs[i].x - top.middle;
    pressed.joint_pressure_shares.push_back(core.joint_share(i, true) * top.share(x));
    pressed.bottom_joint_shares.push_back(core.joint_share(i, false) * bottom.share(x));
  }
  return pressed;
}

const TableKind& clamp_kind() {
  static const TableKind kind = [] {
    using T = Clamp;
    TableKind k;
    k.name = "clamp";
    k.doc = "Bolts or bands that press the sheets of a core's yokes together. They take the place of the core's 'pressure': each corner "
            "gets what is in "
            "equilibrium with their forces, each packet by the height of its yoke.";
    FieldTable& f = k.fields;
    f.add("core", &T::core).required().doc("name of the [[core]] that they press");
    f.add("at", &T::at).one_of({"both", "top", "bottom"}).doc("the yokes that have them");
    f.add("count", &T::count).at_least(1).at_most(1000).doc("on each of these yokes, all alike; default: as many as 'places', else 1");
    f.add("places", &T::places)
        .in("m")
        .doc("along the yoke, from the middle between the outer limbs, positive ahead; default: about that middle");
    f.add("preload", &T::preload).in("N").positive().required().doc("of each clamp, as tightened");
    f.add("relaxation", &T::relaxation).not_negative().at_most(0.99).doc("share of the preload that is lost since");
    f.add("stiffness", &T::stiffness).in("N/m").positive().doc("of a clamp along its force: E A/l of a bolt");
    f.add("stack_stiffness", &T::stack_stiffness).in("N/m").positive().doc("of the stack under a clamp, across the sheets");
    f.add("settling", &T::settling).in("m").not_negative().doc("reduction of the stack's thickness since clamping; needs both stiffnesses");
    f.add("warming", &T::warming).in("K").doc("temperature difference since clamping; needs both stiffnesses and 'expansion'");
    f.add("expansion", &T::expansion).in("1/K").not_negative().doc("thermal, of the clamp");
    f.add("stack_expansion", &T::stack_expansion).in("1/K").not_negative().doc("thermal, of the stack across the sheets");
    f.add("length", &T::length).in("m").positive().doc("that is clamped; default: the depth of the stack");
    f.add("yoke_length", &T::yoke_length)
        .in("m")
        .positive()
        .doc("over which the forces press; default: between the outer faces of the outer limbs");
    k.holds<T>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element& table, Model& model) { check(static_cast<const Clamp&>(table), model); };
    return k;
  }();
  return kind;
}

} // namespace steplap
