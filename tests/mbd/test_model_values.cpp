// Models as values: copies of their own, fields by paths, completed as from a file, and systems of one model with many
// values, side by side.
#include "elements/load.h"
#include "elements/spring_damper.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/io/reader.h"
#include "mbd/model/completion.h"
#include "mbd/model/model_building.h"
#include "mbd/model/model_path.h"
#include "mbd/rest/assembly.h"
#include "mbd/simulation/simulation.h"
#include "mbd/system/instance.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <numbers>
#include <thread>

using namespace steplap;

namespace {

const std::string k_paper = std::string(STEPLAP_MODELS) + "/paper/no_interference.toml";

// A pendulum on a slanted marker, placed by its joint's angle, with a spring to a body's centre, a table and a core's
// worth of kinds of fields.
const char* k_scene = R"(
title = "values"
gravity = [0.0, -9.81]
[simulation]
end = 0.05
tolerance = 1e-9
integrator = "dop853"
[output]
step = 1e-2
[[body]]
name = "arm 1.5"
mass = 2.0
inertia = 0.4
cg = [0.0, -1.0]
[[body]]
name = "arm"
mass = 1.0
inertia = 0.1
position = [3.0, 0.0]
[[signal]]
name = "push"
kind = "harmonics"
amplitudes = [3.0, 1.0]
frequencies = [1.0, 7.0]
[[element]]
kind = "revolute"
name = "pin"
a = { body = "arm 1.5", point = [0.0, 0.0] }
b = { body = "ground", at = [0.0, 0.0], angle = 0.1 }
angle = 0.3
[[element]]
kind = "spring_damper"
name = "tie"
a = "arm"
b = "arm 1.5"
force_table = [[-1.0, -100.0], [0.0, 0.0], [2.0, 300.0]]
[[element]]
kind = "load"
name = "wind"
at = "arm"
force = [1.0, 0.0]
force_x = "push"
)";

RunResult run_of(const System& system, const Model& model) {
  SimulationOptions options = options_of(model);
  return simulate(system, assembled_start(system, assemble(model, system)), options);
}

bool are_same_bytes(const RunResult& a, const RunResult& b) {
  if (a.trajectory->size() != b.trajectory->size() || a.trajectory->channels().size() != b.trajectory->channels().size()) return false;
  for (std::size_t i = 0; i < a.trajectory->size(); ++i)
    for (std::size_t k = 0; k < a.trajectory->channels().size(); ++k) {
      const double x = a.trajectory->value(i, k), y = b.trajectory->value(i, k);
      if (std::memcmp(&x, &y, sizeof x) != 0) return false;
    }
  return true;
}

