#include "run/tipping_feet.h"

#include "elements/polygon_contact.h"
#include "elements/round_contacts.h"
#include "elements/unilateral_contact.h"
#include "mbd/rest/statics.h"
#include "run/places.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_near = 1e-3; // relative to the radius of gyration
constexpr double k_flat = 0.02; // rad; largest angle between faces in full contact

struct Line {
  Vec2 from, to;
};

class FootFinder {
public:
  FootFinder(const LoadedModel& loaded, const State& state) : loaded_(loaded), state_(state), statics_(*loaded.system) {
    statics_.evaluate(state_);
  }

  std::vector<Foot> run() {
    for (const ElementEntry& entry : loaded_.model.elements) {
      const Element& element = *entry.element;
      if (const auto* const foot = dynamic_cast<const UnilateralContact*>(&element)) add_foot(*foot);
      else if (const auto* const wheel = dynamic_cast<const SegmentContact*>(&element)) add_wheel(*wheel);
      else if (const auto* const roller = dynamic_cast<const CircleContact*>(&element)) add_roller(*roller);
      else if (const auto* const outlines = dynamic_cast<const PolygonContact*>(&element)) add_outlines(*outlines);
    }
    return std::move(feet_);
  }

private:
  struct MarkerPose {
    int body;
    Vec3 pose;
    double angle; ///< orientation of the marker
    Vec2 point;
  };
  [[nodiscard]] MarkerPose marker_pose(const std::string& name) const {
    const Place place = place_of(loaded_.model, name);
    const Vec3 pose = pose_of(*loaded_.system, state_, place.body);
    return {index_of(*loaded_.system, place.body), pose, pose.z() + place.angle, Vec2(pose.x(), pose.y()) + rotated(place.point, pose.z())};
  }

  [[nodiscard]] bool touches(const std::string& name, int a, int b) const {
    if (is_closed(*loaded_.system, state_, name)) return true;
    const Channel* const gap = loaded_.system->find_channel(name + ".gap");
    if (!gap) return false;
    Snapshot snapshot;
    snapshot.t = state_.t;
    snapshot.motion = statics_.motion().data();
    snapshot.evaluation = &statics_.evaluation();
    snapshot.memory = state_.memory.data();
    double size = 0.0;
    for (const int i : {a, b})
      if (i != k_ground) size = std::max(size, std::sqrt(loaded_.system->bodies[i].inertia / loaded_.system->bodies[i].mass));
    return gap->value(snapshot) <= k_near * size;
  }

  void add_foot(const UnilateralContact& contact) {
    const MarkerPose a = marker_pose(contact.a), b = marker_pose(contact.b);
    if (touches(contact.name, a.body, b.body))
      feet_.push_back({contact.name, contact.name, a.body, b.body, a.point, rotated(contact.normal, b.angle).normalized()});
  }

