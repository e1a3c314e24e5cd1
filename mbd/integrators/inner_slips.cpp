// Detection of slips that begin and end within one part of a time step, so that all elements stick at its end.
//
// A part is computed with mean loads and with the clamping pressures at its end, so a peak of the utilisation (load over capacity)
// within it is not seen. Near a peak this error is about the change of the utilisation from part to part. A part is examined only if a
// utilisation may have reached 1 within this error. The examination repeats the part up to three positions, with loads averaged over the
// last 1/1000 of its length. Loads have no breakpoints within a step (Simulation::next_limit_of_steps), and harmonics turn little, so
// the utilisation is nearly a parabola through three values. If the parabola reaches 1 within the part and is below 1 at its end, a slip
// is hidden. If it is not below 1 at the end, the next part finds the slip.
#include "mbd/integrators/time_stepping.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Possible excess of the utilisation within a part, in changes from part to part: with a triangular peak as wide as the part, the mean
// is too small by one change.
constexpr double k_reach = 1.5;
constexpr double k_noise = 1e-6;  // accuracy of utilisations; wrenches converge to this (time_stepping.cpp)
constexpr double k_glance = 1e-3; // averaging time of loads before a probed position, relative to the part
constexpr double k_unlike_parabola =
    // Allowance for the deviation from a parabola, relative to the curvature within a part: harmonics turn by at most 0.4 rad per
    // part, and the reciprocal of one may curve more.
    0.3;
constexpr double k_places[] = {0.125, 0.5625, 1.0}; // positions within a part; the last is its end

// Returns an upper limit of the utilisation between 0 and 1: the maximum of the parabola through three values at k_places, plus a fraction
// of its curvature.
double top_of(const std::array<double, 3>& u) {
  constexpr double a = k_places[0], b = k_places[1], c = k_places[2];
  const double first = (u[1] - u[0]) / (b - a), second = ((u[2] - u[1]) / (c - b) - first) / (c - a);
  const auto at = [&](double x) { return u[0] + (x - a) * (first + (x - b) * second); };
  const double vertex = second < 0.0 ? 0.5 * (a + b) - 0.5 * first / second : -1.0;
  const double top = std::max({at(0.0), u[0], u[1], u[2], vertex > 0.0 && vertex < 1.0 ? at(vertex) : 0.0});
  return top + k_unlike_parabola * 0.25 * std::abs(second);
}

// Returns a scratch state; its memory is reused from part to part.
State& probe_state() {
  thread_local State state;
  return state;
}

} // namespace

// Returns the utilisation of an element; 1 if it slips, 0 if nothing presses on it.
double TimeStepping::usage_of(const Evaluation& e, const FrictionPart& part) const {
  if (!part.is_loaded) return 0.0;
  if (!part.block.sticks) return 1.0;
  const double* const wrench = &wrench_[static_cast<std::size_t>(part.first)];
  if (std::all_of(wrench, wrench + part.dimension, [](double w) { return w == 0.0; })) return 0.0;
  if (part.dimension == 1) return std::abs(wrench[0]) / bound_of(e, part, false);
  double normal[3];
  return system_.frictions[part.friction].friction->gauge(e, e.friction[part.friction], wrench, normal);
}

// Records the elements that stick at the end t1 of the part just computed. Returns true if some of them may have slipped within it.
bool TimeStepping::note_sticking(Dynamics& dynamics, double t1) {
  if (sticking_.size() < system_.frictions.size()) { // allocated once, at the first call
    sticking_.resize(system_.frictions.size());
    glance_usage_.resize(system_.frictions.size());
    probe_state() = start_;
  }
  sticking_now_.assign(system_.frictions.size(), {});
  bool is_any_near = false;
  for (const FrictionPart& part : parts_) {
    if (!part.block.sticks || part.is_driven) continue;
    const Sticking& before = sticking_[part.friction];
    Sticking& now = sticking_now_[part.friction];
    now.t = t1;
    now.usage = usage_of(dynamics.evaluation(), part);
    if (start_.friction[part.friction].phase == FrictionPhase::slip || slides_at_landing(part)) continue; // it has just come to rest
    const RowSpec& row = *system_.frictions[part.friction].friction->rows(dynamics.evaluation().friction[part.friction]);
    if (impacts_.acts_between(row.a, row.b)) continue; // its normal force within an impact is known by its mean only
    const bool is_known = before.t == start_.t;
    now.change = is_known ? std::abs(now.usage - before.usage) : 1.0;
    const double reach = k_reach * std::max(now.change, before.change);
    now.is_near = now.usage < 1.0 && reach > k_noise && now.usage + reach >= 1.0;
    is_any_near = is_any_near || now.is_near;
  }
  return is_any_near;
}

// Returns true if an element with Sticking::is_near slips within the part from start_ to t1 and sticks at its end. The state of
// `dynamics` is undefined afterwards.
bool TimeStepping::slips_inside(Dynamics& dynamics, double t1, double tolerance) {
  const double h = t1 - start_.t;
  const Residual residual = residual_;
  glance_usage_.assign(system_.frictions.size(), {});
  bool is_made = true;
  State& probe = probe_state();
  const auto holds_at_end = [&](std::size_t f) { return sticking_now_[f].is_near && glance_usage_[f].back() < 1.0; };
  for (const int i : {k_glances - 1, 0, 1}) { // the end first: if no element sticks there, no slip is hidden
    probe = start_;
    const double end = i + 1 == k_glances ? t1 : start_.t + k_places[i] * h;
    glance_ = k_glance * h;
    try {
      is_made = try_part(dynamics, probe, end, tolerance).what == nullptr;
    } catch (const NumericalFailure&) {
      is_made = false; // cannot be computed up to this position, although the whole part could: not examined
    }
    glance_ = 0.0;
    if (!is_made) break;
    bool holds_any = false, slips_any = false;
    for (const FrictionPart& part : parts_) {
      std::array<double, k_glances>& usage = glance_usage_[part.friction];
      usage[i] = usage_of(dynamics.evaluation(), part);
      holds_any = holds_any || holds_at_end(part.friction);
      slips_any = slips_any || (holds_at_end(part.friction) && usage[i] >= 1.0);
    }
    is_made = holds_any;
    if (!is_made || slips_any) break; // one slip suffices; without sticking elements there is nothing to find
  }
  residual_ = residual;
  for (std::size_t f = 0; is_made && f < sticking_now_.size(); ++f)
    if (holds_at_end(f) && top_of(glance_usage_[f]) >= 1.0) return true;
  return false;
}

} // namespace steplap
