// Friction of a step-lap joint: three rows that hold the limb, the limit surface of the overlapping sheets, which bounds their wrench, and
// the slip law (theory.md §4).
//
// Wrench W = (Fx, Fy, M) on the limb about its centre of gravity, slip twist ν = (vx, vy, ω) of the limb relative to the active part, both
// in the axes of the active part; ν is the rate of the rows.
//
//   stick   while u(W) ≤ 1 with the static coefficients
//   slip    W = −∇h(ν) with the kinetic coefficients, for the overlap at the present pose
//
// At ν = 0 the slip law is undefined, and near it its stiffness is (grip acceleration)/|ν|. This matters at the onset, after which |ν|
// grows only with the square of time. While a slip is starting, with |ν| below a few times δ = (grip acceleration) × (a time short compared
// with all others and set by the tolerance: 2.5e-6 s at 1e-6), the law is
//
//   W = −∇h(ν + δ (1 − |ν|²/(k δ)²)³ n),  n the normal of the limit surface at the onset.
//
// It has bounded stiffness, is exact at both ends of this range, dissipates energy consistently, and its influence vanishes as the
// direction settles. Afterwards the law is −∇h(ν).
//
// At the end of a slip |ν| becomes zero without a change of sign of any other quantity; the direction turns as a power of the remaining
// time and tends to a limit. A slip is ending below |ν| = ε = (grip acceleration) × (1e-8 s at tolerance 1e-6, 1e-11 s from 1e-9 on). There
// the law is −∇h(ν + ε n), with n the direction when it was last updated, and the slip ends when ν·n passes zero. If |ν| grows again, the
// slip continues. To allow steps through ν = 0, the law is continued to ν·n < 0 with constant wrench. Another event is ν leaving the cone
// of 60° about n; then n is updated and the slip continues. Derivation: docs/explanation/limit_surface.md, section 7. Methods get the
// required accuracy of velocities from slip_scale() and max_damping_rate().
//
// An elastic joint (make_elastic) does not use these laws. It is a spring, W = −K (s − p), with s the relative pose and p the slid part of
// it, an inner state. p moves only while u(W) = 1, along the normal n of the limit surface, at the rate that keeps W on it (associated,
// rate-independent flow):
//
//   ṗ = γ n,  γ (n·K n + u ∂h/∂p·n) = n·K ṡ,  h = h(n; p),
//
// with the overlap at p, since elastic shear of the sheets is not slip. It yields while γ ≥ 0 and holds while u ≤ 1. At a corner of the
// limit surface n is not determined by the wrench; n is then a state in addition to p and follows from the same condition (flow_along). The
// force is computed in step_lap_elastic.h. Derivation: docs/explanation/theory.md, "Elastic step-lap joints".
#pragma once

#include "elements/step_lap/patch/required_pressure.h"
#include "elements/step_lap/step_lap_interface.h"
#include "elements/step_lap/step_lap_loss.h"
#include "mbd/system/system.h"

namespace steplap {

/// Clamping pressures at one time: the pressure of each interface is multiplied by `factor` and by max(0, 1 + transverse · tilt)
/// (SheetPair::transverse).
struct PressureState {
  double factor = 1.0, tilt = 0.0;
  double factor_rate = 0.0, tilt_rate = 0.0;
  [[nodiscard]] bool operator==(const PressureState&) const = default;
};

/// Coefficients of friction: static (`holding`) or kinetic (`sliding`).
enum class GripLaw { holding, sliding };

/// Friction element of one step-lap joint.
class StepLapFriction final : public FrictionElement {
public:
  /// `index`: number of this element among the friction elements; `row`: its first index in Snapshot::friction_force. Without sheets, or as
  /// a monitor, it never slips.
  StepLapFriction(std::string name, int index, int row, std::vector<SheetPair> sheets, bool is_monitor, bool stops_when_apart);

