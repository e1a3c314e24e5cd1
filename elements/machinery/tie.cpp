#include "elements/machinery/tie.h"

#include "elements/contact_laws.h"
#include "elements/space_distance.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/system.h"
#include "mbd/system/turn_table.h"
#include "mbd/trust/element_judgement.h"

#include <cmath>
#include <limits>

namespace steplap {

namespace {

// Modes: 0 slack; 1 tension, 2 elongated without force; 3 and 4 the corresponding modes in compression; 5 acts in both directions without
// slack; 6 broken.
constexpr UnitMode k_slack = 0, k_pulls = 1, k_presses = 3, k_linear = 5, k_broken = 6;

struct TieLaw {
  static constexpr int k_event_count = 3;
  KelvinVoigtContact pull, push; ///< contact laws for −δ and δ; offset −∞ if that side does not act
  double k = 0.0, c = 0.0, free = 0.0;
  double strength = std::numeric_limits<double>::infinity(); ///< strength of all ties together, N
  bool is_linear = false;

  static UnitMode contact_mode(UnitMode mode) { return mode == k_pulls || mode == k_presses ? k_contact_pressed : k_contact_released; }
  static bool is_pull(UnitMode mode) { return mode == k_pulls || mode == k_pulls + 1; }
  static bool is_push(UnitMode mode) { return mode == k_presses || mode == k_presses + 1; }
  static UnitMode tie_mode(UnitMode contact, UnitMode side) {
    if (contact == k_contact_open) return k_slack;
    return contact == k_contact_pressed ? side : side + 1;
  }

