#include "elements/polygon_contact.h"

#include "elements/convex_outline.h"
#include "elements/coulomb_friction.h"
#include "elements/share_channel.h"
#include "elements/support_points.h"
#include "mbd/system/approximate_place.h"
#include "mbd/system/law_group.h"
#include "mbd/system/swallowing_contacts.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace steplap {

namespace {

using D12 = Dual<12>;

struct Outlines {
  ConvexOutline a, b;
  PlacedOutline<double> own_b;         ///< b in the axes of its body
  double reach_a = 0.0, reach_b = 0.0; ///< distance of the farthest corner from the centre of gravity, m
  double through = 0.0;                ///< GapBounds::through, m: penetration at which one part is entirely through the other
  double narrowest = 0.0;              ///< the smaller of the widths (width_of()) of a and b, m
};

template <class S, class B> struct Placed {
  PlacedOutline<S> a, b;
  Pair<S> centre; ///< position of body a relative to body b

  Placed(const Outlines& outlines, const Motion<S>& at_a, const B& at_b) : centre(offset(at_a, at_b)) {
    place_outline(outlines.a, at_a, centre, a);
    place_outline(outlines.b, at_b, Pair<S>{}, b);
  }
};

class PolygonGroup final : public ForceGroup, public GapSource, public SwallowingContacts {
public:
  struct ElementData {
    int a = k_ground, b = k_ground;
    std::shared_ptr<const Outlines> outlines;
    double stiffness = 0.0, dissipation = 0.0;
    bool has_friction = false;
    bool has_same_a = false; ///< bodies and outline a are those of the entry before
    int link = 0, unit = 0, first_event = 0, contact = 0;
  };
  std::vector<ElementData> entries;

  void add_forces(Evaluation& e) const override {
    PlacedOutline<double> a;
    for (const ElementData& entry : entries) {
      const Motion<double>& m = e.link_motion[entry.link];
      const Pair<double> centre = offset(m, Origin{});
      if (!entry.has_same_a) place_outline(entry.outlines->a, m, centre, a);
      const PlacedOutline<double>& b = entry.outlines->own_b;
      const RelativeVelocity<double> velocity = relative(m, centre);
      const UnitMode mode = e.mode[entry.unit];
      const Approach now = approach(a, b, velocity);
      const double sign = mode == k_contact_open ? 1.0 : -1.0;
      e.event_value[entry.first_event] = sign * now.gap;
      e.event_derivative[entry.first_event] = sign * now.rate;
      e.contact_force[entry.contact] = 0.0;
      if (mode == k_contact_open) continue;
      BodyForce& sum = e.link_force[entry.link];
      if (now.gap > 0.0) {
        bring_back(entry, centre, now, sum);
        continue;
      }
      const OverlapForce<double> f = overlap_force(a, b, velocity, entry.stiffness, entry.dissipation);
      if (f.is_swallowed) {
        bring_back(entry, centre, now, sum);
        continue;
      }
      sum.fx += f.force.x;
      sum.fy += f.force.y;
      sum.m += f.moment - cross(centre, f.force);
      e.contact_force[entry.contact] = size_of(f.force);
      e.dissipation += f.dissipation;
    }
  }

