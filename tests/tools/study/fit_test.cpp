// Fits of a block that slides under a pulse: the path it slides is known in closed form at every instant.
#include "tests/tools/study/block_scene.h"
#include "tests/tools/study/study_bench.h"
#include "tools/study/counter_random.h"
#include "tools/study/least_squares.h"

#include <Eigen/Dense>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_mu = 0.3, k_peak = 5.886, k_duration = 0.1;

// The block's coordinate on the deck, which moves away from under it: first at A − mu g, then slowed by mu g until both
// move alike.
double slide_at(double t) {
  const double since = t - 0.01, brake = k_mu * k_g, rate = k_peak - brake;
  if (since <= 0.0) return 0.0;
  if (since <= k_duration) return -0.5 * rate * since * since;
  const double speed = rate * k_duration, more = std::min(since - k_duration, speed / brake);
  return -(0.5 * rate * k_duration * k_duration + speed * more - 0.5 * brake * more * more);
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

// `count` values, every 2 ms unless the times are told; noise in m.
std::string record(
    double noise, std::uint64_t seed, int count = 150, double (*time)(int) = [](int i) { return 0.002 * i; }) {
  const study::CounterRandom random(seed, 77);
  std::string text = "t,slide\n";
  for (int i = 1; i <= count; ++i)
    text += number(time(i)) + "," + number(slide_at(time(i)) + noise * random.normal(static_cast<std::uint64_t>(i), 0)) + "\n";
  return text;
}

std::string block() {
  std::string text = k_block;
  text.replace(text.find("end = 1.0"), 9, "end = 0.3");
  text.replace(text.find("1e-10"), 5, "1e-8");
  return text;
}

const std::string k_fit = "kind = \"fit\"\nmodel = \"block.toml\"\n";
const std::string k_history = "[[history]]\nname = \"way\"\nchannel = \"deck friction.slide\"\nfile = \"record.csv\"\n";
const std::string k_mu_variable = "[[variable]]\nname = \"mu\"\npath = \"element.deck friction.static_friction\"\nrange = [0.1, 0.8]\n";
const std::string k_peak_variable = "[[variable]]\nname = \"peak\"\npath = \"signal.push.peak\"\nrange = [2, 15]\n";
const std::string k_duration_variable = "[[variable]]\nname = \"duration\"\npath = \"signal.push.duration\"\nrange = [0.02, 0.25]\n";
const std::string k_variables = k_mu_variable + k_peak_variable + k_duration_variable;
const std::string k_few = "[fit]\nstarts = 2\n";

} // namespace

TEST_CASE("least squares of a straight line: values and covariance of the closed form") {
  // y = 1 + 2 x at x = 0 … 9 with residuals that are known; parameters as shares of [0, 4].
  const double noise[] = {0.1, -0.2, 0.05, 0.15, -0.1, 0.0, 0.2, -0.15, 0.1, -0.15};
  study::LeastSquaresProblem problem;
  problem.residuals = [&](const std::vector<Eigen::VectorXd>& points) {
    std::vector<Eigen::VectorXd> rows;
    for (const auto& z : points) {
      rows.emplace_back(10);
      for (int i = 0; i < 10; ++i) rows.back()[i] = 4.0 * z[0] + 4.0 * z[1] * i - (1.0 + 2.0 * i + noise[i]);
    }
    return rows;
  };
  problem.step = Eigen::VectorXd::Constant(2, 1e-3);
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(2, 0.9);
  const study::LeastSquaresMinimum m = study::minimise(problem, start, problem.residuals({start}).front());
  CHECK(m.problem.empty());
  double mean_y = 0.0, slope = 0.0; // slope = Σ (x − x̄) y / Σ (x − x̄)², x̄ = 4.5, Σ (x − x̄)² = 82.5
  for (int i = 0; i < 10; ++i) mean_y += (1.0 + 2.0 * i + noise[i]) / 10.0, slope += (i - 4.5) * (1.0 + 2.0 * i + noise[i]) / 82.5;
  CHECK(4.0 * m.at[1] == doctest::Approx(slope).epsilon(1e-6)); // the search ends a ten-thousandth of a deviation off
  CHECK(4.0 * m.at[0] == doctest::Approx(mean_y - 4.5 * slope).epsilon(1e-4));
  const study::Identified told = study::identify(m, 0.01);
  CHECK(told.rank == 2);
  CHECK(16.0 * told.covariance(1, 1) == doctest::Approx(0.01 / 82.5).epsilon(1e-9));
  CHECK(16.0 * told.covariance(0, 0) == doctest::Approx(0.01 * (0.1 + 4.5 * 4.5 / 82.5)).epsilon(1e-9));
  CHECK(16.0 * told.covariance(0, 1) == doctest::Approx(-0.01 * 4.5 / 82.5).epsilon(1e-9));
}

