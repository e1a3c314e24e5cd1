// Reads a recorder's file once from beginning to end with bounded memory and passes samples to a sink.
//
// Accelerations are in m/s² along the record's axes. Times are in s: those of the file if it counts seconds, otherwise from its first row.
// A gap, a new block of the file or a step back in time begins a new segment. ReadFacts counts every omission, repetition and split, with
// the line of its first occurrence.
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

/// Receives samples. Times increase within a segment.
class SampleSink {
public:
  virtual ~SampleSink() = default;
  /// Receives the layout of the file, before the first segment.
  virtual void begin(const RecordLayout& layout) = 0;
  virtual void begin_segment(std::size_t line) = 0;
  /// Receives a sample: t in s, one acceleration (m/s²) for each axis of the layout.
  virtual void put(double t, const double* a) = 0;
  virtual void end_segment() = 0;
};

/// Share of the sensor's range at which amplifiers begin to saturate.
inline constexpr double k_saturates = 0.95;

/// Number of occurrences with the line of the first.
struct Counted {
  std::size_t count = 0, line = 0;
  /// Counts an occurrence in line `at`.
  void note(std::size_t at) {
    if (count++ == 0) line = at;
  }
};

/// Statistics of one axis as read, m/s².
struct AxisFacts {
  double least = std::numeric_limits<double>::infinity(), greatest = -std::numeric_limits<double>::infinity();
  double rest = 0.0; ///< mean acceleration at rest: over ReadOptions::rest, otherwise over the first second
  /// Length of the longest sequence of equal samples at the minimum or maximum that is entered or left by a jump; indicates clipping.
  std::size_t flat_longest = 0;
  std::size_t flat_line = 0;
  double flat_value = 0.0;
  Counted beyond_range; ///< samples at or beyond the sensor's range, if the range is known
};

/// An entry of a table of peaks. Values that the table lacks are NaN.
struct PeakEntry {
  double t = 0.0; ///< time from the first entry, s
  std::size_t line = 0;
  std::array<double, 3> axis{};                                  ///< peaks of the axes, m/s²
  double magnitude = 0.0, duration = 0.0, velocity_change = 0.0; ///< magnitude, m/s²; duration, s; velocity change, m/s
};

/// A line among or after the data rows that is not a row: a comment or a title.
struct Remark {
  std::size_t line = 0;
  std::size_t rows = 0; ///< number of samples before this line
  std::string text;
};

/// Missing rows within a segment, across which the segment continues.
struct Hole {
  std::size_t line = 0;                    ///< line of the row after the gap
  double t = 0.0, length = 0.0;            ///< time of the row before the gap; time until the row after it; s
  std::size_t rows = 0;                    ///< number of missing rows
  std::array<double, 3> before{}, after{}; ///< values of the rows before and after the gap, m/s²
};

/// Statistics of the whole file.
struct ReadFacts {
  std::size_t lines = 0, rows = 0, segments = 0; ///< `rows`: samples passed to the sink, except those that ReadOptions::holds filled in
  double first = 0.0, last = 0.0;                ///< times of the first and the last sample, s
  double longest_gap = 0.0;                      ///< longest gap, s
  std::optional<std::array<double, 2>> rest;     ///< given interval at rest, s
  Counted gaps, holes, block_gaps, blocks, comments, short_rows, long_rows, other_rows, missing, repeated, backward, held, midnights;
  std::size_t cut_line = 0;         ///< number of the last line if it was omitted because it is incomplete; 0 otherwise
  std::size_t unended_line = 0;     ///< number of the last line if it has no line break; 0 otherwise
  bool is_unended_left_out = false; ///< the unended line was omitted, because its last number may be incomplete
  std::string last_comment;         ///< comment or other text after the last row
  double longest_block_gap = 0.0;   ///< longest time without samples between two blocks, s; infinite if unknown
  std::vector<Remark> remarks;      ///< first occurrence of each remark, at most k_most_listed
  std::vector<Hole> hole_list;      ///< the first k_most_listed gaps
  static constexpr std::size_t k_most_listed = 100;
  std::array<AxisFacts, 3> axes;
};

/// Contents of a recorder's file, without its samples.
struct Recording {
  RecordLayout layout;
  ReadFacts facts;
  std::vector<PeakEntry> peaks; ///< entries of a table of peaks
};

/// Reads a record. Throws RecordError with line and column if it cannot be read or is ambiguous.
[[nodiscard]] Recording read_record(LineSource& source, const ReadOptions& options, SampleSink& sink);

/// Returns a sentence about a value that is impossible in transport, caused by a wrong unit or scale; "" if there is none.
[[nodiscard]] std::string impossible_reading(const Recording& recording);

/// Describes the layout of the file, and how it was read, in sentences or "key: value" lines.
[[nodiscard]] std::vector<std::string> facts_text(const Recording& recording);

} // namespace steplap
