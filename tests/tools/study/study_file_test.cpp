// Study files: every mistake is told with its line before anything runs.
#include "tests/tools/study/study_bench.h"
#include "tools/study/study_reader.h"

#include <nlohmann/json.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <functional>

using namespace steplap;
using namespace steplap::testing;

namespace {

const std::string k_model = "model = \"" STEPLAP_MODELS "/paper/no_interference.toml\"\n";
const std::string k_variable = "[[variable]]\nname = \"mu\"\npath = \"element.tank bottom.static_friction\"\nvalues = [0.2, 0.3]\n";

std::string complaint(const std::string& text) {
  StudyBench bench;
  const Outcome outcome = bench.run(text);
  CHECK(outcome.code == 3);
  CHECK_FALSE(fs::exists(bench.at("study.sqlite")));
  std::string err = outcome.err;
  for (std::size_t i = err.find(bench.at("")); i != std::string::npos; i = err.find(bench.at(""))) err.erase(i, bench.at("").size());
  return err;
}

} // namespace

TEST_CASE("mistakes are told with file, line and what was probably meant") {
  struct Mistake {
    std::string text, message;
  };
  const std::string head = "kind = \"sweep\"\n" + k_model; // two lines
  const std::vector<Mistake> mistakes{
      {"kind = \"swep\"\n", "study.toml:1:8: error: there is no kind of study 'swep' (did you mean 'sweep'?); those there are: 'sweep'"},
      {"kind = \"sweep\"\nmodel = \"none.toml\"\n", "study.toml:2:9: error: there is no model file"},
      {"kind = \"sweep\"\nmodell = \"none.toml\"\n", "study.toml:2:1: error: unknown key 'modell' in the study (did you mean 'model'?)"},
      {head + "[[variable]]\nname = \"mu\"\npath = \"element.tank botom.static_friction\"\nvalues = [0.3]\n",
       "study.toml:5:8: error: path 'element.tank botom.static_friction' of variable 'mu' in model 'no_interference': "
       "there is no element 'tank botom' (did you mean 'tank bottom'?)"},
      {head + "[[variable]]\nname = \"mu\"\npath = \"element.tank bottom.static_frction\"\nvalues = [0.3]\n",
       "(did you mean 'static_friction'?)"},
      {head + "[[variable]]\nname = \"p\"\npath = \"core.core.pressure\"\nvalues = [\"3 mm\"]\n",
       "study.toml:6:11: error: 'values' of variable 'p'"},
      {head + "[[variable]]\nname = \"mu\"\npath = \"element.tank bottom.static_friction\"\nvalues = [-0.3]\n",
       "variable 'mu', path 'element.tank bottom.static_friction'"},
      {head + "[[variable]]\nname = \"x\"\npath = [\"core.core.pressure\", \"core.core.overlap\"]\nvalues = [1]\n",
       "one value cannot be both"},
      {head + "[[variable]]\nname = \"tank mu\"\npath = \"element.tank bottom.static_friction\"\nvalues = [0.3]\n",
       "must begin with a letter"},
      {head + k_variable + "[[response]]\nname = \"m\"\nchannel = \"front joint.margn\"\nwhat = \"lowest\"\n",
       "study.toml:9:11: error: no channel of model 'no_interference' is called 'front joint.margn' (did you mean "
       "'front joint.margin'?)"},
      {head + k_variable + "[[response]]\nname = \"m\"\nchannel = \"front joint.*\"\nwhat = \"lowest\"\n", "are of different units"},
      {head + k_variable + "[[response]]\nname = \"n\"\nwhat = \"count\"\nevent = \"slip\"\n",
       "response 'n': no event of the model is called 'slip' (did you mean 'slips'?)"},
      {head + k_variable + "[[response]]\nname = \"n\"\nwhat = \"count\"\nevent = \"slips\"\nelement = \"tank bottom\"\n",
       "response 'n': no event of 'tank bottom' is called 'slips'; there are 'loses"},
      {head + k_variable + "[[response]]\nname = \"m\"\nexpression = \"2*nu\"\n",
       "'nu' in the expression '2*nu' is not known (did you mean 'mu'?)"},
      {head + k_variable + "[[limit_state]]\nname = \"g\"\nexpression = \"1 - (mu\"\n", "the expression '1 - (mu' is wrong"},
      {head + k_variable + "[[limit_state]]\nname = \"mu\"\nexpression = \"1 - mu\"\n", "the name is taken"},
      {head + k_variable + "[[limit_state]]\nname = \"sin\"\nexpression = \"1 - mu\"\n", "is taken by expressions"},
      {"kind = \"sample\"\n[[variable]]\nname = \"x\"\ndistribution = \"normal\"\nmean = 1\n",
       "study.toml:2:1: error: variable 'x': its normal distribution needs 'standard_deviation' or 'cov'"},
      {"kind = \"sample\"\n[[variable]]\nname = \"x\"\ndistribution = \"normal\"\nmean = 1\ncov = 0.1\nmode = 3\n",
       "a normal distribution has no 'mode'"},
      {"kind = \"sample\"\n[[variable]]\nname = \"x\"\ndistribution = \"lognormal\"\nmean = -1\ncov = 0.1\n",
       "the mean of a lognormal distribution must be above its location"},
      {"kind = \"sample\"\n[[variable]]\nname = \"x\"\nvalues = [1, 2]\n", "a list of values is for sweeps"},
      {"kind = \"reliability\"\n[[variable]]\nname = \"x\"\nrange = [1, 2]\n[[limit_state]]\nname = \"g\"\nexpression "
       "= \"x\"\n",
       "how likely its values are is not known"},
      {"kind = \"reliability\"\n[reliability]\nmethods = [\"fourm\"]\n[[variable]]\nname = \"x\"\ndistribution = "
       "\"normal\"\nmean = 1\ncov = 0.1\n[[limit_state]]\nname = \"g\"\nexpression = \"x\"\n",
       "there is no method 'fourm' (did you mean 'form'?)"},
  };
  for (const Mistake& m : mistakes) {
    CAPTURE(m.text);
    const std::string said = complaint(m.text);
    CHECK_MESSAGE(has(said, m.message), said);
  }
}

