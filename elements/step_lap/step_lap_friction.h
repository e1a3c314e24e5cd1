// The friction of a step-lap joint: three rows that hold the limb, the limit surface of the overlapping
// sheets that bounds their wrench, and the slip law (physics.md §4).
//
// Wrench W = (Fx, Fy, M) on the limb about its centre of gravity and slip twist ν = (vx, vy, ω) of the
// limb relative to the active part, both in the active part's axes; ν is the rate of the rows.
//   Sticks while u(W) ≤ 1 by the static coefficients; slides with W = −∇h(ν) by the kinetic ones, the
//   overlap taken at the present pose.
//
// At ν = 0 the law has no value, and near it a stiffness of (grip acceleration)/|ν|. After an onset
// |ν| grows as the square of time only, so that it matters there. While a slip is *starting*,
// |ν| below a few times δ = (grip acceleration) × (a time short against all else, after the tolerance: 2.5e-6 s at 1e-6), the law is
//   W = −∇h(ν + δ (1 − |ν|²/(k δ)²)³ n),  n the normal of the bound at the onset,
// which is bounded in stiffness, exact at both ends, dissipates what it does work on (no energy is lost
// from the account), and whose influence is forgotten as the direction settles. Beyond, and for good, it
// is −∇h(ν) alone.
//
// |ν| reaches zero with no sign change of anything but ν itself; on the way the direction turns as a power of
// the time left and tends to a limit. A slip is *ending* below |ν| = ε = (grip acceleration) × (1e-8 s at 1e-6, 1e-11 s from 1e-9 on): the law is
// −∇h(ν + ε n), n the direction there, and the slip is at rest where ν·n passes zero. If |ν| grows again instead, the
// slip goes on. So that a step may pass through ν = 0, the law is continued there with the wrench it
// had, ν·n < 0, n being the direction as last looked at. An event is also where ν leaves the cone of 60°
// about n: n is taken anew and the slip goes on. All of this is derived in docs/explanation/limit_surface.md, section 7; methods
// learn how fine velocities have to be known from slip_scale() and decay_rate().
//
// An *elastic* joint (make_elastic) neither sticks nor slides by these laws: it is a spring, W = −K (s − p), s the
// relative pose and p the pose as far as the sheets have slid, an inner state. p moves only while u(W) = 1, along the
// normal n of the limit surface and as fast as keeps W on it (associated flow, rate-independent):
//   ṗ = γ n,  γ (n·K n + u ∂h/∂p·n) = n·K ṡ,  h = h(n; p),
// the overlap being the one at p: what the sheets are sheared by is no slip. It *yields* (slips) while γ ≥ 0, holds while
// u ≤ 1. At a corner of the limit surface, where the wrench hardly tells n, n is a state beside p and follows from the same
// condition (flow_along). The force is that of step_lap_elastic.h. Derived in docs/explanation/theory.md, "Elastic step-lap joints".
#pragma once

#include "elements/step_lap/patch/required_pressure.h"
#include "elements/step_lap/step_lap_interface.h"
#include "elements/step_lap/step_lap_loss.h"
#include "mbd/system/system.h"

namespace steplap {

/// What the clamping pressures are like at a time: all are multiplied by `factor`, each once more by
/// 1 + transverse · tilt (SheetPair::transverse), at least 0.
struct PressureState {
  double factor = 1.0, tilt = 0.0;
  double factor_rate = 0.0, tilt_rate = 0.0;
  [[nodiscard]] bool operator==(const PressureState&) const = default;
};

/// Which coefficients count.
enum class GripLaw { holding, sliding };

class StepLapFriction final : public FrictionElement {
public:
  /// `index` among the friction elements, `row` its slot in Snapshot::friction_force. Without sheets,
  /// or as a monitor, it holds whatever it takes.
  StepLapFriction(std::string name, int index, int row, std::vector<SheetPair> sheets, bool is_monitor, bool stops_when_apart);

