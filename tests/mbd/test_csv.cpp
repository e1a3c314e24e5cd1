// Records in, histories out, and files that are written as a whole or not at all.
#include "mbd/base/number_text.h"
#include "mbd/io/atomic_file.h"
#include "mbd/io/csv.h"
#include "tests/sanitized.h"

#include <doctest/doctest.h>

#include <sys/resource.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

using namespace steplap;
using steplap::testing::k_is_sanitized;
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
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator{}));
}

} // namespace

TEST_CASE("delimiters, comments, headers, decimal commas") {
  const CsvTable a = parse_csv("# stop\n\ntime [s], \"a, long\"\r\n0, 1.5\r\n+0.1,-2e3\r\n", "a.csv");
  CHECK(a.names == std::vector<std::string>{"time", "a, long"});
  CHECK(a.columns[1] == std::vector<double>{1.5, -2000.0});
  CHECK(a.lines == std::vector<int>{4, 5});
  CHECK(a.column("a, long", {}) == 1);
  CHECK(a.column("1", {}) == 0);
  CHECK_THROWS_WITH_AS(static_cast<void>(a.column("3", {"m.toml", 4, 1})),
                       "m.toml:4:1: error: the record 'a.csv' has no column '3'; it has 2 columns", ModelError);
  CHECK(parse_csv("0,5;1\n1,5;2", "b.csv").columns[0] == std::vector<double>{0.5, 1.5});
  CHECK(parse_csv("0,5\t1\n1,5\t2", "c.csv").columns[0] == std::vector<double>{0.5, 1.5});
  CHECK(parse_csv("0.5\t1\n1.5\t2", "c.csv").columns[0] == std::vector<double>{0.5, 1.5});
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
  CHECK(problem("0,\n") == "r.csv:1:1: error: no value in column 2");
  CHECK(problem("0,1 000\n") == "r.csv:1:1: error: '1 000' in column 2 is not a number");
  CHECK(problem("0,nan\n") == "r.csv:1:1: error: 'nan' in column 2 is not finite");
}

TEST_CASE("written numbers read back as the same doubles") {
  const std::vector<std::string> names{"t [s]", "a,b", "#c"};
  CsvText csv(names);
  const std::vector<double> row{0.1, -1.0 / 3.0, 1.0}, tiny{5e-324, 1.7976931348623157e308, 2.0};
  csv.add_row(row);
  csv.add_row(tiny);
  CHECK(csv.text() == "t [s],\"a,b\",\"#c\"\n0.1,-0.3333333333333333,1\n5e-324,1.7976931348623157e+308,2\n");
  const CsvTable table = parse_csv(csv.text(), "x.csv");
  CHECK(table.columns[1] == std::vector<double>{row[1], tiny[1]});
  CHECK(table.columns[0] == std::vector<double>{row[0], tiny[0]});
}

// The C++ library's own way is the reference: it finds the digits otherwise (Ryu), and chooses the notation by itself.
TEST_CASE("numbers are the text that the C++ library makes of them") {
  const auto reference = [](double value) {
    char buffer[400];
    return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  };
  int wrong = 0;
  const auto compare = [&](double value) {
    for (const double x : {value, -value})
      if (number_text(x) != reference(x) && ++wrong < 10) CHECK(number_text(x) == reference(x));
  };
  for (const double value : {0.0,
                             1.0,
                             5e-324,
                             2.2250738585072014e-308,
                             1.7976931348623157e308,
                             9007199254740993.0,
                             1e22,
                             1e23,
                             123456e5,
                             1e5,
                             1e4,
                             99999.0,
                             100000.0,
                             0.001,
                             0.0001,
                             0.00012,
                             1e-5,
                             2e-4,
                             4.35,
                             0.3,
                             std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()})
    compare(value);
  for (int exponent = -1074; exponent < 1024; ++exponent) // the interval of a power of two reaches less far down
    for (const double factor : {1.0, std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0)}) compare(factor * std::ldexp(1.0, exponent));
  std::mt19937_64 random(1);
  const int count = k_is_sanitized ? 20000 : 500000;
  for (int i = 0; i < count; ++i) {
    const auto bits = random();
    compare(std::bit_cast<double>(bits)); // of all sizes
    const double of_one = static_cast<double>(bits >> 11) * 0x1p-53;
    compare((of_one - 0.5) * 1e3);                   // as results are
    const auto digits = static_cast<int>(bits % 17); // with few digits, and whole numbers
    const double power = std::pow(10.0, digits);
    compare(std::round(of_one * power) / power);
    compare(std::round(of_one * power) * 100.0);
    // And those beside them, whose seventeenth digit lies nearest to where it would be another.
    const double decimal = std::round(of_one * power) * std::pow(10.0, static_cast<double>(bits >> 8 & 63U) - 32.0);
    for (const double x : {decimal, std::nextafter(decimal, 0.0), std::nextafter(decimal, std::numeric_limits<double>::infinity())})
      compare(x);
  }
  CHECK(wrong == 0);
}

// Fields that repeat are copied from the row before, also behind a comment and where a part of the text was taken away.
TEST_CASE("a row is the same text wherever it stands") {
  const std::vector<std::string> names{"a", "b", "c"};
  std::mt19937 random(2);
  const std::vector<double> values{0.0, -0.0, 1.0, -1.0 / 3.0, -1.2345678901234567e-308, std::numeric_limits<double>::quiet_NaN()};
  CsvText whole(names);
  std::string expected = whole.text(), parts = whole.text();
  CsvText part(names);
  part.clear();
  for (int i = 0; i < 300; ++i) {
    std::vector<double> row;
    for (int k = 0; k < 3; ++k) row.push_back(values[random() % values.size()]);
    expected += number_text(row[0]) + "," + number_text(row[1]) + "," + number_text(row[2]) + "\n";
    whole.add_row(row);
    part.add_row(row);
    if (i % 7 == 0) {
      whole.add_comment("# and");
      part.add_comment("# and");
      expected += "# and\n";
    }
    if (i % 11 != 0) continue;
    parts += part.text();
    part.clear();
  }
  CHECK(whole.text() == expected);
  CHECK(parts + part.text() == expected);
  CsvText narrow({});
  narrow.add_row({});
  CHECK(narrow.text() == "\n\n");
}

TEST_CASE("files are whole or absent") {
  const fs::path folder = fs::temp_directory_path() / "steplap_test_files";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string path = (folder / "out.csv").string();
  write_file(path, "one");
  CHECK(content(path) == "one");
  CHECK_THROWS_WITH_AS(write_file(path, "two"), ("'" + path + "' exists already and is not overwritten").c_str(), FileError);
  CHECK(content(path) == "one");
  write_file(path, "two", IfExists::replace);
  CHECK(content(path) == "two");
  CHECK(files_in(folder) == 1);
  // The target of a link is replaced; the link and the permissions remain.
  const fs::path link = folder / "link.csv";
  fs::create_symlink(path, link);
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  write_file(link.string(), "three", IfExists::replace);
  CHECK(fs::is_symlink(link));
  CHECK(content(path) == "three");
  CHECK(fs::status(path).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
  fs::remove(link);
  CHECK(files_in(folder) == 1);

  const std::string nowhere = (folder / "no" / "out.csv").string();
  CHECK_THROWS_WITH_AS(write_file(nowhere, "x"), ("cannot write '" + nowhere + "': No such file or directory").c_str(), FileError);
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
