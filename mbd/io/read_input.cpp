#include "mbd/io/read_input.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace steplap {

namespace {

// Largest size of a file, bytes. A week of three axes at 200 Hz fits; an endless pipe must not fill the memory.
constexpr std::size_t k_most_bytes = std::size_t{4} << 30U;

constexpr const char* k_standard_input = "<standard input>"; // no file has this name

// Open file descriptor, closed by the destructor; standard input belongs to the caller and stays open.
class Descriptor {
public:
  explicit Descriptor(const std::string& path)
      : number_(is_standard_input(path) ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ > STDIN_FILENO) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }

private:
  int number_;
};

bool is_open_already(std::string_view path) { return path.starts_with("/dev/fd/") || path.starts_with("/proc/self/fd/"); }

// Returns a message if the file is of a kind that cannot be read to its end; otherwise "".
std::string problem_with(const struct ::stat& status, const std::string& path) {
  if (S_ISDIR(status.st_mode)) return "it is a folder";
  if (S_ISREG(status.st_mode) || is_standard_input(path)) return "";
  if (S_ISFIFO(status.st_mode)) return is_open_already(path) ? "" : "it is a named pipe: hand its content over with '-' or <(...)";
  return "it is no file, but a device";
}

} // namespace

bool is_standard_input(const std::string& path) {
  return path == "-" || path == "/dev/stdin" || path == "/dev/fd/0" || path == k_standard_input;
}

std::string shown_input(const std::string& path) { return is_standard_input(path) ? k_standard_input : path; }

std::string read_input(const std::string& path, const Location& where, const std::string& noun) {
  const auto fail = [&](const std::string& why) {
    throw ModelError(where, "cannot read " + noun + (is_standard_input(path) ? "standard input" : "'" + path + "'") + ": " + why);
  };
  const Descriptor file(path);
  struct ::stat status {};
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0) fail(std::strerror(errno));
  if (const std::string problem = problem_with(status, path); !problem.empty()) fail(problem);
  // The file was opened without waiting, so that a named pipe without writer does not block. Reading has to wait.
  if (!is_standard_input(path)) ::fcntl(file.number(), F_SETFL, ::fcntl(file.number(), F_GETFL) & ~O_NONBLOCK);
  std::string content;
  if (S_ISREG(status.st_mode) && static_cast<std::uintmax_t>(status.st_size) > k_most_bytes) fail("it is larger than 4 GB");
  if (S_ISREG(status.st_mode)) content.reserve(static_cast<std::size_t>(status.st_size) + 1);
  for (char buffer[1 << 16];;) {
    const ::ssize_t count = ::read(file.number(), buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(std::strerror(errno));
    if (count == 0) return content;
    content.append(buffer, static_cast<std::size_t>(count));
    if (content.size() > k_most_bytes) fail("it is larger than 4 GB");
  }
}

} // namespace steplap