  RowSpec hold[3]; ///< x and y in the active part's axes, angle
  /// Signals of PressureState: factor (1 − loss) · `factor`, acceleration across the sheets; null where there is none.
  void set_pressure(const Signal* factor, double loss, const Signal* acceleration);
  [[nodiscard]] PressureState pressure_at(double t) const;
  [[nodiscard]] bool has_changing_pressure() const { return pressure_signal_ || acceleration_ || kept_ != 1.0; }
  /// Where linear pressures are what their interfaces say: at the middles of the overlaps at this pose.
  void centre_pressures(const Pose& reference);
  /// To be called when the rows are complete: scales of lengths and accelerations at this pose, of which `at_reference` is
  /// patch_at() for what holds.
  void set_scales(const Pose& reference, Patch at_reference, const BodyData& limb, const BodyData& active_part);

  /// K about the limb's centre of gravity in the active part's axes; `inner`: first of seven inner states: p, the direction of slip, whether it is apart; `unit`: of
  /// the force element that gives its wrench.
  void make_elastic(const Mat3& stiffness, int inner, int unit);
  /// Of springs spread evenly over all interfaces at a pose (each as often as it is counted), `total` N/m in translation.
  [[nodiscard]] Mat3 spread_stiffness(const Pose& pose, double total) const;

  // --- what the joint is like now -------------------------------------------------------------------
  [[nodiscard]] bool has_sheets() const { return !sheets_.empty(); }
  /// One pair for each interface, in the order of the model.
  [[nodiscard]] const std::vector<SheetPair>& sheets() const { return sheets_; }
  [[nodiscard]] Pose pose_of(const Motion<double>* motion) const;
  /// The overlapping area with its tractions at a pose.
  [[nodiscard]] Patch patch_at(const Pose& pose, GripLaw law) const;
  /// Of the wrench in `s`: share of the capacity, direction, centre of rotation.
  [[nodiscard]] const RequiredPressure& usage(const Snapshot& s) const;
  /// Bounds of its share, which cost little.
  [[nodiscard]] ValueBounds usage_between(const Snapshot& s) const;
  /// Throws NumericalFailure, naming the joint, where an iteration has ended too far from its solution.
  [[nodiscard]] RequiredPressure required(const Patch& patch, const Vec3& wrench, double t) const;
  [[nodiscard]] double area(const Snapshot& s) const;
  [[nodiscard]] const OverlapReference& overlaps() const { return overlaps_; }
  [[nodiscard]] const OverlapLoss& loss(const Snapshot& s) const;
  /// On the limb about its centre of gravity, active part's axes.
  [[nodiscard]] Vec3 wrench(const Snapshot& s) const;
  /// By how much it has slid: the pose, of an elastic joint without what it is strained by.
  [[nodiscard]] Pose slid_pose(const Snapshot& s) const;
  [[nodiscard]] FrictionPhase phase(const Snapshot& s) const;

