// Writes to the store on a separate thread while further samples run. On sixteen processors, writing on the main thread would add up to a
// fifth of the time of the runs.
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

/// Queue of write operations, executed in order. All calls must come from one thread.
class StoreWriter {
public:
  explicit StoreWriter(Store& store);
  /// Writes the rest. Errors are lost; call store() before to receive them.
  ~StoreWriter();
  StoreWriter(const StoreWriter&) = delete;
  StoreWriter& operator=(const StoreWriter&) = delete;

  /// As the functions of Store, but executed later. They throw errors of earlier writing and wait if the queue is long.
  void append(std::vector<StoredSample> rows);
  void note(long place, const Finding& finding);
  /// Returns the store after all queued writes; nothing is written until the next append() or note(). Throws errors of writing.
  [[nodiscard]] Store& store();

private:
  using Job = std::function<void(Store&)>;
  void add(Job job, std::size_t samples);
  void work();
  void write(const Job& job);

  Store& store_;
  std::mutex mutex_; ///< protects everything below
  std::condition_variable changed_;
  std::deque<std::pair<Job, std::size_t>> jobs_; ///< with the number of samples; the first is being written
  std::size_t waiting_ = 0;                      ///< total number of samples in the queue
  std::exception_ptr failure_;
  bool is_ending_ = false;
  std::thread thread_; ///< last member, because the thread uses the others
};

} // namespace steplap::study
