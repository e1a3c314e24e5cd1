// Frictions that models of two planes share: closed forms, symmetry, what forbids "energise", and that nothing else changes.
#include "driven_scene.h"

#include "tools/assess/shared_friction.h"
#include "transformer/recorder/fields.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

using namespace steplap;
using namespace steplap::assess;
using namespace assess_test;

namespace {

const std::string k_planes = std::string(STEPLAP_TEST_DATA) + "/planes/";
constexpr double k_degree = std::numbers::pi / 180.0;

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

AssessmentOptions options_of() {
  AssessmentOptions options;
  options.reading.gravity = "z";
  options.reading.rules.threshold = 0.1 * k_gravity;
  options.sampling.samples = 0;
  options.estimating = Estimating::never;
  options.accepted = all_evidence(); // of the plane question alone
  options.criteria = k_planes + "only.toml";
  options.overrides = {"gravity=[0, -9.80665]"}; // the record's g
  return options;
}

// A record of x, y and z in g.
void write_record(const std::string& file, double rate, double duration, const std::function<std::array<double, 3>(double)>& at) {
  std::string text = "time [s],x [g],y [g],z [g]\n";
  for (long i = 0; i < std::lround(duration * rate); ++i) {
    const double t = static_cast<double>(i) / rate, noise = 1e-4 * std::sin(1e5 * t); // an axis that never moves is no axis
    const std::array<double, 3> a = at(t);
    char row[96];
    std::snprintf(row, sizeof row, "%.4f,%.6f,%.6f,%.6f\n", t, a[0] + noise, a[1] - noise, 1.0 + a[2] + noise);
    text += row;
  }
  write(file, text);
}

double plateau(double t) { // rises and falls in 0.1 s, 1.6 s at the top
  return std::clamp(10.0 * std::min(t - 1.0, 2.8 - t), 0.0, 1.0);
}
// The same with smooth ends of 0.3 s, by which the models' feet (50 Hz) are not shaken: the rigid block's use is met to a thousandth.
double smooth(double t) { return 0.5 - 0.5 * std::cos(std::numbers::pi * std::clamp(std::min(t - 1.0, 3.2 - t) / 0.3, 0.0, 1.0)); }

const SharedPassage& only_passage(const Assessment& a) {
  REQUIRE(a.shared.size() == 1);
  REQUIRE(a.events.size() == 1);
  REQUIRE(a.events[0].shared.size() == 1);
  return a.events[0].shared[0];
}

// The models of tests/data/planes with other lines in them.
struct Machine {
  Folder folder;
  std::string along = text_of(k_planes + "long_rec.toml"), across = text_of(k_planes + "cross_rec.toml");
  [[nodiscard]] Assessment assessed(const std::function<std::array<double, 3>(double)>& at, const AssessmentOptions& options,
                                    double duration = 4.0) const {
    write(folder.file("along.toml"), along);
    write(folder.file("across.toml"), across);
    write_record(folder.file("record.csv"), 500.0, duration, at);
    return assess::assess({folder.file("record.csv")}, {folder.file("along.toml"), folder.file("across.toml")}, options);
  }
};

std::array<double, 3> pulled_smoothly(double t, double along, double across) { return {along * smooth(t), across * smooth(t), 0.0}; }
std::array<double, 3> pulled(double t, double along, double across) { return {along * plateau(t), across * plateau(t), 0.0}; }

bool has_sentence(const std::vector<std::string>& sentences, const std::string& part) {
  return std::any_of(sentences.begin(), sentences.end(), [&](const std::string& s) { return s.find(part) != std::string::npos; });
}

} // namespace

TEST_CASE("0.25 g along and across at a friction of 0.3: use 1.179, 0.9046 m, return; in either order of the models") {
  for (const bool is_turned : {false, true}) {
    std::vector<std::string> models{k_planes + "long_rec.toml", k_planes + "cross_rec.toml"};
    if (is_turned) std::swap(models[0], models[1]);
    const Assessment a = assess::assess({k_planes + "curve.csv"}, models, options_of());
    const SharedPassage& passage = only_passage(a);
    CHECK(a.decision == Decision::send_back);
    CHECK(a.reason.find("both planes together") != std::string::npos);
    // The machine's feet spring, which adds a little to the rigid block's use: 1e9 N/m under 20 t, 50 Hz, and ramps of some ms.
    CHECK(passage.use == doctest::Approx(1.179).epsilon(0.005));
    CHECK(passage.slid == doctest::Approx(0.9046).epsilon(5e-4));
    CHECK(passage.bound == "");
    CHECK(has_sentence(a.assumptions, "yaw"));
    CHECK(nlohmann::json::parse(assessment_json(a)).at("voyage").at("shared_frictions").at(0).at("name") == "beams");
  }
}

