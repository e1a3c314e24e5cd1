// Headers that a program on the library includes: each of their public declarations has a /// of its own, beside it or
// in the lines above it. Lines are read, not C++: what is counted is what stands in a namespace, in a struct, in the public
// part of a class or in an enumeration.
#include <doctest/doctest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

enum class Place { names, record, closed, choices }; ///< closed: bodies, private parts, namespaces of details

struct Scope {
  Place place = Place::names;
  bool is_public = true;
  std::string name; ///< of a record
};

struct Undocumented {
  int count = 0;     ///< declarations looked at
  std::string lines; ///< of those without a ///
};

bool starts_with_word(const std::string& text, const char* word) {
  const std::string start = word;
  return text.starts_with(start) &&
         (text.size() == start.size() || !(std::isalnum(static_cast<unsigned char>(text[start.size()])) || text[start.size()] == '_'));
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

// A declaration without its "template <…>".
std::string without_template(const std::string& text) {
  if (!starts_with_word(text, "template")) return text;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    depth += text[i] == '<';
    if (text[i] == '>' && --depth == 0) return trimmed(text.substr(i + 1));
  }
  return text;
}

class Reader {
public:
  explicit Reader(std::string path) : path_(std::move(path)) {}

  Undocumented read(std::istream& lines) {
    std::string line;
    for (number_ = 1; std::getline(lines, line); ++number_) take(line);
    return found_;
  }

private:
  void take(const std::string& line) {
    const std::size_t comment = line.find("//");
    const std::string code = trimmed(line.substr(0, comment));
    const bool has_doc = line.find("///") != std::string::npos;
    if (code.empty()) {
      if (begun_.empty()) is_announced_ = has_doc || (is_announced_ && comment != std::string::npos);
      return;
    }
    if (code.starts_with('#')) return;
    if (scopes_.back().place == Place::closed) return follow(code);
    if (begun_.empty()) {
      if (code == "public:" || code == "private:" || code == "protected:") {
        scopes_.back().is_public = code == "public:";
        is_announced_ = false;
        return;
      }
      if (code.starts_with('}')) return close();
      begins_at_ = number_;
    }
    begun_ += (begun_.empty() ? "" : " ") + code;
    is_announced_ |= has_doc;
    const char end = code.back();
    const bool is_choice = scopes_.back().place == Place::choices;
    if (is_choice ? end != '{' : end == ';' || end == '{' || end == '}') complete();
  }

  // Through what is not looked into.
  void follow(const std::string& code) {
    for (const char c : code) depth_ += (c == '{') - (c == '}');
    if (depth_ == 0) scopes_.pop_back();
  }

  void close() {
    if (scopes_.size() > 1) scopes_.pop_back();
    is_announced_ = false;
  }

  void complete() {
    const std::string text = without_template(begun_);
    const bool opens = begun_.back() == '{';
    if (starts_with_word(text, "namespace")) {
      scopes_.push_back({text.find("detail") == std::string::npos ? Place::names : Place::closed, true, ""});
      depth_ = scopes_.back().place == Place::closed;
    } else {
      if (scopes_.back().is_public && needs_words(text)) {
        ++found_.count;
        if (!is_announced_) found_.lines += path_ + ":" + std::to_string(begins_at_) + ": " + begun_ + "\n";
      }
      if (opens) enter(text);
    }
    begun_.clear();
    is_announced_ = false;
  }

  void enter(const std::string& text) {
    const bool is_class = starts_with_word(text, "class"), is_record = is_class || starts_with_word(text, "struct");
    if (is_record || starts_with_word(text, "enum")) {
      std::istringstream words(text);
      std::string name;
      words >> name >> name;
      scopes_.push_back({is_record ? Place::record : Place::choices, !is_class && scopes_.back().is_public, name});
      if (!is_record) scopes_.back().is_public = scopes_[scopes_.size() - 2].is_public;
    } else {
      scopes_.push_back({Place::closed, false, ""});
      depth_ = 1;
    }
  }

