// Interprets the lines before the data of a recorder's file: keys and values, family of the recorder, names and units of columns.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace steplap {

/// Returns true if the line is a comment: it begins with # or *, or with ; unless ; is the delimiter.
[[nodiscard]] bool is_comment(std::string_view line, char delimiter);

/// A line before the data.
struct HeaderLine {
  std::size_t number = 0; ///< line number, from 1
  std::string text;
};

/// Keys and values in the lines before the data.
struct Metadata {
  struct Value {
    std::size_t line = 0;
    std::vector<std::string> values; ///< text after the key, at least one entry
  };
  std::map<std::string, Value> entries; ///< values by key; keys are reduced to lower case letters and digits

  /// Returns the value of the first of the keys that exists; nullptr if none does.
  [[nodiscard]] const Value* find(std::initializer_list<const char*> keys) const;
};
/// Splits lines into keys and values at the first : = ; , or tab.
[[nodiscard]] Metadata metadata_of(const std::vector<HeaderLine>& lines);

/// A sampling rate given in the header, Hz, with its line: "SampleRate, 100,Hz", "Sampling interval: 5 ms" and similar.
struct HeaderRate {
  double hz = 0.0;
  std::size_t line = 0;
};
/// Returns the sampling rate given in the header; nothing if there is none.
[[nodiscard]] std::optional<HeaderRate> rate_of(const Metadata& metadata);

/// Returns the corner frequency of the recorder's low-pass given in the header, Hz: "Low-pass filter: 80 Hz" and similar.
[[nodiscard]] std::optional<double> low_pass_of(const Metadata& metadata);

/// Returns the family of the recorder: "Gulf Coast Data Concepts", "MSR", …; "" if unknown.
[[nodiscard]] std::string family_of(const std::vector<HeaderLine>& lines);

/// Splits a column name into lower-case words: "Ax" gives {"ax"}, "Acc. X" gives {"acc", "x"}.
[[nodiscard]] std::vector<std::string> words_of(std::string_view name);

/// Meaning of a column according to its name.
enum class Role {
  other,
  time,
  date,
  clock,
  index,
  x,
  y,
  z,
  acceleration,
  magnitude,
  peak_x,
  peak_y,
  peak_z,
  peak,
  duration,
  velocity_change,
  slot
};
/// A role with its confidence: "Ax" has a higher weight than "X"; 0 if the name does not indicate this role.
struct NamedRole {
  Role role = Role::other;
  int weight = 0;
};
/// Returns the most likely role of a column.
[[nodiscard]] NamedRole role_of(std::string_view name);

} // namespace steplap
