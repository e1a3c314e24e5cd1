#include "transformer/core/core_geometry.h"

#include "elements/step_lap/patch/exact_polygon.h"
#include "elements/step_lap/step_lap_interface.h"
#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "transformer/core/lap_overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

namespace steplap {

namespace {

constexpr double k_usual_notch = 45.0 * std::numbers::pi / 180.0;
// Default dimensions of strips, m; they have an effect only after large slides.
constexpr double k_strip_tongue = 0.05, k_strip_margin = 0.02;
constexpr long k_hole_sides = 24;

// Position of a circle relative to a convex ring.
enum class Place { inside, outside, across };
Place place_of(const Vec2& centre, double radius, const Ring& ring) {
  double nearest = 1e300;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 edge = ring[(i + 1) % ring.size()] - ring[i];
    if (edge.norm() > 0.0) nearest = std::min(nearest, cross(edge, centre - ring[i]) / edge.norm());
  }
  return nearest > radius ? Place::inside : nearest < -radius ? Place::outside : Place::across;
}

// Integrals ∫ dA, ∫ r dA, ∫ r² dA over a ring, about the origin.
struct Moments {
  double area = 0.0, second = 0.0;
  Vec2 first = Vec2::Zero();

  void add(const Ring& ring, double weight) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double twice = weight * cross(a, b);
      area += twice / 2.0;
      first += twice / 6.0 * (a + b);
      second += twice / 12.0 * (a.squaredNorm() + a.dot(b) + b.squaredNorm());
    }
  }
  void add(const Polygon& polygon, double weight) {
    add(polygon.outer, weight);
    for (const Ring& hole : polygon.holes) add(hole, weight);
  }
};

} // namespace

struct CoreGeometry::End {
  bool is_middle = false;
  double side = 1.0, level = 1.0, reach = 0.0; ///< signs of the end; for a middle limb `side` is the side of its axis
};

Stack stack_of(const Core& core) {
  Stack stack;
  for (std::size_t i = 0; i < core.packets.size(); ++i)
    stack.packets.push_back({core.packets[i].x(), i < core.yoke_heights.size() ? core.yoke_heights[i] : 0.0, core.packets[i].y(),
                             i < core.pressure_shares.size() ? core.pressure_shares[i] : 1.0});
  if (stack.packets.empty())
    stack.packets.push_back({core.limb_width.value_or(0.0), core.yoke_height.value_or(0.0), core.stack_depth.value_or(0.0), 1.0});
  for (const Vec2& duct : core.ducts) stack.ducts.push_back({duct.x(), duct.y()});
  stack.stacking_factor = core.stacking_factor.value_or(1.0);
  stack.sheet_thickness = core.sheet_thickness.value_or(0.0);
  stack.book.kind = core.book == "zig_zag"           ? BookKind::zig_zag
                    : core.book == "zig_zag_doubled" ? BookKind::zig_zag_doubled
                                                     : BookKind::saw_tooth;
  stack.book.sheets_per_layer = core.sheets_per_layer.value_or(1);
  stack.book.steps = core.steps.value_or(2);
  stack.book.pitch = core.step_pitch.value_or(0.0);
  stack.book.clearance = core.clearance.value_or(0.0);
  stack.is_by_place = !core.transverse_acceleration.empty();
  stack.slices = core.transverse_slices.value_or(1);
  return stack;
}

CoreGeometry::CoreGeometry(const Core& core) : core_(core), stack_(stack_of(core)) {
  const auto is_less = [](const Packet& a, const Packet& b) {
    return a.yoke_height != b.yoke_height ? a.yoke_height < b.yoke_height : a.width < b.width;
  };
  const auto most = std::max_element(stack_.packets.begin(), stack_.packets.end(), is_less);
  largest_ = likeness(stack_, static_cast<std::size_t>(most - stack_.packets.begin()));
}

// Yokes stepped on both sides have a common axis; those stepped on one side a common edge on the other.
Mitre CoreGeometry::mitre(std::size_t packet, bool is_middle) const {
  const Packet& own = stack_.packets[packet];
  const double lower = stack_.packets[largest_].yoke_height - own.yoke_height;
  const double less = core_.yoke_steps == "both" ? lower : core_.yoke_steps == "outside" ? 2.0 * lower : 0.0;
  Mitre mitre{own.width, core_.core_height - less, own.yoke_height, core_.mitre_angle};
  if (is_middle) mitre.angle = core_.notch_angle.value_or(k_usual_notch);
  return mitre;
}