  [[nodiscard]] double potential(const Motion<double>* motion) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries) {
      const Placed<double, Motion<double>> placed(*entry.outlines, motion[entry.a], motion[entry.b]);
      if (separation_of(placed.a, placed.b).gap < 0.0)
        sum += 2.0 * entry.stiffness * overlap_force(placed.a, placed.b, RelativeVelocity<double>{}, entry.stiffness, 0.0, true).volume;
    }
    return sum;
  }

  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries) {
      PairJacobian& j = out.emplace_back();
      j.a = entry.a;
      j.b = entry.b;
      j.contact = entry.contact;
      j.stiffness.setZero();
      j.damping.setZero();
      j.normal.setZero();
      if (e.mode[entry.unit] == k_contact_open) continue;
      const Motion<D12> a = seeded(e.motion[entry.a], 0), b = seeded(e.motion[entry.b], 3);
      const Placed<D12, Motion<D12>> placed(*entry.outlines, a, b);
      RelativeVelocity<D12> velocity;
      velocity.u = Pair<D12>{a.vx - b.vx, a.vy - b.vy} - a.omega * perp(placed.centre);
      velocity.spin = a.omega - b.omega;
      const OverlapForce<D12> f = overlap_force(placed.a, placed.b, velocity, entry.stiffness, entry.dissipation);
      const D12 couple_a = f.moment - cross(placed.centre, f.force);
      const D12 rows[6] = {f.force.x, f.force.y, couple_a, -f.force.x, -f.force.y, -f.moment};
      for (int i = 0; i < 6; ++i) {
        j.stiffness.row(i) = rows[i].d.head<6>().matrix().transpose();
        j.damping.row(i) = rows[i].d.tail<6>().matrix().transpose();
      }
      if (size_of(Pair<double>{f.force.x.v, f.force.y.v}) > 0.0) j.normal = size_of(f.force).d.matrix();
    }
  }

  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
  }
  void register_turns(TurnTable& turns) const override {
    for (const ElementData& entry : entries) turns.add_all({entry.a, entry.b});
  }
  // Registers the relative positions that a run has to keep: friction on a face of a needs b's corners in the axes of a.
  void register_links(LinkTable& links) override {
    for (ElementData& entry : entries) {
      entry.link = links.add(entry.a, entry.b);
      if (entry.has_friction && entry.a != k_ground) (void)links.add(entry.b, entry.a);
    }
  }
  // Adds the gap: the distance of the other body from the face that separates them is a lower bound of all point distances. A half-plane
  // has no corners, so its reach extends to its points near the other body.
  [[nodiscard]] const GapSource* gap_source() const override { return this; }
  void add_gaps(const Motion<double>* motion, std::vector<GapBounds>& out) const override {
    for (const ElementData& entry : entries) {
      const Placed<double, Motion<double>> placed(*entry.outlines, motion[entry.a], motion[entry.b]);
      GapBounds& bounds = out.emplace_back();
      bounds.a = entry.a;
      bounds.b = entry.b;
      const Approach now = approach(placed.a, placed.b, RelativeVelocity<double>{});
      bounds.gap = now.gap;
      bounds.normal = now.normal;
      bounds.reach_a = entry.outlines->reach_a;
      bounds.reach_b =
          entry.outlines->b.corners.empty() ? size_of(placed.centre) + bounds.reach_a + std::max(0.0, bounds.gap) : entry.outlines->reach_b;
      bounds.through = entry.outlines->through;
    }
  }
  // Returns the first unit in which one outline lies within the other; −1 if there is none. Such a contact has a depth of at least the
  // smaller width, so shallower contacts are skipped.
  [[nodiscard]] int first_swallowed(const std::vector<UnitMode>& modes, const std::vector<double>& event_value,
                                    const std::function<const Motion<double>*()>& motion) const override {
    for (const ElementData& entry : entries) {
      if (modes[entry.unit] == k_contact_open || event_value[entry.first_event] < entry.outlines->narrowest) continue;
      const Placed<double, Motion<double>> placed(*entry.outlines, motion()[entry.a], motion()[entry.b]);
      if (overlap_force(placed.a, placed.b, RelativeVelocity<double>{}, entry.stiffness, 0.0).is_swallowed) return entry.unit;
    }
    return -1;
  }
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override {
    return measured(element, e).gap < 0.0 ? k_contact_pressed : k_contact_open;
  }
  [[nodiscard]] UnitMode next_mode(int, UnitMode mode, int, const Evaluation&) const override {
    return mode == k_contact_open ? k_contact_pressed : k_contact_open;
  }
  [[nodiscard]] EventKind event_kind(UnitMode, UnitMode to) const override {
    return to == k_contact_open ? EventKind::opens : EventKind::closes;
  }

  struct Approach {
    double gap = 0.0, rate = 0.0;
    Pair<double> corner, normal; ///< corner with the least gap; direction of the force on a
  };
  /// Returns the gap and its rate, the velocity of the corner normal to the face.
  [[nodiscard]] Approach measured(int element, const Evaluation& e) const {
    const ElementData& entry = entries[element];
    const Motion<double>&a = e.motion[entry.a], &b = e.motion[entry.b];
    const Placed<double, Motion<double>> placed(*entry.outlines, a, b);
    RelativeVelocity<double> velocity;
    velocity.u = Pair<double>{a.vx - b.vx, a.vy - b.vy} - a.omega * perp(placed.centre);
    velocity.spin = a.omega - b.omega;
    return approach(placed.a, placed.b, velocity);
  }