  // What says all there is to say by itself: names declared ahead, copies, destructors, what a base class documents, and the
  // bodies of functions that are declared elsewhere in the header.
  [[nodiscard]] bool needs_words(const std::string& text) const {
    for (const char* word : {"friend", "static_assert"})
      if (starts_with_word(text, word)) return false;
    const bool is_type = starts_with_word(text, "class") || starts_with_word(text, "struct");
    if (is_type && text.back() == ';' && text.find('{') == std::string::npos) return false;
    if (text.starts_with("~") || text.starts_with("virtual ~")) return false;
    for (const char* part : {"= default;", "= delete;", " override;", " override {", "operator="})
      if (text.find(part) != std::string::npos) return false;
    const std::string& owner = scopes_.back().name;
    for (const std::string& copy : {owner + "(const " + owner + "&", owner + "(" + owner + "&&"})
      if (!owner.empty() && text.starts_with(copy)) return false;
    if (scopes_.back().place == Place::names && text.back() != ';') { // Type::function(…) {
      const std::string before = text.substr(0, text.find('('));
      if (before.substr(before.find_last_of(' ') + 1).find("::") != std::string::npos) return false;
    }
    return true;
  }

  std::string path_;
  Undocumented found_;
  std::vector<Scope> scopes_ = {{}};
  std::string begun_; ///< the declaration being read
  bool is_announced_ = false;
  int number_ = 0, begins_at_ = 0, depth_ = 0;
};

Undocumented undocumented_in(const std::string& text) {
  std::istringstream lines(text);
  return Reader("a.h").read(lines);
}

// Public headers whose declarations have their words elsewhere: fields of elements in the table of their kind, laws and roles in
// docs/how-to/use_from_cpp.md.
const std::set<std::string> k_described_elsewhere = {"elements.h", "own_element.h"};

// Headers that the public ones include, as cmake/public_headers.cmake lists them.
std::set<fs::path> listed_headers() {
  const fs::path root = STEPLAP_SOURCE;
  std::ifstream list(root / "cmake/public_headers.cmake");
  std::set<fs::path> headers;
  bool is_entry = false;
  for (std::string line; std::getline(list, line);) {
    const std::string start = "steplap_public_header(";
    if (line.starts_with(start)) is_entry = !k_described_elsewhere.contains(line.substr(start.size(), line.find(' ') - start.size()));
    else if (is_entry) {
      std::istringstream words(line);
      for (std::string word; words >> word;) {
        is_entry = !word.ends_with(')');
        headers.insert(root / word.substr(0, word.find(')')));
      }
    }
  }
  return headers;
}

// The public headers and the folders that users read first.
std::set<fs::path> read_headers() {
  std::set<fs::path> headers = listed_headers();
  for (const char* folder : {"mbd/run", "mbd/model", "mbd/simulation"})
    for (const auto& entry : fs::directory_iterator(fs::path(STEPLAP_SOURCE) / folder))
      if (entry.path().extension() == ".h") headers.insert(entry.path());
  return headers;
}

} // namespace

TEST_CASE("every public declaration of the headers that users meet says what it is") {
  int count = 0;
  std::string lines;
  for (const fs::path& header : read_headers()) {
    std::ifstream text(header);
    REQUIRE(text);
    const Undocumented found = Reader(fs::relative(header, STEPLAP_SOURCE).generic_string()).read(text);
    count += found.count;
    lines += found.lines;
  }
  CHECK_MESSAGE(lines.empty(), lines);
  CHECK(listed_headers().size() > 25);
  CHECK(count > 800); // all headers were read
}

TEST_CASE("a declaration without words is found") {
  CHECK(undocumented_in("namespace n {\n/// Says it.\nint f();\nint g(int a,\n      int b);\nint h(); ///< m\n} // namespace n\n").lines ==
        "a.h:4: int g(int a, int b);\n");
  const Undocumented record = undocumented_in(
      "/// A thing.\nclass A {\npublic:\n  A() = default;\n  int f() const { return 1; }\nprivate:\n  int b;\n};\nint c;\n");
  CHECK(record.lines == "a.h:5: int f() const { return 1; }\na.h:9: int c;\n");
  CHECK(record.count == 3);
  CHECK(undocumented_in("/// A choice.\nenum class E {\n  a, ///< the first\n  b\n};\n").lines == "a.h:4: b\n");
  CHECK(undocumented_in("namespace detail {\nint f();\n}\nint g() {\n  int b;\n  return b;\n}\n").lines == "a.h:4: int g() {\n");
  CHECK(undocumented_in("/// Not of what follows the gap.\n\nint f();\n").lines == "a.h:3: int f();\n");
}
