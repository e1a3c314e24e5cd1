// MPI processes of one study. Rank 0 selects and stores the samples; all ranks run them.
#pragma once

#include <cstddef>
#include <vector>

namespace steplap::study {

/// All processes of a study, and the rank of this one.
class Ranks {
public:
  /// Represents this process only.
  Ranks() = default;
  /// Returns all processes of MPI's world. MPI must be initialised, and finalised only after the last use.
  [[nodiscard]] static Ranks of_world();

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] bool is_first() const { return rank_ == 0; }

  /// Returns the number of processors of this computer available to this rank.
  [[nodiscard]] int threads() const;
  /// Copies `data` from rank 0 to all ranks; collective. The sizes may differ before.
  void spread(std::vector<double>& data) const;
  /// Returns the bytes of all ranks in order, on rank 0.
  [[nodiscard]] std::vector<std::vector<char>> gather(const std::vector<char>& mine) const;

private:
  int rank_ = 0, count_ = 1;
};

} // namespace steplap::study
