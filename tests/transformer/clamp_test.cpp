// What clamps a core: the pressure that the forces of bolts make at corners and packets, in equilibrium with them; what is left of a preload.
#include "elements/step_lap/step_lap_interface.h"
#include "mbd/io/reader.h"
#include "mbd/model/completion.h"
#include "mbd/model/model_path.h"
#include "transformer/catalog.h"
#include "transformer/core/clamp.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace steplap;

namespace {

// Two limbs 2.5 m apart and 0.5 m wide: yokes 3.0 m long and 0.5 m high.
constexpr double k_length = 3.0, k_height = 0.5;

std::string core_text(const std::string& section, const std::string& pressed) {
  return R"([[body]]
name = "active part"
mass = 47000
inertia = 65200
position = [0.3, 1.95]
[[body]]
name = "front limb"
position = [1.55, 1.95]
[[body]]
name = "back limb"
position = [-0.95, 1.95]
[[core]]
name = "core"
active_part = "active part"
limbs = ["front limb", "back limb"]
core_height = 3.3
stacking_factor = 0.96
sheet_thickness = "0.27 mm"
sheets_per_layer = 1
steps = 5
step_pitch = "5 mm"
pitch_direction = "across"
book = "saw_tooth"
clearance = "0.5 mm"
static_friction = 0.2
)" + section +
         pressed;
}
const std::string k_one_packet = "limb_width = 0.5\nyoke_height = 0.5\nstack_depth = 0.4\n";
const std::string k_stepped = "packets = [[0.4, 0.1], [0.5, 0.2], [0.3, 0.1]]\nyoke_heights = [0.4, 0.5, 0.3]\n";

std::string clamp(const std::string& fields, const std::string& name = "bolts") {
  return "[[clamp]]\nname = \"" + name + "\"\ncore = \"core\"\n" + fields;
}
Model model_of(const std::string& pressed, const std::string& section = k_one_packet) {
  return parse_model("gravity = [0.0, 0.0]\n[simulation]\nend = 0.01\n" + core_text(section, pressed), "core.toml", transformer_catalog());
}
std::string refusal(const std::string& pressed, const std::string& section = k_one_packet) {
  try {
    static_cast<void>(model_of(pressed, section));
  } catch (const ModelError& error) {
    return error.diagnostics().front().message;
  }
  return "nothing is wrong";
}
bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::vector<const StepLapInterface*> interfaces_of(const Model& model, const std::string& part = "") {
  std::vector<const StepLapInterface*> found;
  for (const ElementEntry& entry : model.elements)
    if (const auto* face = dynamic_cast<const StepLapInterface*>(entry.element.get()); face && has(face->name, part)) found.push_back(face);
  return found;
}
double pressure_at(const Model& model, const std::string& part) {
  const auto faces = interfaces_of(model, part);
  REQUIRE_FALSE(faces.empty());
  return faces.front()->pressure;
}

} // namespace

TEST_CASE("bolts spread about the middle press as the pressure that is their force over the yoke's face") {
  const Model by_bolts = model_of(clamp("count = 6\npreload = \"25 kN\"\n"));
  const Model by_pressure = model_of("pressure = \"0.1 MPa\"\n"); // 6 · 25 kN/(3 m · 0.5 m)
  const auto one = interfaces_of(by_bolts), other = interfaces_of(by_pressure);
  REQUIRE(one.size() == other.size());
  REQUIRE(one.size() >= 4);
  for (std::size_t i = 0; i < one.size(); ++i)
    CHECK(one[i]->pressure == doctest::Approx(other[i]->pressure).epsilon(1e-14)); // rounding of a product
  // The same where each is said, in whatever order and wherever they are, as long as they balance about the middle.
  const Model placed = model_of(clamp("places = [1.4, -0.9, 0.2, -0.7]\npreload = 37.5e3\n"));
  CHECK(pressure_at(placed, "front limb joint") == doctest::Approx(1e5).epsilon(1e-14));
  CHECK(pressure_at(placed, "back limb joint") == doctest::Approx(1e5).epsilon(1e-14));
}

