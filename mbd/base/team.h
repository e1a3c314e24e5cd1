// Threads that share the work of one run.
//
// A large scene is evaluated in parts (mbd/dynamics/parts.h), each thread taking a stretch of them, the same one every time, so that
// what it has touched is in its own cache. Which thread does what changes no result: whatever is summed over parts is summed in
// their order by the thread that asked.
//
// Evaluations ask for work every few hundred microseconds, so whoever waits looks for it for a while before it sleeps;
// on a machine with other work a thread that went on looking would take the time of the one that it waits for. (OpenMP's
// threads look for milliseconds, or sleep at once, and that is chosen by the environment a process is started in.)
#pragma once

#include <array>
#include <memory>

namespace steplap {

class Team {
public:
  /// `threads` ≥ 1, that of the caller included.
  explicit Team(int threads = 1);
  ~Team();
  Team(const Team&) = delete; // threads refer to it
  Team& operator=(const Team&) = delete;

  [[nodiscard]] int size() const { return size_; }
  /// OMP_NUM_THREADS, else as many as there are processors for this process.
  [[nodiscard]] static int usual_size();

  /// job(i) for every i from 0 to count − 1, each thread its stretch of them in ascending order; returns when all are done. Throws
  /// what the job of the least i has thrown, of those that did. To be called by one thread at a time, and not by a job.
  template <class Job> void each(int count, const Job& job) {
    if (size_ == 1 || count < 2) {
      for (int i = 0; i < count; ++i) job(i);
      return;
    }
    share(count, [](const void* of, int i) { (*static_cast<const Job*>(of))(i); }, &job);
  }

  /// job(from, to) for stretches that make up 0 … count, a multiple of 8 each but the last; for sums of arrays, element by element.
  template <class Job> void stretches(int count, const Job& job) {
    if (size_ == 1 || count < k_least_stretch) {
      job(0, count);
      return;
    }
    const auto bound = [count, this](int i) { return i == size_ ? count : static_cast<int>(8L * (count / 8L * i / size_)); };
    each(size_, [&](int i) { job(bound(i), bound(i + 1)); });
  }

  /// Fewer numbers than this are added up while another thread wakes.
  static constexpr int k_least_stretch = 8192;

private:
  using Work = void (*)(const void* job, int i);
  void share(int count, Work work, const void* job);

  struct Threads;
  int size_;
  std::unique_ptr<Threads> threads_;
};

/// The sum of of(from, to) over 0 … count: in one piece if they are fewer than `least`, else in always as many pieces, which are added up
/// in their order whatever the number of threads.
template <class Sum, class Of> [[nodiscard]] Sum ordered_sum(Team& team, int count, int least, const Of& of) {
  if (count < least) return of(0, count);
  constexpr int k_pieces = 64;
  std::array<Sum, k_pieces> pieces;
  const auto bound = [count](int i) { return static_cast<int>(static_cast<long>(count) * i / k_pieces); };
  team.each(k_pieces, [&](int i) { pieces[i] = of(bound(i), bound(i + 1)); });
  Sum sum = pieces[0];
  for (int i = 1; i < k_pieces; ++i) sum += pieces[i];
  return sum;
}

} // namespace steplap
