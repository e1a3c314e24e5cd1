#include "elements/machinery/rolling_resistance.h"

#include "elements/coulomb_friction.h"
#include "elements/machinery/tyre.h"
#include "elements/machinery/tyre_contact.h"
#include "elements/round_contacts.h"
#include "elements/share_channel.h"

#include <optional>
#include <utility>

namespace steplap {

namespace {

// Friction with the normal force of one contact, whose unit may be that of a tyre.
class RollingFriction final : public CoulombFriction {
public:
  bool is_tyre = false;

  [[nodiscard]] bool is_loaded(const Evaluation& e, const FrictionState& state) const override {
    return is_tyre ? tyre_presses(e.mode[contacts.front().unit]) : CoulombFriction::is_loaded(e, state);
  }
};

// Returns the markers a and b of the round body's contact; nothing for other elements.
std::optional<std::pair<std::string, std::string>> ends_of(const Element& contact) {
  if (const auto* tyre = dynamic_cast<const Tyre*>(&contact)) return std::pair{tyre->a, tyre->b};
  if (const auto* round = dynamic_cast<const RoundContact*>(&contact)) return std::pair{round->a, round->b};
  return std::nullopt;
}

void add_channels(const RollingFriction& friction, SystemBuilder& builder) {
  const int f = builder.next_friction(), slot = builder.next_friction_row();
  const auto* self = &friction;
  builder.add_channel("friction", "N m", {"couple on a", "positive counter-clockwise"},
                      [slot](const Snapshot& s) { return s.friction_force[slot]; });
  builder.add_channel("capacity", "N m", {"largest couple that holds", "never negative"},
                      [self](const Snapshot& s) { return self->mu_static * self->normal_force(*s.evaluation); });
  add_share_channel(builder, friction);
  builder.add_channel("slip_rate", "rad/s", {"with which a turns over b", "positive counter-clockwise"},
                      [self, f](const Snapshot& s) { return evaluate_row<false>(*self->rows(s.evaluation->friction[f]), s.motion).rate; });
  builder.add_channel("mode", "", {"state", "", "0 in the air, 1 holds, 2 rolls"},
                      [f](const Snapshot& s) { return static_cast<double>(s.evaluation->friction[f].phase); });
}

void compile_rolling_resistance(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const RollingResistance&>(element);
  if (e.contacts.size() != 1) return builder.error("name one contact in 'contacts': each rolling contact needs its own rolling_resistance");
  const std::string& name = e.contacts.front();
  const ElementEntry* const entry = builder.element(name);
  const auto ends = entry ? ends_of(*entry->element) : std::nullopt;
  if (!ends) return builder.error("'" + name + "' does not roll: name a tyre, a circle_contact or a segment_contact");
  const ContactIndex* const contact = builder.contact(name);
  if (!contact) return; // the contact reports its own error
  RowSpec row;
  row.kind = MeasureKind::angle;
  row.a = builder.marker(ends->first).body;
  row.b = builder.marker(ends->second).body;
  row.quantity = "angle";
  row.element = builder.element_index();
  row.base = builder.add_base();
  auto friction = std::make_unique<RollingFriction>();
  friction->is_tyre = dynamic_cast<const Tyre*>(entry->element.get()) != nullptr;
  friction->contacts = {*contact};
  friction->feet = {row, row};
  friction->mu_static = friction->mu_kinetic = e.arm;
  add_channels(*friction, builder);
  builder.add_friction(std::move(friction));
}

} // namespace

const ElementKind& rolling_resistance_kind() {
  static const ElementKind kind = [] {
    using T = RollingResistance;
    ElementKind k;
    k.name = "rolling_resistance";
    k.stage = 1;
    k.doc = "Couple against the turning of something round that presses: at most 'arm' times the normal force, and at rest whatever it "
            "takes within that.";
    FieldTable& f = k.fields;
    f.add("contacts", &T::contacts).as(FieldType::elements).required().doc("what rolls: one tyre, circle_contact or segment_contact");
    f.add("arm", &T::arm)
        .in("m")
        .positive()
        .required()
        .doc("couple over normal force; a coefficient of rolling resistance times the radius");
    k.example = R"([[element]]
name = 'roller'
kind = 'segment_contact'
a = 'a'
b = 'b'
radius = 0.5
from = [-1.0, 1.5]
to = [1.0, 1.5]
stiffness = 1e6
[[element]]
name = 'resistance'
kind = 'rolling_resistance'
contacts = ['roller']
arm = 0.001
)";
    k.holds<T>();
    k.compile = compile_rolling_resistance;
    return k;
  }();
  return kind;
}

} // namespace steplap