double CoreGeometry::angle(std::size_t packet, bool is_middle) const {
  const Mitre m = mitre(packet, is_middle);
  return m.angle ? *m.angle : portable::atan2(m.yoke_height, m.limb_width);
}

// A sheet shifted by s' along its length shifts its cut by s' cos α (limb) or s' sin α (yoke) across the mitre.
double CoreGeometry::pitch(std::size_t packet, bool is_middle) const {
  const double pitch = stack_.book.pitch;
  if (core_.pitch_direction == "along_limb") return pitch * portable::cos(angle(packet, is_middle));
  if (core_.pitch_direction == "along_yoke") return pitch * portable::sin(angle(packet, is_middle));
  return pitch;
}

bool CoreGeometry::overlaps_within(std::size_t packet, bool is_middle) const {
  std::set<long> gaps;
  for (const Duct& duct : stack_.ducts) gaps.insert(sheets_before(stack_, duct));
  long before = 0;
  for (std::size_t p = 0; p < packet; ++p) before += sheets_in(stack_, stack_.packets[p]);
  Book book = stack_.book;
  book.pitch = pitch(packet, is_middle);
  for (long i = 0; i + 1 < layers_in(stack_, stack_.packets[packet]); ++i) {
    if (gaps.count(before + (i + 1) * book.sheets_per_layer) > 0) continue;
    const double apart = line_at(book, position_of(book, i + 1)) - line_at(book, position_of(book, i));
    if (std::abs(apart) > book.clearance) return true;
  }
  return false;
}

double CoreGeometry::line(const LayerShape& shape, bool is_middle) const {
  Book book = stack_.book;
  book.pitch = pitch(shape.packet, is_middle);
  return line_at(book, shape.position);
}

CornerFrame CoreGeometry::frame(std::size_t packet, const End& end) const {
  const Mitre m = mitre(packet, end.is_middle);
  return end.is_middle ? notch_frame(m, -end.side, end.level) : corner_frame(m, end.side, end.level);
}

// Cuts the bolt holes out of the outline of a sheet. `levels`: ends at which the sheet has holes, +1 top, −1 bottom.
Polygon CoreGeometry::punched(const std::vector<Vec2>& ring, double side, std::initializer_list<double> levels) const {
  Polygon sheet{ring, {}};
  if (core_.bolt_holes.empty() || ring.size() < 3) return sheet;
  const double diameter = core_.bolt_hole_diameter.value_or(0.0);
  const Mitre m = mitre(largest_, false);
  std::vector<Ring> inside;
  for (const double level : levels)
    for (const Vec2& hole : core_.bolt_holes) {
      const Vec2 centre(side * hole.x(), level * (0.5 * (m.core_height - m.yoke_height) + hole.y()));
      Ring round = round_hole(centre, diameter, k_hole_sides);
      double radius = 0.0;
      for (const Vec2& p : round) radius = std::max(radius, (p - centre).norm());
      const Place place = place_of(centre, radius, ring);
      if (place == Place::inside) inside.push_back({round.rbegin(), round.rend()});
      if (place != Place::across) continue;
      const Region left = exact_difference(sheet, round);
      if (left.size() != 1)
        throw PolygonError("the bolt hole at (" + number_text(hole.x()) + " m, " + number_text(hole.y()) + " m), 'bolt_hole_diameter' " +
                           number_text(diameter) + " m, cuts a sheet in two");
      sheet = left.front();
    }
  for (Ring& hole : inside) sheet.holes.push_back(std::move(hole));
  return sheet;
}

Polygon CoreGeometry::limb_sheet(std::size_t packet, const End& end, double q) const {
  const Mitre m = mitre(packet, end.is_middle);
  if (core_.has_strips()) {
    const CornerFrame f = frame(packet, end);
    return {band(f, 0.0, f.length, q, core_.tongue.value_or(k_strip_tongue)), {}};
  }
  if (end.is_middle) return punched(pointed_end(m, end.level, q), 1.0, {end.level});
  return punched(limb_end(m, end.side, end.level, q), end.side, {end.level});
}

Polygon CoreGeometry::yoke_sheet(std::size_t packet, const End& end, double q) const {
  const Mitre m = mitre(packet, end.is_middle);
  if (core_.has_strips()) {
    const CornerFrame f = frame(packet, end);
    const double margin = core_.margin.value_or(k_strip_margin), tongue = core_.tongue.value_or(k_strip_tongue);
    return {band(f, -margin, f.length + margin, -tongue, q), {}};
  }
  const double reach = std::max(end.reach, m.limb_width);
  if (end.is_middle) return punched(yoke_half(m, end.side, end.level, q, m.limb_width), 1.0, {end.level});
  return punched(yoke_end(m, end.side, end.level, q, reach), end.side, {end.level});
}

