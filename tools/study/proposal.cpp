#include "tools/study/proposal.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

namespace {

constexpr double k_wide = 0.2; // weight of the wide component

// Returns the points to be used as centres: design points; if there are none, unconverged points near the surface; otherwise all ends of
// searches.
std::vector<const DesignPoint*> usable_of(const std::vector<DesignPoint>& points) {
  std::vector<const DesignPoint*> usable;
  const auto take = [&](auto is_usable) {
    if (!usable.empty()) return;
    for (const DesignPoint& p : points)
      if (is_usable(p)) usable.push_back(&p);
  };
  take([](const DesignPoint& p) { return p.is_found; });
  take([](const DesignPoint& p) { return std::isfinite(p.off_surface); });
  take([](const DesignPoint&) { return true; });
  return usable;
}

} // namespace

Proposal::Proposal(const std::vector<DesignPoint>& points, const std::vector<std::vector<double>>& more, std::size_t dimension)
    : dimension_(dimension) {
  const std::vector<const DesignPoint*> usable = usable_of(points);
  double nearest = std::numeric_limits<double>::infinity();
  for (const DesignPoint* p : usable) nearest = std::min(nearest, std::abs(p->beta));
  // Distance beyond the nearest centre from which a centre is omitted: at 3 standard deviations more its probability is negligible.
  constexpr double k_too_far = 3.0;
  for (const DesignPoint* p : usable)
    if (std::abs(p->beta) < nearest + k_too_far) centres_.push_back(p->u);
  centres_.insert(centres_.end(), more.begin(), more.end());
  wide_ = std::max(1.0, 1.2 * nearest / std::sqrt(static_cast<double>(dimension)));
}

bool Proposal::draw(const CounterRandom& random, std::uint64_t sample, std::vector<double>& points) const {
  const double share = random.uniform(sample, 0);
  const bool is_wide = share < k_wide;
  const std::size_t k = is_wide
                            ? 0
                            : std::min(centres_.size() - 1,
                                       static_cast<std::size_t>((share - k_wide) / (1.0 - k_wide) * static_cast<double>(centres_.size())));
  for (std::size_t d = 0; d < dimension_; ++d) {
    const double z = random.normal(sample, static_cast<std::uint32_t>(d + 2));
    points.push_back(is_wide ? wide_ * z : centres_[k][d] + z);
  }
  return is_wide;
}

bool Proposal::is_stray(const double* u) const { return wide_part(u) * weight(u) > 0.9; }

double Proposal::weight(const double* u) const {
  double sum = wide_part(u);
  for (const auto& c : centres_) {
    double product = 0.0, own = 0.0;
    for (std::size_t d = 0; d < dimension_; ++d) product += u[d] * c[d], own += c[d] * c[d];
    sum += (1.0 - k_wide) / static_cast<double>(centres_.size()) * std::exp(product - 0.5 * own);
  }
  return 1.0 / sum;
}

double Proposal::wide_weight(const double* u) const { return k_wide / wide_part(u); }

// Returns the density of the wide normal component at u, with its weight k_wide, divided by the standard normal density.
double Proposal::wide_part(const double* u) const {
  const double distance = length_of(u, dimension_);
  return k_wide * std::pow(wide_, -static_cast<double>(dimension_)) * std::exp(0.5 * distance * distance * (1.0 - 1.0 / (wide_ * wide_)));
}

} // namespace steplap::study
