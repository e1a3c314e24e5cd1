#include "tools/steplap/model_update.h"

#include "mbd/io/document.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace steplap {

namespace {

// Returns the offset of a location in the text. Columns count characters, which have one to four bytes in UTF-8. Returns nothing beyond the
// end of the text.
std::optional<std::size_t> offset_of(const std::string& text, const Location& where) {
  std::size_t at = 0;
  for (int line = 1; line < where.line; ++line) {
    at = text.find('\n', at);
    if (at == std::string::npos) return std::nullopt;
    ++at;
  }
  const auto continues_character = [&](std::size_t i) { return (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80; };
  for (int column = 1; column < where.column; ++column) {
    if (at >= text.size() || text[at] == '\n') return std::nullopt;
    for (++at; at < text.size() && continues_character(at);) ++at;
  }
  return at;
}

// Returns the offset at which the key's name begins, after a quote; nothing if the text differs.
std::optional<std::size_t> place_of_key(const std::string& text, const RenamedKey& key) {
  std::optional<std::size_t> at = offset_of(text, key.where);
  if (at && *at < text.size() && (text[*at] == '"' || text[*at] == '\'')) ++*at;
  if (!at || text.compare(*at, key.earlier.size(), key.earlier) != 0) return std::nullopt;
  return at;
}

// Returns the offset of the first line that is neither empty nor a comment; the end of the text if there is none.
std::size_t first_statement(const std::string& text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t begin = text.find_first_not_of(" \t\r", at);
    if (begin == std::string::npos) break;
    if (text[begin] != '#' && text[begin] != '\n') return at;
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) break;
    at = end + 1;
  }
  return text.size();
}

void add_format(std::string& text) {
  const bool has_carriage_returns = text.find("\r\n") != std::string::npos;
  const std::string line_end = has_carriage_returns ? "\r\n" : "\n";
  const std::size_t at = first_statement(text);
  std::string line = "format = " + std::to_string(k_file_format) + line_end;
  if (at < text.size() && text[text.find_first_not_of(" \t", at)] == '[') line += line_end; // an empty line before the first table
  if (at > 0 && text[at - 1] != '\n') line = line_end + line;
  text.insert(at, line);
}

} // namespace

ModelUpdate updated(const std::string& text, const std::string& file, const Model& model) {
  ModelUpdate update{text};
  std::vector<std::pair<std::size_t, const RenamedKey*>> places;
  for (const RenamedKey& key : model.renamed_keys) {
    const std::optional<std::size_t> at = key.where.file == file ? place_of_key(text, key) : std::nullopt;
    if (at) places.emplace_back(*at, &key);
    else ++update.missing_keys;
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first == b.first; }), places.end());
  for (auto place = places.rbegin(); place != places.rend(); ++place)
    update.text.replace(place->first, place->second->earlier.size(), place->second->name);
  update.renamed_keys = places.size();
  update.adds_format =
      std::find(model.files_without_format.begin(), model.files_without_format.end(), file) != model.files_without_format.end();
  if (update.adds_format) add_format(update.text);
  return update;
}

} // namespace steplap
