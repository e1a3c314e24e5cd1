// What goes in and what comes out: records, models through pipes, results that know their inputs and whether they are whole.
#include "mbd/io/csv.h"
#include "mbd/run/results.h"
#include "tests/tools/steplap/workbench.h"
#include "tools/steplap/command.h"

#include <doctest/doctest.h>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <random>

using namespace steplap;
using namespace steplap::testing;

namespace {

// What the program says of a shell's command, both streams.
struct CommandOutput {
  int code = 0;
  std::string text;
};
CommandOutput shell(const std::string& command) {
  std::FILE* const pipe = popen(("exec 2>&1; " + command).c_str(), "r");
  REQUIRE(pipe);
  CommandOutput said;
  char part[4096];
  while (const std::size_t count = std::fread(part, 1, sizeof part, pipe)) said.text.append(part, count);
  const int status = pclose(pipe);
  said.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return said;
}

const std::string k_program = STEPLAP_PROGRAM;

// A mass that is pulled by what a record says.
constexpr const char* k_pulled = R"(gravity = [0, 0]
[simulation]
end = 1.0
integrator = "dop853"
[output]
step = 0.1
[[body]]
name = "mass"
mass = "2 kg"
inertia = 1
[[signal]]
name = "pull"
kind = "record"
file = "pull.csv"
[[element]]
kind = "load"
name = "pulling"
at = "mass"
force_x = "pull"
)";
constexpr const char* k_pull = "t,F\n0,0\n0.5,10\n1,0\n";

