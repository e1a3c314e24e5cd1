// Integrates the hand-written transformer with a separate DOP853, PI step control, and event location on the dense output. The dense output
// costs three evaluations and is built only if an event is possible: an event function changed its sign over the step, its Hermite cubic is
// negative inside, or the friction force at a stage exceeded the sticking limit.

#include "dop853_step.h"
#include "transformer_programs.h"

#include <algorithm>
#include <cmath>

namespace steplap::peers {
namespace {

using Step = Dop853Step<k_states>;

constexpr double k_safety = 0.9;
constexpr double k_shrink = 0.2;
constexpr double k_growth = 6.0;
constexpr double k_beta = 0.04;        // exponent of the PI control (Hairer, Wanner II, IV.2)
constexpr double k_slope_probe = 1e-3; // interval for difference quotients of event functions, as a fraction of the step
constexpr int k_pieces = 8;            // number of parts of a step that are searched for a double crossing

class Run {
public:
  Run(Condition condition, double tolerance, Record* record)
      : model_(condition), tolerance_(tolerance), record_(record), y_(model_.initial_state()) {
    for (int i = 0; i < k_states; ++i) weight_[i] = 1.0 / (tolerance * k_scale[i]);
  }

  RunCounts integrate() {
    start_mode();
    double proposal = k_breakpoints[0]; // first step, s: the machine is at rest until braking begins
    for (const double stop : k_breakpoints) {
      if (stop == k_breakpoints[1]) proposal = first_step();
      while (t_ < stop) proposal = advance(stop, proposal);
    }
    counts_.evaluations = model_.evaluations();
    return counts_;
  }

private:
  // Returns the first step, s, from the error's proportionality to the eighth power of the step. It is correct within a factor of two for
  // this scene.
  [[nodiscard]] double first_step() const { return 0.02 * std::pow(tolerance_, 0.125); }

  void start_mode() {
    model_.rates(t_, y_.data(), step_.k[0].data());
    watch(y_, step_.k[0], old_);
    last_error_ = 1e-4;
  }

  struct Watch {
    Switches value;
    Switches slope; // derivatives, 1/s; zero for those of sticking
  };

  // Evaluates all event functions and their derivatives. Precondition: k contains the rates at y from the last evaluation, so that the
  // friction force is known.
  void watch(const State& y, const State& k, Watch& w) {
    model_.kinematic_switches(y.data(), w.value.data());
    model_.stick_switches(w.value.data());
    const double dt = k_slope_probe * probe_;
    State ahead;
    for (int i = 0; i < k_states; ++i) ahead[i] = y[i] + dt * k[i];
    model_.kinematic_switches(ahead.data(), w.slope.data());
    for (int i = 0; i < k_switches; ++i) w.slope[i] = (w.slope[i] - w.value[i]) / dt;
    if (model_.sticking()) w.slope[k_friction_upper] = w.slope[k_friction_lower] = 0.0;
  }

  // Accepts one step, or its part up to the first event. Returns the size of the next step, s.
  double advance(double stop, double h) {
    auto rates = [this](double t, const double* y, double* f) { model_.rates(t, y, f); };
    const bool last = t_ + 1.01 * h >= stop;
    if (last) h = stop - t_;
    model_.reset_stick_margin();
    step_.advance(rates, t_, y_, h);
    const double error = std::max(step_.error(h, weight_), 1e-30);
    if (error > 1.0) {
      ++counts_.rejected;
      return h * std::max(k_shrink, k_safety * std::pow(error, -0.125));
    }
    ++counts_.steps;
    const double factor = k_safety * std::pow(error, -(0.125 - 0.75 * k_beta)) * std::pow(last_error_, k_beta);
    const double next = h * std::clamp(factor, k_shrink, k_growth);
    const double end = last ? stop : t_ + h;
    model_.rates(end, step_.y1.data(), step_.k[12].data());
    probe_ = h;
    Watch fresh;
    watch(step_.y1, step_.k[12], fresh);
    const bool event = suspect(fresh, h);
    if (event || record_ != nullptr) step_.prepare_dense(rates, t_, y_, h);
    Crossing first;
    if (event) first = first_crossing(fresh, h);
    const double reached = first.slot < 0 ? end : t_ + first.s * h;
    if (record_ != nullptr) sample(reached, h);
    if (first.slot < 0) {
      y_ = step_.y1;
      t_ = end;
      step_.k[0] = step_.k[12];
      old_ = fresh;
      last_error_ = std::max(error, 1e-4);
      return next;
    }
    State at;
    step_.dense(y_, first.s, at);
    y_ = at;
    t_ = reached;
    ++counts_.events;
    if (record_ != nullptr) record_->happenings.push_back({t_, model_.describe(first.slot)});
    model_.cross(first.slot, t_, y_);
    start_mode();
    return std::min(next, k_after_event * first_step());
  }

