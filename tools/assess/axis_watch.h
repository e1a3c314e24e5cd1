// Does every axis measure, from the first row to the last? An axis that keeps one value while others move has stopped.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace steplap::assess {

/// Takes samples as they were read, m/s².
class AxisWatch {
public:
  void put(double t, const double* a, std::size_t axes);
  /// After the last sample.
  void finish();

  struct Stuck {
    double from = 0.0, to = 0.0; ///< s
  };
  /// The stretch in which the axis kept one value while others moved; nothing if there is none.
  [[nodiscard]] std::optional<Stuck> stuck(std::size_t axis) const;
  /// Median of the first second, m/s²: a shock in it changes a mean.
  [[nodiscard]] double rest(std::size_t axis) const;
  /// Does the axis move by a few steps of its converter only, while another moves at least twenty times as far?
  [[nodiscard]] bool is_insensitive(std::size_t axis) const;

private:
  struct Run {
    double from = 0.0, to = 0.0;
    std::size_t rows = 0;
    double others = 0.0;            ///< m/s², largest range of another axis in it
    std::size_t others_changes = 0; ///< rows in which every other axis changed
  };
  struct Axis {
    double value = 0.0, step = std::numeric_limits<double>::infinity(); ///< m/s²; smallest change
    double least = std::numeric_limits<double>::infinity(), greatest = -std::numeric_limits<double>::infinity();
    std::size_t changes = 0;
    Run now, moved, longest;             ///< moved: that of all long runs in which others moved furthest
    std::array<double, 3> low{}, high{}; ///< of all axes in the run
  };
  void end_run(Axis& axis) const;
  [[nodiscard]] double others_range(std::size_t axis) const;

  std::array<Axis, 3> axes_;
  std::array<std::vector<double>, 3> first_second_;
  double begin_ = 0.0;
  std::size_t count_ = 0, rows_ = 0;
};

} // namespace steplap::assess
