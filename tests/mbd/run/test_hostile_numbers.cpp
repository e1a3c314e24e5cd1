// Numbers that no table can mean, and sizes that no machine holds, are errors of the model or are computed with: they never end the program.
#include "mbd/base/stop.h"
#include "mbd/rest/assembly.h"
#include "mbd/rest/descent.h"
#include "mbd/run/loaded_model.h"
#include "mbd/run/report.h"
#include "mbd/run/run.h"
#include "transformer/program.h"

#include <doctest/doctest.h>
#include <toml++/toml.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace steplap;
namespace fs = std::filesystem;

namespace {

// Models with tables that are completed from others: cores, clamps, recorders, uncertain values.
std::vector<fs::path> models_with_tables() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(STEPLAP_SOURCE "/models")) {
    if (entry.path().extension() != ".toml") continue;
    try {
      if (!load_model(entry.path().string())->model.tables.empty()) found.push_back(entry.path());
    } catch (const ModelError&) { // a study, or a part that is no whole model
    }
  }
  return found;
}

std::vector<std::string> numeric_settings(const TableEntry& entry) {
  std::vector<std::string> settings;
  for (const Field& field : entry.kind->fields.fields())
    if (field.type == FieldType::number || field.type == FieldType::integer)
      settings.push_back(entry.kind->name + "." + entry.table->name + "." + field.name + "=");
  return settings;
}

const std::string k_body = "[simulation]\nend = 0.1\n[output]\nstep = 0.1\n[[body]]\nname = \"a\"\nmass = 1\ninertia = 1\n";

std::string problem_of(const std::string& text) {
  try {
    (void)load_model_text(text, "long.toml", {});
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

bool is_refused(const std::string& model, const std::string& setting) {
  try {
    (void)load_model(model, {setting});
  } catch (const ModelError&) {
    return true;
  }
  return false;
}

// A number, or a text that holds one: "50 MN/m", "= 2 * r".
bool is_numeric(const toml::node& node) {
  if (node.is_integer() || node.is_floating_point()) return true;
  const toml::value<std::string>* text = node.as_string();
  return text && !text->get().empty() && (std::isdigit(text->get()[0]) || std::string("+-.=").find(text->get()[0]) != std::string::npos);
}

struct NumberInModel {
  std::string key; ///< path without names and indices, but with the kinds
  std::function<void(double)> set;
};

// Appends each numeric value below `node`, at any depth. The references remain valid while values are set, not when `node` is copied.
void append_numbers(toml::node& node, const std::string& key, std::vector<NumberInModel>& numbers) {
  const auto append = [&](toml::node& child, const std::string& below, const std::function<void(double)>& set) {
    if (is_numeric(child)) {
      numbers.push_back({below, set});
    } else {
      append_numbers(child, below, numbers);
    }
  };
  if (toml::table* table = node.as_table()) {
    const std::string kind = (*table)["kind"].value_or(std::string());
    for (auto&& [name, child] : *table)
      append(child, key + "/" + kind + "." + std::string(name.str()),
             [table, field = std::string(name.str())](double number) { table->insert_or_assign(field, number); });
  } else if (toml::array* array = node.as_array()) {
    for (std::size_t i = 0; i < array->size(); ++i)
      append((*array)[i], key, [array, i](double number) { array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(i), number); });
  }
}

std::vector<NumberInModel> numbers_of(toml::table& model) {
  std::vector<NumberInModel> numbers;
  append_numbers(model, "", numbers);
  return numbers;
}

bool is_refused_text(const toml::table& model, const std::string& path) {
  std::stringstream text;
  text << model;
  try {
    (void)load_model_text(text.str(), path, {});
  } catch (const ModelError&) {
    return true;
  } catch (const NumericalFailure&) {} // joints that cannot be assembled
  return false;
}

} // namespace

// STEPLAP_HOSTILE_NUMBERS=all sets each value of each model, in minutes; otherwise each field of each kind once.
TEST_CASE("no number of any model ends the program, and NaN is always refused") {
  const char* const wanted = std::getenv("STEPLAP_HOSTILE_NUMBERS"); // more than a test has time for
  const bool sets_all = wanted && std::string(wanted) == "all";
  std::set<std::string> done;
  for (const auto& entry : fs::recursive_directory_iterator(STEPLAP_SOURCE "/models")) {
    if (entry.path().extension() != ".toml") continue;
    const std::string path = entry.path().string();
    CAPTURE(path);
    const toml::table original = toml::parse_file(path);
    if (is_refused_text(original, path)) continue; // a study, or a part that is no whole model
    toml::table counted = original;
    const std::vector<NumberInModel> numbers = numbers_of(counted);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!done.insert(numbers[i].key).second && !sets_all) continue;
      CAPTURE(numbers[i].key);
      const auto is_refused_with = [&](double number) {
        toml::table changed = original;
        numbers_of(changed)[i].set(number);
        return is_refused_text(changed, path);
      };
      for (const double number : {0.0, -1.0, 1e300}) (void)is_refused_with(number);
      CHECK(is_refused_with(std::numeric_limits<double>::quiet_NaN()));
    }
  }
  CHECK(done.size() > 200); // the fields that the shipped models give
}

