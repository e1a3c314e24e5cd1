// Choice between static and kinetic coefficient for each friction element in a time step.
//
// If kinetic friction is below static friction, the problem of a step is not convex and does not define the onset of slip. An element
// that slid at the end of the last step keeps its kinetic coefficient; with the static one it would load its neighbours by a force that
// it cannot have. All others start with the static coefficient. Then, until nothing changes:
//
//   1. The convex problem is solved for the present coefficients.
//   2. An element that would slide in the opposite direction has passed through rest: it gets its static coefficient back.
//   3. An element with the kinetic coefficient that is at rest and within its static set gets its static coefficient back.
//   4. Of the elements that slide with the static coefficient, the most overloaded one, and those equal to it, get the kinetic
//      coefficient. The overload is the wrench needed to stick, while all elements that may stick do so, relative to the capacity. Under
//      proportionally growing loads this element starts to slide first. If the others alone keep it at rest (two friction elements on
//      one body), it can slide only together with them: then all that slide get the kinetic coefficient.
//
// Each element gets its static coefficient back at most once in a step, and no set of coefficients is tried twice: from the first
// repetition on, elements only change to kinetic. The number of rounds is therefore at most about twice the number of elements.
#include "mbd/integrators/time_stepping.h"
#include "mbd/system/bounded_friction.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_tie = 1e-9; // relative tolerance for equal overloads, far above the rounding errors of identical elements
// Overloads are also equal if they differ by at most this multiple of the last change of the sweeps, to which wrenches are accurate.
constexpr double k_changes_in_tie = 10.0;
// Regularisation if not all elements can stick, for example between parts that drives move apart. The wrenches are then those of springs
// with equal stiffness relative to the mobilities; their relative rounding errors are about 1e-10.
constexpr double k_soft = 1e-6;
// A row is at rest if its velocity is below this fraction of the terms of which it is the sum. Velocities are accurate to 1e-6 at worst.
constexpr double k_rest_by_others = 1e-6;

// Returns true if a one-dimensional element has equal static and kinetic bounds.
bool has_one_set(const BoundedFriction& element, const Evaluation& e, const FrictionState& friction) {
  const WrenchBounds at_rest = element.bounds(e, friction, false), sliding = element.bounds(e, friction, true);
  return at_rest.low == sliding.low && at_rest.high == sliding.high;
}

} // namespace

bool TimeStepping::slid_before(int f) const { return keeps_sliding_ && start_.friction[f].phase == FrictionPhase::slip; }

// `keeps_kinetic`: continues with the coefficients of the last call; elements then only change to kinetic.
TimeStepping::StepFailure TimeStepping::balance_friction(Dynamics& dynamics, bool keeps_kinetic) {
  const Evaluation& e = dynamics.evaluation();
  for (FrictionPart& part : parts_) {
    part.is_kinetic = keeps_kinetic ? part.is_kinetic : part.has_slid;
    part.is_returned = false;
  }
  tried_.clear();
  bool only_grows = keeps_kinetic;
  for (;;) {
    double change = 0.0;
    if (const StepFailure trouble = settle_wrenches(dynamics, change); trouble.what) return trouble;
    note_tried();
    bool is_changed = false;
    if (!only_grows) {
      is_changed = return_turned();
      if (!is_changed) return_stopped(e);
    }
    if (!is_changed) is_changed = give_kinetic(e, change);
    if (!is_changed) return {};
    if (only_grows || !is_tried()) continue;
    only_grows = true;
    const char* const last = &tried_[tried_.size() - parts_.size()];
    for (std::size_t p = 0; p < parts_.size(); ++p) parts_[p].is_kinetic = last[p] != 0;
    if (!give_kinetic(e, change)) return {};
  }
}

// Returns true if the element slides opposite to its direction at the end of the last step. In three dimensions a slip can change its
// direction without coming to rest; there the result is true if friction would push along the former slip.
bool TimeStepping::turns_round(const FrictionPart& part) const {
  if (!part.has_slid || !part.is_kinetic || !part.is_loaded || part.block.sticks) return false;
  const FrictionState& before = start_.friction[part.friction];
  if (part.dimension == 1) return before.sign * part.block.direction[0] < 0.0;
  double power = 0.0;
  for (int i = 0; i < part.dimension; ++i) power += wrench_[part.first + i] * before.direction[i];
  return power > 0.0;
}

bool TimeStepping::return_turned() {
  bool is_any = false;
  for (FrictionPart& part : parts_) {
    if (part.is_returned || !turns_round(part)) continue;
    part.is_kinetic = false;
    part.is_returned = is_any = true;
  }
  return is_any;
}

