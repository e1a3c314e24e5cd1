// A block on a deck that is accelerated for a while: everything is known in closed form.
//   D(A, t, mu) = (A t)²/(2 mu g) (1 − mu g/A), if A > mu g
#include "mbd/model/completion.h"
#include "mbd/rest/start.h"
#include "tests/tools/study/block_scene.h"
#include "tests/tools/study/study_bench.h"
#include "tools/study/law.h"

#include <cctype>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string with_friction(const std::string& kind, const std::string& settings, double mean, double cov) {
  return "kind = \"" + kind + "\"\nmodel = \"block.toml\"\n" + settings +
         "[[variable]]\nname = \"mu\"\npath = \"element.deck friction.static_friction\"\n" +
         "distribution = \"lognormal\"\nmean = " + std::to_string(mean) + "\ncov = " + std::to_string(cov) + "\n" + k_slid;
}

} // namespace

namespace {

// Returns true if a text has 64 hexadecimal digits in a row.
bool has_digest(const std::string& text) {
  std::size_t count = 0;
  for (const char c : text) {
    count = std::isxdigit(static_cast<unsigned char>(c)) ? count + 1 : 0;
    if (count == 64) return true;
  }
  return false;
}

} // namespace

TEST_CASE("a sweep over friction gives the distances of the closed form") {
  StudyBench bench;
  bench.write("block.toml", k_block);
  const Outcome outcome = bench.run("kind = \"sweep\"\nmodel = \"block.toml\"\n[[variable]]\nname = \"mu\"\npath = "
                                    "\"element.deck friction.static_friction\"\n"
                                    "values = [0.1, 0.2, 0.3, 0.5, 0.7]\n" +
                                    k_slid);
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  study::Store store(bench.at("study.sqlite"));
  std::vector<study::StoredSample> rows;
  store.read(1, 5, rows);
  // The screen has every value with what it gave, and no digests of the files.
  for (const char* row : {"sample", "     1  0.1", "     5  0.7"}) CHECK_MESSAGE(has(outcome.out, row), outcome.out);
  CHECK(has(outcome.out, "Read from "));
  CHECK_MESSAGE(!has_digest(outcome.out), outcome.out);
  for (const study::StoredSample& row : rows) {
    CAPTURE(row.values[0]);
    // The run's own tolerance is 1e-10.
    CHECK(row.outcome.numbers[0] == doctest::Approx(slid_distance(0.6 * k_g, 0.1, row.values[0])).epsilon(1e-8));
  }
}

// P = Φ((ln mu* − λ)/ζ): studies.md
TEST_CASE("the probability that it slides too far, friction lognormal") {
  struct Case {
    double mean, cov, limit, probability, beta;
  };
  for (const Case& c : {Case{0.45, 0.20, 0.010, 0.529745757, -0.074630777},
                        {0.60, 0.15, 0.005, 0.164196877, 0.977353354},
                        {0.60, 0.10, 0.005, 0.063857722, 1.523172941}}) {
    StudyBench bench;
    bench.write("block.toml", k_block);
    const std::string limit = "[[limit_state]]\nname = \"far\"\nexpression = \"" + std::to_string(c.limit) + " - slid\"\n";
    const Outcome outcome = bench.run(with_friction("reliability",
                                                    "[reliability]\nmethods = [\"form\", \"importance_sampling\"]\nsamples = "
                                                    "400\nconfidence = 0.999\nstarts = 2\n",
                                                    c.mean, c.cov) +
                                      limit);
    CAPTURE(outcome.err);
    CAPTURE(c.mean);
    // One variable and a monotonic response: first order is exact. Four digits are asked for.
    CHECK(std::abs(bench.find("form", "beta", "far").value - c.beta) < 1e-4);
    CHECK(bench.find("form", "probability").value == doctest::Approx(c.probability).epsilon(1e-4));
    CHECK(bench.find("importance_sampling", "probability").low <= c.probability);
    CHECK(bench.find("importance_sampling", "probability").high >= c.probability);
  }
}

TEST_CASE("responses of channels on request: friction's heat, and a formula of it") {
  StudyBench bench;
  bench.write("block.toml", k_block + "[output]\nalso = [\"deck friction.dissipated\"]\n"
                                      "[[channel]]\nname = \"way by heat\"\nexpression = \"{deck friction.dissipated} / '9810 N'\"\n");
  const std::string text = "kind = \"sweep\"\nmodel = \"block.toml\"\n[[variable]]\nname = \"mu\"\npath = "
                           "\"element.deck friction.static_friction\"\nvalues = [0.1, 0.3]\n"
                           "[[response]]\nname = \"heat\"\nchannel = \"deck friction.dissipated\"\nwhat = \"final\"\n"
                           "[[response]]\nname = \"way\"\nchannel = \"way by heat\"\nwhat = \"highest\"\n";
  const Outcome outcome = bench.run(text);
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  study::Store store(bench.at("study.sqlite"));
  std::vector<study::StoredSample> rows;
  store.read(1, 2, rows);
  for (const study::StoredSample& row : rows) {
    const double mu = row.values[0], way = slid_distance(0.6 * k_g, 0.1, mu);
    // μ m g times the way, and the way times μ: as closely as the run knows the way.
    CHECK(row.outcome.numbers[0] == doctest::Approx(mu * 9810.0 * way).epsilon(1e-7));
    CHECK(row.outcome.numbers[1] == doctest::Approx(mu * way).epsilon(1e-7));
  }
  StudyBench other;
  other.write("block.toml", k_block);
  std::string one = text;
  const Outcome refused = other.run(one.erase(one.rfind("[[response]]")));
  CHECK(refused.code == 3);
  CHECK(has(refused.err, "is made on request only"));
}

