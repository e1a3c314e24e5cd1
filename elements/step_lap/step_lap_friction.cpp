#include "elements/step_lap/step_lap_friction.h"

#include "elements/step_lap/patch/admissible_projection.h"
#include "elements/step_lap/step_lap_elastic.h"
#include "elements/step_lap/step_lap_fit.h"
#include "mbd/base/diagnostics.h"
#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace steplap {

namespace {

// Excess of u over 1 that counts as rounding; it is below the resolution of a load.
constexpr double k_bound_slack = 1e-13;
// Range of u in which the joint is evaluated exactly; outside it the cheap certified bounds decide whether the joint sticks.
constexpr double k_surely_holds = 0.9, k_surely_slips = 1.1;
// Remaining capacity of the overlaps, relative to the reference pose, below which an elastic joint counts as separated. The direction of
// flow relaxes within a displacement F/(K |ν|), which tends to zero with the overlap, so that steps would become ever shorter.
constexpr double k_last_grip = 1e-2;
constexpr double k_surely_overlap = 0.25; // depth relative to the reference pose above which a lower bound of the depth suffices

// Largest permitted residuals of iterations, relative to the capacity. The error of u is their square, 1e-14, so decisions based on u are
// not affected. The direction in which a slip begins has an error of 1e-7, which has no effect once the slip has started. A wrench of the
// mode problem may differ by the fluctuation of blocks of other joints.
constexpr double k_usage_residual = 1e-7, k_block_residual = 1e-9;

void insist(double residual, double bound, const std::string& name, double t, const char* what) {
  if (residual <= bound) return;
  std::ostringstream message;
  message.precision(12);
  message << "step_lap_joint '" << name << "', t = " << t << " s: " << what << " is known only to " << residual
          << " of the joint's capacity, which is not enough: its sheets overlap in slivers, or its wrench is infinite";
  throw NumericalFailure(message.str());
}

} // namespace

StepLapFriction::StepLapFriction(std::string name, int index, int row, std::vector<SheetPair> sheets, bool is_monitor,
                                 bool stops_when_apart)
    : name_(std::move(name)), index_(index), row_(row), sheets_(std::move(sheets)), is_monitor_(is_monitor),
      stops_when_apart_(stops_when_apart) {
  constexpr double k_same_ratio = 4e-16; // relative difference of quotients of equal coefficients: rounding
  bool is_first = true;
  for (const SheetPair& s : sheets_) {
    if (s.kinetic_traction != s.static_traction) is_one_law_ = false;
    if (s.kinetic_traction == 0.0 && s.static_traction == 0.0) continue;
    const double ratio = s.kinetic_traction / s.static_traction;
    if (std::exchange(is_first, false)) slip_usage_ = ratio;
    else if (!(std::abs(ratio - slip_usage_) <= k_same_ratio * slip_usage_)) slip_usage_ = std::numeric_limits<double>::quiet_NaN();
  }
  if (is_one_law_) slip_usage_ = 1.0;
}

std::unique_ptr<FrictionScratch> StepLapFriction::make_scratch() const {
  if (sheets_.empty()) return nullptr;
  auto scratch = std::make_unique<Scratch>();
  if (reference_) scratch->fits[0] = *reference_;
  return scratch;
}

void StepLapFriction::set_scales(const Pose& reference, Patch at_reference, const BodyData& limb, const BodyData& active_part) {
  if (at_reference.empty()) return;
  auto fit = std::make_shared<Fit>(); // fit in the reference pose, without acceleration across the sheets
  fit->patch = std::move(at_reference);
  const Patch& patch = fit->patch;
  fit->pose = reference;
  fit->is_valid = true;
  if (!never_slips()) fit->prepare();
  reference_ = std::move(fit);
  overlaps_ = OverlapReference(sheets_, reference);
  OverlapWorkspace workspace;
  for (const SheetPair& s : sheets_) depth_.push_back(depth_bound(s.yoke, s.limb, reference, workspace));
  arm_ = patch.centroid() - patch.reference();
  gyration_ = patch.gyration();
  const auto mobility = [&](const BodyData& body, const Vec2& lever) {
    if (!(body.mass > 0.0)) return 0.0;
    return 1.0 / body.mass + (gyration_ * gyration_ + lever.squaredNorm()) / body.inertia;
  };
  const auto take = [](const BodyData& body, double* inverse) {
    inverse[0] = body.mass > 0.0 ? 1.0 / body.mass : 0.0;
    inverse[1] = body.mass > 0.0 ? 1.0 / body.inertia : 0.0;
  };
  take(limb, limb_mobility_);
  take(active_part, part_mobility_);
  // Based on the limb, the lighter body, because it is not known here whether the active part is free, driven or guided by joints.
  const double of_limb = mobility(limb, arm_);
  grip_acceleration_ = patch.force() * (of_limb > 0.0 ? of_limb : mobility(active_part, patch.centroid()));
}

