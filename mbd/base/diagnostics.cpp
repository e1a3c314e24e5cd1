#include "mbd/base/diagnostics.h"

#include "mbd/base/shown_text.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace steplap {

std::string Diagnostic::text() const {
  std::string place;
  if (!where.file.empty()) {
    place = where.file + ":";
    if (where.line > 0) place += std::to_string(where.line) + ":" + std::to_string(where.column) + ":";
    place += " ";
  }
  return shown(place) + "error: " + shown(message); // names may contain control characters, as they come from files
}

ModelError::ModelError(std::vector<Diagnostic> diagnostics) : diagnostics_(std::move(diagnostics)) {
  for (const Diagnostic& d : diagnostics_) text_ += (text_.empty() ? "" : "\n") + d.text();
}

ModelError::ModelError(const Location& where, std::string message) : ModelError(std::vector<Diagnostic>{{where, std::move(message)}}) {}

namespace {

// Returns the Levenshtein distance: number of insertions, deletions and substitutions.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, diagonal + 1, substituted});
    }
  }
  return row.back();
}

// Returns the first letters of the words of a name: "fx" of "force_x".
std::string initials(const std::string& name) {
  std::string letters;
  for (std::size_t i = 0; i < name.size(); ++i)
    if (name[i] != '_' && (i == 0 || name[i - 1] == '_')) letters += name[i];
  return letters;
}

// Returns true if at least half of the letters of the longer word occur in the shorter one, too. A small edit distance alone would also
// match short words without a common letter.
bool share_letters(std::string a, std::string b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  std::string common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return 2 * common.size() >= std::max(a.size(), b.size());
}

// Returns true if the word is the plural of a name: "bodies" of "body".
bool is_plural(const std::string& word, const std::string& name) {
  if (name.empty()) return false;
  const std::string stem = name.substr(0, name.size() - 1);
  return word == name + "s" || word == name + "es" || (name.back() == 'y' && word == stem + "ies");
}

} // namespace

std::string nearest_name(const std::string& word, const std::vector<std::string>& known) {
  const auto singular = std::find_if(known.begin(), known.end(), [&](const std::string& name) { return is_plural(word, name); });
  if (singular != known.end()) return *singular;
  const auto abbreviated = std::find_if(known.begin(), known.end(),
                                        [&](const std::string& name) { return name.find('_') < name.size() && initials(name) == word; });
  if (abbreviated != known.end()) return *abbreviated;
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance && share_letters(word, candidate)) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = nearest_name(word, known);
  return near.empty() ? "" : " (did you mean '" + near + "'?)";
}

} // namespace steplap
