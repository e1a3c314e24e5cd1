#include "mbd/io/reader.h"
#include "mbd/model/completion.h"
#include "mbd/run/findings.h"
#include "mbd/run/report.h"
#include "mbd/run/result_files.h"
#include "mbd/run/with_settings.h"
#include "mbd/trust/element_judgement.h"
#include "transformer/program.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

using namespace steplap;

namespace {

constexpr const char* k_pendulum = R"([simulation]
end = 0.1

[[body]]
name = "bob"
mass = 1.0
inertia = 0.01
position = [1.0, 0.0]

[[element]]
kind = "stay"
name = "rod"
a = "bob"
)";

// A rod that is content with no run.
const ElementKind& stay_kind() {
  static const ElementKind kind = [] {
    ElementKind k = *program_catalogue().find_element("distance");
    k.name = "stay";
    k.judge = [](const Element& element, const Model&, const RunResult&) {
      CriterionResult never;
      never.name = element.name;
      never.consequence = never.outcome = Verdict::reject;
      return ElementJudgement{{never}, {}, ""};
    };
    return k;
  }();
  return kind;
}

} // namespace

// Its core's joints are not there yet: compiled as it is it would never slip.
TEST_CASE("a model as given is completed before it is compiled, or refused") {
  const std::string file = STEPLAP_MODELS "/layouts/three_limb.toml";
  const Model given = read_given_model(file, program_catalogue());
  CHECK_THROWS_WITH_AS(static_cast<void>(compile(given)), doctest::Contains("the model is as given"), ModelError);
  const auto loaded = load_given(given, "three_limb"), read = load_model(file);
  CHECK(loaded->system->channels.size() == read->system->channels.size());
  CHECK(judged_run(loaded).judgement.verdict == judged_run(read).judgement.verdict);
  CHECK_THROWS_AS(judged_run(loaded).write("nowhere"), FileError); // it has no text to be run again from
}

TEST_CASE("what is found after a run, and what was not looked for, forbids to call it hold") {
  const std::string file = STEPLAP_MODELS "/layouts/five_limb.toml";
  RunOptions quick;
  quick.estimating = Estimating::never;
  REQUIRE(judged_run(load_model(file), quick).judgement.verdict == Verdict::hold);
  // Feet 2.4 m from the middle of a tank that reaches 2.2 m.
  const Report beyond = judged_run(load_model(file, {"body.tank.outline=[[-2.2, -1.75], [2.2, -1.75], [2.2, 1.95], [-2.2, 1.95]]"}), quick);
  CHECK(beyond.judgement.verdict == Verdict::open);
  CHECK(std::count_if(beyond.findings.begin(), beyond.findings.end(), [](const Finding& f) { return f.code == "foot_beyond_edge"; }) == 2);
  quick.has_extremes = false;
  CHECK(judged_run(load_model(file), quick).judgement.verdict == Verdict::open);
}

