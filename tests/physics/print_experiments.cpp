// Prints measurements beside predictions as CSV, for docs/evidence/experiments.md and its figures: print_experiments
// [EXPERIMENT].
#include "tests/physics/experiments.h"

#include <cstdio>

using namespace steplap::testing;

namespace {

void print(const std::vector<Compared>& all) {
  for (const Compared& c : all)
    std::printf("%s,%s,%g,%d,%d,%.6g,%.2g,%.6g,%.3g,%.2f,%s\n", c.experiment.c_str(), c.what.c_str(), c.setting, c.number, c.count,
                c.measured, c.scatter, c.predicted, c.miss(), c.miss() / c.scatter, c.is_fitted ? "fitted" : "predicted");
}

} // namespace

int main(int argc, char** argv) {
  const std::string wanted = argc > 1 ? argv[1] : "";
  const auto wants = [&](const char* name) { return wanted.empty() || wanted == name; };
  if (wanted != "housner_limit")
    std::printf("experiment,what,setting,number,count,measured,scatter,computed,miss,miss over scatter,role\n");
  if (wants("golf_ball")) print(bounces("golf_ball", 1.1));
  if (wants("table_tennis_ball")) print(bounces("table_tennis_ball", 0.18));
  if (wants("flywheel_trolley")) print(flywheel_trolley());
  if (wants("inclined_rail")) {
    print(balls_on_rail());
    print(cylinders_on_rail());
  }
  if (wants("friction_damper")) print(friction_damper());
  if (wants("air_track")) {
    print(air_track(true));
    print(air_track(false));
  }
  if (wants("car_to_car"))
    for (const double restitution : {0.2, 0.3, 0.4}) print(car_to_car(restitution));
  if (wants("toppling_brick")) print(toppling_brick());
  if (wants("rocking_blocks"))
    for (const double tilt : {0.3, 0.5, 0.8}) print(rocking_blocks(tilt));
  if (wanted == "housner_limit") {
    std::printf("aspect,damping ratio,stiffness,share of Housner's ratio at impacts 1 to 4\n");
    for (const double aspect : {2.0, 3.0, 5.0})
      for (const double ratio : {0.02, 0.1, 0.3, 1.0})
        for (const double stiffness : {1e6, 1e7, 1e8, 1e9}) {
          const RockingBlock block{.height = 0.2 * aspect, .stiffness = stiffness, .damping_ratio = ratio};
          std::printf("%g,%g,%g", aspect, ratio, stiffness);
          for (const double e : rocking_ratios(block, 4)) std::printf(",%.5f", e / housner_ratio(block));
          std::printf("\n");
        }
  }
  return 0;
}
