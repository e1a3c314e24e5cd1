// A joint that holds although it cannot: of a mode problem that is deaf to the limit the run stops, of an event finder that
// is blind to it the judgement says so.
#include "mbd/trust/judge.h"
#include "mbd/trust/weighed_errors.h"
#include "tests/elements/step_lap/step_lap_scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>

using namespace steplap;
using namespace step_lap_scene;

namespace {

// A slider of 2 kg on sheets of 0.08 m² with 5 Pa each way of traction: they hold 0.4 N. A force that grows by 1 N/s pulls
// at their centre, so that u = t / 0.4 s, and the margin at the end of a run to 0.5 s is 0.8.
constexpr double k_onset = 0.4;

std::string pulled(const std::string& settings, const std::string& joint_fields = "", const std::string& peak = "100.0") {
  const std::vector<Vec2> ring = rectangle(-0.2, -0.1, 0.2, 0.1), yoke = rectangle(-5.0, -5.0, 5.0, 5.0);
  return header("end = 0.5\n" + settings, 0.01) + body("slider", 2.0, 0.05, Vec2::Zero()) + joint("slider", "ground", joint_fields) +
         interface(yoke, ring, 5.0, 1.0) + "[[signal]]\nname = \"ramp\"\nkind = \"triangle\"\npeak = " + peak +
         "\nduration = 200.0\n"
         "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"slider\"\nforce_x = \"ramp\"\n";
}

enum class Fault { deaf_mode_problem, blind_watch };

// The real friction, but for one answer.
class Faulty final : public FrictionElement {
public:
  Faulty(std::unique_ptr<FrictionElement> real, Fault fault) : real_(std::move(real)), fault_(fault) {}
  [[nodiscard]] int dimension() const override { return real_->dimension(); }
  [[nodiscard]] const RowSpec* rows(const FrictionState& s) const override { return real_->rows(s); }
  [[nodiscard]] bool is_rigid() const override { return real_->is_rigid(); }
  void mark_bodies(std::vector<char>& is_used) const override { real_->mark_bodies(is_used); }
  [[nodiscard]] std::unique_ptr<FrictionScratch> make_scratch() const override { return real_->make_scratch(); }
  [[nodiscard]] bool is_loaded(const Evaluation& e, const FrictionState& s) const override { return real_->is_loaded(e, s); }
  void slip_wrench(const Evaluation& e, const FrictionState& s, const double* rate, double* wrench) const override {
    real_->slip_wrench(e, s, rate, wrench);
  }
  [[nodiscard]] double support(const Evaluation& e, const FrictionState& s, const double* rate) const override {
    return real_->support(e, s, rate);
  }
  [[nodiscard]] double gauge(const Evaluation& e, const FrictionState& s, const double* wrench, double* normal) const override {
    return real_->gauge(e, s, wrench, normal);
  }
  void stick_events(const Evaluation& e, const FrictionState& s, const double* wrench, double* event_value) const override {
    if (fault_ == Fault::blind_watch) event_value[0] = event_value[1] = 1.0;
    else real_->stick_events(e, s, wrench, event_value);
  }
  void set_onset_direction(const Evaluation& e, FrictionState& s, const double* wrench) const override {
    real_->set_onset_direction(e, s, wrench);
  }
  void aim(FrictionState& s, const double* rate) const override { real_->aim(s, rate); }
  // Where it begins to move the mode problem is asked how it goes on.
  void slip_events(const Evaluation&, const FrictionState&, const double* rate, double* event_value) const override {
    event_value[0] = 1e-9 - std::abs(rate[0]);
    event_value[1] = 1.0;
  }
  [[nodiscard]] BlockSolution solve_block(const Evaluation& e, const FrictionState& s, const double* a, const double* b,
                                          bool is_kinetic) const override {
    BlockSolution block = real_->solve_block(e, s, a, b, is_kinetic);
    if (fault_ == Fault::deaf_mode_problem) block.sticks = true;
    return block;
  }

private:
  std::unique_ptr<FrictionElement> real_;
  Fault fault_;
};

struct CheckedModel {
  Model model;
  std::unique_ptr<System> system;

