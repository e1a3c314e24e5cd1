// Kinds of events and their words: one table, and no code that reads the words anywhere else.
#include "mbd/events/event.h"

#include <doctest/doctest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

using namespace steplap;

namespace fs = std::filesystem;

namespace {

std::vector<EventKind> all_kinds() {
  std::vector<EventKind> kinds;
  for (std::size_t i = 1; i < k_event_kinds; ++i) kinds.push_back(static_cast<EventKind>(i));
  return kinds;
}

// The words of a kind, or how they begin: "slips", "force ", "slips another".
bool is_of_event(std::string_view text) {
  if (text.empty()) return false;
  const bool is_beginning = text.find(' ') != std::string_view::npos;
  for (const EventKind kind : all_kinds()) {
    const std::string_view words = words_of(kind);
    if (text == words || (is_beginning && words.starts_with(text))) return true;
  }
  return false;
}

// A line without what follows //, and the texts in it between `quote`s.
struct Line {
  std::string code; ///< with an empty text where one stood
  std::vector<std::string> texts;
};

Line split(const std::string& line, const std::string& quotes) {
  Line result;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line.compare(i, 2, "//") == 0) break;
    result.code += line[i];
    if (quotes.find(line[i]) == std::string::npos) continue;
    const char quote = line[i];
    std::string text;
    for (++i; i < line.size() && line[i] != quote; ++i) {
      if (line[i] == '\\') ++i;
      if (i < line.size()) text += line[i];
    }
    result.texts.push_back(text);
    result.code += quote;
  }
  return result;
}

bool has_any(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    if (text.find(part) != std::string::npos) return true;
  return false;
}

// What is wrong with a line of C++; empty: nothing.
std::string fault_of_code(const std::string& line) {
  const Line parts = split(line, "\"");
  for (const std::string& text : parts.texts)
    if (is_of_event(text)) return "holds the words '" + text + "'";
  const bool has_words = has_any(parts.code, {"words()", "words_of("});
  if (has_words && has_any(parts.code, {"==", "!=", "starts_with", "ends_with", ".find(", ".rfind(", ".compare(", "strcmp"}))
    return "compares words";
  return "";
}

// The page's scripts show words of modes and events; they compare roles (report_data.cpp).
std::string fault_of_script(const std::string& line) {
  for (const char* call : {"=== ", "!== ", "== ", "!= ", "startsWith(", "endsWith(", "includes(", "indexOf(", "match("})
    for (const char* quote : {"'", "\"", "`"})
      for (const EventKind kind : all_kinds())
        if (line.find(std::string(call) + quote + words_of(kind)) != std::string::npos)
          return std::string("compares with '") + words_of(kind) + "'";
  for (const EventKind kind : all_kinds())
    for (const char* begin : {"/^", "/^(", "/(", "/"})
      for (const char* end : {"/", "|"})
        if (line.find(std::string(begin) + words_of(kind) + end) != std::string::npos)
          return std::string("looks for '") + words_of(kind) + "'";
  return "";
}

} // namespace

TEST_CASE("every kind of event has words and a line of explanation, no two the same words") {
  std::set<std::string> known;
  for (const EventKind kind : all_kinds()) {
    const std::string words = words_of(kind);
    CAPTURE(words);
    REQUIRE(!words.empty());
    CHECK(known.insert(words).second);
    CHECK(std::string(doc_of(kind)).size() > words.size() / 2);
    CHECK(words.find_first_of("*?,\"") == std::string::npos); // they stand in CSV, and patterns are matched with them
    CHECK(event_kind_called(words) == kind);
    CHECK(event_kind_of_entry(words) == kind);
    CHECK(event_kind_of_entry(words + " for 2 ms") == kind);
    CHECK(Event{1.0, "foot", kind}.words() == words);
    CHECK(event_kinds_matching(words).to_ullong() == 1ull << static_cast<unsigned>(kind));
  }
  CHECK(known.size() == k_event_kinds - 1);
  CHECK(std::string(words_of(EventKind::none)).empty());
  for (const char* other : {"", "slip", "slipps", "Slips", "slips ", "slips forwards"}) CHECK(!event_kind_called(other));
  CHECK(!event_kind_of_entry("rattles"));
  CHECK(event_kinds_matching("*").count() == k_event_kinds - 1);
}

TEST_CASE("kinds by a pattern, and what a kind is") {
  const EventKinds slips = event_kinds_matching("slips*");
  for (const EventKind kind : all_kinds()) CHECK(slips.test(static_cast<std::size_t>(kind)) == is_slip(kind));
  CHECK(event_kinds_matching("slips").count() == 1);
  CHECK(event_kinds_matching("slipps").none());
  CHECK(is_main(EventKind::opens));
  CHECK(!is_main(EventKind::changes_foot));
  CHECK(!is_main(EventKind::force_returns));
  CHECK(is_kink(EventKind::passes_kink));
  CHECK(!is_kink(EventKind::force_returns));
  CHECK(Event{0.1, "foot", EventKind::storm, "for 2 ms"}.words() == "changes too often to be followed: time stepping for 2 ms");
}

TEST_CASE("code that reads words is told from other code") {
  CHECK(fault_of_code("if (event.what == \"slips\") return;") != "");
  CHECK(fault_of_code("x.what.rfind(\"force \", 0) == 0") != "");
  CHECK(fault_of_code("text.starts_with(\"slips another\")") != "");
  CHECK(fault_of_code("if (a.words() == b.words()) return;") != "");
  CHECK(fault_of_code("words_of(kind)[0] != 's'") != "");
  for (const char* other : {"// \"slips\" is said", "f.doc(\"slips at \\\"once\\\"\");", "channel(\"force\")", "return x.force == 1.0;",
                            "out << event.words() << \" \\\"slips\";", "name = std::string(words_of(kind));"})
    CHECK(fault_of_code(other) == "");
  CHECK(fault_of_script("v[2] === 'opens'") != "");
  CHECK(fault_of_script("v[2].startsWith('slips')") != "");
  CHECK(fault_of_script("{ test: /^(opens|closes)/ }") != "");
  CHECK(fault_of_script("m === 1 ? 'sticks' : 'slips'") == "");
}

// Words for people, kinds for code. Tests may name a kind by its words, through the table.
TEST_CASE("no code reads the words of an event") {
  long files = 0, lines = 0;
  for (const char* room : {"mbd", "elements", "transformer", "tools"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(STEPLAP_SOURCE) / room)) {
      const std::string extension = entry.path().extension(), path = entry.path().string();
      const bool is_script = extension == ".js", is_code = extension == ".cpp" || extension == ".h";
      const bool is_of_another_program = path.find("bench/peers") != std::string::npos; // that steplap is compared with
      const bool is_key = path.find("tools/assess/") != std::string::npos; // "slips" is a key of its files: the number of slips
      const bool has_words = path.ends_with("mbd/run/story.cpp") || path.ends_with("mbd/run/open_end.cpp"); // of sentences, of channels
      if (!(is_script || is_code) || is_of_another_program || is_key || has_words || entry.path().filename() == "event_kind.cpp") continue;
      ++files;
      std::ifstream in(entry.path());
      std::string line;
      for (int number = 1; std::getline(in, line); ++number, ++lines) {
        const std::string fault = is_script ? fault_of_script(line) : fault_of_code(line);
        CHECK_MESSAGE(fault.empty(), path << ":" << number << ": " << fault << ": use EventKind (mbd/base/event_kind.h)");
      }
    }
  CHECK(files > 150);
  CHECK(lines > 15000);
}
