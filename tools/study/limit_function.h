// The limit states of a study as one function g on standard normal space, used by all reliability methods.
#pragma once

#include "tools/study/counter_random.h"
#include "tools/study/study_run.h"

namespace steplap::study {

/// Value of the limit function for one sample.
struct LimitValue {
  double g = 0.0;          ///< value of the limit function; negative: failure
  bool is_missing = false; ///< true if the run failed or is not trusted; g is then undefined
  bool is_bad = false;     ///< true if it is unknown whether the sample fails: g is missing, or zero to rounding
};

struct ReliabilitySettings;

/// A system of limit states, in series (any failure is a failure) or in parallel (all must fail).
class LimitSystem {
public:
  /// `is_any`: the system fails if any of the limit states does, otherwise only if all do.
  LimitSystem(const LoadedStudy& loaded, const std::vector<std::string>& names, bool is_any);

  /// Returns the least of the limit states, or the largest if all must fail.
  [[nodiscard]] LimitValue value_of(const Outcome& outcome) const;
  /// Returns the limit states in words, for findings.
  [[nodiscard]] const std::string& text() const { return text_; }

private:
  std::vector<std::size_t> places_; ///< indices of the limit states among the numbers
  bool is_any_;
  std::string text_;
};

/// The limit function g of a study. It counts failed runs and keeps the failing point closest to the origin.
class LimitFunction {
public:
  explicit LimitFunction(StudyRun& run);

  [[nodiscard]] std::size_t dimension() const { return run_.law.dimension(); }
  /// Evaluates `points` of standard normal space, given one after the other. The result is valid until the next call.
  const std::vector<LimitValue>& at(const std::vector<double>& points);
  /// Returns the limit states that are evaluated.
  [[nodiscard]] const LimitSystem& system() const { return system_; }
  /// Evaluates a single point.
  [[nodiscard]] LimitValue at_point(const std::vector<double>& u);

  [[nodiscard]] StudyRun& run() { return run_; }
  [[nodiscard]] const Study& study() const { return run_.study(); }
  [[nodiscard]] const ReliabilitySettings& settings() const { return settings_; }
  /// Returns the number of samples requested so far, by all methods.
  [[nodiscard]] long asked() const { return run_.evaluator.asked(); }
  /// Returns the name of the system of limit states for findings.
  [[nodiscard]] const std::string& subject() const { return system_.text(); }
  [[nodiscard]] long bad() const { return bad_; } ///< number of bad samples so far
  /// Returns the smallest distance of a failing point to the origin so far; infinite if there was none.
  [[nodiscard]] double nearest_failure() const { return nearest_; }
  /// Returns that failing point.
  [[nodiscard]] const std::vector<double>& nearest_point() const { return nearest_point_; }

private:
  StudyRun& run_;
  const ReliabilitySettings& settings_;
  LimitSystem system_;
  std::vector<double> values_;
  std::vector<LimitValue> limits_;
  long bad_ = 0;
  double nearest_ = std::numeric_limits<double>::infinity();
  std::vector<double> nearest_point_;
};

/// Returns the Euclidean length of a vector.
[[nodiscard]] double length_of(const double* u, std::size_t n);

} // namespace steplap::study
