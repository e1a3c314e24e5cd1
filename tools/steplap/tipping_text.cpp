#include "tools/steplap/tipping_text.h"

#include "mbd/base/shown_text.h"
#include "mbd/run/quantity_text.h"
#include "tools/steplap/text_table.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <ostream>

namespace steplap {

namespace {

constexpr double k_pi = std::numbers::pi;

std::string degrees(double angle) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g°", std::abs(angle) * 180.0 / k_pi);
  return text;
}

std::string part_name(const System& system, const Tipping& t) {
  const std::string name = system.bodies[t.body].name;
  return t.others == 0 ? name : name + " and " + counted(static_cast<std::size_t>(t.others), "other", "others");
}

} // namespace

void print_tipping(std::ostream& out, const LoadedModel& loaded, const State& state) {
  using Align = TextTable::Align;
  TextTable table({Align::left, Align::left, Align::left, Align::right, Align::left, Align::right});
  table.set_head("tipping", {"what stands", "tips over", "lifts", "tilted by", "", "or accelerated by"},
                 {"what stands", "tips over", "lifts", "tilted by", "turning", "accelerated by"});
  bool is_any = false;
  for (const Tipping& t : tipping_of(loaded, state)) {
    if (t.margin < 0.0) continue;
    is_any = true;
    table.add_row({part_name(*loaded.system, t), t.about, t.lifts, Cell(degrees(t.margin), t.margin, "rad"),
                   t.is_clockwise ? "clockwise" : "counter-clockwise",
                   t.acceleration > 0.0 ? quantity_cell(t.acceleration, "m/s^2", 1.0) : Cell("-")});
  }
  const std::vector<UnjudgedPart> unjudged = not_judged_for_tipping(loaded, state);
  if (is_any || !unjudged.empty()) out << "\nDistance from tipping over\n";
  if (is_any) out << table;
  for (const UnjudgedPart& one : unjudged)
    out << "  '" << loaded.system->bodies[one.body].name << "' is not judged, because " << one.why << "\n";
}

} // namespace steplap