TEST_CASE("least squares in a curved valley, and at the end of a range") {
  study::LeastSquaresProblem problem; // Rosenbrock's
  problem.residuals = [](const std::vector<Eigen::VectorXd>& points) {
    std::vector<Eigen::VectorXd> rows;
    for (const auto& z : points) {
      const double x = 4.0 * z[0] - 2.0, y = 4.0 * z[1] - 1.0;
      rows.push_back(Eigen::Vector3d(10.0 * (y - x * x), 1.0 - x, 0.0));
    }
    return rows;
  };
  problem.step = Eigen::VectorXd::Constant(2, 1e-4);
  problem.floor = 1e-20;
  const Eigen::VectorXd start = Eigen::Vector2d(0.2, 0.5); // x = −1.2, y = 1: where others begin too
  const study::LeastSquaresMinimum m = study::minimise(problem, start, problem.residuals({start}).front());
  CHECK(4.0 * m.at[0] - 2.0 == doctest::Approx(1.0).epsilon(1e-6));
  CHECK(4.0 * m.at[1] - 1.0 == doctest::Approx(1.0).epsilon(1e-6));

  problem.residuals = [](const std::vector<Eigen::VectorXd>& points) {
    std::vector<Eigen::VectorXd> rows;
    for (const auto& z : points) rows.push_back(Eigen::Vector3d(z[0] - 1.5, z[1] - 0.25, z[0] - 1.4)); // z[0] would be 1.45
    return rows;
  };
  const study::LeastSquaresMinimum end = study::minimise(problem, start, problem.residuals({start}).front());
  CHECK(end.at[0] == 1.0);
  CHECK(end.at[1] == doctest::Approx(0.25));
  CHECK(end.is_at_end[0]);
  CHECK_FALSE(end.is_at_end[1]);
}

TEST_CASE("a fit to an exact record finds friction and pulse") {
  StudyBench bench;
  bench.write("block.toml", block());
  bench.write("record.csv", record(0.0, 1));
  const Outcome outcome = bench.run(k_fit + k_history + k_variables);
  CAPTURE(outcome.err);
  CAPTURE(outcome.out);
  REQUIRE(outcome.code == 0);
  // The runs are known to 1e-8 of 29 mm; what the record tells least of is ten times less well known.
  CHECK(bench.find("fit", "value", "mu").value == doctest::Approx(k_mu).epsilon(1e-6));
  CHECK(bench.find("fit", "value", "peak").value == doctest::Approx(k_peak).epsilon(1e-6));
  CHECK(bench.find("fit", "value", "duration").value == doctest::Approx(k_duration).epsilon(1e-6));
}

// A mass of 10 kg on a spring of 1 kN/m swings at 1.59 Hz and is read four times a second: many stiffnesses between 0.2 and 5 kN/m fit some of
// the readings, in valleys of their own. The units stand in the header only.
TEST_CASE("a fit finds the deepest of many valleys, and reads units in the header") {
  const double k = 1000.0, c = 5.0, m = 10.0, decay = c / (2.0 * m), omega = std::sqrt(k / m - decay * decay);
  std::string readings = "t [ms],x [cm]\n";
  for (int i = 0; i < 8; ++i) {
    const double t = 0.25 * i, x = 0.1 * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
    readings += number(1e3 * t) + "," + number(100.0 * x) + "\n";
  }
  StudyBench bench;
  bench.write("swing.toml", "format = 1\n[simulation]\nend = 2.0\ntolerance = 1e-8\n[[body]]\nname = \"m\"\nmass = 10.0\ninertia = 1.0\n"
                            "position = [0.1, 0.0]\n[[element]]\nkind = \"prismatic\"\nname = \"g\"\na = \"m\"\naxis = [1.0, 0.0]\n"
                            "[[element]]\nkind = \"spring_damper\"\nname = \"s\"\na = \"m\"\nb = { body = \"ground\", at = [-1.0, 0.0] }\n"
                            "stiffness = 1500.0\ndamping = 8.0\nfree_length = 1.0\n");
  bench.write("readings.csv", readings);
  const std::string history = "kind = \"fit\"\nmodel = \"swing.toml\"\n[[history]]\nname = \"way\"\nchannel = \"m.x\"\n"
                              "file = \"readings.csv\"\n";
  const std::string variables = "[[variable]]\nname = \"k\"\npath = \"element.s.stiffness\"\nrange = [200.0, 5000.0]\n"
                                "[[variable]]\nname = \"c\"\npath = \"element.s.damping\"\nrange = [0.5, 50.0]\n";
  const Outcome outcome = bench.run(history + variables);
  CAPTURE(outcome.out);
  REQUIRE(outcome.code == 0);
  CHECK(bench.find("fit", "value", "k").value == doctest::Approx(k).epsilon(1e-4)); // the runs are known to 1e-8 of 0.1 m
  CHECK(bench.find("fit", "value", "c").value == doctest::Approx(c).epsilon(1e-2));
  CHECK(bench.run(history + "unit = \"mm\"\n" + variables).code != 0); // and the header says cm
}