  /// Returns the force on a along the measure, N; tension is negative.
  template <class S> [[nodiscard]] S force(const S& value, const S& rate, UnitMode mode) const {
    const S d = value - S(free);
    if (is_pull(mode)) return -pull.force(-d, -rate, contact_mode(mode));
    if (is_push(mode)) return push.force(d, rate, contact_mode(mode));
    return mode == k_linear ? S(-k) * d - S(c) * rate : S(0);
  }
  [[nodiscard]] double elastic_force(double value, UnitMode mode) const {
    const double d = value - free;
    if (is_pull(mode)) return -pull.elastic_force(-d, contact_mode(mode));
    if (is_push(mode)) return push.elastic_force(d, contact_mode(mode));
    return mode == k_linear ? -k * d : 0.0;
  }
  [[nodiscard]] double energy(double value) const {
    const double d = value - free;
    return is_linear ? 0.5 * k * d * d : pull.energy(-d) + push.energy(d);
  }
  [[nodiscard]] UnitMode initial_mode(double value, double rate) const {
    const double d = value - free;
    if (is_linear) return k_linear;
    if (const UnitMode mode = pull.initial_mode(-d, -rate); mode != k_contact_open) return tie_mode(mode, k_pulls);
    return tie_mode(push.initial_mode(d, rate), k_presses);
  }
  void event_value(double value, double rate, UnitMode mode, double* event_value, double* event_derivative) const {
    const double d = value - free;
    event_value[0] = event_value[1] = event_value[2] = 1.0;
    event_derivative[0] = event_derivative[1] = event_derivative[2] = std::numeric_limits<double>::quiet_NaN();
    if (mode == k_broken) return;
    if (std::isfinite(strength)) event_value[2] = 1.0 - std::abs(force(value, rate, mode)) / strength;
    if (mode == k_slack) {
      event_value[0] = std::isfinite(pull.offset) ? -d - pull.offset : 1.0;
      event_value[1] = std::isfinite(push.offset) ? d - push.offset : 1.0;
    } else if (is_pull(mode)) {
      pull.event_value(-d, -rate, contact_mode(mode), event_value, event_derivative);
    } else if (is_push(mode)) {
      push.event_value(d, rate, contact_mode(mode), event_value, event_derivative);
    }
  }
  [[nodiscard]] UnitMode next_mode(UnitMode mode, int slot, double value, double rate, double rounding) const {
    const double d = value - free;
    if (slot == 2) return k_broken;
    if (mode == k_slack)
      return slot == 0 ? tie_mode(pull.next_mode(k_contact_open, 0, -d, -rate, rounding), k_pulls)
                       : tie_mode(push.next_mode(k_contact_open, 0, d, rate, rounding), k_presses);
    if (is_pull(mode)) return tie_mode(pull.next_mode(contact_mode(mode), slot, -d, -rate, rounding), k_pulls);
    return is_push(mode) ? tie_mode(push.next_mode(contact_mode(mode), slot, d, rate, rounding), k_presses) : mode;
  }
  [[nodiscard]] bool is_armed_at_entry(UnitMode mode, int slot, double value, double rounding) const {
    const double d = value - free;
    if (is_pull(mode)) return pull.is_armed_at_entry(contact_mode(mode), slot, -d, rounding);
    return is_push(mode) && push.is_armed_at_entry(contact_mode(mode), slot, d, rounding);
  }
};

template <class Measure> class TieGroup final : public ForceGroup {
public:
  struct ElementData {
    int a = k_ground, b = k_ground;
    Measure measure;
    TieLaw law;
    int inner = -1; ///< index of the inner state that is 1 after breaking, for a tie with a strength; −1: none
    bool stops = false;
    int link = 0, unit = 0, first_event = 0;
  };
  std::vector<ElementData> entries;

  void add_forces(Evaluation& e) const override {
    for (const ElementData& entry : entries) {
      const UnitMode mode = e.mode[entry.unit];
      const auto m = entry.measure.template at<false, double>(e.link_motion[entry.link], Origin{});
      entry.law.event_value(m.value, m.rate, mode, e.event_value + entry.first_event, e.event_derivative + entry.first_event);
      const double f = entry.law.force(m.value, m.rate, mode);
      if (f != 0.0) apply_force(e.link_force[entry.link], m, f);
      e.dissipation += (entry.law.elastic_force(m.value, mode) - f) * m.rate;
    }
  }
  [[nodiscard]] double potential(const Motion<double>* motion) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries)
      if (entry.inner < 0) sum += entry.law.energy(value(entry, motion));
    return sum;
  }
  [[nodiscard]] double inner_energy(const Motion<double>* motion, const double* inner) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries)
      if (entry.inner >= 0 && inner[entry.inner] == 0.0) sum += entry.law.energy(value(entry, motion));
    return sum;
  }
  double jump_inner(int element, UnitMode to, const Evaluation& e, double* inner) const override {
    const ElementData& entry = entries[element];
    if (to != k_broken) return 0.0;
    inner[entry.inner] = 1.0;
    return entry.law.energy(value(entry, e.motion));
  }
  [[nodiscard]] bool ends_run_in(int element, UnitMode to) const override { return to == k_broken && entries[element].stops; }
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries)
      add_pair_jacobian(
          entry.a, entry.b, entry.measure, e,
          [&](const Dual<12>& v, const Dual<12>& rate) { return entry.law.force(v, rate, e.mode[entry.unit]); }, out);
  }
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
  }
  void register_turns(TurnTable& turns) const override {
    for (const ElementData& entry : entries) turns.add(entry.a, entry.b, turning_of(entry.measure));
  }
  void register_links(LinkTable& links) override {
    for (ElementData& entry : entries) entry.link = links.add(entry.a, entry.b);
  }
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override {
    const ElementData& entry = entries[element];
    if (entry.inner >= 0 && e.inner[entry.inner] != 0.0) return k_broken;
    const auto m = measured(element, e);
    return entry.law.initial_mode(m.value, m.rate);
  }
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    const auto m = measured(element, e);
    return entries[element].law.next_mode(mode, slot, m.value, m.rate, rounding_of(element, m, e));
  }
  [[nodiscard]] bool is_armed_at_entry(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    const auto m = measured(element, e);
    return entries[element].law.is_armed_at_entry(mode, slot, m.value, rounding_of(element, m, e));
  }
  [[nodiscard]] EventKind event_kind(UnitMode from, UnitMode to) const override {
    if (to == k_broken) return EventKind::breaks;
    if (to == k_slack) return EventKind::enters_gap;
    if (from == k_slack) return EventKind::closes_gap;
    return to == k_pulls || to == k_presses ? EventKind::force_returns : EventKind::force_reaches_zero;
  }
  [[nodiscard]] MeasureValue<double> measured(int element, const Evaluation& e) const {
    const ElementData& entry = entries[element];
    return entry.measure.template at<false, double>(e.motion[entry.a], e.motion[entry.b]);
  }
  /// Returns the force, N, tension positive.
  [[nodiscard]] double force_of(int element, const Evaluation& e) const {
    const auto m = measured(element, e);
    return -entries[element].law.force(m.value, m.rate, e.mode[entries[element].unit]);
  }

