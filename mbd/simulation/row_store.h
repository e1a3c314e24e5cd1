// Storage for rows of numbers with bounded memory. Beyond a limit rows are moved to an unnamed temporary file, which disappears however the
// program ends. The file is in $TMPDIR, otherwise in /var/tmp, which is on disk even if /tmp is in memory. Rows can be read in any order;
// reading is by blocks and fastest in the order of writing.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace steplap {

/// Rows of equal width, appended at the end and read in any order.
class RowStore {
public:
  static constexpr std::size_t k_most_in_memory = std::size_t{1} << 23; ///< default limit: 64 MB of numbers

  /// `width`: numbers per row. Beyond `most_in_memory` numbers rows are moved to a file.
  explicit RowStore(std::size_t width, std::size_t most_in_memory = k_most_in_memory);
  RowStore(const RowStore&) = delete;
  RowStore& operator=(const RowStore&) = delete;
  ~RowStore();

  /// Returns a new row to be filled; null after a failure. Throws NumericalFailure once if there is no disk space: earlier rows remain,
  /// later ones are lost.
  [[nodiscard]] double* add_row();
  /// Returns the number of rows.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Returns true if rows have been moved to a file.
  [[nodiscard]] bool is_on_disk() const { return file_ >= 0; }

  /// Returns row i; valid until the next call.
  [[nodiscard]] const double* row(std::size_t i) const {
    const std::size_t block = i >> shift_;
    const double* begin = block == cached_ ? cache_ : find(block);
    return begin + (i & mask_) * width_;
  }

private:
  [[nodiscard]] const double* find(std::size_t block) const;
  void move_to_disk();
  void write_block(std::size_t block, const std::vector<double>& values);
  [[noreturn]] void fail(int code, const std::string& folder);

  std::size_t width_, most_in_memory_;
  std::size_t shift_ = 0, mask_ = 0; ///< rows per block, a power of two
  std::size_t size_ = 0;
  std::vector<std::vector<double>> blocks_; ///< complete blocks, as long as all are in memory
  std::vector<double> tail_;                ///< block being filled
  std::size_t full_ = 0;                    ///< number of complete blocks
  int file_ = -1;
  bool has_failed_ = false;
  mutable std::vector<double> read_; ///< last block read from the file
  mutable std::size_t cached_ = ~std::size_t{0};
  mutable const double* cache_ = nullptr;
};

} // namespace steplap
