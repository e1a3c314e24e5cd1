// The values in models/experiments that were found from measurements are those that the fits in models/studies find.
#include "tests/tools/study/study_bench.h"

using namespace steplap;
using namespace steplap::testing;

// Intervals of both fits are some 2 and 4 % wide; the models give the value with four digits, half of the last of which is 0.03
// %.
TEST_CASE("damping of the bouncing balls is what their fits say, and the golf ball's fit says that its interval is off") {
  struct Ball {
    std::string name;
    double damping;
    int code;
  };
  for (const Ball& ball : {Ball{"golf_ball", 15.784, 5}, Ball{"table_tennis_ball", 0.6284, 0}}) {
    CAPTURE(ball.name);
    const StudyBench bench;
    const std::string folder = STEPLAP_MODELS "/studies/", store = bench.at("fit.sqlite");
    const Outcome outcome = study_does({"run", folder + ball.name + "_fit.toml", "-o", store});
    CAPTURE(outcome.err);
    CHECK(outcome.code == ball.code);
    double found = 0.0;
    for (const study::Finding& finding : study::Store(store).findings())
      if (finding.subject == "damping" && finding.quantity == "value") found = finding.value;
    CHECK(found == doctest::Approx(ball.damping).epsilon(1e-3));
    CHECK(has(text_of(STEPLAP_MODELS "/experiments/" + ball.name + ".toml"),
              "damping = " + std::string(ball.damping > 1.0 ? "15.784" : "0.6284")));
  }
}
