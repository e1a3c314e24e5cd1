// Initialises MPI during its lifetime, if a launcher (mpirun, srun) has started the program.
#pragma once

#include "tools/study/ranks.h"

namespace steplap::study {

class MpiSession {
public:
  MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;
  ~MpiSession();

  /// Returns all processes that the launcher started; without a launcher this process only.
  [[nodiscard]] const Ranks& ranks() const { return ranks_; }

private:
  Ranks ranks_;
  bool is_begun_ = false;
};

} // namespace steplap::study
