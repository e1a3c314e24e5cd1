#include "transformer/recorder/line_source.h"

#include "mbd/io/read_input.h"
#include "transformer/recorder/record_error.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>

namespace steplap {

namespace {

constexpr std::size_t k_chunk = std::size_t{1} << 20U;
constexpr std::size_t k_longest_line = std::size_t{1} << 20U;

void append_utf8(std::string& text, unsigned code) {
  const auto put = [&](unsigned byte) { text += static_cast<char>(byte); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | code >> 6U);
    put(0x80 | (code & 0x3FU));
  } else if (code < 0x10000) {
    put(0xE0 | code >> 12U);
    put(0x80 | (code >> 6U & 0x3FU));
    put(0x80 | (code & 0x3FU));
  } else {
    put(0xF0 | code >> 18U);
    put(0x80 | (code >> 12U & 0x3FU));
    put(0x80 | (code >> 6U & 0x3FU));
    put(0x80 | (code & 0x3FU));
  }
}

} // namespace

RecordError::RecordError(const std::string& file, std::size_t line, std::size_t column, const std::string& what)
    : FileError(file,
                file + (line > 0 ? ":" + std::to_string(line) : "") + (line > 0 && column > 0 ? ":" + std::to_string(column) : "") + ": " +
                    what,
                line),
      column_(column) {}

void LineSource::Close::operator()(std::FILE* file) const {
  if (file && file != stdin) std::fclose(file);
}

LineSource::LineSource(const std::string& path) : name_(path) {
  if (is_standard_input(path)) name_ = shown_input(path);
  errno = 0;
  struct ::stat status {};
  if (!is_standard_input(path)) {
    if (::stat(path.c_str(), &status) != 0)
      throw RecordError(name_, 0, 0, std::string("The file cannot be read: ") + std::strerror(errno) + ".");
    if (S_ISDIR(status.st_mode)) throw RecordError(name_, 0, 0, "This is a folder. Name the recorder's file in it.");
    if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) throw RecordError(name_, 0, 0, "This is a device, not a file.");
  }
  file_.reset(is_standard_input(path) ? stdin : std::fopen(path.c_str(), "rb"));
  if (!file_) throw RecordError(name_, 0, 0, std::string("The file cannot be read: ") + std::strerror(errno) + ".");
  begin();
}

LineSource::LineSource(std::string content, const std::string& name) : name_(name), memory_(std::move(content)) { begin(); }

std::size_t LineSource::read_bytes(char* at, std::size_t room) {
  if (file_) {
    const std::size_t count = std::fread(at, 1, room, file_.get());
    if (count < room && std::ferror(file_.get()))
      throw RecordError(name_, number_, 0, std::string("Reading failed: ") + std::strerror(errno) + ".");
    return count;
  }
  const std::size_t count = std::min(room, memory_.size() - memory_at_);
  std::memcpy(at, memory_.data() + memory_at_, count);
  memory_at_ += count;
  return count;
}

void LineSource::begin() {
  raw_.resize(k_chunk);
  const std::size_t count = read_bytes(raw_.data(), k_chunk);
  is_at_end_ = count < k_chunk;
  const std::string_view head(raw_.data(), count);
  const auto zero_at = [&](std::size_t i) { return head.size() > i && head[i] == '\0'; };
  std::size_t mark = 0;
  if (head.starts_with("\xEF\xBB\xBF")) {
    mark = 3;
    encoding_ = "UTF-8 with byte order mark";
  } else if (head.starts_with("\xFF\xFE") || (zero_at(1) && !zero_at(0) && zero_at(3))) {
    mark = zero_at(1) && !head.starts_with("\xFF\xFE") ? 0 : 2;
    form_ = Form::little;
    encoding_ = mark > 0 ? "UTF-16 (little-endian)" : "UTF-16 (little-endian, without byte order mark)";
  } else if (head.starts_with("\xFE\xFF") || (zero_at(0) && !zero_at(1) && zero_at(2))) {
    mark = head.starts_with("\xFE\xFF") ? 2 : 0;
    form_ = Form::big;
    encoding_ = mark > 0 ? "UTF-16 (big-endian)" : "UTF-16 (big-endian, without byte order mark)";
  }
  raw_.erase(0, mark);
  if (form_ == Form::bytes) {
    buffer_.assign(raw_, 0, count - mark);
    check_zero_bytes(0);
  } else {
    append_utf16(count - mark);
  }
}

