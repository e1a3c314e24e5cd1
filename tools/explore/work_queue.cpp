#include "tools/explore/work_queue.h"

#include <algorithm>

namespace steplap {

WorkQueue::WorkQueue() : thread_([this] { work(); }) {}

WorkQueue::~WorkQueue() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    waiting_.clear();
  }
  something_.notify_all();
  thread_.join();
}

bool WorkQueue::add(Urgency urgency, const std::string& owner, Task task) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= k_most_waiting) return false;
    if (urgency == Urgency::drag && !owner.empty()) {
      for (QueuedTask& entry : waiting_)
        if (entry.urgency == urgency && entry.owner == owner) *entry.is_stale = true;
      if (active_stale_ && active_owner_ == owner) *active_stale_ = true;
    }
    waiting_.push_back({urgency, owner, std::move(task), std::make_shared<bool>(false)});
  }
  something_.notify_all();
  return true;
}

// Returns the most urgent task; among equally urgent ones the oldest.
std::deque<WorkQueue::QueuedTask>::iterator WorkQueue::most_urgent() {
  return std::max_element(waiting_.begin(), waiting_.end(), [](const QueuedTask& a, const QueuedTask& b) { return a.urgency < b.urgency; });
}

bool WorkQueue::is_stale(const QueuedTask& entry) {
  const std::lock_guard lock(mutex_);
  if (is_ending_ || *entry.is_stale) return true;
  return entry.urgency == Urgency::background && !waiting_.empty() && most_urgent()->urgency > entry.urgency;
}

void WorkQueue::work() {
  for (;;) {
    std::unique_lock lock(mutex_);
    something_.wait(lock, [this] { return is_ending_ || !waiting_.empty(); });
    if (is_ending_) return;
    const auto next = most_urgent();
    const QueuedTask entry = std::move(*next);
    waiting_.erase(next);
    active_stale_ = entry.is_stale;
    active_owner_ = entry.urgency == Urgency::drag ? entry.owner : "";
    lock.unlock();
    entry.task([this, &entry] { return is_stale(entry); });
    lock.lock();
    active_stale_.reset();
    active_owner_.clear();
  }
}

} // namespace steplap