private:
  // Adds a restoring force in mode pressed where the contact law has none. Beyond zero gap it has the opposite sign, continuing the force
  // of a single corner. If one outline lies completely within the other, it acts outwards along the shortest way, with the force of a
  // corner of that depth. Needed because stages of a step that is too long may leave the contact, pass a thin part, or end below the
  // ground: without any force there, the error estimate would be zero and the step would be accepted. No accepted step ends in such a state
  // (first_swallowed()).
  static void bring_back(const ElementData& entry, const Pair<double>& centre, const Approach& now, BodyForce& sum) {
    const Pair<double> f = (-entry.stiffness * now.gap * std::abs(now.gap)) * now.normal;
    sum.fx += f.x;
    sum.fy += f.y;
    sum.m += cross(now.corner - centre, f);
  }
  static double size_of(const Pair<double>& f) { return std::sqrt(dot(f, f)); }
  static D12 size_of(const Pair<D12>& f) { return sqrt(dot(f, f)); }
  static RelativeVelocity<double> relative(const Motion<double>& m, const Pair<double>& centre) {
    return {Pair<double>{m.vx, m.vy} - m.omega * perp(centre), m.omega};
  }
  // The rate of the gap is the velocity of the corner relative to the material point of the other body at the same position, irrespective
  // of which body has the face.
  static Approach approach(const PlacedOutline<double>& a, const PlacedOutline<double>& b, const RelativeVelocity<double>& velocity) {
    const Separation s = separation_of(a, b);
    const int faces = a.edge_count;
    const bool is_of_b = s.face >= faces;
    const Pair<double> corner = is_of_b ? a.corner[s.corner] : b.corner[s.corner];
    const Pair<double> n = is_of_b ? b.normal[s.face - faces] : -1.0 * a.normal[s.face];
    return {s.gap, dot(n, velocity.u + velocity.spin * perp(corner)), corner, n};
  }
};

// Contact point of friction on a face: a corner of the other body, or the edge that begins there.
struct HoldingPlace {
  int face = 0, corner = 0;
  bool is_edge = false;
};

class PolygonFriction final : public CoulombFriction, public ApproximatePlace {
public:
  std::shared_ptr<const Outlines> outlines;
  int a = k_ground, b = k_ground;
  std::vector<HoldingPlace> places; ///< contact points, in the order of `feet`
  std::vector<int> first;           ///< index of the first contact point of each face

  static constexpr double k_dead_band = 1e-13; // dead band for changes of the contact point, m, as for feet
  static constexpr double k_same_face = 0.1;   // largest angle, rad, between two faces that lie on each other
  // Largest velocity error of an approximate contact point, m/s. Friction of a tenth of the weight removes such a velocity within a
  // microsecond.
  static constexpr double k_most_error = 1e-6;

  void make_places(int base) {
    const int of_a = outlines->a.edge_count(), of_b = outlines->b.edge_count();
    for (int face = 0; face < of_a + of_b; ++face) {
      first.push_back(static_cast<int>(places.size()));
      const ConvexOutline& other = face < of_a ? outlines->b : outlines->a;
      for (int corner = 0; corner < other.corner_count(); ++corner)
        for (const bool is_edge : {false, true}) {
          places.push_back({face, corner, is_edge});
          feet.push_back(row_of(places.back(), base));
        }
    }
    lever = std::max(outlines->reach_a, outlines->reach_b);
  }