TEST_CASE("all mistakes of a file are told at once") {
  const std::string said =
      complaint("kind = \"sweep\"\n" + k_model + "[[variable]]\nname = \"a\"\npath = \"body.tnk.mass\"\nvalues = [1]\n" +
                "[[response]]\nname = \"r\"\nchannel = \"nothing\"\nwhat = \"final\"\n");
  CHECK(has(said, "there is no body 'tnk'"));
  CHECK(has(said, "no channel of model"));
}

// A name that is none makes every expression behind it unreadable: that is no second mistake.
TEST_CASE("a wrong name is one mistake") {
  for (const std::string name : {"slid path", "slid-path", "2nd", "sin"}) {
    CAPTURE(name);
    const std::string said = complaint(
        "kind = \"sweep\"\n" + k_model + k_variable + "[[response]]\nname = \"" + name +
        "\"\nchannel = \"front joint.margin\"\nwhat = \"lowest\"\n" +
        "[[limit_state]]\nname = \"g\"\nexpression = \"1 - mu\"\n[[limit_state]]\nname = \"f\"\nexpression = \"" + name + " - 1\"\n");
    CHECK(has(said, "the name of response '" + name + "'"));
    CHECK(said.find("error:") == said.rfind("error:"));
  }
}

namespace {

/// A body that moves freely, the signal "push" with its value, and what takes "use".
std::string scene_of(const std::string& push, const std::string& use, const std::string& element) {
  return "gravity = [0, 0]\n[simulation]\nend = 0.1\n[[body]]\nname = \"box\"\nmass = 1\ninertia = 1\n[[signal]]\nname = \"push\"\n" +
         push + "\n" + use + "[[element]]\nname = \"user\"\n" + element + "\n";
}

bool is_accepted(const std::function<void()>& read) {
  try {
    read();
    return true;
  } catch (const ModelError&) {
    return false;
  }
}

} // namespace

