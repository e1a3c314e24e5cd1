// No text of the library names an option of the command line, because programs that link the library have no such options.
// Texts are string literals; comments and preprocessor directives are skipped.
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

const std::vector<std::string> k_library = {"mbd",           "elements",     "transformer", "tools/pages",
                                            "tools/explore", "tools/python", "tools/study", "tools/assess"};
const std::vector<std::string> k_programs = {"tools/study/program/", "transformer/recorder/"}; ///< speak to users of the command line

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

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::vector<std::string> sources_in(const std::vector<std::string>& folders) {
  std::vector<std::string> sources;
  for (const std::string& folder : folders)
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(STEPLAP_SOURCE) / folder))
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

TEST_CASE("no text of the library names an option of the command line") {
  int texts = 0;
  for (const std::string& path : sources_in(k_library)) {
    if (std::any_of(k_programs.begin(), k_programs.end(), [&](const std::string& folder) { return path.starts_with(folder); })) continue;
    for (const std::string& text : stripped(path).texts) {
      ++texts;
      CHECK_MESSAGE(!names_option(text), path << ": \"" << text << "\"");
    }
  }
  CHECK(texts > 5000);
}

TEST_CASE("texts are found past comments, directives and raw strings") {
  const std::string code = R"--(#define X "directive"
// "comment"
/* "comment" */
const char* s = "}" R"(}
"})";
const char c = '"';
const int n = 1'000;
)--";
  CHECK(Stripper(code).strip().texts == std::vector<std::string>{"}", "}\n\"}"});
}

TEST_CASE("an option is distinguished from other dashes") {
  for (const char* text : {"--restart", "with -o", "ask (--x)", "-o names another", "type `--set`"}) CHECK(names_option(text));
  for (const char* text : {"--", "a -- b", "a--b", "x -other", "-1", "fill:var(--ink)", "--ink:#fff"}) CHECK_FALSE(names_option(text));
}