  // --- of an elastic joint ------------------------------------------------------------------------------
  /// How it yields: the rate ṗ, and γ, the speed of slip at the joint's centre.
  struct Flow {
    Vec3 rate = Vec3::Zero();
    double speed = 0.0;
    Vec3 direction = Vec3::Zero(); ///< n
    double resistance = 1.0;       ///< n·K n + u ∂h/∂p·n
    double roundness = 1.0;        ///< of the limit surface there
    // Along a direction y that is given:
    Vec3 turning = Vec3::Zero();  ///< ẏ
    Mat3 turn = Mat3::Zero();     ///< from wrenches that are left over to ẏ
    Vec3 by_speed = Vec3::Zero(); ///< such a wrench, of a unit of speed
    double relaxation = 0.0;      ///< rate at which |y| goes back to 1
  };
  /// In the direction that the force K (s − p) tells; `rate`: ṡ.
  [[nodiscard]] Flow flow_under(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& rate) const;
  /// Along y (scaled, |y| about 1), of which that force is the bound's.
  [[nodiscard]] Flow flow_along(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& direction, const Vec3& rate) const;
  /// What ṗ (first three rows) and ẏ of that change by.
  struct FlowSlopes {
    using Block = Eigen::Matrix<double, 6, 3>;
    Block by_slid = Block::Zero(), by_direction = Block::Zero(), by_rate = Block::Zero();
  };
  [[nodiscard]] FlowSlopes flow_slopes(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& direction,
                                       const Vec3& rate) const;
  /// The unit direction y in which a force on the bound makes it yield; zero where it is as good as parted.
  [[nodiscard]] Vec3 direction_of(const Evaluation& e, const Pose& slid, const Vec3& force) const;
  /// By how much, of what it can bear, the wrench turns at least as y does: the radius of the limit surface there, small at a corner.
  [[nodiscard]] double roundness(const Evaluation& e, const Pose& slid, const Vec3& direction) const;
  /// The force on the bound that makes it yield along y.
  [[nodiscard]] Vec3 bound_along(const Evaluation& e, const Pose& slid, const Vec3& direction) const;
  /// 1 − u or, far from the bound, less that is certain.
  [[nodiscard]] double spare(const Evaluation& e, const Pose& slid, const Vec3& wrench) const;
  /// u of a joint that yields; 1 where it is as good as parted.
  [[nodiscard]] double yield_usage(const Evaluation& e, const Pose& slid, const Vec3& wrench) const;
  /// Watch value of the interfaces that are parted (bits) or not.
  [[nodiscard]] double parting(const Evaluation& e, const Pose& pose, std::uint32_t parted) const;
  /// Of an elastic joint: share of its capacity that overlaps leave, less that at which it has come apart.
  [[nodiscard]] double grip_beyond_last(const Evaluation& e, const Pose& slid) const;
  /// Those that are, as bits; `is_any_left`: do sheets overlap anywhere?
  [[nodiscard]] std::uint32_t parted_at(const Pose& pose, bool& is_any_left) const;
  [[nodiscard]] const Mat3& stiffness() const { return stiffness_; }
  [[nodiscard]] double gyration() const { return gyration_; }
  /// A twist as velocity of the joint's centre, and ω as a velocity at the gyration radius.
  [[nodiscard]] Vec3 scaled(const Vec3& nu) const;