// The message of the ModelError that `f` throws, "" if it throws none.
template <class F> std::string message_of(const F& f) {
  try {
    f();
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

// The path of the pressure of the model's core.
std::string core_pressure(const Model& model) {
  for (const TableEntry& entry : model.tables)
    if (entry.kind->name == "core") return "core." + entry.table->name + ".pressure";
  return "";
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace

// What refers to itself can be neither copied nor moved; a model and a state can.
static_assert(!std::is_copy_constructible_v<System> && !std::is_move_constructible_v<System>);
static_assert(!std::is_copy_constructible_v<Simulation> && !std::is_move_constructible_v<Simulation>);
static_assert(!std::is_copy_constructible_v<Dynamics> && !std::is_move_constructible_v<Dynamics>);
static_assert(std::is_copy_constructible_v<Model> && std::is_copy_constructible_v<State>);

TEST_CASE("a copy of a model has elements, signals and tables of its own") {
  const Model model = read_given_model(std::string(STEPLAP_MODELS) + "/layouts/three_limb.toml", transformer_catalog());
  REQUIRE_FALSE(model.tables.empty());
  Model copy = model;
  for (std::size_t i = 0; i < model.elements.size(); ++i) CHECK(copy.elements[i].element != model.elements[i].element);
  for (std::size_t i = 0; i < model.signals.size(); ++i) CHECK(copy.signals[i].definition != model.signals[i].definition);
  for (std::size_t i = 0; i < model.tables.size(); ++i) CHECK(copy.tables[i].table != model.tables[i].table);
  const std::string pressure = core_pressure(model);
  const double before = number_of(model, pressure);
  set_value(copy, pressure, 0.5 * before);
  CHECK(number_of(copy, pressure) == 0.5 * before);
  CHECK(number_of(model, pressure) == before);
  copy = model;
  CHECK(number_of(copy, pressure) == before);
}

TEST_CASE("a value set by its path runs as one that --set gives, byte for byte") {
  const std::vector<std::pair<std::string, double>> values = {
      {"gravity.1", -3.0},         {"body.arm 1.5.mass", 7.0},        {"body.arm.position.0", 3.5},
      {"element.pin.angle", -0.2}, {"signal.push.amplitudes.1", 9.0}, {"element.tie.force_table.2.1", 500.0},
      {"body.arm 1.5.cg.1", -0.7}, {"simulation.end", 0.03},          {"element.wind.force.0", 2.5}};
  const Model given = parse_given_model(k_scene, "scene.toml", transformer_catalog());
  const Model plain = parse_model(k_scene, "scene.toml", transformer_catalog());
  const auto usual = run_of(*compile(plain), plain);
  for (const auto& [path, value] : values) {
    CAPTURE(path);
    Model changed = given;
    set_value(changed, path, value);
    const Model one = completed(changed);
    char text[64];
    std::snprintf(text, sizeof text, "=%.17g", value);
    const Model other = parse_model(k_scene, "scene.toml", transformer_catalog(), {path + text});
    const auto system = compile(one);
    const RunResult run = run_of(*system, one);
    CHECK(are_same_bytes(run, run_of(*compile(other), other)));
    CHECK_FALSE(are_same_bytes(run, usual)); // the value matters
    CHECK(number_of(changed, path) == value);
    if (path != "simulation.end") CHECK(are_same_bytes(run_of(*instantiate(given, {{path, value}}), plain), run));
  }
}

TEST_CASE("a core's dimensions are set in the model as given") {
  const std::string path = std::string(STEPLAP_MODELS) + "/layouts/three_limb.toml";
  const Model given = read_given_model(path, transformer_catalog());
  const std::string field = core_pressure(given);
  Model changed = given;
  set_value(changed, field, 0.7 * number_of(given, field));
  set_value(changed, "simulation.end", 0.02);
  const Model one = completed(changed);
  char text[64];
  std::snprintf(text, sizeof text, "=%.17g", number_of(changed, field));
  const Model other = read_model(path, transformer_catalog(), {field + text, "simulation.end=0.02"});
  CHECK(are_same_bytes(run_of(*compile(one), one), run_of(*compile(other), other)));
}

TEST_CASE("what is wrong with a path or a value is said") {
  Model model = parse_given_model(k_scene, "scene.toml", transformer_catalog());
  const auto set = [&](const std::string& path, const FieldValue& value) { return message_of([&] { set_value(model, path, value); }); };
  CHECK(says(set("body.arm.mas", 1.0), "did you mean 'mass'?"));
  CHECK(says(set("body.amr.mass", 1.0), "did you mean 'arm'?"));
  CHECK(says(set("bodi.arm.mass", 1.0), "a model has no 'bodi'"));
  CHECK(says(set("body.arm.mass", -1.0), "must be greater than 0 kg, got -1"));
  CHECK(says(set("body.arm.mass", std::nan("")), "must be finite"));
  CHECK(says(set("body.arm.mass", std::string("2 kg")), "does not take a text"));
  CHECK(says(set("body.arm.position.2", 1.0), "has no such item"));
  CHECK(says(set("body.arm.position.x", 1.0), "'x' is not an item"));
  CHECK(says(set("element.tie.count", 1.5), "expected an integer"));
  CHECK(says(set("simulation.integrator", std::string("dop835")), "did you mean 'dop853'?"));
  CHECK(says(set("simulation", 1.0), "name a key of 'simulation'"));
  CHECK(set("element.tie.count", 2.0).empty());
  CHECK(number_of(model, "element.tie.count") == 2.0);
  CHECK(says(message_of([&] { (void)number_of(model, "title"); }), "not a number"));
  // What needs the whole model is said when it is completed.
  set_value(model, "element.wind.force_x", std::string("pull"));
  CHECK(says(message_of([&] { (void)completed(model); }), "there is no signal 'pull'"));
}

TEST_CASE("a model made in code is completed as one from a file") {
  const Model from_file = parse_model(k_scene, "scene.toml", transformer_catalog());
  const Catalogue& catalogue = transformer_catalog();
  Model model;
  model.simulation.end = 0.05;
  model.simulation.tolerance = 1e-9;
  model.simulation.integrator = "dop853";
  model.output.step = 1e-2;
  Body arm;
  arm.name = "arm 1.5";
  arm.mass = 2.0;
  arm.inertia = 0.4;
  arm.cg = {0.0, -1.0};
  Body other;
  other.name = "arm";
  other.mass = 1.0;
  other.inertia = 0.1;
  other.position = {3.0, 0.0};
  model.bodies = {arm, other};
  Marker on_arm, on_ground;
  on_arm.name = "pin.a";
  on_arm.body = "arm 1.5";
  on_arm.point = Vec2(0.0, 0.0);
  on_ground.name = "pin.b";
  on_ground.at = Vec2(0.0, 0.0);
  on_ground.angle = 0.1;
  model.markers = {on_arm, on_ground};
  add_signal(model, "harmonics", "push");
  for (const auto& [kind, name] : {std::pair("revolute", "pin"), {"spring_damper", "tie"}, {"load", "wind"}}) {
    const ElementKind* const k = catalogue.find_element(kind);
    model.elements.emplace_back(k, k->create()).element->name = name;
  }
  using Numbers = std::vector<double>;
  for (const auto& [path, value] : std::vector<std::pair<std::string, FieldValue>>{
           {"signal.push.amplitudes", Numbers{3.0, 1.0}},
           {"signal.push.frequencies", Numbers{1.0, 7.0}},
           {"element.pin.a", std::string("pin.a")},
           {"element.pin.b", std::string("pin.b")},
           {"element.pin.angle", 0.3},
           {"element.tie.a", std::string("arm")},
           {"element.tie.b", std::string("arm 1.5")},
           {"element.tie.force_table", std::vector<Vec2>{{-1.0, -100.0}, {0.0, 0.0}, {2.0, 300.0}}},
           {"element.wind.at", std::string("arm")},
           {"element.wind.force", Vec2(1.0, 0.0)},
           {"element.wind.force_x", std::string("push")}}) {
    CAPTURE(path);
    set_value(model, path, value);
  }
  const Model whole = completed(model);
  CHECK(are_same_bytes(run_of(*compile(whole), whole), run_of(*compile(from_file), from_file)));
  CHECK(model.markers.size() == 2); // what was given stays
}

TEST_CASE("entries made in code are of the kind that is named, or refused") {
  Model model;
  SpringDamper& tie = add_element<SpringDamper>(model, spring_damper_kind(), "tie");
  tie.stiffness = 300.0;
  for (int i = 0; i < 50; ++i) (void)add_element<Load>(model, load_kind(), "load " + std::to_string(i));
  CHECK(&tie == model.elements.front().element.get()); // it stays where it is
  CHECK(number_of(model, "element.tie.stiffness") == 300.0);
  CHECK_THROWS_AS(add_element<Load>(model, spring_damper_kind(), "wrong"), std::bad_cast);
  CHECK(model.elements.size() == 51);
  add_signal(model, "haversine", "braking");
  set_value(model, "signal.braking.peak", -5.9);
  CHECK(number_of(model, "signal.braking.peak") == -5.9);
  CHECK(says(message_of([&] { add_signal(model, "haversin", "x"); }), "no kind of signal 'haversin' (did you mean 'haversine'?)"));
}

namespace {

// The paths of all plain numbers of bodies, elements and signals.
std::vector<std::string> numbers_of(const Model& model) {
  std::vector<std::string> paths;
  const auto take = [&](const std::string& start, const FieldTable& fields, const void* object) {
    for (const Field& field : fields.fields()) {
      if (field.type == FieldType::vec2 && std::holds_alternative<Vec2>(field.get(object)))
        for (const char* component : {".0", ".1"}) paths.push_back(start + field.name + component);
      if (field.type == FieldType::number && std::holds_alternative<double>(field.get(object))) paths.push_back(start + field.name);
    }
  };
  for (const Body& body : model.bodies) take("body." + body.name + ".", Body::fields(), &body);
  for (const ElementEntry& e : model.elements) take("element." + e.element->name + ".", e.kind->fields, e.element.get());
  for (const SignalEntry& e : model.signals) take("signal." + e.definition->name + ".", e.kind->fields, e.definition.get());
  for (const TableEntry& e : model.tables) take(e.kind->name + "." + e.table->name + ".", e.kind->fields, e.table.get());
  paths.insert(paths.end(), {"gravity.0", "simulation.end", "output.step"});
  return paths;
}

// What a system does at its start: the first rates, and all channels there.
std::vector<double> start_values(const System& system) {
  State state = system.initial_state();
  start_drives(system, state);
  Dynamics dynamics(system);
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension()), dy(dynamics.dimension());
  dynamics.pack(state, y.data());
  dynamics.rates(1e-3, y.data(), dy.data());
  const Snapshot snapshot = dynamics.snapshot(dy.data());
  std::vector<double> values = y;
  values.insert(values.end(), dy.begin(), dy.end());
  for (const Channel& channel : system.channels) values.push_back(channel.value(snapshot));
  return values;
}

} // namespace

// Whatever number of whatever model: put into the completed model, or given and completed again, is one system.
TEST_CASE("variants of a model are what instantiate makes, number by number") {
  for (const char* name : {"paper/interference", "layouts/three_limb", "benchmarks/andrews", "benchmarks/robot_arm", "benchmarks/chain_10",
                           "machines/ladder", "machines/crane_arm"}) {
    const std::string file = std::string(STEPLAP_MODELS) + "/" + name + ".toml";
    if (!std::filesystem::exists(file)) FAIL(file);
    const Model given = read_given_model(file, transformer_catalog());
    for (const std::string& path : numbers_of(given)) {
      CAPTURE(path);
      const double before = number_of(given, path), value = before == 0.0 ? 1e-3 : 1.001 * before;
      std::unique_ptr<System> one, other;
      const std::string wrong = message_of([&] { one = instantiate(given, {{path, value}}); });
      Variants variants(given, {path});
      static_cast<void>(message_of([&] { (void)variants.make({before == 0.0 ? 2e-3 : 0.9 * before}); })); // one made before leaves no trace
      const std::string as_wrong = message_of([&] { other = variants.make({value}); });
      CHECK(wrong == as_wrong);
      if (!one || !other) continue;
      const std::vector<double> a = start_values(*one), b = start_values(*other);
      REQUIRE(a.size() == b.size());
      CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
    }
  }
}

// Of a body whose shapes give it its mass and its centre of gravity, at which a spring acts.
TEST_CASE("variants of a body follow its shapes") {
  const Model given = parse_given_model(R"(
[[body]]
name = "plate"
position = [0.0, 1.0]
[[shape]]
name = "sheet"
body = "plate"
outline = [[-1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [-1.0, 1.0]]
area_density = 100.0
[[shape]]
name = "disc"
body = "plate"
centre = [0.5, 0.5]
diameter = 0.6
area_density = 200.0
[[element]]
kind = "spring_damper"
name = "spring"
a = "plate"
b = { body = "ground", at = [0.2, 3.0] }
stiffness = 1000.0
)",
                                        "m.toml", transformer_catalog());
  const std::vector<std::string> paths = {"shape.disc.diameter", "shape.sheet.area_density", "shape.sheet.outline.2.1",
                                          "body.plate.position.1"};
  Variants variants(given, paths);
  for (const double share : {1.0, 0.9, 1.1, 1.0}) {
    const std::vector<double> values = {0.6 * share, 100.0 * share, 1.0 / share, 1.0 * share};
    const auto one = instantiate(given, {{paths[0], values[0]}, {paths[1], values[1]}, {paths[2], values[2]}, {paths[3], values[3]}}),
               other = variants.make(values);
    CHECK(one->bodies[1].mass == other->bodies[1].mass);
    CHECK(one->bodies[1].mass ==
          doctest::Approx(100.0 * share * 0.5 * (1.0 + 1.0 / share) + 200.0 * 0.25 * std::numbers::pi * 0.36 * share * share));
    const std::vector<double> a = start_values(*one), b = start_values(*other);
    REQUIRE(a.size() == b.size());
    CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
  }
}

TEST_CASE("variants have the channels that are asked for, and say what is wrong") {
  const Model given = read_given_model(k_paper, transformer_catalog());
  const std::vector<std::string> wanted = {"upper tank.ax", "upper tank.theta"};
  Variants some(given, {"body.upper tank.mass"}, &wanted);
  const auto few = some.make({21e3}), all = Variants(given, {"body.upper tank.mass"}).make({21e3});
  REQUIRE(few->channels.size() == 2);
  for (const std::string& name : wanted) CHECK(few->find_channel(name) != nullptr);
  CHECK(all->channels.size() > 100);
  CHECK(says(message_of([&] { (void)some.make({-1.0}); }), "must be greater than 0 kg"));
  const auto masses = [](const System& system) {
    std::vector<double> list;
    for (const BodyData& body : system.bodies) list.push_back(body.mass);
    return list;
  };
  CHECK(masses(*some.make({21e3})) == masses(*few)); // a failed one leaves no trace
  CHECK_THROWS_AS((void)some.make({}), std::invalid_argument);
  CHECK(says(message_of([&] { Variants(given, {"body.uper tank.mass"}); }), "did you mean 'upper tank'?"));
  CHECK(says(message_of([&] { Variants(given, {"title"}); }), "not a number"));
}

TEST_CASE("systems of one model with different values run side by side as one after the other") {
  Model given = read_given_model(k_paper, transformer_catalog());
  set_value(given, "simulation.end", 0.1);
  set_value(given, "simulation.integrator", std::string("dop853"));
  const Model model = completed(given);
  constexpr int k_threads = 4, k_each = 3;
  const auto run = [&](int i) {
    const auto system =
        instantiate(given, {{"element.tank bottom.static_friction", 0.2 + 0.01 * i}, {"body.active part.mass", 46e3 + 100.0 * i}});
    RunResult result = run_of(*system, model);
    std::vector<double> last;
    for (std::size_t k = 0; k < result.trajectory->channels().size(); ++k)
      last.push_back(result.trajectory->value(result.trajectory->size() - 1, k));
    return last;
  };
  std::vector<std::vector<double>> together(k_threads * k_each), alone;
  std::vector<std::thread> threads;
  for (int t = 0; t < k_threads; ++t)
    threads.emplace_back([&, t] {
      for (int i = t; i < k_threads * k_each; i += k_threads) together[static_cast<std::size_t>(i)] = run(i);
    });
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < k_threads * k_each; ++i) alone.push_back(run(i));
  const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  };
  for (std::size_t i = 0; i < alone.size(); ++i) CHECK(same(together[i], alone[i]));
  CHECK_FALSE(same(alone[0], alone[1]));
}

// What makes a body's place known is that the file gives it, not its value.
TEST_CASE("a chain that begins at a body given the place [0, 0] is placed in memory as from its file") {
  const std::string text = R"(gravity = [0.0, 0.0]
[simulation]
end = 1.0
[[body]]
name = "first"
mass = 1.0
inertia = 0.1
position = [0.0, 0.0]
[[body]]
name = "second"
mass = 1.0
inertia = 0.1
cg = [0.5, 0.0]
[[element]]
kind = "revolute"
name = "pin"
a = { body = "second", point = [0.0, 0.0] }
b = { body = "first", point = [1.0, 0.0] }
angle = 0.25
)";
  const Model read = parse_model(text, "chain.toml", transformer_catalog());
  const Model made = completed(parse_given_model(text, "chain.toml", transformer_catalog()));
  for (const Model* model : {&read, &made}) {
    const Body& second = *model->find_body("second");
    CHECK(second.position == Vec2(1.0, 0.0));
    CHECK(second.angle == 0.25);
  }
}
