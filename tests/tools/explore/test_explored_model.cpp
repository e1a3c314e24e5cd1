// A model run with other values is the model that its file with these values makes: in memory, from a file of the changes, and as the
// command line runs it. Held against each other byte by byte.
#include "mbd/run/overview.h"
#include "tests/tools/steplap/workbench.h"
#include "tools/explore/explored_model.h"
#include "tools/explore/run_results.h"
#include "tools/explore/saved_changes.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string model_at(const std::string& name) { return std::string(STEPLAP_MODELS) + "/" + name + ".toml"; }

// A slider of each group that the model has, moved a little.
ExploredValues moved(const ExploredModel& model) {
  ExploredValues values;
  std::set<std::string> groups;
  for (const Slider& s : model.sliders())
    if (!s.group.empty() && !s.is_whole && groups.insert(s.group).second) values[s.path] = s.value + 0.013 * (s.most - s.value);
  return values;
}

void check_alike(const Results& a, const Results& b) {
  CHECK(a.times == b.times);
  REQUIRE(a.channels.size() == b.channels.size());
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    CHECK(a.channels[i].name == b.channels[i].name);
    const auto &x = a.channels[i].values, &y = b.channels[i].values;
    REQUIRE(x.size() == y.size());
    for (std::size_t k = 0; k < x.size(); ++k)
      if (!(x[k] == y[k] || (std::isnan(x[k]) && std::isnan(y[k])))) FAIL_CHECK(a.channels[i].name << " at " << a.times[k]);
  }
  REQUIRE(a.events.size() == b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i)
    CHECK((a.events[i].t == b.events[i].t && a.events[i].element == b.events[i].element && a.events[i].kind == b.events[i].kind));
  CHECK(a.drawing == b.drawing);
}

} // namespace

TEST_CASE("values set in memory, in the file and in a saved file give the same run") {
  for (const char* name :
       {"machines/stacked_blocks", "paper/weak_clamping", "machines/crane_arm", "layouts/three_limb", "benchmarks/slider_crank"}) {
    CAPTURE(name);
    const Workbench bench;
    ExploredModel model(model_at(name), {"simulation.end=0.05"});
    model.read();
    const ExploredValues values = moved(model);
    CHECK(values.size() >= 1);
    RunOptions options;
    options.estimating = Estimating::never;
    const Report first = model.run(values, options), second = model.run_from_file(values, options);
    const Results in_memory = results_of(first);
    check_alike(in_memory, results_of(second));
    CHECK(first.judgement.verdict == second.judgement.verdict);
    CHECK(overview_of(first).reason == overview_of(second).reason);
    REQUIRE(first.findings.size() == second.findings.size());
    for (std::size_t i = 0; i < first.findings.size(); ++i)
      CHECK(text_with_place(first.findings[i]) == text_with_place(second.findings[i]));
    // The file of the changes stands beside the model's in use; here in a copy of its folder.
    const std::string folder = bench.at("copy");
    fs::copy(fs::path(STEPLAP_MODELS), folder, fs::copy_options::recursive);
    ExploredModel copy((fs::path(folder) / (std::string(name) + ".toml")).string(), {"simulation.end=0.05"});
    copy.read();
    const std::string saved = save_changes(copy, values, "changed.toml");
    CHECK(has(text_of(saved), "extends = "));
    ExploredModel again(saved, {});
    again.read();
    check_alike(in_memory, results_of(again.run({}, options)));
    CHECK_THROWS_AS((void)save_changes(copy, values, "changed.toml"), FileError);
  }
}

TEST_CASE("results without a folder are those that the folder gives back") {
  const Workbench bench;
  const std::string file = bench.write("ball.toml", k_bouncer);
  ExploredModel model(file, {});
  model.read();
  const Results here = results_of(model.run_from_file({{"element.floor.damping", 20.0}}, {}));
  REQUIRE(steplap_does({"simulate", file, "--set", "element.floor.damping=20", "-o", bench.at("out"), "-q"}).code == 0);
  const Results there = read_results(bench.at("out/ball"));
  check_alike(here, there);
  CHECK(here.model == there.model);
  CHECK(here.name == there.name);
  // The folder's summary lists its files besides.
  const std::size_t end = here.summary.find("\"overview\"");
  REQUIRE(end != std::string::npos);
  CHECK(there.summary.starts_with(here.summary.substr(0, end)));
}

TEST_CASE("changes of what a file that extends another does not reach are saved as a model that stands alone") {
  const Workbench bench;
  bench.write("wheel.toml", "[[body]]\nname = \"disc\"\nmass = 2\ninertia = 1\n");
  const std::string file =
      bench.write("cart.toml", "[simulation]\nend = 0.01\nstep = 1e-3\n[[part]]\nname = \"front\"\nfile = \"wheel.toml\"\n");
  ExploredModel model(file, {});
  try {
    model.read();
  } catch (const ModelError& error) {
    FAIL(error.what());
  }
  const ExploredValues values{{"body.front.disc.mass", 3.0}};
  ExploredModel again(save_changes(model, values, "heavy.toml"), {});
  again.read();
  const auto mass = [](const ExploredModel& m) {
    for (const Slider& s : m.sliders())
      if (s.path == "body.front.disc.mass") return s.value;
    return 0.0;
  };
  CHECK(mass(model) == 2.0);
  CHECK(mass(again) == 3.0);
}

TEST_CASE("a file that cannot be read any more leaves the model as it was") {
  const Workbench bench;
  const std::string file = bench.write("ball.toml", k_bouncer);
  ExploredModel model(file, {});
  CHECK_THROWS_AS((void)model.run({}, {}), ModelError); // nothing was read yet
  model.read();
  const Results before = results_of(model.run({}, {}));
  bench.write("ball.toml", "[[body]\n");
  CHECK_THROWS_AS(model.read(), ModelError);
  check_alike(before, results_of(model.run({}, {})));
  CHECK(model.files().size() == 1);
  for (const ExploredValues& values : {ExploredValues{{"body.none.mass", 1.0}}, ExploredValues{{"body.ball.mass", std::nan("")}},
                                       ExploredValues{{"body.ball.mass", -1.0}}, ExploredValues{{"title", 1.0}}})
    CHECK_THROWS_AS((void)model.run(values, {}), ModelError);
}