Lap CoreGeometry::lap(std::size_t limb_packet, double inner, std::size_t yoke_packet, double outer, const End& end) const {
  Lap lap;
  lap.inner = inner;
  lap.outer = outer;
  lap.limb = limb_sheet(limb_packet, end, inner);
  lap.yoke = yoke_sheet(yoke_packet, end, outer);
  find_overlap(lap);
  return lap;
}

void CoreGeometry::add_counted(const End& end, std::vector<Lap>& laps) const {
  const double half = 0.5 * core_.overlap.value_or(0.0);
  Lap only = lap(0, -half, 0, half, end);
  only.count = core_.interfaces.value_or(0.0);
  laps.push_back(std::move(only));
}

// Returns the name of a packet, such as "packet 2", or in a stack by place that of a zone, such as "packet 2, slice 3"; "" for the only
// packet of a stack that is not by place.
std::string CoreGeometry::zone_name(std::size_t packet, std::size_t zone) const {
  if (!stack_.is_by_place) return stack_.packets.size() == 1 ? "" : "packet " + std::to_string(packet + 1);
  const auto slices = static_cast<std::size_t>(stack_.slices);
  std::string name = "packet " + std::to_string(zone / slices + 1);
  if (slices > 1) name += ", slice " + std::to_string(zone % slices + 1);
  return name;
}

// Adds the overlaps of two neighbouring layers: the yoke sheet of each may overlap the limb sheet of the other.
void CoreGeometry::add_built(const End& end, std::vector<Lap>& laps) const {
  const double half_gap = 0.5 * stack_.book.clearance;
  std::map<std::array<std::size_t, 3>, long> number; // number of laps so far, for each zone and pair of packets
  const auto add = [&](const LayerShape& yoke, const LayerShape& limb, const LayerPair& pair) {
    const double inner = line(limb, end.is_middle) + half_gap, outer = line(yoke, end.is_middle) - half_gap;
    const bool is_one_packet = yoke.packet == limb.packet;
    if (is_one_packet && outer <= inner) return;
    Lap found = lap(limb.packet, inner, yoke.packet, outer, end);
    if (!(found.area > 0.0)) return;
    const auto [first, second] = std::minmax(yoke.packet, limb.packet);
    const std::string k = std::to_string(++number[{pair.zone, first, second}]);
    const std::string own = zone_name(first, pair.zone);
    const std::size_t front = pair.zone / static_cast<std::size_t>(stack_.slices);
    const std::string one = std::to_string((stack_.is_by_place ? front : first) + 1),
                      two = std::to_string((stack_.is_by_place ? front + 1 : second) + 1);
    found.name = !is_one_packet ? "packets " + one + " and " + two + ", " + k : own.empty() ? k : own + ", " + k;
    found.packet = limb.packet;
    found.is_between = !is_one_packet;
    found.zone = pair.zone;
    found.before = pair.before;
    found.first = pair.first;
    found.last = pair.last;
    found.count = static_cast<double>(pair.count);
    found.pressure = 0.5 * (stack_.packets[yoke.packet].pressure + stack_.packets[limb.packet].pressure);
    laps.push_back(std::move(found));
  };
  for (const LayerPair& pair : layer_pairs(stack_)) {
    add(pair.a, pair.b, pair);
    if (!(pair.a == pair.b)) add(pair.b, pair.a, pair);
  }
  if (core_.bands == "each") return;
  std::set<std::pair<std::size_t, std::size_t>> kinds; // pairs (packet, zone)
  for (const Lap& lap : laps)
    if (!lap.is_between) kinds.insert({lap.packet, lap.zone});
  for (const auto& [packet, zone] : kinds) merge(end, packet, zone, laps);
}

