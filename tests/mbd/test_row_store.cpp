// Rows beyond what memory is to hold, and text that is fit to be shown.
#include "mbd/base/diagnostics.h"
#include "mbd/base/shown_text.h"
#include "mbd/simulation/row_store.h"

#include <doctest/doctest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

using namespace steplap;

namespace {

// $TMPDIR for a while.
class TemporaryFolder {
public:
  explicit TemporaryFolder(const std::string& path) {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    ::setenv("TMPDIR", path.c_str(), 1);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    if (before_.empty()) ::unsetenv("TMPDIR");
    else ::setenv("TMPDIR", before_.c_str(), 1);
  }

private:
  std::string before_;
};

double number_at(std::size_t row, std::size_t column) { return static_cast<double>(row) + 0.25 * static_cast<double>(column); }

void fill(RowStore& store, std::size_t rows, std::size_t width) {
  for (std::size_t row = store.size(); row < rows; ++row) {
    double* place = store.add_row();
    REQUIRE(place != nullptr);
    for (std::size_t c = 0; c < width; ++c) place[c] = number_at(row, c);
  }
}

std::size_t wrong_numbers(const RowStore& store, std::size_t width, std::size_t stride) {
  std::size_t wrong = 0;
  for (std::size_t i = 0, row = 0; i < store.size(); ++i, row = (row + stride) % store.size())
    for (std::size_t c = 0; c < width; ++c) wrong += store.row(row)[c] != number_at(row, c);
  return wrong;
}

} // namespace

TEST_CASE("rows come back as they went in, from memory and from disk, in any order") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("row_store_" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  const TemporaryFolder here(folder.string());
  for (const std::size_t width : {std::size_t{1}, std::size_t{3}, std::size_t{7}, std::size_t{200}})
    for (const std::size_t most : {std::size_t{1}, std::size_t{64}, std::size_t{1000}, std::size_t{1} << 20}) {
      CAPTURE(width);
      CAPTURE(most);
      RowStore store(width, most);
      for (const std::size_t rows : {std::size_t{1}, std::size_t{2}, std::size_t{90}, std::size_t{503}}) { // read while it grows
        fill(store, rows, width);
        CHECK(store.size() == rows);
        CHECK(wrong_numbers(store, width, 1) == 0);
        CHECK(wrong_numbers(store, width, 211) == 0); // a prime that divides none: every row, far apart
      }
      CHECK(store.is_on_disk() == (503 * width > most));
      CHECK(std::filesystem::is_empty(folder)); // a file without a name: killed, a run leaves nothing
    }
  std::filesystem::remove_all(folder);
}

TEST_CASE("where rows cannot be kept, those before stay and the failure says what to do") {
  const TemporaryFolder nowhere("/no/such/folder");
  RowStore store(4, 64);
  std::size_t kept = 0;
  std::string message;
  try {
    for (std::size_t row = 0; row < 1000; ++row) {
      double* place = store.add_row();
      for (std::size_t c = 0; c < 4; ++c) place[c] = number_at(row, c);
      ++kept;
    }
  } catch (const NumericalFailure& failure) {
    message = failure.what();
  }
  CHECK(message.find("'/no/such/folder'") != std::string::npos);
  CHECK(message.find("TMPDIR") != std::string::npos);
  CHECK(kept >= 16); // as many as the memory allows at least, less the block that was full
  CHECK(store.size() == kept);
  CHECK(wrong_numbers(store, 4, 1) == 0);
  CHECK(store.add_row() == nullptr); // said once
  CHECK(store.size() == kept);
}

TEST_CASE("text fit for a terminal; digits that matter; one is not several") {
  CHECK(shown("a\nb\t\x1b[0m\x7f") == "a\\nb\\t\\x1b[0m\\x7f");
  CHECK(shown("a\nb", true) == "a\nb");
  CHECK(shown("µ°²… ä") == "µ°²… ä"); // UTF-8 stays
  CHECK(shown("\xc2\x9b"
              "31m") == "\\x9b31m"); // U+009B: what ESC [ is in one character
  CHECK(has_control_character("\xc2\x9b"));
  CHECK_FALSE(has_control_character("Größe µ"));
  CHECK_FALSE(has_control_character("– 中 €"));
  for (const char* const hidden : {"\u200b", "\u202e", "\u2066", "\ufeff", "\u061c"}) CHECK(has_control_character(hidden));
  CHECK(shown("a\u202eb") == "a\\u202eb"); // would be read from right to left
  CHECK(rounded_text(1.0000000000000001e-11) == "1e-11");
  CHECK(rounded_text(3.5527e-15, 3) == "3.55e-15");
  CHECK(counted(1, "body", "bodies") == "1 body");
  CHECK(counted(0, "body", "bodies") == "0 bodies");
  CHECK(Diagnostic{{"a\x1b.toml", 1, 2}, "x\n'y'"}.text() == "a\\x1b.toml:1:2: error: x\\n'y'");
}
