#include "tools/study/program/mpi_session.h"

#include <mpi.h>

#include <cstdlib>

namespace steplap::study {

namespace {

// Returns true if an environment variable shows that mpirun or srun (--mpi=pmix or pmi2) has started this process.
bool has_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
    if (std::getenv(name)) return true;
  return false;
}

} // namespace

MpiSession::MpiSession() {
  if (!has_launcher()) return;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  is_begun_ = true;
  ranks_ = Ranks::of_world();
}

MpiSession::~MpiSession() {
  if (is_begun_) MPI_Finalize();
}

} // namespace steplap::study
