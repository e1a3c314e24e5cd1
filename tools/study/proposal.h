// Density from which importance sampling draws, in standard normal space.
#pragma once

#include "tools/study/design_points.h"

namespace steplap::study {

/// A mixture of normal densities around each design point and a wide one around the origin.
class Proposal {
public:
  /// `points`: ends of design point searches, at least one. `more`: further centres.
  Proposal(const std::vector<DesignPoint>& points, const std::vector<std::vector<double>>& more, std::size_t dimension);

  /// Appends the coordinates of a sample to `points`. Uses the random numbers with index 0 and from 2 on. Returns true if the wide component
  /// drew it.
  bool draw(const CounterRandom& random, std::uint64_t sample, std::vector<double>& points) const;
  /// Returns true if the density at u is due almost only to the wide component. A failure at such a point indicates an unknown design
  /// point.
  [[nodiscard]] bool is_stray(const double* u) const;
  /// Returns the ratio of the standard normal density to the sampling density.
  [[nodiscard]] double weight(const double* u) const;
  /// Returns the ratio of the standard normal density to that of the wide component.
  [[nodiscard]] double wide_weight(const double* u) const;

private:
  [[nodiscard]] double wide_part(const double* u) const;

  std::size_t dimension_;
  std::vector<std::vector<double>> centres_;
  double wide_ = 1.0; ///< standard deviation of the wide part
};

} // namespace steplap::study
