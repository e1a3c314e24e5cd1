// Samples in the order in which a study asks for them: those in the store are taken from there, the others are run on
// all threads of all ranks, and stored.
//
// A study that is interrupted asks for the same samples again, in the same order, when it is run once more: nothing of
// what it asks for hangs on threads, ranks or time. So the store alone tells where to go on.
#pragma once

#include "tools/study/ranks.h"
#include "tools/study/store_writer.h"

#include <functional>
#include <memory>

namespace steplap::study {

/// failed = "stop", and a sample's run did not reach its end; or somebody asked the study to stop. Exit code 4.
class StudyStopped : public NumericalFailure {
public:
  using NumericalFailure::NumericalFailure;
};

/// How far a study is.
struct Pace {
  long samples = 0, stored = 0; ///< asked for so far; of these, found in the store
  double seconds = 0.0;
  double rate = 0.0;     ///< samples run a second, lately
  std::string estimate;  ///< the last that was noted
  long expected = 0;     ///< samples when what runs now will have ended; 0: not known
  bool is_guess = false; ///< that hangs on how an estimate goes on
};

class Workers;

class Evaluator {
public:
  Evaluator(const LoadedStudy& loaded, Store& store, const Ranks& ranks, int threads, std::function<void(const Pace&)> progress);
  ~Evaluator();

  /// The outcomes of `points` (of all variables, one after the other), in their order; good until the next call.
  const std::vector<StoredSample>& evaluate(const std::vector<double>& points);
  /// Samples asked for so far.
  [[nodiscard]] long asked() const { return next_ - 1; }
  /// The store, with all that was asked for so far in it.
  [[nodiscard]] Store& store() { return writer_.store(); }
  /// Keeps an estimate as it grew, and shows it.
  void note(const Finding& finding);
  /// For the time left: so many samples are still to come, by a guess from how an estimate grew, or for sure; 0: not
  /// known.
  void expect(long more, bool is_guess = false);
  /// Seconds since the study began, of this call of the program.
  [[nodiscard]] double seconds() const;

  /// Of the other ranks: runs what rank 0 asks for until it is done.
  static void serve(const LoadedStudy& loaded, const Ranks& ranks, int threads);
  /// At rank 0: lets the others go.
  static void dismiss(const Ranks& ranks);

private:
  void fetch(std::size_t from, std::size_t count, const std::vector<double>& points);
  [[nodiscard]] bool may_go_another_way(Store& store) const;
  void run(std::size_t from, std::size_t count, const std::vector<double>& points);
  void check(const StoredSample& sample) const;

  const LoadedStudy& loaded_;
  StoreWriter writer_;
  long stored_; ///< samples in the store, or on their way there
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