  void mark_bodies(std::vector<char>& is_used) const override { is_used[a] = is_used[b] = 1; }

  [[nodiscard]] bool record_friction(TracedEvaluation&, const FrictionState&, const TapeNumber*, TapeNumber*, TapeNumber*) const override {
    return false; // not traceable: the choice of the contact point depends on comparisons
  }
  [[nodiscard]] double contact_point_event(const Evaluation& e, const FrictionState& state) const override {
    const Placed<double, Motion<double>> placed(*outlines, e.motion[a], e.motion[b]);
    const HoldingPlace& place = places[state.foot];
    const Heights h = heights(placed, place.face);
    const double best = separation_of(placed.a, placed.b).gap, own = h.least();
    // Negative if the present face has twice the penetration of the best one; both terms are negative while pressed.
    const double face_left = own - 2.0 * best;
    return k_dead_band + std::min(face_left, left_of(h, place));
  }
  void switch_contact_point(const Evaluation& e, FrictionState& state) const override {
    const Placed<double, Motion<double>> placed(*outlines, e.motion[a], e.motion[b]);
    const Separation s = separation_of(placed.a, placed.b);
    const Heights h = heights(placed, s.face);
    const int before = h.before(s.corner), after = h.after(s.corner);
    int corner = s.corner;
    bool is_edge = false;
    if (std::min(h.of[before], h.of[after]) < 0.0) {
      is_edge = true;
      if (h.of[before] < h.of[after]) corner = before;
    }
    state.foot = static_cast<std::uint32_t>(first[s.face] + 2 * corner + (is_edge ? 1 : 0));
  }
  // Returns the velocity error of the approximate contact points `from` and `to`. Let w(x) be the velocity of a relative to b. Along a face
  // the two points are within twice the depth, so the component of w along the face differs by up to 2 depth·ω on each side. If the face
  // belongs to the other body, it is turned by an angle φ, and φ times the component of w across the face is added. A fast rotation at
  // large depth is a real motion: stopping it at once would be an impact, which friction cannot exert. So the error is limited to
  // k_most_error, and above it the element slides.
  [[nodiscard]] double rate_error(const Evaluation& e, const FrictionState& from, const FrictionState& to) const override {
    const Motion<double>&ma = e.motion[a], &mb = e.motion[b];
    const Placed<double, Motion<double>> placed(*outlines, ma, mb);
    const auto normal_of = [&](const FrictionState& state) {
      const int face = places[state.foot].face, of_a = placed.a.edge_count;
      return face < of_a ? placed.a.normal[face] : placed.b.normal[face - of_a];
    };
    const double turned = std::abs(cross(normal_of(from), normal_of(to)));
    const double depth = std::max(0.0, -separation_of(placed.a, placed.b).gap), spin = std::abs(ma.omega - mb.omega);
    double error = 4.0 * depth * spin;
    if (turned > k_same_face) return std::min(error, k_most_error);
    const RowSpec& row = feet[to.foot];
    const Pair<double> lever_a =
        row.a == a ? to_ground(ma, row.point_a) : Pair<double>{mb.x - ma.x, mb.y - ma.y} + to_ground(mb, row.point_a);
    const Pair<double> lever_b = lever_a + Pair<double>{ma.x - mb.x, ma.y - mb.y};
    const Pair<double> w = Pair<double>{ma.vx - mb.vx, ma.vy - mb.vy} + ma.omega * perp(lever_a) - mb.omega * perp(lever_b);
    return std::min(error + turned * (std::abs(w.x) + std::abs(w.y)), k_most_error);
  }

private:
  // Heights of the other body's corners above the line of a face, m.
  struct Heights {
    int count = 0;
    std::array<double, k_most_corners> of;
    [[nodiscard]] int before(int i) const { return i > 0 ? i - 1 : count - 1; }
    [[nodiscard]] int after(int i) const { return i + 1 < count ? i + 1 : 0; }
    [[nodiscard]] double least() const { return *std::min_element(of.begin(), of.begin() + count); }
  };
  template <class B> Heights heights(const Placed<double, B>& placed, int face) const {
    const int of_a = placed.a.edge_count;
    const PlacedOutline<double>&own = face < of_a ? placed.a : placed.b, &other = face < of_a ? placed.b : placed.a;
    const int edge = face < of_a ? face : face - of_a;
    Heights h;
    h.count = other.corner_count;
    for (int i = 0; i < h.count; ++i) h.of[i] = dot(own.normal[edge], other.corner[i]) - own.offset[edge];
    return h;
  }
  // Returns the margin of a contact point, positive while it is valid: for a corner, its neighbours are outside and higher; for an edge,
  // both its corners are inside and lower than the next ones.
  static double left_of(const Heights& h, const HoldingPlace& place) {
    const int i = place.corner, next = h.after(i);
    if (!place.is_edge) {
      const double least = std::min(h.of[h.before(i)], h.of[next]);
      return std::min(least, least - h.of[i]);
    }
    const double highest = std::max(h.of[i], h.of[next]);
    return std::min(-highest, std::min(h.of[h.before(i)], h.of[h.after(next)]) - highest);
  }
  [[nodiscard]] RowSpec row_of(const HoldingPlace& place, int base) const {
    const int of_a = outlines->a.edge_count();
    const bool is_of_a = place.face < of_a;
    const ConvexOutline &own = is_of_a ? outlines->a : outlines->b, &other = is_of_a ? outlines->b : outlines->a;
    const int edge = is_of_a ? place.face : place.face - of_a, next = (place.corner + 1) % other.corner_count();
    RowSpec row;
    row.kind = MeasureKind::slide;
    row.a = is_of_a ? b : a;
    row.b = is_of_a ? a : b;
    row.point_a = place.is_edge ? Vec2(0.5 * (other.corners[place.corner] + other.corners[next])) : other.corners[place.corner];
    row.direction = own.normals[edge];
    row.point_b = own.offsets[edge] * row.direction;
    row.base = base;
    row.quantity = "slide";
    return row;
  }
};

