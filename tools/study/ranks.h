// Processes of one study, by MPI: rank 0 asks, stores and answers; the others run samples for it.
//
// A lone process knows nothing of MPI. Who wants several begins it (tools/study/program/mpi_session.h) and takes of_world(): a library
// never does.
#pragma once

#include <cstddef>
#include <vector>

namespace steplap::study {

class Ranks {
public:
  /// This process alone.
  Ranks() = default;
  /// All processes of MPI's world; it has been begun, and is ended after the last use.
  [[nodiscard]] static Ranks of_world();

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] bool is_first() const { return rank_ == 0; }

  /// Processors of this machine that fall to this rank.
  [[nodiscard]] int threads() const;
  /// Everybody's: `data` of the first rank goes to all, whatever its size.
  void spread(std::vector<double>& data) const;
  /// The bytes of all ranks, one after the other, at the first one.
  [[nodiscard]] std::vector<std::vector<char>> gather(const std::vector<char>& mine) const;

private:
  int rank_ = 0, count_ = 1;
};

} // namespace steplap::study