  explicit CheckedModel(const std::string& text) : model(parse_model(text, "scene.toml", transformer_catalog())), system(compile(model)) {}
  void make(Fault fault) {
    std::unique_ptr<FrictionElement>& friction = system->frictions.front().friction;
    friction = std::make_unique<Faulty>(std::move(friction), fault);
    system->frictions.front().bounded = nullptr; // its blocks are solved by the faulty element
  }
  [[nodiscard]] RunResult run() const { return simulate(*system, system->initial_state(), options_of(model)); }
};

} // namespace

TEST_CASE("a joint that goes on holding below a margin of 1 stops the run, and is named with time and margin") {
  for (const char* method : {"auto", "dop853", "tsit5", "rodas5p", "rk4"}) {
    CAPTURE(method);
    const std::string text = pulled("step = 1e-3\nintegrator = \"" + std::string(method) + "\"");
    REQUIRE(CheckedModel(text).run().events.size() == 1); // as it should be: it slips
    CHECK(CheckedModel(text).run().events.front().t == doctest::Approx(k_onset).epsilon(1e-8));

    CheckedModel deaf(text);
    deaf.make(Fault::deaf_mode_problem);
    Simulation simulation(*deaf.system, deaf.system->initial_state(), options_of(deaf.model));
    std::string message;
    try {
      simulation.run();
    } catch (const NumericalFailure& failure) {
      message = failure.what();
    }
    CAPTURE(message);
    CHECK(message.find("'joint' holds with a margin of 0.") != std::string::npos);
    CHECK(message.find("the run contradicts itself") != std::string::npos);
    CHECK(simulation.current_state().t >= k_onset * (1.0 - 1e-8)); // not before it has to slip
  }
}

TEST_CASE("joints that are only monitored, and those that a model lets slip, are no contradiction") {
  const CheckedModel monitored(pulled("", "mode = \"monitor\""));
  const RunResult beyond = monitored.run();
  CHECK(beyond.final_state.t == 0.5);
  const Judgement judgement = judge(monitored.model, *monitored.system, beyond, "");
  CHECK(judgement.distrust.empty());
  CHECK(judgement.verdict == Verdict::inspect); // it would slip
  const CheckedModel real(pulled(""));
  CHECK(judge(real.model, *real.system, real.run(), "").distrust.empty());
}

TEST_CASE("a joint that is said to hold with a margin below 1 leaves the verdict open") {
  CheckedModel blind(pulled(""));
  blind.make(Fault::blind_watch);
  const RunResult result = blind.run();
  REQUIRE(result.events.empty());
  const Judgement judgement = judge(blind.model, *blind.system, result, "");
  CAPTURE(judgement.distrust);
  CHECK(judgement.distrust.find("'joint' holds with a margin of 0.8 at t = 0.5 s") == 0);
  CHECK(judgement.verdict == Verdict::open);
}

namespace {

// A run to `end`, judged as if its finer run had pulled with `finer_peak` instead of the peak of 100 N.
std::string distrust_of(const std::string& end, const std::string& peak, const std::string& finer_peak) {
  CheckedModel mine(pulled("", "", peak)), other(pulled("", "", finer_peak));
  SimulationOptions options = options_of(mine.model);
  options.end = std::stod(end);
  const RunResult run = simulate(*mine.system, mine.system->initial_state(), options);
  GlobalErrorEstimate estimate = estimate_global_error(*mine.system, mine.system->initial_state(), options, run);
  estimate.finest = simulate(*other.system, other.system->initial_state(), options);
  Judgement judgement = judge(mine.model, *mine.system, run, "");
  weigh_errors(judgement, mine.model, *mine.system, run, estimate);
  CHECK((judgement.verdict == Verdict::open || judgement.distrust.empty()));
  return judgement.distrust;
}

} // namespace

TEST_CASE("a slip that only the run or only its finer run has is not to be trusted where a verdict hangs on it") {
  // With 70 N at the top instead of 100 N the force reaches 0.35 N of 0.4 N in half a second: nothing slips.
  CHECK(distrust_of("0.5", "100.0", "100.0").empty());
  CHECK(distrust_of("0.5", "70.0", "70.0").empty());
  CHECK(distrust_of("0.5", "100.0", "70.0").find("'joint' slips at t = 0.4 s here but not in a finer run") != std::string::npos);
  CHECK(distrust_of("0.5", "70.0", "100.0").find("'joint' slips at t = 0.4 s in a finer run but not here") != std::string::npos);
}
