// A worker thread that executes the most urgent task first.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace steplap {

/// Task queue with one worker thread. A newer task can make older tasks of the same owner stale; a task can query this and end early.
class WorkQueue {
public:
  /// Urgency of a task. Later enumerators are executed first.
  enum class Urgency { background, page, drag };
  /// Passed to a task; returns true if its result is no longer needed or a more urgent task is waiting.
  using IsStale = std::function<bool()>;
  using Task = std::function<void(const IsStale&)>;

  static constexpr std::size_t k_most_waiting = 256; ///< maximum number of waiting tasks; further ones are rejected

  WorkQueue();
  /// Discards the waiting tasks, marks the running task as stale, and waits until it ends.
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  /// Adds a task. A task of urgency `drag` makes older tasks of the same owner and urgency stale, unless the owner is "". Stale tasks are
  /// also run, so that they reply. Returns false and discards the task if k_most_waiting tasks are waiting. Tasks must not throw.
  [[nodiscard]] bool add(Urgency urgency, const std::string& owner, Task task);

private:
  struct QueuedTask {
    Urgency urgency;
    std::string owner;
    Task task;
    std::shared_ptr<bool> is_stale; ///< guarded by the mutex
  };

  void work();
  [[nodiscard]] bool is_stale(const QueuedTask& entry);
  [[nodiscard]] std::deque<QueuedTask>::iterator most_urgent();

  std::mutex mutex_;
  std::condition_variable something_;
  std::deque<QueuedTask> waiting_;
  std::shared_ptr<bool> active_stale_;
  std::string active_owner_;
  bool is_ending_ = false;
  std::thread thread_;
};

} // namespace steplap