TEST_CASE("0.2 g along and across holds at 0.943, and says so") {
  const Machine machine;
  const Assessment a = machine.assessed([](double t) { return pulled_smoothly(t, 0.2, 0.2); }, options_of());
  CHECK(a.decision == Decision::energise);
  CHECK(only_passage(a).use == doctest::Approx(0.2 * std::sqrt(2.0) / 0.3).epsilon(0.002)); // noise of the record
  CHECK(only_passage(a).slid == 0.0);
  CHECK(std::any_of(a.reasons.begin(), a.reasons.end(), [](const Reason& r) { return r.text.find("at most 94.") != std::string::npos; }));
}

TEST_CASE("friction of different names in two planes is open until somebody takes the responsibility") {
  Machine machine;
  for (std::size_t at = 0; (at = machine.across.find("beams", at)) != std::string::npos; at += 6) machine.across.replace(at, 5, "planks");
  AssessmentOptions options = options_of();
  const auto gentle = [](double t) { return pulled_smoothly(t, 0.2, 0.2); };
  CHECK(machine.assessed(gentle, options).decision == Decision::energise); // all evidence is accepted
  options.accepted.clear();
  const Assessment a = machine.assessed(gentle, options);
  CHECK(std::any_of(a.missing.begin(), a.missing.end(), [](const MissingEvidence& m) {
    return m.item == Evidence::planes && m.reason.find("'beams' of") != std::string::npos &&
           m.reason.find("'planks' of") != std::string::npos;
  }));
  CHECK(a.decision == Decision::open);
  const Assessment same = Machine().assessed(gentle, options);
  CHECK(std::none_of(same.missing.begin(), same.missing.end(), [](const MissingEvidence& m) { return m.item == Evidence::planes; }));
}

TEST_CASE("mirrored, and with the axes of the record exchanged, it slides the same way") {
  const Machine machine;
  const AssessmentOptions options = options_of();
  const double slid = only_passage(machine.assessed([](double t) { return pulled(t, 0.28, 0.21); }, options)).slid;
  CHECK(slid > 0.1);
  for (const auto& [x, y] : {std::pair(-0.28, 0.21), std::pair(0.28, -0.21), std::pair(0.21, 0.28), std::pair(-0.21, -0.28)})
    // Noise of the record acts along one diagonal.
    CHECK(only_passage(machine.assessed([&](double t) { return pulled(t, x, y); }, options)).slid == doctest::Approx(slid).epsilon(2e-3));
}

TEST_CASE("the vertical axis counts once: less weight slides earlier, as the closed form says") {
  const Machine machine;
  const Assessment a = machine.assessed(
      [](double t) {
        return std::array<double, 3>{0.18 * smooth(t), 0.18 * smooth(t), -0.1 * smooth(t)};
      },
      options_of());
  CHECK(only_passage(a).use == doctest::Approx(0.18 * std::sqrt(2.0) / (0.3 * 0.9)).epsilon(0.003)); // twice would be 1.06
  CHECK(only_passage(a).slid == 0.0);
}

namespace {

// Both planes tilted by the parts of a slope along them; the record is quiet.
SharedPassage on_slope(double slope, double azimuth, double mu) {
  std::array<SampledFriction, 2> traces;
  SharedFriction friction;
  friction.name = "beams";
  std::array<DriveHistory, 2> histories;
  const double g = 9.80665, mass = 20000.0;
  const std::array<double, 2> sine{std::sin(slope) * std::cos(azimuth), std::sin(slope) * std::sin(azimuth)};
  for (std::size_t p = 0; p < 2; ++p) {
    PlaneOfFriction& plane = friction.planes[p];
    plane.model = p, plane.traces = {0}, plane.gravity = g, plane.downhill = g * sine[p], plane.tilt = std::sqrt(1.0 - sine[p] * sine[p]);
    traces[p].step = histories[p].step = 1e-3;
    traces[p].mu_static = traces[p].mu_kinetic = mu;
    traces[p].force.assign(11, -mass * g * sine[p]); // as each model says: it stands on its own slope
    traces[p].normal.assign(11, mass * g * plane.tilt);
    traces[p].sticks.assign(11, 1);
    histories[p].x.assign(11, 0.0), histories[p].y.assign(11, 0.0);
  }
  SharedFrictionCourse course(friction);
  return course.pass(traces, {&histories[0], &histories[1]});
}

} // namespace

