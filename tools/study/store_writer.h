// Writes to the store on a separate thread while further samples run. On 16 processors this saves up to 20 % of the time.
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
  /// Writes everything still in the queue. Errors are lost; call store() first to receive them.
  ~StoreWriter();
  StoreWriter(const StoreWriter&) = delete;
  StoreWriter& operator=(const StoreWriter&) = delete;

  /// Queue calls of the functions of Store with the same name. Wait if the queue is long; throw errors of earlier writes.
  void append(std::vector<StoredSample> rows);
  void note(long place, const Finding& finding);
  /// Waits until the queue is empty and returns the store. Nothing is written until the next append() or note(). Throws errors of earlier
  /// writes.
  [[nodiscard]] Store& store();

private:
  using Job = std::function<void(Store&)>;
  void add(Job job, std::size_t samples);
  void work();
  void write(const Job& job);

  Store& store_;
  std::mutex mutex_; ///< protects the members below
  std::condition_variable changed_;
  std::deque<std::pair<Job, std::size_t>> jobs_; ///< jobs with their numbers of samples; the first one is being executed
  std::size_t waiting_ = 0;                      ///< total number of samples in the queue
  std::exception_ptr failure_;
  bool is_ending_ = false;
  std::thread thread_; ///< last member, because the thread uses the others
};

} // namespace steplap::study