  RowSpec hold[3]; ///< x and y in the axes of the active part, and the angle
  /// Centre of gravity and axes of the active part relative to those of its compiled body, in which all positions, wrenches and twists of
  /// this class are: zero for a body that moves, the pose in the ground for a fixed one.
  Pose part_frame;
  /// Returns a vector in the axes of the active part.
  [[nodiscard]] Vec2 in_part_axes(const Vec2& vector) const { return rotated(vector, -part_frame.theta); }
  /// Returns a point relative to the active part's centre of gravity, in its axes, m.
  [[nodiscard]] Vec2 in_part(const Vec2& point) const { return in_part_axes(point - Vec2(part_frame.x, part_frame.y)); }
  /// Sets the signals of PressureState: factor (1 − loss) · `factor`, and the acceleration across the sheets, m/s². Null: constant.
  void set_pressure(const Signal* factor, double loss, const Signal* acceleration);
  /// Returns the pressure factor and the acceleration across the sheets at time t, s. Throws NumericalFailure if the factor is not
  /// positive.
  [[nodiscard]] PressureState pressure_at(double t) const;
  [[nodiscard]] bool has_changing_pressure() const { return pressure_signal_ || acceleration_ || kept_ != 1.0; }
  /// Sets the points at which linear pressures have their nominal values: the centroids of the overlaps at this pose.
  void centre_pressures(const Pose& reference);
  /// Computes the scales of lengths and accelerations at the reference pose. Precondition: the rows are complete. `at_reference`:
  /// patch_at() of that pose for GripLaw::holding.
  void set_scales(const Pose& reference, Patch at_reference, const BodyData& limb, const BodyData& active_part);

  /// Makes the joint elastic with stiffness K about the limb's centre of gravity, axes of the active part. `inner`: first of its seven
  /// inner states (p, direction of slip, whether it has come apart); `unit`: unit of the force element.
  void make_elastic(const Mat3& stiffness, int inner, int unit);
  /// Returns the stiffness of springs distributed uniformly over all interfaces at a pose (equal interfaces count with their number);
  /// `total`: stiffness in translation, N/m.
  [[nodiscard]] Mat3 spread_stiffness(const Pose& pose, double total) const;

  // --- present state ----------------------------------------------------------------------------------
  [[nodiscard]] bool has_sheets() const { return !sheets_.empty(); }
  /// Returns one pair of sheets for each interface, in the order of the model.
  [[nodiscard]] const std::vector<SheetPair>& sheets() const { return sheets_; }
  /// Returns the pose of the limb relative to the active part.
  [[nodiscard]] Pose pose_of(const Motion<double>* motion) const;
  /// Returns the overlap area with its tractions at a pose.
  [[nodiscard]] Patch patch_at(const Pose& pose, GripLaw law) const;
  /// Returns, for the wrench in `s`, the utilisation of the capacity, the slip direction and the centre of rotation.
  [[nodiscard]] const RequiredPressure& usage(const Snapshot& s) const;
  /// Returns cheap bounds of the utilisation (usage()).
  [[nodiscard]] ValueBounds usage_between(const Snapshot& s) const;
  /// Returns the required pressure for `wrench`. Throws NumericalFailure, naming the joint, if the iteration does not converge.
  [[nodiscard]] RequiredPressure required(const Patch& patch, const Vec3& wrench, double t) const;
  /// Returns the sum of the overlap areas, m²; equal interfaces count once.
  [[nodiscard]] double area(const Snapshot& s) const;
  [[nodiscard]] const OverlapReference& overlaps() const { return overlaps_; }
  /// Returns the loss of overlap since the reference pose.
  [[nodiscard]] const OverlapLoss& loss(const Snapshot& s) const;
  /// Returns the wrench on the limb about its centre of gravity, axes of the active part.
  [[nodiscard]] Vec3 wrench(const Snapshot& s) const;
  /// Returns the slid pose: for an elastic joint the relative pose without the elastic strain.
  [[nodiscard]] Pose slid_pose(const Snapshot& s) const;
  /// Returns whether the joint is free, sticks or slips.
  [[nodiscard]] FrictionPhase phase(const Snapshot& s) const;

