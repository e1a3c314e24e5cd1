// Inspects the conditioned signal of a record before the search for shocks: largest value of each axis, and whether the record begins or
// ends during a shock.
#pragma once

#include "transformer/recorder/conditioner.h"

#include <array>
#include <cstddef>

namespace steplap::assess {

/// Receives the conditioned signal.
class SignalWatch : public SignalSink {
public:
  /// A segment begins or ends during a shock if its first or last samples exceed `level`, m/s².
  explicit SignalWatch(double level) : level_(level) {}

  /// A begin or end of a segment during a shock.
  struct End {
    bool is_begin = true;
    double t = 0.0, value = 0.0; ///< s; m/s²
    char axis = 'x';
    std::size_t count = 0; ///< number of such ends in the record; 0: none
  };
  /// Returns the first begin or end during a shock, with their number.
  [[nodiscard]] const End& first_end() const { return end_; }
  /// Returns the largest magnitude of each axis, filtered, m/s².
  [[nodiscard]] const std::array<double, 3>& greatest() const { return greatest_; }

  void begin(const RecordLayout& layout, double rate) override;
  void begin_segment(std::size_t line) override;
  void put(double t, const double* plain, const double* filtered) override;
  void end_segment() override;

private:
  void note(bool is_begin, double t, std::size_t axis, double value);
  static constexpr std::size_t k_inspected = 3; // samples inspected at an end; a single one may be a zero crossing
  double level_;
  std::size_t axes_ = 0, samples_ = 0;
  std::array<char, 3> letters_{};
  std::array<double, 3> greatest_{};
  std::array<std::array<double, 3>, k_inspected> last_{};
  bool is_noted_ = false;
  double t_ = 0.0;
  End end_;
};

} // namespace steplap::assess
