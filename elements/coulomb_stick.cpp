#include "elements/coulomb_stick.h"

#include "elements/coulomb_friction.h"
#include "elements/round_contacts.h"
#include "elements/round_measures.h"
#include "elements/share_channel.h"
#include "elements/unilateral_contact.h"
#include "mbd/base/portable_math.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace steplap {

namespace {

// Dead band, m, for the change of the contact point from the side of a segment to its end.
constexpr double k_end_dead_band = 1e-13;
// Friction of a segment's contact: one contact point for each side and each end (SegmentPart).
class SegmentFriction final : public CoulombFriction {
public:
  SegmentMeasure segment;

  [[nodiscard]] bool record_friction(TracedEvaluation&, const FrictionState&, const TapeNumber*, TapeNumber*, TapeNumber*) const override {
    return false; // not traceable: the choice of the contact point depends on comparisons
  }
  [[nodiscard]] double contact_point_event(const Evaluation& e, const FrictionState& state) const override {
    const Pair<double> p = segment.place(e.motion[feet[0].a], e.motion[feet[0].b]);
    const auto part = static_cast<SegmentPart>(state.foot);
    if (part == SegmentPart::from) return k_end_dead_band - p.x;
    if (part == SegmentPart::to) return k_end_dead_band + p.x - segment.length;
    if ((part == SegmentPart::right) != (p.y < 0.0)) return -1.0; // the side can change only after the contact has been open
    return k_end_dead_band + std::min(p.x, segment.length - p.x);
  }
  void switch_contact_point(const Evaluation& e, FrictionState& state) const override {
    state.foot = static_cast<std::uint32_t>(segment.part(e.motion[feet[0].a], e.motion[feet[0].b]));
  }
};

RowSpec slide_row(const ContactGeometry& g, int base) {
  RowSpec row;
  row.kind = MeasureKind::slide;
  row.a = g.a;
  row.b = g.b;
  row.point_a = g.gap.point_a;
  row.point_b = g.gap.point_b;
  row.direction = g.gap.normal;
  row.contact_axis = g.gap.axis;
  row.is_axis_in_a = g.gap.is_axis_in_a;
  row.base = base;
  row.quantity = "slide";
  return row;
}

// Reports a contact that belongs to two friction elements, which would use its normal force twice.
bool is_claimed(const CoulombStick& e, SystemBuilder& builder) {
  const auto refuse = [&builder](const std::string& contact, const std::string& where) {
    builder.error("'" + contact + "' stands in 'contacts' " + where + ": its normal force would be used for friction twice");
    return true;
  };
  for (auto contact = e.contacts.begin(); contact != e.contacts.end(); ++contact)
    if (std::find(e.contacts.begin(), contact, *contact) != contact) return refuse(*contact, "twice");
  for (const ElementEntry& entry : builder.model().elements) {
    if (entry.element.get() == &e) return false;
    if (entry.kind != &coulomb_stick_kind()) continue;
    const std::vector<std::string>& others = static_cast<const CoulombStick&>(*entry.element).contacts;
    for (const std::string& contact : e.contacts)
      if (std::find(others.begin(), others.end(), contact) != others.end())
        return refuse(contact, "here and in those of '" + entry.element->name + "'");
  }
  return false;
}

// Collects the contacts. All must lie between the same two bodies on one line, so that one coordinate is sufficient.
bool collect(const CoulombStick& e, SystemBuilder& builder, std::vector<ContactGeometry>& geometry, std::vector<ContactIndex>& contacts,
             double& damping, bool& may_pull) {
  for (const std::string& name : e.contacts) {
    const ContactIndex* index = builder.contact(name);
    const ElementEntry* entry = builder.element(name);
    if (!index || !entry) {
      builder.error("'" + name + "' is no contact: name contact elements in 'contacts'");
      return false;
    }
    const auto* contact = dynamic_cast<const UnilateralContact*>(entry->element.get());
    if (!contact) {
      builder.error("'" + name + "' is no unilateral_contact");
      return false;
    }
    geometry.push_back(contact_geometry(*contact, builder));
    damping += damping_of(*contact, geometry.back(), builder);
    may_pull = may_pull || contact->law == "literal";
    contacts.push_back(*index);
    const ContactGeometry &first = geometry.front(), &last = geometry.back();
    if (first.a != last.a || first.b != last.b || (first.gap.normal - last.gap.normal).norm() > 1e-9) {
      builder.error("contacts '" + e.contacts.front() + "' and '" + name +
                    "' are not between the same two bodies with the same normal: give each its own "
                    "coulomb_stick");
      return false;
    }
  }
  return true;
}

void add_channels(SystemBuilder& builder, const CoulombFriction& friction) {
  const int f = builder.next_friction(), row = builder.next_friction_row();
  const auto* self = &friction;
  builder.add_channel("friction", "N", {"friction force on a", "along b's tangent, its normal turned clockwise by a right angle"},
                      [row](const Snapshot& s) { return s.friction_force[row]; });
  builder.add_channel("normal", "N", {"sum of the contacts' normal forces", "positive: they press"},
                      [self](const Snapshot& s) { return self->normal_force(*s.evaluation); });
  builder.add_channel("capacity", "N", {"largest friction force that holds", "never negative"},
                      [self](const Snapshot& s) { return self->mu_static * self->normal_force(*s.evaluation); });
  add_share_channel(builder, friction);
  builder.add_channel("slip_rate", "m/s", {"velocity of a's last contact point against b", "along b's tangent"},
                      [self, f](const Snapshot& s) { return evaluate_row<false>(*self->rows(s.evaluation->friction[f]), s.motion).rate; });
  builder.add_channel("mode", "", {"what the friction does", "", "0 free, 1 sticks, 2 slips"},
                      [self, f](const Snapshot& s) { return self->shown_phase(*s.evaluation, s.evaluation->friction[f]); });
}

// Adds the channel of the slid distance from the reference pose.
void add_slide_channel(SystemBuilder& builder, const char* name, const char* doc, const CoulombFriction& friction, std::size_t place) {
  const double start = evaluate_row<false>(friction.feet[place], &builder.reference(0)).value;
  builder.add_channel(name, "m", {doc, "along b's tangent"}, MotionValue{[row = friction.feet[place], start](const Motion<double>* motion) {
                        return evaluate_row<false>(row, motion).value - start;
                      }});
}

void finish(const CoulombStick& e, std::unique_ptr<CoulombFriction> friction, bool is_rolling, SystemBuilder& builder) {
  for (RowSpec& row : friction->feet) row.element = builder.element_index();
  friction->mu_static = e.static_friction;
  friction->mu_kinetic = e.kinetic_friction.value_or(e.static_friction);
  add_channels(builder, *friction);
  if (!is_rolling) {
    add_slide_channel(builder, "slide", "tangential coordinate of the front-most contact since the reference pose", *friction,
                      friction->feet.size() - 1);
    add_slide_channel(builder, "slide_rear", "the same of the rear-most contact", *friction, 0);
  }
  builder.add_friction(std::move(friction));
}

bool is_round(const ElementEntry* entry) { return entry && dynamic_cast<const RoundContact*>(entry->element.get()); }

bool is_any_round(const CoulombStick& e, const SystemBuilder& builder) {
  return std::any_of(e.contacts.begin(), e.contacts.end(), [&](const std::string& name) { return is_round(builder.element(name)); });
}

// Compiles friction of a circle's contact; its sticking phase is rolling.
void compile_rolling(const CoulombStick& e, SystemBuilder& builder) {
  if (e.contacts.size() > 1)
    return builder.error("a circle's contact cannot share its friction with others: give each its own coulomb_stick");
  const ContactIndex* index = builder.contact(e.contacts.front());
  if (!index) return; // the contact reports its own error
  const Element& contact = *builder.element(e.contacts.front())->element;
  std::vector<RowSpec> rows = rolling_rows(contact, builder);
  const int base = builder.add_base();
  for (RowSpec& row : rows) row.base = base;
  std::unique_ptr<CoulombFriction> friction;
  if (const auto* segment = dynamic_cast<const SegmentContact*>(&contact)) {
    auto own = std::make_unique<SegmentFriction>();
    own->segment = segment_measure(*segment, builder);
    friction = std::move(own);
  } else {
    friction = std::make_unique<CoulombFriction>();
    rows.push_back(rows.front());
  }
  friction->contacts.push_back(*index);
  friction->feet = std::move(rows);
  finish(e, std::move(friction), true, builder);
}

double lighter_mass(const ContactGeometry& g, const SystemBuilder& builder) {
  double mass = std::numeric_limits<double>::infinity();
  for (const int index : {g.a, g.b})
    if (index != k_ground) mass = std::min(mass, builder.compiled().bodies[static_cast<std::size_t>(index)].mass);
  return mass;
}

// Returns the angle φ = θ_A − θ_B at which both feet touch. Let d be the vector from the rear to the front foot in a's axes, t and n the
// line's tangent and normal in b's axes. Then gap_front − gap_rear = n·R(φ) d − h = |d| sin(φ + β) − h, with tan β = n·d/t·d, and h the
// height of b's line at the front foot above that at the rear foot. Front and rear are those of the reference pose, so φ is the solution
// within a right angle of that pose. |φ| < 0.01 rad counts as zero: such angles result from preloads and rounded coordinates of feet that
// are meant to be level.
double level_angle(const ContactGeometry& rear, const ContactGeometry& front, const SystemBuilder& builder) {
  constexpr double k_meant_level = 0.01, k_whole_turn = 6.283185307179586;
  const Vec2 n = front.gap.normal, t(n.y(), -n.x()), d = front.gap.point_a - rear.gap.point_a;
  const double length = d.norm(), h = n.dot(front.gap.point_b - rear.gap.point_b);
  if (length == 0.0) return 0.0;
  RowSpec turn = slide_row(rear, -1);
  turn.kind = MeasureKind::angle;
  const double reference = evaluate_row<false>(turn, &builder.reference(0)).value;
  const double sine = std::clamp(h / length, -1.0, 1.0);
  const double angle = portable::atan2(sine, std::sqrt(1.0 - sine * sine)) - portable::atan2(n.dot(d), t.dot(d));
  const double level = angle + k_whole_turn * std::round((reference - angle) / k_whole_turn);
  return std::abs(level) < k_meant_level ? 0.0 : level;
}

void compile_coulomb(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const CoulombStick&>(element);
  if (e.contacts.empty()) return builder.error("'contacts' is empty: name the contacts that carry the friction");
  if (e.kinetic_friction.value_or(e.static_friction) > e.static_friction)
    return builder.error("'kinetic_friction' must not exceed 'static_friction'");
  if (is_claimed(e, builder)) return;
  if (is_any_round(e, builder)) return compile_rolling(e, builder);
  std::vector<ContactGeometry> geometry;
  auto friction = std::make_unique<CoulombFriction>();
  if (!collect(e, builder, geometry, friction->contacts, friction->damping, friction->may_pull)) return;

  const int base = builder.add_base();
  const auto slide_of = [&](const ContactGeometry& g) { return evaluate_row<false>(slide_row(g, -1), &builder.reference(0)).value; };
  std::vector<std::size_t> order(geometry.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return slide_of(geometry[x]) < slide_of(geometry[y]); });
  for (const std::size_t i : order) friction->feet.push_back(slide_row(geometry[i], base));
  if (order.size() > 1) {
    for (const std::size_t i : order) friction->foot_contacts.push_back(friction->contacts[i]);
    friction->levels.assign(order.size() * order.size(), 0.0);
    for (std::size_t rear = 0; rear < order.size(); ++rear)
      for (std::size_t front = rear + 1; front < order.size(); ++front)
        friction->levels[rear * order.size() + front] = level_angle(geometry[order[rear]], geometry[order[front]], builder);
  }
  friction->mass = lighter_mass(geometry.front(), builder);
  for (const ContactGeometry& g : geometry) friction->lever = std::max({friction->lever, g.gap.point_a.norm(), g.gap.point_b.norm()});
  finish(e, std::move(friction), false, builder);
}

} // namespace