TEST_CASE("a study takes a signal's value in the units that an override takes it in, and in no other") {
  struct Taker {
    const char *element, *fits; ///< "": only numbers and angles fit
  };
  const Taker takers[] = {
      {"kind = \"prescribed_motion\"\na = \"box\"\ncoordinate = \"x\"\nas = \"acceleration\"\nsignal = \"use\"", "m/s^2"},
      {"kind = \"prescribed_motion\"\na = \"box\"\ncoordinate = \"x\"\nas = \"velocity\"\nsignal = \"use\"", "m/s"},
      {"kind = \"prescribed_motion\"\na = \"box\"\ncoordinate = \"angle\"\nas = \"velocity\"\nsignal = \"use\"", "rad/s"},
      {"kind = \"motor\"\na = \"box\"\ncoordinate = \"x\"\ntarget = \"use\"\nproportional = 1", "m"},
      {"kind = \"load\"\nat = \"box\"\nforce_x = \"use\"", "N"},
      {"kind = \"load\"\nat = \"box\"\ntorque = \"use\"", "N m"},
      {"kind = \"motor\"\na = \"box\"\ncoordinate = \"angle\"\ntarget = \"use\"\nproportional = 1", "rad"},
      {"kind = \"joint_friction\"\na = \"box\"\ncoordinate = \"x\"\nholds = 1\nsignal = \"use\"", ""}};
  const std::string constant = "kind = \"constant\"\nvalue = 1", zero = "[[signal]]\nname = \"other\"\nkind = \"constant\"\nvalue = 0\n",
                    use = "[[signal]]\nname = \"use\"\n";
  struct Way {
    std::string use;
    bool is_in_its_unit; ///< the values of "push" are those of "use"
  };
  const Way ways[] = {{use + "kind = \"sum\"\nsignals = [\"push\", \"other\"]\n" + zero, true},
                      {use + "kind = \"sum\"\nsignals = [\"push\"]\nfactors = [2]\n", false},
                      {use + "kind = \"scaled\"\nsignal = \"push\"\ndelay = 0.0\n", true},
                      {use + "kind = \"scaled\"\nsignal = \"push\"\nfactor = 1\n", true},
                      {use + "kind = \"scaled\"\nsignal = \"push\"\nfactor = 3.0\n", false},
                      {use + "kind = \"product\"\nsignals = [\"push\", \"other\"]\n" + zero, false},
                      {use + constant + "\n", false}}; // "push" is not used
  struct Kind {
    const char *push, *path;
  };
  const Kind kinds[] = {{"kind = \"sine\"\namplitude = 1\nfrequency = 1", "amplitude"},
                        {"kind = \"half_sine\"\npeak = 1\nduration = 1", "peak"},
                        {"kind = \"trapezoid\"\npeak = 1\nrise = 0.1\nfall = 0.1\nhold = 1", "peak"},
                        {"kind = \"harmonics\"\namplitudes = [1]\nfrequencies = [1]", "amplitudes.0"},
                        {"kind = \"harmonics\"\namplitudes = [1]\nfrequencies = [1]\noffset = 1", "offset"},
                        {"kind = \"chirp\"\namplitude = 1\nfrom = 1\nto = 2\nduration = 1", "amplitude"},
                        {"kind = \"random\"\nfactor = 1\nfrequencies = [1, 2]\ndensities = [1, 1]\nduration = 1", "factor"}};
  const std::vector<std::string> units{"m/s^2", "gravity", "m/s",   "km/h", "m",   "mm", "N", "kN",
                                       "N m",   "kN m",    "rad/s", "rad",  "deg", "Hz", "kg"};
  const StudyBench bench;
  long fitting = 0;
  const auto check = [&](const std::string& scene, const std::string& path, const std::string& fits, bool is_known) {
    const std::string model = bench.write("model.toml", scene);
    CAPTURE(scene);
    CAPTURE(path);
    REQUIRE_NOTHROW((void)study::read_study_model(model));
    const auto override_takes = [&](const std::string& value) {
      return is_accepted([&] { (void)study::read_study_model(model, {path + "=" + value}); });
    };
    const auto study_takes = [&](const std::string& value) {
      return is_accepted([&] {
        (void)study::parse_study("kind = \"sweep\"\nmodel = \"model.toml\"\n[[variable]]\nname = \"x\"\npath = \"" + path +
                                     "\"\nvalues = [" + value + "]\n[[response]]\nname = \"y\"\nchannel = \"box.x\"\nwhat = \"final\"\n",
                                 bench.at("study.toml"));
      });
    };
    CHECK(override_takes("2"));
    CHECK(study_takes("2"));
    for (const std::string& unit : units) {
      CAPTURE(unit);
      const bool is_taken = override_takes("2 " + unit);
      CHECK(study_takes("\"2 " + unit + "\"") == is_taken);
      if (!is_known) CHECK(is_taken);
      fitting += is_known && is_taken;
      if (is_known && unit == fits) CHECK(is_taken);
      if (is_known && unit == "kg") CHECK_FALSE(is_taken); // nothing takes masses
    }
  };
  for (const Taker& taker : takers) {
    const std::string direct = scene_of(constant, zero, taker.element);
    std::string named = direct;
    for (std::size_t at = named.find("\"use\""); at != std::string::npos; at = named.find("\"use\"")) named.replace(at, 5, "\"push\"");
    check(named, "signal.push.value", taker.fits, true);
    for (const Way& way : ways) check(scene_of(constant, way.use, taker.element), "signal.push.value", taker.fits, way.is_in_its_unit);
  }
  for (const Kind& kind : kinds)
    check(scene_of(kind.push, use + "kind = \"sum\"\nsignals = [\"push\"]\n", takers[0].element), std::string("signal.push.") + kind.path,
          "m/s^2", true);
  CHECK(fitting > 40);
}

