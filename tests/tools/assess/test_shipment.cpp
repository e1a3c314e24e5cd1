// The papers of a transport: what the sheet to be signed needs, and the voyage that they state.
#include "driven_scene.h"

#include "transformer/decision/shipment.h"
#include "transformer/recorder/fields.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>

using namespace steplap;
using namespace steplap::assess;
using namespace assess_test;

namespace {

const std::string k_papers = R"(transformer = "T-4711"
departure = "2016-01-04 10:00:00"
arrival = "2016-01-04 10:00:02"
[[recorder]]
serial = "SL-0815"
record = "shock.csv"
calibrated = "2015-11-02"
range = "16 g"
place = "lid, above limb 2"
[[handover]]
place = "Rotterdam"
time = "2016-01-04 10:00:01"
)";

std::size_t line_of_error(const std::string& text) {
  try {
    static_cast<void>(parse_shipment(text, "papers.toml"));
  } catch (const ModelError& error) {
    return static_cast<std::size_t>(error.diagnostics().front().where.line);
  }
  return 0;
}

// A record with a clock, from 10:00:00 for two seconds.
std::string clocked_record() {
  std::string text = "Time,x [g],y [g],z [g]\n";
  for (int i = 0; i <= 2000; ++i) {
    const double t = 1e-3 * i, noise = 1e-4 * std::sin(1e5 * t);
    const double x = t < 0.5 || t > 0.6 ? noise : 1.2 * std::sin(10.0 * std::numbers::pi * (t - 0.5));
    char row[96];
    std::snprintf(row, sizeof row, "2016-01-04 10:00:0%.3f,%.6f,%.6f,%.6f\n", t, x, noise, 1.0 - noise);
    text += row;
  }
  return text;
}

} // namespace

TEST_CASE("papers are read, and what is wrong in them is told with its line") {
  const Shipment s = parse_shipment(k_papers, "papers.toml");
  CHECK(s.transformer == "T-4711");
  REQUIRE(s.recorders.size() == 1);
  CHECK(s.recorders[0].serial == "SL-0815");
  CHECK(s.recorders[0].filter.empty());
  REQUIRE(s.handovers.size() == 1);
  CHECK(s.handovers[0].place == "Rotterdam");
  CHECK(line_of_error("") == 0); // nothing has to be stated
  CHECK(line_of_error("transformer = 5\n") == 1);
  CHECK(line_of_error("transformer = \"a\"\nserial = \"b\"\n") == 2);
  CHECK(line_of_error("[[recorder]]\nrange = \"16 g\"\n") == 1); // a recorder has a serial number
  CHECK(line_of_error("\nrecorder = \"SL-0815\"\n") == 2);
}

TEST_CASE("departure and arrival of the papers are the voyage, of which the share that was recorded is told") {
  const Folder folder;
  write(folder.file("shock.csv"), clocked_record());
  write(folder.file("block.toml"), block_text(0.5, "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"1 m\"\n"));
  write(folder.file("criteria.toml"),
        "name = \"models\"\n[[criterion]]\nname = \"what the models ask\"\nquantity = \"acceptance\"\noutcome = \"inspect\"\n");
  const auto run = [&](const std::string& papers, const std::string& more) {
    write(folder.file("papers.toml"), papers);
    const std::string command = std::string(STEPLAP_PROGRAM) + " assess " + folder.file("shock.csv") + " --model " +
                                folder.file("block.toml") + " --gravity z --samples 0 --no-estimate --criteria " +
                                folder.file("criteria.toml") + " --shipment " + folder.file("papers.toml") + " -f -o " +
                                folder.file("out") + " " + more + " > /dev/null 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  const auto written = [&] { return nlohmann::json::parse(std::ifstream(folder.file("out") + "/assessment.json")); };
  CHECK(run(k_papers, "") == 0);
  CHECK(written().at("shipment").at("recorders").at(0).at("serial") == "SL-0815");
  CHECK(written().at("covered_share") == doctest::Approx(1.0).epsilon(1e-9));
  CHECK(run(k_papers, "--voyage 0,2") == 2); // said twice
  std::string longer = k_papers;
  longer.replace(longer.find("10:00:02"), 8, "10:00:04");
  CHECK(run(longer, "") == 12);
  // The record begins at 10:00:00 and covers half of four seconds, and 1.5 ms after its last row.
  CHECK(written().at("covered_share") == doctest::Approx(0.5).epsilon(1e-3));
  std::string backward = k_papers;
  backward.replace(backward.find("10:00:02"), 8, "09:00:00");
  CHECK(run(backward, "") == 2);
  CHECK(run("transformer = \"T-4711\"\n", "") == 12); // nobody says when the journey began
  // The shock of 1.2 g is beyond a range of 1 g.
  const auto of_range = [](const std::string& range) {
    std::string papers = k_papers;
    return papers.replace(papers.find("16 g"), 4, range);
  };
  CHECK(run(of_range("± 1 g"), "") == 12);
  CHECK(run(of_range("±1 g"), "--range '16 g'") == 2);   // said twice
  CHECK(run(of_range("16 g"), "--range 156.9064") == 2); // m/s² without a unit are g
  CHECK(run(of_range("see the label"), "") == 0);
}
