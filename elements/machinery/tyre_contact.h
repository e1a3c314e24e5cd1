// Forces of tyres (tyre.h): normal force and tread as force elements with modes and one inner state.
//
// The inner state is p, with u = s − p, and s the distance travelled by the centre along the road (RoadWay; for a flat road the coordinate
// along it) + r (θ_A − θ_B). s is a function of the pose whose gradient is the direction of the tread force, so that at rest the tread is a
// spring between positions. ṗ is ṡ − u̇.
#pragma once

#include "elements/contact_laws.h"
#include "elements/machinery/road.h"
#include "mbd/system/sliding_units.h"
#include "mbd/system/turn_table.h"

#include <memory>

namespace steplap {

/// Motion of a wheel relative to its road.
template <class S> struct WheelMotion {
  MeasureValue<S> gap;   ///< distance of the centre from the road, m, along the road's normal
  MeasureValue<S> tread; ///< position s along the road, m, and its direction
  S slip_rate{0.0};      ///< slip velocity v_s, m/s
  S rolling{0.0};        ///< rolling velocity r ω, m/s
};

/// Geometry of a wheel on its road.
struct WheelMeasure {
  Vec2 centre, origin, level; ///< centre in the frame of a; origin and direction (unit vector) of the road in that of b
  double radius = 0.0;        ///< radius of the wheel, m
  std::shared_ptr<const Road> road;

  template <class S, class B> [[nodiscard]] WheelMotion<S> at(const Motion<S>& a, const B& b) const {
    using std::sqrt;
    const Pair<S> ra = to_ground(a, centre), e = to_ground(b, level), up = perp(e);
    const Pair<S> reach = offset(a, b) + ra, from_origin = reach - Pair<S>(to_ground(b, origin));
    const Pair<S> velocity = point_velocity(a, ra) - point_velocity(b, reach); // velocity of the centre relative to b
    const S x = dot(e, from_origin), y = dot(up, from_origin);
    const RoadPoint<S> foot = road->nearest(x, y);
    const S inverse = S(1.0) / sqrt(S(1.0) + foot.slope * foot.slope);
    const Pair<S> along = inverse * (e + foot.slope * up), normal = perp(along);
    WheelMotion<S> w;
    w.gap.value = dot(normal, from_origin - foot.x * e - foot.height * up);
    w.gap.rate = dot(normal, velocity);
    w.gap.direction = normal;
    w.gap.lever_a = w.tread.lever_a = ra;
    w.gap.lever_b = w.tread.lever_b = reach;
    w.rolling = S(radius) * relative_spin(a, b);
    const RoadWay<S> way = road->way(x, y, radius, value_of(foot.x));
    w.tread.value = way.value + S(radius) * relative_angle(a, b);
    w.tread.rate = way.by_x * dot(e, velocity) + way.by_y * dot(up, velocity) + w.rolling;
    w.tread.direction = along;
    w.tread.couple = S(radius);
    w.slip_rate = dot(along, velocity) + w.rolling;
    return w;
  }
};

/// Parameters of the tread.
struct TreadLaw {
  double friction = 0.0;   ///< coefficient of friction μ
  double stiffness = 0.0;  ///< stiffness C/σ, N/m
  double damping = 0.0;    ///< damping b, N s/m
  double relaxation = 1.0; ///< relaxation length σ, m

  /// Returns the rolling velocity V up to which the damping b is used, 4 C/b, m/s; above it the damping is 4 C/V.
  [[nodiscard]] double slow() const { return 4.0 * stiffness * relaxation / damping; }
};

/// Forces, N, and deflection, m and m/s, of the bristles at one time.
template <class S> struct TreadState {
  S most{0.0};  ///< bound μ N
  S trial{0.0}; ///< force T required for adhesion
  S force{0.0}; ///< tread force T
  S bent{0.0};  ///< deflection u
  S rate{0.0};  ///< its rate u̇
};

/// All tyres, as one force group.
class TyreGroup final : public ForceGroup, public GapSource, public SlidingUnits {
public:
  struct ElementData {
    int a = k_ground, b = k_ground;
    WheelMeasure measure;
    KelvinVoigtContact press; ///< radial contact law, for the distance of the centre
    TreadLaw tread;
    int inner = 0; ///< index of the inner state p
    int link = 0, unit = 0, first_event = 0, contact = 0;
  };
  /// Two event functions of the contact, two of the tread, one for the direction of rotation, one for its speed.
  static constexpr int k_event_count = 6;
  std::vector<ElementData> entries;

  void add_forces(Evaluation& e) const override;
  [[nodiscard]] double potential(const Motion<double>* motion) const override;
  [[nodiscard]] double inner_energy(const Motion<double>* motion, const double* inner) const override;
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override;
  void add_inner_jacobian(const Evaluation& e, std::vector<InnerJacobian>& out) const override;
  void relax_inner(const Motion<double>* motion, double* inner) const override;
  void mark_bodies(std::vector<char>& is_used) const override;
  void register_turns(TurnTable& turns) const override;
  void register_links(LinkTable& links) override;
  [[nodiscard]] const GapSource* gap_source() const override { return this; }
  void add_gaps(const Motion<double>* motion, std::vector<GapBounds>& out) const override;
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override;
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override;
  [[nodiscard]] bool is_armed_at_entry(int element, UnitMode mode, int slot, const Evaluation& e) const override;
  [[nodiscard]] EventTolerance event_tolerance(int slot) const override;
  [[nodiscard]] EventKind event_kind(UnitMode from, UnitMode to) const override;
  [[nodiscard]] EventKind sliding_in(UnitMode mode) const override;

  /// Values for channels.
  [[nodiscard]] WheelMotion<double> measured(int element, const Evaluation& e) const;
  [[nodiscard]] double normal_force(int element, const Evaluation& e) const;
  [[nodiscard]] TreadState<double> tread_state(int element, const Evaluation& e) const;
};

/// Returns true if the tyre is pressed in this mode.
[[nodiscard]] inline bool tyre_presses(UnitMode mode) { return (mode & 3U) == k_contact_pressed; }
/// Returns true if the tread slides in this mode. Precondition: tyre_presses(mode).
[[nodiscard]] inline bool tread_slides(UnitMode mode) { return (mode >> 2U & 3U) != 0; }

} // namespace steplap
