// Records in, histories out, and files that are written as a whole or not at all.
#include "mbd/io/atomic_file.h"
#include "mbd/io/csv.h"

#include <doctest/doctest.h>

#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace steplap;
namespace fs = std::filesystem;

namespace {

std::string problem(const std::string& text) {
  try {
    static_cast<void>(parse_csv(text, "r.csv"));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

std::string content(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator{}));
}

} // namespace

TEST_CASE("delimiters, comments, headers, decimal commas") {
  const CsvTable a =
      parse_csv("# stop\n\ntime [s], \"a, long\"\r\n0, 1.5\r\n+0.1,-2e3\r\n", "a.csv");
  CHECK(a.names == std::vector<std::string>{"time", "a, long"});
  CHECK(a.columns[1] == std::vector<double>{1.5, -2000.0});
  CHECK(a.lines == std::vector<int>{4, 5});
  CHECK(a.column("a, long", {}) == 1);
  CHECK(a.column("1", {}) == 0);
  CHECK_THROWS_WITH_AS(static_cast<void>(a.column("3", {"m.toml", 4, 1})),
                       "m.toml:4:1: error: the record 'a.csv' has no column '3'; it has 2 columns",
                       ModelError);
  CHECK(parse_csv("0,5;1\n1,5;2", "b.csv").columns[0] == std::vector<double>{0.5, 1.5});
  CHECK(parse_csv("0,5\t1\n1.5\t2", "c.csv").columns[0] == std::vector<double>{0.5, 1.5});
  CHECK(parse_csv("\xEF\xBB\xBF"
                  "1,2\n",
                  "d.csv")
            .columns[0] == std::vector<double>{1.0});
}

TEST_CASE("records that are no record") {
  CHECK(problem("") == "r.csv: error: the record holds no row of numbers");
  CHECK(problem("t,a\n") == "r.csv: error: the record holds no row of numbers");
  CHECK(problem("0,1\n1\n") == "r.csv:2:1: error: expected 2 columns, got 1");
  CHECK(problem("0,1\n1,2,3\n") == "r.csv:2:1: error: expected 2 columns, got 3");
  CHECK(problem("0,1\n1,\n") == "r.csv:2:1: error: no value in column 2");
  CHECK(problem("0,1\n1,x\n") == "r.csv:2:1: error: 'x' in column 2 is not a number");
  CHECK(problem("0,1\n1,inf\n") == "r.csv:2:1: error: 'inf' in column 2 is not finite");
  CHECK(problem("0,nan\n") == "r.csv:1:1: error: 'nan' in column 2 is not finite");
}

TEST_CASE("written numbers read back as the same doubles") {
  const std::vector<std::string> names{"t [s]", "a,b"};
  CsvText csv(names);
  const std::vector<double> row{0.1, -1.0 / 3.0}, tiny{5e-324, 1.7976931348623157e308};
  csv.add_row(row);
  csv.add_row(tiny);
  CHECK(csv.text() == "t [s],\"a,b\"\n0.1,-0.3333333333333333\n5e-324,1.7976931348623157e+308\n");
  const CsvTable table = parse_csv(csv.text(), "x.csv");
  CHECK(table.columns[1] == std::vector<double>{row[1], tiny[1]});
  CHECK(table.columns[0] == std::vector<double>{row[0], tiny[0]});
}

TEST_CASE("files are whole or absent") {
  const fs::path folder = fs::temp_directory_path() / "steplap_test_files";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string path = (folder / "out.csv").string();
  write_file(path, "one");
  CHECK(content(path) == "one");
  CHECK_THROWS_WITH_AS(write_file(path, "two"),
                       ("'" + path + "' exists already and is not overwritten").c_str(), FileError);
  CHECK(content(path) == "one");
  write_file(path, "two", IfExists::replace);
  CHECK(content(path) == "two");
  CHECK(files_in(folder) == 1);

  const std::string nowhere = (folder / "no" / "out.csv").string();
  CHECK_THROWS_WITH_AS(write_file(nowhere, "x"),
                       ("cannot write '" + nowhere + "': No such file or directory").c_str(),
                       FileError);
  fs::create_directories(folder / "taken");
  CHECK_THROWS_AS(write_file((folder / "taken").string(), "x", IfExists::replace), FileError);
  CHECK(files_in(folder) == 2);
  fs::remove_all(folder);
}

TEST_CASE("a file that does not fit leaves nothing behind") {
  const fs::path folder = fs::temp_directory_path() / "steplap_test_full";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string path = (folder / "out.csv").string();
  write_file(path, "before");

  rlimit usual{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &usual) == 0);
  const rlimit tight{1000, usual.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  REQUIRE(setrlimit(RLIMIT_FSIZE, &tight) == 0);
  std::string message;
  try {
    write_file(path, std::string(100000, 'x'), IfExists::replace);
  } catch (const FileError& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &usual);
  std::signal(SIGXFSZ, handler);

  CHECK(message == "cannot write '" + path + "': File too large");
  CHECK(content(path) == "before");
  CHECK(files_in(folder) == 1);
  fs::remove_all(folder);
}