  // --- elastic joints -----------------------------------------------------------------------------------
  /// Yielding of an elastic joint.
  struct Flow {
    Vec3 rate = Vec3::Zero();      ///< rate ṗ of the slid pose
    double speed = 0.0;            ///< slip speed γ at the centre of the joint
    Vec3 direction = Vec3::Zero(); ///< unit direction n
    double resistance = 1.0;       ///< resistance to the slip n·K n + u ∂h/∂p·n
    double roundness = 1.0;        ///< roundness of the limit surface at n
    // Results of flow_along() for a given direction y:
    Vec3 turning = Vec3::Zero();  ///< rate of change ẏ of the direction
    Mat3 turn = Mat3::Zero();     ///< maps a residual wrench to ẏ
    Vec3 by_speed = Vec3::Zero(); ///< residual wrench per unit of speed
    double relaxation = 0.0;      ///< rate at which |y| returns to 1
  };
  /// Returns the flow under the force K (s − p), whose direction determines that of the slip. `slid`: slid pose p; `rate`: rate ṡ of the
  /// relative pose.
  [[nodiscard]] Flow flow_under(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& rate) const;
  /// Returns the flow under the same force at a corner of the limit surface, where the slip direction is a state y (scaled, |y| about 1).
  [[nodiscard]] Flow flow_along(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& direction, const Vec3& rate) const;
  /// Derivatives of ṗ (first three rows) and ẏ of flow_along().
  struct FlowSlopes {
    using Block = Eigen::Matrix<double, 6, 3>;
    Block by_slid = Block::Zero(), by_direction = Block::Zero(), by_rate = Block::Zero();
  };
  [[nodiscard]] FlowSlopes flow_slopes(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& direction,
                                       const Vec3& rate) const;
  /// Returns the unit direction y in which the joint yields under a force on the limit surface; zero if the joint has almost come apart.
  [[nodiscard]] Vec3 direction_of(const Evaluation& e, const Pose& slid, const Vec3& force) const;
  /// Returns the radius of curvature of the limit surface at direction y, relative to the capacity; small at a corner.
  [[nodiscard]] double roundness(const Evaluation& e, const Pose& slid, const Vec3& direction) const;
  /// Returns the force on the limit surface at which the joint yields along `direction`.
  [[nodiscard]] Vec3 bound_along(const Evaluation& e, const Pose& slid, const Vec3& direction) const;
  /// Returns 1 − u, or, far from the limit surface, a positive lower bound of it.
  [[nodiscard]] double spare(const Evaluation& e, const Pose& slid, const Vec3& wrench) const;
  /// Returns u of a joint that yields; 1 if the joint has almost come apart.
  [[nodiscard]] double yield_usage(const Evaluation& e, const Pose& slid, const Vec3& wrench) const;
  /// Returns the event function for the next separation of an interface; interfaces with a set bit in `parted` have already separated.
  [[nodiscard]] double parting(const Evaluation& e, const Pose& pose, std::uint32_t parted) const;
  /// Returns, for an elastic joint, the remaining capacity of its overlaps relative to the reference pose, minus the fraction at which it
  /// comes apart.
  [[nodiscard]] double grip_beyond_last(const Evaluation& e, const Pose& slid) const;
  /// Returns the separated interfaces as bits; sets `is_any_left` if some sheets overlap.
  [[nodiscard]] std::uint32_t parted_at(const Pose& pose, bool& is_any_left) const;
  [[nodiscard]] const Mat3& stiffness() const { return stiffness_; }
  [[nodiscard]] double gyration() const { return gyration_; }
  /// Returns a twist as the velocity of the joint's centre and ω times the radius of gyration.
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
  void stick_events(const Evaluation& e, const FrictionState& state, const double* wrench, double* event_value) const override;
  void set_onset_direction(const Evaluation& e, FrictionState& state, const double* wrench) const override;
  void aim(FrictionState& state, const double* rate) const override;
  void slip_events(const Evaluation& e, const FrictionState& state, const double* rate, double* event_value) const override;
  [[nodiscard]] SlipScale slip_scale(const Evaluation& e, const FrictionState& state, const double* rate) const override;
  [[nodiscard]] double max_damping_rate(const Evaluation& e, const FrictionState& state, const double* rate) const override;
  [[nodiscard]] bool continue_slip(const Evaluation& e, FrictionState& state, const double* rate, FrictionWatch fired) const override;
  [[nodiscard]] double contact_point_event(const Evaluation& e, const FrictionState& state) const override;
  void switch_contact_point(const Evaluation& e, FrictionState& state) const override;
  [[nodiscard]] EventKind contact_switch_event(const FrictionState& from, const FrictionState& to) const override {
    return (to.foot & ~from.foot) != 0 ? EventKind::loses_interface : EventKind::meets_interface;
  }
  [[nodiscard]] bool stops_when_apart() const override { return stops_when_apart_; }
  [[nodiscard]] BlockSolution solve_block(const Evaluation& e, const FrictionState& state, const double* a, const double* b,
                                          bool is_kinetic) const override;

private:
  struct Fit;
  struct Scratch;
  [[nodiscard]] Fit& fit(FrictionScratch* const* scratch, const Pose& pose, GripLaw law, double tilt) const;
  [[nodiscard]] Pose anchor(const RowBase* bases) const;
  [[nodiscard]] Pose present(const Snapshot& s) const;
  void build(const Pose& pose, GripLaw law, double tilt, OverlapWorkspace& workspace, Region& region, Patch& patch) const;
  void add_pressed(const SheetPair& sheets, const Region& region, GripLaw law, double tilt, Patch& patch) const;
  [[noreturn]] void refuse_pressure() const;
  [[nodiscard]] Vec3 gradient_at(const Pose& pose, double tilt, const Vec3& nu, Scratch& own) const;
  [[nodiscard]] bool has_separated(const Fit& f) const;
  struct FlowQuestion;
  [[nodiscard]] Flow find_flow_along(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& direction,
                                     const Vec3& rate) const;
  [[noreturn]] void refuse_snap(double t) const;
  [[nodiscard]] Vec3 unscaled(const Vec3& y) const;
  [[nodiscard]] Dissipation friction_along(const Patch& patch, const Vec3& y, bool with_curvature) const;
  [[nodiscard]] bool has_usage_for(const Snapshot& s, const Vec3& wrench) const;
  [[nodiscard]] RequiredPressure usage_of_slip(const Snapshot& s, const Pose& pose) const;
  [[nodiscard]] double depth_of(std::size_t i, const Pose& pose, OverlapWorkspace& workspace) const;
  void set_direction(FrictionState& state, const Vec3& nu) const;
  [[nodiscard]] double onset_speed(const Evaluation& e) const;
  [[nodiscard]] Vec3 law_twist(const Evaluation& e, const FrictionState& state, const Vec3& nu) const;
  [[nodiscard]] double end_speed(const Evaluation& e) const;

