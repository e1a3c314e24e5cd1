#include "mbd/rest/ramped_rest.h"

#include "mbd/base/stop.h"
#include "mbd/rest/rest_increment.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace steplap {

namespace {

constexpr double k_agree = 5e-5;          // share of a force; largest change of forces by halving an increment
constexpr double k_small_force = 1e-2;    // share of the largest force; smaller ones are only known to k_agree of it
constexpr double k_shortest = 1.0 / 4096; // share of the load; a shorter increment with other forces is a jump between equilibria
constexpr int k_most_increments = 2000;

class Ramp {
public:
  Ramp(System& system, const Equilibrium& start, const GravityRamp& ramp, const RampQuestions& questions)
      : system_(system), ramp_(ramp), questions_(questions), gravity_(system.gravity), now_(start) {
    now_.slid.clear();
    const double load = std::max((ramp.from - gravity_).norm(), (ramp.to - gravity_).norm()), length = (ramp.to - ramp.from).norm();
    if (length > 0.0) load_ = load / length;
  }
  Ramp(const Ramp&) = delete;
  Ramp& operator=(const Ramp&) = delete;
  ~Ramp() { system_.gravity = gravity_; }

  Equilibrium run() {
    double step = 1.0;
    std::optional<Equilibrium> whole;
    while (s_ < 1.0) {
      const double end = s_ + step > 1.0 - 1e-9 ? 1.0 : s_ + step;
      const double length = end - s_;
      const bool is_shortest = length <= k_shortest * load_;
      if (!whole) whole = attempt(now_, end, is_shortest);
      if (whole && (is_shortest || has_same_modes(now_, *whole))) {
        for (const int f : whole->slid)
          if (!slides_on(*whole, f)) questions_.on_jump(f, end);
        accept(*whole, end);
      } else if (const double middle = s_ + 0.5 * length; !halves(whole, middle, end)) {
        step = 0.5 * length;
        continue;
      }
      whole.reset();
      step = 2.0 * length;
    }
    return std::move(now_);
  }

private:
  // Computes an increment, whose result at once is `whole`, in two halves, and accepts what is known of it. Returns false if nothing is.
  // Then `whole` is the first half.
  bool halves(std::optional<Equilibrium>& whole, double middle, double end) {
    std::optional<Equilibrium> first = attempt(now_, middle, false);
    if (first && has_same_modes(now_, *first)) {
      accept(*first, middle);
      return true;
    }
    std::optional<Equilibrium> second;
    if (first && whole) second = attempt(*first, end, false);
    if (!second || !agree(*whole, *second)) {
      whole = std::move(first);
      return false;
    }
    accept(*first, middle);
    accept(*second, end);
    return true;
  }

  [[nodiscard]] static bool slides_on(const Equilibrium& rest, int f) {
    return std::find(rest.sliding.begin(), rest.sliding.end(), f) != rest.sliding.end();
  }

  // Returns true if the same friction sticks and slides, with the same contacts closed.
  [[nodiscard]] static bool has_same_modes(const Equilibrium& from, const Equilibrium& to) {
    bool is_same = from.state.mode == to.state.mode && from.sliding == to.sliding;
    for (std::size_t f = 0; f < to.state.friction.size(); ++f)
      is_same = is_same && from.state.friction[f].phase == to.state.friction[f].phase;
    for (const int f : to.slid) is_same = is_same && slides_on(to, f);
    for (const int f : to.sliding) is_same = is_same && from.state.friction[f].sign == to.state.friction[f].sign;
    return is_same;
  }

  void load_to(double s) { system_.gravity = s == 1.0 ? ramp_.to : Vec2(ramp_.from + s * (ramp_.to - ramp_.from)); }

  // Returns nothing if there is no equilibrium. Throws the reason instead if `is_last`.
  [[nodiscard]] std::optional<Equilibrium> attempt(const Equilibrium& from, double s, bool is_last) {
    load_to(s);
    if (++increments_ > k_most_increments) throw RestNotFound("the path of the load needs more than 2000 increments", {});
    try {
      return rest_after_increment(system_, from);
    } catch (const RunStopped&) {
      throw;
    } catch (const NumericalFailure&) {
      if (is_last) throw;
      return {};
    }
  }

  [[nodiscard]] bool agree(const Equilibrium& whole, const Equilibrium& halves) const {
    const std::vector<std::vector<double>> x = questions_.forces(whole), y = questions_.forces(halves);
    for (std::size_t unit = 0; unit < x.size(); ++unit) {
      double largest = 0.0;
      for (const double force : y[unit]) largest = std::max(largest, std::abs(force));
      for (std::size_t i = 0; i < x[unit].size(); ++i) {
        const double a = x[unit][i], b = y[unit][i];
        if (std::isnan(a) && std::isnan(b)) continue;
        if (!(std::abs(a - b) <= k_agree * std::max(std::abs(b), k_small_force * largest))) return false;
      }
    }
    return true;
  }

  void accept(Equilibrium& rest, double s) {
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
  Equilibrium now_;
  double s_ = 0.0;
  double load_ = 1.0; ///< largest load, as a share of the length of the ramp
  int increments_ = 0;
};

} // namespace

Equilibrium find_ramped_rest(System& system, const Equilibrium& start, const GravityRamp& ramp, const RampQuestions& questions) {
  return Ramp(system, start, ramp, questions).run();
}

} // namespace steplap
