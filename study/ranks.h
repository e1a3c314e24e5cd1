// Processes of one study, by MPI: rank 0 asks, stores and answers; the others run samples for it.
//
// MPI is begun only where a launcher (mpirun, srun) has started the program; a lone process knows nothing of it.
#pragma once

#include <cstddef>
#include <vector>

namespace steplap::study {

class Ranks {
public:
  /// Begins MPI if a launcher is there.
  Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  ~Ranks();

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
  bool is_begun_ = false;
};

} // namespace steplap::study