// Returns the frame of the body's own coordinates, in which its outline is given; the marker with the body's name is at the centre of
// gravity instead.
CompiledMarker frame_of_body(const std::string& body, const SystemBuilder& builder) {
  CompiledMarker frame = builder.marker(body);
  const std::vector<Body>& bodies = builder.model().bodies;
  const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.name == body; });
  if (found != bodies.end()) frame.point -= rotated(found->cg, frame.angle);
  return frame;
}

// Returns the outline with the given corners or, if there are none, with those of the marker's body; nothing after an error.
std::optional<ConvexOutline> outline_of(const std::vector<Vec2>& given, const std::string& marker, const char* field,
                                        SystemBuilder& builder) {
  const std::string body = body_of(marker, builder);
  const std::vector<Vec2>& points = given.empty() ? outline_of_body(body, builder) : given;
  try {
    if (points.empty()) {
      builder.error("'" + body + "' has no outline: give it one, or '" + field + "'");
      return std::nullopt;
    }
    return convex_outline(points, given.empty() ? frame_of_body(body, builder) : builder.marker(marker));
  } catch (const OutlineError& error) {
    builder.error((given.empty() ? "the outline of '" + body + "' " : "'" + std::string(field) + "' ") + error.what());
    return std::nullopt;
  }
}

bool is_half_plane(const PolygonContact& e, const SystemBuilder& builder) {
  return e.normal.has_value() ||
         (e.outline_b.empty() && builder.marker(e.b).body == k_ground && outline_of_body(body_of(e.b, builder), builder).empty());
}

bool check(const PolygonContact& e, SystemBuilder& builder) {
  bool is_bad = false;
  const auto fail = [&](const std::string& message) {
    builder.error(message);
    is_bad = true;
  };
  if (builder.marker(e.a).body == builder.marker(e.b).body) fail("touches its own body: name markers on two different bodies");
  if (e.normal && !e.outline_b.empty()) fail("give one of 'normal' (b is a half-plane) and 'outline_b'");
  if (e.normal && !(e.normal->norm() > 0.0)) fail("'normal' has no direction");
  if (const std::string problem = friction_problem(e.static_friction, e.kinetic_friction); !problem.empty()) fail(problem);
  return !is_bad;
}

