// Evaluates the samples that a study requests. Samples in the store are read from it; the others are run on all threads of all ranks and
// stored.
//
// An interrupted study requests the same samples in the same order when it is repeated, because requests depend neither on threads or ranks
// nor on time. The store alone therefore determines where the study continues.
#pragma once

#include "tools/study/ranks.h"
#include "tools/study/store_writer.h"

#include <functional>
#include <memory>

namespace steplap::study {

/// Thrown if a sample failed and the study has failed = "stop", or if the user stopped the study. Exit code 4.
class StudyStopped : public NumericalFailure {
public:
  using NumericalFailure::NumericalFailure;
};

/// Progress of a study.
struct Pace {
  long samples = 0, stored = 0; ///< samples requested so far, and how many of them the store contained
  double seconds = 0.0;
  double rate = 0.0;     ///< samples per second, recently
  std::string estimate;  ///< latest estimate as a text
  long expected = 0;     ///< number of samples at the end of the current method; 0: unknown
  bool is_guess = false; ///< true if `expected` is an extrapolation from the scatter of the estimate
};

class Workers;

/// Evaluates samples and keeps the store up to date.
class Evaluator {
public:
  Evaluator(const LoadedStudy& loaded, Store& store, const Ranks& ranks, int threads, std::function<void(const Pace&)> progress);
  ~Evaluator();

  /// Returns the outcomes of `points` (values of all variables, one point after the other) in their order, valid until the next call.
  const std::vector<StoredSample>& evaluate(const std::vector<double>& points);
  /// Returns the number of samples requested so far.
  [[nodiscard]] long asked() const { return next_ - 1; }
  /// Waits until all requested samples are written and returns the store.
  [[nodiscard]] Store& store() { return writer_.store(); }
  /// Stores an intermediate estimate and reports it to `progress`.
  void note(const Finding& finding);
  /// Sets the number of samples still to come, for the prediction of the remaining time; 0: unknown. `is_guess`: extrapolated from an
  /// estimate.
  void expect(long more, bool is_guess = false);
  /// Returns the time since the study was started or continued, s.
  [[nodiscard]] double seconds() const;

  /// Returns how many samples are run per second, by the latest batch; zero if all came from the store.
  [[nodiscard]] double rate() const { return pace_.rate; }

  /// Called on ranks other than 0: runs the samples that rank 0 requests until dismiss().
  static void serve(const LoadedStudy& loaded, const Ranks& ranks, int threads);
  /// Called on rank 0: ends serve() on the other ranks.
  static void dismiss(const Ranks& ranks);

private:
  void fetch(std::size_t from, std::size_t count, const std::vector<double>& points);
  [[nodiscard]] bool may_go_another_way(Store& store) const;
  void run(std::size_t from, std::size_t count, const std::vector<double>& points);
  void check(const StoredSample& sample) const;

  const LoadedStudy& loaded_;
  StoreWriter writer_;
  long stored_; ///< samples in the store, including those still queued for writing
  const Ranks& ranks_;
  std::unique_ptr<Workers> workers_;
  std::function<void(const Pace&)> progress_;
  std::vector<StoredSample> rows_, fetched_;
  long next_ = 1, notes_ = 0;
  std::size_t chunk_ = 0;
  double begin_ = 0.0;
  Pace pace_;
};

} // namespace steplap::study
