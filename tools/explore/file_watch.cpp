#include "tools/explore/file_watch.h"

#include <sys/stat.h>

namespace steplap {

namespace {

std::string look_at(const std::string& file) {
  struct stat seen {};
  if (stat(file.c_str(), &seen) != 0) return "";
  return std::to_string(seen.st_size) + " " + std::to_string(seen.st_mtim.tv_sec) + "." + std::to_string(seen.st_mtim.tv_nsec) + " " +
         std::to_string(seen.st_ino);
}

} // namespace

void FileWatch::watch(const std::vector<std::string>& files) {
  std::map<std::string, std::string> known, before;
  for (const std::string& file : files) {
    const bool is_new = !known_.contains(file);
    known[file] = is_new ? look_at(file) : known_[file];
    before[file] = is_new ? known[file] : before_[file];
  }
  known_ = std::move(known);
  before_ = std::move(before);
}

bool FileWatch::has_changed() {
  std::map<std::string, std::string> now;
  for (const auto& [file, look] : known_) now[file] = look_at(file);
  const bool is_quiet = now == before_;
  before_ = now;
  if (now == known_ || !is_quiet) return false;
  known_ = std::move(now);
  return true;
}

} // namespace steplap
