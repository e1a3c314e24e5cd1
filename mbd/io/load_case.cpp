#include "mbd/io/load_case.h"

#include "mbd/base/number_text.h"

#include <algorithm>

namespace steplap {

namespace {

void check(const LoadCase& one) {
  const auto fail = [&one](const std::string& field, const std::string& message) {
    throw ModelError(one.place(field), "case '" + one.name + "': " + message);
  };
  if (one.source.empty()) fail("source", "'source' is empty: name the document that requires the load, with its edition");
  if (one.criteria.empty() && one.places.contains("criteria"))
    fail("criteria", "'criteria' is empty, so nothing would be judged: leave it out to apply all criteria");
  const auto sets_case = [](const std::string& change) { return change.starts_with("case."); };
  if (std::any_of(one.changes.begin(), one.changes.end(), sets_case))
    fail("set", "'set' changes a load case, which the run of a case does not read: give the value in the case itself");
  const auto sets_gravity = [](const std::string& change) { return change.starts_with("gravity"); };
  if (one.pull && std::any_of(one.changes.begin(), one.changes.end(), sets_gravity))
    fail("pull", "'pull' is added to the gravity of the model, which 'set' replaces: give one of them");
}

} // namespace

std::vector<std::string> LoadCase::overrides(const Vec2& gravity) const {
  std::vector<std::string> all = changes;
  if (!pull) return all;
  const Vec2 apparent = gravity + *pull;
  all.push_back("gravity=[" + number_text(apparent.x()) + ", " + number_text(apparent.y()) + "]");
  return all;
}

const TableKind& case_kind() {
  static const TableKind kind = [] {
    using T = LoadCase;
    TableKind k;
    k.name = "case";
    k.doc = "A load that the machine must withstand: the model with other values. A run of the model itself ignores it; "
            "How to run all cases: `docs/how-to/sign_load_cases.md`.";
    FieldTable& f = k.fields;
    f.add("set", &T::changes).doc("values of this case, each \"path=value\", such as \"element.drive.signal=braking\"");
    f.add("pull", &T::pull)
        .in("m/s^2")
        .doc("[x, y], added to gravity from the start: minus the constant acceleration of the vehicle; braking pulls forward");
    f.add("plane", &T::plane)
        .one_of({"", "lengthwise", "transverse"})
        .doc("section of the machine that the model shows; cases of one name in models of both sections act at the same time");
    f.add("source", &T::source).required().doc("document that requires the load, with its edition");
    f.add("criteria", &T::criteria).doc("names of the [[acceptance]] that apply, patterns with * and ?; all if not given");
    k.holds<T>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element& table, Model&) { check(static_cast<const T&>(table)); };
    return k;
  }();
  return kind;
}

std::vector<LoadCase> load_cases_of(const Model& model) {
  std::vector<LoadCase> cases;
  for (const TableEntry& entry : model.tables)
    if (entry.kind == &case_kind()) cases.push_back(static_cast<const LoadCase&>(*entry.table));
  return cases;
}

} // namespace steplap
