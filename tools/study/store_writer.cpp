#include "tools/study/store_writer.h"

#include <utility>

namespace steplap::study {

StoreWriter::StoreWriter(Store& store) : store_(store), thread_([this] { work(); }) {}

StoreWriter::~StoreWriter() {
  {
    const std::scoped_lock lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void StoreWriter::append(std::vector<StoredSample> rows) {
  const std::size_t count = rows.size();
  add([rows = std::move(rows)](Store& store) { store.append(rows.data(), rows.size()); }, count);
}

void StoreWriter::note(long place, const Finding& finding) {
  add([place, finding](Store& store) { store.note(place, finding); }, 0);
}

Store& StoreWriter::store() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty(); });
  if (failure_) std::rethrow_exception(failure_);
  return store_;
}

// Queues a job. Waits if too many samples are queued, which limits the memory; formulas are evaluated faster than written.
void StoreWriter::add(Job job, std::size_t samples) {
  constexpr std::size_t k_most_samples = 20000;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_ == 0 || waiting_ + samples <= k_most_samples; });
  if (failure_) std::rethrow_exception(failure_);
  jobs_.emplace_back(std::move(job), samples);
  waiting_ += samples;
  lock.unlock();
  changed_.notify_all();
}

void StoreWriter::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return !jobs_.empty() || is_ending_; });
    if (jobs_.empty()) return;
    const Job job = std::move(jobs_.front().first);
    if (!failure_) { // after a failed write nothing is written
      lock.unlock();
      write(job);
      lock.lock();
    }
    waiting_ -= jobs_.front().second;
    jobs_.pop_front();
    changed_.notify_all();
  }
}

void StoreWriter::write(const Job& job) {
  try {
    job(store_);
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    failure_ = std::current_exception();
  }
}

} // namespace steplap::study
