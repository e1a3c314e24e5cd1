// A unilateral contact whose face has ends: a foot beyond an end is not supported.
//
// Modes: those of its law (contact_laws.h), and `off`: behind the line of the face and not supported, because the foot is past an end, or
// came from there. When a pressed foot passes an end the mode becomes off, the force vanishes at once, and its elastic energy ½ k δ² is
// counted as dissipated. No energy is created: a foot that is off is supported again only after it has risen above the line. The face has
// no sides; use polygon_contact for a part that has sides.
#pragma once

#include "elements/contact_laws.h"

#include <algorithm>

namespace steplap {

inline constexpr UnitMode k_contact_off = 3;

template <class Law> class EndedContactGroup final : public ForceGroup, public GapSource {
public:
  struct ElementData {
    int a = k_ground, b = k_ground;
    GapMeasure gap;
    Law law;
    double low = 0.0, high = 0.0; ///< range of the coordinate along the face, from point_b, m
    int inner = 0;                ///< index of the inner state that is 1 while the mode is off
    int link = 0, unit = 0, first_event = 0, contact = 0;

    [[nodiscard]] SlideMeasure slide() const { return {gap.point_a, gap.point_b, gap.normal, gap.axis, gap.is_axis_in_a}; }
    [[nodiscard]] bool is_on_face(double along) const { return along >= low && along <= high; }
    /// Returns true if a foot that has not been supported before is behind the line and past an end.
    [[nodiscard]] bool is_off_at(const Motion<double>& at_a, const Motion<double>& at_b) const {
      return gap.at<false, double>(at_a, at_b).value < law.offset && !is_on_face(slide().template at<false, double>(at_a, at_b).value);
    }
  };
  static constexpr int k_event_count = Law::k_event_count + 1;
  std::vector<ElementData> entries;

  void add_forces(Evaluation& e) const override {
    for (const ElementData& entry : entries) add_force(entry, e);
  }
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }
  [[nodiscard]] double inner_energy(const Motion<double>* motion, const double* inner) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries)
      if (inner[entry.inner] == 0.0) sum += entry.law.energy(gap(entry, motion).value);
    return sum;
  }
  void relax_inner(const Motion<double>* motion, double* inner) const override {
    for (const ElementData& entry : entries) inner[entry.inner] = entry.is_off_at(motion[entry.a], motion[entry.b]) ? 1.0 : 0.0;
  }
  double jump_inner(int element, UnitMode to, const Evaluation& e, double* inner) const override {
    const ElementData& entry = entries[element];
    const bool was_carried = inner[entry.inner] == 0.0;
    inner[entry.inner] = to == k_contact_off ? 1.0 : 0.0;
    // Only a foot that was pressed has elastic energy.
    return to == k_contact_off && was_carried ? entry.law.energy(gap(entry, e.motion).value) : 0.0;
  }
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries) {
      const UnitMode mode = law_mode(e.mode[entry.unit]);
      const Dual<12> f = add_pair_jacobian(
          entry.a, entry.b, entry.gap, e, [&](const Dual<12>& value, const Dual<12>& rate) { return entry.law.force(value, rate, mode); },
          out);
      out.back().contact = entry.contact;
      out.back().normal = f.d.matrix();
    }
  }
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
  }
  void register_turns(TurnTable& turns) const override {
    for (const ElementData& entry : entries) turns.add(entry.a, entry.b, turning_of(entry.gap));
  }
  void register_links(LinkTable& links) override {
    for (ElementData& entry : entries) entry.link = links.add(entry.a, entry.b);
  }
  [[nodiscard]] const GapSource* gap_source() const override { return this; }
  void add_gaps(const Motion<double>* motion, std::vector<GapBounds>& out) const override {
    for (const ElementData& entry : entries) {
      out.push_back(gap_bounds(entry.gap, entry.law.offset, motion[entry.a], motion[entry.b]));
      out.back().a = entry.a;
      out.back().b = entry.b;
    }
  }
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override {
    const auto m = measured(element, e);
    return closed_mode(element, e, entries[element].law.initial_mode(m.value, m.rate));
  }
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    if (mode == k_contact_off) return k_contact_open;
    if (slot == Law::k_event_count) return k_contact_off;
    const auto m = measured(element, e);
    const UnitMode next = entries[element].law.next_mode(mode, slot, m.value, m.rate, rounding_of(element, m, e));
    return mode == k_contact_open ? closed_mode(element, e, next) : next;
  }
  [[nodiscard]] bool is_armed_at_entry(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    if (mode == k_contact_off || slot == Law::k_event_count) return false;
    const auto m = measured(element, e);
    return steplap::is_armed_at_entry(entries[element].law, mode, slot, m.value, rounding_of(element, m, e));
  }
  [[nodiscard]] EventKind event_kind(UnitMode from, UnitMode to) const override {
    const UnitMode was = law_mode(from), is = law_mode(to);
    return was == is ? EventKind::none : Law::event_kind(was, is);
  }

  [[nodiscard]] MeasureValue<double> measured(int element, const Evaluation& e) const { return gap(entries[element], e.motion); }
  [[nodiscard]] double force_of(int element, const Evaluation& e) const {
    const auto m = measured(element, e);
    return entries[element].law.force(m.value, m.rate, law_mode(e.mode[entries[element].unit]));
  }
  [[nodiscard]] double along_of(int element, const Evaluation& e) const {
    const ElementData& entry = entries[element];
    return along(entry, e.motion[entry.a], e.motion[entry.b]).value;
  }

