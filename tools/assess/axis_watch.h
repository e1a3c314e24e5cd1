// Detects axes of a recorder that do not measure: the value is constant while other axes change, or the noise of the axis stops.
#pragma once

#include "tools/assess/noise_watch.h"

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace steplap::assess {

/// Inspects the samples as read from the file, m/s².
class AxisWatch {
public:
  /// Adds a sample with `axes` values.
  void put(double t, const double* a, std::size_t axes);
  /// Must be called after the last sample.
  void finish();

  struct DeadInterval {
    double from = 0.0, to = 0.0; ///< begin and end of the interval, s
  };
  /// Returns the interval in which the axis was constant while others changed, or had no noise; nothing if there is none.
  [[nodiscard]] std::optional<DeadInterval> stuck(std::size_t axis) const;
  /// Returns the median of the first second, m/s². A mean would be changed by a shock in this second.
  [[nodiscard]] double rest(std::size_t axis) const;
  /// Returns true if the axis changes by at most four steps of its converter while another changes at least twenty times as much.
  [[nodiscard]] bool is_insensitive(std::size_t axis) const;

private:
  /// An interval in which the value of one axis is constant.
  struct ConstantInterval {
    double from = 0.0, to = 0.0; ///< begin and end of the interval, s
    std::size_t rows = 0;        ///< number of samples
    double others = 0.0;         ///< largest change of another axis while this one was constant, m/s²
  };
  struct Axis {
    double value = 0.0, step = std::numeric_limits<double>::infinity(); ///< present value and smallest change of the value, m/s²
    double least = std::numeric_limits<double>::infinity(), greatest = -std::numeric_limits<double>::infinity();
    std::size_t changes = 0;
    ConstantInterval current;            ///< the interval that contains the last sample
    ConstantInterval suspect;            ///< the sufficiently long interval in which another axis changed most
    std::array<double, 3> low{}, high{}; ///< range of each axis during `current`, m/s²
    std::array<NoiseWatch, 2> noise{NoiseWatch(1), NoiseWatch(8)};
  };
  static void end_constant_interval(Axis& axis);
  [[nodiscard]] double others_range(std::size_t axis) const;

  std::array<Axis, 3> axes_;
  std::array<std::vector<double>, 3> first_second_;
  double begin_ = 0.0;
  std::size_t count_ = 0, rows_ = 0;
};

} // namespace steplap::assess
