// A recorder's file read once, from its first line to its last, in bounded memory: samples go to a sink as they come.
//
// Accelerations are handed on in m/s² along the record's axes, times in s: those of the file where it counts seconds, else from its
// first row. A gap, a new block of the file or a step back in time begins a new segment. Nothing is changed in silence: what was
// left out, held or split is counted in ReadFacts with the first line where it happened.
#pragma once

#include "transformer/recorder/layout.h"
#include "transformer/recorder/line_source.h"
#include "transformer/recorder/read_options.h"

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace steplap {

/// Takes samples. Times rise within a segment.
class SampleSink {
public:
  virtual ~SampleSink() = default;
  /// Before the first segment: what the file was taken for.
  virtual void begin(const RecordLayout& layout) = 0;
  virtual void begin_segment(std::size_t line) = 0;
  /// t in s, one acceleration (m/s²) for each axis of the layout.
  virtual void put(double t, const double* a) = 0;
  virtual void end_segment() = 0;
};

/// How often something happened, and the line of the first.
struct Counted {
  std::size_t count = 0, line = 0;
  void note(std::size_t at) {
    if (count++ == 0) line = at;
  }
};

/// Values of one axis as they were read, m/s².
struct AxisFacts {
  double least = std::numeric_limits<double>::infinity(), greatest = -std::numeric_limits<double>::infinity();
  double rest = 0.0;            ///< mean of the first second
  std::size_t flat_longest = 0; ///< samples in a row at an end of the values, entered or left by a jump: clipped, as it seems
  std::size_t flat_line = 0;
  double flat_value = 0.0;
  Counted beyond_range; ///< at or beyond the sensor's range, where a line says it
};

/// An entry of a table of peaks; what the table does not give is NaN.
struct PeakEntry {
  double t = 0.0; ///< s from the first entry
  std::size_t line = 0;
  std::array<double, 3> axis{};                                  ///< m/s²
  double magnitude = 0.0, duration = 0.0, velocity_change = 0.0; ///< m/s², s, m/s
};

/// A line among or after the rows that is no row: a comment, or a title.
struct Remark {
  std::size_t line = 0;
  std::size_t rows = 0; ///< samples before it
  std::string text;
};

/// Rows that are missing within a segment, which goes on over them.
struct Hole {
  std::size_t line = 0;                    ///< of the row after it
  double t = 0.0, length = 0.0;            ///< s: time of the row before; from there to the row after
  std::size_t rows = 0;                    ///< that are missing
  std::array<double, 3> before{}, after{}; ///< m/s², of the rows next to it
};

struct ReadFacts {
  std::size_t lines = 0, rows = 0, segments = 0; ///< rows: samples handed on, those that were held not counted
  double first = 0.0, last = 0.0;                ///< s
  double longest_gap = 0.0;                      ///< s
  Counted gaps, holes, block_gaps, blocks, comments, short_rows, other_rows, missing, repeated, backward, held, midnights;
  std::size_t cut_line = 0;         ///< the last line, left out because it is cut; 0: it is not
  std::size_t unended_line = 0;     ///< the last line, if no line break ends it; 0: one does
  bool is_unended_left_out = false; ///< it was left out, as its last number may lack digits
  std::string last_comment;         ///< after the last row: a comment, or a line of text
  double longest_block_gap = 0.0;   ///< s without a sample between two blocks, at most; infinite: their times do not tell
  std::vector<Remark> remarks;      ///< the first of each text, k_most_listed at most
  std::vector<Hole> hole_list;      ///< the first k_most_listed
  static constexpr std::size_t k_most_listed = 100;
  std::array<AxisFacts, 3> axes;
};

struct Recording {
  RecordLayout layout;
  ReadFacts facts;
  std::vector<PeakEntry> peaks; ///< of a table of peaks
};

/// Throws RecordError with line and column for whatever cannot be read or known.
[[nodiscard]] Recording read_record(LineSource& source, const ReadOptions& options, SampleSink& sink);

/// What the file was taken for and what happened to it, in whole sentences or "key: value" lines for people.
[[nodiscard]] std::vector<std::string> facts_text(const Recording& recording);

} // namespace steplap