// --- pose and overlap -----------------------------------------------------------------------------------

Pose StepLapFriction::pose_of(const Motion<double>* motion) const {
  const Motion<double>&l = motion[hold[0].a], &p = motion[hold[0].b];
  const double x = l.x - p.x, y = l.y - p.y;
  return {p.c * x + p.s * y, p.c * y - p.s * x, l.theta - p.theta};
}

// While the joint sticks its pose is that of its anchors, without the rounding errors of positions.
Pose StepLapFriction::anchor(const RowBase* bases) const {
  return {bases[hold[0].base].value, bases[hold[1].base].value, bases[hold[2].base].value};
}

Pose StepLapFriction::present(const Snapshot& s) const {
  if (is_elastic()) return slid_pose(s);
  const bool is_stuck = s.evaluation->friction[index_].phase == FrictionPhase::stick;
  return is_stuck ? anchor(s.evaluation->bases) : pose_of(s.motion);
}

void StepLapFriction::build(const Pose& pose, GripLaw law, double tilt, OverlapWorkspace& workspace, Region& region, Patch& patch) const {
  patch.clear({pose.x, pose.y});
  for (const SheetPair& s : sheets_) {
    intersect(s.yoke, s.limb, pose, workspace, region);
    add_pressed(s, region, law, tilt, patch);
  }
}

void StepLapFriction::add_pressed(const SheetPair& s, const Region& region, GripLaw law, double tilt, Patch& patch) const {
  const double traction = traction_of(s, law, tilt);
  if (s.gradient.isZero(0.0)) return patch.add(region, traction);
  for (const Polygon& piece : region) {
    const double at_centroid = 1.0 + s.gradient.dot(steplap::centroid(piece) - s.middle);
    try {
      patch.add(piece, Traction{traction * at_centroid, traction * s.gradient});
    } catch (const std::invalid_argument&) {
      refuse_pressure();
    }
  }
}

void StepLapFriction::refuse_pressure() const {
  throw NumericalFailure("step_lap_joint '" + name_ + "': its linear pressure is negative somewhere in the overlap");
}

void StepLapFriction::centre_pressures(const Pose& reference) {
  OverlapWorkspace workspace;
  Region region;
  for (SheetPair& s : sheets_) {
    if (s.gradient.isZero(0.0)) continue;
    intersect_exactly(s.yoke, s.limb, reference, workspace, region);
    if (!region.empty()) s.middle = steplap::centroid(region);
  }
}

void StepLapFriction::set_pressure(const Signal* factor, double loss, const Signal* acceleration) {
  pressure_signal_ = factor;
  kept_ = 1.0 - loss;
  acceleration_ = acceleration;
}

// Tractions are n μ (p f + c a) = n μ p f (1 + (c/p) a/f), with pressure p, factor f, and change of pressure c by the acceleration a.
PressureState StepLapFriction::pressure_at(double t) const {
  PressureState now;
  now.factor = kept_;
  if (pressure_signal_) {
    now.factor *= pressure_signal_->value(t);
    now.factor_rate = kept_ * pressure_signal_->drive(t, DriveLevel::position).rate;
    if (!(now.factor > 0.0))
      throw NumericalFailure("step_lap_joint '" + name_ + "', t = " + number_text(t) + " s: the factor of its pressures is " +
                             number_text(now.factor) + ": it has to stay above zero");
  }
  if (!acceleration_) return now;
  now.tilt = acceleration_->value(t) / now.factor;
  now.tilt_rate = (acceleration_->drive(t, DriveLevel::position).rate - now.tilt * now.factor_rate) / now.factor;
  return now;
}

Patch StepLapFriction::patch_at(const Pose& pose, GripLaw law) const {
  OverlapWorkspace workspace;
  Region region;
  Patch patch({pose.x, pose.y});
  for (const SheetPair& s : sheets_) {
    intersect_exactly(s.yoke, s.limb, pose, workspace, region);
    add_pressed(s, region, law, 0.0, patch);
  }
  return patch;
}

StepLapFriction::Fit& StepLapFriction::fit(FrictionScratch* const* scratch, const Pose& pose, GripLaw law, double tilt) const {
  auto& own = static_cast<Scratch&>(*scratch[index_]);
  Fit& f = own.fits[is_one_law_ || law == GripLaw::holding ? 0 : 1];
  const bool is_same = f.is_valid && f.pose.x == pose.x && f.pose.y == pose.y && f.pose.theta == pose.theta && f.tilt == tilt;
  if (is_same) return f;
  const bool is_reference = &f == &own.fits[0] && reference_ && reference_->tilt == tilt && reference_->pose.x == pose.x &&
                            reference_->pose.y == pose.y && reference_->pose.theta == pose.theta;
  if (is_reference) return f = *reference_; // the stored data of the reference pose do not depend on poses evaluated before
  build(pose, law, tilt, own.workspace, own.region, f.patch);
  f.pose = pose;
  f.tilt = tilt;
  f.is_valid = true;
  f.has_capacity = f.has_table = false;
  return f;
}

