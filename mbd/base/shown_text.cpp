#include "mbd/base/shown_text.h"

#include <algorithm>
#include <cstdio>

namespace steplap {

namespace {

struct HiddenCharacter {
  unsigned code = 0;      // Unicode
  std::size_t length = 0; // bytes; 0: the character is visible
};

// Recognises characters that control a terminal (ASCII, U+0080 … U+009F) and those that hide or reorder text: zero-width characters
// (U+200B … U+200D, U+2060 … U+2064, U+FEFF) and bidirectional controls (U+061C, U+200E, U+200F, U+202A … U+202E, U+2066 … U+2069).
HiddenCharacter hidden_at(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  const unsigned first = byte(i);
  if (first < 0x20 || first == 0x7f) return {first, 1};
  const unsigned two = (first & 0x1fU) << 6U | (byte(i + 1) & 0x3fU);
  if ((first & 0xe0U) == 0xc0 && ((two >= 0x80 && two < 0xa0) || two == 0x61c)) return {two, 2};
  const unsigned three = (first & 0x0fU) << 12U | (byte(i + 1) & 0x3fU) << 6U | (byte(i + 2) & 0x3fU);
  const bool is_hidden = (three >= 0x200b && three <= 0x200f) || (three >= 0x202a && three <= 0x202e) ||
                         (three >= 0x2060 && three <= 0x2069) || three == 0xfeff;
  return (first & 0xf0U) == 0xe0 && is_hidden ? HiddenCharacter{three, 3} : HiddenCharacter{};
}

} // namespace

bool has_control_character(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (hidden_at(text, i).length > 0) return true;
  return false;
}

std::string shown(std::string_view text, bool keeps_lines) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const HiddenCharacter hidden = hidden_at(text, i);
    if (hidden.length == 0 || (keeps_lines && c == '\n')) {
      result += c;
      continue;
    }
    if (c == '\n') result += "\\n";
    else if (c == '\t') result += "\\t";
    else if (c == '\r') result += "\\r";
    else {
      char code[16];
      std::snprintf(code, sizeof code, hidden.code < 0x100 ? "\\x%02x" : "\\u%04x", hidden.code);
      result += code;
    }
    i += hidden.length - 1;
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
