// No function is longer than 70 lines and no file than 600: beyond that they hold two ideas. Bodies are found by their braces,
// after texts and comments are taken out; what a file lists or a kind registers counts as well. And no text of a library
// names an option of the command line: programs that link it have none.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace fs = std::filesystem;

namespace {

constexpr int k_most_lines = 70, k_most_lines_of_file = 600;

const std::vector<std::string> k_library = {"mbd", "elements", "transformer", "run", "report", "explore", "python", "study", "assess"};

// A peer that is measured against: written by hand in one piece, as its measurement says.
const std::string k_left_out = "tools/bench/peers/transformer_minimal.cpp";

struct Source {
  std::string code;               // lines as they were, each text "" and each character '', without comments and directives
  std::vector<std::string> texts; // what stood in the texts
};

bool is_of_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

class Stripper {
public:
  explicit Stripper(std::string_view text) : text_(text) {}

  Source strip() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      const bool is_after_word = at_ > 0 && is_of_word(text_[at_ - 1]);
      if (c == '#' && is_at_line_start()) skip_to(end_of_directive());
      else if (starts("//")) skip_to(text_.find('\n', at_));
      else if (starts("/*")) skip_to(text_.find("*/", at_) + 2);
      else if (starts("R\"") && !is_after_word) take_raw();
      else if (c == '"') take_quoted('"');
      else if (c == '\'' && !(is_after_word && std::isdigit(static_cast<unsigned char>(text_[at_ - 1])))) take_quoted('\'');
      else keep(c);
    }
    return std::move(source_);
  }

private:
  [[nodiscard]] bool starts(std::string_view mark) const { return text_.substr(at_, mark.size()) == mark; }

  [[nodiscard]] bool is_at_line_start() const {
    const std::size_t last = source_.code.find_last_not_of(" \t");
    return last == std::string::npos || source_.code[last] == '\n';
  }

  [[nodiscard]] std::size_t end_of_directive() const {
    std::size_t end = text_.find('\n', at_);
    while (end != std::string::npos && text_[end - 1] == '\\') end = text_.find('\n', end + 1);
    return end;
  }

  void keep(char c) {
    source_.code += c;
    ++at_;
  }

  void skip_to(std::size_t end) {
    end = std::min(end, text_.size());
    source_.code.append(
        static_cast<std::size_t>(std::count(text_.begin() + static_cast<long>(at_), text_.begin() + static_cast<long>(end), '\n')), '\n');
    at_ = end;
  }

  void take_quoted(char quote) {
    std::size_t end = at_ + 1;
    while (end < text_.size() && text_[end] != quote) end += text_[end] == '\\' ? 2 : 1;
    if (quote == '"') source_.texts.emplace_back(text_.substr(at_ + 1, end - at_ - 1));
    source_.code += {quote, quote};
    skip_to(end + 1);
  }

  void take_raw() {
    const std::size_t open = text_.find('(', at_);
    const std::string close = ")" + std::string(text_.substr(at_ + 2, open - at_ - 2)) + "\"";
    const std::size_t end = text_.find(close, open);
    source_.texts.emplace_back(text_.substr(open + 1, end - open - 1));
    source_.code += "\"\"";
    skip_to(end + close.size());
  }

  std::string_view text_;
  std::size_t at_ = 0;
  Source source_;
};

struct Function {
  std::string head; // its last line
  int line = 0, lines = 0;
};

// What is before a brace, from its first line that is not empty.
std::string head_of(const std::string& text) {
  std::istringstream lines(text);
  std::string head;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first != std::string::npos) head += (head.empty() ? "" : "\n") + line.substr(first);
  }
  return head;
}

// A namespace, a class or an enumeration: what is looked into.
bool is_scope(std::string head) {
  if (head.starts_with("template")) head = head.substr(std::min(head.size(), head.find('>') + 1));
  for (const char* word : {"namespace", "inline namespace", "class", "struct", "union", "enum", "extern"}) {
    const std::size_t at = head.find_first_not_of(" \n");
    const std::string start = word;
    if (at != std::string::npos && head.compare(at, start.size(), start) == 0 && !is_of_word((head + " ")[at + start.size()]))
      return head.find(')') == std::string::npos;
  }
  return false;
}

