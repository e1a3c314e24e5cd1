#include "mbd/simulation/row_store.h"

#include "mbd/base/diagnostics.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace steplap {

namespace {

constexpr std::size_t k_block = std::size_t{1} << 17; // approximate number of values in a block, 1 MB

std::string spill_folder() {
  const char* wanted = std::getenv("TMPDIR");
  if (wanted && *wanted) return wanted;
  return ::access("/var/tmp", W_OK | X_OK) == 0 ? "/var/tmp" : "/tmp";
}

// Opens an unnamed temporary file in `folder`.
int open_unnamed(const std::string& folder) {
#ifdef O_TMPFILE
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
#endif
  std::string name = folder + "/steplap.XXXXXX"; // fallback for file systems without unnamed files
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

} // namespace

RowStore::RowStore(std::size_t width, std::size_t most_in_memory) : width_(width), most_in_memory_(most_in_memory) {
  const std::size_t block = std::min(k_block, std::max<std::size_t>(most_in_memory, 1));
  while ((std::size_t{2} << shift_) * width_ <= block) ++shift_;
  mask_ = (std::size_t{1} << shift_) - 1;
}

RowStore::~RowStore() {
  if (file_ >= 0) ::close(file_);
}

double* RowStore::add_row() {
  if (has_failed_) return nullptr;
  const std::size_t full_size = (mask_ + 1) * width_;
  if (tail_.size() == full_size) {
    if (file_ < 0 && (full_ + 2) * full_size > most_in_memory_) move_to_disk();
    cached_ = ~std::size_t{0}; // the cached block may have been the tail
    if (file_ >= 0) write_block(full_, tail_);
    else blocks_.push_back(std::exchange(tail_, {}));
    ++full_;
    tail_.clear();
  }
  // Reserved memory that is never written needs no physical pages, and rows are not moved when others are added.
  if (tail_.empty()) tail_.reserve(full_size);
  const double* before = tail_.data();
  tail_.resize(tail_.size() + width_);
  if (cache_ == before) cached_ = ~std::size_t{0}; // the buffer may have moved
  ++size_;
  return tail_.data() + (tail_.size() - width_);
}

const double* RowStore::find(std::size_t block) const {
  if (block == full_) cache_ = tail_.data();
  else if (file_ < 0) cache_ = blocks_[block].data();
  else {
    read_.resize((mask_ + 1) * width_);
    const std::size_t bytes = read_.size() * sizeof(double);
    std::size_t done = 0;
    while (done < bytes) {
      const ::ssize_t count =
          ::pread(file_, reinterpret_cast<char*>(read_.data()) + done, bytes - done, static_cast<::off_t>(block * bytes + done));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0)
        throw NumericalFailure(std::string("rows of the trajectory cannot be read back from disk: ") +
                               std::strerror(count < 0 ? errno : EIO));
      done += static_cast<std::size_t>(count);
    }
    cache_ = read_.data();
  }
  cached_ = block;
  return cache_;
}

void RowStore::move_to_disk() {
  const std::string folder = spill_folder();
  file_ = open_unnamed(folder);
  if (file_ < 0) fail(errno, folder);
  for (std::size_t i = 0; i < blocks_.size(); ++i) write_block(i, blocks_[i]);
  blocks_ = {};
}

void RowStore::write_block(std::size_t block, const std::vector<double>& values) {
  const std::size_t bytes = values.size() * sizeof(double);
  std::size_t done = 0;
  while (done < bytes) {
    const ::ssize_t count =
        ::pwrite(file_, reinterpret_cast<const char*>(values.data()) + done, bytes - done, static_cast<::off_t>(block * bytes + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail(count < 0 ? errno : ENOSPC, spill_folder());
    done += static_cast<std::size_t>(count);
  }
}

void RowStore::fail(int code, const std::string& folder) {
  has_failed_ = true;
  if (file_ >= 0 && !blocks_.empty()) { // blocks that could not be written remain in memory
    ::close(file_);
    file_ = -1;
  }
  throw NumericalFailure("the rows of the trajectory cannot be kept in '" + folder + "': " + std::strerror(code) +
                         "; set TMPDIR to a folder with more room, or choose a larger 'step' or fewer 'channels' of [output].");
}

} // namespace steplap
