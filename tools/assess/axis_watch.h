// Detects axes of a recorder that do not measure: constant while another moves, or without the noise that they have otherwise.
#pragma once

#include "tools/assess/noise_watch.h"

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace steplap::assess {

/// Receives the samples as read, m/s².
class AxisWatch {
public:
  /// Adds a sample with `axes` values.
  void put(double t, const double* a, std::size_t axes);
  /// Must be called after the last sample.
  void finish();

  struct Stuck {
    double from = 0.0, to = 0.0; ///< s
  };
  /// Returns the interval in which the axis was constant while others moved, or had no noise; nothing if there is none.
  [[nodiscard]] std::optional<Stuck> stuck(std::size_t axis) const;
  /// Returns the median of the first second, m/s². A shock in this second would change a mean, but hardly the median.
  [[nodiscard]] double rest(std::size_t axis) const;
  /// Returns true if the axis changes by only a few steps of its converter while another axis changes at least twenty times as much.
  [[nodiscard]] bool is_insensitive(std::size_t axis) const;

private:
  struct Run {
    double from = 0.0, to = 0.0;
    std::size_t rows = 0;
    double others = 0.0; ///< largest range of another axis during the run, m/s²
  };
  struct Axis {
    double value = 0.0, step = std::numeric_limits<double>::infinity(); ///< m/s²; smallest change of the value
    double least = std::numeric_limits<double>::infinity(), greatest = -std::numeric_limits<double>::infinity();
    std::size_t changes = 0;
    Run now, moved;                      ///< current run; the long run in which other axes moved most
    std::array<double, 3> low{}, high{}; ///< minimum and maximum of all axes during the run
    std::array<NoiseWatch, 2> noise{NoiseWatch(1), NoiseWatch(8)};
  };
  static void end_run(Axis& axis);
  [[nodiscard]] double others_range(std::size_t axis) const;

  std::array<Axis, 3> axes_;
  std::array<std::vector<double>, 3> first_second_;
  double begin_ = 0.0;
  std::size_t count_ = 0, rows_ = 0;
};

} // namespace steplap::assess
