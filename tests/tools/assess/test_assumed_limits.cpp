// Limits that the model's author assumed: they alone never send a machine back. Limits may be uncertain, and then vary among the samples.
#include "driven_scene.h"

#include "mbd/base/diagnostics.h"
#include "tools/assess/assumed_limits.h"
#include "transformer/recorder/fields.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::assess;
using namespace assess_test;

namespace {

// 0.6 g for 0.1 s, a triangle, slides the block by 3.602 mm at a friction of 0.3 (closed form; gravity is the model's).
constexpr double k_slide = 3.602e-3;
constexpr double k_friction = 0.3;

std::string shock_file(const Folder& folder) {
  std::string file = folder.file("shock.csv");
  write(file, record_csv(1000.0, 2.0, [](double t) {
          const double s = (t - 0.5) / 0.1;
          return s < 0.0 || s > 1.0 ? 0.0 : 0.6 * 9.81 * (1.0 - std::abs(2.0 * s - 1.0));
        }));
  return file;
}

std::string limit(const std::string& name, const std::string& fields) {
  return "[[acceptance]]\nname = \"" + name + "\"\nchannel = \"floor.slide\"\nconsequence = \"reject\"\n" + fields + "\n";
}

// A travel between 2 mm and 5 mm, as a parameter.
std::string uncertain_travel(const std::string& source) {
  return "[parameters]\ntravel = \"3 mm\"\n[[uncertain]]\nname = \"travel\"\npaths = [\"parameters.travel\"]\n"
         "distribution = \"uniform\"\nlow = \"2 mm\"\nhigh = \"5 mm\"\nsource = \"" +
         source + "\"\nsource_text = \"a test\"\n";
}

Assessment assessed(const Folder& folder, const std::string& more, const std::string& criterion, long samples) {
  AssessmentOptions options;
  options.reading.gravity = "z";
  options.reading.rules.threshold = 0.3 * k_gravity;
  options.estimating = Estimating::never;
  options.voyage = parse_voyage("0,2");
  options.sampling.samples = samples;
  options.criteria = folder.file("criteria.toml");
  write(options.criteria, "name = \"mine\"\n[[criterion]]\nname = \"only\"\n" + criterion + "\n");
  const std::string model = folder.file("block.toml");
  write(model, block_text(k_friction, more));
  return assess::assess({shock_file(folder)}, {model}, options);
}

const std::string k_limits = "quantity = \"acceptance\"\noutcome = \"inspect\"";

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("a limit returns the machine, one that is assumed only asks to inspect it, and says why") {
  const Folder folder;
  CHECK(assessed(folder, limit("slide", "within = \"1 mm\""), k_limits, 0).decision == Decision::send_back);
  CHECK(assessed(folder, limit("slide", "within = \"1 mm\"\nsource = \"specified\""), k_limits, 0).decision == Decision::send_back);
  const Assessment assumed = assessed(folder, limit("slide", "within = \"1 mm\"\nsource = \"assumed\""), k_limits, 0);
  CHECK(assumed.decision == Decision::inspect);
  CHECK(says(assumed.reason, "'slide'"));
  CHECK(says(assumed.reason, "assumed"));
  CHECK(says(assessment_json(assumed), "\"assumed\": true"));
  // A limit that is met decides nothing, whatever its source.
  CHECK(assessed(folder, limit("slide", "within = \"1 m\"\nsource = \"assumed\""), k_limits, 0).decision == Decision::energise);
}

TEST_CASE("a known limit that is exceeded, too, still returns the machine, and is the reason") {
  const Folder folder;
  const Assessment both = assessed(
      folder, limit("rough", "within = \"1 mm\"\nsource = \"assumed\"") + limit("exact", "within = \"2 mm\"\nsource = \"measured\""),
      k_limits, 0);
  CHECK(both.decision == Decision::send_back);
  CHECK(says(both.reason, "'exact'"));
}

TEST_CASE("that only an assumed limit asks to return the machine is the reason, whatever else asks to inspect it") {
  const Folder folder;
  const Assessment a = assessed(folder, limit("slide", "within = \"1 mm\"\nsource = \"assumed\""),
                                "quantity = \"peak\"\nat_most = \"0.01 gravity\"\n[[criterion]]\nname = \"models\"\n" + k_limits, 0);
  CHECK(a.decision == Decision::inspect);
  CHECK(a.reasons.front().criterion == "models");
  CHECK(says(a.reason, "assumed"));
}

TEST_CASE("a limit whose uncertain parameter is assumed is assumed") {
  const Folder folder;
  const std::string follows = limit("slide", "within = \"= travel\"");
  CHECK(assessed(folder, uncertain_travel("assumed") + follows, k_limits, 0).decision == Decision::inspect);
  CHECK(assessed(folder, uncertain_travel("measured") + follows, k_limits, 0).decision == Decision::send_back);
}

TEST_CASE("an uncertain limit varies among the samples, in whatever unit its channel is") {
  const Folder folder;
  const std::string in_mm = "[[channel]]\nname = \"slid\"\nexpression = \"abs({floor.slide})\"\nunit = \"mm\"\n";
  const std::string of_mm = "[[acceptance]]\nname = \"slide\"\nchannel = \"slid\"\nconsequence = \"reject\"\nat_most = \"= travel\"\n";
  for (const std::string& more : {limit("slide", "within = \"= travel\""), in_mm + of_mm}) {
    const Assessment a = assessed(folder, uncertain_travel("measured") + more, k_limits, 40);
    REQUIRE(a.samples.size() == 40);
    for (const VoyageSample& sample : a.samples) {
      // The closed form is known to 0.5 µm, its last digit.
      if (std::abs(sample.values[0] - k_slide) < 1e-6) continue;
      CHECK_MESSAGE(is_damaged(sample.summary) == (sample.values[0] < k_slide), "limit " << sample.values[0]);
    }
  }
}

TEST_CASE("a probability of damage that only an assumed limit makes does not return the machine") {
  const Folder folder;
  const std::string asked = "quantity = \"damage_probability\"\nat_most = 0.05\noutcome = \"return\"";
  const std::string follows = limit("slide", "within = \"= travel\"");
  CHECK(assessed(folder, uncertain_travel("measured") + follows, asked, 40).decision == Decision::send_back);
  const Assessment assumed = assessed(folder, uncertain_travel("assumed") + follows, asked, 40);
  CHECK(assumed.decision == Decision::inspect);
  CHECK(assumed.known_damage.value == 0.0);
}

TEST_CASE("an uncertain limit that is no parameter is refused, with the way to give it") {
  const std::string direct = limit("slide", "within = \"3 mm\"") +
                             "[[uncertain]]\nname = \"travel\"\npaths = [\"acceptance.slide.within\"]\ndistribution = \"uniform\"\n"
                             "low = \"2 mm\"\nhigh = \"5 mm\"\nsource = \"assumed\"\nsource_text = \"a test\"\n";
  try {
    static_cast<void>(driven(block_text(k_friction, direct)));
    FAIL("it was taken");
  } catch (const ModelError& error) {
    CHECK(says(error.diagnostics().front().message, "[parameters]"));
  }
}