TEST_CASE("a sample is replayed by the command that runs models") {
  StudyBench bench;
  bench.write("block.toml", k_block);
  (void)bench.run("kind = \"sweep\"\nmodel = \"block.toml\"\n[[variable]]\nname = \"mu\"\npath = \"element.deck "
                  "friction.static_friction\"\nvalues = [0.2, 0.3]\n" +
                  k_slid);
  const Outcome outcome =
      study_does({"replay", bench.at("study.toml"), "--store", bench.at("study.sqlite"), "--sample", "2", "-o", bench.at("replay")});
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "\"element.deck friction.static_friction=0.3\""));
  CHECK(fs::exists(bench.at("replay/block/summary.json")));
  CHECK(study_does({"replay", bench.at("study.toml"), "--store", bench.at("study.sqlite"), "--sample", "3"}).code == 2);
}

// Runs of a study have only the channels that are asked for, and systems made from variants: their numbers are those of
// the model with the values laid over it, compiled and run as a whole.
TEST_CASE("a sample's numbers are those of the whole model with its values") {
  StudyBench bench;
  bench.write("block.toml", k_block);
  const std::string text =
      "kind = \"sweep\"\nmodel = \"block.toml\"\n[sweep]\ndesign = \"list\"\n"
      "[[variable]]\nname = \"mu\"\npath = \"element.deck friction.static_friction\"\nvalues = [0.1, 0.2, 0.45]\n"
      "[[variable]]\nname = \"m\"\npath = [\"body.block.mass\", \"element.foot.preload\"]\nfactor = true\nvalues = [1, "
      "1.5, 0.7]\n"
      "[[variable]]\nname = \"x\"\npath = \"body.deck.position.0\"\nvalues = [0, 0, 0.25]\n" +
      k_slid +
      "[[response]]\nname = \"force\"\nchannel = \"foot.force\"\nwhat = \"highest\"\n"
      "[[response]]\nname = \"end\"\nchannel = \"block.x\"\nwhat = \"final\"\n"
      "[[response]]\nname = \"way\"\nchannel = \"deck.x\"\nwhat = \"path\"\n";
  const Outcome outcome = bench.run(text);
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  const study::LoadedStudy loaded = study::read_study(bench.at("study.toml"));
  study::Store store(bench.at("study.sqlite"));
  std::vector<study::StoredSample> rows;
  store.read(1, 3, rows);
  for (const study::StoredSample& row : rows) {
    const Model model = completed(study::model_with(loaded, *loaded.models.front(), row.values.data()));
    const auto system = compile(model);
    SimulationOptions options = options_of(model);
    options.channels = {"*"};
    const RunResult result = simulate(*system, start_of(model, *system), options);
    const auto range = [&](const std::string& name) {
      return *std::find_if(result.ranges.begin(), result.ranges.end(), [&](const ChannelRange& r) { return r.channel->name == name; });
    };
    const std::vector<double> deck = result.trajectory->series("deck.x");
    double way = 0.0;
    for (std::size_t i = 1; i < deck.size(); ++i) way += std::abs(deck[i] - deck[i - 1]);
    // Where extremes are looked for hangs on the other channels too: to 1e-6 of their ranges. The rest is the same run.
    CHECK(row.outcome.numbers[0] == doctest::Approx(std::abs(range("deck friction.slide").largest().value)).epsilon(1e-6));
    CHECK(row.outcome.numbers[1] == doctest::Approx(range("foot.force").high.value).epsilon(1e-6));
    CHECK(row.outcome.numbers[2] == range("block.x").final);
    CHECK(row.outcome.numbers[3] == way);
    CHECK(row.outcome.evaluations > 0.0);
  }
}

// One variable in both, one in the second alone; each model slides as the closed form says.
TEST_CASE("a study over two models") {
  StudyBench bench;
  bench.write("soft.toml", k_block);
  bench.write("hard.toml", k_block);
  const Outcome outcome =
      bench.run("kind = \"sample\"\nmodel = [\"soft.toml\", \"hard.toml\"]\n[sample]\ndesign = \"latin_hypercube\"\nsamples = "
                "12\n"
                "[[variable]]\nname = \"mu\"\npath = \"element.deck friction.static_friction\"\ndistribution = \"uniform\"\nlow "
                "= 0.2\nhigh = 0.5\n"
                "[[variable]]\nname = \"peak\"\npath = \"signal.push.peak\"\nmodel = \"hard\"\ndistribution = \"uniform\"\nlow = "
                "6\nhigh = 8\n"
                "[[response]]\nname = \"soft\"\nmodel = \"soft\"\nchannel = \"deck friction.slide\"\nwhat = \"largest\"\n"
                "[[response]]\nname = \"hard\"\nmodel = \"hard\"\nchannel = \"deck friction.slide\"\nwhat = \"largest\"\n");
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  std::vector<study::StoredSample> rows;
  study::Store(bench.at("study.sqlite")).read(1, 12, rows);
  for (const study::StoredSample& row : rows) { // to the tolerance of the runs, 1e-10, over a few steps
    CHECK(row.outcome.numbers[0] == doctest::Approx(slid_distance(5.886, 0.1, row.values[0])).epsilon(1e-8));
    CHECK(row.outcome.numbers[1] == doctest::Approx(slid_distance(row.values[1], 0.1, row.values[0])).epsilon(1e-8));
  }
}
