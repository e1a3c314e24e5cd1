#include "mbd/base/number_text.h"

#include <charconv>

namespace steplap {

void append_number(std::string& text, double value) {
  char buffer[32];
  const auto [end, status] = std::to_chars(buffer, buffer + sizeof buffer, value);
  text.append(buffer, end);
}

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

} // namespace steplap
