#include "mbd/system/turn_table.h"

#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_turn = 2.0 * std::numbers::pi;
// Fraction of the distance between knots: a knot ahead that is nearer counts as reached. If the angular velocity is not constant, steps end
// slightly off a knot, and an extra step for the remainder would be useless.
constexpr double k_reached = 0.02;
constexpr double k_without_end = std::numeric_limits<double>::infinity();

} // namespace

TurnKnots::Interval TurnKnots::about(double x, double direction) const {
  const double turned = is_periodic ? k_turn * std::floor((x - at.front()) / k_turn) : 0.0;
  const auto after = static_cast<std::ptrdiff_t>(std::upper_bound(at.begin(), at.end(), x - turned) - at.begin());
  const auto last = static_cast<std::ptrdiff_t>(at.size()) - 1;
  // Returns the angle of knot i; a periodic curve is continued beyond both ends.
  const auto knot = [&](std::ptrdiff_t i) {
    if (!is_periodic) return i < 0 ? -k_without_end : (i > last ? k_without_end : at[static_cast<std::size_t>(i)]);
    const std::ptrdiff_t turns = i < 0 ? -1 : i / last;
    return turned + k_turn * static_cast<double>(turns) + at[static_cast<std::size_t>(i - turns * last)];
  };
  const Interval here{knot(after - 1), knot(after)};
  const double reached = k_reached * (here.high - here.low);
  if (direction > 0.0 && here.high - x <= reached && here.high < k_without_end) return {here.high, knot(after + 1)};
  if (direction < 0.0 && x - here.low <= reached && here.low > -k_without_end) return {knot(after - 2), here.low};
  return here;
}

Turn& TurnTable::entry(int a, int b) {
  const std::uint64_t key = static_cast<std::uint64_t>(a) << 32U | static_cast<std::uint32_t>(b);
  const auto [place, is_new] = index_.try_emplace(key, turns_.size());
  if (is_new) turns_.push_back({a, b});
  return turns_[place->second];
}

void TurnTable::add(int a, int b) {
  if (a != b) (void)entry(std::max(a, b), std::min(a, b));
}

void TurnTable::add(int a, int b, TurnKnots knots) {
  if (a == b) return;
  if (a < b) { // the same curve over the angle of b relative to a
    std::reverse(knots.at.begin(), knots.at.end());
    for (double& x : knots.at) x = -x;
    knots.zero = -knots.zero;
  }
  entry(std::max(a, b), std::min(a, b)).knots.push_back(std::move(knots));
}

void TurnTable::add(int a, int b, Turning turning) {
  if (turning.a) add(a, k_ground);
  if (turning.b) add(b, k_ground);
  if (turning.a && turning.b) add(a, b);
}

void TurnTable::add_all(std::span<const int> bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    add(bodies[i], k_ground);
    for (std::size_t j = 0; j < i; ++j) add(bodies[i], bodies[j]);
  }
}

void TurnTable::add_marked(const std::vector<char>& is_marked) {
  constexpr std::size_t k_many = 8;
  std::vector<int> bodies;
  for (int i = 1; i < static_cast<int>(is_marked.size()); ++i)
    if (is_marked[static_cast<std::size_t>(i)] != 0) bodies.push_back(i);
  if (bodies.size() <= k_many) return add_all(bodies);
  for (const int body : bodies) add(body, k_ground);
}

Turning turning_of(const RowSpec& row) {
  const bool a = moves_by_turning(row.point_a), b = moves_by_turning(row.point_b);
  switch (row.kind) {
  case MeasureKind::angle: return {};
  case MeasureKind::distance:
  case MeasureKind::roll_round: return {a, b};
  case MeasureKind::skate: return {true, false};
  case MeasureKind::slide: return {a || row.is_axis_in_a, true};
  case MeasureKind::axis:
  case MeasureKind::roll_line: break;
  }
  return {a, true};
}

namespace {

void enter_row(const RowSpec& row, TurnTable& turns) {
  for (const RowSpec* part = &row; part; part = part->next) turns.add(part->a, part->b, turning_of(*part));
}

} // namespace

void ForceGroup::register_turns(TurnTable& turns) const {
  std::vector<char> is_used(turns.body_count(), 0);
  mark_bodies(is_used);
  turns.add_marked(is_used);
}

TurnTable turn_table_of(const System& system) {
  TurnTable turns(system.bodies.size());
  for (const auto& group : system.groups) group->register_turns(turns);
  for (const RowSpec& row : system.rows) enter_row(row, turns);
  for (const FrictionUnit& unit : system.frictions)
    for (int i = 0; i < unit.friction->dimension(); ++i) enter_row(unit.friction->rows({})[i], turns);
  return turns;
}

} // namespace steplap
