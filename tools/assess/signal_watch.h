// What the conditioned signal of a record comes to before it is searched for shocks: how far each axis goes, and whether it begins or ends
// within a shock.
#pragma once

#include "transformer/recorder/conditioner.h"

#include <array>
#include <cstddef>

namespace steplap::assess {

class SignalWatch : public SignalSink {
public:
  /// `level`, m/s²: a segment whose first or last samples are beyond it begins or ends within a shock.
  explicit SignalWatch(double level) : level_(level) {}

  /// Where a segment begins or ends within a shock.
  struct End {
    bool is_begin = true;
    double t = 0.0, value = 0.0; ///< s; m/s²
    char axis = 'x';
    std::size_t count = 0; ///< of such ends in the record; 0: there is none
  };
  [[nodiscard]] const End& first_end() const { return end_; }
  /// m/s² without sign, of each axis, filtered.
  [[nodiscard]] const std::array<double, 3>& greatest() const { return greatest_; }

  void begin(const RecordLayout& layout, double rate) override;
  void begin_segment(std::size_t line) override;
  void put(double t, const double* plain, const double* filtered) override;
  void end_segment() override;

private:
  void note(bool is_begin, double t, std::size_t axis, double value);
  static constexpr std::size_t k_looked_at = 3; // samples at an end: a single one may be noise that crosses zero
  double level_;
  std::size_t axes_ = 0, samples_ = 0;
  std::array<char, 3> letters_{};
  std::array<double, 3> greatest_{};
  std::array<std::array<double, 3>, k_looked_at> last_{};
  bool is_noted_ = false;
  double t_ = 0.0;
  End end_;
};

} // namespace steplap::assess
