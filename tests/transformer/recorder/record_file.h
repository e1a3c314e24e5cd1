// Recorders' files made for tests: any family's way of writing with any of its traps, the values that were written, and what a
// reader has to ask for because the file does not say it.
#pragma once

#include "transformer/recorder/reader.h"
#include "transformer/recorder/record_error.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace steplap::test {

struct Sample {
  double t = 0.0;
  std::array<double, 3> a{};
};
using Segments = std::vector<std::vector<Sample>>;

/// Keeps all that is read.
class Keep : public SampleSink {
public:
  void begin(const RecordLayout& layout) override { axes = layout.axes.size(); }
  void begin_segment(std::size_t) override { segments.emplace_back(); }
  void put(double t, const double* a) override {
    Sample sample{t, {}};
    for (std::size_t i = 0; i < axes; ++i) sample.a[i] = a[i];
    segments.back().push_back(sample);
  }
  void end_segment() override {}

  std::size_t axes = 0;
  Segments segments;
};

enum class Encoding { utf8, marked_utf8, utf16_little, utf16_big, utf16_unmarked };
enum class Clock { seconds, milliseconds, iso, local_dots, local_slashes, epoch, days, none };
enum class Scale { g, mg, si, counts_with_scale, counts_alone };
enum class UnitPlace { names, line, header, nowhere };
enum class RowTrap { none, gap, repeated, backward, clipped, missing, comment, block };
enum class Ending { line_break, no_line_break, cut_row, comment };

/// How a file is written.
struct Manner {
  char delimiter = ',', decimal = '.';
  Encoding encoding = Encoding::utf8;
  std::string line_end = "\n";
  char comment = 0; ///< before lines of the header; 0: there are none
  bool has_names = true, are_names_comment = false, has_rate = false, is_ragged = false;
  Clock clock = Clock::seconds;
  bool says_clock_unit = true; ///< of numbers
  Scale scale = Scale::g;
  UnitPlace unit_place = UnitPlace::names;
  RowTrap trap = RowTrap::none;
  Ending ending = Ending::line_break;
  int variant = 0; ///< which of the answers is given, which word stands for a missing value
};

/// What a file leaves open: the option that settles it, and the line where it is asked for (0: any).
struct Open {
  std::string option;
  std::size_t line = 0;
  std::function<void(ReadOptions&)> settle;
};

struct MadeFile {
  std::string text;
  Segments segments;       ///< what has to be read when all is settled
  double time_error = 0.0; ///< s: the digits that the file's times have
  std::vector<Open> open;
  std::vector<std::array<std::size_t, 2>>
      values;                ///< of UTF-8 files: begin and length of each number of an axis or a time in rows that are kept
  std::size_t last_line = 0; ///< number of the last line of rows
};

[[nodiscard]] MadeFile make_file(const Manner& manner, std::uint32_t seed);
/// Any combination that one file can have.
[[nodiscard]] Manner random_manner(std::mt19937& random);
[[nodiscard]] std::string text_of(const Manner& manner);

struct ReadResult {
  Recording recording;
  Segments segments;
};
[[nodiscard]] ReadResult read_text(const std::string& text, const ReadOptions& options = {});
/// The message of a refusal; fails the test if the text is read. `line`: where, 0 for any.
[[nodiscard]] std::string refusal(const std::string& text, const ReadOptions& options, std::size_t line);
[[nodiscard]] bool names_option(const std::string& message, const std::string& option);
/// Answers what is asked until the file is read; each question has to name an option that is open, with line and column.
[[nodiscard]] ReadResult read_and_answer(const MadeFile& made, ReadOptions& options);
void check_same(const Segments& read, const Segments& written, double time_error);

} // namespace steplap::test
