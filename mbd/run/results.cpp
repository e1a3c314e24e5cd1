#include "mbd/run/results.h"

#include "mbd/io/atomic_file.h"
#include "mbd/io/digest.h"
#include "mbd/run/ordered_json.h"
#include "mbd/run/result_files.h"
#include "mbd/simulation/trajectory.h"

#include <sys/stat.h>

#include <array>
#include <charconv>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

namespace steplap {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void damaged(const fs::path& file, std::size_t line, const std::string& what) {
  throw FileError(
      file.string(),
      "'" + file.string() + "', line " + std::to_string(line) + ": " + what + "; it is not as steplap wrote it: run the model again", line);
}

// Splits a row of CSV into cells and removes quotes.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && is_quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"') {
      is_quoted = !is_quoted;
    } else if (c == ',' && !is_quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

// Splits "front foot.force [N]".
ResultChannel channel_of(const std::string& head) {
  ResultChannel channel;
  const std::size_t bracket = head.rfind(" [");
  const bool has_unit = bracket != std::string::npos && head.back() == ']';
  channel.name = has_unit ? head.substr(0, bracket) : head;
  if (has_unit) channel.unit = head.substr(bracket + 2, head.size() - bracket - 3);
  return channel;
}

double number_of(const char*& begin, const char* end, const fs::path& file, std::size_t line) {
  double value = 0.0;
  const auto [next, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || (next != end && *next != ',')) damaged(file, line, "not a number");
  begin = next;
  return value;
}

void read_trajectory(const fs::path& file, Results& results) {
  std::ifstream lines(file, std::ios::binary);
  if (!lines) throw FileError(file.string(), "cannot read '" + file.string() + "'");
  std::string line;
  if (!std::getline(lines, line)) damaged(file, 1, "empty");
  const std::vector<std::string> heads = cells_of(line);
  if (heads.front() != "t [s]") damaged(file, 1, "the first column is not 't [s]'");
  for (std::size_t i = 1; i < heads.size(); ++i) results.channels.push_back(channel_of(heads[i]));
  for (std::size_t number = 2; std::getline(lines, line); ++number) {
    if (line.starts_with('#')) continue;
    const char *at = line.data(), *end = at + line.size();
    results.times.push_back(number_of(at, end, file, number));
    for (ResultChannel& channel : results.channels) {
      if (at == end) damaged(file, number, "fewer numbers than columns");
      channel.values.push_back(number_of(++at, end, file, number));
    }
    if (at != end) damaged(file, number, "more numbers than columns");
  }
  if (results.times.empty()) damaged(file, 2, "no rows");
}

void read_events(const fs::path& file, Results& results) {
  std::istringstream lines(read_text(file.string()));
  std::string line;
  std::getline(lines, line);
  const std::size_t columns = cells_of(line).size() > 3 ? 4 : 3; // the optional fourth column contains errors of the times
  for (std::size_t number = 2; std::getline(lines, line); ++number) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != columns) damaged(file, number, "an event has a time, an element and what happened");
    const auto value = [&](const std::string& cell) {
      const char* at = cell.data();
      return number_of(at, at + cell.size(), file, number);
    };
    ResultEvent event{value(cells[0]), cells[1], cells[2], event_kind_of_entry(cells[2]).value_or(EventKind::none)};
    if (columns > 3) event.error = cells[3] == "unknown" ? std::numeric_limits<double>::quiet_NaN() : value(cells[3]);
    results.events.push_back(std::move(event));
  }
}

std::string date_of(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return "";
  std::tm utc{};
  gmtime_r(&status.st_mtime, &utc);
  char text[32];
  return std::string(text, std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc));
}