const ElementKind& coulomb_stick_kind() {
  static const ElementKind kind = [] {
    using T = CoulombStick;
    ElementKind k;
    k.name = "coulomb_stick";
    k.stage = 1;
    k.doc = "Coulomb friction under a group of contacts of one pair of bodies: sticks exactly while the "
            "force it takes is within static_friction times the sum of their normal forces.";
    FieldTable& f = k.fields;
    f.add("contacts", &T::contacts)
        .as(FieldType::elements)
        .required()
        .doc("the contacts that press: unilateral_contact elements, or one of a circle");
    f.add("static_friction", &T::static_friction).not_negative().required().doc("mu_s");
    f.add("kinetic_friction", &T::kinetic_friction).not_negative().doc("mu_k; default: mu_s");
    f.add("shared_friction", &T::shared_friction)
        .doc("name by which models of other planes of the same machine share this friction; default: the element's own. Only "
             "`steplap assess` with several models looks at it");
    f.add("source", &T::source)
        .doc("where the coefficients come from: above 0.8 results name it, from 1.2 on no verdict is hold without it");
    k.holds<T>();
    k.compile = compile_coulomb;
    k.friction = [](const Element& element) { // the static coefficient, since the kinetic one is not larger
      const auto& e = static_cast<const T&>(element);
      return GivenFriction{"static_friction", e.static_friction, e.source};
    };
    k.example = R"([[element]]
name = 'foot'
kind = 'unilateral_contact'
a = { body = 'a', point = [0.0, -0.5] }
b = { body = 'b', point = [0.0, 0.5] }
stiffness = 1e6
[[element]]
name = 'sole'
kind = 'coulomb_stick'
contacts = ['foot']
static_friction = 0.5
)";
    return k;
  }();
  return kind;
}

} // namespace steplap
