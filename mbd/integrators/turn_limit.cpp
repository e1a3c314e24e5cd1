#include "mbd/integrators/turn_limit.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// A step that ends within this fraction of the interval after a knot counts as ending at the knot. Larger than k_reached of
// turn_table.cpp.
constexpr double k_beyond_knot = 0.05;
constexpr double k_shorter = 0.9; // safety factor for repeating a step that turned too far
constexpr double k_whole = 1e-9;  // relative tolerance when the remaining interval is divided by the step

// Returns the time, s, in which the angle `turn`, rad, is reached with `rate` and `acceleration`, both positive.
double time_to(double turn, double rate, double acceleration) {
  return 2.0 * turn / (rate + std::sqrt(rate * rate + 2.0 * acceleration * turn));
}

// Returns the index of the coordinate that is the angle of a cluster.
int angle_of(const Layout& layout, int cluster) {
  if (cluster < layout.absolute_count) return 3 * cluster + 2;
  const Mechanism& m = layout.mechanism_of_cluster(cluster);
  return m.first_coordinate + m.members[static_cast<std::size_t>(m.member_of(cluster))].coordinate;
}

} // namespace

TurnLimit::TurnLimit(const System& system) : turns_(turn_table_of(system).turns()) {
  has_knots_ = std::any_of(turns_.begin(), turns_.end(), [](const Turn& turn) { return !turn.knots.empty(); });
}

double TurnLimit::relative_turn(const Layout& layout, const Turn& turn, const double* values) {
  const int a = layout.placements[static_cast<std::size_t>(turn.a)].cluster;
  const int b = layout.placements[static_cast<std::size_t>(turn.b)].cluster;
  if (a == b) return 0.0; // both bodies belong to one cluster
  return (a < 0 ? 0.0 : values[angle_of(layout, a)]) - (b < 0 ? 0.0 : values[angle_of(layout, b)]);
}

double TurnLimit::offset(const Layout& layout, const Turn& turn) {
  return layout.placements[static_cast<std::size_t>(turn.a)].angle - layout.placements[static_cast<std::size_t>(turn.b)].angle;
}

double TurnLimit::shortened(const Layout& layout, const double* y, const double* dy, double h, int division) {
  for (const Turn& turn : turns_) {
    const double longest = shortened_by(turn, layout, y, dy, h, division);
    if (longest >= h) continue;
    limiting_ = &turn;
    h = longest;
  }
  return h;
}

double TurnLimit::shortened_by(const Turn& turn, const Layout& layout, const double* y, const double* dy, double h, int division) {
  const double rate = relative_turn(layout, turn, y + layout.coordinate_count);
  double most = k_aim / division;
  if (std::abs(rate) * h <= (turn.knots.empty() ? most : 0.0)) return h;
  const double angle = turn.knots.empty() ? 0.0 : relative_turn(layout, turn, y) + offset(layout, turn);
  for (const TurnKnots& knots : turn.knots) {
    const double x = angle + knots.zero;
    const TurnKnots::Interval interval = knots.about(x, rate);
    const double left = rate > 0.0 ? interval.high - x : x - interval.low, part = (interval.high - interval.low) / division;
    // Up to the knot equal steps are made, each no longer than this part.
    if (std::isfinite(left)) most = std::min(most, left / std::max(1.0, std::ceil(left / part - k_whole)));
  }
  // An acceleration that would double the rate within the step is a transient and is ignored; the rotation is checked at the end of the
  // step.
  const double even = most / std::abs(rate), growth = relative_turn(layout, turn, dy + layout.coordinate_count) * (rate > 0.0 ? 1.0 : -1.0);
  const bool is_steady = growth > 0.0 && growth * even < std::abs(rate);
  return is_steady ? time_to(most, std::abs(rate), growth) : even;
}

double TurnLimit::kept_by_all(const Layout& layout, const double* y0, const double* y1) {
  double share = 1.0;
  for (const Turn& turn : turns_) {
    const double turned = relative_turn(layout, turn, y1) - relative_turn(layout, turn, y0);
    const double kept = std::abs(turned) > (turn.knots.empty() ? k_most : 0.0) ? kept_by(turn, layout, y0, turned) : 1.0;
    if (kept >= share) continue;
    share = kept;
    limiting_ = &turn;
  }
  return share;
}

double TurnLimit::kept_by(const Turn& turn, const Layout& layout, const double* y0, double turned) {
  double most = k_most;
  const double angle = turn.knots.empty() ? 0.0 : relative_turn(layout, turn, y0) + offset(layout, turn);
  for (const TurnKnots& knots : turn.knots) {
    const double x = angle + knots.zero;
    const TurnKnots::Interval interval = knots.about(x, turned);
    const double knot = turned > 0.0 ? interval.high : interval.low;
    if (!std::isfinite(knot)) continue;
    const TurnKnots::Interval behind = knots.about(knot, turned); // interval behind this knot
    const double width = std::isfinite(behind.high - behind.low) ? std::min(behind.high - behind.low, k_most) : k_most;
    most = std::min(most, std::abs(knot - x) + k_beyond_knot * width);
  }
  return std::abs(turned) > most ? k_shorter * most / std::abs(turned) : 1.0;
}

} // namespace steplap
