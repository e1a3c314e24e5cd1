// A tank driven as recorded: closed forms, and that the place of the recorder counts as it should.
#include "driven_scene.h"

#include "mbd/io/reference.h"
#include "mbd/run/run.h"
#include "tools/assess/voyage_runner.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::assess;
using namespace assess_test;

namespace {

// A bar of mass m and inertia I about its centre, gravity off, recorder `h` above the centre.
std::string bar_text(double h, const std::string& rotation, const std::string& axes = "x = \"x\"\ny = \"z\"\n", double turned = 0.0) {
  return "gravity = [0.0, 0.0]\n[simulation]\nend = 1.0\nintegrator = \"dop853\"\ntolerance = 1e-10\n[[body]]\nname = \"bar\"\nmass = "
         "200.0\ninertia = 150.0\n"
         "[[body]]\nname = \"weight\"\nmass = 1.0\ninertia = 1.0\n[[element]]\nkind = \"weld\"\nname = \"screw\"\na = \"weight\"\nb = "
         "\"bar\"\n"
         "[[marker]]\nname = \"place\"\nbody = \"bar\"\npoint = [0.0, " +
         std::to_string(h) + "]\nangle = " + std::to_string(turned) + "\n[[recorder]]\nname = \"recorder\"\nmarker = \"place\"\n" + axes +
         "settle = 0.0\nrotation = \"" + rotation + "\"\n";
}

DriveHistory constant(double ax, double ay, double duration) {
  DriveHistory history;
  history.step = duration / 100.0;
  history.x.assign(101, ax);
  history.y.assign(101, ay);
  return history;
}

} // namespace

TEST_CASE("a body that hangs freely from its recorder turns as the driven pendulum does, by the lever arm of the recorder") {
  // About the recorder's place, h above the centre: (I + m h^2) alpha = -m h a. The weight at the centre adds 1 kg and 1 kg m^2.
  const double a = 3.0, m = 201.0, inertia = 151.0;
  for (const double h : {0.0, 0.4, 1.5}) {
    const DrivenModel model = driven(bar_text(h, "free"));
    const double t = 1e-3; // the angle is then 1e-6: sines and centrifugal terms are gone to rounding of the check
    const double omega = final_value(model, constant(a, 0.0, t), "bar.omega");
    CHECK(omega / t == doctest::Approx(-m * h * a / (inertia + m * h * h)).epsilon(1e-5));
  }
}

TEST_CASE("a body that is held moves everywhere alike: the place of the recorder does not matter, its direction does") {
  const DriveHistory pulse = constant(2.0, -1.0, 0.1);
  for (const double h : {0.0, 1.5}) {
    const DrivenModel model = driven(bar_text(h, "held"));
    CHECK(final_value(model, pulse, "bar.vx") == doctest::Approx(0.2).epsilon(1e-9));
    CHECK(final_value(model, pulse, "bar.vy") == doctest::Approx(-0.1).epsilon(1e-9));
    CHECK(final_value(model, pulse, "bar.omega") == doctest::Approx(0.0));
  }
}

TEST_CASE("the poses of an event are those at its worst instant, when the limited speed is largest") {
  // a = a0 cos(πt/T): v = (a0 T/π) sin(πt/T) is largest at T/2, where x = (a0 T²/π²)(1 − cos(π/2)).
  constexpr double a0 = 2.0, duration = 0.1;
  DriveHistory pulse = constant(0.0, 0.0, duration);
  for (std::size_t i = 0; i < pulse.x.size(); ++i) pulse.x[i] = a0 * std::cos(std::numbers::pi * static_cast<double>(i) / 100.0);
  const std::string limit = "[[acceptance]]\nname = \"speed\"\nchannel = \"bar.vx\"\nwithin = 1.0\n";
  const DrivenModel model = driven(bar_text(1.5, "held") + limit);
  const Passage passage = VoyageModel(model).pass(pulse, Estimating::never);
  REQUIRE(passage.is_made);
  REQUIRE(passage.worst_instant.has_value());
  CHECK(*passage.worst_instant == doctest::Approx(0.5 * duration).epsilon(1e-3)); // the cosine is drawn by 100 chords
  REQUIRE(passage.poses.size() == 2);
  CHECK(passage.poses[0].body == "bar");
  CHECK(passage.poses[0].x == doctest::Approx(a0 * duration * duration / (std::numbers::pi * std::numbers::pi)).epsilon(2e-3)); // chords
  CHECK(passage.poses[0].angle == doctest::Approx(0.0));
}

