// What a study has found goes into its store on a thread of its own, while the next samples run: on sixteen processors writing would
// else take as long as a fifth of the runs.
#pragma once

#include "tools/study/store.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace steplap::study {

/// Writes in the order in which it is asked. For one thread's use.
class StoreWriter {
public:
  explicit StoreWriter(Store& store);
  /// Writes what is left. What goes wrong there is not told: call store() before.
  ~StoreWriter();
  StoreWriter(const StoreWriter&) = delete;
  StoreWriter& operator=(const StoreWriter&) = delete;

  /// As of Store, but later. They throw what writing of before threw, and wait where much is left to write.
  void append(std::vector<StoredSample> rows);
  void note(long place, const Finding& finding);
  /// The store with all that was asked for in it; nothing is written until the next append() or note(). Throws what writing threw.
  [[nodiscard]] Store& store();

private:
  using Job = std::function<void(Store&)>;
  void add(Job job, std::size_t samples);
  void work();
  void write(const Job& job);

  Store& store_;
  std::mutex mutex_; ///< of all below
  std::condition_variable changed_;
  std::deque<std::pair<Job, std::size_t>> jobs_; ///< with its number of samples; the first is being written
  std::size_t waiting_ = 0;                      ///< samples of all of them
  std::exception_ptr failure_;
  bool is_ending_ = false;
  std::thread thread_; ///< the last: it uses the others
};

} // namespace steplap::study