void LineSource::check_zero_bytes(std::size_t from) {
  const void* zero = std::memchr(buffer_.data() + from, 0, buffer_.size() - from);
  if (!zero) return;
  const std::size_t place = static_cast<std::size_t>(static_cast<const char*>(zero) - buffer_.data());
  const char end = line_end_ == '\r' ? '\r' : '\n';
  std::size_t line = number_ + 1, start = at_;
  for (std::size_t i = at_; i < place; ++i)
    if (buffer_[i] == end) {
      ++line;
      start = i + 1;
    }
  throw RecordError(name_, line, place - start + 1,
                    "A zero byte stands here: this is no text. Export the record as CSV from the recorder's program.");
}

// Converts `count` bytes of raw_ from UTF-16 and appends them. Characters above U+FFFF consist of two code units. An odd byte at the end is
// an error.
void LineSource::append_utf16(std::size_t count) {
  if (count % 2 != 0)
    throw RecordError(name_, 0, 0, "The file is UTF-16 with an odd number of bytes: it is cut. Copy it again from the recorder.");
  const std::size_t before = buffer_.size();
  for (std::size_t i = 0; i + 1 < count; i += 2) {
    const auto first = static_cast<unsigned char>(raw_[i]), second = static_cast<unsigned char>(raw_[i + 1]);
    const unsigned unit = form_ == Form::little ? first | unsigned{second} << 8U : unsigned{first} << 8U | second;
    if (unit >= 0xD800 && unit < 0xDC00) {
      pending_high_ = unit;
    } else if (unit >= 0xDC00 && unit < 0xE000) {
      append_utf8(buffer_, pending_high_ ? 0x10000 + ((pending_high_ - 0xD800) << 10U) + (unit - 0xDC00) : 0xFFFD);
      pending_high_ = 0;
    } else {
      append_utf8(buffer_, unit);
    }
  }
  check_zero_bytes(before);
}

void LineSource::refill() {
  buffer_.erase(0, at_);
  at_ = 0;
  const std::size_t before = buffer_.size();
  if (form_ == Form::bytes) {
    buffer_.resize(before + k_chunk);
    const std::size_t count = read_bytes(buffer_.data() + before, k_chunk);
    buffer_.resize(before + count);
    is_at_end_ = count < k_chunk;
    check_zero_bytes(before);
  } else {
    raw_.resize(k_chunk);
    const std::size_t count = read_bytes(raw_.data(), k_chunk);
    is_at_end_ = count < k_chunk;
    append_utf16(count);
  }
}

bool LineSource::next(std::string_view& line) {
  if (line_end_ == 0) { // the first CR decides: lines end with CR unless LF follows
    const std::size_t first = buffer_.find_first_of("\r\n");
    const bool is_cr = first != std::string::npos && buffer_[first] == '\r' && first + 1 < buffer_.size() && buffer_[first + 1] != '\n';
    line_end_ = is_cr ? '\r' : '\n';
  }
  for (std::size_t searched = at_;;) {
    const void* end = searched < buffer_.size() ? std::memchr(buffer_.data() + searched, line_end_, buffer_.size() - searched) : nullptr;
    if (end) {
      const std::size_t place = static_cast<std::size_t>(static_cast<const char*>(end) - buffer_.data());
      line = std::string_view(buffer_).substr(at_, place - at_);
      at_ = place + 1;
      break;
    }
    if (buffer_.size() - at_ > k_longest_line)
      throw RecordError(name_, number_ + 1, 1, "This line is longer than a megabyte: this is no table with a row for each instant.");
    if (is_at_end_) {
      if (at_ == buffer_.size()) return false;
      line = std::string_view(buffer_).substr(at_);
      at_ = buffer_.size();
      is_terminated_ = false;
      break;
    }
    const std::size_t kept = buffer_.size() - at_;
    refill();
    searched = kept;
  }
  if (line_end_ == '\n' && line.ends_with('\r')) line.remove_suffix(1);
  ++number_;
  return true;
}

} // namespace steplap
