// A voyage is one history: where an event leaves the machine, the next begins.
#include "driven_scene.h"

#include <atomic>
#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::assess;
using namespace assess_test;

namespace {

constexpr double k_g = 9.81;
const std::string k_asked = "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"1 m\"\n";

// |floor.slide| at its largest after each of the events, one after the other.
std::vector<double> slides(const DrivenModel& model, const std::vector<double>& peaks) {
  VoyageModel traveller(model);
  std::vector<double> found;
  for (const double peak : peaks) {
    const Passage passage = traveller.pass(triangles({peak}, 0.1, 0.4), Estimating::never);
    REQUIRE(passage.is_made);
    for (const LimitPassage& limit : passage.clearances)
      if (limit.name == "slide") found.push_back(std::abs(limit.value));
  }
  return found;
}

std::string lashed(double strength) {
  return k_asked +
         "[[element]]\nkind = \"tie\"\nname = \"lashing\"\na = { body = \"block\", at = [0.0, 0.0] }\nb = { body = \"tank\", at = [-1.0, "
         "0.0] }\naxis = [1.0, 0.0]\nacts = \"both\"\nstiffness = 1e9\ndamping = 1e5\nstrength = " +
         std::to_string(strength) + "\n";
}

} // namespace

TEST_CASE("slides of events add up, and two events are one run with both pulses") {
  const DrivenModel model = driven(block_text(0.3, k_asked));
  const std::vector<double> both = slides(model, {0.6 * k_g, 0.5 * k_g});
  const std::vector<double> first = slides(model, {0.6 * k_g}), second = slides(model, {0.5 * k_g});
  REQUIRE(both.size() == 2);
  CHECK(both[0] == doctest::Approx(first[0]).epsilon(1e-9));
  CHECK(both[1] == doctest::Approx(first[0] + second[0]).epsilon(1e-6)); // both slide the same way; errors of two runs
  // The settling time lies between the pulses as well: 0.4 s after a pulse and 0.3 s.
  const double at_once = std::abs(final_value(model, triangles({0.6 * k_g, 0.0, 0.5 * k_g}, 0.1, 0.4), "floor.slide"));
  CHECK(both[1] == doctest::Approx(at_once).epsilon(1e-6));
}

TEST_CASE("the order of events counts: what a strong one breaks no longer holds in a weak one") {
  // The tie bears what friction does not: 1000 kg (0.6 g - 0.2 g) in the strong event, 1000 kg (0.4 g - 0.2 g) in the weak one.
  const DrivenModel model = driven(block_text(0.2, lashed(3000.0)));
  const double strong_first = slides(model, {0.6 * k_g, 0.4 * k_g}).back();
  const double weak_first = slides(model, {0.4 * k_g, 0.6 * k_g}).back();
  const double weak_alone = slides(model, {0.4 * k_g}).back();
  CHECK(weak_alone < 1e-4);                // it holds
  CHECK(strong_first > weak_first + 1e-3); // and does not after the strong one
  CHECK(slides(driven(block_text(0.2, lashed(1e6))), {0.6 * k_g, 0.4 * k_g}).back() < 1e-4);
}

TEST_CASE("the voyage by one system, as samples take it, is the voyage event by event") {
  const DrivenModel model = driven(block_text(0.3, "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"4 mm\"\n"));
  for (const double second : {0.31 * k_g, 0.5 * k_g}) { // 3.602 mm, then nearly none or beyond 4 mm
    const std::vector<DriveHistory> histories = {triangles({0.6 * k_g}, 0.1, 0.4), triangles({second}, 0.1, 0.4)};
    VoyageRunner runner(model, histories, {});
    const VoyageOutcome outcome = runner.run({});
    CHECK(outcome.summary.unknown == "");
    CHECK(outcome.events_made == 2);
    VoyageModel traveller(model);
    Verdict worst = Verdict::hold;
    for (const DriveHistory& history : histories)
      for (const LimitPassage& limit : traveller.pass(history, Estimating::never).clearances) worst = std::max(worst, limit.outcome);
    CHECK(outcome.summary.limits.outcome == worst);
    CHECK(worst == (second > 0.4 * k_g ? Verdict::inspect : Verdict::hold));
  }
}

namespace {

const std::string k_uncertain = "[[uncertain]]\nname = \"floor\"\npaths = [\"element.floor.static_friction\"]\ndistribution = "
                                "\"uniform\"\nlow = 0.2\nhigh = 0.4\nsource = \"assumed\"\nsource_text = \"a test\"\n";

struct UncertainVoyage {
  std::vector<DrivenModel> models;
  std::vector<std::vector<DriveHistory>> histories;
};

// |slide| beyond 3.602 mm, that of a friction of 0.3: half of the uniform distribution.
UncertainVoyage uncertain_voyage() {
  UncertainVoyage voyage;
  voyage.models.push_back(
      driven(block_text(0.3, k_uncertain + "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"3.602 mm\"\n")));
  voyage.histories.push_back({triangles({0.6 * k_g}, 0.1, 0.2)});
  return voyage;
}

} // namespace

