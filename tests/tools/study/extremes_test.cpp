// A study follows only those extremes that it is asked for, and of channels that one response looks at together only the outermost.
// What it says is held against runs by themselves, which follow all ends of all channels.
#include "mbd/base/name_pattern.h"
#include "mbd/io/reader.h"
#include "mbd/model/completion.h"
#include "mbd/model/model_path.h"
#include "mbd/rest/start.h"
#include "tests/tools/study/study_bench.h"
#include "transformer/catalog.h"

using namespace steplap;
using namespace steplap::testing;

namespace {

// Extremes are located to 1e-6 of a channel's range. What but a look at another channel would show may be missed on top of it: of
// 800 samples of this scene the margin was off by 2.6e-6 at most.
constexpr double k_located = 1e-5;

const std::string k_scene = STEPLAP_SOURCE "/models/studies/transformer_interference.toml";
const std::string k_paths[] = {"element.tank bottom.static_friction", "core.core.static_friction", "core.core.pressure",
                               "signal.braking.peak"};
const std::string k_values[] = {"[0.28, 0.4]", "[0.2, 0.3]", "[7e4, 1.2e5]", "[-8.5, 6.0, -4.5]"}; // in each direction

std::string study_text() {
  std::string text = "kind = \"sweep\"\nmodel = \"" + k_scene + "\"\n";
  for (std::size_t i = 0; i < std::size(k_paths); ++i)
    text += "[[variable]]\nname = \"x" + std::to_string(i) + "\"\npath = \"" + k_paths[i] + "\"\nvalues = " + k_values[i] + "\n";
  const auto ask = [&](const char* name, const char* channel, const char* what) {
    text += std::string("[[response]]\nname = \"") + name + "\"\nchannel = \"" + channel + "\"\nwhat = \"" + what + "\"\n";
  };
  ask("margin", "* joint.margin", "lowest");
  ask("pressure", "* joint.p_req", "highest");
  ask("push", "* arresting.force", "highest");
  ask("slide", "tank bottom.slide", "final");
  return text;
}

/// The outermost end of all channels that match, of a run of the model by itself.
double outermost(const RunResult& run, const std::string& pattern, bool is_low) {
  double best = std::numeric_limits<double>::quiet_NaN();
  for (const ChannelRange& range : run.ranges) {
    if (!matches_pattern(range.channel->name, pattern)) continue;
    const double value = is_low ? range.low.value : range.high.value;
    if (std::isnan(best) || (is_low ? value < best : value > best)) best = value;
  }
  return best;
}

} // namespace

TEST_CASE("extremes of a study are those of runs by themselves") {
  StudyBench bench;
  const Outcome outcome = bench.run(study_text());
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  study::Store store(bench.at("study.sqlite"));
  std::vector<study::StoredSample> rows;
  store.read(1, store.size(), rows);
  REQUIRE(rows.size() == 24);
  const Model given = read_given_model(k_scene, transformer_catalog());
  int of_front = 0;
  for (const study::StoredSample& row : rows) {
    CAPTURE(row.number);
    Model model = given;
    for (std::size_t i = 0; i < std::size(k_paths); ++i) set_value(model, k_paths[i], row.values[i]);
    model = completed(model);
    const auto system = compile(model);
    SimulationOptions options = options_of(model);
    options.output_step = 0.0;
    const RunResult run = simulate(*system, start_of(model, *system), options);
    const std::vector<double>& numbers = row.outcome.numbers;
    CHECK(numbers.at(0) == doctest::Approx(outermost(run, "* joint.margin", true)).epsilon(k_located));
    CHECK(numbers.at(1) == doctest::Approx(outermost(run, "* joint.p_req", false)).epsilon(k_located));
    CHECK(numbers.at(2) == doctest::Approx(outermost(run, "* arresting.force", false)).epsilon(k_located));
    const auto slide = std::find_if(run.ranges.begin(), run.ranges.end(),
                                    [](const ChannelRange& range) { return range.channel->name == "tank bottom.slide"; });
    REQUIRE(slide != run.ranges.end());
    CHECK(numbers.at(3) == slide->final); // the motion does not hang on what is asked for, to the bit
    of_front += outermost(run, "front joint.margin", true) < outermost(run, "back joint.margin", true) ? 1 : 0;
  }
  CHECK(of_front >= 4); // either joint wins the race now and then
  CHECK(of_front <= 20);
}

// At a flat position of linkages joints' reactions go with one over the distance from it, and how near a run comes is chance: −1.1e10 N, where
// the same model by itself found −181 N.
TEST_CASE("an extreme met beside a singular position is not to be trusted, one of the same run met elsewhere is") {
  const auto status_of = [](const std::string& channel, const std::string& what) {
    StudyBench bench;
    const Outcome outcome =
        bench.run("kind = \"sample\"\nseed = 49\nmodel = \"" STEPLAP_SOURCE "/models/benchmarks/four_bar_40.toml\"\n[sample]\nsamples = 2\n"
                  "[[variable]]\nname = \"angle\"\npath = \"body.rod 10.angle\"\nfactor = true\ndistribution = \"uniform\"\nlow = 0.85\n"
                  "high = 1.2\n[[response]]\nname = \"found\"\nchannel = \"" +
                  channel + "\"\nwhat = \"" + what + "\"\n");
    CAPTURE(outcome.err);
    study::Store store(bench.at("study.sqlite"));
    std::vector<study::StoredSample> rows;
    store.read(1, store.size(), rows);
    REQUIRE(rows.size() == 2);
    return rows.front().outcome.status;
  };
  CHECK(status_of("*.force_y", "largest") == study::SampleStatus::untrusted);
  CHECK(status_of("rod 0.y", "highest") == study::SampleStatus::ok);
}
