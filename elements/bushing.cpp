#include "elements/bushing.h"

#include "elements/spring_laws.h"
#include "mbd/system/system.h"

namespace steplap {

namespace {

template <class Measure>
void add(SystemBuilder& builder, int a, int b, const Measure& measure, double k, double c, const char* channel, const char* unit) {
  if (k == 0.0 && c == 0.0) return;
  using Group = LawGroup<Measure, LinearSpring>;
  Group& group = builder.group<Group>();
  const double now = measure.template at<false, double>(builder.reference(a), builder.reference(b)).value;
  group.entries.push_back({a, b, measure, LinearSpring{k, c, now}});
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel(channel, unit,
                      {"what it acts with on a", unit[1] == '\0' ? "along that axis of marker b" : "positive counter-clockwise"},
                      [&group, i](const Snapshot& s) { return group.force_of(i, *s.evaluation); });
}

void compile_bushing(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Bushing&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("joins a body to itself: name markers on two different bodies");
  if ((e.stiffness.array() < 0.0).any() || (e.damping.array() < 0.0).any())
    return builder.error("'stiffness' and 'damping' must not be negative");
  const AxisMeasure x{a.point, b.point, builder.direction(b, {1.0, 0.0})};
  const AxisMeasure y{a.point, b.point, builder.direction(b, {0.0, 1.0})};
  with_cheapest(x, [&](const auto& m) { add(builder, a.body, b.body, m, e.stiffness.x(), e.damping.x(), "force_x", "N"); });
  with_cheapest(y, [&](const auto& m) { add(builder, a.body, b.body, m, e.stiffness.y(), e.damping.y(), "force_y", "N"); });
  add(builder, a.body, b.body, AngleMeasure{}, e.rotational_stiffness, e.rotational_damping, "couple", "N m");
}

} // namespace

const ElementKind& bushing_kind() {
  static const ElementKind kind = [] {
    ElementKind k;
    k.name = "bushing";
    k.doc = "Springs and dampers along x and y of marker b and about it; without force in the reference pose.";
    FieldTable& f = k.fields;
    f.add("a", &Bushing::a).as(FieldType::marker).required().doc("marker on the first body");
    f.add("b", &Bushing::b).as(FieldType::marker).doc("marker on the second body, whose axes count");
    f.add("stiffness", &Bushing::stiffness).in("N/m").doc("[along x, along y]");
    f.add("damping", &Bushing::damping).in("N s/m").doc("[along x, along y]");
    f.add("rotational_stiffness", &Bushing::rotational_stiffness).in("N m/rad").not_negative().doc("about b");
    f.add("rotational_damping", &Bushing::rotational_damping).in("N m s/rad").not_negative().doc("about b");
    k.example = R"([[element]]
name = 'mount'
kind = 'bushing'
a = { body = 'a', at = [0.0, 0.0] }
b = { body = 'b', at = [0.0, 0.0] }
stiffness = [1e6, 1e6]
damping = [1e3, 1e3]
)";
    k.holds<Bushing>();
    k.compile = compile_bushing;
    return k;
  }();
  return kind;
}

} // namespace steplap