  static constexpr std::size_t k_tracked = 30; ///< largest number of interfaces whose separation is an event

  std::shared_ptr<const Fit> reference_; ///< patch and capacity in the reference pose, where most joints stay; shared by copies
  std::string name_;
  int index_ = 0, row_ = 0;
  std::vector<SheetPair> sheets_;
  OverlapReference overlaps_; ///< overlaps in the reference pose
  bool is_monitor_ = false, stops_when_apart_ = true;
  bool is_one_law_ = true;               ///< static and kinetic coefficients are equal
  Vec2 arm_ = Vec2::Zero();              ///< from the limb's centre of gravity to the centre of the joint, m
  double gyration_ = 1.0;                ///< radius of gyration of the traction about the centre of the joint, m
  double grip_acceleration_ = 1.0;       ///< approximate largest acceleration by friction, m/s²
  double limb_mobility_[2] = {0.0, 0.0}; ///< 1/mass, 1/kg, and 1/inertia, 1/(kg m²), of the limb
  double part_mobility_[2] = {0.0, 0.0};
  const Signal* pressure_signal_ = nullptr;
  const Signal* acceleration_ = nullptr;
  double kept_ = 1.0;                                               ///< fraction of the pressures that remains after relaxation
  int inner_ = -1, unit_ = -1;                                      ///< first inner state and unit of an elastic joint; −1: not elastic
  Mat3 stiffness_ = Mat3::Zero(), scaled_stiffness_ = Mat3::Zero(); ///< stiffness K; scaled_stiffness_: K for scaled twists
  double slip_usage_ = 1.0;       ///< u while sliding: the ratio of the coefficients; NaN if interfaces have different ratios
  std::vector<DepthBound> depth_; ///< per interface: lower bound of its depth from the reference pose
};

} // namespace steplap
