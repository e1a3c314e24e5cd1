// The page of a study: bands and digits against what theory says of them, every kind's findings with their units,
// thinning that is told, the same bytes for the same store.
#include "tests/tools/study/study_bench.h"
#include "tools/study/counter_random.h"
#include "tools/study/program/progress_line.h"
#include "tools/study/report_data.h"
#include "tools/study/report_findings.h"
#include "tools/study/report_tally.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <numeric>

using namespace steplap;
using namespace steplap::testing;
using Json = nlohmann::ordered_json;

namespace {

const std::string k_sample = R"(title = "<script>bad()</script>"
kind = "sample"
[sample]
samples = 400
[[variable]]
name = "force"
distribution = "normal"
mean = "30 kN"
standard_deviation = "5 kN"
unit = "N"
[[variable]]
name = "share"
distribution = "uniform"
low = 0
high = 1
[[response]]
name = "load"
expression = "share > 0.98 ? sqrt(-1) : force*share"
[[limit_state]]
name = "strength"
expression = "27000 - load"
)";

Json data_of(const std::string& store_path, std::size_t budget = 6000000) {
  study::Store store(store_path);
  return Json::parse(study::report_data(store, store_path, budget));
}

} // namespace

TEST_CASE("the band of a distribution is Dvoretzky, Kiefer and Wolfowitz's, widened by what is not known") {
  // 200 values, 20 of them missing: half of the band's width is sqrt(ln 40 / 400).
  std::vector<double> values;
  for (int i = 0; i < 180; ++i) values.push_back(i);
  values.resize(200, std::nan(""));
  const study::Tally t = study::tally_of(values, true);
  const double half = std::sqrt(std::log(40.0) / 400.0);
  CHECK(t.total == 200);
  CHECK(t.missing == 20);
  REQUIRE(t.cumulative.x.size() == 180);
  CHECK(t.cumulative.p[89] == doctest::Approx(0.5).epsilon(1e-12)); // of those with a value
  CHECK(t.cumulative.low[89] == doctest::Approx(90.0 / 200.0 - half).epsilon(1e-12));
  CHECK(t.cumulative.high[89] == doctest::Approx(110.0 / 200.0 + half).epsilon(1e-12));
  CHECK(std::accumulate(t.histogram.counts.begin(), t.histogram.counts.end(), 0L) == 180);
}

// Massart's constant makes 95 % a lower bound; of 300 repetitions at 95 % at least 273 hold with probability 0.999
// (binomial: 285 ± 3.8, four of these below).
TEST_CASE("the whole distribution lies within its band nearly always") {
  const study::CounterRandom random(7, 1);
  int held = 0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    std::vector<double> values;
    for (std::uint32_t i = 0; i < 100; ++i) values.push_back(random.uniform(k, i));
    const study::Tally t = study::tally_of(values, true, 1000);
    bool is_within = true; // F(x) = x; the band is a step: just below a value its bounds are those of the value before
    for (std::size_t i = 0; i < t.cumulative.x.size(); ++i) {
      const double x = t.cumulative.x[i], before = i ? t.cumulative.high[i - 1] : t.cumulative.high[0] - 0.01;
      is_within = is_within && x >= t.cumulative.low[i] && x <= before;
    }
    held += is_within;
  }
  CAPTURE(held);
  CHECK(held >= 269);
}

TEST_CASE("infinite values count, none has a place on the axis") {
  const double infinity = std::numeric_limits<double>::infinity();
  const study::Tally t = study::tally_of({1.0, 2.0, infinity, -infinity}, false);
  CHECK(t.above == 1);
  CHECK(t.below == 1);
  REQUIRE(t.cumulative.p.size() == 2);
  CHECK(t.cumulative.p[0] == 0.5);
  CHECK(t.cumulative.p[1] == 0.75); // the rest is at infinity
  CHECK(t.cumulative.low.empty());  // not drawn independently
  CHECK(study::tally_of({}, true).cumulative.x.empty());
  CHECK(study::tally_of({3.0, 3.0, 3.0}, true).histogram.counts == std::vector<long>{3});
}

TEST_CASE("how a share of failures settled, with runs without result on both sides") {
  std::vector<char> sure(1000, 0), possible(1000, 0);
  for (std::size_t i = 0; i < 1000; i += 10) sure[i] = possible[i] = 1; // 100 failures
  for (std::size_t i = 5; i < 1000; i += 20) possible[i] = 1;           // 50 that may be
  const study::Running r = study::running_share(sure, possible);
  CHECK(r.samples.back() == 1000.0);
  CHECK(r.low.back() == study::proportion_interval(100, 1000, 0.95).low);
  CHECK(r.high.back() == study::proportion_interval(150, 1000, 0.95).high);
  CHECK(r.samples.size() < 150);
  const study::Running mean = study::running_mean({1.0, 2.0, 3.0});
  CHECK(mean.value.back() == 2.0);
  CHECK(mean.high.back() - 2.0 == doctest::Approx(4.302652729911275 / std::sqrt(3.0)).epsilon(1e-9)); // Student's, 2 degrees
}