private:
  [[nodiscard]] double rounding_of(int element, const MeasureValue<double>& m, const Evaluation& e) const {
    return value_rounding(m, e.motion[entries[element].a], e.motion[entries[element].b]);
  }
  static double value(const ElementData& entry, const Motion<double>* motion) {
    return entry.measure.template at<false, double>(motion[entry.a], motion[entry.b]).value;
  }
};

template <class Measure> void add(const Tie& e, SystemBuilder& builder, int a, int b, const Measure& measure) {
  constexpr double k_never = -std::numeric_limits<double>::infinity();
  const double n = static_cast<double>(e.count), k = n * e.stiffness, c = n * e.damping;
  typename TieGroup<Measure>::ElementData entry;
  entry.a = a;
  entry.b = b;
  entry.measure = measure;
  entry.stops = e.on_break == "stop";
  TieLaw& law = entry.law;
  const double now = measure.template at<false, double>(builder.reference(a), builder.reference(b)).value;
  law.k = k;
  law.c = c;
  law.free = now - e.preload.value_or(0.0) / k;
  law.is_linear = e.acts == "both" && e.slack == 0.0;
  law.pull = {k, c, e.acts == "compression" ? k_never : -e.slack};
  law.push = {k, c, e.acts == "tension" ? k_never : -e.slack};
  if (e.strength) law.strength = n * *e.strength;
  if (std::abs(e.preload.value_or(0.0)) >= law.strength) return builder.error("its 'preload' is beyond its 'strength'");
  auto& group = builder.group<TieGroup<Measure>>();
  if (e.strength) entry.inner = builder.add_inner(group, 0.0);
  group.entries.push_back(entry);
  builder.add_unit(group, TieLaw::k_event_count);
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel("elongation", "m", {"its length less the free one", "positive: stretched"},
                      motion_value(a, b, measure, [free = law.free](const auto& m) { return m.value - free; }));
  builder.add_channel("force", "N", {"force of all of them together", "positive: tension"},
                      [&group, i](const Snapshot& s) { return group.force_of(i, *s.evaluation); });
  if (!e.strength) return;
  builder
      .add_channel("strength_share", "", {"size of its force, of its strength; breaks at 1", "never negative"},
                   [&group, i](const Snapshot& s) { return std::abs(group.force_of(i, *s.evaluation)) / group.entries[i].law.strength; })
      .role = ChannelRole::strength_use;
  builder.add_channel("mode", "", {"whether it holds", "", "1 whole, 0 broken"},
                      [&group, i](const Snapshot& s) { return s.evaluation->mode[group.entries[i].unit] == k_broken ? 0.0 : 1.0; });
}

bool check(const Tie& e, SystemBuilder& builder) {
  const auto fails = [&builder](bool is_wrong, const char* message) {
    if (is_wrong) builder.error(message);
    return is_wrong;
  };
  bool is_bad = fails(e.preload && *e.preload != 0.0 && e.slack > 0.0, "give either 'preload' or 'slack', not both");
  is_bad |= fails(e.preload.value_or(0.0) < 0.0 && e.acts == "tension",
                  "a negative 'preload' presses: 'acts' has to be \"compression\" or \"both\"");
  is_bad |= fails(e.preload.value_or(0.0) > 0.0 && e.acts == "compression",
                  "a positive 'preload' pulls: 'acts' has to be \"tension\" or \"both\"");
  is_bad |= refuses_across(builder, e.axis.has_value(), e.across);
  is_bad |= fails(e.on_break == "stop" && !e.strength, "'on_break' needs a 'strength'");
  return !is_bad;
}