TEST_CASE("a model with a kind of one's own is loaded by a catalogue that has it, and judged by the kind") {
  namespace fs = std::filesystem;
  const fs::path file = fs::temp_directory_path() / ("steplap_stay_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(file) << k_pendulum;

  CHECK_THROWS_WITH_AS(static_cast<void>(load_model(file.string())), doctest::Contains("unknown kind 'stay'"), ModelError);

  std::shared_ptr<const LoadedModel> loaded;
  {
    Catalogue catalogue = program_catalogue();
    catalogue.elements.push_back(&stay_kind());
    loaded = load_model(file.string(), {"simulation.end=0.05"}, catalogue);
  } // the model refers to the kinds and not to the catalogue
  fs::remove(file);

  const Report report = judged_run(loaded);
  CHECK(report.run.result.final_state.t == 0.05);
  CHECK(report.judgement.verdict == Verdict::reject);
  REQUIRE(report.judgement.criteria.size() == 1);
  CHECK(report.judgement.criteria.front().name == "rod");
}

namespace {

namespace fs = std::filesystem;

// Files of a run by name, with what they hold.
std::map<std::string, std::string> files_of(const Report& report) {
  std::map<std::string, std::string> files;
  for (const ResultFile& file : result_files(report)) {
    std::string& text = files[file.name];
    if (!file.parts) text = file.content;
    else file.parts([&text](std::string_view part) { text += part; });
  }
  return files;
}

} // namespace

// The second model reads a record, whose checksum stands in model.toml.
TEST_CASE("settings of a run are the same overrides, byte for byte, in all files") {
  struct Case {
    const char* what;
    std::vector<std::string> overrides;
    RunOptions options;
  };
  const auto with = [](auto change) {
    RunOptions options;
    change(options);
    return options;
  };
  const Case cases[] = {
      {"tolerance", {"simulation.tolerance=1e-07"}, with([](RunOptions& o) { o.tolerance = 1e-7; })},
      {"step", {"simulation.integrator=rk4", "simulation.step=0.00025"}, with([](RunOptions& o) { o.method = "rk4", o.step = 2.5e-4; })},
      {"all",
       {"simulation.integrator=rodas5p", "simulation.tolerance=1e-06", "simulation.end=0.25", "output.step=0.01"},
       with([](RunOptions& o) { o.method = "rodas5p", o.tolerance = 1e-6, o.end = 0.25, o.output_step = 0.01; })}};
  for (const char* model : {STEPLAP_MODELS "/benchmarks/simple_pendulum.toml", STEPLAP_MODELS "/benchmarks/hard/noisy_record.toml"})
    for (const Case& c : cases) {
      CAPTURE(model);
      CAPTURE(c.what);
      const auto by_options = files_of(judged_run(load_model(model, {"title=the same"}), c.options));
      std::vector<std::string> overrides = c.overrides;
      overrides.insert(overrides.begin(), "title=the same");
      const auto by_overrides = files_of(judged_run(load_model(model, overrides)));
      REQUIRE(by_options.size() == 5);
      CHECK(by_options == by_overrides);
      CHECK(by_options != files_of(judged_run(load_model(model, {"title=the same"})))); // they do something
    }
}

TEST_CASE("settings that a model cannot be run with are refused, all of them at once, and those it has are laid over it once") {
  const auto loaded = load_model(STEPLAP_MODELS "/benchmarks/simple_pendulum.toml");
  CHECK(with_settings(loaded, {}) == loaded);
  RunOptions bad;
  bad.method = "dop583";
  bad.tolerance = 3.0;
  bad.end = std::numeric_limits<double>::quiet_NaN();
  bad.output_step = -1.0;
  try {
    static_cast<void>(run_model(loaded, bad));
    FAIL("not refused");
  } catch (const ModelError& error) {
    CHECK(error.diagnostics().size() == 4);
    for (const char* part : {"RunOptions: error: ", "did you mean 'dop853'?", "must be at most 0.1, got 3", "must be finite",
                             "must be greater than 0 s, got -1"})
      CHECK_MESSAGE(std::string(error.what()).find(part) != std::string::npos, part << " is not in\n" << error.what());
  }
  RunOptions no_method, idle_step, no_step, short_run;
  no_method.method = "";
  CHECK_THROWS_WITH_AS(static_cast<void>(run_model(loaded, no_method)), doctest::Contains("'method' is empty"), ModelError);
  idle_step.step = 1e-4; // the model's method chooses its steps by itself
  CHECK_THROWS_WITH_AS(static_cast<void>(run_model(loaded, idle_step)), doctest::Contains("for methods of a fixed step"), ModelError);
  no_step.method = "rk4";
  CHECK_THROWS_WITH_AS(static_cast<void>(run_model(loaded, no_step)), doctest::Contains("needs 'step'"), ModelError);
  short_run.end = 1e-6;
  CHECK_THROWS_WITH_AS(static_cast<void>(run_model(loaded, short_run)), doctest::Contains("is larger than 'end'"), ModelError);

  RunOptions good;
  good.end = 0.5;
  const auto once = with_settings(loaded, good), twice = with_settings(once, good);
  CHECK(once != loaded);
  CHECK(once->model.simulation.end == 0.5);
  CHECK(once->system != loaded->system); // steps and scales hang on the end
  CHECK(twice == once);
  CHECK(once->overrides == std::vector<std::string>{"simulation.end=0.5"});
  CHECK(loaded->overrides.empty());
  good.end = 0.4;
  CHECK(with_settings(once, good)->overrides == std::vector<std::string>{"simulation.end=0.5", "simulation.end=0.4"});
}

// Compiling reads records again: results would be of another record than model.toml names.
TEST_CASE("settings are not laid over a model whose record has changed since it was loaded") {
  const fs::path folder = fs::temp_directory_path() / ("steplap_record_" + std::to_string(::getpid()));
  fs::create_directory(folder);
  std::ofstream(folder / "f.csv") << "t,f\n0,0\n1,1\n";
  std::ofstream(folder / "a.toml") << R"(
[[signal]]
name = "f"
kind = "record"
file = "f.csv"
time_column = "t"
column = "f"
[[body]]
name = "mass"
mass = 1.0
inertia = 1.0
[[element]]
kind = "load"
name = "push"
at = "mass"
force_x = "f"
)";
  const auto loaded = load_model((folder / "a.toml").string());
  RunOptions options;
  options.end = 0.5;
  CHECK(with_settings(loaded, options)->inputs == loaded->inputs);
  std::ofstream(folder / "f.csv") << "t,f\n0,0\n1,2\n";
  CHECK_THROWS_WITH_AS(static_cast<void>(with_settings(loaded, options)), doctest::Contains("has changed since the model was loaded"),
                       ModelError);
  fs::remove_all(folder);
}

