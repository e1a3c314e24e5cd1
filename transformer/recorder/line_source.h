// Lines of a text file, one after the other, in bounded memory.
//
// Encodings: UTF-8 (with or without byte order mark), any one-byte encoding that extends ASCII, UTF-16 of both byte orders (with
// mark, or without where the first characters tell). Line ends: LF, CR LF, or CR alone if the first line ends so.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace steplap {

class LineSource {
public:
  /// Opens a file, or standard input ("-"). Throws RecordError: it cannot be read, or is a folder or a device.
  explicit LineSource(const std::string& path);
  /// Reads from memory; `name` is what messages call it.
  LineSource(std::string content, const std::string& name);

  /// The next line without its end, valid until the next call; false after the last. Throws RecordError for a zero byte (no
  /// text), for a line longer than a megabyte, and where reading fails.
  [[nodiscard]] bool next(std::string_view& line);
  /// Of the line that next() gave, from 1.
  [[nodiscard]] std::size_t number() const { return number_; }
  /// Did that line end with a line break? Only the last one of a file may not.
  [[nodiscard]] bool is_terminated() const { return is_terminated_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// "UTF-8", "UTF-8 with byte order mark", "UTF-16 (little-endian)", …
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
  std::unique_ptr<std::FILE, Close> file_; ///< none: from memory
  std::string memory_, buffer_, raw_;
  std::size_t memory_at_ = 0, at_ = 0, number_ = 0;
  unsigned pending_high_ = 0; ///< first half of a character of two units
  bool is_at_end_ = false, is_terminated_ = true;
  Form form_ = Form::bytes;
  char line_end_ = 0; ///< 0: not yet known
};

} // namespace steplap