void compile_tie(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Tie&>(element);
  if (!check(e, builder)) return;
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("ties a body to itself: name markers on two different bodies");
  if (e.axis) {
    if (e.axis->norm() == 0.0) return builder.error("'axis' has no direction");
    return add(e, builder, a.body, b.body, AxisMeasure{a.point, b.point, builder.direction(b, *e.axis)});
  }
  with_distance(builder, a, b, e.across, [&](const auto& measure) { add(e, builder, a.body, b.body, measure); });
}

// Judges a tie with a strength: the criterion is met if it does not break.
ElementJudgement judge_tie(const Element& element, const Model&, const RunResult& run) {
  const auto& tie = static_cast<const Tie&>(element);
  if (!tie.strength || tie.consequence == "none") return {};
  CriterionResult result;
  result.name = result.where = tie.name;
  result.text = "the tie does not break: its force, of its strength < 1";
  result.consequence = tie.consequence == "inspect" ? Verdict::inspect : Verdict::reject;
  result.outcome = Verdict::open;
  result.limit = 1.0;
  if (const ChannelRange* share = find_range(run, tie.name + ".strength_share"); share && !std::isnan(share->high.value)) {
    result.outcome = Verdict::hold;
    result.value = share->high.value;
    result.t = share->high.t;
    result.channel = share->channel->name;
    result.reserve = 1.0 - share->high.value;
  }
  for (const Event& event : run.events)
    if (event.kind == EventKind::breaks && event.element == tie.name) {
      result.outcome = result.consequence;
      result.t = event.t;
      result.reserve.reset(); // a broken tie is certain, whatever the error
    }
  return {{std::move(result)}, {}, ""};
}

} // namespace

const ElementKind& tie_kind() {
  static const ElementKind kind = [] {
    using T = Tie;
    ElementKind k;
    k.name = "tie";
    k.doc = "Parts that carry load in parallel with a joint: tie plates, clamping bolts, bindings, resin, a winding round a limb. A spring "
            "between "
            "two markers that pulls, presses or both, with slack, preload and a strength at which it breaks for good.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker on the first body");
    f.add("b", &T::b).as(FieldType::marker).doc("marker on the second body");
    f.add("axis", &T::axis).doc("direction in marker b's axes; without it, from point to point");
    f.add("across", &T::across).in("m").not_negative().doc("distance of its ends across the plane; its length is that in space");
    f.add("acts", &T::acts).one_of({"tension", "compression", "both"}).doc("in which sense it gives a force");
    f.add("stiffness", &T::stiffness).in("N/m").positive().required().doc("of one");
    f.add("damping", &T::damping).in("N s/m").not_negative().doc("of one");
    f.add("count", &T::count).at_least(1).doc("equal ones side by side");
    f.add("slack", &T::slack).in("m").not_negative().doc("elongation without force, on each side on which it acts");
    f.add("preload", &T::preload).in("N").doc("of all in the reference pose, tension positive");
    f.add("strength", &T::strength).in("N").positive().doc("size of the force at which one breaks; not given: it does not");
    f.add("on_break", &T::on_break).one_of({"continue", "stop"}).doc("whether the run continues without it");
    f.add("consequence", &T::consequence)
        .one_of({"reject", "inspect", "none"})
        .doc("what its breaking means for the verdict; none: it is meant to give way first, such as resin");
    k.example = R"([[element]]
name = 'tie plate'
kind = 'tie'
a = { body = 'a', point = [0.0, -0.5] }
b = { body = 'b', point = [0.0, 0.5] }
acts = 'both'
stiffness = 1e7
strength = 1e5
)";
    k.holds<T>();
    k.compile = compile_tie;
    k.judge = judge_tie;
    return k;
  }();
  return kind;
}

} // namespace steplap
