// What a run keeps to save work, against the same runs without: stages made by machine code (mbd/dynamics/stage_program.h), layouts that
// come back (layout_store.h). All bytes of the rows written, of
// the final state, of the events and counts. Random scenes, scenes on rails, and every model of models/, with each explicit method:
// whatever an element's template does in another order, a branch that is no condition of the tape, a by-product that somebody
// reads behind a stage shows in the last bits, which steps and events then amplify.
#include "mbd/io/reader.h"
#include "mbd/rest/assembly.h"
#include "mbd/simulation/simulation.h"
#include "mbd/tape/machine_code.h"
#include "tests/random/random_scene.h"
#include "tests/sanitized.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <map>
#include <string>
#include <unistd.h>
#include <vector>

using namespace steplap;
using namespace steplap::random;

namespace {

#ifdef STEPLAP_TESTS_SANITIZED
constexpr std::uint64_t k_scenes = 40; // ten times as slow
#else
constexpr std::uint64_t k_scenes = 300;
#endif
constexpr double k_longest = 0.1; // s, of models
constexpr long k_most_evaluations = 40'000;

struct Outcome {
  std::vector<std::uint64_t> bits;
  std::vector<std::pair<std::uint64_t, EventKind>> events;
  std::string failure;
  long evaluations = 0, coded = 0;
};

Outcome outcome(const System& system, const State& start, SimulationOptions options) {
  options.channels.clear();
  Outcome found;
  const auto keep = [&found](double x) { found.bits.push_back(std::bit_cast<std::uint64_t>(x)); };
  try {
    Simulation simulation(system, start, options);
    while (simulation.statistics().evaluations < k_most_evaluations && simulation.advance()) {}
    const RunResult run = std::move(simulation).result();
    for (const Channel& channel : system.channels)
      for (const double x : run.trajectory->series(channel.name)) keep(x);
    for (const double x : run.final_state.q) keep(x);
    for (const double x : run.final_state.v) keep(x);
    for (const Event& event : run.events) found.events.emplace_back(std::bit_cast<std::uint64_t>(event.t), event.kind);
    found.evaluations = run.statistics.evaluations;
    found.coded = run.statistics.coded_stages;
  } catch (const std::exception& error) {
    found.failure = error.what();
  }
  return found;
}

void check_same(const Outcome& a, const Outcome& b) {
  CHECK(a.bits == b.bits);
  CHECK(a.events == b.events);
  CHECK(a.failure == b.failure);
  CHECK(a.evaluations == b.evaluations);
}

Outcome outcome(const System& system, const State& start, SimulationOptions options, StageCode code) {
  options.stage_code = code;
  return outcome(system, start, options);
}

SimulationOptions options_for(const Model& model, const std::string& method, double end) {
  SimulationOptions options = options_of(model);
  options.integrator = method;
  options.end = end;
  options.output_step = end / 50.0;
  if (method == "rk4" && options.settings.step <= 0.0) options.settings.step = end / 500.0;
  return options;
}

// How many stages were made by code.
long compare(const Model& model, const std::string& method, double end) {
  const auto system = compile(model);
  const State start = assembled_start(*system, assemble(model, *system));
  const SimulationOptions options = options_for(model, method, end);
  const Outcome plain = outcome(*system, start, options, StageCode::never), coded = outcome(*system, start, options, StageCode::at_once);
  CHECK(plain.coded == 0);
  check_same(coded, plain);
  return coded.coded;
}

// Layouts given up at once, or never, with code as it pays. How many events there were.
std::size_t compare_stores(const Model& model, const std::string& method, double end) {
  const auto system = compile(model);
  const State start = assembled_start(*system, assemble(model, *system));
  SimulationOptions options = options_for(model, method, end);
  options.kept_layouts = 1000;
  const Outcome all = outcome(*system, start, options);
  for (const std::size_t kept : {1U, 2U}) {
    options.kept_layouts = kept;
    check_same(outcome(*system, start, options), all);
  }
  return all.events.size();
}

// Scenes by seed, each with one of three methods; what cannot be compiled (a drive that does not begin where the body is) is left out.
template <class Check> void on_random_scenes(const Check& check) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("steplap_code_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const char* const methods[] = {"dop853", "tsit5", "rk4"};
  std::vector<std::uint64_t> seeds;
  const auto take = [&seeds](std::uint64_t first, std::uint64_t count) {
    for (std::uint64_t seed = first; seed < first + count; ++seed) seeds.push_back(seed);
  };
  take(1, k_scenes);
  take(3001, k_scenes / 6);  // with buffers, brakes and forces by formula
  take(6001, k_scenes / 6);  // with wheels and skates
  take(12001, k_scenes / 6); // with belts, bands, cams, clutches, gears with losses, beams
  for (const std::uint64_t seed : seeds) {
    const Scene scene = seed % 4 == 0 ? random_friction_scene(seed) : random_scene(seed);
    const std::string method = methods[seed % 3];
    CAPTURE(seed);
    CAPTURE(method);
    try {
      check(model_of(scene, folder.string()), method, scene.end);
    } catch (const ModelError&) {}
  }
  std::filesystem::remove_all(folder);
}

} // namespace

