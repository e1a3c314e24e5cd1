#include "mbd/rest/clearance.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

// Fractions of the thickness of a part: the path allowed between two measurements (k_look), and the depth at which a closed contact stops
// the step.
constexpr double k_look = 0.25, k_half = 0.5;
constexpr double k_rounded = 1.0 - 1e-6; // factor on a path that was chosen to fit the available space exactly
constexpr double k_endless = std::numeric_limits<double>::infinity();

// Returns the path that the parts may move between two measurements, m.
double room_of(const GapBounds& bounds) { return std::max(bounds.gap, k_look * bounds.through); }

// Returns an upper bound of the path of the parts in a displacement, m.
double way_of(const GapBounds& bounds, const VecX& displacement) {
  const auto of = [&displacement](int body, int k) { return body == k_ground ? 0.0 : displacement[3 * body - 3 + k]; };
  return portable::hypot(of(bounds.a, 0) - of(bounds.b, 0), of(bounds.a, 1) - of(bounds.b, 1)) +
         std::abs(of(bounds.a, 2)) * bounds.reach_a + std::abs(of(bounds.b, 2)) * bounds.reach_b;
}

} // namespace

Clearance::Clearance(const System& system, double touch) : touch_(touch), still_(3 * system.bodies.size(), 0.0) {
  for (const auto& group : system.groups)
    if (const GapSource* const source = group->gap_source()) sources_.push_back(source);
}

void Clearance::measure(const std::vector<double>& q, bool is_instead) {
  if (!is_instead) std::swap(now_, before_);
  now_.clear();
  place_bodies(q, still_, motion_);
  for (const GapSource* source : sources_) source->add_gaps(motion_.data(), now_);
}

double Clearance::share(const VecX& displacement) const {
  double share = k_endless;
  for (const GapBounds& bounds : now_) {
    if (bounds.gap < 0.0) continue;
    const double room = room_of(bounds), way = way_of(bounds, displacement);
    if (room < k_endless && way * share > room) share = room / way;
  }
  return share;
}

bool Clearance::keeps_sides(const VecX& displacement) const {
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const GapBounds &was = before_[i], &is = now_[i];
    if (was.gap < 0.0 && is.gap < 0.0 && dot(was.normal, is.normal) > 0.0) continue;
    if (way_of(was, displacement) * k_rounded > room_of(was)) return false;
  }
  return true;
}

bool Clearance::has_met() const {
  for (std::size_t i = 0; i < now_.size() && i < before_.size(); ++i) {
    const double was = before_[i].gap, is = now_[i].gap;
    if (was > touch_ && is < 0.0) return true;
    if (is < was && is < -k_half * now_[i].through) return true;
  }
  return false;
}

} // namespace steplap
