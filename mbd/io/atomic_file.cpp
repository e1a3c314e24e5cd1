#include "mbd/io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

namespace steplap {

namespace {

[[noreturn]] void fail(const std::string& path, int code) {
  std::string advice;
  if (code == ENOSPC || code == EDQUOT) advice = ": free some space and run again";
  throw FileError(path, "cannot write '" + path + "': " + std::strerror(code) + advice);
}

// Temporary file; closed and removed unless it was renamed.
class TemporaryFile {
public:
  explicit TemporaryFile(const std::string& target) : target_(target), name_(target + ".XXXXXX") {
    std::vector<char> buffer(name_.begin(), name_.end());
    buffer.push_back('\0');
    descriptor_ = ::mkostemp(buffer.data(), O_CLOEXEC);
    if (descriptor_ < 0) fail(target_, errno);
    name_ = buffer.data();
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!is_renamed_) ::unlink(name_.c_str());
  }

  void write(std::string_view content) {
    std::size_t done = 0;
    while (done < content.size()) {
      const ::ssize_t count = ::write(descriptor_, content.data() + done, content.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail(target_, errno);
      done += static_cast<std::size_t>(count);
    }
  }

  // Flushes the content to disk and closes the file; a full disk may be reported only here. An existing target gives its permissions.
  void finish() {
    const ::mode_t mask = ::umask(0);
    ::umask(mask);
    struct ::stat existing {};
    const ::mode_t mode = ::stat(target_.c_str(), &existing) == 0 ? existing.st_mode & 07777 : 0666 & ~mask;
    if (::fchmod(descriptor_, mode) != 0) fail(target_, errno);
    if (::fsync(descriptor_) != 0 && errno != EINVAL) fail(target_, errno);
    const int descriptor = std::exchange(descriptor_, -1);
    if (::close(descriptor) != 0) fail(target_, errno);
  }

  // Gives the temporary file its final name. If existing files must not be replaced, a hard link is made, which fails if the target exists;
  // so two simultaneous runs cannot overwrite each other's file.
  void become_target(IfExists if_exists) {
    if (if_exists == IfExists::refuse && ::link(name_.c_str(), target_.c_str()) == 0) return;
    if (if_exists == IfExists::refuse && errno == EEXIST) refuse(target_);
    if (std::rename(name_.c_str(), target_.c_str()) != 0) fail(target_, errno);
    is_renamed_ = true;
  }

  [[noreturn]] static void refuse(const std::string& path) {
    throw FileError(path, "'" + path + "' exists already and is not overwritten");
  }

private:
  std::string target_, name_;
  int descriptor_ = -1;
  bool is_renamed_ = false;
};

} // namespace

void write_file(const std::string& path, const std::string& content, IfExists if_exists) {
  write_file(
      path, [&content](const FileSink& put) { put(content); }, if_exists);
}

void write_file(const std::string& path, const FileContent& content, IfExists if_exists) {
  if (if_exists == IfExists::refuse && std::filesystem::exists(path)) TemporaryFile::refuse(path);
  std::error_code ignored;
  if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path, ignored)) // renaming would replace a device by a file
    throw FileError(path, "cannot write '" + path + "': it is there, but is no file");
  TemporaryFile file(if_exists == IfExists::replace && std::filesystem::is_symlink(path, ignored)
                         ? std::filesystem::weakly_canonical(path).string() // the file is replaced, not the link
                         : path);
  content([&file](std::string_view part) { file.write(part); });
  file.finish();
  file.become_target(if_exists);
}

} // namespace steplap
