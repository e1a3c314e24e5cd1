#include "mbd/run/late_formulas.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/formula/formula.h"
#include "mbd/model/action.h"
#include "mbd/model/formula_fields.h"
#include "mbd/simulation/run_record.h"
#include "mbd/system/own_states.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace steplap {

bool uses_time(const ElementEntry& entry) {
  if (as_action(*entry.element)) return false;
  for (const Field& field : entry.kind->fields.fields()) {
    if (!is_formula_field(field)) continue;
    try {
      const Formula formula(std::get<std::string>(field.get(entry.element.get())), field.name, {});
      if (std::any_of(formula.tree().begin(), formula.tree().end(), [](const FormulaNode& node) { return node.op == FormulaOp::time; }))
        return true;
    } catch (const ModelError&) { // not a formula; an invalid formula is reported when the element is compiled
    }
  }
  return false;
}

namespace {

// Samples within the run, in the k_near run lengths after it, and in a geometric sequence from there to k_behind.
constexpr int k_samples = 200;
constexpr double k_near = 10.0; // range of the evenly spaced samples after the end, in run lengths
// Smallest excess over values of the run, as ratio; peaks of sums of harmonics differ by less from interval to interval.
constexpr double k_larger = 1.25;
constexpr double k_far = 100.0;  // range in which a load reaches its full size, if it has one, in run lengths
constexpr double k_behind = 1e4; // last sample, in run lengths
constexpr double k_alike = 1e-9; // differences below this fraction of the largest value are rounding

// Computes the force of an element, or the rate of a state, at any time, with the bodies in their final state.
class LaterEvaluation {
public:
  LaterEvaluation(const Model& model, const System& system, const State& state, const std::string& element)
      : system_(system), state_(state), dynamics_(system) {
    for (const Channel& channel : system.channels)
      if (channel.name.starts_with(element + ".") && channel.codes.empty() && !channel.is_on_request) channels_.push_back(&channel);
    for (std::size_t u = 0; u < system.units.size(); ++u)
      if (system.element_names[static_cast<std::size_t>(system.units[u].element)] == element) units_.push_back(u);
    const std::vector<const OwnState*> states = own_states(model);
    for (std::size_t i = 0; i < states.size(); ++i)
      if (states[i]->name == element) inner_.push_back(static_cast<std::size_t>(own_state_group(system)->first_inner) + i);
    y_.resize(static_cast<std::size_t>(system.largest_dimension()));
    dy_.resize(y_.size());
    dynamics_.set_left_limit_time(std::numeric_limits<double>::infinity());
  }

  std::vector<double> values(double t) {
    state_.t = t;
    Snapshot snapshot = evaluate();
    for (const std::size_t u : units_) {
      const Unit& unit = system_.units[u];
      state_.mode[u] = unit.group->initial_mode(unit.index, dynamics_.evaluation());
    }
    if (!units_.empty()) snapshot = evaluate();
    std::vector<double> values;
    for (const Channel* const channel : channels_) values.push_back(channel->value(snapshot));
    const double* const inner_rate = dy_.data() + 2 * dynamics_.coordinate_count();
    for (const std::size_t i : inner_) values.push_back(inner_rate[i]);
    return values;
  }

private:
  Snapshot evaluate() {
    dynamics_.set_state(state_);
    dynamics_.pack(state_, y_.data());
    dynamics_.rates(state_.t, y_.data(), dy_.data());
    return dynamics_.snapshot(dy_.data());
  }

  const System& system_;
  State state_;
  Dynamics dynamics_;
  std::vector<const Channel*> channels_;
  std::vector<std::size_t> units_, inner_; ///< indices in System::units and State::inner
  std::vector<double> y_, dy_;
};

bool are_alike(const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(a[i] - b[i]) > k_alike * std::max(std::abs(a[i]), std::abs(b[i]))) return false;
  return true;
}

// Returns the position of sample i within its interval. The golden ratio avoids aliasing: evenly spaced samples could meet a harmonic
// always at the same phase.
double golden(int i) { return std::fmod(i * 0.6180339887498949, 1.0); }

// First sample after the end of a run at which a formula has an effect that the run did not show.
struct LaterBehaviour {
  double t = 0.0;        ///< s
  bool is_first = false; ///< true: the formula is constant before t; false: its magnitude exceeds all earlier ones
};

// Largest magnitudes of an element's channels.
class LargestMagnitudes {
public:
  void add(const std::vector<double>& values) {
    largest_.resize(values.size(), 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) largest_[i] = std::max(largest_[i], std::abs(values[i]));
  }
  [[nodiscard]] const std::vector<double>& largest() const { return largest_; }
  [[nodiscard]] bool are_exceeded_by(const std::vector<double>& values) const {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (std::abs(values[i]) > k_larger * largest_[i]) return true;
    return false;
  }

private:
  std::vector<double> largest_;
};

std::optional<LaterBehaviour> late_look(LaterEvaluation& at, double end) {
  const std::vector<double> first = at.values(0.0);
  bool depends = false;
  LargestMagnitudes within, behind, far_behind;
  within.add(first);
  for (int i = 1; i <= k_samples; ++i) {
    const std::vector<double> values = at.values(i == k_samples ? end : end * golden(i));
    depends = depends || !are_alike(values, first);
    within.add(values);
  }
  std::optional<LaterBehaviour> begins, grows;
  const auto look = [&](double t) {
    const std::vector<double> values = at.values(t);
    if (!depends && !begins && !are_alike(values, first)) begins = LaterBehaviour{t, true};
    if (depends && !grows && within.are_exceeded_by(values)) grows = LaterBehaviour{t, false};
    (t > k_far * end ? far_behind : behind).add(values);
  };
  for (int i = 1; i <= k_samples; ++i) look(end * (1.0 + (k_near - 1.0) * (i - golden(i)) / k_samples));
  for (int i = 1; i <= k_samples; ++i)
    look(end * portable::pow(10.0, portable::log10(k_near) + portable::log10(k_behind / k_near) * i / k_samples));
  // A force that grows up to the last sample, such as c t, has no full size that a run could reach, so only a late beginning is reported.
  if (behind.are_exceeded_by(far_behind.largest())) return begins;
  return begins ? begins : grows;
}

} // namespace

std::vector<Finding> late_formulas(const LoadedModel& loaded, const RunResult& result) {
  std::vector<Finding> findings;
  const double end = result.final_state.t;
  for (const ElementEntry& entry : loaded.model.elements) {
    if (!uses_time(entry)) continue;
    try {
      LaterEvaluation at(loaded.model, *loaded.system, result.final_state, entry.element->name);
      const std::optional<LaterBehaviour> late = late_look(at, end);
      if (!late) continue;
      const std::string what = late->is_first ? "begins to depend on the time by" : "is larger than in the whole run at";
      findings.push_back({late->is_first ? "load_behind_end" : "load_still_grows", FindingLevel::warning,
                          "the formula of '" + entry.element->name + "' " + what + " t = " + rounded_text(late->t, 3) +
                              " s, but the run ends at " + number_text(end) + " s: what it does then is not judged",
                          entry.element->where});
    } catch (const NumericalFailure&) { // the formula has no value at other times
    }
  }
  return findings;
}

} // namespace steplap