TEST_CASE("two digits of an interval's width are written, none that is not known") {
  CHECK(study::estimate_text(1.8273e-4, 1.5e-4, 2.2e-4, 6) == "1.83e-4");
  CHECK(study::estimate_text(0.5, 0.2, 0.8, 6) == "0.50");
  CHECK(study::estimate_text(29.9853751, 29.9853520, 29.9853752, 6) == "29.985375");
  CHECK(study::estimate_text(299834.0, 296200.0, 303400.0, 6) == "299800");
  CHECK(study::estimate_text(-0.02, -0.08, 0.04, 6) == "-0.02");
  CHECK(study::estimate_text(3.1415926535, std::nan(""), std::nan(""), 4) == "3.142");
  CHECK(study::estimate_text(0.000199, std::nan(""), std::nan(""), 4) == "1.99e-4");
  CHECK(study::estimate_text(1e-4, std::nan(""), std::nan(""), 4) == "1e-4");
  CHECK(study::estimate_text(-1e-9, -0.4, 0.4, 4) == "0.00");
  CHECK(study::estimate_text(2.5, 1.2, std::nan(""), 6) == "2.5"); // half of an interval counts as one
  CHECK(study::estimate_text(std::nan(""), 0.0, 1.0, 6).empty());
}

TEST_CASE("the quantity of a finding says its part and its unit") {
  const std::vector<study::ReportColumn> columns{{"pressure", "Pa", "variable"},
                                                 {"mu", "", "variable"},
                                                 {"slide", "m", "response"},
                                                 {"margin", "", "response"},
                                                 {"record", "m", "history"}};
  const auto view = [&](const study::Finding& f) { return study::view_of(f, columns); };
  const study::FindingView mean = view({"monte_carlo", "slide", "mean", 0.0123456, 0.0121, 0.0125});
  CHECK(mean.value == "12.35");
  CHECK(mean.interval == "12.10 … 12.50");
  CHECK(mean.unit == "mm");
  const study::FindingView critical = view({"critical", "pressure", "critical value", 29985.375, 29985.352, 29985.375});
  CHECK(critical.unit == "kPa");
  CHECK(critical.value == "29.985375");
  CHECK(view({"elasticity", "slide", "derivative by pressure", 2.0}).unit == "m/Pa");
  CHECK(view({"elasticity", "slide", "elasticity to pressure", 2.0}).variable == "pressure");
  CHECK(view({"form", "design point 2", "pressure", 66506.0}).unit == "kPa");
  CHECK(view({"form", "design point 2", "pressure", 66506.0}).place == 2);
  CHECK(view({"map", "border 3 point 17", "pressure", 66506.0}).place == 3);
  CHECK(view({"design", "value 1", "pressure", 66506.0}).role == "value");
  CHECK(view({"design", "value 1", "margin", 0.1}).role == "margin"); // which is a response here, too, but no coordinate
  CHECK(view({"fit", "pressure", "value", 29985.0, 29000.0, 31000.0}).value == "30.0");
  CHECK(view({"fit", "pressure, mu", "correlation", 0.91234}).value == "0.912");
  CHECK(view({"fit", "record", "residual, root mean square", 0.00123456}).value == "1.235"); // mm
  CHECK(view({"fit", "pressure", "skewness", 2.0}).unit == "SI"); // of which nothing is known is not given the subject's
}