TEST_CASE("a record is in the units of its header, and open if it ends within an event") {
  const fs::path folder = fs::temp_directory_path() / ("steplap_header_" + std::to_string(::getpid()));
  fs::create_directory(folder);
  const auto impulse = [&](const std::string& rows, const std::string& fields = "", double* doubts = nullptr,
                           const std::string& force = "f") {
    std::ofstream(folder / "a.csv") << rows;
    const std::string text = "simulation.end = 1.0\n[[signal]]\nname = \"f\"\nkind = \"record\"\nfile = \"" + (folder / "a.csv").string() +
                             "\"\n" + fields +
                             "[[body]]\nname = \"m\"\nmass = 1.0\ninertia = 1.0\n[[element]]\nkind = \"load\"\nname = \"push\"\nat = "
                             "\"m\"\nforce_x = \"" +
                             force + "\"\n[[acceptance]]\nname = \"slow\"\nchannel = \"m.vx\"\nwithin = 1e3\n";
    const Report report = judged_run(load_model_text(text, "record.toml"), {});
    if (doubts)
      *doubts = static_cast<double>(
          std::count_if(report.findings.begin(), report.findings.end(), [](const Finding& f) { return f.code == "record_in_doubt"; }));
    return report.run.result.final_state.v[3];
  };
  // A triangle of 2 units, 0.2 s long.
  const std::string rows = "\n0,0\n0.1,2\n0.2,0\n", thousand = "\n0,0\n100,2\n200,0\n";
  CHECK(impulse("t,f" + rows) == doctest::Approx(0.2));
  CHECK(impulse("t [s],f [kN]" + rows) == doctest::Approx(200.0));
  CHECK(impulse("t [ms],f [N]" + thousand) == doctest::Approx(0.2));
  const std::string scaled = "[[signal]]\nname = \"times mass\"\nkind = \"scaled\"\nsignal = \"f\"\nfactor = 2.0\n";
  CHECK(impulse("t [s],a [g]" + rows, scaled, nullptr, "times mass") == doctest::Approx(0.4 * 9.80665)); // of an acceleration, not grams
  CHECK_THROWS_WITH_AS(impulse("t [s],a [g]" + rows), doctest::Contains("its signal 'f' is in gravity by the header of its file"),
                       ModelError);
  CHECK(impulse("t,f" + rows, "unit = \"kN\"\n") == doctest::Approx(200.0));
  CHECK(impulse("t [s],f [kN]" + rows, "unit = \"kN\"\n") == doctest::Approx(200.0));
  CHECK_THROWS_WITH_AS(impulse("t [s],f [kN]" + rows, "unit = \"N\"\n"), doctest::Contains("but the column says [kN]"), ModelError);
  CHECK_THROWS_WITH_AS(impulse("t [s],f [furlongs of hay]" + rows), doctest::Contains("is not known: give it by 'unit'"), ModelError);
  CHECK_THROWS_WITH_AS(impulse("t [s],f [kN]" + rows, "unit = \"m/s^2\"\n"), doctest::Contains("but the column says [kN]"), ModelError);
  CHECK(impulse("t [s],f [-]" + rows) == doctest::Approx(0.2));
  // Parentheses may hold a unit or a part of the name, so the reader asks for the unit where the two give different values.
  CHECK_THROWS_WITH_AS(impulse("t,f (kN)" + rows), doctest::Contains("column 'f (kN)' may be in the unit in its parentheses"), ModelError);
  CHECK_THROWS_WITH_AS(impulse("t (ms),f" + rows), doctest::Contains("say which by 'time_unit'"), ModelError);
  CHECK(impulse("t (s),f (kN)" + rows, "unit = \"kN\"\n") == doctest::Approx(200.0));
  CHECK(impulse("t (s),f (front)" + rows) == doctest::Approx(0.2));
  double doubts = 0.0;
  (void)impulse("t,f" + rows, "", &doubts);
  CHECK(doubts == 0.0);
  (void)impulse("t,f\n0,0\n0.1,2\n", "", &doubts); // ends at its peak
  CHECK(doubts == 1.0);
  (void)impulse("t,f\n0,0\n0.1,2\n", "after = \"hold\"\n", &doubts);
  CHECK(doubts == 0.0);
  (void)impulse("t,f\n0,2\n0.1,0\n", "", &doubts); // anything: a spring that is let go
  CHECK(doubts == 0.0);
  (void)impulse("t,a [g]\n0,2\n0.1,0\n", scaled, &doubts, "times mass"); // an acceleration began before it was measured
  CHECK(doubts == 1.0);
  fs::remove_all(folder);
}