TEST_CASE("random scenes run to the same bytes with and without machine code") {
  if (!MachineCode::is_available()) return;
  long scenes_coded = 0;
  on_random_scenes(
      [&](const Model& model, const std::string& method, double end) { scenes_coded += compare(model, method, end) > 0 ? 1 : 0; });
  CHECK(scenes_coded > static_cast<long>(k_scenes / 8)); // else next to nothing was compared
}

TEST_CASE("random scenes run to the same bytes however few layouts are kept") {
  long scenes_with_events = 0;
  on_random_scenes([&](const Model& model, const std::string& method, double end) {
    scenes_with_events += compare_stores(model, method, end) > 2 ? 1 : 0;
  });
  CHECK(scenes_with_events > static_cast<long>(k_scenes / 4));
}

// Models that have no stage by machine code as far as they are run here, and why (docs/explanation/machine_code.md).
const std::map<std::string, std::string> k_without_code = {
    {"four_bar_40.toml", "more than 100 coordinates"},
    {"redundant_loop.toml", "rows that depend on each other"},
    {"chain.toml", "the same, as long as all sticks"},
    {"two_feet.toml", "the same, as long as both feet stick"},
};

TEST_CASE("every model runs to the same bytes with and without machine code, and however few layouts are kept") {
  long models = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(STEPLAP_MODELS)) {
    const std::string file = entry.path().string();
    if (entry.path().extension() != ".toml" || entry.path().parent_path().filename() == "studies") continue;
    if (file.ends_with("brick_wall.toml") || file.ends_with("pile.toml")) continue; // stiff: half a minute
    CAPTURE(file);
    const Model model = read_model(file, transformer_catalog());
    ++models;
    const double end = std::min(model.simulation.end, k_longest);
    static_cast<void>(compare_stores(model, "dop853", end));
    if (MachineCode::is_available())
      CHECK((compare(model, "dop853", end) > 0) == (k_without_code.count(entry.path().filename().string()) == 0));
  }
  CHECK(models > 50);
}

namespace {

const std::string k_two_bodies = R"(
[simulation]
end = 0.2
[output]
step = 0.01
[parameters]
tau = 0.02
[[state]]
name = "flow"
unit = "N"
start = 3.0
scale = 10.0
rate = "('40 N' * exp(-abs(low.x) / '1 m') - flow) / tau / '1 s'"
[[signal]]
name = "grip"
kind = "harmonics"
offset = 1.5
amplitudes = [0.5]
frequencies = [7.0]
[[body]]
name = "low"
mass = 3.0
inertia = 0.2
velocity = [0.8, 0.0]
[[body]]
name = "high"
mass = 1.0
inertia = 0.1
position = [0.3, 0.6]
velocity = [0.2, 0.4]
[[element]]
kind = "prismatic"
name = "guide"
a = "low"
b = "ground"
)";

// Stages by code, of all, in a run whose bytes are those of one without.
double coded_share(const std::string& element) {
  const Model model = parse_model(k_two_bodies + "[[element]]" + element, "two bodies", transformer_catalog());
  const auto system = compile(model);
  const State start = assembled_start(*system, assemble(model, *system));
  const SimulationOptions options = options_for(model, "dop853", model.simulation.end);
  const Outcome plain = outcome(*system, start, options, StageCode::never), coded = outcome(*system, start, options, StageCode::at_once);
  check_same(coded, plain);
  CHECK(coded.failure == "");
  return static_cast<double>(coded.coded) / static_cast<double>(std::max(coded.evaluations, 1L));
}

const std::pair<const char*, const char*> k_first_odd_elements[] = {
    {"a brake that a signal presses", R"(
kind = "joint_friction"
name = "brake"
a = "low"
b = "ground"
coordinate = "x"
holds = 2.0
signal = "grip"
)"},
    {"a force by a state", R"(
kind = "force"
name = "push"
a = "low"
coordinate = "x"
formula = "flow"
)"},
    {"a force with an exponential and a root", R"(
kind = "force"
name = "push"
a = "low"
coordinate = "x"
formula = "'5 N' * exp(-value / '1 m') - '2 N' * (1 + (rate / '1 m/s')^2)^0.3"
)"},
    {"a damper between a driven body and another", R"(
kind = "prescribed_motion"
name = "drive"
a = "high"
coordinate = "x"
signal = "grip"
as = "velocity"
[[element]]
kind = "spring_damper"
name = "strut"
a = "high"
b = "low"
stiffness = 50.0
damping = 8.0
)"},
    {"a force along y between two bodies", R"(
kind = "force"
name = "push"
a = "high"
b = "low"
coordinate = "y"
formula = "'-3 N' * value / '1 m' - '2 N' * rate / '1 m/s'"
)"},
    {"a belt", R"(
kind = "belt"
name = "belt"
a = "low"
b = "high"
radius_a = 0.1
radius_b = 0.15
friction_a = 0.3
friction_b = 0.4
stiffness = 900.0
damping = 2.0
pretension = 30.0
)"},
};