std::string refusal(const std::string& text) {
  try {
    static_cast<void>(parse_csv(text, "r.csv"));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("a first row that begins with a number is data: what is wrong in it is refused with its column") {
  for (const char* const value : {"1 000", "", "1e400", "10 N", "1,5e", "--1", "0x10", "1e", "abc", "nan", "inf", "-inf", "1.2.3", "１"}) {
    CAPTURE(value);
    const std::string text = refusal("0;" + std::string(value) + "\n1;2\n");
    CHECK(text.starts_with("r.csv:1:1: error: "));
    CHECK(has(text, "in column 2"));
  }
  for (const char* const time : {"0 s", "0.0.0", "-", "+", "1e400", "0:00", "nan", ".", "0x0"}) {
    CAPTURE(time);
    CHECK(refusal(std::string(time) + ",5\n1,2\n").starts_with("r.csv:1:1: error: "));
  }
  CHECK(has(refusal("t,5\n1,2\n"), "the first row holds both words and numbers: 't' in column 1, '5' in column 2"));
  CHECK(refusal("time,10 N\n1,2\n").empty()); // two words: names
  CHECK(refusal(",a\n1,2\n").empty());
}

// A whole row may be damaged in one way: by a program that writes other dashes, digits, blanks or quotes.
TEST_CASE("a first row of which every cell is damaged is not taken for names") {
  const std::vector<std::pair<const char*, const char*>> around = {{"−", ""},        {"'", "'"},  {"(", ")"}, {"~", ""},  {"$", ""},
                                                                   {"\xC2\xA0", ""}, {"‐", ""},   {"*", "*"}, {"=", ""},  {"O.", ""},
                                                                   {"l,", ""},       {"x0.", ""}, {"－", ""}, {"--", ""}, {"\"'", "\""}};
  std::mt19937 random(6);
  for (const auto& [before, after] : around)
    for (int trial = 0; trial < 20; ++trial) {
      const bool has_commas = random() % 2 == 0 && std::string(before) != "l,";
      std::string text;
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 2; ++column) {
          const std::string value = std::to_string(row) + (random() % 2 == 0 ? "." + std::to_string(random() % 1000) : "");
          text += (row == 0 ? before + value + after : value) + (column == 1 ? "\n" : has_commas ? "," : ";");
        }
      CAPTURE(text);
      CHECK(refusal(text).starts_with("r.csv:1:1: error: "));
    }
  for (const char* const row : {"-,-", "--,--", "?,?", "*,*", "1e5x,", "nan,nan", "inf,inf", "-inf,-inf", ",", "\"\",\"\"", "٣,٤", "１,２",
                                "x,1e400", "x,1 000", ",1e400", ".,."}) {
    CAPTURE(row);
    CHECK(refusal(std::string(row) + "\n1,2\n").starts_with("r.csv:1:1: error: "));
  }
  for (const char* const row : {"t,a", "t1,a2", "Zeit,µ", "φ1,φ2", "time [s],force [kN]", ",a", "t (s),x.1", "acc_x,acc_y", "Δ,E",
                                "\"time, s\",\"a\"", "T,A1.5 g"}) {
    CAPTURE(row);
    CHECK(refusal(std::string(row) + "\n1,2\n").empty());
  }
}

TEST_CASE("decimals of two kinds, and columns of one name, are refused") {
  CHECK(has(refusal("t;a\n0.5;1\n1;1,000\n"),
            "r.csv:3:1: error: '1,000' in column 2 has a decimal comma, and numbers before it have a point"));
  CHECK(has(refusal("0,5\t1\n1.5\t2"), "has a decimal point"));
  CHECK(refusal("t;a\n0,5;1\n1;1,000\n").empty());
  CHECK(refusal("t;a\n0.5;1\n1;1.000\n").empty());
  const CsvTable table = parse_csv("t,a,a\n0,1,2\n", "r.csv");
  CHECK_THROWS_WITH_AS(static_cast<void>(table.column("a", {"m.toml", 4, 1})),
                       "m.toml:4:1: error: the record 'r.csv' has several columns 'a': name one by its number, from \"1\"", ModelError);
  CHECK(table.column("3", {}) == 2);
}

// A row that is gone leaves a gap in times that come evenly; where values stay as they are nothing is lost.
TEST_CASE("a row that is missing from a record is told, and forbids to call the machine sound") {
  const Workbench bench;
  std::mt19937 random(8);
  std::string model = k_pulled;
  model += "[[acceptance]]\nname = \"goes\"\nchannel = \"mass.x\"\nat_most = 1000\n";
  for (int trial = 0; trial < 40; ++trial) {
    const int rows = 20 + static_cast<int>(random() % 80),
              gone = trial % 2 == 0 ? 1 + static_cast<int>(random() % static_cast<unsigned>(rows - 2)) : -1;
    const double step = 1e-3 * (1.0 + static_cast<double>(random() % 5));
    std::ostringstream text;
    text.precision(3 + trial % 3); // times with few digits
    for (int row = 0; row < rows; ++row)
      if (row != gone) text << step * row << "," << (row + 1 < rows ? 1.0 + 0.1 * static_cast<double>(random() % 1000) : 0.0) << "\n";
    bench.write("pull.csv", text.str());
    CAPTURE(gone);
    CAPTURE(text.str());
    const Outcome outcome = steplap_does({"simulate", bench.write("a.toml", model), "-q", "--force", "-o", bench.at("out")});
    CHECK(outcome.code != 3);
    const std::string summary = text_of(bench.at("out/a/summary.json"));
    CHECK(has(summary, "rows_missing") == (gone > 0 && gone < rows - 2));
    CHECK(has(summary, "\"verdict\": \"open\"") == (gone > 0 && gone < rows - 2));
  }
  bench.write("pull.csv", "0,0\n0.1,0\n0.2,0\n0.5,0\n0.6,0\n0.7,0\n0.8,5\n0.9,2\n1,0\n1.1,0\n1.2,0\n"); // what repeats was left out
  CHECK(!has(steplap_does({"check", bench.at("a.toml")}).out, "are rows missing?"));
}

TEST_CASE("a machine that no signal loads is not called sound") {
  const Workbench bench;
  std::string model = k_pulled;
  model += "[[acceptance]]\nname = \"goes\"\nchannel = \"mass.x\"\nat_most = 1000\n";
  const auto verdict = [&](const char* record, const char* velocity) {
    bench.write("pull.csv", record);
    std::string text = model;
    text.replace(text.find("inertia = 1\n"), 12, std::string("inertia = 1\n") + velocity);
    (void)steplap_does({"simulate", bench.write("a.toml", text), "-q", "--force", "-o", bench.at("out")});
    const std::string summary = text_of(bench.at("out/a/summary.json"));
    return has(summary, "\"verdict\": \"open\"") ? "open" : has(summary, "\"verdict\": \"hold\"") ? "hold" : "other";
  };
  CHECK(std::string(verdict("0,1\n1,2\n", "")) == "hold");
  CHECK(std::string(verdict("0,0\n0.5,0\n1,0\n", "")) == "open");
  CHECK(std::string(verdict("2,1\n3,1\n", "")) == "open");                           // behind the end
  CHECK(std::string(verdict("0,0\n0.5,0\n1,0\n", "velocity = [1, 0]\n")) == "hold"); // it moves without
}

// Every single damage of a cell of a sound record changes what is read, or is refused: no row is lost.
TEST_CASE("a record with one damaged cell is refused, or read with the value that stands there") {
  std::mt19937 random(5);
  const char* const damages[] = {"", " ", "x", "1 0", "1e999", "-", "1..2", "1e5x", "#", "\"", "NaN", "+-1", "1'000", "٣"};
  int refused = 0, tried = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const int rows = 3 + static_cast<int>(random() % 5), bad_row = static_cast<int>(random() % static_cast<unsigned>(rows));
    const int bad_column = static_cast<int>(random() % 3);
    const bool has_header = random() % 2 == 0;
    std::string damage = damages[random() % std::size(damages)];
    if (damage == "#" && bad_column == 0) damage = "x"; // at the start of a line it makes a comment of it, as is said
    std::string text = has_header ? "t,a,b\n" : "";
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < 3; ++column) {
        const std::string value = std::to_string(row) + "." + std::to_string(random() % 1000);
        text += (row == bad_row && column == bad_column ? damage : value) + (column < 2 ? "," : "\n");
      }
    CAPTURE(text);
    ++tried;
    std::size_t found = static_cast<std::size_t>(rows);
    try {
      found = parse_csv(text, "r.csv").columns.front().size();
    } catch (const ModelError&) {
      ++refused;
    }
    CHECK(found == static_cast<std::size_t>(rows));
  }
  CHECK(refused > tried * 3 / 4);
}

