#include "mbd/base/budget.h"

#include "mbd/base/number_text.h"

#include <chrono>
#include <fstream>
#include <unistd.h>
#include <utility>

namespace steplap {

namespace {

constexpr std::chrono::milliseconds k_between{10}; // least time between two readings of the memory

// Returns the resident memory of this process, bytes; 0 if it is unknown.
double resident_memory() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0, resident = 0.0;
  return file >> pages >> resident ? resident * static_cast<double>(sysconf(_SC_PAGESIZE)) : 0.0;
}

} // namespace

StopQuestion within(const Budget& budget, StopQuestion otherwise) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  return [budget, otherwise = std::move(otherwise), begin, next = begin]() mutable -> std::string {
    if (std::string why = otherwise ? otherwise() : std::string(); !why.empty()) return why;
    const Clock::time_point now = Clock::now();
    if (budget.time && std::chrono::duration<double>(now - begin).count() >= *budget.time)
      return "stopped by the time limit of " + number_text(*budget.time) + " s";
    if (!budget.memory || now < next) return {};
    next = now + k_between;
    constexpr double k_megabyte = 1e6;
    return resident_memory() > *budget.memory ? "stopped by the memory limit of " + number_text(*budget.memory / k_megabyte) + " MB"
                                              : std::string();
  };
}

} // namespace steplap
