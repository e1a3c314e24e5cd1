// What can be varied: every number of every model of the project, by a path that sets it, within a range that holds its value.
#include "tools/explore/slider.h"

#include "mbd/io/reader.h"
#include "mbd/model/model_path.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <set>

using namespace steplap;

TEST_CASE("every slider of every model leads to its number, and can be set to it and to both ends but for what others forbid") {
  long models = 0, sliders = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(STEPLAP_MODELS)) {
    const std::string path = entry.path().string();
    if (entry.path().extension() != ".toml" || path.find("/studies/") != std::string::npos || path.find("/loads/") != std::string::npos)
      continue;
    Model given;
    try {
      given = read_given_model(path, program_catalogue());
    } catch (const ModelError&) {
      continue; // what others extend
    }
    ++models;
    std::set<std::string> seen;
    for (const Slider& s : sliders_of(given)) {
      ++sliders;
      CHECK_MESSAGE(seen.insert(s.path).second, path << ": " << s.path << " twice");
      CHECK_MESSAGE(number_of(given, s.path) == s.value, path << ": " << s.path);
      CHECK_MESSAGE(s.least < s.most, path << ": " << s.path);
      CHECK_MESSAGE((s.least <= s.value && s.value <= s.most), path << ": " << s.path << " " << s.least << " " << s.value << " " << s.most);
      if (s.needs_file) continue;
      for (const double value : {s.least, s.most, s.value}) CHECK_NOTHROW(set_value(given, s.path, value));
    }
    CHECK_MESSAGE(seen.size() > 5, path);
  }
  CHECK(models > 60);
  CHECK(sliders > 5000);
}

TEST_CASE("parameters come first, with the range of the file; what follows from them is no slider") {
  const Model model = parse_given_model(R"(
[parameters]
grip = { value = 0.4, range = [0.05, 0.9], meaning = "friction" }
half = "= grip/2"
push = "2 kN"
[simulation]
step = 1e-3
[[body]]
name = "a"
mass = "= '1 kg' * 3"
inertia = 1
[[body]]
name = "b"
mass = 2
inertia = 1
velocity = ["= push/'1 kg'*'1 s'", 0]
)",
                                        "a.toml", program_catalogue());
  const std::vector<Slider> sliders = sliders_of(model);
  REQUIRE(sliders.size() > 3);
  CHECK(sliders[0].path == "parameters.grip");
  CHECK(sliders[0].least == 0.05);
  CHECK(sliders[0].most == 0.9);
  CHECK(sliders[0].has_own_range);
  CHECK(sliders[0].meaning == "friction");
  CHECK(sliders[1].path == "parameters.push");
  CHECK(sliders[1].value == 2000.0);
  CHECK(sliders[1].unit == "N");
  CHECK_FALSE(sliders[1].has_own_range);
  const auto has = [&](const std::string& path) {
    return std::any_of(sliders.begin(), sliders.end(), [&](const Slider& s) { return s.path == path; });
  };
  CHECK(has("body.b.mass"));
  CHECK(has("body.b.velocity.1"));
  CHECK_FALSE(has("parameters.half"));
  CHECK_FALSE(has("body.b.velocity.0"));
}