// The squared distance of what was found from what is true, by the stated covariance, is χ² of three degrees of freedom
// in each repetition: of 24 in eight. Too narrow intervals make it large, too wide ones small. (100 repetitions:
// fit_repeatedly.)
TEST_CASE("intervals of a fit are as wide as its errors") {
  const Eigen::Vector3d truth(k_mu, k_peak, k_duration);
  const char* const names[] = {"mu", "peak", "duration"};
  double distance = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    StudyBench bench;
    bench.write("block.toml", block());
    bench.write("record.csv", record(2e-4, seed));
    const Outcome outcome = bench.run(k_fit + k_few + k_history + "noise = \"0.2 mm\"\n" + k_variables);
    CAPTURE(outcome.out);
    REQUIRE(outcome.code == 0);
    Eigen::Vector3d error, deviation;
    Eigen::Matrix3d correlation = Eigen::Matrix3d::Identity();
    for (int i = 0; i < 3; ++i) {
      error[i] = bench.find("fit", "value", names[i]).value - truth[i];
      deviation[i] = bench.find("fit", "standard deviation", names[i]).value;
      for (int j = i + 1; j < 3; ++j)
        correlation(i, j) = correlation(j, i) = bench.find("fit", "correlation", std::string(names[i]) + ", " + names[j]).value;
    }
    const Eigen::Vector3d scaled = error.cwiseQuotient(deviation);
    distance += scaled.dot(correlation.ldlt().solve(scaled));
  }
  CHECK(distance > 9.886);  // 0.5 % of χ²(24)
  CHECK(distance < 45.559); // 99.5 %
}

// As long as the pulse lasts, only A − mu g is seen: what is said to be the same must be 9.81 of one for one of the
// other.
TEST_CASE("parameters that a record cannot tell apart are named, with the combination") {
  StudyBench bench;
  bench.write("block.toml", block());
  bench.write("record.csv", record(2e-4, 3, 50));
  const std::string longer = "[[variable]]\nname = \"duration\"\npath = \"signal.push.duration\"\nrange = [0.1, 0.25]\n";
  const Outcome outcome = bench.run(k_fit + k_few + k_history + k_mu_variable + k_peak_variable + longer);
  CAPTURE(outcome.out);
  CHECK(outcome.code == 5);
  const study::Finding together = bench.find("fit", "not determined", "mu, peak");
  double mu = 0.0, peak = 0.0;
  REQUIRE(std::sscanf(together.status.c_str(),
                      "cannot be distinguished: the record does not change where mu changes by %lf and peak changes by %lf", &mu,
                      &peak) == 2);
  CHECK(peak / mu == doctest::Approx(k_g).epsilon(1e-3)); // printed to four digits
  CHECK(has(bench.find("fit", "not determined", "duration").status, "does not depend on it"));
  CHECK(std::isnan(bench.find("fit", "value", "mu").low)); // no interval is claimed
}

TEST_CASE("a record that the model does not describe is told, and not trusted") {
  StudyBench bench;
  bench.write("block.toml", block());
  SUBCASE("the noise is larger than stated") {
    bench.write("record.csv", record(6e-4, 3));
    CHECK(bench.run(k_fit + k_few + k_history + "noise = \"0.2 mm\"\n" + k_variables).code == 4);
    CHECK(has(bench.find("fit", "residual, root mean square").status, "times the stated noise"));
  }
  SUBCASE("a parameter that matters is held at a wrong value") {
    bench.write("record.csv", record(2e-4, 3));
    const std::string wrong = "[[variable]]\nname = \"duration\"\npath = \"signal.push.duration\"\nvalue = 0.07\n";
    CHECK(bench.run(k_fit + k_few + k_history + k_mu_variable + k_peak_variable + wrong).code == 4);
    CHECK(has(bench.find("fit", "residual, root mean square").status, "residuals are correlated"));
  }
  SUBCASE("the value lies beyond the range") {
    bench.write("record.csv", record(2e-4, 3));
    const std::string low = "[[variable]]\nname = \"mu\"\npath = \"element.deck friction.static_friction\"\nrange = [0.1, 0.25]\n";
    CHECK(bench.run(k_fit + k_few + k_history + low + k_peak_variable + k_duration_variable).code != 0);
    CHECK(has(bench.find("fit", "value", "mu").status, "at the end of its range"));
  }
}