const std::pair<const char*, const char*> k_next_odd_elements[] = {
    {"a band", R"(
kind = "band"
name = "band"
a = "high"
b = { body = "ground", at = [-1.0, 1.0] }
drum = { body = "low", at = [0.0, 0.0] }
radius = -0.2
friction = 0.3
stiffness = 900.0
damping = 2.0
pretension = 30.0
)"},
    {"a cam", R"(
kind = "cam"
name = "cam"
a = "low"
cam = "high"
axis = [1.0, 0.0]
formula = "sin(value) * '0.05 m'"
holds = true
stiffness = 2000.0
damping = 3.0
)"},
    {"a tyre", R"(
kind = "tyre"
name = "tyre"
a = "high"
radius = 0.61
stiffness = 4e3
damping = 20.0
friction = 0.8
slip_stiffness = 300.0
relaxation_length = 0.2
tread_damping = 5.0
)"},
    {"a part of a beam", R"(
kind = "beam_part"
name = "beam"
a = "high"
b = { body = "low", at = [-0.3, 0.6] }
length = 0.3
bending_stiffness = 20.0
axial_stiffness = 5e3
damping_time = 0.01
)"},
    {"a gear with losses", R"(
kind = "lossy_gear"
name = "gear"
a = "high"
b = "low"
ratio = 3.0
efficiency = 0.8
stiffness = 50.0
damping = 0.5
)"},
};

const std::pair<const char*, const char*> k_last_odd_elements[] = {
    {"a one-way clutch", R"(
kind = "freewheel"
name = "clutch"
a = "high"
b = "low"
holds = 5.0
drags = 0.1
[[element]]
kind = "load"
name = "turning"
at = "high"
couple = 2.0
)"},
    {"a skate that slides", R"(
kind = "skate"
name = "skate"
a = "high"
axis = [0.6, 0.8]
grip = 0.5
drags = 0.4
)"},
    {"a tie that may break", R"(
kind = "tie"
name = "strap"
a = "low"
b = "high"
stiffness = 900.0
strength = 800.0
)"},
    {"polygons that press and rub", R"(
kind = "polygon_contact"
name = "pad"
a = "high"
b = "low"
stiffness = 1e7
outline_a = [[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]]
outline_b = [[-1.0, -0.5], [1.0, -0.5], [1.0, 0.39], [-1.0, 0.39]]
static_friction = 0.4
)"},
};

} // namespace

// What has no template of its equations is called, what hangs on time or on a state of the model is an input.
TEST_CASE("odd elements cost themselves only") {
  if (!MachineCode::is_available()) return;
  const auto check = [](const auto& elements) {
    for (const auto& [what, element] : elements) {
      CAPTURE(what);
      CHECK(coded_share(element) > 0.3);
    }
  };
  check(k_first_odd_elements);
  check(k_next_odd_elements);
  check(k_last_odd_elements);
}

namespace {

// A spring along x from the ground to a body, without a template, that gives up where the body is beyond `limit`. It says when: a
// stage by code that swallowed what is thrown would be followed by one at another time.
struct Picky : Element {
  std::string body;
  double limit = 0.0;
};

class PickyGroup final : public ForceGroup {
public:
  struct BoundedBody {
    int body = 0;
    double limit = 0.0;
  };
  std::vector<BoundedBody> entries;

  void add_forces(Evaluation& e) const override {
    for (const BoundedBody& entry : entries) {
      const double x = e.motion[entry.body].x;
      if (x > entry.limit) throw NumericalFailure("the spring gives up at " + std::to_string(1e9 * e.t) + " ns");
      e.force[entry.body].fx -= 50.0 * x;
    }
  }
  [[nodiscard]] double potential(const Motion<double>* motion) const override {
    double sum = 0.0;
    for (const BoundedBody& entry : entries) sum += 25.0 * motion[entry.body].x * motion[entry.body].x;
    return sum;
  }
  void add_jacobian(const Evaluation&, std::vector<PairJacobian>&) const override {}
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const BoundedBody& entry : entries) is_used[static_cast<std::size_t>(entry.body)] = 1;
  }
};

