// One thread that does what is asked of it, the most urgent first.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace steplap {

/// Tasks for one thread. What is asked anew makes the older task of the same owner stale: it is told so, and ends early.
class WorkQueue {
public:
  /// The later ones are done first.
  enum class Urgency { background, page, drag };
  /// Asked at any time by the task: is its result not wanted any more, or should it give way to something more urgent?
  using IsStale = std::function<bool()>;
  using Task = std::function<void(const IsStale&)>;

  static constexpr std::size_t k_most_waiting = 256; ///< tasks; further ones are refused

  WorkQueue();
  /// Waiting tasks are thrown away, the one that runs is told that it is stale and waited for.
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  /// `owner`: tasks of the same owner and urgency `drag` are stale once a newer one is there; "" owns nothing. A stale task is run all
  /// the same, so that it can answer. False if too much is waiting: then the task is thrown away. Tasks must not throw.
  [[nodiscard]] bool add(Urgency urgency, const std::string& owner, Task task);

private:
  struct Entry {
    Urgency urgency;
    std::string owner;
    Task task;
    std::shared_ptr<bool> is_stale; ///< guarded by the mutex
  };

  void work();
  [[nodiscard]] bool is_stale(const Entry& entry);
  [[nodiscard]] std::deque<Entry>::iterator most_urgent();

  std::mutex mutex_;
  std::condition_variable something_;
  std::deque<Entry> waiting_;
  std::shared_ptr<bool> active_stale_;
  std::string active_owner_;
  bool is_ending_ = false;
  std::thread thread_;
};

} // namespace steplap