private:
  [[nodiscard]] double rounding_of(int element, const MeasureValue<double>& m, const Evaluation& e) const {
    return value_rounding(m, e.motion[entries[element].a], e.motion[entries[element].b]);
  }
  static void add_force(const ElementData& entry, Evaluation& e) {
    const Motion<double>& a = e.link_motion[entry.link];
    const auto m = entry.gap.template at<false, double>(a, Origin{});
    const UnitMode mode = e.mode[entry.unit], of_law = law_mode(mode);
    event_value(entry, m, along(entry, a, Origin{}), mode, e.event_value + entry.first_event, e.event_derivative + entry.first_event);
    const double f = entry.law.force(m.value, m.rate, of_law);
    e.contact_force[entry.contact] = f;
    if (f != 0.0) apply_force(e.link_force[entry.link], m, f);
    e.dissipation += (entry.law.elastic_force(m.value, of_law) - f) * m.rate;
  }
  static UnitMode law_mode(UnitMode mode) { return mode == k_contact_off ? k_contact_open : mode; }
  static MeasureValue<double> gap(const ElementData& entry, const Motion<double>* motion) {
    return entry.gap.template at<false, double>(motion[entry.a], motion[entry.b]);
  }
  template <class B> static MeasureValue<double> along(const ElementData& entry, const Motion<double>& a, const B& b) {
    return entry.slide().template at<false, double>(a, b);
  }
  [[nodiscard]] UnitMode closed_mode(int element, const Evaluation& e, UnitMode mode) const {
    if (mode == k_contact_open) return mode;
    return e.inner[entries[element].inner] == 0.0 && entries[element].is_on_face(along_of(element, e)) ? mode : k_contact_off;
  }
  static void event_value(const ElementData& entry, const MeasureValue<double>& m, const MeasureValue<double>& at, UnitMode mode,
                          double* event_value, double* rate) {
    std::fill_n(event_value, k_event_count, 1.0);
    std::fill_n(rate, k_event_count, std::numeric_limits<double>::quiet_NaN());
    if (mode == k_contact_off) {
      event_value[0] = entry.law.offset - m.value;
      rate[0] = -m.rate;
      return;
    }
    entry.law.event_value(m.value, m.rate, mode, event_value, rate);
    if (mode == k_contact_open) return;
    const double before = at.value - entry.low, after = entry.high - at.value;
    event_value[Law::k_event_count] = std::min(before, after);
    rate[Law::k_event_count] = before < after ? at.rate : -at.rate;
  }
};

} // namespace steplap