TEST_CASE("axes of a record are mapped with their signs onto those of the marker, which may be turned") {
  RecordEvents record;
  for (const char axis : {'x', 'y', 'z'}) record.recording.layout.axes.push_back({axis, 0, "", 1.0, "", ""});
  RecordedEvent event;
  event.window.rate = 100.0;
  event.window.times = {0.0, 0.01};
  event.window.filtered = {std::vector<double>{1.0, 1.0}, std::vector<double>{2.0, 2.0}, std::vector<double>{3.0, 3.0}};
  Recorder recorder;
  recorder.x = "-z", recorder.y = "x";
  const DriveHistory straight = drive_history(record, event, recorder, 0.0);
  CHECK(straight.x[0] == doctest::Approx(-3.0));
  CHECK(straight.y[0] == doctest::Approx(1.0));
  const DriveHistory turned = drive_history(record, event, recorder, 1.5707963267948966); // its x points up, its y back
  CHECK(turned.x[0] == doctest::Approx(-1.0));
  CHECK(turned.y[0] == doctest::Approx(-3.0));
  recorder.drift = "line";
  CHECK(drive_history(record, event, recorder, 0.0).x[0] == doctest::Approx(0.0)); // a constant is all drift
  record.recording.layout.axes.pop_back();
  CHECK_THROWS_AS(static_cast<void>(drive_history(record, event, recorder, 0.0)), FileError);
}

TEST_CASE("a block on the driven tank slides as Newmark's sliding block does") {
  // Triangle of 0.6 g and 0.1 s; slides by quadrature of the rigid block. The feet's springs let it swing a little about its
  // length, which changes the share of each foot and not their sum: 1e-3 is left for the digits of the table.
  const struct {
    double mu, slide;
  } cases[] = {{0.2, 9.787e-3}, {0.3, 3.602e-3}, {0.4, 1.059e-3}};
  const DriveHistory pulse = triangles({0.6 * 9.81}, 0.1, 0.4);
  for (const auto& c : cases)
    CHECK(std::abs(final_value(driven(block_text(c.mu)), pulse, "floor.slide")) == doctest::Approx(c.slide).epsilon(1e-3));
  CHECK(std::abs(final_value(driven(block_text(0.61)), pulse, "floor.slide")) < 1e-12);
}

TEST_CASE("an event that ends while the block slides towards its limit is not decided") {
  // A triangle of 0.6 g and 0.1 s leaves 0.27 m/s, which friction of 0.02 g stops after some 0.2 m: 1.4 s, and 'settle' is 0.3 s.
  const DriveHistory pulse = triangles({0.6 * 9.81}, 0.1, 0.0);
  const auto passed = [&](double within, const DriveHistory& history) {
    const DrivenModel model =
        driven(block_text(0.02, "[[acceptance]]\nname = \"stays\"\nchannel = \"floor.slide\"\nwithin = " + std::to_string(within) + "\n"));
    return VoyageModel(model).pass(history, Estimating::never);
  };
  CHECK(passed(0.15, pulse).still_grows.find("'stays' is met so far") == 0);
  CHECK(passed(0.5, pulse).still_grows == "");
  DriveHistory goes_on = pulse;
  goes_on.goes_on = true;
  CHECK(passed(0.15, goes_on).still_grows == ""); // the next event shows it
}

TEST_CASE("what else drives the recorder's body is refused, unless the record takes its place") {
  const std::string brake = "[[signal]]\nname = \"brake\"\nkind = \"haversine\"\npeak = -5.0\nduration = 0.1\n[[element]]\nkind = "
                            "\"prescribed_motion\"\nname = \"brake\"\na = \"tank\"\nsignal = \"brake\"\n";
  CHECK_THROWS_AS(static_cast<void>(driven(block_text(0.3, brake))), ModelError);
  std::string replaced = block_text(0.3, brake + "[[acceptance]]\nname = \"brake force\"\nchannel = \"brake.reaction\"\nwithin = 1e6\n");
  replaced.replace(replaced.find("settle = 0.3"), 12, "settle = 0.3\nreplaces = [\"brake\"]");
  const DrivenModel model = driven(replaced);
  CHECK(model.notes.size() == 2); // the drive, and the acceptance that looked at it
  const DriveHistory pulse = triangles({0.6 * 9.81}, 0.1, 0.4);
  CHECK(final_value(model, pulse, "floor.slide") == final_value(driven(block_text(0.3)), pulse, "floor.slide"));
}

TEST_CASE("the model's own speed is left out: a machine on arrival does not move when the record begins") {
  std::string text = block_text(0.3);
  text.replace(text.find("end = 1.0"), 9, "end = 1.0\nvelocity = [2.0, 0.0]");
  const DriveHistory pulse = triangles({0.6 * 9.81}, 0.1, 0.4);
  CHECK(final_value(driven(text), pulse, "floor.slide") == final_value(driven(block_text(0.3)), pulse, "floor.slide"));
}