TEST_CASE("findings of every kind have a part to play") {
  const std::string variables = "[[variable]]\nname = \"a\"\nRANGE\n[[variable]]\nname = "
                                "\"b\"\nRANGE\n[[response]]\nname = \"r\"\nexpression = \"a*b + a\"\n";
  const auto text = [&](const std::string& head, const std::string& range) {
    std::string whole = head + variables;
    for (std::size_t at; (at = whole.find("RANGE")) != std::string::npos;) whole.replace(at, 5, range);
    return whole;
  };
  const std::string normal = "distribution = \"normal\"\nmean = 1\nstandard_deviation = 0.3", range = "range = [0.5, 2]";
  const std::string studies[] = {text("kind = \"sweep\"\n[sweep]\npoints = 3\n", range),
                                 text("kind = \"sample\"\n[sample]\nsamples = 50\n", normal) +
                                     "[[limit_state]]\nname = \"g\"\nexpression = \"3 - r\"\n",
                                 text("kind = \"sensitivity\"\n[sensitivity]\nmethod = \"elasticity\"\n", range),
                                 text("kind = \"sensitivity\"\n[sensitivity]\nmethod = \"morris\"\n", range),
                                 text("kind = \"sensitivity\"\n[sensitivity]\nmethod = \"sobol\"\nsamples = 50\n", range),
                                 text("kind = \"sensitivity\"\n[sensitivity]\nmethod = \"tornado\"\n", range),
                                 text("kind = \"critical\"\n[critical]\nvariable = \"a\"\nexpression = \"r - 2\"\n", range),
                                 text("kind = \"map\"\n[map]\nvariables = [\"a\", \"b\"]\nexpression = \"r - 2\"\nstep = 0.2\n", range),
                                 text("kind = \"reliability\"\n[reliability]\nmethods = [\"form\", \"sorm\", \"importance_sampling\", "
                                      "\"subset\", \"monte_carlo\", \"kriging\"]\nsamples = 2000\nsubset_samples = 500\n",
                                      normal) +
                                     "[[limit_state]]\nname = \"g\"\nexpression = \"4 - r\"\n"};
  for (const std::string& one : studies) {
    CAPTURE(one);
    StudyBench bench;
    const Outcome outcome = bench.run(one);
    CAPTURE(outcome.err);
    REQUIRE(outcome.err.empty());
    const Json data = data_of(bench.at("study.sqlite"));
    CHECK(!data["findings"].empty());
    for (const Json& f : data["findings"]) {
      CAPTURE(f.dump());
      CHECK(f["role"] != "estimate");
      CHECK(f["unit"] != "SI");
    }
  }
}

TEST_CASE("the page of a study: all of it from the store, the same bytes, markup stays text") {
  StudyBench bench;
  const Outcome run = bench.run(k_sample, {"--report", "--threads", "1"});
  CAPTURE(run.err);
  REQUIRE(run.code == 5); // some of its samples have no result
  const std::string page = text_of(bench.at("study.html"));
  CHECK(has(run.out, "Page: " + bench.at("study.html")));
  CHECK(!has(page, "<script>bad()"));
  CHECK(has(page, "Plotly Technologies")); // the licence goes with it
  SUBCASE("from the store alone, where the study file is gone") {
    fs::remove(bench.at("study.toml"));
    REQUIRE(study_does({"report", bench.at("study.sqlite"), "-o", bench.at("other.html")}).code == 0);
    CHECK(text_of(bench.at("other.html")) == page);
  }
  SUBCASE("run again by other threads") {
    (void)bench.run(k_sample, {"--report", "--threads", "3", "--restart"});
    CHECK(text_of(bench.at("study.html")) == page);
  }
  SUBCASE("an earlier page is not overwritten without being told to") {
    CHECK(study_does({"report", bench.at("study.sqlite")}).code == 2);
    CHECK(study_does({"report", bench.at("study.sqlite"), "-f"}).code == 0);
  }
  SUBCASE("units, failures, runs without result, all counted") {
    const Json data = data_of(bench.at("study.sqlite"));
    CHECK(data["samples"]["columns"][0]["unit"] == "kN");
    CHECK(data["samples"]["columns"][0]["factor"] == 1e-3);
    const long bad = data["reasons"]["failed"], failures = data["samples"]["classes"][1]["all"],
               others = data["samples"]["classes"][0]["all"];
    CHECK(bad > 0);
    CHECK(data["samples"]["classes"][2]["all"] == bad);
    CHECK(failures + others + bad == 400);
    CHECK(bench.find("monte_carlo", "share of failures, runs without result as unsafe").value ==
          doctest::Approx(static_cast<double>(failures + bad) / 400.0).epsilon(1e-12));
    CHECK(data["running"][0]["value"].back() == doctest::Approx(static_cast<double>(failures + bad) / 400.0).epsilon(1e-12));
    CHECK(data["distributions"]["of"].size() == 4);
    CHECK(data["distributions"]["of"][2]["missing"] == bad);
  }
  SUBCASE("what does not fit is thinned, and told") {
    const Json data = data_of(bench.at("study.sqlite"), 6000);
    long shown = 0;
    for (const Json& c : data["samples"]["classes"]) {
      shown += c["shown"].get<long>();
      CHECK(c["shown"] <= c["all"]);
    }
    CHECK(shown < 400);
    CHECK(data["samples"]["total"] == 400);
    CHECK(data["samples"]["classes"][2]["shown"] == data["samples"]["classes"][2]["all"]); // rare ones are kept
    CHECK(data["distributions"]["of"][0]["total"] == 400);                                 // of all, however many are shown
  }
}

TEST_CASE("the table of variables has the unit and the meaning of each column of the samples") {
  StudyBench bench;
  (void)bench.run(k_sample);
  const std::string table = study_does({"export", bench.at("study.sqlite"), "--variables"}).out;
  CHECK(table.starts_with("name,role,unit,is\nforce,variable,N,\"normal, mean 30000 N, standard deviation 5000 N\"\n"));
  std::string names;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) names += "," + line.substr(0, line.find(','));
  CHECK(has(bench.samples(), "evaluations" + names.substr(std::string(",name").size()) + "\n"));
}