// All that stands between outermost braces which are no scope: functions, and lists. Lambdas and local types are of the function
// that they stand in.
std::vector<Function> functions_in(const std::string& code) {
  std::vector<Function> found;
  std::vector<bool> is_scope_open;
  std::size_t since = 0, depth = 0; // braces within a function
  int line = 1, begins = 0;
  std::string head;
  for (std::size_t i = 0; i < code.size(); ++i) {
    const char c = code[i];
    if (c == '\n') ++line;
    if (c == '{') {
      if (depth > 0) ++depth;
      else if (head = head_of(code.substr(since, i - since)); is_scope(head)) is_scope_open.push_back(true);
      else {
        depth = 1;
        begins = line - static_cast<int>(std::count(head.begin(), head.end(), '\n'));
      }
    } else if (c == '}') {
      if (depth == 0 && !is_scope_open.empty()) is_scope_open.pop_back();
      else if (depth > 0 && --depth == 0) found.push_back({head.substr(head.find_last_of('\n') + 1), begins, line - begins + 1});
    }
    if (depth == 0 && (c == '{' || c == '}' || c == ';')) since = i + 1;
  }
  return found;
}

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::vector<std::string> sources_in(const std::vector<std::string>& rooms) {
  std::vector<std::string> sources;
  for (const std::string& room : rooms)
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(STEPLAP_SOURCE) / room))
      if (const auto ending = entry.path().extension(); ending == ".cpp" || ending == ".h")
        sources.push_back(fs::relative(entry.path(), STEPLAP_SOURCE).generic_string());
  return sources;
}

Source stripped(const std::string& path) { return Stripper(text_of(fs::path(STEPLAP_SOURCE) / path)).strip(); }

// "--restart", or " -o" by itself; not a variable of a style sheet, "var(--ink)" or "--ink:".
bool names_option(const std::string& text) {
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at + 2)) {
    const bool is_at_start = at == 0 || text[at - 1] == ' ' || text[at - 1] == '(' || text[at - 1] == '`';
    const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", at + 2);
    const bool is_of_style =
        (at >= 4 && text.compare(at - 4, 4, "var(") == 0) || (end != std::string::npos && text.compare(end, 2, ":#") == 0);
    if (is_at_start && !is_of_style && at + 2 < text.size() && std::islower(static_cast<unsigned char>(text[at + 2]))) return true;
  }
  const std::size_t at = (" " + text + " ").find(" -o");
  return at != std::string::npos && !is_of_word((" " + text + " ")[at + 3]);
}

} // namespace

TEST_CASE("no function is longer than 70 lines, no file than 600") {
  std::vector<std::string> rooms = k_library;
  rooms.insert(rooms.end(), {"tools", "tests", "examples"});
  int functions = 0;
  for (const std::string& path : sources_in(rooms)) {
    const Source source = stripped(path);
    const long lines = std::count(source.code.begin(), source.code.end(), '\n');
    CHECK_MESSAGE(lines <= k_most_lines_of_file, path << ": " << lines << " lines");
    for (const Function& f : functions_in(source.code)) {
      ++functions;
      if (path != k_left_out) CHECK_MESSAGE(f.lines <= k_most_lines, path << ":" << f.line << ": " << f.lines << " lines: " << f.head);
    }
  }
  CHECK(functions > 8000); // it has read the sources
}

TEST_CASE("no text of a library names an option of the command line") {
  int texts = 0;
  for (const std::string& path : sources_in(k_library))
    for (const std::string& text : stripped(path).texts) {
      ++texts;
      CHECK_MESSAGE(!names_option(text), path << ": \"" << text << "\"");
    }
  CHECK(texts > 5000);
}

TEST_CASE("lengths are counted past texts, comments and scopes, with all that a function holds") {
  const std::string code = R"--(namespace n {
#define X {
struct A {
  int f() const { // }
    return '}' + '"' + 1'000;
  }
  int b = 0;
};
template <class T>
void g(T t,
       int u) {
  const auto h = [&] {
    const char* s = "}" R"(}
})";
  };
  /* }
  } */
}
const int k[] = {
    1};
} // namespace n
)--";
  const std::vector<Function> found = functions_in(Stripper(code).strip().code);
  REQUIRE(found.size() == 3);
  CHECK(found[0].line == 4);
  CHECK(found[0].lines == 3);
  CHECK(found[1].line == 9);
  CHECK(found[1].lines == 10);
  CHECK(found[1].head == "int u) ");
  CHECK(found[2].lines == 2);
  CHECK(Stripper(code).strip().texts.size() == 2);
}

TEST_CASE("an option is told from other dashes") {
  for (const char* text : {"--restart", "with -o", "ask (--x)", "-o names another", "type `--set`"}) CHECK(names_option(text));
  for (const char* text : {"--", "a -- b", "a--b", "x -other", "-1", "fill:var(--ink)", "--ink:#fff"}) CHECK_FALSE(names_option(text));
}