void add_friction(const PolygonContact& e, const PolygonGroup::ElementData& entry, SystemBuilder& builder) {
  auto friction = std::make_unique<PolygonFriction>();
  friction->outlines = entry.outlines;
  friction->a = entry.a;
  friction->b = entry.b;
  friction->contacts.push_back({entry.contact, entry.unit});
  friction->make_places(builder.add_base());
  for (RowSpec& row : friction->feet) row.element = builder.element_index();
  friction->mu_static = *e.static_friction;
  friction->mu_kinetic = e.kinetic_friction.value_or(*e.static_friction);
  const int f = builder.next_friction(), row = builder.next_friction_row();
  const PolygonFriction* const self = friction.get();
  builder.add_channel("friction", "N",
                      {"friction force on a", "along the touching face, its normal towards a turned clockwise by a right angle"},
                      [row](const Snapshot& s) { return s.friction_force[row]; });
  builder.add_channel("capacity", "N", {"largest friction force that holds", "never negative"},
                      [self](const Snapshot& s) { return self->mu_static * self->normal_force(*s.evaluation); });
  add_share_channel(builder, *friction);
  builder.add_channel("slip_rate", "m/s", {"velocity of a against b along the touching face", "as friction"},
                      [self, f](const Snapshot& s) { return evaluate_row<false>(*self->rows(s.evaluation->friction[f]), s.motion).rate; });
  builder.add_channel("mode", "", {"what the friction does", "", "0 free, 1 sticks, 2 slips"},
                      [self, f](const Snapshot& s) { return self->shown_phase(*s.evaluation, s.evaluation->friction[f]); });
  builder.add_friction(std::move(friction));
}

void compile_polygon(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const PolygonContact&>(element);
  if (!check(e, builder)) return;
  const bool is_plane = is_half_plane(e, builder);
  const std::optional<ConvexOutline> a = outline_of(e.outline_a, e.a, "outline_a", builder);
  const std::optional<ConvexOutline> b =
      is_plane ? half_plane(e.normal.value_or(Vec2(0.0, 1.0)), builder.marker(e.b)) : outline_of(e.outline_b, e.b, "outline_b", builder);
  if (!a || !b) return;
  PolygonGroup& group = builder.group<PolygonGroup>();
  PolygonGroup::ElementData entry;
  entry.a = builder.marker(e.a).body;
  entry.b = builder.marker(e.b).body;
  const double narrowest = is_plane ? width_of(*a) : std::min(width_of(*a), width_of(*b));
  const double through = is_plane ? std::numeric_limits<double>::infinity() : 0.5 * narrowest;
  PlacedOutline<double> own_b;
  place_outline(*b, Origin{}, Pair<double>{}, own_b);
  entry.outlines = std::make_shared<const Outlines>(Outlines{*a, *b, own_b, reach_of(*a), reach_of(*b), through, narrowest});
  entry.stiffness = e.stiffness;
  entry.dissipation = e.dissipation;
  entry.has_friction = e.static_friction.has_value() && !is_plane;
  if (!group.entries.empty()) {
    const PolygonGroup::ElementData& before = group.entries.back();
    entry.has_same_a = entry.a == before.a && entry.b == before.b && entry.outlines->a.corners == before.outlines->a.corners;
  }
  group.entries.push_back(std::move(entry));
  builder.add_unit(group, 1);
  group.entries.back().contact = builder.add_contact(group.entries.back().unit);
  const int i = static_cast<int>(group.entries.size()) - 1, contact = group.entries.back().contact;
  builder.add_channel("gap", "m",
                      {"distance between the outlines; closed, the least way that would part them", "negative while it presses"},
                      [&group, i](const Snapshot& s) { return group.measured(i, *s.evaluation).gap; });
  builder.add_channel("force", "N", {"size of the normal force, zero while open", "positive: it presses"},
                      [contact](const Snapshot& s) { return s.evaluation->contact_force[contact]; });
  if (is_plane)
    builder.add_endless_face(contact, group.entries.back().a, a->corners, e.b, e.normal.value_or(Vec2(0.0, 1.0)),
                             "leave out 'normal', so that the outline of b ends it");
  if (e.static_friction) add_friction(e, group.entries.back(), builder);
}