TEST_CASE("the pressure along a yoke is in equilibrium with forces that stand to one side") {
  const Model model = model_of(clamp("places = [0.8, 0.1]\npreload = 30e3\n", "upper") + "at = \"top\"\n" +
                               clamp("places = [-0.4]\npreload = 90e3\n", "lower") + "at = \"bottom\"\n");
  const Core& core = dynamic_cast<const Core&>(*model.tables.front().table);
  for (const bool is_top : {true, false}) {
    const YokeClamping yoke = clamping_of(core, model, is_top);
    CHECK(yoke.length == doctest::Approx(k_length));
    double force = 0.0, moment = 0.0; // Gauss with two places is exact for p and for p x
    for (const double x : {-0.5 * k_length / std::sqrt(3.0), 0.5 * k_length / std::sqrt(3.0)}) {
      const double p = yoke.pressure() * yoke.share(x);
      force += 0.5 * k_length * k_height * p;
      moment += 0.5 * k_length * k_height * p * x;
    }
    CHECK(force == doctest::Approx(is_top ? 60e3 : 90e3).epsilon(1e-13));
    CHECK(moment == doctest::Approx(is_top ? 30e3 * 0.9 : -90e3 * 0.4).epsilon(1e-13));
    // Interfaces have what there is at the axis of their limb.
    const std::string end = is_top ? ", top" : ", bottom";
    CHECK(pressure_at(model, "front limb joint" + end) == doctest::Approx(yoke.pressure() * yoke.share(1.25)).epsilon(1e-13));
    CHECK(pressure_at(model, "back limb joint" + end) == doctest::Approx(yoke.pressure() * yoke.share(-1.25)).epsilon(1e-13));
  }
}

TEST_CASE("each packet bears all of the force over the height of its own yoke") {
  const Model model = model_of(clamp("count = 4\npreload = 25e3\n"), k_stepped);
  const std::pair<const char*, double> packets[] = {{"packet 1", 0.4}, {"packet 2", 0.5}, {"packet 3", 0.3}};
  for (const auto& [part, height] : packets) {
    double least = 1e9, most = 0.0;
    for (const StepLapInterface* face : interfaces_of(model))
      if (face->part == part && !has(face->name, "between")) {
        least = std::min(least, face->pressure);
        most = std::max(most, face->pressure);
      }
    CAPTURE(part);
    // Where packets meet there is the mean of both; of the others one has this packet's own.
    const double own = 100e3 / (k_length * height);
    CHECK(least <= own * (1 + 1e-12));
    CHECK(most >= own * (1 - 1e-12));
  }
  CHECK(pressure_at(model_of(clamp("count = 4\npreload = 25e3\n"), k_stepped + "pressure_shares = [1.0, 1.0, 1.0]\n"),
                    "front limb joint") == doctest::Approx(100e3 / (k_length * k_height)).epsilon(1e-13)); // shares that are given stay
}

TEST_CASE("what relaxation, settling and warmth leave of a preload") {
  // Bolt and stack in series: 1/k = 1/2e8 + 1/3e8. A stack that grows by 10 µm more than the bolt stretches both by so much.
  const std::string series = "count = 1\npreload = 150e3\nstiffness = 2e8\nstack_stiffness = 3e8\n";
  const double k = 1.2e8;
  const auto pressure_of = [&](const std::string& more) { return pressure_at(model_of(clamp(series + more)), "front limb joint"); };
  CHECK(pressure_of("") == doctest::Approx(150e3 / 1.5).epsilon(1e-13));
  CHECK(pressure_of("relaxation = 0.3\n") == doctest::Approx(0.7 * 150e3 / 1.5).epsilon(1e-13));
  CHECK(pressure_of("settling = \"0.2 mm\"\n") == doctest::Approx((150e3 - k * 0.2e-3) / 1.5).epsilon(1e-12));
  CHECK(pressure_of("warming = 50\nexpansion = 7e-6\nstack_expansion = 12e-6\n") ==
        doctest::Approx((150e3 + k * 0.4 * 5e-6 * 50) / 1.5).epsilon(1e-12));
  CHECK(pressure_of("warming = -40\nexpansion = 7e-6\nlength = 0.5\n") ==
        doctest::Approx((150e3 - k * 0.5 * 5e-6 * 40) / 1.5).epsilon(1e-12));
  // Steel bolts in a steel stack know no warmth.
  CHECK(pressure_of("warming = 80\nexpansion = 12e-6\n") == doctest::Approx(150e3 / 1.5).epsilon(1e-13));
}