  void add_wheel(const SegmentContact& contact) {
    const MarkerPose a = marker_pose(contact.a), b = marker_pose(contact.b);
    if (!touches(contact.name, a.body, b.body)) return;
    const Vec2 from = b.point + rotated(contact.from, b.angle), along = b.point + rotated(contact.to, b.angle) - from;
    const double share = std::clamp((a.point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Vec2 normal = (a.point - from - share * along).normalized();
    feet_.push_back({contact.name, contact.name, a.body, b.body, a.point - contact.radius * normal, normal});
  }

  void add_roller(const CircleContact& contact) {
    const MarkerPose a = marker_pose(contact.a), b = marker_pose(contact.b);
    if (!touches(contact.name, a.body, b.body) || a.point == b.point) return;
    const Vec2 outwards = (a.point - b.point).normalized();
    const Vec2 normal = contact.inside ? Vec2(-outwards) : outwards;
    feet_.push_back({contact.name, contact.name, a.body, b.body, a.point - contact.radius_a * normal, normal});
  }

  // Returns the corners of one side, counter-clockwise.
  [[nodiscard]] std::vector<Vec2> corners(const std::string& name, const std::vector<Vec2>& given) const {
    const Place place = place_of(loaded_.model, name);
    const MarkerPose at = marker_pose(name);
    std::vector<Vec2> points;
    if (!given.empty())
      for (const Vec2& p : given) points.push_back(at.point + rotated(p, at.angle));
    else if (place.body)
      for (const Vec2& p : place.body->outline) points.push_back(Vec2(at.pose.x(), at.pose.y()) + rotated(p - place.body->cg, at.pose.z()));
    double area = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec2 &p = points[i], &q = points[(i + 1) % points.size()];
      area += p.x() * q.y() - p.y() * q.x();
    }
    if (area < 0.0) std::reverse(points.begin(), points.end());
    return points;
  }
  static std::vector<Line> faces_of(const std::vector<Vec2>& corners) {
    std::vector<Line> faces;
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (const Vec2& to = corners[(i + 1) % corners.size()]; to != corners[i]) faces.push_back({corners[i], to});
    return faces;
  }
  // Returns the outward normal.
  static Vec2 normal_of(const Line& face) {
    const Vec2 along = (face.to - face.from).normalized();
    return {along.y(), -along.x()};
  }

  void add_outlines(const PolygonContact& contact) {
    const MarkerPose a = marker_pose(contact.a), b = marker_pose(contact.b);
    if (!touches(contact.name, a.body, b.body)) return;
    const std::vector<Vec2> of_a = corners(contact.a, contact.outline_a), of_b = corners(contact.b, contact.outline_b);
    if (of_a.empty()) return;
    const bool is_plane = contact.normal || of_b.empty();
    const double endless = std::numeric_limits<double>::infinity();
    Best best;
    if (is_plane) {
      const Vec2 n = rotated(contact.normal.value_or(Vec2(0.0, 1.0)), b.angle).normalized();
      try_face(n, b.point, of_a, false, -endless, endless, best);
    } else {
      for (const Line& face : faces_of(of_b)) try_line(face, of_a, false, best);
      for (const Line& face : faces_of(of_a)) try_line(face, of_b, true, best);
    }
    const Vec2 along(best.normal.y(), -best.normal.x());
    const Vec2 on_face = best.normal * best.normal.dot(best.origin);
    const auto add = [&](double at, const char* which) {
      feet_.push_back(
          {contact.name, contact.name + which, a.body, b.body, on_face + at * along, best.is_of_a ? Vec2(-best.normal) : best.normal});
    };
    if (best.high - best.low <= 0.0) return add(best.low, "");
    const bool is_forward = along.x() >= 0.0;
    add(best.low, is_forward ? " (left end)" : " (right end)");
    add(best.high, is_forward ? " (right end)" : " (left end)");
  }

  struct Best {
    double gap = -std::numeric_limits<double>::infinity();
    Vec2 normal, origin;
    double low = 0.0, high = 0.0; ///< ends of the touching part, along the face
    bool is_of_a = false;
  };
  static void try_line(const Line& face, const std::vector<Vec2>& other, bool is_of_a, Best& best) {
    const Vec2 n = normal_of(face), along(n.y(), -n.x());
    const double one = along.dot(face.from), two = along.dot(face.to);
    try_face(n, face.from, other, is_of_a, std::min(one, two), std::max(one, two), best);
  }
  // The supporting face is the one that the other body penetrates least.
  static void try_face(const Vec2& n, const Vec2& origin, const std::vector<Vec2>& other, bool is_of_a, double from, double to,
                       Best& best) {
    const Vec2 along(n.y(), -n.x());
    std::size_t lowest = 0;
    for (std::size_t i = 1; i < other.size(); ++i)
      if (n.dot(other[i] - other[lowest]) < 0.0) lowest = i;
    const double gap = n.dot(other[lowest] - origin);
    if (gap <= best.gap) return;
    double low = along.dot(other[lowest]), high = low;
    for (const Vec2& corner : other) {
      const Vec2 reach = corner - other[lowest];
      if (std::abs(n.dot(reach)) > k_flat * std::abs(along.dot(reach))) continue;
      low = std::min(low, along.dot(corner));
      high = std::max(high, along.dot(corner));
    }
    best = {gap, n, origin, std::max(low, from), std::min(high, to), is_of_a};
  }

  const LoadedModel& loaded_;
  State state_;
  Statics statics_;
  std::vector<Foot> feet_;
};

} // namespace

std::vector<Foot> feet_of(const LoadedModel& loaded, const State& state) { return FootFinder(loaded, state).run(); }

} // namespace steplap