  // Returns true if an event function may have reached zero within this step.
  bool suspect(const Watch& fresh, double h) {
    bool any = false;
    for (int i = 0; i < k_switches; ++i) {
      const double a = old_.value[i];
      const double b = fresh.value[i];
      const double da = h * old_.slope[i];
      const double db = h * fresh.slope[i];
      suspect_[i] = b <= 0.0;
      if (b > 0.0 && da < 0.0 && db > 0.0) suspect_[i] = dips(a, b, da, db);
      any = any || suspect_[i];
    }
    if (model_.sticking() && model_.stick_margin() < 0.0) {
      suspect_[k_friction_upper] = suspect_[k_friction_lower] = true;
      any = true;
    }
    return any;
  }

  // Returns true if the Hermite cubic, which decreases first and increases at the end, has a minimum below a quarter of its smaller end
  // value: the function itself may then be negative.
  static bool dips(double a, double b, double da, double db) {
    const double c2 = 3.0 * (b - a) - 2.0 * da - db;
    const double c3 = da + db - 2.0 * (b - a);
    const double root = std::sqrt(std::max(0.0, c2 * c2 - 3.0 * c3 * da));
    const double s = -da / (c2 + root); // lower turning point, in the form without cancellation
    if (!(s > 0.0 && s < 1.0)) return true;
    const double least = a + s * (da + s * (c2 + s * c3));
    return least < 0.25 * std::min(a, b);
  }

  struct Crossing {
    int slot = -1;
    double s = 2.0;
  };

  [[nodiscard]] double value_at(int slot, double s, double h) {
    State y;
    step_.dense(y_, s, y);
    return model_.switch_value(slot, t_ + s * h, y.data());
  }

  Crossing first_crossing(const Watch& fresh, double h) {
    Crossing first;
    for (int slot = 0; slot < k_switches; ++slot) {
      if (!suspect_[slot]) continue;
      const double s = slot_crossing(slot, fresh, h);
      if (s < first.s) first = {slot, s};
    }
    return first;
  }

  // Returns the first zero of a decreasing function in (0, 1]; 2 if there is none. A function that starts at zero, because its mode has
  // just begun, is ignored until it has become positive.
  double slot_crossing(int slot, const Watch& fresh, double h) {
    const bool plain = old_.value[slot] > k_armed && fresh.value[slot] <= 0.0 && old_.slope[slot] < 0.0 && fresh.slope[slot] < 0.0;
    if (plain) return root(slot, 0.0, 1.0, old_.value[slot], fresh.value[slot], h);
    double before = 0.0;
    double g_before = old_.value[slot];
    for (int piece = 1; piece <= k_pieces; ++piece) {
      const double s = piece / static_cast<double>(k_pieces);
      const double g = piece == k_pieces ? fresh.value[slot] : value_at(slot, s, h);
      if (g <= 0.0 && g_before > k_armed) return root(slot, before, s, g_before, g, h);
      before = s;
      g_before = g;
    }
    return 2.0;
  }

  // Locates a zero by the Illinois method. The result is slightly beyond the zero.
  double root(int slot, double a, double b, double ga, double gb, double h) {
    const double enough = std::max(1e-15, k_root_share * tolerance_);
    double last = b;
    int side = 0;
    for (int i = 0; i < 60; ++i) {
      double s = b - gb * (b - a) / (gb - ga);
      if (!(s > a && s < b)) s = 0.5 * (a + b);
      if (b - a <= enough || std::abs(s - last) <= enough) return std::min(s + enough, b);
      last = s;
      const double g = value_at(slot, s, h);
      if (g > 0.0) {
        a = s;
        ga = g;
        if (side == 1) gb *= 0.5;
        side = 1;
      } else {
        b = s;
        gb = g;
        if (side == -1) ga *= 0.5;
        side = -1;
      }
    }
    return b;
  }

  void sample(double reached, double h) {
    while (static_cast<int>(record_->samples.size()) < k_samples) {
      const double t = k_sample_interval * static_cast<double>(record_->samples.size() + 1);
      if (t > reached) return;
      State y;
      step_.dense(y_, std::clamp((t - t_) / h, 0.0, 1.0), y);
      record_->samples.push_back(model_.outputs(t, y));
    }
  }

  static constexpr double k_armed = 1e-12;
  static constexpr double k_root_share = 1e-3;
  static constexpr double k_after_event = 1.0;

  Transformer model_;
  double tolerance_;
  Record* record_;
  State y_;
  State weight_{};
  double t_ = 0.0;
  double last_error_ = 1e-4;
  double probe_ = 1e-3;
  Step step_;
  Watch old_{};
  std::array<bool, k_switches> suspect_{};
  RunCounts counts_;
};

} // namespace

RunCounts run_transformer_dop853(Condition condition, double tolerance, Record* record) {
  return Run(condition, tolerance, record).integrate();
}

} // namespace steplap::peers