TEST_CASE("a preload is varied as any number, and the corners follow") {
  Model given = parse_given_model("gravity = [0.0, 0.0]\n[simulation]\nend = 0.01\n" +
                                      core_text(k_one_packet, clamp("count = 6\npreload = \"25 kN\"\n")),
                                  "core.toml", transformer_catalog());
  set_value(given, "clamp.bolts.preload", 50e3);
  CHECK(pressure_at(completed(given), "front limb joint") == doctest::Approx(2e5).epsilon(1e-14));
}

TEST_CASE("what is wrong with clamps is said") {
  CHECK(has(refusal(""), "core 'core': needs 'pressure' above 0, that clamps its sheets (in Pa), or a [[clamp]] with what presses them"));
  CHECK(has(refusal("pressure = 1e5\n" + clamp("preload = 1e5\n")), "'pressure' and clamp 'bolts' say the same: give one of them"));
  CHECK(has(refusal(clamp("preload = 1e5\nat = \"top\"\n")), "the bottom yoke of core 'core' is pressed by nothing"));
  CHECK(has(refusal(clamp("preload = 1e5\nplaces = [1.6]\n")), "the place 1.6 m lies beyond the yoke, which reaches 1.5 m to either side"));
  CHECK(has(refusal(clamp("preload = 1e5\nplaces = [0.6]\n")),
            "beyond a sixth of its length: at its other end nothing would press the sheets"));
  CHECK(has(refusal(clamp("preload = 1e5\nplaces = [0.3, 0.1]\ncount = 3\n")), "'count' says 3 clamps, 'places' gives 2"));
  CHECK(has(refusal(clamp("preload = 1e4\nstiffness = 2e8\nstack_stiffness = 2e8\nsettling = 0.001\n")),
            "nothing is left (-90000 N): it is loose"));
  CHECK(has(refusal(clamp("preload = 1e4\nsettling = 0.001\n")), "needs 'stiffness' and 'stack_stiffness', by which it changes the force"));
  CHECK(has(refusal(clamp("preload = 1e4\nstiffness = 2e8\n")), "'stiffness' and 'stack_stiffness' are in series: give both"));
  CHECK(has(refusal(clamp("preload = 1e5\nstiffness = 2e8\nstack_stiffness = 2e8\nexpansion = 6e-6\nwarming = \"20 celsius\"\n")),
            "look like a temperature and not like a difference"));
  CHECK(has(refusal("pressure = 1e5\n[[clamp]]\nname = \"bolts\"\ncore = \"cor\"\npreload = 1e5\n"),
            "there is no core 'cor' (did you mean 'core'?)"));
  // Fields out of their ranges are told once, as such; a name is used once.
  CHECK(refusal(clamp("preload = -1e5\n")) == "'preload' of clamp 'bolts' must be greater than 0 N, got -1e+05");
  CHECK(refusal(clamp("preload = 1e5\nrelaxation = 1.0\n")) == "'relaxation' of clamp 'bolts' must be at most 0.99, got 1");
  CHECK(refusal(clamp("preload = inf\n")) == "'preload' of clamp 'bolts' must be finite, got inf");
  CHECK(refusal(clamp("preload = 1e5\n") + clamp("preload = 2e5\n")) == "clamp named 'bolts' exists already: choose another name");
  CHECK(has(refusal(clamp("preload = 1e5\nyoke_length = 2.4\n")),
            "forces that press on 2.4 m do not reach the axis of the limb 1.25 m from the middle"));
}
