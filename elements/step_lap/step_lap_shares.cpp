#include "elements/step_lap/step_lap_shares.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

namespace steplap {

namespace {

// Returns the fraction of a pressure that remains at the present transverse acceleration (SheetPair::transverse).
double left_by_tilt(double transverse, const PressureState& now) { return std::max(0.0, 1.0 + transverse * now.tilt); }

} // namespace

void GripShares::Group::add(const Sheet& sheet) {
  if (sheet.transverse != 0.0) tilting.push_back(sheet);
  else capacity += sheet.capacity;
}

double GripShares::Group::capacity_at(const PressureState& now) const {
  double sum = capacity;
  for (const Sheet& sheet : tilting) sum += sheet.capacity * left_by_tilt(sheet.transverse, now);
  return sum * now.factor;
}

GripShares::GripShares(const StepLapFriction& friction, const std::vector<const StepLapInterface*>& interfaces, double weight)
    : weight_(weight) {
  const OverlapReference& overlaps = friction.overlaps();
  corners_.resize(overlaps.corner_count());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    const SheetPair& pair = friction.sheets()[i];
    Sheet sheet{interfaces[i]->pressure, pair.static_traction * overlaps.area_of(i), pair.transverse,
                interfaces[i]->transverse_spread / interfaces[i]->pressure};
    for (const Vec2& vertex : overlaps.vertices_of(i)) sheet.least = std::min(sheet.least, 1.0 + pair.gradient.dot(vertex - pair.middle));
    sheets_.push_back(sheet);
    corners_[overlaps.corner_of(i)].add(sheet);
    const std::string& part = interfaces[i]->part;
    if (part.empty()) continue;
    const auto known = std::find(names.begin(), names.end(), part);
    const auto at = static_cast<std::size_t>(known - names.begin());
    if (known == names.end()) {
      names.push_back(part);
      parts_.emplace_back().share = interfaces[i]->part_share;
    }
    parts_[at].add(sheet);
  }
  for (Group& corner : corners_) corner.share = 1.0 / static_cast<double>(corners_.size());
}

double GripShares::least_pressure(const PressureState& now) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Sheet& sheet : sheets_)
    least = std::min(least, sheet.pressure * (sheet.least + sheet.transverse * now.tilt - sheet.spread * std::abs(now.tilt)));
  return std::max(0.0, least * now.factor);
}

double GripShares::least_margin(const std::vector<Group>& groups, const PressureState& now, double load) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Group& group : groups) {
    const double capacity = group.capacity_at(now);
    if (!(capacity > 0.0)) return 0.0;
    least = std::min(least, capacity / (group.share * load));
  }
  return least;
}

void add_share_channels(SystemBuilder& builder, const StepLapFriction& friction, const std::vector<const StepLapInterface*>& interfaces,
                        double weight) {
  const auto shares = std::make_shared<const GripShares>(friction, interfaces, weight);
  const auto* self = &friction;
  builder.add_channel("least_pressure", "Pa", "the least clamping pressure that any of its interfaces has anywhere in its overlap",
                      [self, shares](const Snapshot& s) { return shares->least_pressure(self->pressure_at(s.t)); });
  const auto demand = [self](const Snapshot& s) { return self->wrench(s).head<2>().norm(); };
  if (shares->corner_count() > 1)
    builder.add_channel("corner_margin", "",
                        "of the weakest corner alone: capacity over its share of the limb's weight, equal for all corners",
                        [self, shares](const Snapshot& s) { return shares->corner_margin(self->pressure_at(s.t)); });
  if (shares->has_parts())
    builder.add_channel(
        "part_margin", "",
        "of the packet of sheets that holds itself least: capacity over its share of the limb's weight or of the force on the limb, "
        "whichever is larger",
        [self, shares, demand](const Snapshot& s) { return shares->part_margin(self->pressure_at(s.t), demand(s)); });
  builder.add_channel("demand", "N", {"size of the force on the limb", "never negative"}, demand);
}

} // namespace steplap