// Returns a hint if the path is something that users may confuse with the folder of a run; "" otherwise.
std::string something_else(const fs::path& path) {
  std::error_code ignored;
  const std::string name = "'" + path.string() + "'";
  if (fs::is_regular_file(path, ignored)) {
    constexpr std::string_view k_sqlite = "SQLite format 3";
    std::string head(k_sqlite.size(), ' ');
    std::ifstream(path, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
    if (head == k_sqlite) return name + " is the file of a study, not the folder of a run: read it with steplap study report";
    const fs::path parent = path.parent_path();
    if (fs::exists(parent / "summary.json", ignored) || fs::exists(parent / "partial_summary.json", ignored))
      return name + " is a file: name the folder of the run, '" + parent.string() + "'";
    return "";
  }
  if (fs::exists(path / "record.json", ignored))
    return name + " is the folder of a record, not of a run: see record.json and events.csv there";
  for (const fs::directory_entry& entry : fs::directory_iterator(path, ignored))
    if (fs::exists(entry.path() / "summary.json", ignored))
      return name + " holds folders of runs: name one of them, as '" + entry.path().string() + "'";
  return "";
}

// Returns "" or "partial_", the prefix of the file names.
std::string prefix_in(const fs::path& folder) {
  std::error_code ignored;
  for (const std::string prefix : {"", "partial_"})
    if (fs::exists(folder / (prefix + "summary.json"), ignored)) return prefix;
  if (const std::string other = something_else(folder); !other.empty()) throw FileError(folder.string(), other);
  if (!fs::is_directory(folder, ignored))
    throw FileError(folder.string(), "'" + folder.string() + "' is not a folder: name the folder of a run, as in out/<model>");
  throw FileError(folder.string(), "'" + folder.string() + "' holds no results (no summary.json): run steplap simulate first");
}

[[noreturn]] void changed(const fs::path& file, const std::string& how) {
  throw FileError(file.string(), "'" + file.string() + "' is not as steplap wrote it: " + how + ". Run the model again");
}

std::string digest_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  Sha256 digest;
  for (std::array<char, 1 << 16> part{}; stream.read(part.data(), part.size()), stream.gcount() > 0;)
    digest.add({part.data(), static_cast<std::size_t>(stream.gcount())});
  return digest.hex();
}

// Checks the summary's own digest and the digests of all other files.
void check_files(const fs::path& file, const std::string& summary, const std::string& prefix) {
  const std::string_view content = checked_content(summary);
  if (content.empty()) changed(file, "its checksum is not that of its text, or is missing");
  const OrderedJson json = parse_ordered(std::string(content) + "}");
  for (const char* const name : {"trajectory.csv", "events.csv", "model.toml", "drawing.json"}) {
    const fs::path path = file.parent_path() / (prefix + name);
    const OrderedJson& wanted = json.at("files").at(prefix + name); // exists: the digest of the summary is correct
    std::error_code error;
    const auto bytes = fs::file_size(path, error);
    if (error) throw FileError(path.string(), "'" + path.string() + "' is missing: the results are not whole, run the model again");
    if (bytes != wanted.at("bytes").get<std::uintmax_t>())
      changed(path, "it has " + std::to_string(bytes) + " bytes, and had " + std::to_string(wanted.at("bytes").get<std::uintmax_t>()));
    if (digest_of(path) != wanted.at("sha256").get<std::string>()) changed(path, "it has as many bytes, but others");
  }
}

} // namespace

std::string read_text(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw FileError(file, "cannot read '" + file + "'");
  return std::move(text).str();
}

Results read_results(const std::string& folder, Reading reading) {
  const fs::path path = folder;
  const std::string prefix = prefix_in(path);
  const auto file = [&](const char* name) {
    fs::path found = path / (prefix + name);
    std::error_code ignored;
    if (!fs::exists(found, ignored))
      throw FileError(found.string(), "'" + found.string() + "' is missing: the results are not whole, run the model again");
    return found;
  };
  Results results;
  results.summary = read_text(file("summary.json").string());
  check_files(file("summary.json"), results.summary, prefix);
  results.folder = folder;
  results.name = fs::absolute(path / "").lexically_normal().parent_path().filename().string();
  results.is_partial = !prefix.empty();
  if (reading == Reading::all) read_trajectory(file("trajectory.csv"), results);
  read_events(file("events.csv"), results);
  results.model = read_text(file("model.toml").string());
  results.drawing = read_text(file("drawing.json").string());
  results.model_date = date_of(file("model.toml"));
  return results;
}

std::vector<const ResultChannel*> matching_channels(const Results& results, const std::string& pattern) {
  std::vector<const ResultChannel*> found;
  for (const ResultChannel& channel : results.channels)
    if (matches_pattern(channel.name, pattern)) found.push_back(&channel);
  return found;
}

} // namespace steplap