RequiredPressure StepLapFriction::required(const Patch& patch, const Vec3& wrench, double t) const {
  const RequiredPressure found = required_pressure(patch, wrench);
  if (!wrench.allFinite()) return found; // stage of a step that is too long and will be rejected
  insist(found.residual, k_usage_residual, name_, t, "the share of its capacity in use");
  return found;
}

// --- sticking

void StepLapFriction::stick_events(const Evaluation& e, const FrictionState&, const double* wrench, double* event_value) const {
  event_value[0] = event_value[1] = 1.0;
  if (!never_slips()) event_value[0] = spare(e, anchor(e.bases), Vec3(wrench[0], wrench[1], wrench[2]));
}

double StepLapFriction::spare(const Evaluation& e, const Pose& slid, const Vec3& wrench) const {
  const PressureState now = pressure_at(e.t);
  const Vec3 w = wrench / now.factor;
  Fit& f = fit(e.scratch, slid, GripLaw::holding, now.tilt);
  f.prepare();
  const UsageBounds bounds = usage_bounds(f.capacity, w);
  if (bounds.upper <= k_surely_holds) return 1.0 - bounds.upper;
  if (bounds.lower >= k_surely_slips) return 1.0 - bounds.lower;
  return 1.0 + k_bound_slack - required(f.tabulated(), w, e.t).u;
}

bool StepLapFriction::has_separated(const Fit& f) const { return f.patch.force() < 0.5 * k_last_grip * reference_->patch.force(); }

double StepLapFriction::yield_usage(const Evaluation& e, const Pose& slid, const Vec3& wrench) const {
  const PressureState now = pressure_at(e.t);
  const Fit& f = fit(e.scratch, slid, GripLaw::holding, now.tilt);
  if (has_separated(f)) return 1.0;
  return required(f.patch, wrench / now.factor, e.t).u;
}

double StepLapFriction::support(const Evaluation& e, const FrictionState&, const double* rate) const {
  const PressureState now = pressure_at(e.t);
  Fit& f = fit(e.scratch, anchor(e.bases), GripLaw::holding, now.tilt);
  return now.factor * evaluate_gradient(f.tabulated(), Vec3(rate[0], rate[1], rate[2])).h;
}

// u = W·ν/h(ν) at the maximiser ν; its gradient by W is ν/h.
double StepLapFriction::gauge(const Evaluation& e, const FrictionState&, const double* wrench, double* normal) const {
  const PressureState now = pressure_at(e.t);
  const Patch& patch = fit(e.scratch, anchor(e.bases), GripLaw::holding, now.tilt).tabulated();
  const RequiredPressure need = required(patch, Vec3(wrench[0], wrench[1], wrench[2]) / now.factor, e.t);
  Vec3 n = need.direction;
  if (need.u > 0.0) n /= now.factor * evaluate_gradient(patch, n).h;
  Vec3::Map(normal) = n;
  return need.u;
}

const RequiredPressure& StepLapFriction::usage(const Snapshot& s) const {
  auto& own = static_cast<Scratch&>(*s.evaluation->scratch[index_]);
  const Vec3 w = wrench(s);
  const Pose pose = present(s);
  const PressureState now = pressure_at(s.t);
  // The pose is constant, so expansions (Fit::tabulated()) pay off.
  const bool is_stuck = s.evaluation->friction[index_].phase == FrictionPhase::stick;
  const bool is_known = has_usage_for(s, w);
  const bool is_same = own.asked == w && own.usage_pose.x == pose.x && own.usage_pose.y == pose.y && own.usage_pose.theta == pose.theta &&
                       own.pressed.factor == now.factor && own.pressed.tilt == now.tilt && own.was_from_table == is_stuck &&
                       own.was_from_slip_law == is_known;
  if (is_same) return own.answer;
  if (is_known) {
    own.answer = usage_of_slip(s, pose);
  } else {
    Fit& f = fit(s.evaluation->scratch, pose, GripLaw::holding, now.tilt);
    own.answer = required(is_stuck ? f.tabulated() : f.patch, w / now.factor, s.t);
  }
  own.pressed = now;
  own.was_from_table = is_stuck;
  own.was_from_slip_law = is_known;
  own.asked = w;
  own.usage_pose = pose;
  return own.answer;
}

