// Requirements of friction laws that depend on the direction of slip: the accuracy of velocities, and the length of steps.
#include "mbd/base/portable_math.h"
#include "mbd/dynamics/dynamics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

// Reduces the scales of those coordinates that move a cluster of a mechanism. The scale of a rate is `found.speed` divided by the largest
// velocity of the contact point per unit rate. `speed` receives the slowest slip.
void narrow_scales(const Layout& layout, int cluster, const SlipScale& found, double lever, double* scale, double* speed) {
  const Mechanism& m = layout.mechanism_of_cluster(cluster);
  for (int i = 0; i < m.size(); ++i) {
    if ((m.moved_by(cluster) >> i & 1U) == 0) continue;
    const int c = m.first_coordinate + i;
    scale[c] = std::min(scale[c], m.is_place(i) ? found.speed : found.speed / (lever + m.reach(i)));
    speed[c] = std::min(speed[c], found.speed);
  }
}

} // namespace

void Dynamics::sliding_rates(std::size_t i, double* rate) const {
  const FrictionUnit& unit = system_.frictions[layout_->sliding[i]];
  const RowSpec* rows = unit.friction->rows(state_->friction[layout_->sliding[i]]);
  for (int r = 0; r < unit.friction->dimension(); ++r)
    rate[r] = evaluate_row<false>(rows[r], motion_[layout_->sliding_link[i]], Origin{}).rate;
}

bool Dynamics::slip_scales(double* scale) {
  bool is_any = false;
  double* const speed = scale + coordinate_count();
  for (std::size_t i = 0; i < layout_->sliding.size(); ++i) {
    const FrictionState& friction = state_->friction[layout_->sliding[i]];
    const FrictionElement& element = *system_.frictions[layout_->sliding[i]].friction;
    if (!element.depends_on_slip_direction(friction)) continue;
    need(ResultLevel::motion);
    ensure_byproducts();
    double rate[3];
    sliding_rates(i, rate);
    const SlipScale found = element.slip_scale(evaluation_, friction, rate);
    if (!std::isfinite(found.speed)) continue;
    if (!is_any) std::fill(scale, speed + coordinate_count(), std::numeric_limits<double>::infinity());
    is_any = true;
    const RowSpec& row = element.rows(friction)[0];
    for (const int body : {row.a, row.b}) {
      const int cluster = layout_->placements[body].cluster;
      if (cluster < 0) continue;
      const Motion<double>& centre = motion_[layout_->clusters[cluster].motion];
      const double lever = found.lever + portable::hypot(motion_[row.a].x - centre.x, motion_[row.a].y - centre.y);
      if (cluster >= layout_->absolute_count) {
        narrow_scales(*layout_, cluster, found, lever, scale, speed);
        continue;
      }
      for (int c = 0; c < 3; ++c) {
        const int k = 3 * cluster + c;
        scale[k] = std::min(scale[k], c < 2 ? found.speed : found.speed / lever);
        speed[k] = std::min(speed[k], found.speed);
      }
    }
  }
  return is_any;
}

bool Dynamics::depends_on_slip_direction() const {
  return std::any_of(layout_->sliding.begin(), layout_->sliding.end(),
                     [this](int f) { return system_.frictions[f].friction->depends_on_slip_direction(state_->friction[f]); });
}

double Dynamics::slip_decay_rate() {
  double fastest = 0.0;
  for (std::size_t i = 0; i < layout_->sliding.size(); ++i) {
    const int f = layout_->sliding[i];
    if (!system_.frictions[f].friction->depends_on_slip_direction(state_->friction[f])) continue;
    need(ResultLevel::motion);
    ensure_byproducts();
    double rate[3];
    sliding_rates(i, rate);
    fastest = std::max(fastest, system_.frictions[f].friction->max_damping_rate(evaluation_, state_->friction[f], rate));
  }
  return fastest;
}

} // namespace steplap