// Replaces the laps of one packet and zone by one lap with their mean area about the middle of the mitre. The secant method determines its
// width, because the area is nearly proportional to it.
void CoreGeometry::merge(const End& end, std::size_t packet, std::size_t zone, std::vector<Lap>& laps) const {
  const auto is_own = [&](const Lap& lap) { return !lap.is_between && lap.packet == packet && lap.zone == zone; };
  double count = 0.0, area = 0.0, width = 0.0, before = 0.0;
  long first = std::numeric_limits<long>::max(), last = 0;
  for (const Lap& lap : laps) {
    if (!is_own(lap)) continue;
    first = std::min(first, lap.first);
    last = std::max(last, lap.last);
    count += lap.count;
    area += lap.count * lap.area;
    width += lap.count * (lap.outer - lap.inner);
    before += lap.count * lap.area * lap.before; // weighted by area, like the pressures
  }
  if (!(area > 0.0)) return;
  std::erase_if(laps, is_own);
  const auto of_width = [&](double w) { return lap(packet, -0.5 * w, packet, 0.5 * w, end); };
  const double target = area / count;
  double w = width / count, w_before = 0.0, area_before = 0.0;
  Lap mean = of_width(w);
  for (int i = 0; i < 20 && mean.area != target && mean.area != area_before; ++i) {
    const double next = w + (target - mean.area) * (w - w_before) / (mean.area - area_before);
    Lap better = of_width(next);
    if (!(std::abs(better.area - target) < std::abs(mean.area - target))) break; // no further improvement: rounding
    w_before = w;
    area_before = mean.area;
    w = next;
    mean = std::move(better);
  }
  mean.name = zone_name(packet, zone);
  mean.packet = packet;
  mean.zone = zone;
  mean.before = before / area;
  mean.first = first;
  mean.last = last;
  mean.count = count;
  mean.pressure = stack_.packets[packet].pressure;
  laps.push_back(std::move(mean));
}

CoreCorner CoreGeometry::corner(const End& end) const {
  CoreCorner corner;
  corner.is_top = end.level > 0.0;
  corner.place = corner.is_top ? "top" : "bottom";
  if (end.is_middle) corner.place += end.side > 0.0 ? " front" : " rear";
  corner.frame = frame(largest_, end);
  corner.out = Vec2(end.side, end.level);
  if (core_.is_counted()) add_counted(end, corner.laps);
  else add_built(end, corner.laps);
  return corner;
}

std::vector<CoreCorner> CoreGeometry::corners(bool is_middle, double side, double reach) const {
  std::vector<CoreCorner> all;
  for (const double level : {1.0, -1.0}) {
    if (!is_middle) all.push_back(corner({false, side, level, reach}));
    else
      for (const double half : {1.0, -1.0}) all.push_back(corner({true, half, level, reach}));
  }
  return all;
}

// Where two packets meet, each of the two laps holds the packet of its limb sheet.
std::size_t CoreGeometry::packet_of(const Lap& lap) const {
  if (!stack_.is_by_place) return lap.packet;
  const std::size_t front = lap.zone / static_cast<std::size_t>(stack_.slices);
  return lap.is_between && lap.packet != likeness(stack_, front) ? front + 1 : front;
}

LimbSteel CoreGeometry::limb_steel(bool is_middle, double side) const {
  Moments sum;
  const auto add = [&](std::size_t packet, double q, double weight) {
    const Mitre m = mitre(packet, is_middle);
    const auto ring = is_middle ? whole_pointed_limb(m, q) : whole_limb(m, side, q);
    sum.add(punched(ring, is_middle ? 1.0 : side, {1.0, -1.0}), weight);
  };
  if (core_.is_counted()) add(0, 0.0, 1.0);
  else
    for (const LayerCount& layer : layer_counts(stack_))
      add(layer.shape.packet, line(layer.shape, is_middle) + 0.5 * stack_.book.clearance, static_cast<double>(layer.sheets));
  LimbSteel steel;
  steel.centre = sum.first / sum.area;
  if (core_.is_counted()) return steel;
  const double surface = core_.density * stack_.sheet_thickness; // mass per area of a sheet, kg/m²
  steel.mass = surface * sum.area;
  steel.inertia = surface * (sum.second - sum.area * steel.centre.squaredNorm());
  return steel;
}

