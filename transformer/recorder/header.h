// What stands before a recorder's numbers: lines of keys and values, the family of the recorder, names and units of columns.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace steplap {

/// Does the line say something beside the data: begins with #, * or, where ; does not part fields, with ;?
[[nodiscard]] bool is_comment(std::string_view line, char delimiter);

struct HeaderLine {
  std::size_t number = 0; ///< from 1
  std::string text;
};

/// Keys and values of the lines before the data.
struct Metadata {
  struct Value {
    std::size_t line = 0;
    std::vector<std::string> values; ///< what follows the key, at least one
  };
  std::map<std::string, Value> entries; ///< by key: lower case, letters and digits only

  /// The first of the keys that there is.
  [[nodiscard]] const Value* find(std::initializer_list<const char*> keys) const;
};
/// Keys are parted from their values by : = ; , or a tab, whichever comes first.
[[nodiscard]] Metadata metadata_of(const std::vector<HeaderLine>& lines);

/// A rate of sampling that the lines give, Hz, with its line; from "SampleRate, 100,Hz", "Sampling interval: 5 ms" and the like.
struct SaidRate {
  double hz = 0.0;
  std::size_t line = 0;
};
[[nodiscard]] std::optional<SaidRate> rate_of(const Metadata& metadata);

/// "Gulf Coast Data Concepts", "MSR", …; "" if no line tells.
[[nodiscard]] std::string family_of(const std::vector<HeaderLine>& lines);

/// "Ax" and "Acc. X" as words: {"ax"}, {"acc", "x"}.
[[nodiscard]] std::vector<std::string> words_of(std::string_view name);

/// What a column is by its name.
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
/// How sure: a name such as "Ax" says more than "X". 0: not of that role.
struct NamedRole {
  Role role = Role::other;
  int weight = 0;
};
[[nodiscard]] NamedRole role_of(std::string_view name);

} // namespace steplap
