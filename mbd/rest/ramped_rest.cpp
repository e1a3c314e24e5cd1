#include "mbd/rest/ramped_rest.h"

#include "mbd/rest/rest_increment.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace steplap {

namespace {

constexpr double k_agree = 2e-4;            // share of a force; largest change of forces by halving an increment
constexpr double k_small_force = 1e-2;      // share of the largest force; smaller ones are only known to k_agree of it
constexpr double k_shortest = 1.0 / 1024;   // share of the load; a shorter increment with other forces is a jump between equilibria
constexpr double k_shortest_way = 1.0 / 64; // share of the load; without an equilibrium so near, the machine leaves its place
constexpr double k_longest_slide = 0.25;    // share of the load; longer increments with sliding could miss a reversal
constexpr int k_most_increments = 2000;

class Ramp {
public:
  Ramp(System& system, const State& start, const GravityRamp& ramp, const RampQuestions& questions)
      : system_(system), ramp_(ramp), questions_(questions), gravity_(system.gravity) {
    now_.rest.state = start;
    const double load = std::max((ramp.from - gravity_).norm(), (ramp.to - gravity_).norm()), length = (ramp.to - ramp.from).norm();
    if (length > 0.0) load_ = load / length;
  }
  Ramp(const Ramp&) = delete;
  Ramp& operator=(const Ramp&) = delete;
  ~Ramp() { system_.gravity = gravity_; }

  Equilibrium run() {
    double step = 1.0;
    std::optional<Increment> whole;
    for (int i = 0; s_ < 1.0; ++i) {
      const double end = s_ + step > 1.0 - 1e-9 ? 1.0 : s_ + step;
      const double length = end - s_;
      const bool is_shortest = length <= k_shortest * load_ || i > k_most_increments;
      if (!whole) whole = attempt(now_.rest.state, end, is_shortest || length <= k_shortest_way * load_);
      if (whole && (whole->is_elastic || is_shortest)) {
        accept(*whole, end);
      } else {
        const double middle = s_ + 0.5 * length;
        std::optional<Increment> first = attempt(now_.rest.state, middle, length <= 2.0 * k_shortest_way * load_);
        std::optional<Increment> second;
        if (first && whole && length <= k_longest_slide * load_) second = attempt(first->rest.state, end, false);
        if (!second || !agree(*whole, *second)) {
          whole = std::move(first);
          step = 0.5 * length;
          continue;
        }
        accept(*first, middle);
        accept(*second, end);
      }
      whole.reset();
      step = 2.0 * length;
    }
    return std::move(now_.rest);
  }

private:
  struct Increment {
    Equilibrium rest;
    bool is_elastic = false; ///< all friction held, and no contact changed
  };

  void load_to(double s) { system_.gravity = s == 1.0 ? ramp_.to : Vec2(ramp_.from + s * (ramp_.to - ramp_.from)); }

  // Returns nothing if there is no equilibrium. Throws the reason instead if `is_last`.
  [[nodiscard]] std::optional<Increment> attempt(const State& from, double s, bool is_last) {
    load_to(s);
    Increment increment;
    try {
      increment.rest = rest_after_increment(system_, from);
    } catch (const NumericalFailure&) {
      if (is_last) throw;
      return {};
    }
    const State& to = increment.rest.state;
    increment.is_elastic = increment.rest.slid.empty() && !increment.rest.is_settled && from.mode == to.mode;
    for (std::size_t f = 0; f < to.friction.size(); ++f)
      increment.is_elastic = increment.is_elastic && from.friction[f].phase == to.friction[f].phase;
    return increment;
  }

  [[nodiscard]] bool agree(const Increment& whole, const Increment& halves) const {
    const std::vector<std::vector<double>> x = questions_.forces(whole.rest), y = questions_.forces(halves.rest);
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

  void accept(Increment& increment, double s) {
    std::vector<int>& slid = increment.rest.slid;
    for (const int f : now_.rest.slid)
      if (std::find(slid.begin(), slid.end(), f) == slid.end()) slid.push_back(f);
    increment.rest.iterations += now_.rest.iterations;
    now_ = std::move(increment);
    s_ = s;
    load_to(s);
    questions_.on_rest(now_.rest);
  }

  System& system_;
  const GravityRamp ramp_;
  const RampQuestions& questions_;
  const Vec2 gravity_; ///< of the system; restored at the end
  Increment now_;
  double s_ = 0.0;
  double load_ = 1.0; ///< largest load, as a share of the length of the ramp
};

} // namespace

Equilibrium find_ramped_rest(System& system, const State& start, const GravityRamp& ramp, const RampQuestions& questions) {
  return Ramp(system, start, ramp, questions).run();
}

} // namespace steplap