TEST_CASE("settings are laid over a model made in code, too") {
  const auto loaded = load_given(read_given_model(STEPLAP_MODELS "/layouts/three_limb.toml", program_catalogue()), "three_limb");
  RunOptions options;
  options.end = 0.05;
  const Run run = run_model(loaded, options);
  CHECK(run.result.final_state.t == 0.05);
  CHECK(run.loaded->name == "three_limb");
  CHECK(run.loaded->text.empty());
  CHECK(run.loaded->system->channels.size() == loaded->system->channels.size());
}

// A road at a walking pace: 20 m of run-in are 20 s, and a run of 12 s would hold because it hardly sees a load.
TEST_CASE("a run that ends before its load has grown does not hold") {
  const std::string file = STEPLAP_MODELS "/loads/road_class_c.toml";
  const auto growing = [&](const std::vector<std::string>& overrides) {
    const auto loaded = load_model(file, overrides);
    const std::vector<Finding> findings = findings_of(*loaded);
    const auto found = std::find_if(findings.begin(), findings.end(), [](const Finding& each) { return each.code == "load_still_grows"; });
    return found != findings.end() && caps_verdict(*found) ? found->text : "";
  };
  CHECK(growing({}).empty());
  CHECK(growing({"signal.road.speed=1 m/s"}).find("from t = 20 s on") != std::string::npos);
  CHECK(growing({"signal.road.speed=1 m/s", "simulation.end=21"}).find("from t = 27 s on") !=
        std::string::npos); // the rear axles, 7 m behind
  CHECK(growing({"signal.road.speed=1 m/s", "simulation.end=45"}).empty());
}

TEST_CASE("a run keeps running extremes only if a criterion can read them") {
  const std::string pendulum = std::string(k_pendulum).replace(std::string(k_pendulum).find("stay"), 4, "distance");
  const std::string criterion = "[[acceptance]]\nname = 'near'\nchannel = 'bob.x'\nwithin = 2.0\nconsequence = 'reject'\n";
  for (const bool is_limited : {false, true}) {
    const auto loaded =
        load_given(parse_given_model(pendulum + (is_limited ? criterion : ""), "pendulum.toml", program_catalogue()), "pendulum");
    RunOptions options;
    options.has_extremes = true;
    CHECK(run_model(loaded, options).result.growth.empty() == !is_limited);
  }
}