TEST_CASE("a probability by samples is that of the closed form, and the same for any number of threads") {
  const UncertainVoyage voyage = uncertain_voyage();
  const UncertainValues uncertain(voyage.models);
  SamplingOptions options;
  options.samples = 100;
  const std::vector<VoyageSample> one = sample_voyages(voyage.models, voyage.histories, uncertain, options);
  const Probability p = damage_probability(one);
  CHECK(p.runs == 100);
  CHECK(p.low < 0.5); // the closed form's; a 95 % interval, and the seed is fixed
  CHECK(p.high > 0.5);
  for (const VoyageSample& sample : one) CHECK(is_damaged(sample.summary) == (sample.values[0] < 0.30000));
  options.threads = 3;
  const std::vector<VoyageSample> three = sample_voyages(voyage.models, voyage.histories, uncertain, options);
  for (std::size_t i = 0; i < one.size(); ++i) {
    CHECK(one[i].values == three[i].values);
    CHECK(one[i].summary.limits.outcome == three[i].summary.limits.outcome);
  }
}

TEST_CASE("samples that were made are kept, and an assessment that was interrupted goes on") {
  const Folder folder;
  const UncertainVoyage voyage = uncertain_voyage();
  const UncertainValues uncertain(voyage.models);
  SamplingOptions options;
  options.samples = 12;
  options.threads = 1; // `asked` is counted by one
  const std::vector<VoyageSample> whole = sample_voyages(voyage.models, voyage.histories, uncertain, options);
  options.store = folder.file("samples.sqlite");
  long asked = 0;
  options.stop = [&] { return ++asked > 8 ? std::string("stopped by the test") : std::string(); };
  CHECK_THROWS_AS(static_cast<void>(sample_voyages(voyage.models, voyage.histories, uncertain, options)), NumericalFailure);
  options.stop = {};
  long first = -1;
  options.progress = [&](long done, long) { first = first < 0 ? done : first; };
  const std::vector<VoyageSample> resumed = sample_voyages(voyage.models, voyage.histories, uncertain, options);
  CHECK(first > 0);
  CHECK(first < 12);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    CHECK(resumed[i].summary.limits.outcome == whole[i].summary.limits.outcome);
    CHECK(resumed[i].slips == whole[i].slips);
  }
  options.seed = 2; // other samples: what is there is of no use
  first = -1;
  static_cast<void>(sample_voyages(voyage.models, voyage.histories, uncertain, options));
  CHECK(first == 0);
}

TEST_CASE("what goes wrong on one of several threads reaches who asked for the samples, and what was made before is kept") {
  const Folder folder;
  const UncertainVoyage voyage = uncertain_voyage();
  const UncertainValues uncertain(voyage.models);
  SamplingOptions options;
  options.samples = 30;
  options.threads = 3;
  options.store = folder.file("samples.sqlite");
  std::atomic<long> made = 0;
  options.progress = [&](long done, long) { made = done; };
  options.stop = [&]() -> std::string {
    if (made >= 3) throw std::length_error("of the test");
    return "";
  };
  CHECK_THROWS_AS(static_cast<void>(sample_voyages(voyage.models, voyage.histories, uncertain, options)), std::length_error);
  options.stop = {};
  long first = -1;
  options.progress = [&](long done, long) { first = first < 0 ? done : first; };
  const std::vector<VoyageSample> resumed = sample_voyages(voyage.models, voyage.histories, uncertain, options);
  CHECK(first >= 3);
  options.store.clear();
  const std::vector<VoyageSample> whole = sample_voyages(voyage.models, voyage.histories, uncertain, options);
  for (std::size_t i = 0; i < whole.size(); ++i) CHECK(resumed[i].slips == whole[i].slips);
}

TEST_CASE("a number of the same name in two models is one number; two laws for it are refused") {
  std::vector<DrivenModel> models;
  models.push_back(driven(block_text(0.3, k_uncertain)));
  models.push_back(driven(block_text(0.3, k_uncertain)));
  CHECK(UncertainValues(models).values().size() == 1);
  std::string other = k_uncertain;
  other.replace(other.find("high = 0.4"), 10, "high = 0.5");
  models.push_back(driven(block_text(0.3, other)));
  CHECK_THROWS_AS(UncertainValues{models}, ModelError);
}
