// Exceptions of the library. A ModelError carries all errors of a model, each with its place in the file. A NumericalFailure ends a
// computation. A FileError names a file that cannot be used. Wrong arguments of functions throw std::invalid_argument; the library throws
// nothing else.
#pragma once

#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// A place in a model file. 0 means unknown, for example in a model built in C++.
struct Location {
  std::string file; ///< path as the user gave it
  int line = 0;     ///< from 1
  int column = 0;   ///< from 1
};

/// One error of a model.
struct Diagnostic {
  Location where;      ///< of the value that is wrong
  std::string message; ///< cause and remedy in one or two sentences, names in 'quotes'

  /// "file:line:column: error: message"
  [[nodiscard]] std::string text() const;
};

/// The model cannot be used. The command line exits with code 3.
class ModelError : public std::exception {
public:
  /// All errors of a model, in the order in which they are shown.
  explicit ModelError(std::vector<Diagnostic> diagnostics);
  /// A single error.
  ModelError(const Location& where, std::string message);

  /// The errors, at least one.
  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }
  [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }

private:
  std::vector<Diagnostic> diagnostics_;
  std::string text_;
};

/// A computation could not be finished. The message names time, element and remedy. The command line exits with code 4.
class NumericalFailure : public std::runtime_error {
public:
  /// The message in whole sentences.
  using std::runtime_error::runtime_error;
};

/// A file cannot be written, or is not of the expected kind. The message names the file, the cause and the remedy. The command line exits
/// with code 2.
class FileError : public std::runtime_error {
public:
  /// `line` counts from 1; 0 means the file as a whole.
  FileError(std::string path, const std::string& message, std::size_t line = 0)
      : std::runtime_error(message), path_(std::move(path)), line_(line) {}

  /// The file as it was named.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// The line, from 1; 0 means the file as a whole.
  [[nodiscard]] std::size_t line() const { return line_; }

private:
  std::string path_;
  std::size_t line_ = 0;
};

/// The name in `known` with the least edit distance to `word`; "" if none is similar enough to be a misspelling.
[[nodiscard]] std::string nearest_name(const std::string& word, const std::vector<std::string>& known);

/// " (did you mean 'x'?)" or "".
[[nodiscard]] std::string did_you_mean(const std::string& word, const std::vector<std::string>& known);

} // namespace steplap
