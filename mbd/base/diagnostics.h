// What goes wrong, said once and clearly: errors in a model (all of them together, each with its place), failures of a
// computation (with time, element and advice), files that cannot be used. Nothing else is thrown on purpose.
#pragma once

#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// A place in a model file; line and column count from 1, 0 = unknown (for example a model built in code).
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};

struct Diagnostic {
  Location where;
  std::string message; ///< cause and remedy in one or two sentences, names in 'quotes'

  /// "file:line:column: error: message"
  [[nodiscard]] std::string text() const;
};

/// The model cannot be used as it stands. Exit code 3.
class ModelError : public std::exception {
public:
  explicit ModelError(std::vector<Diagnostic> diagnostics);
  ModelError(const Location& where, std::string message);

  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }
  [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }

private:
  std::vector<Diagnostic> diagnostics_;
  std::string text_;
};

/// A computation could not be finished: the message carries time, element and advice. Exit code 4.
class NumericalFailure : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A file that cannot be written, or that is not what it should be; the message names it, the cause and what to do. Exit code 2.
class FileError : public std::runtime_error {
public:
  /// `line` counts from 1, 0: the file as a whole.
  FileError(std::string path, const std::string& message, std::size_t line = 0)
      : std::runtime_error(message), path_(std::move(path)), line_(line) {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::size_t line() const { return line_; }

private:
  std::string path_;
  std::size_t line_ = 0;
};

/// The nearest of `known` to `word` by edit distance, or "" if none is near enough to be meant.
[[nodiscard]] std::string nearest_name(const std::string& word, const std::vector<std::string>& known);

/// " (did you mean 'x'?)" or "".
[[nodiscard]] std::string did_you_mean(const std::string& word, const std::vector<std::string>& known);

} // namespace steplap