TEST_CASE("the examples are read without a complaint") {
  int studies = 0;
  for (const auto& entry : fs::directory_iterator(STEPLAP_MODELS "/studies")) {
    if (entry.path().extension() != ".toml") continue;
    const std::string text = text_of(entry.path()), head = text.substr(0, text.find("\n[")); // models have kinds in their tables
    if (!has(head, "kind = \"") && !has(head, "extends = \"slip_probability")) continue;
    CAPTURE(entry.path().string());
    CHECK_NOTHROW((void)study::read_study(entry.path().string()));
    ++studies;
  }
  CHECK(studies >= 9);
}

// A monitored joint's motion does not hang on its pressure, and its capacity is proportional to it: the critical
// pressure is the pressure over the margin, at any pressure.
TEST_CASE("the critical clamping pressure of the paper's transformer") {
  StudyBench bench;
  const Outcome outcome = study_does({"run", STEPLAP_MODELS "/studies/critical_pressure.toml", "-o", bench.at("study.sqlite")});
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  study::Store store(bench.at("study.sqlite"));
  std::vector<study::StoredSample> rows;
  store.read(9, 1, rows); // the last of the first looks
  CHECK(rows[0].values[0] == doctest::Approx(1e5));
  // The tolerance of the study is 1e-6 of the range, that of extremes 1e-6 of the channel's.
  CHECK(store.findings().front().value == doctest::Approx(1e5 / rows[0].outcome.numbers[0]).epsilon(1e-5));
}

TEST_CASE("the schema knows the tables, keys and kinds") {
  const nlohmann::json schema = nlohmann::json::parse(study_does({"schema"}).out);
  const auto& kinds = schema["properties"]["kind"]["enum"];
  CHECK(std::find(kinds.begin(), kinds.end(), "reliability") != kinds.end());
  CHECK(schema["properties"]["variable"]["items"]["properties"].contains("distribution"));
  CHECK(schema["additionalProperties"].contains("const")); // no other keys
}

TEST_CASE("a study that is no file is refused, and not waited for") {
  const StudyBench bench;
  const std::string fifo = bench.at("fifo"), store = bench.at("other.sqlite");
  REQUIRE(mkfifo(fifo.c_str(), 0600) == 0);
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  for (const std::string& path : {std::string("/dev/zero"), fifo, bench.at(""), "/dev/fd/" + std::to_string(ends[0])}) {
    CAPTURE(path);
    const Outcome outcome = study_does({"run", path, "-o", store});
    CHECK(outcome.code == 3);
    CHECK(has(outcome.err, "cannot read the study: it is no file"));
    CHECK(study_does({"show", path, "-o", store}).code == 2);
    CHECK(study_does({"show", path}).code == 2); // of what it is called a store
  }
  for (const int end : ends) close(end);
  CHECK(study_does({"run", bench.at("none.toml"), "-o", store}).code == 3);
  CHECK_FALSE(fs::exists(store));
}