TEST_CASE("times that are no multiples of one step are compared as well") {
  StudyBench bench;
  bench.write("block.toml", block());
  bench.write("record.csv", record(0.0, 1, 100, [](int i) { return 0.0029 * i + 0.0004 * std::sin(i); }));
  const Outcome outcome = bench.run(k_fit + k_few + k_history + "noise = \"0.2 mm\"\n" + k_variables);
  CAPTURE(outcome.out);
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "interpolated between samples"));
  // Straight lines of a quarter of a millisecond are off by 2e-8 m: a ten-thousandth of the noise.
  CHECK(bench.find("fit", "value", "mu").value == doctest::Approx(k_mu).epsilon(1e-4));
  CHECK(bench.find("fit", "value", "duration").value == doctest::Approx(k_duration).epsilon(1e-4));
}

TEST_CASE("a fit goes on where it was, comes to the same bytes, and keeps what it compared") {
  StudyBench bench, other;
  for (const StudyBench* b : {&bench, &other}) {
    b->write("block.toml", block());
    b->write("record.csv", record(2e-4, 5));
  }
  const std::string text = k_fit + k_few + k_history + k_variables;
  (void)bench.run(text, {"--threads", "1"});
  (void)other.run(text, {"--threads", "2"});
  CHECK(bench.samples() == other.samples());
  { // half of it is lost
    study::LoadedStudy loaded = study::read_study(bench.at("study.toml"));
    study::Store store(bench.at("study.sqlite"), study::identity_of(loaded), study::StoreMode::run);
    store.forget_from(store.size() / 2);
    store.flush();
  }
  const Outcome again = bench.run(text);
  CHECK(has(again.out + again.err, "going on with"));
  CHECK(bench.samples() == other.samples());
  CHECK(study_does({"export", bench.at("study.sqlite"), "--findings"}).out ==
        study_does({"export", other.at("study.sqlite"), "--findings"}).out);
  const std::string histories = study_does({"export", bench.at("study.sqlite"), "--histories"}).out;
  CHECK(has(histories, "history,t,measured,fitted\nway,0.002,"));
  CHECK(std::count(histories.begin(), histories.end(), '\n') == 151);
  // Another record is another study.
  bench.write("record.csv", record(2e-4, 6));
  CHECK(bench.run(text).code == 2);
}

TEST_CASE("what is wrong with a history is told with its place") {
  StudyBench bench;
  bench.write("block.toml", block());
  const auto said = [&](const std::string& text) {
    const Outcome outcome = bench.run(text);
    CHECK(outcome.code == 3);
    return outcome.err;
  };
  bench.write("record.csv", "t,slide\n0.1,1\n0.2,2\n0.15,3\n");
  CHECK(has(said(k_fit + k_history + k_mu_variable), "record.csv:4:1: error: the times of history 'way' must rise"));
  bench.write("record.csv", "t,slide\n0.1,1\n0.2,2\n0.9,3\n");
  CHECK(has(said(k_fit + k_history + k_mu_variable), "record.csv:4:1: error: t = 0.9 s of history 'way' lies outside the run"));
  CHECK(has(said(k_fit + k_history + "to = 0.25\n" + k_variables), "2 measured values are too few for 3 parameters"));
  bench.write("record.csv", record(0.0, 1));
  CHECK(has(said(k_fit + k_history + "column = \"slid\"\n" + k_mu_variable), "study.toml:7:10"));
  CHECK(has(said(k_fit + k_history + "unit = \"kg\"\n" + k_mu_variable), "study.toml:7:8"));
  CHECK(has(said(k_fit + k_history + "noise = \"-1 mm\"\n" + k_mu_variable), "must be above zero"));
  CHECK(has(said(k_fit + k_mu_variable), "needs a [[history]]"));
  CHECK(has(said(k_fit + k_history + "[[variable]]\nname = \"mu\"\npath = \"element.deck friction.static_friction\"\nvalue = 0.3\n"),
            "needs a [[variable]] with a range"));
  CHECK(has(said("kind = \"sweep\"\nmodel = \"block.toml\"\n" + k_history + k_mu_variable), "for studies of the kind 'fit'"));
  std::string twice = k_history;
  twice.replace(twice.find("way"), 3, "again");
  CHECK(has(said(k_fit + k_history + twice + k_mu_variable), "need 'noise' each"));
  std::string misspelt = k_history;
  misspelt.replace(misspelt.find(".slide"), 6, ".slid");
  CHECK(has(said(k_fit + misspelt + k_mu_variable), "(did you mean 'deck friction.slide'?)"));
}
