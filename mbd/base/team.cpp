#include "mbd/base/team.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <string_view>
#include <thread>
#include <vector>

namespace steplap {

namespace {

// Looks before a thread sleeps, some tens of microseconds; none where there are more threads than processors.
constexpr int k_looks = 2000;
constexpr int k_looks_between_offers = 100;

void rest_a_moment() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

} // namespace

// What is shared stands under the mutex. The counts beside it tell who waits only when to take the mutex, and decide nothing.
struct Team::Threads {
  std::mutex mutex;
  std::condition_variable begun, done;
  long round = 0; ///< calls of share() so far
  int count = 0, busy = 0;
  Work work = nullptr;
  const void* job = nullptr;
  bool is_over = false;
  std::exception_ptr failure;
  int failed_at = 0;

  std::atomic<long> round_hint{0}, done_hint{0};
  int size = 1, looks = 0;
  std::vector<std::thread> others;

  // By functions of their own, which the tests for data races know by name: a value that is late here costs time alone.
  [[gnu::noinline]] static void hint(std::atomic<long>& at, long value) { at.store(value, std::memory_order_release); }
  [[gnu::noinline]] static bool is_hinted(const std::atomic<long>& at, long value) { return at.load(std::memory_order_acquire) >= value; }
  // Whom it waits for may be without a processor: now and then it offers its own.
  void look_for(const std::atomic<long>& at, long value) const {
    for (int i = 1; i <= looks && !is_hinted(at, value); ++i) {
      if (i % k_looks_between_offers == 0) std::this_thread::yield();
      else rest_a_moment();
    }
  }

  void take_stretch(int thread, int all, Work do_work, const void* of) {
    const auto bound = [all, this](int i) { return static_cast<int>(static_cast<long>(all) * i / size); };
    int i = bound(thread);
    try {
      for (; i < bound(thread + 1); ++i) do_work(of, i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure || i < failed_at) {
        failure = std::current_exception();
        failed_at = i;
      }
    }
  }

  void serve(int thread) {
    for (long seen = 0;;) {
      look_for(round_hint, seen + 1);
      std::unique_lock lock(mutex);
      begun.wait(lock, [&] { return round > seen || is_over; });
      if (is_over) return;
      seen = round;
      const int all = count;
      const Work do_work = work;
      const void* const of = job;
      lock.unlock();
      take_stretch(thread, all, do_work, of);
      lock.lock();
      if (--busy > 0) continue;
      done.notify_one();
      lock.unlock();
      hint(done_hint, seen);
    }
  }
};

// As OpenMP has it; of a list the number for the outermost level, and what is no number is passed over.
int Team::usual_size() {
  const char* const given = std::getenv("OMP_NUM_THREADS");
  const std::string_view wanted = given ? given : "";
  int threads = 0;
  std::from_chars(wanted.data(), wanted.data() + wanted.size(), threads);
  if (threads > 0) return threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Team::Team(int threads) : size_(threads) {
  if (threads < 2) return;
  threads_ = std::make_unique<Threads>();
  threads_->size = threads;
  threads_->looks = static_cast<unsigned>(threads) <= std::thread::hardware_concurrency() ? k_looks : 0;
  for (int i = 1; i < threads; ++i) threads_->others.emplace_back([this, i] { threads_->serve(i); });
}

Team::~Team() {
  if (!threads_) return;
  {
    const std::lock_guard lock(threads_->mutex);
    threads_->is_over = true;
    threads_->begun.notify_all();
  }
  Threads::hint(threads_->round_hint, threads_->round + 1);
  for (std::thread& other : threads_->others) other.join();
}

void Team::share(int count, Work work, const void* job) {
  Threads& t = *threads_;
  long round = 0;
  {
    const std::lock_guard lock(t.mutex);
    t.count = count;
    t.work = work;
    t.job = job;
    t.busy = size_ - 1;
    t.failure = nullptr;
    round = ++t.round;
    t.begun.notify_all(); // costs next to nothing where none sleeps
  }
  Threads::hint(t.round_hint, round);
  t.take_stretch(0, count, work, job);
  t.look_for(t.done_hint, round);
  std::unique_lock lock(t.mutex);
  t.done.wait(lock, [&] { return t.busy == 0; });
  if (!t.failure) return;
  const std::exception_ptr failure = t.failure;
  t.failure = nullptr;
  lock.unlock();
  std::rethrow_exception(failure);
}

} // namespace steplap
