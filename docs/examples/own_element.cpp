// Adds an element kind, an orifice damper, which model files can use and whose runs get a verdict:
//   own_element own_element.toml
#include <steplap/catalog.h>
#include <steplap/judged_run.h>
#include <steplap/own_element.h>
#include <steplap/verdict.h>

#include <cmath>
#include <cstdio>

using namespace steplap;

struct OrificeDamper : Element {
  std::string a, b = "ground";           // markers
  double constant = 0.0, strength = 0.0; // N s²/m²; largest permitted force, N
};

struct OrificeLaw {                       // Force on a, away from b: f = −c rate |rate|. No energy is stored, so −f rate is dissipated.
  static constexpr int k_event_count = 0; // smooth, so there are no events
  static constexpr bool k_is_contact = false;
  double c = 0.0;
  template <class S> S force(const S&, const S& rate, UnitMode) const {
    using std::abs;
    return S(-c) * rate * abs(rate);
  }
  template <class S> S elastic_force(const S&, UnitMode) const { return S(0); }
  double energy(double) const { return 0.0; }
};

void compile_damper(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const OrificeDamper&>(element);
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (builder.marker_position(a) == builder.marker_position(b)) return builder.error("its ends coincide: move a marker");
  auto& group = builder.group<LawGroup<DistanceMeasure, OrificeLaw>>();
  group.entries.push_back({a.body, b.body, {a.point, b.point}, {e.constant}});
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel("force", "N", {"what it acts with on a, away from b", "negative: it pulls a towards b"},
                      [&group, i](const Snapshot& s) { return group.force_of(i, *s.evaluation); });
}

ElementJudgement judge_damper(const Element& element, const Model&, const RunResult& run) {
  Criterion strength; // limit of the force, like an entry of [[acceptance]]
  strength.name = element.name;
  strength.channel = element.name + ".force";
  strength.within = static_cast<const OrificeDamper&>(element).strength;
  strength.consequence = "reject";
  return {{judge_criterion(strength, run)}, {}, ""};
}

const ElementKind& orifice_damper_kind() {
  static const ElementKind kind = [] {
    ElementKind k;
    k.name = "orifice_damper";
    k.doc = "Damper from point to point whose force grows with the square of its rate.";
    k.fields.add("a", &OrificeDamper::a).as(FieldType::marker).required().doc("marker on the first body");
    k.fields.add("b", &OrificeDamper::b).as(FieldType::marker).doc("marker on the second body");
    k.fields.add("constant", &OrificeDamper::constant).in("N s2/m2").positive().required().doc("force over rate squared");
    k.fields.add("strength", &OrificeDamper::strength).in("N").positive().required().doc("force that it bears");
    k.holds<OrificeDamper>();
    k.compile = compile_damper;
    k.judge = judge_damper;
    k.channels_of_trust = [](const Element& e) { return std::vector<std::string>{e.name + ".force"}; };
    return k;
  }();
  return kind;
}

int main(int argc, char** argv) try {
  if (argc < 2) return std::fprintf(stderr, "usage: own_element own_element.toml [path=value …]\n"), 2;
  Catalogue catalogue = transformer_catalog();
  catalogue.elements.push_back(&orifice_damper_kind());
  const Report report = judged_run(load_model(argv[1], {argv + 2, argv + argc}, catalogue));

  const Trajectory& rows = *report.run.result.trajectory;
  std::printf("speed %.6f m/s\nway %.6f m\n", rows.series("wagon.vx").back(), rows.series("wagon.x").back());
  std::printf("dissipated %.4f J\n", report.run.result.statistics.dissipated);
  for (const CriterionResult& c : report.judgement.criteria)
    std::printf("%s: %s, largest %.3f N\n", c.text.c_str(), name_of(c.outcome), c.value.value_or(0.0));
  std::printf("verdict: %s\n", name_of(report.judgement.verdict));
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