TEST_CASE("a block on a slope whose azimuth turns slides when tan = mu at every azimuth, to 1e-9") {
  const double mu = 0.3, limit = std::atan(mu);
  for (int i = 0; i < 360; i += 5) {
    const double azimuth = (i + 0.5) * k_degree;
    CHECK(on_slope(limit, azimuth, mu).use == doctest::Approx(1.0).epsilon(1e-9));
    CHECK(on_slope(0.5 * limit, azimuth, mu).use == doctest::Approx(std::tan(0.5 * limit) / mu).epsilon(1e-9));
    const bool is_diagonal = std::min(std::abs(std::sin(azimuth)), std::abs(std::cos(azimuth))) > 0.06; // a part of each plane
    if (!is_diagonal) continue;
    CHECK_FALSE(on_slope(limit * (1.0 - 1e-9), azimuth, mu).slips);
    CHECK(on_slope(limit * (1.0 + 1e-8), azimuth, mu).slips);
    CHECK(std::isinf(on_slope(limit * (1.0 + 1e-6), azimuth, mu).slid)); // a slope ends nowhere
  }
}

TEST_CASE("models whose gravity is tilted count both slopes") {
  // 10 degrees to the front and 10 to the side, 12 % more by a slow pull along; the block of the models, not of a formula.
  Machine machine;
  const double sine = std::sin(10.0 * k_degree), cosine = std::cos(10.0 * k_degree);
  const std::string gravity = "gravity = [" + std::to_string(9.80665 * sine) + ", " + std::to_string(-9.80665 * cosine) + "]\n";
  machine.along = gravity + machine.along, machine.across = gravity + machine.across;
  AssessmentOptions options = options_of();
  options.overrides.clear();
  const Assessment a = machine.assessed([](double t) { return pulled(t, -0.12, 0.0); }, options);
  // Its front is tilted against x, so that a pull of the deck along -x adds to it: 0.1736 + 0.12 along, 0.1736 across.
  const double normal = std::sqrt(1.0 - 2.0 * sine * sine);
  CHECK(only_passage(a).use == doctest::Approx(std::hypot(sine + 0.12, sine) / (0.3 * normal)).epsilon(0.003));
  // Gravity of another size in one of them is no slope.
  machine.across = "gravity = [0.0, -9.7]\n" + text_of(k_planes + "cross_rec.toml");
  const Assessment other = machine.assessed([](double t) { return pulled(t, 0.2, 0.0); }, options);
  CHECK(other.decision == Decision::open);
  CHECK(other.reason.find("gravity is") != std::string::npos);
}

TEST_CASE("with a rope, with a foot that lifts: the path is an upper bound, and the decision inspect at best") {
  Machine machine;
  machine.across +=
      "[[element]]\nkind = \"tie\"\nname = \"lashing\"\na = { body = \"unit\", at = [1.2, 0.4] }\nb = { body = \"deck\", at = "
      "[2.5, 0.0] }\naxis = [1.0, 0.0]\nacts = \"both\"\nstiffness = 1e5\ndamping = 1e3\n";
  const Assessment roped = machine.assessed([](double t) { return pulled(t, 0.25, 0.25); }, options_of());
  CHECK(roped.decision == Decision::inspect);
  CHECK(only_passage(roped).bound.find("lashing") != std::string::npos);
  CHECK(roped.reason.find("upper bound") != std::string::npos);
  // The same rope where nothing slips asks for nothing.
  CHECK(machine.assessed([](double t) { return pulled(t, 0.15, 0.15); }, options_of()).decision == Decision::energise);
  // 0.25 g at the height of 1.9 m tips what stands on 2 x 0.45 m.
  Machine tall;
  for (std::string* const text : {&tall.along, &tall.across})
    for (const std::string sign : {"", "-"})
      for (std::size_t at = 0; (at = text->find("at = [" + sign + "1.2, 0.0]", at)) != std::string::npos;)
        text->replace(at, 6 + sign.size() + 3, "at = [" + sign + "0.15");
  const Assessment tipped = tall.assessed([](double t) { return pulled(t, 0.26, 0.26); }, options_of());
  CHECK(tipped.decision >= Decision::inspect);
  if (only_passage(tipped).slips) CHECK(only_passage(tipped).bound.find("lifts") != std::string::npos);
}

