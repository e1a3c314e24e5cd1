#include "run/late_formulas.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/formula/formula.h"
#include "mbd/model/action.h"
#include "mbd/model/formula_fields.h"
#include "mbd/simulation/run_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace steplap {

namespace {

constexpr int k_looks = 200;        // over the run, and as many evenly and in even ratios behind it
constexpr double k_near = 10.0;     // run lengths over which looks behind the end are even
constexpr double k_behind = 1e4;    // run lengths up to which there are looks
constexpr double k_rounding = 1e-9; // of the largest value: what is alike

bool uses_time(const ElementEntry& entry) {
  if (as_action(*entry.element)) return false;
  for (const Field& field : entry.kind->fields.fields()) {
    if (!is_formula_field(field)) continue;
    try {
      const Formula formula(std::get<std::string>(field.get(entry.element.get())), field.name, {});
      if (std::any_of(formula.tree().begin(), formula.tree().end(), [](const FormulaNode& node) { return node.op == FormulaOp::time; }))
        return true;
    } catch (const ModelError&) { // no formula, or it is told where the element is compiled
    }
  }
  return false;
}

// Force of an element at other times, with bodies where the run left them.
class AtOtherTimes {
public:
  AtOtherTimes(const System& system, const State& state, const std::string& element) : system_(system), state_(state), dynamics_(system) {
    for (const Channel& channel : system.channels)
      if (channel.name.starts_with(element + ".") && channel.codes.empty() && !channel.is_on_request) channels_.push_back(&channel);
    for (std::size_t u = 0; u < system.units.size(); ++u)
      if (system.element_names[static_cast<std::size_t>(system.units[u].element)] == element) units_.push_back(u);
    y_.resize(static_cast<std::size_t>(system.largest_dimension()));
    dy_.resize(y_.size());
    dynamics_.set_time_limit(std::numeric_limits<double>::infinity());
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
  std::vector<std::size_t> units_;
  std::vector<double> y_, dy_;
};

bool are_alike(const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(a[i] - b[i]) > k_rounding * std::max(std::abs(a[i]), std::abs(b[i]))) return false;
  return true;
}

// The first look behind the end at which the formula does what it never did before.
std::optional<double> begins_at(AtOtherTimes& at, double end) {
  const std::vector<double> first = at.values(0.0);
  for (int i = 1; i <= k_looks; ++i)
    if (!are_alike(at.values(end * i / k_looks), first)) return std::nullopt;
  for (int i = 1; i <= k_looks; ++i)
    if (const double t = end * (1.0 + (k_near - 1.0) * i / k_looks); !are_alike(at.values(t), first)) return t;
  for (int i = 1; i <= k_looks; ++i)
    if (const double t = end * portable::pow(10.0, portable::log10(k_near) + portable::log10(k_behind / k_near) * i / k_looks);
        !are_alike(at.values(t), first))
      return t;
  return std::nullopt;
}

} // namespace

std::vector<Finding> late_formulas(const LoadedModel& loaded, const RunResult& result) {
  std::vector<Finding> findings;
  const double end = result.final_state.t;
  for (const ElementEntry& entry : loaded.model.elements) {
    if (!uses_time(entry)) continue;
    try {
      AtOtherTimes at(*loaded.system, result.final_state, entry.element->name);
      if (const std::optional<double> t = begins_at(at, end))
        findings.push_back({"load_behind_end", FindingLevel::warning,
                            "the formula of '" + entry.element->name + "' begins to depend on the time by t = " + rounded_text(*t, 3) +
                                " s, but the run ends at " + number_text(end) + " s: what it does then is not judged",
                            entry.element->where});
    } catch (const NumericalFailure&) { // at another time the machine cannot be
    }
  }
  return findings;
}

} // namespace steplap
