// Rows of numbers in bounded memory: kept there up to a limit, from then on in a file that has no name, so that nothing of it
// is left behind however the program ends. The file lies in $TMPDIR, else in /var/tmp, which is a disk also where /tmp is
// memory. Rows are read back in any order, block by block: in the order in which they came is fast.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace steplap {

/// Rows of equal width, added at the end and read in any order.
class RowStore {
public:
  static constexpr std::size_t k_most_in_memory = std::size_t{1} << 23; ///< numbers: 64 MB

  /// Rows of `width` numbers; beyond `most_in_memory` numbers they go to a file.
  explicit RowStore(std::size_t width, std::size_t most_in_memory = k_most_in_memory);
  RowStore(const RowStore&) = delete;
  RowStore& operator=(const RowStore&) = delete;
  ~RowStore();

  /// The place of a new row, to be filled with its numbers; null after a failure. Throws NumericalFailure, once, if there is no
  /// more room: the rows before stay as they are and what comes later is not kept.
  [[nodiscard]] double* add_row();
  /// Rows there are.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Are rows in a file by now?
  [[nodiscard]] bool is_on_disk() const { return file_ >= 0; }

  /// Valid until another row is asked for.
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
  std::size_t shift_ = 0, mask_ = 0; ///< of rows in a block, a power of two
  std::size_t size_ = 0;
  std::vector<std::vector<double>> blocks_; ///< full ones, while all are in memory
  std::vector<double> tail_;                ///< the block being filled
  std::size_t full_ = 0;                    ///< how many are full
  int file_ = -1;
  bool has_failed_ = false;
  mutable std::vector<double> read_; ///< the block last read from the file
  mutable std::size_t cached_ = ~std::size_t{0};
  mutable const double* cache_ = nullptr;
};

} // namespace steplap