TEST_CASE("without a limit on the slide the decision is open, with a wide one it is energise") {
  Machine machine;
  for (std::string* const text : {&machine.along, &machine.across}) text->replace(text->find("\"5 mm\""), 6, "\"2 m\"");
  CHECK(machine.assessed([](double t) { return pulled(t, 0.25, 0.25); }, options_of()).decision == Decision::energise);
  for (std::string* const text : {&machine.along, &machine.across}) {
    text->replace(text->find("beams.slide"), 11, "beams.friction");
    text->replace(text->find("\"2 m\""), 5, "\"1 MN\"");
  }
  const Assessment a = machine.assessed([](double t) { return pulled(t, 0.25, 0.25); }, options_of());
  CHECK(a.decision == Decision::open);
  CHECK(a.reason.find("[[acceptance]]") != std::string::npos);
}

TEST_CASE("which frictions are one: by name, by shared_friction, by sums; not two models of one plane") {
  std::vector<DrivenModel> models;
  const std::string along = text_of(k_planes + "long_rec.toml");
  std::string across = text_of(k_planes + "cross_rec.toml");
  const auto found = [&] { return find_shared_frictions(models).size(); };
  models = {driven(along), driven(along)};
  CHECK(found() == 0);
  CHECK(models[0].traced.empty());
  models = {driven(along), driven(across)};
  CHECK(found() == 1);
  CHECK(models[0].traced == std::vector<std::string>{"beams"});
  std::string renamed = across;
  const std::size_t name = renamed.find("name = \"beams\"");
  renamed.replace(name, 14, "name = \"timber\"");
  renamed.replace(renamed.find("beams.slide"), 11, "timber.slide");
  models = {driven(along), driven(renamed)};
  CHECK(found() == 0);
  renamed.insert(name, "shared_friction = \"beams\"\n");
  models = {driven(along), driven(renamed)};
  CHECK(found() == 1);
  // One friction under each foot, and their sum.
  const std::string one = "contacts = [\"front\", \"rear\"]\nstatic_friction = 0.3\n";
  REQUIRE(across.find(one) != std::string::npos);
  across.replace(across.find(one), one.size(),
                 "contacts = [\"front\"]\nstatic_friction = 0.3\n[[element]]\nkind = \"coulomb_stick\"\nname = \"beams "
                 "2\"\nshared_friction = \"beams\"\ncontacts = [\"rear\"]\nstatic_friction = 0.3\n");
  models = {driven(along), driven(across)};
  const std::vector<SharedFriction> sum = find_shared_frictions(models);
  REQUIRE(sum.size() == 1);
  CHECK(sum[0].planes[1].traces.size() == 2);
  CHECK(sum[0].planes[1].holders.empty());
  // Halves of it, one in each trace, are the whole.
  SampledFriction whole;
  whole.step = 1e-3, whole.mu_static = whole.mu_kinetic = 0.3;
  whole.force = {0.0, 2e4, 4e4}, whole.normal = {2e5, 2e5, 2e5}, whole.sticks = {1, 1, 1};
  SampledFriction half = whole;
  for (std::size_t i = 0; i < 3; ++i) half.force[i] *= 0.5, half.normal[i] *= 0.5;
  const std::vector<SampledFriction> one_of{whole}, two_of{half, half};
  DriveHistory quiet;
  quiet.step = 1e-3, quiet.x.assign(3, 0.0), quiet.y.assign(3, 0.0);
  SharedFrictions shared(sum);
  CHECK(shared.pass({&one_of, &two_of}, {&quiet, &quiet}).at(0).use == doctest::Approx(4e4 * std::sqrt(2.0) / 6e4).epsilon(1e-12));
}