TEST_CASE("no number in a table ends the program, and NaN is always refused") {
  const std::vector<fs::path> models = models_with_tables();
  REQUIRE(models.size() >= 10);
  for (const fs::path& path : models) {
    CAPTURE(path.string());
    const auto loaded = load_model(path.string());
    for (const TableEntry& entry : loaded->model.tables)
      for (const std::string& setting : numeric_settings(entry)) {
        CAPTURE(setting);
        for (const char* const number : {"0", "-1", "1e300"}) (void)is_refused(path.string(), setting + number);
        CHECK(is_refused(path.string(), setting + "nan")); // no dimension of a machine is NaN
      }
  }
}

// Before there were limits, 200 000 parameters took 40 s, and a file of 40 kB took 4.7 GB.
TEST_CASE("what would take all memory or minutes to read is refused by an error that names the limit") {
  std::string parameters = "[parameters]\n";
  for (int i = 0; i < 200'000; ++i) parameters += "p" + std::to_string(i) + " = 1\n";
  CHECK(has(problem_of(parameters + k_body), "'parameters' has 200000 keys, more than the 10000 that a table may have"));
  const std::string repeated = "repeat = 100000\nposition = [\"= 3 * i\", 0]\n";
  const std::string problem =
      problem_of(k_body + "[[body]]\nname = \"" + std::string(40'000, 'n') + " {i}\"\nmass = 1\ninertia = 1\n" + repeated);
  CHECK(has(problem, "more than the 20000000 that an entry may make"));
  CHECK(problem.size() < 1000); // the name of 40 kB is not repeated
}

// Two tables of one active part: the sound one weighs the yokes with its neighbour's steel.
TEST_CASE("a core is not completed from a neighbour whose numbers are out of range") {
  const std::string model = STEPLAP_SOURCE "/models/layouts/five_limb.toml";
  REQUIRE_FALSE(is_refused(model, "core.wound limbs.sheets_per_layer=1"));
  for (const char* const field : {"sheets_per_layer", "steps", "sheet_thickness"})
    CHECK(is_refused(model, std::string("core.wound limbs.") + field + "=0"));
}

// Time stepping divides the steps of this search, each into up to a million parts. The search counts the parts: it asks for a stop in each,
// and two searches (from the given poses, and near the pose found) of 4000 steps make at most 40 000 parts each.
TEST_CASE("a search for the rest of bodies 1e8 m apart ends") {
  const auto loaded = load_model(STEPLAP_SOURCE "/tests/data/rest/far_apart.toml");
  long asked = 0;
  const StopQuestion count = [&asked] { return ++asked > 200'000 ? std::string("it does not end") : std::string(); };
  const StopScope scope(count);
  std::string problem;
  try {
    (void)equilibrium_of(*loaded);
  } catch (const NumericalFailure& failure) {
    problem = failure.what();
  }
  CAPTURE(asked);
  CHECK(has(problem, "released and strongly damped, it does not come to rest either"));
}

// Gaps of such bodies drown in rounding, so that each step of the search measures them thousands of times.
TEST_CASE("a search for the rest of bodies that cannot be measured gives up") {
  const std::pair<std::string, std::string> cases[] = {
      {STEPLAP_SOURCE "/models/machines/forklift.toml", "body.truck.position=[-0.95, 1e9]"},
      {STEPLAP_SOURCE "/tests/data/contacts/hop_segment.toml", "body.box.position=[0, -1e300]"}};
  for (const auto& [path, setting] : cases) {
    CAPTURE(path);
    const auto loaded = load_model(path, {setting});
    State state = assembled_start(*loaded->system, assemble(loaded->model, *loaded->system));
    Descent descent(*loaded->system, state);
    CHECK(descent.run() == DescentEnd::no_way);
    CHECK(descent.statics().evaluations() < 300'000);
  }
}

TEST_CASE("a run ends with the name of the element whose formula loses its value") {
  const std::string head = "[simulation]\nend = 2.0\n[[body]]\nname = \"box\"\nmass = 1.0\ninertia = 1.0\nposition = [1.0, 0.0]\n"
                           "velocity = [-1.0, 0.0]\n";
  const auto force = [&head](const std::string& formula) {
    return head + "[[element]]\nkind = \"force\"\nname = \"magnet\"\na = \"box\"\ncoordinate = \"x\"\nformula = \"" + formula + "\"\n";
  };
  const std::string cooling = "[[state]]\nname = \"heat\"\nstart = 0.01\nrate = \"-'0.01 1/s'/sqrt(heat)\"\n";
  const std::string logarithm = force("-'1e-3 N'*ln(value/'1 m')");
  const auto failure_with = [](const std::string& text, const std::vector<std::string>& settings) {
    const Run run = run_model(load_model_text(text, "formula.toml", settings));
    REQUIRE(run.failure);
    return run.failure->text;
  };
  for (const std::string method : {"auto", "dop853", "tsit5", "rodas5p"}) {
    CAPTURE(method);
    const std::vector<std::string> settings = {"simulation.integrator=" + method};
    CHECK(has(failure_with(logarithm, settings), "the formula of 'magnet' has no finite value after t = 1.00025"));
    CHECK(has(failure_with(head + cooling, settings), "the formula of 'heat' has no finite value after t = 0.0666"));
    // 1/x grows beyond all bounds before zero, but is finite there and beyond.
    CHECK(has(failure_with(force("-'1e-3 N m'/value"), settings), "step size fell to"));
  }
  CHECK(has(failure_with(logarithm, {"simulation.integrator=rk4", "simulation.step=1e-3"}), "the formula of 'magnet' has no finite value"));
}

// Steps of rk4 and their halves pass over the pole alike, and agree with each other.
TEST_CASE("the error of fixed steps that pass over a pole, at which adaptive steps end, is unknown") {
  const std::string text = "[simulation]\nend = 2.0\nintegrator = \"rk4\"\nstep = 1e-3\n[[body]]\nname = \"box\"\nmass = 1.0\n"
                           "inertia = 1.0\nposition = [1.0, 0.0]\nvelocity = [-1.0, 0.0]\n[[element]]\nkind = \"force\"\n"
                           "name = \"magnet\"\na = \"box\"\ncoordinate = \"x\"\nformula = \"-'1e-3 N m'/value\"\n";
  const Report report = judged_run(load_model_text(text, "pole.toml"));
  REQUIRE_FALSE(report.run.failure);
  CHECK(report.estimate.status == EstimateStatus::failed);
  CHECK(has(report.estimate.reason, "the finer run failed"));
}

// Squares of such places are infinite, and so were the nudges by which the balance of a run is tried.
TEST_CASE("a run with bodies beyond all distances has a report, in which its balance is unknown") {
  RunOptions options;
  options.end = 0.01;
  const std::string beads = STEPLAP_SOURCE "/tests/data/formulas/row_of_carts.toml";
  const auto loaded =
      load_model(beads, {"body.bead 0.position=[0, 1e300]", "body.bead 1.position=[1.1, 1e300]", "body.bead 2.position=[2.2, 1e300]"});
  CHECK(has(judged_run(loaded, options).estimate.balance_unknown, "beyond all numbers"));
}

// Matrices without rows have no pivot.
TEST_CASE("a scene in which nothing moves runs by every method") {
  const std::string deck = "[simulation]\nend = 0.1\n[[body]]\nname = \"deck\"\nfixed = true\n";
  for (const char* const method : {"auto", "dop853", "tsit5", "rodas5p", "rk4", "moreau"}) {
    CAPTURE(method);
    const std::vector<std::string> settings = {std::string("simulation.integrator=") + method, "simulation.step=0.01"};
    const Report report = judged_run(load_model_text(deck, "deck.toml", settings));
    CHECK_FALSE(report.run.failure);
    CHECK(report.run.result.final_state.t == 0.1);
  }
}

// Accelerations of 1e320 m/s² are infinite, so the step is NaN; with 1e300 m/s² it shrinks to zero. Neither is less than a smallest step.
TEST_CASE("a run whose rates are beyond all numbers ends") {
  const std::string pendulum = STEPLAP_SOURCE "/models/benchmarks/double_pendulum.toml",
                    first = STEPLAP_SOURCE "/tests/data/peers/modelica_first.toml";
  const std::pair<std::string, std::vector<std::string>> cases[] = {{pendulum, {"body.lower.mass=1e-320"}},
                                                                    {first, {"gravity=[0, 1e300]", "body.i1.mass=1e12"}}};
  for (const auto& [path, settings] : cases) {
    CAPTURE(path);
    const Run run = run_model(load_model(path, settings));
    REQUIRE(run.failure);
    CHECK(has(run.failure->text, "step size fell to"));
  }
}
