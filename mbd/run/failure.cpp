#include "mbd/run/failure.h"

#include "mbd/base/shown_text.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/integrators/scene_rate.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/motion_formula.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

// Times after the last step at which formulas are tried, in rounding errors of time: from the shortest step that integrators make to well
// beyond the last ones, each k_growth times the one before.
constexpr double k_nearest = 16.0, k_farthest = 1e7, k_growth = 4.0;

// Returns the location of an element or body in the model file.
const Location* place_of(const Model& model, const std::string& name) {
  for (const ElementEntry& entry : model.elements)
    if (entry.element->name == name) return &entry.element->where;
  for (const Body& body : model.bodies)
    if (body.name == name) return &body.where;
  return nullptr;
}

// Returns the first element whose formula has no finite value soon after `last`.
std::optional<int> element_without_value(const State& last, double step, const System& system) {
  std::vector<FormulaInMotion> formulas;
  for (const auto& group : system.groups) group->register_formulas(formulas);
  if (formulas.empty()) return {};
  Dynamics dynamics(system);
  dynamics.set_state(last);
  const auto n = static_cast<std::size_t>(dynamics.dimension());
  std::vector<double> y(n), rate(n), ahead(n), unused(n);
  dynamics.pack(last, y.data());
  dynamics.rates(last.t, y.data(), rate.data());
  // The last adaptive step ended as close to the place without a value as rounding of time permits.
  const double rounding = std::numeric_limits<double>::epsilon() * rounding_time_scale(last.t, system);
  const double farthest = std::max(k_farthest * rounding, step);
  for (double h = 0.0; h < farthest;) {
    h = std::min(std::max(k_growth * h, k_nearest * rounding), farthest);
    for (std::size_t i = 0; i < n; ++i) ahead[i] = y[i] + h * rate[i];
    dynamics.rates(last.t + h, ahead.data(), unused.data());
    const Evaluation& e = dynamics.evaluation();
    for (const FormulaInMotion& each : formulas) {
      const OwnCoordinate<double> own = each.own ? each.own(e) : OwnCoordinate<double>{};
      const SwitchBits bits = each.unit < 0 ? 0 : e.mode[each.unit];
      if (!std::isfinite(each.formula->value<double>(e, own, NumericSignalEvaluator{last.t + h}, bits, nullptr))) return each.element;
    }
  }
  return {};
}

} // namespace

Failure failure_of(const NumericalFailure& failure, const Model& model, const System& system, double t) {
  Failure told;
  if (dynamic_cast<const RunStopped*>(&failure)) told.kind = FailureKind::stopped;
  std::vector<std::string> names;
  if (const auto* at_element = dynamic_cast<const ElementFailure*>(&failure)) names = at_element->elements();
  if (const auto* constraint = dynamic_cast<const ConstraintFailure*>(&failure)) names = {system.element_names[constraint->element]};
  told.text = failure.what();
  told.t = t;
  const char* before = " (";
  for (const std::string& name : names) {
    const Location* where = place_of(model, name);
    told.elements.push_back({name, where ? *where : Location{}});
    if (!where || where->line == 0) continue;
    told.text += before + ("'" + name + "': " + where->file + ":" + std::to_string(where->line));
    before = ", ";
  }
  if (*before == ',') told.text += ")";
  return told;
}

std::optional<Failure> formula_failure(const State& last, double step, const Model& model, const System& system) {
  try {
    const std::optional<int> element = element_without_value(last, step, system);
    if (!element) return {};
    const std::string& name = system.element_names[*element];
    const std::string text =
        "the formula of '" + name + "' has no finite value after t = " + rounded_text(last.t, 12) +
        " s: something is divided by zero, or a root or logarithm is taken of what has none. Guard its argument, as in "
        "ln(max(x, 1e-9))";
    return failure_of(ElementFailure(text, {name}), model, system, last.t);
  } catch (const NumericalFailure&) {
    return {}; // the state itself cannot be evaluated
  }
}

} // namespace steplap
