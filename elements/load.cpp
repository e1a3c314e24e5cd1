#include "elements/load.h"

#include "mbd/system/system.h"
#include "mbd/system/turn_table.h"

namespace steplap {

namespace {

struct LoadEntry {
  int body = k_ground;
  Vec2 point, force;
  double couple = 0.0, angle = 0.0;
  const Signal *x = nullptr, *y = nullptr, *torque = nullptr;
  bool is_in_body = false;
};

template <class S> struct AppliedLoad {
  Pair<S> force, lever;
  S couple{0.0};
};

// Returns the load on the body. `value` returns the value of a signal at the present time.
template <class S, class Value> AppliedLoad<S> load_by(const LoadEntry& entry, const Motion<S>& body, const Value& value) {
  const auto sum = [&value](double constant, const Signal* signal) { return constant + (signal ? value(signal) : S(0.0)); };
  AppliedLoad<S> load;
  const Pair<S> local{sum(entry.force.x(), entry.x), sum(entry.force.y(), entry.y)};
  load.force = local;
  if (entry.is_in_body) {
    const auto [s, c] = portable::sin_cos(entry.angle);
    const Pair<S> turned{c * local.x - s * local.y, s * local.x + c * local.y};
    load.force = {body.c * turned.x - body.s * turned.y, body.s * turned.x + body.c * turned.y};
  }
  load.lever = to_ground(body, entry.point);
  load.couple = sum(entry.couple, entry.torque);
  return load;
}

AppliedLoad<double> load_at(const LoadEntry& entry, const Evaluation& e) {
  return load_by(entry, e.motion[entry.body], [&e](const Signal* signal) { return e.force_of(*signal); });
}

class LoadGroup final : public ForceGroup {
public:
  static constexpr bool k_does_work = true;
  std::vector<LoadEntry> entries;

  void add_forces(Evaluation& e) const override {
    for (const LoadEntry& entry : entries) add(entry, load_at(entry, e), e);
  }
  [[nodiscard]] bool record_forces(TracedEvaluation& e) const override {
    for (const LoadEntry& entry : entries)
      add<TapeNumber>(entry, load_by(entry, e.motion[entry.body], [&e](const Signal* signal) { return e.record_signal_input({signal}); }),
                      e);
    return true;
  }
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }

  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const LoadEntry& entry : entries) {
      const AppliedLoad<double> load = load_at(entry, e);
      PairJacobian& j = out.emplace_back();
      j.a = entry.body;
      j.b = k_ground;
      j.stiffness.setZero();
      j.damping.setZero();
      // A rotation of the body rotates the lever. A force fixed in the body rotates with it, so its moment is constant.
      if (entry.is_in_body) {
        j.stiffness(0, 2) = -load.force.y;
        j.stiffness(1, 2) = load.force.x;
      } else {
        j.stiffness(2, 2) = -dot(load.lever, load.force);
      }
    }
  }
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const LoadEntry& entry : entries) is_used[entry.body] = 1;
  }

  void register_turns(TurnTable& turns) const override {
    for (const LoadEntry& entry : entries)
      if (entry.is_in_body || moves_by_turning(entry.point)) turns.add(entry.body, k_ground);
  }

private:
  template <class S> static void add(const LoadEntry& entry, const AppliedLoad<S>& load, EvaluationData<S>& e) {
    const Motion<S>& body = e.motion[entry.body];
    BodyForceOf<S>& sum = e.force[entry.body];
    const S moment = cross(load.lever, load.force) + load.couple;
    sum.fx += load.force.x;
    sum.fy += load.force.y;
    sum.m += moment;
    e.work += load.force.x * body.vx + load.force.y * body.vy + moment * body.omega;
  }
};

void compile_load(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Load&>(element);
  const CompiledMarker marker = builder.marker(e.at);
  if (marker.body == k_ground) return builder.error("acts on the ground or a fixed body, which it cannot move");
  LoadGroup& group = builder.group<LoadGroup>();
  group.entries.push_back({marker.body, marker.point, e.force.value_or(Vec2::Zero()), e.couple.value_or(0.0), marker.angle,
                           builder.signal(e.force_x, SignalUse::force), builder.signal(e.force_y, SignalUse::force),
                           builder.signal(e.torque, SignalUse::force), e.frame == "body"});
  const auto* entries = &group.entries;
  const std::size_t i = group.entries.size() - 1;
  const auto load = [entries, i](const Snapshot& s) { return load_at((*entries)[i], *s.evaluation); };
  builder.add_channel("force_x", "N", {"its force", "along x of the ground axes"}, [load](const Snapshot& s) { return load(s).force.x; });
  builder.add_channel("force_y", "N", {"its force", "along y of the ground axes"}, [load](const Snapshot& s) { return load(s).force.y; });
  builder.add_channel("torque", "N m", {"its couple", "positive counter-clockwise"}, [load](const Snapshot& s) { return load(s).couple; });
}

} // namespace

const ElementKind& load_kind() {
  static const ElementKind kind = [] {
    ElementKind k;
    k.name = "load";
    k.doc = "A force and a couple at a marker, constant or following signals.";
    FieldTable& f = k.fields;
    f.add("at", &Load::at).as(FieldType::marker).required().doc("marker where it acts");
    f.add("force", &Load::force).in("N").doc("constant part; zero if not given");
    f.add("couple", &Load::couple).in("N m").doc("constant part; zero if not given");
    f.add("force_x", &Load::force_x).as(FieldType::signal).in("N").doc("signal added to the force along x");
    f.add("force_y", &Load::force_y).as(FieldType::signal).in("N").doc("signal added to the force along y");
    f.add("torque", &Load::torque).as(FieldType::signal).in("N m").doc("signal added to the couple");
    f.add("frame", &Load::frame).one_of({"ground", "body"}).doc("axes of the force: ground, or the marker's");
    k.example = R"([[element]]
name = 'push'
kind = 'load'
at = 'a'
force = [1e3, 0.0]
)";
    k.holds<Load>();
    k.compile = compile_load;
    k.acts_from_outside = [](const Element&, const Model&) { return true; };
    k.has_constant_load = [](const Element& element) {
      const auto& load = static_cast<const Load&>(element);
      return load.force.value_or(Vec2::Zero()) != Vec2::Zero() || load.couple.value_or(0.0) != 0.0;
    };
    return k;
  }();
  return kind;
}

} // namespace steplap
