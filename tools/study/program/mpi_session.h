// MPI for as long as one of these lives, where a launcher (mpirun, srun) has started the program.
#pragma once

#include "tools/study/ranks.h"

namespace steplap::study {

class MpiSession {
public:
  MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;
  ~MpiSession();

  /// All processes that the launcher started; without one this process alone.
  [[nodiscard]] const Ranks& ranks() const { return ranks_; }

private:
  Ranks ranks_;
  bool is_begun_ = false;
};

} // namespace steplap::study