  // --- FrictionElement --------------------------------------------------------------------------------
  [[nodiscard]] int dimension() const override { return 3; }
  [[nodiscard]] const RowSpec* rows(const FrictionState&) const override { return hold; }
  [[nodiscard]] bool is_rigid() const override { return !is_elastic(); }
  [[nodiscard]] bool is_elastic() const override { return inner_ >= 0; }
  [[nodiscard]] bool never_slips() const override { return is_monitor_ || sheets_.empty(); }
  void mark_bodies(std::vector<char>&) const override {}
  [[nodiscard]] std::unique_ptr<FrictionScratch> make_scratch() const override;
  [[nodiscard]] bool is_loaded(const Evaluation&, const FrictionState&) const override { return !is_elastic(); }
  void slip_wrench(const Evaluation& e, const FrictionState& state, const double* rate, double* wrench) const override;
  [[nodiscard]] double support(const Evaluation& e, const FrictionState& state, const double* rate) const override;
  [[nodiscard]] double gauge(const Evaluation& e, const FrictionState& state, const double* wrench, double* normal) const override;
  void watch_stick(const Evaluation& e, const FrictionState& state, const double* wrench, double* watch) const override;
  void begin_slip(const Evaluation& e, FrictionState& state, const double* wrench) const override;
  void aim(FrictionState& state, const double* rate) const override;
  void watch_slip(const Evaluation& e, const FrictionState& state, const double* rate, double* watch) const override;
  [[nodiscard]] SlipScale slip_scale(const Evaluation& e, const FrictionState& state, const double* rate) const override;
  [[nodiscard]] double decay_rate(const Evaluation& e, const FrictionState& state, const double* rate) const override;
  [[nodiscard]] bool goes_on_slipping(const Evaluation& e, FrictionState& state, const double* rate, int slot) const override;
  [[nodiscard]] double watch_place(const Evaluation& e, const FrictionState& state) const override;
  void change_place(const Evaluation& e, FrictionState& state) const override;
  [[nodiscard]] EventKind place_change(const FrictionState& from, const FrictionState& to) const override {
    return (to.foot & ~from.foot) != 0 ? EventKind::loses_interface : EventKind::meets_interface;
  }
  [[nodiscard]] bool stops_when_apart() const override { return stops_when_apart_; }
  [[nodiscard]] FrictionBlock solve_block(const Evaluation& e, const FrictionState& state, const double* a, const double* b,
                                          bool is_kinetic) const override;

private:
  struct Fit;
  struct Scratch;
  [[nodiscard]] Fit& fit(FrictionScratch* const* scratch, const Pose& pose, GripLaw law, double tilt) const;
  [[nodiscard]] Pose anchor(const double* memory) const;
  [[nodiscard]] Pose present(const Snapshot& s) const;
  void build(const Pose& pose, GripLaw law, double tilt, OverlapWorkspace& workspace, Region& region, Patch& patch) const;
  void add_pressed(const SheetPair& sheets, const Region& region, GripLaw law, double tilt, Patch& patch) const;
  [[noreturn]] void refuse_pressure() const;
  [[nodiscard]] Vec3 gradient_at(const Pose& pose, double tilt, const Vec3& nu, Scratch& own) const;
  [[nodiscard]] bool has_let_go(const Fit& f) const;
  struct FlowQuestion;
  [[nodiscard]] Flow find_flow_along(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& direction,
                                     const Vec3& rate) const;
  [[noreturn]] void refuse_snap(double t) const;
  [[nodiscard]] Vec3 unscaled(const Vec3& y) const;
  [[nodiscard]] Dissipation friction_along(const Patch& patch, const Vec3& y, bool with_curvature) const;
  [[nodiscard]] bool knows_usage(const Snapshot& s, const Vec3& wrench) const;
  [[nodiscard]] RequiredPressure usage_of_slip(const Snapshot& s, const Pose& pose) const;
  [[nodiscard]] double depth_of(std::size_t i, const Pose& pose, OverlapWorkspace& workspace) const;
  void set_direction(FrictionState& state, const Vec3& nu) const;
  [[nodiscard]] double onset_speed(const Evaluation& e) const;
  [[nodiscard]] Vec3 law_twist(const Evaluation& e, const FrictionState& state, const Vec3& nu) const;
  [[nodiscard]] double end_speed(const Evaluation& e) const;

  static constexpr std::size_t k_tracked = 30; ///< interfaces whose parting is an event of its own

  std::shared_ptr<const Fit> reference_; ///< in the reference pose, where most joints stay: made once
  std::string name_;
  int index_ = 0, row_ = 0;
  std::vector<SheetPair> sheets_;
  OverlapReference overlaps_; ///< in the reference pose
  bool is_monitor_ = false, stops_when_apart_ = true;
  bool is_one_law_ = true;               ///< static and kinetic coefficients are the same
  Vec2 arm_ = Vec2::Zero();              ///< from the limb's centre of gravity to the joint's centre, m
  double gyration_ = 1.0;                ///< of the traction about the joint's centre, m
  double grip_acceleration_ = 1.0;       ///< about the largest that it can give, m/s²
  double limb_mobility_[2] = {0.0, 0.0}; ///< 1/mass, 1/inertia
  double part_mobility_[2] = {0.0, 0.0};
  const Signal* pressure_signal_ = nullptr;
  const Signal* acceleration_ = nullptr;
  double kept_ = 1.0;                                               ///< share of the pressures that relaxation leaves
  int inner_ = -1, unit_ = -1;                                      ///< of an elastic joint
  Mat3 stiffness_ = Mat3::Zero(), scaled_stiffness_ = Mat3::Zero(); ///< the second by scaled twists
  double slip_usage_ = 1.0;       ///< u of what slides: the ratio of its coefficients; not-a-number where interfaces differ in it
  std::vector<DepthBound> depth_; ///< by interface, from the reference pose
};

} // namespace steplap
