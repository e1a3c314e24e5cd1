#include "mbd/run/failure.h"

#include "mbd/dynamics/dynamics.h"
#include "mbd/system/element_failure.h"

namespace steplap {

namespace {

// Returns the location of an element or body in the model file.
const Location* place_of(const Model& model, const std::string& name) {
  for (const ElementEntry& entry : model.elements)
    if (entry.element->name == name) return &entry.element->where;
  for (const Body& body : model.bodies)
    if (body.name == name) return &body.where;
  return nullptr;
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

} // namespace steplap
