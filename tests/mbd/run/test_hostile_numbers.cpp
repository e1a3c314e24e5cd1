// Numbers that no table can mean, and sizes that no machine holds, are errors of the model or are computed with: they never end the program.
#include "mbd/run/loaded_model.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <set>
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

} // namespace

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
