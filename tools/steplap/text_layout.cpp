#include "tools/steplap/text_layout.h"

#include <algorithm>
#include <cctype>

namespace steplap {

std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string cut(const std::string& text, std::size_t most) {
  if (width_of(text) <= most) return text;
  std::string kept;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80;
    if (begins && width_of(kept) + 2 > most) break;
    kept += text[i];
  }
  return kept + "…";
}

std::string wrapped(const std::string& text, std::size_t columns, std::size_t indent, std::size_t most_lines) {
  std::string result, line;
  std::size_t lines = 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = std::min(text.find_first_not_of(' ', at), text.size() - 1); // blanks before a word stay with it
    std::size_t end = std::min(text.find(' ', begin), text.size());
    if (std::isdigit(static_cast<unsigned char>(text[end - 1])) && end < text.size()) end = std::min(text.find(' ', end + 1), text.size());
    const std::string word = text.substr(at, end - at);
    if (!line.empty() && width_of(line) + 1 + width_of(word) > columns && lines < most_lines) {
      result += line + "\n";
      line = std::string(indent, ' ') + word;
      ++lines;
    } else {
      line += (at == 0 ? "" : " ") + word;
    }
    at = end + 1;
  }
  return result + cut(line, columns);
}

} // namespace steplap