TEST_CASE("the model of a result runs again from any folder, to the same bytes, until its record changes") {
  const Workbench bench;
  bench.write("pull.csv", k_pull);
  REQUIRE(steplap_does({"simulate", bench.write("a.toml", k_pulled), "-q", "-o", bench.at("out")}).code == 0);
  bench.write("elsewhere/pull.csv", "0,0\n1,99\n"); // of the same name, beside the copy
  bench.write("elsewhere/model.toml", text_of(bench.at("out/a/model.toml")));
  const Outcome again = steplap_does({"simulate", bench.at("elsewhere/model.toml"), "-q", "-o", bench.at("again")});
  CHECK(again.err == "");
  REQUIRE(again.code == 0);
  CHECK(text_of(bench.at("again/model/trajectory.csv")) == text_of(bench.at("out/a/trajectory.csv")));
  const std::string summary = text_of(bench.at("out/a/summary.json"));
  for (const char* const name : {"a.toml", "pull.csv"}) CHECK(has(summary, fs::canonical(bench.at(name)).string()));
  bench.write("pull.csv", "t,F\n0,0\n0.5,11\n1,0\n");
  const Outcome changed = steplap_does({"simulate", bench.at("elsewhere/model.toml"), "-q", "-o", bench.at("third")});
  CHECK(changed.code == 3);
  CHECK(has(changed.err, "is not the one that was meant"));
  fs::remove(bench.at("pull.csv"));
  CHECK(has(steplap_does({"simulate", bench.at("elsewhere/model.toml"), "-q", "-o", bench.at("third")}).err, "cannot read the record"));
}

TEST_CASE("results of which one byte is another, or is missing, are not shown") {
  const Workbench bench;
  REQUIRE(steplap_does({"simulate", bench.write("a.toml", k_bouncer), "-q", "-o", bench.at("out")}).code == 0);
  CHECK_NOTHROW(static_cast<void>(read_results(bench.at("out/a"))));
  std::mt19937 random(7);
  for (const char* const name : {"trajectory.csv", "events.csv", "model.toml", "drawing.json", "summary.json"}) {
    const std::string path = "out/a/" + std::string(name), whole = text_of(bench.at(path));
    const auto is_refused = [&](const std::string& text) {
      bench.write(path, text);
      try {
        static_cast<void>(read_results(bench.at("out/a")));
      } catch (const FileError& error) {
        return has(error.what(), name) && has(error.what(), "is not as steplap wrote it");
      }
      return false;
    };
    CAPTURE(name);
    for (int trial = 0; trial < 60; ++trial) {
      std::string text = whole;
      char& byte = text[random() % text.size()];
      byte = static_cast<char>(byte ^ static_cast<char>(1U << random() % 8U));
      CAPTURE(trial);
      CHECK(is_refused(text));
    }
    CHECK(is_refused(whole.substr(0, whole.size() / 2)));
    CHECK(is_refused(whole + "\n"));
    for (const char* const text : {"", "[]", "null", "{}"}) CHECK(is_refused(text));
    bench.write(path, whole);
  }
  CHECK_NOTHROW(static_cast<void>(read_results(bench.at("out/a"))));
  bench.write("out/a/summary.json", "[]");
  const Outcome report = steplap_does({"report", bench.at("out/a")});
  CHECK(report.code == 2);
  CHECK_FALSE(fs::exists(bench.at("out/a/report.html")));
}