ValueBounds StepLapFriction::usage_between(const Snapshot& s) const {
  const Vec3 w = wrench(s);
  if (has_usage_for(s, w)) return {slip_usage_, slip_usage_};
  const PressureState now = pressure_at(s.t);
  Fit& f = fit(s.evaluation->scratch, present(s), GripLaw::holding, now.tilt);
  f.prepare();
  if (!f.has_capacity) return {0.0, std::numeric_limits<double>::infinity()}; // no overlap is left
  const UsageBounds bounds = usage_bounds(f.capacity, w / now.factor);
  return {bounds.lower, bounds.upper};
}

const OverlapLoss& StepLapFriction::loss(const Snapshot& s) const {
  auto& own = static_cast<Scratch&>(*s.evaluation->scratch[index_]);
  const Pose pose = present(s);
  const bool is_same = own.is_lost_known && own.lost_at.x == pose.x && own.lost_at.y == pose.y && own.lost_at.theta == pose.theta;
  if (is_same) return own.lost;
  own.lost = overlaps_.loss_at(sheets_, pose, own.workspace, own.region);
  own.lost_at = pose;
  own.is_lost_known = true;
  return own.lost;
}

double StepLapFriction::area(const Snapshot& s) const {
  return fit(s.evaluation->scratch, present(s), GripLaw::holding, pressure_at(s.t).tilt).patch.area();
}

BlockSolution StepLapFriction::solve_block(const Evaluation& e, const FrictionState&, const double* a, const double* b,
                                           bool is_kinetic) const {
  const GripLaw law = is_kinetic ? GripLaw::sliding : GripLaw::holding;
  const PressureState now = pressure_at(e.t);
  Fit& f = fit(e.scratch, anchor(e.bases), law, now.tilt);
  // Wrenches are in units of the pressure factor f: minimises ½ f² wᵀA w + f bᵀw over the admissible set for factor 1.
  const Mat3 mobility = now.factor * Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(a);
  const AdmissibleWrench w = admissible_wrench(f.tabulated(), 0.5 * (mobility + mobility.transpose()), Vec3(b[0], b[1], b[2]));
  insist(w.residual, k_block_residual, name_, e.t, "whether it sticks, and the wrench on its limb,");
  BlockSolution block;
  block.sticks = !w.slips;
  Vec3::Map(block.wrench) = now.factor * w.wrench;
  if (const double size = scaled(w.acceleration).norm(); size > 0.0) Vec3::Map(block.direction) = w.acceleration / size;
  return block;
}

// --- separation

double StepLapFriction::contact_point_event(const Evaluation& e, const FrictionState& state) const {
  return state.phase == FrictionPhase::slip ? parting(e, pose_of(e.motion), state.foot) : 1.0;
}

// Returns the depth of an interface's overlap, m, or a lower bound if that is a large fraction of the depth in the reference pose. Far from
// zero the exact value has no effect.
double StepLapFriction::depth_of(std::size_t i, const Pose& pose, OverlapWorkspace& workspace) const {
  const double at_least = depth_[i].at_least(pose);
  if (at_least > k_surely_overlap * depth_[i].depth) return at_least;
  return penetration(sheets_[i].yoke, sheets_[i].limb, pose, workspace);
}

double StepLapFriction::parting(const Evaluation& e, const Pose& pose, std::uint32_t parted) const {
  OverlapWorkspace& workspace = static_cast<Scratch&>(*e.scratch[index_]).workspace;
  double event_value = 1.0, deepest = -1.0;
  for (std::size_t i = 0; i < sheets_.size(); ++i) {
    const bool is_parted = i < k_tracked && (parted >> i & 1u) != 0;
    const double depth = is_parted ? penetration(sheets_[i].yoke, sheets_[i].limb, pose, workspace) : depth_of(i, pose, workspace);
    if (i < k_tracked) event_value = std::min(event_value, is_parted ? -depth : depth);
    deepest = std::max(deepest, depth);
  }
  return sheets_.size() > k_tracked ? std::min(event_value, deepest) : event_value;
}

void StepLapFriction::switch_contact_point(const Evaluation& e, FrictionState& state) const {
  bool is_any_left = false;
  state.foot = parted_at(pose_of(e.motion), is_any_left);
  if (!is_any_left) state.phase = FrictionPhase::apart;
}

double StepLapFriction::grip_beyond_last(const Evaluation& e, const Pose& slid) const {
  return fit(e.scratch, slid, GripLaw::holding, pressure_at(e.t).tilt).patch.force() / reference_->patch.force() - k_last_grip;
}

std::uint32_t StepLapFriction::parted_at(const Pose& pose, bool& is_any_left) const {
  OverlapWorkspace workspace;
  std::uint32_t parted = 0;
  is_any_left = false;
  for (std::size_t i = 0; i < sheets_.size(); ++i) {
    const bool overlaps = penetration(sheets_[i].yoke, sheets_[i].limb, pose, workspace) > 0.0;
    if (!overlaps && i < k_tracked) parted |= 1u << i;
    is_any_left = is_any_left || overlaps;
  }
  return parted;
}

} // namespace steplap