// Returns the depth, m, at which the contact law becomes invalid: half of the width of the thinner outline; for a half-plane the whole
// width of the other. Nothing without outlines.
std::optional<double> depth_limit(const PolygonContact& e, const Model& model) {
  const auto width = [&](const std::vector<Vec2>& given, const std::string& marker) -> std::optional<double> {
    const Body* const body = place_of(model, marker).body;
    const std::vector<Vec2>* const outline = !given.empty() ? &given : body ? &body->outline : nullptr;
    return outline && !outline->empty() ? std::optional(width_of(convex_outline(*outline, CompiledMarker{}))) : std::nullopt;
  };
  const std::optional<double> a = width(e.outline_a, e.a), b = e.normal ? std::nullopt : width(e.outline_b, e.b);
  if (!a) return b ? std::optional(0.5 * *b) : std::nullopt;
  return b ? 0.5 * std::min(*a, *b) : *a;
}

ContactDescription describe(const Element& element, const Model& model) {
  const auto& e = static_cast<const PolygonContact&>(element);
  ContactDescription contact;
  contact.a = e.a;
  contact.b = e.b;
  contact.standing = ContactDescription::Standing::both;
  contact.depth_limit = depth_limit(e, model);
  contact.points = [](const Element& outlines, const ScenePose& pose) {
    const auto& of = static_cast<const PolygonContact&>(outlines);
    const ScenePose::PlacedMarker b = pose.marker(of.b);
    const std::vector<Vec2> corners_b = of.normal ? std::vector<Vec2>() : pose.outline(of.b, of.outline_b);
    const Vec2 up = rotated(of.normal.value_or(Vec2(0.0, 1.0)), b.angle).normalized();
    return support_points(pose.outline(of.a, of.outline_a), corners_b, b.point, up);
  };
  return contact;
}

} // namespace

std::string friction_problem(std::optional<double> static_friction, std::optional<double> kinetic_friction) {
  if (!kinetic_friction) return "";
  if (!static_friction) return "'kinetic_friction' needs 'static_friction'";
  return *kinetic_friction > *static_friction ? "'kinetic_friction' must not exceed 'static_friction'" : "";
}

const ElementKind& polygon_contact_kind() {
  static const ElementKind kind = [] {
    using T = PolygonContact;
    ElementKind k;
    k.name = "polygon_contact";
    k.doc = "The convex outline of a against that of b, or against a half-plane of b (the ground): corners and edges, "
            "wherever they touch. They press, they never hold; with 'static_friction' they stick.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("body that touches, or a marker of it");
    f.add("b", &T::b).as(FieldType::marker).doc("body that it touches, or a marker of it");
    f.add("outline_a", &T::outline_a).in("m").doc("corners in marker a's axes; default: the outline of its body");
    f.add("outline_b", &T::outline_b)
        .in("m")
        .doc("corners in marker b's axes; default: the outline of its body, of the ground the half-plane below marker b");
    f.add("normal", &T::normal).doc("b is the half-plane behind the line through marker b; in marker b's axes, towards a");
    add_contact_law<T>(f);
    k.holds<T>();
    k.compile = compile_polygon;
    k.contact = describe;
    k.friction = [](const Element& element) {
      const auto& e = static_cast<const T&>(element);
      return GivenFriction{"static_friction", e.static_friction.value_or(0.0), e.source};
    };
    k.example = R"([[element]]
name = 'faces'
kind = 'polygon_contact'
a = 'a'
b = 'b'
stiffness = 1e6
static_friction = 0.5
)";
    return k;
  }();
  return kind;
}

} // namespace steplap