const ElementKind& picky_kind() {
  static const ElementKind kind = [] {
    ElementKind k;
    k.name = "picky";
    k.fields.add("body", &Picky::body).as(FieldType::body).required().doc("body");
    k.fields.add("limit", &Picky::limit).required().doc("farthest place");
    k.holds<Picky>();
    k.compile = [](const Element& element, SystemBuilder& builder) {
      const auto& e = static_cast<const Picky&>(element);
      builder.group<PickyGroup>().entries.push_back({builder.body(e.body), e.limit});
    };
    return k;
  }();
  return kind;
}

Outcome picky_outcome(const std::string& limit, StageCode code) {
  Catalogue catalogue = transformer_catalog();
  catalogue.elements.push_back(&picky_kind());
  const Model model = parse_model(
      k_two_bodies + "[[element]]\nkind = \"picky\"\nname = \"spring\"\nbody = \"low\"\nlimit = " + limit + "\n", "picky", catalogue);
  const auto system = compile(model);
  return outcome(*system, system->initial_state(), options_for(model, "dop853", model.simulation.end), code);
}

} // namespace

TEST_CASE("what an element throws inside machine code comes out as it does without") {
  if (!MachineCode::is_available()) return;
  const Outcome whole = picky_outcome("10.0", StageCode::at_once);
  CHECK(whole.coded > whole.evaluations / 3);
  check_same(whole, picky_outcome("10.0", StageCode::never));
  const Outcome thrown = picky_outcome("0.1", StageCode::at_once); // from 0 at 0.8 m/s
  CHECK(thrown.failure.find("the spring gives up") != std::string::npos);
  check_same(thrown, picky_outcome("0.1", StageCode::never));
}

// Two stages of each step are looked at for the paper's limbs, which hang on their sheets. What is evaluated as ever is fewer than
// that alone: ends of steps, the few evaluations of an event, and the first stages in each set of modes.
TEST_CASE("stages at which merged joints are looked at are made by machine code too") {
  if (!MachineCode::is_available()) return;
  const Model model = read_model(STEPLAP_MODELS "/paper/interference.toml", transformer_catalog());
  const auto system = compile(model);
  SimulationOptions options = options_of(model);
  options.integrator = "dop853";
  options.settings = {.tolerance = 1e-9};
  options.output_step = 0.0;
  options.has_extremes = false;
  options.stage_code = StageCode::at_once;
  const RunStatistics run = simulate(*system, system->initial_state(), options).statistics;
  CHECK(run.steps > 100);
  CHECK(run.evaluations - run.coded_stages < 2 * run.steps);
}

// Their joints merge bodies on both sides of drives, stops and sticking feet: rows on clusters of several bodies. What is evaluated without
// code is ends of steps, events, and the first stages in each set of modes.
TEST_CASE("transformers on vehicles run by machine code, whose rows are on merged clusters") {
  if (!MachineCode::is_available()) return;
  for (const char* const file : {"/layouts/three_limb_bump.toml", "/layouts/five_limb_bump.toml"}) {
    CAPTURE(file);
    const Model model = read_model(STEPLAP_MODELS + std::string(file), transformer_catalog());
    const auto system = compile(model);
    const State start = assembled_start(*system, assemble(model, *system));
    const Outcome coded = outcome(*system, start, options_for(model, "dop853", model.simulation.end), StageCode::at_once);
    CHECK(coded.evaluations > 5000);
    CHECK(coded.coded > coded.evaluations * 2 / 3);
  }
}

// Tapes that runs before have written are not written once more: of another sample of the scene constants alone are gathered.
TEST_CASE("what runs before have made known serves other samples, to the same bytes") {
  if (!MachineCode::is_available()) return;
  constexpr int k_rounds = 160; // in which modes that last for 25 stages have come often enough for code of their own
  for (int round = 0; round < k_rounds; ++round)
    for (const char* const file : {"/paper/no_interference.toml", "/paper/interference.toml"}) {
      CAPTURE(round);
      const Model model = read_model(STEPLAP_MODELS + std::string(file), transformer_catalog());
      const auto system = compile(model); // each time another, as in a study
      SimulationOptions options = options_of(model);
      options.integrator = "dop853";
      options.settings = {.tolerance = 1e-6};
      options.has_extremes = false;
      options.output_step = 0.05;
      const State start = system->initial_state();
      const Outcome plain = outcome(*system, start, options, StageCode::never);
      const Outcome coded = outcome(*system, start, options, StageCode::when_it_pays);
      check_same(coded, plain);
      if (round == k_rounds - 1) CHECK(coded.coded > coded.evaluations * 3 / 4);
    }
}