// A load acts whatever the unit does; a spring by formula takes a part of what the friction would have to hold.
TEST_CASE("a force by formula holds the load if it depends on the motion, not if it is a function of time, signals and parameters") {
  const std::string along = text_of(k_planes + "long_rec.toml"), across = text_of(k_planes + "cross_rec.toml");
  const auto holders = [&](const std::string& formula) {
    const std::string force =
        "[parameters]\nstiff = \"1 kN/m\"\nlarge = \"2 kN\"\n[[signal]]\nkind = \"constant\"\nname = \"gust\"\nvalue = "
        "0.5\n[[element]]\nkind = \"force\"\nname = \"by formula\"\na = \"unit\"\ncoordinate = \"x\"\nformula = \"" +
        formula + "\"\n";
    std::vector<DrivenModel> models = {driven(along + force), driven(across)};
    return find_shared_frictions(models).at(0).planes[0].holders;
  };
  CHECK(holders("'1 kN'").empty());
  CHECK(holders("large * gust + '1 N/s' * t").empty());
  CHECK(holders("-stiff * value") == std::vector<std::string>{"by formula"});
  CHECK(holders("-'1 kN s/m' * rate") == std::vector<std::string>{"by formula"});
  CHECK(holders("-stiff * unit.x") == std::vector<std::string>{"by formula"});
}

TEST_CASE("two models that load one contact unlike are not of one machine: open") {
  Machine machine;
  machine.across.replace(machine.across.find("\"20 t\""), 6, "\"24 t\"");
  const Assessment a = machine.assessed([](double t) { return pulled(t, 0.15, 0.15); }, options_of());
  CHECK(a.decision == Decision::open);
  CHECK(a.reason.find("carries") != std::string::npos);
}

TEST_CASE("one plane that slips alone is judged by its own model as before") {
  // 0.35 g along and 0.01 g across: 3 % of the friction is asked for across.
  const Machine machine;
  const Assessment a = machine.assessed([](double t) { return pulled(t, 0.35, 0.01); }, options_of());
  CHECK_FALSE(only_passage(a).slips);
  CHECK(a.decision == Decision::send_back); // the model's own slide
  CHECK(a.summary.limits.unmet.find("together") == std::string::npos);
  // With 0.2 g across it slides further than along alone: the direction of friction is that of the motion.
  const Assessment both = machine.assessed([](double t) { return pulled(t, 0.35, 0.2); }, options_of());
  REQUIRE(only_passage(both).slips);
  const double alone = std::abs(both.events[0].passages[0].clearances.at(0).value);
  CHECK(only_passage(both).slid > 1.2 * alone);
  const double a_along = std::hypot(0.35, 0.2) * 9.80665, c = 0.3 * 9.80665; // a straight line, ramps of 0.1 s
  // Rises from c at u to the top, stays for 1.6 s, falls; v at the top, then closed forms of uniform and linear acceleration.
  const double rest = c / a_along, ramp = 0.1;
  const double rise = ramp * (1.0 - rest), excess = a_along - c;
  double v = 0.5 * excess * rise, s = excess * rise * rise / 6.0;
  s += v * 1.6 + 0.5 * excess * 1.6 * 1.6, v += excess * 1.6;
  s += v * ramp + excess * ramp * ramp / 2.0 - a_along * ramp * ramp / 6.0, v += excess * ramp - 0.5 * a_along * ramp;
  s += 0.5 * v * v / c;
  CHECK(only_passage(both).slid == doctest::Approx(s).epsilon(5e-3)); // the other plane's model slides, and its feet spring
}

TEST_CASE("samples and events in detail say the same of both planes") {
  Machine machine;
  const std::string uncertain = "[[uncertain]]\nname = \"beams\"\npaths = [\"element.beams.static_friction\"]\ndistribution = "
                                "\"uniform\"\nlow = 0.25\nhigh = 0.45\nsource = \"assumed\"\nsource_text = \"a test\"\n";
  machine.along += uncertain, machine.across += uncertain;
  AssessmentOptions options = options_of();
  options.sampling.samples = 30;
  const Assessment a = machine.assessed([](double t) { return pulled(t, 0.25, 0.25); }, options);
  CHECK(a.summary.unknown == "");
  // Below 0.25 √2 = 0.3536 it slides; above it holds, although each plane alone does for all of them.
  CHECK(a.damage.runs == 30);
  for (const VoyageSample& sample : a.samples)
    if (std::abs(sample.values[0] - 0.25 * std::sqrt(2.0)) > 0.003) // 5 mm are allowed
      CHECK(is_damaged(sample.summary) == (sample.values[0] < 0.25 * std::sqrt(2.0)));
}
