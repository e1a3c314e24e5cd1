// Describes in sentences the parts that tip in the given pose.
#include "mbd/base/shown_text.h"
#include "mbd/run/tipping.h"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace steplap {

namespace {

std::string degrees(double angle) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g°", std::abs(angle) * 180.0 / std::numbers::pi);
  return text;
}

} // namespace

std::vector<std::string> tipping_over(const LoadedModel& loaded, const State& state) {
  std::vector<std::string> found;
  for (const Tipping& t : tipping_of(loaded, state)) {
    if (t.margin >= 0.0) continue;
    const std::string name = "'" + loaded.system->bodies[t.body].name + "'" +
                             (t.others == 0 ? "" : " with " + counted(static_cast<std::size_t>(t.others), "other", "others"));
    std::string text = "in the pose given " + name + " tips over '" + t.about + "', and '" + t.lifts +
                       "' lifts: the line of its loads passes " + degrees(t.margin) + " outside";
    if (t.slope && std::abs(*t.slope) > std::abs(*t.slope_at_most))
      text += "; it would stand on slopes of up to " + degrees(*t.slope_at_most) + ", this one has " + degrees(*t.slope);
    found.push_back(text);
  }
  return found;
}

} // namespace steplap