// Returns static coefficients to elements at rest within their static set. Their wrenches are admissible in both sets, so they are not
// solved again.
void TimeStepping::return_stopped(const Evaluation& e) {
  for (FrictionPart& part : parts_) {
    if (!part.is_kinetic || part.is_returned || !part.is_loaded || !part.block.sticks) continue;
    part.is_kinetic = false;
    if (solve_part(e, part).sticks) part.is_returned = true;
    else part.is_kinetic = true; // a viscous part makes the kinetic set larger than the static one
  }
}

// Gives kinetic coefficients to the most overloaded elements (step 4 above). Returns false if no element slides with a static
// coefficient that differs from its kinetic one.
bool TimeStepping::give_kinetic(const Evaluation& e, double change) {
  const auto slides = [](const FrictionPart& part) { return part.is_loaded && !part.is_kinetic && !part.block.sticks; };
  const auto would_change = [&](const FrictionPart& part) {
    const BoundedFriction* const bounded = system_.frictions[part.friction].bounded;
    return slides(part) && !(bounded && has_one_set(*bounded, e, e.friction[part.friction]));
  };
  if (std::none_of(parts_.begin(), parts_.end(), would_change)) return false;
  find_overloads(e);
  double most = -1.0;
  std::size_t top = 0;
  for (std::size_t p = 0; p < parts_.size(); ++p)
    if (slides(parts_[p]) && overload_[p] > most) {
      most = overload_[p];
      top = p;
    }
  const double tie = std::max(k_tie, k_changes_in_tie * change);
  if (std::count_if(parts_.begin(), parts_.end(), slides) > 1 && is_held_by_others(parts_[top])) {
    for (FrictionPart& part : parts_) part.is_kinetic = part.is_kinetic || slides(part);
    return true;
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    FrictionPart& part = parts_[p];
    // By rounding, an element just within its set may equal one just outside. If elements share a load in a statically indeterminate
    // way, an overload above 1 does not imply sliding, because the others carry the rest.
    const bool equals_by_rounding = part.is_loaded && !part.is_kinetic && most <= 1.0 + tie && std::abs(overload_[p] - most) <= tie;
    if ((slides(part) && overload_[p] >= most * (1.0 - tie)) || equals_by_rounding) part.is_kinetic = true;
  }
  return true;
}

// Computes the overloads. They are infinite, and the element slides, if drives determine its motion or its capacity is zero.
void TimeStepping::find_overloads(const Evaluation& e) {
  overload_.assign(parts_.size(), 0.0);
  hold([](const FrictionPart& part) { return part.is_loaded && !part.is_kinetic; });
  if (!hold_rows() && factor_held(k_soft)) (void)solve_held(1);
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const FrictionPart& part = parts_[p];
    if (!part.is_loaded || part.is_kinetic) continue;
    if (part.is_driven) {
      if (!part.block.sticks) overload_[p] = std::numeric_limits<double>::infinity();
      continue;
    }
    double normal[3];
    const double share = system_.frictions[part.friction].friction->gauge(e, e.friction[part.friction], &together_[part.first], normal);
    overload_[p] = std::isnan(share) ? std::numeric_limits<double>::infinity() : share;
  }
}

// Returns true if the element is at rest when all others with static coefficients stick: it cannot slide alone, and the distribution of
// the load is not unique.
bool TimeStepping::is_held_by_others(const FrictionPart& part) {
  hold([&](const FrictionPart& other) { return &other != &part && other.is_loaded && !other.is_kinetic; });
  if (part.is_driven || !hold_rows()) return false;
  for (int i = 0; i < part.dimension; ++i) {
    double velocity = rate_[part.first + i], size = std::abs(velocity);
    for (int j = 0; j < rows_; ++j) {
      const double by = compliance_.between(part.first + i, j) * together_[j];
      velocity += by;
      size += std::abs(by);
    }
    if (std::abs(velocity) > k_rest_by_others * size) return false;
  }
  return true;
}

void TimeStepping::note_tried() {
  for (const FrictionPart& part : parts_) tried_.push_back(part.is_kinetic ? 1 : 0);
}

bool TimeStepping::is_tried() const {
  const std::size_t n = parts_.size();
  for (std::size_t first = 0; first + n <= tried_.size(); first += n) {
    std::size_t p = 0;
    while (p < n && (tried_[first + p] != 0) == parts_[p].is_kinetic) ++p;
    if (p == n) return true;
  }
  return false;
}

} // namespace steplap
