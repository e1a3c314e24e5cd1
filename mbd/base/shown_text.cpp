#include "mbd/base/shown_text.h"

#include <algorithm>
#include <cstdio>

namespace steplap {

namespace {

// Returns true for ASCII control characters and for the second byte of U+0080 … U+009F, the control characters of eight-bit terminals.
bool is_control(std::string_view text, std::size_t i) {
  const auto c = static_cast<unsigned char>(text[i]);
  if (c < 0x20 || c == 0x7f) return true;
  return i > 0 && static_cast<unsigned char>(text[i - 1]) == 0xc2 && c >= 0x80 && c < 0xa0;
}

} // namespace

bool has_control_character(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (is_control(text, i)) return true;
  return false;
}

std::string shown(std::string_view text, bool keeps_lines) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (!is_control(text, i) || (keeps_lines && c == '\n')) {
      result += c;
      continue;
    }
    if (c == '\n') result += "\\n";
    else if (c == '\t') result += "\\t";
    else if (c == '\r') result += "\\r";
    else {
      if (static_cast<unsigned char>(c) >= 0x80) result.pop_back(); // removes the first byte of the two-byte character
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
      result += code;
    }
  }
  return result;
}

std::string rounded_text(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", std::clamp(digits, 1, 17), value);
  return text;
}

std::string counted(std::size_t count, std::string_view one, std::string_view several) {
  return std::to_string(count) + " " + std::string(count == 1 ? one : several);
}

} // namespace steplap