TEST_CASE("a model may come through a pipe") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  for (const std::string& source : {std::string("- <"), std::string("/dev/stdin <"), std::string("/dev/fd/0 <")}) {
    CAPTURE(source);
    CHECK(shell(k_program + " check " + source + model).code == 0);
    CHECK(shell("cat " + model + " | " + k_program + " check " + source.substr(0, source.size() - 2)).code == 0);
  }
  CHECK(shell("bash -c '" + k_program + " check <(cat " + model + ")'").code == 0);
  CHECK(shell(k_program + " simulate - -q -o " + bench.at("out") + " < " + model).code == 0);
  CHECK(fs::exists(bench.at("out/stdin/summary.json")));
}

TEST_CASE("what has no end, or is no file, is refused in words") {
  const Workbench bench;
  const std::string fifo = bench.at("fifo");
  REQUIRE(mkfifo(fifo.c_str(), 0600) == 0);
  const auto refused = [](const std::string& path, const std::string& why) {
    const CommandOutput said = shell("timeout 20 " + k_program + " check " + path);
    CAPTURE(said.text);
    CHECK(said.code == 3);
    CHECK(has(said.text, why));
  };
  refused("/dev/zero", "it is no file, but a device");
  refused("/dev/null", "it is no file, but a device");
  refused(fifo, "it is a named pipe");
  refused(bench.at(""), "it is a folder");
  refused(bench.at("none.toml"), "No such file or directory");
  std::string record = k_pulled;
  record.replace(record.find("pull.csv"), 8, "/dev/zero");
  refused(bench.write("endless.toml", record), "endless.toml:");
  // Twenty thousand files that extend each other.
  bench.write("m0.toml", k_bouncer);
  for (int i = 1; i <= 20000; ++i) bench.write("m" + std::to_string(i) + ".toml", "extends = \"m" + std::to_string(i - 1) + ".toml\"\n");
  refused(bench.at("m20000.toml"), "files extend each other");
  CHECK(shell(k_program + " check " + bench.at("m99.toml")).code == 0);
}

TEST_CASE("limits of a file's size and of processor time, and readers that have seen enough, leave nothing half behind") {
  const Workbench bench;
  const std::string model = bench.write("a.toml", k_bouncer);
  const std::string run = k_program + " simulate " + model + " --set output.step=1e-4 -o ";
  const CommandOutput full = shell("ulimit -f 20; " + run + bench.at("full") + " -q");
  CHECK(full.code == 2);
  CHECK(has(full.text, "File too large"));
  CHECK_FALSE(fs::exists(bench.at("full")));
  const CommandOutput slow = shell("ulimit -S -t 1; " + k_program + " simulate " + bench.write("long.toml", k_oscillator) +
                                   " -q --set simulation.end=1e6 --set output.step=10 -o " + bench.at("slow"));
  CHECK((slow.code == -SIGXCPU || slow.code == 128 + SIGXCPU)); // as the shell hands it on
  CHECK(has(text_of(bench.at("slow/long/partial_summary.json")), "stopped by SIGXCPU"));
  CHECK(bench.content("slow") == std::set<std::string>{"long", "long/partial_drawing.json", "long/partial_events.csv",
                                                       "long/partial_model.toml", "long/partial_summary.json",
                                                       "long/partial_trajectory.csv"});
  const CommandOutput closed = shell(run + bench.at("closed") + " | true");
  CHECK_FALSE(has(closed.text, "error"));
  CHECK(fs::exists(bench.at("closed/a/summary.json")));
  CHECK(bench.content("closed").size() == 6);
}

TEST_CASE("plots of whatever names, in whatever folders") {
  const Workbench bench;
  std::string text = k_bouncer;
  text.replace(text.find("ball"), 4, "it's % _{x} ^ & @ $(ls)");
  text.replace(text.find("a = \"ball\""), 10, "a = \"it's % _{x} ^ & @ $(ls)\"");
  text += "[[plot]]\nname = \"o'clock\"\ntitle = \"it's `1`\"\nchannels = [\"it's*.y\"]\n";
  REQUIRE(steplap_does({"simulate", bench.write("q'q.toml", text), "-q", "-o", bench.at("o'ut")}).code == 0);
  for (const char* const ending : {".svg", ".png", ".pdf"}) {
    const std::string image = bench.at("d'r/p'lot" + std::string(ending));
    fs::create_directories(bench.at("d'r"));
    const Outcome outcome = steplap_does({"plot", bench.at("o'ut/q'q"), "--plot", "o'clock", "-o", image});
    CHECK(outcome.err == "");
    CHECK(fs::exists(image));
  }
}