namespace {

// A core on a driven tank, with how the record or a signal of the model presses its stack.
DrivenModel pressed_core(const Folder& folder, const std::string& recorder, const std::string& signal) {
  const std::string file = folder.file("pressed.toml");
  write(file, "format = 1\nextends = \"" STEPLAP_MODELS "/layouts/three_limb_humping.toml\"\n[[core]]\nname = "
              "\"core\"\ntransverse_acceleration = \"side\"\ntransverse_support = \"front\"\n" +
                  signal +
                  "[[marker]]\nname = \"lid\"\nbody = \"tank\"\nat = [0.0, 3.0]\n[[recorder]]\nname = \"recorder\"\nmarker = \"lid\"\n" +
                  "x = \"x\"\ny = \"z\"\nreplaces = [\"drive\", \"front axles\", \"rear axles\"]\nsettle = 0.2\n" + recorder);
  return read_driven_model(file);
}

double least_margin(const DrivenModel& model, const std::vector<double>& along, const std::vector<double>& across) {
  DriveHistory history;
  history.step = 1e-3;
  history.x = along, history.y.assign(along.size(), 0.0);
  history.across = across;
  const Passage passage = VoyageModel(model).pass(history, Estimating::never);
  REQUIRE_MESSAGE(passage.is_made, passage.reason);
  double least = 1e300;
  for (const JointPassage& joint : passage.joints) least = std::min(least, joint.margin);
  // The way of the samples sees the same axis.
  const VoyageOutcome outcome = VoyageRunner(model, {history, history}, {}).run({});
  REQUIRE_MESSAGE(outcome.summary.unknown.empty(), outcome.summary.unknown);
  CHECK(outcome.summary.least_margin <= least * (1.0 + 1e-3)); // the same event again, from where the first one left it
  return least;
}

} // namespace

TEST_CASE("the record's third axis presses the sheets of a core as a signal of the model does") {
  const Folder folder;
  const std::vector<double> along = triangles({2.0}, 0.1, 0.1).x, across = triangles({8.0}, 0.1, 0.1).x;
  std::vector<double> against = across;
  for (double& value : against) value = -value;
  const std::string none = "[[signal]]\nname = \"side\"\nkind = \"constant\"\nvalue = 0.0\n";
  const std::string pulse = "[[signal]]\nname = \"side\"\nkind = \"triangle\"\npeak = 8.0\nduration = 0.1\n";
  const DrivenModel recorded = pressed_core(folder, "across = \"y\"\n", none);
  CHECK(recorded.notes.back().find("'side' across 'core'") != std::string::npos);
  const double with_record = least_margin(recorded, along, across), mirrored = least_margin(recorded, along, against);
  const double with_signal = least_margin(pressed_core(folder, "", pulse), along, {});
  CHECK(with_record == doctest::Approx(with_signal).epsilon(1e-6)); // two runs of one tolerance
  CHECK(with_record > 1.001 * mirrored);                            // held in front it is pressed by one direction, and eased by the other
  // An event that is cut in two while it presses: no jump, which the pressure of sheets cannot have.
  const auto part = [&](std::size_t from, std::size_t end) {
    DriveHistory history;
    history.step = 1e-3;
    history.x.assign(along.begin() + static_cast<std::ptrdiff_t>(from), along.begin() + static_cast<std::ptrdiff_t>(end));
    history.across.assign(across.begin() + static_cast<std::ptrdiff_t>(from), across.begin() + static_cast<std::ptrdiff_t>(end));
    history.y.assign(history.x.size(), 0.0);
    return history;
  };
  std::vector<DriveHistory> halves{part(0, 50), part(50, along.size())};
  halves[0].goes_on = true;
  CHECK(VoyageModel(recorded).pass(halves[0], Estimating::never).is_made);
  const VoyageOutcome halved = VoyageRunner(recorded, halves, {}).run({});
  CHECK(halved.summary.unknown == "");
  CHECK(halved.summary.least_margin == doctest::Approx(with_record).epsilon(0.02)); // one sample of 1 ms later
  // The axis keeps the sign of the record, and an axis that lies in the plane already is refused.
  RecordEvents record;
  for (const char axis : {'x', 'y', 'z'}) record.recording.layout.axes.push_back({axis, 0, "", 1.0, "", ""});
  RecordedEvent event;
  event.window.rate = 100.0;
  event.window.times = {0.0, 0.01};
  event.window.filtered = {std::vector<double>{1.0, 1.0}, std::vector<double>{2.0, 2.0}, std::vector<double>{3.0, 3.0}};
  Recorder recorder;
  recorder.x = "x", recorder.y = "z", recorder.across = "-y";
  CHECK(drive_history(record, event, recorder, 0.3).across == std::vector<double>{-2.0, -2.0});
  recorder.across = "none";
  CHECK(drive_history(record, event, recorder, 0.3).across.empty());
  CHECK_THROWS_AS(static_cast<void>(pressed_core(folder, "across = \"-z\"\n", none)), ModelError);
  CHECK_THROWS_AS(static_cast<void>(driven([] {
                    std::string text = block_text(0.3);
                    return text.replace(text.find("settle = 0.3"), 12, "settle = 0.3\nacross = \"y\"");
                  }())),
                  ModelError);
}

TEST_CASE("the reference of 'recorder' has the table of a model and the signal of the same name") {
  const std::vector<KindReference> both = kind_references(program_catalogue(), "recorder");
  REQUIRE(both.size() == 2);
  CHECK(both[0].heading != both[1].heading);
  CHECK((both[0].heading == "[[recorder]]" || both[1].heading == "[[recorder]]"));
}
