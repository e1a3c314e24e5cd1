#include "tools/study/ranks.h"

#include <mpi.h>
#include <sched.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace steplap::study {

Ranks Ranks::of_world() {
  Ranks ranks;
  MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks.count_);
  return ranks;
}

void Ranks::spread(std::vector<double>& data) const {
  if (count_ == 1) return;
  unsigned long size = data.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, 0, MPI_COMM_WORLD);
  data.resize(size);
  if (size > static_cast<unsigned long>(std::numeric_limits<int>::max())) throw std::length_error("too many samples at once");
  MPI_Bcast(data.data(), static_cast<int>(size), MPI_DOUBLE, 0, MPI_COMM_WORLD);
}

std::vector<std::vector<char>> Ranks::gather(const std::vector<char>& mine) const {
  if (count_ == 1) return {mine};
  int size = static_cast<int>(mine.size());
  const bool is_here = is_first();
  std::vector<int> sizes(is_here ? static_cast<std::size_t>(count_) : 0), places(sizes.size());
  MPI_Gather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  int total = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) places[i] = total, total += sizes[i];
  std::vector<char> all(static_cast<std::size_t>(total));
  MPI_Gatherv(mine.data(), size, MPI_BYTE, all.data(), sizes.data(), places.data(), MPI_BYTE, 0, MPI_COMM_WORLD);
  std::vector<std::vector<char>> parts;
  for (std::size_t i = 0; i < sizes.size(); ++i) parts.emplace_back(all.begin() + places[i], all.begin() + places[i] + sizes[i]);
  return parts;
}

// Returns the number of threads of this rank. Ranks that are bound to the same processors share them.
int Ranks::threads() const {
  cpu_set_t mine;
  CPU_ZERO(&mine);
  sched_getaffinity(0, sizeof mine, &mine);
  const int processors = std::max(1, CPU_COUNT(&mine));
  if (count_ == 1) return processors;
  MPI_Comm machine;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int here = 1;
  MPI_Comm_size(machine, &here);
  std::vector<cpu_set_t> all(static_cast<std::size_t>(here));
  MPI_Allgather(&mine, sizeof mine, MPI_BYTE, all.data(), sizeof mine, MPI_BYTE, machine);
  MPI_Comm_free(&machine);
  const auto same = std::count_if(all.begin(), all.end(), [&](const cpu_set_t& other) { return CPU_EQUAL(&mine, &other) != 0; });
  return std::max(1, processors / static_cast<int>(same));
}

} // namespace steplap::study
