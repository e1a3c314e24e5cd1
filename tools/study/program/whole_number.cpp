#include "tools/study/program/whole_number.h"

#include "tools/steplap/command.h"

#include <charconv>

namespace steplap {

long whole_number(const std::string& text, const char* option, long least, long most) {
  long value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status == std::errc() && end == text.data() + text.size() && value >= least && value <= most) return value;
  const std::string to = most == std::numeric_limits<long>::max() ? "" : " to " + std::to_string(most);
  throw UsageError(std::string(option) + " takes a whole number from " + std::to_string(least) + to + ", not '" + text + "'");
}

} // namespace steplap