// 11 200 free bodies have 100 800 channels.
TEST_CASE("a large scene has the extremes that are asked for, and those of everything that is judged") {
  std::string bodies = "[simulation]\nend = 0.1\nintegrator = 'rk4'\nstep = 0.05\n[output]\nstep = 0.1\n";
  for (int i = 0; i < 11200; ++i)
    bodies += "[[body]]\nname = 'b" + std::to_string(i) + "'\nmass = 1.0\ninertia = 1.0\nposition = [" + std::to_string(i) + ", 0]\n";
  const std::string plot = "[[plot]]\nname = 'fall'\nchannels = ['b7.vy']\n";
  const std::string criterion = "[[acceptance]]\nname = 'near'\nchannel = 'b3.y'\nwithin = 2.0\nconsequence = 'reject'\n";
  RunOptions options;
  options.estimating = Estimating::never;
  // Returns the number of channels with extremes, and whether a warning says that some are left out.
  const auto counted = [&](const std::string& text, const std::vector<std::string>& settings) {
    const auto loaded = load_model_text(text, "bodies.toml", settings);
    const std::vector<Finding> findings = findings_of(*loaded);
    const bool is_said = std::any_of(findings.begin(), findings.end(), [](const Finding& f) { return f.code == "extremes_left_out"; });
    const std::vector<ChannelRange> ranges = run_model(loaded, options).result.ranges;
    return std::pair(std::count_if(ranges.begin(), ranges.end(), [](const ChannelRange& r) { return std::isfinite(r.high.value); }),
                     is_said);
  };
  CHECK(counted(bodies + plot, {}) == std::pair(std::ptrdiff_t{1}, true));
  CHECK(counted(bodies, {"output.channels=[\"b1?.y\"]"}) == std::pair(std::ptrdiff_t{10}, true));
  CHECK(counted(bodies, {"output.channels=[\"*\"]"}) == std::pair(std::ptrdiff_t{100800}, false));
  CHECK(counted(bodies + criterion, {}) == std::pair(std::ptrdiff_t{100800}, false));
  const Report report = judged_run(load_model_text(bodies + plot, "bodies.toml"), options);
  const nlohmann::json extremes = nlohmann::json::parse(summary_json(report, {})).at("extremes");
  CHECK(extremes.size() == 1);
  CHECK(extremes.contains("b7.vy"));
  const auto range =
      std::find_if(report.ranges().begin(), report.ranges().end(), [](const ChannelRange& each) { return each.channel->name == "b7.vy"; });
  REQUIRE(range != report.ranges().end());
  CHECK(range->low.value == doctest::Approx(-9.81 * 0.1).epsilon(1e-12)); // free fall, which rk4 integrates exactly
}

// The statistics are made up, because a run whose estimate is too expensive takes long itself.
TEST_CASE("a criterion that is met is open if the estimate of its error would take long, and an estimate that decides may cost more") {
  const std::string pendulum = std::string(k_pendulum).replace(std::string(k_pendulum).find("stay"), 4, "distance");
  const std::string criterion = "[[acceptance]]\nname = 'near'\nchannel = 'bob.x'\nwithin = 2.0\nconsequence = 'reject'\n";
  const auto loaded = load_model_text(pendulum + "b = 'ground'\n" + criterion, "pendulum.toml",
                                      {"simulation.integrator=moreau", "simulation.step=0.01 ms"});
  const auto reported = [&](double parts, const RunOptions& options) {
    Run as_dear = run_model(loaded, {});
    RunStatistics& statistics = as_dear.result.statistics;
    statistics.evaluations = 1;
    statistics.evaluations = static_cast<long>(parts / evaluation_cost(*loaded->system, statistics));
    return report_on(std::move(as_dear), {}, options);
  };
  // Two finer runs cost six times the run. The limits are 1e7 and 1e8 parts.
  const Report cheap = reported(1e6, {}), decisive = reported(1e7, {}), dear = reported(1e8, {});
  CHECK(cheap.judgement.verdict == Verdict::hold);
  CHECK(decisive.judgement.verdict == Verdict::hold);
  CHECK(dear.estimate.status == EstimateStatus::too_expensive);
  CHECK(dear.judgement.verdict == Verdict::open);
  CHECK(dear.judgement.criteria.at(0).doubt == "met, but its error is not known: the estimate would take long; ask for it explicitly");
  RunOptions checked;
  checked.has_second_opinion = true;
  const Report twice = reported(1e8, checked);
  CHECK(twice.estimate.status == EstimateStatus::known);
  CHECK(twice.judgement.verdict == Verdict::hold);
}
