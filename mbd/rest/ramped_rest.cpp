#include "mbd/rest/ramped_rest.h"

#include "mbd/base/stop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace steplap {

namespace {

constexpr double k_shortest = 1.0 / 4096; // share of the load within which changes of modes are located
constexpr double k_jump = 1e-2;           // share of the largest force; a larger change in the shortest increment is a jump
constexpr double k_drop = 1e-3;           // share of the static capacity; less is rounding
constexpr double k_rounding = 1e-9;       // share of the ramp
constexpr double k_none = std::numeric_limits<double>::infinity();
constexpr int k_most_increments = 2000;

class Ramp {
public:
  Ramp(System& system, const RampedRest& start, const GravityRamp& ramp, const RampQuestions& questions)
      : system_(system), ramp_(ramp), questions_(questions), gravity_(system.gravity), now_(start) {
    now_.slid.clear();
    const double load = std::max((ramp.from - gravity_).norm(), (ramp.to - gravity_).norm()), length = (ramp.to - ramp.from).norm();
    if (length > 0.0) load_ = load / length;
  }
  Ramp(const Ramp&) = delete;
  Ramp& operator=(const Ramp&) = delete;
  ~Ramp() { system_.gravity = gravity_; }

  // Locates each change of modes by bisection: an increment that contains one is halved, and accepted only if it is the shortest.
  RampedRest run() {
    load_to(s_);
    questions_.on_rest(now_, s_);
    double step = ramp_.first, change = k_none; // the next change of modes is known to come before this share of the ramp
    while (s_ < 1.0) {
      const double end = s_ + step > 1.0 - k_rounding ? 1.0 : s_ + step;
      const bool is_shortest = is_short(end - s_);
      std::optional<RampedRest> rest = attempt(now_, end, is_shortest);
      const bool keeps = rest && keeps_modes(now_, *rest);
      if (!keeps && !is_shortest) {
        change = end;
        step = 0.5 * (end - s_);
        continue;
      }
      step = 2.0 * (end - s_);
      if (!keeps) {
        note_jump(*rest, end);
        step = ramp_.first;
      }
      accept(*rest, end);
      if (s_ >= change - k_rounding) change = k_none;
      else if (change < k_none) step = is_short(change - s_) ? change - s_ : 0.5 * (change - s_);
    }
    return std::move(now_);
  }

private:
  [[nodiscard]] bool is_short(double length) const { return length <= k_shortest * load_ + k_rounding; }

  void note_jump(const RampedRest& rest, double end) const {
    const bool has_jumped = !is_near(now_, rest);
    for (const int f : rest.slid)
      if (!slides_on(rest, f) || (has_jumped && releases_force(rest, f))) questions_.on_jump(f, end);
  }

  // Returns true if friction that slides carries less than it could while sticking. Only then does sliding set free energy: without a drop,
  // friction that slides through a play under a slowly growing load arrives without velocity, although the displacement changes forces.
  [[nodiscard]] static bool releases_force(const RampedRest& rest, int f) {
    return std::any_of(rest.margins.begin(), rest.margins.end(),
                       [f](const FrictionMargin& margin) { return margin.friction == f && margin.used < 1.0 - k_drop; });
  }

  [[nodiscard]] static bool slides_on(const RampedRest& rest, int f) {
    return std::find(rest.sliding.begin(), rest.sliding.end(), f) != rest.sliding.end();
  }

  // Returns true if the modes at the end of an increment are possible at its start, too: the same contacts are closed, and what has slid was at
  // its bound and slides on in the same direction. Forces and displacements are linear in the load while modes stay, and the conditions of the
  // modes are convex, so they are met on the whole way between. Sliding that began and ended within the increment could not be seen otherwise.
  [[nodiscard]] static bool keeps_modes(const RampedRest& from, const RampedRest& to) {
    bool is_same = from.state.mode == to.state.mode;
    for (std::size_t f = 0; f < to.state.friction.size(); ++f)
      is_same = is_same && from.state.friction[f].phase == to.state.friction[f].phase;
    for (const int f : to.slid)
      is_same = is_same && slides_on(to, f) && slides_on(from, f) && from.state.friction[f].sign == to.state.friction[f].sign;
    return is_same;
  }

  void load_to(double s) { system_.gravity = s == 1.0 ? ramp_.to : Vec2(ramp_.from + s * (ramp_.to - ramp_.from)); }

  // Returns nothing if there is no equilibrium. Throws the reason instead if `is_last`.
  [[nodiscard]] std::optional<RampedRest> attempt(const RampedRest& from, double s, bool is_last) {
    load_to(s);
    if (++increments_ > k_most_increments) throw RestNotFound("the path of the load needs more than 2000 increments", {});
    try {
      return rest_after_increment(system_, from, is_last);
    } catch (const RunStopped&) {
      throw;
    } catch (const NumericalFailure&) {
      if (is_last) throw;
      return {};
    }
  }

  // Returns true if no force differs by more than k_jump of the largest one.
  [[nodiscard]] bool is_near(const RampedRest& one, const RampedRest& other) const {
    return largest_difference(questions_.forces(one), questions_.forces(other), 1.0) <= k_jump;
  }

  void accept(RampedRest& rest, double s) {
    for (const int f : now_.slid)
      if (std::find(rest.slid.begin(), rest.slid.end(), f) == rest.slid.end()) rest.slid.push_back(f);
    rest.iterations += now_.iterations;
    now_ = std::move(rest);
    s_ = s;
    load_to(s);
    questions_.on_rest(now_, s_);
  }

  System& system_;
  const GravityRamp ramp_;
  const RampQuestions& questions_;
  const Vec2 gravity_; ///< of the system; restored at the end
  RampedRest now_;
  double s_ = 0.0;
  double load_ =
      1.0; ///< largest distance of the ramp from gravity alone, divided by its own length; a ramp that begins at gravity alone has 1
  int increments_ = 0;
};

} // namespace

double largest_difference(const std::vector<ForcesOfUnit>& x, const std::vector<ForcesOfUnit>& y, double small) {
  double most = 0.0;
  for (std::size_t unit = 0; unit < x.size(); ++unit) {
    double largest = 0.0;
    for (const double force : y[unit].values) largest = std::max(largest, std::abs(force));
    const double rounding = std::max(x[unit].rounding, y[unit].rounding);
    for (std::size_t i = 0; i < x[unit].values.size(); ++i) {
      const double a = x[unit].values[i], b = y[unit].values[i];
      if (std::abs(a - b) <= rounding || (std::isnan(a) && std::isnan(b))) continue;
      const double share = std::abs(a - b) / std::max(std::abs(b), small * largest);
      if (!(share <= most)) most = std::isnan(share) ? std::numeric_limits<double>::infinity() : share;
    }
  }
  return most;
}

RampedRest find_ramped_rest(System& system, const RampedRest& start, const GravityRamp& ramp, const RampQuestions& questions) {
  return Ramp(system, start, ramp, questions).run();
}

} // namespace steplap