std::vector<double> CoreGeometry::packet_shares(bool is_middle, double side) const {
  if (core_.is_counted()) return {};
  const std::size_t count = stack_.packets.size();
  std::vector<double> alike(count, 0.0), shares(count, 0.0), sheets(count, 0.0);
  for (const LayerCount& layer : layer_counts(stack_)) {
    const Mitre m = mitre(layer.shape.packet, is_middle);
    const double q = line(layer.shape, is_middle) + 0.5 * stack_.book.clearance;
    Moments one;
    one.add(punched(is_middle ? whole_pointed_limb(m, q) : whole_limb(m, side, q), is_middle ? 1.0 : side, {1.0, -1.0}), 1.0);
    alike[layer.shape.packet] += static_cast<double>(layer.sheets) * one.area;
  }
  const double all = std::accumulate(alike.begin(), alike.end(), 0.0);
  for (std::size_t p = 0; p < count; ++p) sheets[likeness(stack_, p)] += static_cast<double>(sheets_in(stack_, stack_.packets[p]));
  for (std::size_t p = 0; p < count; ++p) {
    const std::size_t like = likeness(stack_, p);
    if (stack_.is_by_place) shares[p] = alike[like] / all * static_cast<double>(sheets_in(stack_, stack_.packets[p])) / sheets[like];
    else if (like == p) shares[p] = alike[p] / all;
  }
  return shares;
}

double CoreGeometry::yoke_strip(const LimbPlace& outer) const {
  double mass = 0.0;
  if (core_.is_counted()) return mass;
  for (const Packet& packet : stack_.packets)
    mass += 2.0 * core_.density * stack_.sheet_thickness * static_cast<double>(sheets_in(stack_, packet)) * packet.yoke_height *
            (outer.side * outer.x + 0.5 * packet.width);
  return mass;
}

double CoreGeometry::yoke_cut(const LimbPlace& limb) const {
  double mass = 0.0;
  if (core_.is_counted()) return mass;
  for (const LayerCount& layer : layer_counts(stack_)) {
    const Mitre m = mitre(layer.shape.packet, limb.is_middle);
    const double half = 0.5 * m.limb_width, top = 0.5 * m.core_height, low = top - m.yoke_height;
    const double q = line(layer.shape, limb.is_middle) - 0.5 * stack_.book.clearance;
    // A cut on the yoke side of the mitre leaves a part of the yoke next to the limb: |q|/sin α towards the window.
    const double beside = m.limb_width;
    const double inner = half + beside, outer = limb.is_middle ? inner : half;
    std::vector<Vec2> crossing = {{-inner, low}, {outer, low}, {outer, top}, {-inner, top}};
    if (!limb.is_middle && limb.side < 0.0) crossing = {{-outer, low}, {inner, low}, {inner, top}, {-outer, top}};
    if (limb.is_middle) crossing = beyond(crossing, notch_frame(m, -1.0, 1.0), q);
    Moments taken;
    taken.add(beyond(crossing, limb.is_middle ? notch_frame(m, 1.0, 1.0) : corner_frame(m, limb.side, 1.0), q), 1.0);
    mass += 2.0 * core_.density * stack_.sheet_thickness * static_cast<double>(layer.sheets) * taken.area;
  }
  return mass;
}

// For an acceleration a from the front face to the back, the contact forces increase with the number of sheets that are pushed from the
// front. If only the front face is supported (and a constant force acts on the back), an interface is additionally loaded by the mass
// behind it; if only the back is supported, it is relieved by the mass in front of it; if both are supported equally, the mean applies.
LapPressure CoreGeometry::pressure(const CoreCorner& corner, const Lap& lap, double share) const {
  const double level = corner.is_top ? core_.pressure : core_.bottom_pressure.value_or(core_.pressure);
  const std::optional<Vec2>& given =
      !corner.is_top && core_.bottom_pressure_gradient ? core_.bottom_pressure_gradient : core_.pressure_gradient;
  const Vec2 gradient = given.value_or(Vec2(0.0, 0.0)).cwiseProduct(corner.out);
  const Vec2 origin = corner.frame.origin + 0.5 * corner.frame.length * corner.frame.along;
  const double factor = share * lap.pressure;
  const auto at = [&](const Vec2& place) { return factor * (level + gradient.dot(place - origin)); };
  LapPressure pressure;
  pressure.gradient = factor * gradient;
  pressure.least = pressure.middle = gradient.isZero(0.0) ? factor * level : at(lap.middle);
  for (const Vec2& place : lap.overlap) pressure.least = std::min(pressure.least, at(place));
  if (!stack_.is_by_place) return pressure;
  const double all = static_cast<double>(sheets_in(stack_));
  const double held = core_.transverse_support == "front" ? all : core_.transverse_support == "back" ? 0.0 : 0.5 * all;
  const double sheet = core_.density * stack_.sheet_thickness;
  pressure.transverse = sheet * (held - lap.before);
  pressure.transverse_spread = sheet * std::max(lap.before - static_cast<double>(lap.first), static_cast<double>(lap.last) - lap.before);
  return pressure;
}

} // namespace steplap
