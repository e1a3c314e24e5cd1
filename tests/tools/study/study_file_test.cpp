// Study files: every mistake is told with its line before anything runs.
#include "tests/tools/study/study_bench.h"
#include "tools/study/study_reader.h"

#include <nlohmann/json.hpp>

#include <sys/stat.h>
#include <unistd.h>

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
