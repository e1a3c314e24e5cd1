#include "mbd/run/plausible_run.h"

#include "mbd/base/name_pattern.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/base/stop.h"
#include "mbd/run/body_reach.h"
#include "mbd/run/quantity_text.h"
#include "mbd/run/range_index.h"
#include "mbd/simulation/simulation.h"
#include "mbd/system/places.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_set>

namespace steplap {

namespace {

constexpr double k_moved_share = 0.01; // displacement in body sizes; settling on springs is smaller
constexpr double k_turned = 0.05;      // rotation, rad; three degrees are visible in a drawing
constexpr double k_far_limit = 1e3;    // ratio between metres and millimetres
constexpr double k_outside = 0.01;     // tolerance relative to the width of the outer part, for a body on an edge

bool is_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && last == end;
}

double signed_distance(const Vec2& p, const Vec2& from, const Vec2& to) { // signed distance of p from the line, positive on its left side
  const Vec2 along = to - from;
  return (along.x() * (p - from).y() - along.y() * (p - from).x()) / along.norm();
}

// Computes the convex hull by A. M. Andrew's monotone chains, counter-clockwise.
std::vector<Vec2> hull_of(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  std::vector<Vec2> hull;
  const auto add_chain = [&hull](auto begin, auto end) {
    const std::size_t first = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= first + 2) {
        const Vec2 a = hull[hull.size() - 1] - hull[hull.size() - 2], b = *p - hull[hull.size() - 2];
        if (a.x() * b.y() - a.y() * b.x() > 0.0) break;
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back(); // first point of the other chain
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

// Returns the distance of p from the nearest edge of the hull, m; negative outside.
double depth_in(const std::vector<Vec2>& hull, const Vec2& p) {
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) depth = std::min(depth, signed_distance(p, hull[i], hull[(i + 1) % hull.size()]));
  return depth;
}

// A body with an outline, in its own axes about its centre of gravity.
struct Part {
  const Body* body = nullptr;
  std::vector<Vec2> corners, hull;
  double width = 0.0; ///< diagonal of the bounding box, m
  bool is_guided = false;
};

Vec2 seen_from(const Vec3& on, const Vec3& at, const Vec2& point) {
  const Vec2 place = Vec2(at.x(), at.y()) + rotated(point, at.z());
  return rotated(place - Vec2(on.x(), on.y()), -on.z());
}

// Returns all bodies with an outline. A body with joints or drives is marked as guided, because its motion is intended.
std::vector<Part> parts_of_run(const LoadedModel& loaded) {
  const System& system = *loaded.system;
  std::unordered_set<int> guided;
  for (const RowSpec& row : system.rows) guided.insert({row.a, row.b});
  std::vector<Part> parts;
  for (const Body& body : loaded.model.bodies) {
    if (body.outline.size() < 3) continue;
    Part part;
    part.body = &body;
    for (const Vec2& corner : body.outline) part.corners.push_back(corner - body.cg);
    part.hull = hull_of(part.corners);
    Vec2 low = part.corners.front(), high = low;
    for (const Vec2& corner : part.corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    part.width = (high - low).norm();
    part.is_guided = body.fixed || guided.count(index_of(system, &body)) > 0;
    if (part.hull.size() >= 3) parts.push_back(std::move(part));
  }
  return parts;
}

// Returns how far a corner of `inner` that began inside `outer` is beyond its edge at the end, m.
double way_out(const Part& inner, const Part& outer, const LoadedModel& loaded, const State& end) {
  const System& system = *loaded.system;
  const Vec3 on = pose_of(system, loaded.assembled, outer.body), at = pose_of(system, loaded.assembled, inner.body);
  const Vec3 on_then = pose_of(system, end, outer.body), at_then = pose_of(system, end, inner.body);
  double most = 0.0;
  for (const Vec2& corner : inner.corners)
    if (depth_in(outer.hull, seen_from(on, at, corner)) > k_outside * outer.width)
      most = std::max(most, -depth_in(outer.hull, seen_from(on_then, at_then, corner)));
  return most;
}

} // namespace

std::vector<Finding> distant_rest_findings(const LoadedModel& loaded, const RunResult& result) {
  const Model& model = loaded.model;
  if (model.simulation.initial != "equilibrium" || result.ranges.empty()) return {};
  const System& system = *loaded.system;
  const std::vector<double> reaches = body_reaches(model);
  const RangeIndex ranges(result.ranges);
  const std::vector<char> is_led = led_bodies(system);
  const auto index_of = [&system](const Body& body) {
    const auto found =
        std::find_if(system.bodies.begin(), system.bodies.end(), [&](const BodyData& data) { return data.name == body.name; });
    return static_cast<std::size_t>(found - system.bodies.begin()); // every movable body of the model is in the system
  };
  std::vector<Finding> findings;
  const Body* worst = nullptr;
  double most = 1.0, way = 0.0, turn = 0.0; // most: largest ratio of a body's motion to the permitted one; way, turn: motion of this body
  std::size_t count = 0;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    if (body.fixed || !(body.mass > 0.0)) continue;
    const ChannelRange *const x = ranges.find(body.name + ".x"), *const y = ranges.find(body.name + ".y"),
                              *const theta = ranges.find(body.name + ".theta");
    if (!x || !y || !theta) continue;
    const Vec3 given = pose_of(system, loaded.assembled, &body);
    const double size = 2.0 * std::max(reaches[i], std::sqrt(body.inertia / body.mass));
    const double moved = portable::hypot(x->first - given.x(), y->first - given.y()), turned = theta->first - given.z();
    const double share = std::max(moved / (k_moved_share * size), std::abs(turned) / k_turned);
    if (!(share > 1.0)) continue;
    if (std::abs(turned) >= k_overturned && !is_led[index_of(body)])
      findings.push_back({"start_overturned", FindingLevel::warning,
                          "'" + body.name + "' turns by " + rounded_text(turned * 180.0 / std::numbers::pi, 3) +
                              "° in the search for the rest in which the run begins: it does not stand as given",
                          body.where});
    ++count;
    if (!(share > most)) continue;
    most = share;
    worst = &body;
    way = moved;
    turn = turned;
  }
  if (!worst) return {};
  findings.push_back({"rest_far_from_poses", FindingLevel::note,
                      "the run begins at rest, which is far from the poses given for " + counted(count, "body", "bodies") +
                          ", most of all for '" + worst->name + "': it moves by " + quantity_text(way, "m", 1e-3) + " and turns by " +
                          quantity_text(turn, "rad", 1e-3) +
                          " to get there. Check its pose, and stiffnesses and preloads of what carries it",
                      worst->where});
  return findings;
}

namespace {

// Returns true if a criterion forbids the beginning of a slip of this element.
bool forbids_slips(const Model& model, const std::string& element) {
  return std::any_of(model.criteria.begin(), model.criteria.end(), [&](const Criterion& criterion) {
    if (criterion.event.empty() || !matches_pattern(element, criterion.element.empty() ? "*" : criterion.element)) return false;
    const EventKinds kinds = event_kinds_matching(criterion.event);
    const auto forbids = [&kinds](EventKind kind) { return kinds.test(static_cast<std::size_t>(kind)); };
    return forbids(EventKind::slips) || forbids(EventKind::slips_forward) || forbids(EventKind::slips_backward);
  });
}

} // namespace

std::vector<Finding> start_slides(const LoadedModel& loaded) {
  const auto may_slip = [](const FrictionUnit& unit) { return !unit.friction->never_slips(); };
  const std::vector<FrictionUnit>& frictions = loaded.system->frictions;
  if (loaded.model.simulation.initial != "equilibrium" || std::none_of(frictions.begin(), frictions.end(), may_slip)) return {};
  try {
    return start_slides(loaded, equilibrium_of(loaded));
  } catch (const RunStopped&) {
    throw;
  } catch (const NumericalFailure&) { // the run reports it
    return {};
  }
}

std::vector<Finding> start_slides(const LoadedModel& loaded, const Equilibrium& rest) {
  const Model& model = loaded.model;
  const System& system = *loaded.system;
  std::vector<Finding> findings;
  const auto add = [&](int f, const char* how) {
    const std::string& name = system.element_names[system.frictions[f].element];
    const bool is_forbidden = forbids_slips(model, name);
    const auto entry =
        std::find_if(model.elements.begin(), model.elements.end(), [&name](const ElementEntry& one) { return one.element->name == name; });
    findings.push_back({"start_slid", is_forbidden ? FindingLevel::warning : FindingLevel::note,
                        "'" + name + "' " + how + " before the run begins" +
                            (is_forbidden ? ", where no event reports what a criterion forbids" : "") +
                            ": place the bodies, and preloads, where friction holds",
                        entry == model.elements.end() ? Location{} : entry->element->where});
  };
  for (const int f : rest.slid) add(f, "could not hold where the search for rest loaded it: it slides");
  if (rest.is_settled && rest.slid.empty()) // its slides are not followed
    for (const FrictionMargin& margin : rest.margins)
      add(margin.friction, "holds where the machine comes to rest when it is released with strong damping: it may slide");
  return findings;
}

std::vector<Finding> distant_limit_findings(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement) {
  const std::vector<Criterion>& criteria = loaded.model.criteria;
  const std::size_t of_elements = judgement.criteria.size() - std::min(judgement.criteria.size(), criteria.size());
  const auto size_of = [](const ChannelRange& range) {
    double size = 0.0;
    for (const double value : {range.low.value, range.high.value})
      if (std::isfinite(value)) size = std::max(size, std::abs(value));
    return size;
  };
  std::vector<Finding> findings;
  for (std::size_t i = 0; i < criteria.size(); ++i) {
    const Criterion& criterion = criteria[i];
    const CriterionResult& judged = judgement.criteria[of_elements + i];
    if (judged.outcome != Verdict::hold || !judged.value || !judged.limit) continue;
    double own = 0.0, any = 0.0;
    for (const ChannelRange& range : result.ranges) {
      if (matches_pattern(range.channel->name, criterion.channel)) own = std::max(own, size_of(range));
      if (range.channel->unit == judged.unit) any = std::max(any, size_of(range));
    }
    // Only limits given without a unit are considered; a limit such as "20 mm" is intended.
    double limit = 0.0;
    if (criterion.within && is_number(criterion.within_text)) limit = *criterion.within;
    if (criterion.at_most && is_number(criterion.at_most_text)) limit = std::max(limit, *criterion.at_most);
    if (criterion.at_least && is_number(criterion.at_least_text)) limit = std::max(limit, -*criterion.at_least);
    if (!(limit > k_far_limit * own) || !(limit > any) || !(any > 0.0)) continue; // without loads there is no value for comparison
    findings.push_back({"limit_far_beyond", FindingLevel::note,
                        "the limit of '" + criterion.name + "', " + quantity_text(limit, judged.unit) +
                            ", is more than a thousand times what '" + judged.channel + "' reached, " + quantity_text(own, judged.unit) +
                            ", and beyond every value of this unit in the run. The file gives it no unit: is " + judged.unit +
                            " the one that was meant?",
                        criterion.where});
  }
  return findings;
}

std::vector<Finding> parts_outside(const LoadedModel& loaded, const RunResult& result) {
  const std::vector<Part> parts = parts_of_run(loaded);
  std::vector<Finding> findings;
  for (const Part& inner : parts) {
    if (inner.is_guided) continue;
    const Part* through = nullptr;
    double most = 0.0;
    for (const Part& outer : parts) {
      if (&outer == &inner || !(inner.width < outer.width)) continue;
      const double way = way_out(inner, outer, loaded, result.final_state);
      if (!(way > k_outside * outer.width) || way <= most) continue;
      most = way;
      through = &outer;
    }
    if (!through) continue;
    findings.push_back(
        {"part_outside", FindingLevel::warning,
         "'" + inner.body->name + "' began inside '" + through->body->name + "' and ends " + quantity_text(most, "m", 1e-3) +
             " beyond its edge. The model has nothing there that stops it: what comes after it has passed the edge is outside "
             "the range of the model",
         inner.body->where});
  }
  return findings;
}

} // namespace steplap