TEST_CASE("of more samples than fit rare kinds are kept, all evenly") {
  std::vector<char> classes(100000, 0);
  for (std::size_t i = 0; i < 20; ++i) classes[i * 5000 + 7] = 2;
  for (std::size_t i = 0; i < 2000; ++i) classes[i * 50 + 3] = classes[i * 50 + 3] == 2 ? 2 : 1;
  const std::vector<std::size_t> chosen = study::chosen_samples(classes, 900);
  CHECK(chosen.size() == 900);
  CHECK(std::is_sorted(chosen.begin(), chosen.end()));
  CHECK(std::adjacent_find(chosen.begin(), chosen.end()) == chosen.end());
  long of[3] = {0, 0, 0}, early = 0;
  for (const std::size_t i : chosen) {
    ++of[static_cast<std::size_t>(classes[i])];
    early += i < 50000;
  }
  CHECK(of[2] == 20);
  CHECK(of[1] == 300);
  CHECK(of[0] == 580);
  CHECK(std::abs(early - 450) <= 3); // one of each kind
  CHECK(study::chosen_samples(classes, 200000).size() == 100000);
}

TEST_CASE("a store of before units were kept makes a page that says so little, and goes on") {
  StudyBench bench;
  (void)bench.run(k_sample);
  study::Store(bench.at("study.sqlite"), study::Store(bench.at("study.sqlite")).identity(), study::StoreMode::run).describe("");
  const Json data = data_of(bench.at("study.sqlite"));
  CHECK(data["about"]["variables"].empty());
  CHECK(data["samples"]["columns"][0]["unit"] == "");
  (void)bench.run(k_sample);
  CHECK(data_of(bench.at("study.sqlite"))["samples"]["columns"][0]["unit"] == "kN");
}

TEST_CASE("a study that has changed has no answer until it has run again") {
  StudyBench bench;
  (void)bench.run(k_sample);
  CHECK(data_of(bench.at("study.sqlite"))["standing"] == "not met"); // samples without result
  std::string more = k_sample;
  more.replace(more.find("samples = 400"), 13, "samples = 500");
  const study::LoadedStudy loaded = study::parse_study(more, "study.toml");
  (void)study::Store(bench.at("study.sqlite"), study::identity_of(loaded), study::StoreMode::changed); // and killed
  const Json data = data_of(bench.at("study.sqlite"));
  CHECK(data["standing"] == "");
  CHECK(data["findings"].empty());
  CHECK(data["samples"]["total"] == 400); // the samples are kept
}

TEST_CASE("the unit of a variable without a path is one, or an error") {
  StudyBench bench;
  CHECK(bench.run(k_sample).code == 5); // all but the samples without result
  std::string wrong = k_sample;
  wrong.replace(wrong.find("unit = \"N\""), 10, "unit = \"Nn\"");
  const Outcome outcome = StudyBench().run(wrong);
  CHECK(outcome.code == 3);
  CHECK(has(outcome.err, "'Nn' is not a unit"));
}

TEST_CASE("progress tells samples, rate, time left and the running estimate") {
  study::Pace pace{3200, 0, 8.0, 400.0, "monte_carlo: probability 0.002 [0.001, 0.004]", 12000, true};
  CHECK(study::progress_text(pace) == "3200 of about 12000 samples, 400 a second, 8 s gone, about 22 s left of this "
                                      "method; monte_carlo: probability 0.002 [0.001, 0.004]");
  pace = {100, 100, 1.0, 0.0, "", 0, false};
  CHECK(study::progress_text(pace) == "100 samples, 1 s gone, 100 from the store");
  pace = {10, 0, 1.0, 0.01, "", 1000, false};
  CHECK(study::progress_text(pace) == "10 of 1000 samples, 0.01 a second, 1 s gone, about 27.5 h left");
  StudyBench bench;
  std::vector<study::Pace> seen;
  const study::Ranks ranks;
  const study::LoadedStudy loaded = study::parse_study(k_sample, "study.toml");
  study::Store store(bench.at("study.sqlite"), study::identity_of(loaded), study::StoreMode::run);
  study::Evaluator evaluator(loaded, store, ranks, 1, [&](const study::Pace& p) { seen.push_back(p); });
  evaluator.expect(2);
  (void)evaluator.evaluate({3e4, 0.5});
  CHECK(seen.back().expected == 2);
  evaluator.expect(3, true);
  (void)evaluator.evaluate({3e4, 0.5});
  CHECK(seen.back().expected == 4);
  CHECK(seen.back().samples == 2);
}
