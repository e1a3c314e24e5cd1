// Reads a text file line by line with bounded memory.
//
// Encodings: UTF-8 with or without byte order mark, any single-byte encoding that extends ASCII, UTF-16 of both byte orders (without byte
// order mark if the first characters reveal it). Line ends: LF, CR LF, or CR alone if the first line ends with it.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace steplap {

/// Source of lines.
class LineSource {
public:
  /// Opens a file, or standard input for "-". Throws RecordError if it cannot be read, or is a folder or a device.
  explicit LineSource(const std::string& path);
  /// Reads from memory. `name` is used in messages.
  LineSource(std::string content, const std::string& name);

  /// Reads the next line without its line end, valid until the next call. Returns false after the last line. Throws RecordError for a zero
  /// byte (not a text), for a line longer than a megabyte, and if reading fails.
  [[nodiscard]] bool next(std::string_view& line);
  /// Returns the number of the line that next() read last, from 1.
  [[nodiscard]] std::size_t number() const { return number_; }
  /// Returns true if a line break followed the last line read. Only the last line of a file may have none.
  [[nodiscard]] bool is_terminated() const { return is_terminated_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Returns "UTF-8", "UTF-8 with byte order mark", "UTF-16 (little-endian)", …
  [[nodiscard]] const std::string& encoding() const { return encoding_; }

private:
  enum class Form { bytes, little, big };
  struct Close {
    void operator()(std::FILE* file) const;
  };
  void begin();
  void refill();
  void check_zero_bytes(std::size_t from);
  std::size_t read_bytes(char* at, std::size_t room);
  void append_utf16(std::size_t count);

  std::string name_, encoding_ = "UTF-8";
  std::unique_ptr<std::FILE, Close> file_; ///< null when reading from memory
  std::string memory_, buffer_, raw_;
  std::size_t memory_at_ = 0, at_ = 0, number_ = 0;
  unsigned pending_high_ = 0; ///< first code unit of a UTF-16 surrogate pair
  bool is_at_end_ = false, is_terminated_ = true;
  Form form_ = Form::bytes;
  char line_end_ = 0; ///< LF or CR; 0: not yet known
};

} // namespace steplap
