#include "transformer/core/uncertain.h"

#include "mbd/io/units.h"
#include "mbd/model/model_path.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace steplap {

namespace {

void check_path(const Uncertain& uncertain, const std::string& path, const Model& model) {
  try {
    if (std::holds_alternative<std::string>(value_of(model, path)))
      throw ModelError(uncertain.place("paths"), "it is a text; a limit such as \"500 kN\" varies as a parameter: give it in "
                                                 "[parameters], and name that parameter in 'paths'");
    static_cast<void>(number_of(model, path));
  } catch (const ModelError& error) {
    throw ModelError(uncertain.place("paths"),
                     "'" + path + "' of uncertain '" + uncertain.name + "': " + error.diagnostics().front().message);
  }
}

void check(const Uncertain& uncertain, const Model& model) {
  if (uncertain.paths.empty())
    throw ModelError(uncertain.place("paths"), "uncertain '" + uncertain.name + "' has no path: say which number of the model it is");
  for (const std::string& path : uncertain.paths) check_path(uncertain, path, model);
  const std::string unit = unit_of(model, uncertain.paths.front());
  for (const std::string& path : uncertain.paths)
    if (unit_of(model, path) != unit)
      throw ModelError(uncertain.place("paths"),
                       "the paths of uncertain '" + uncertain.name + "' have different units: one number cannot be both");
  if (uncertain.source_text.empty())
    throw ModelError(uncertain.where,
                     "uncertain '" + uncertain.name + "' needs 'source_text': by whom it was " + uncertain.source + ", or why");
  const std::pair<const char*, const std::string*> texts[] = {
      {"mean", &uncertain.mean},  {"standard_deviation", &uncertain.standard_deviation},
      {"low", &uncertain.low},    {"high", &uncertain.high},
      {"mode", &uncertain.mode},  {"lower", &uncertain.lower},
      {"upper", &uncertain.upper}};
  for (const auto& [field, text] : texts) static_cast<void>(value_of_text(uncertain, field, *text, model));
}

} // namespace

std::optional<double> value_of_text(const Uncertain& uncertain, const std::string& field, const std::string& text, const Model& model) {
  if (text.empty()) return {};
  const std::string unit = uncertain.is_factor ? "" : unit_of(model, uncertain.paths.front());
  double value = 0.0;
  const auto [rest, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status == std::errc() && rest == text.data() + text.size() && std::isfinite(value)) return value;
  const Quantity quantity = parse_quantity(text, unit);
  if (!quantity.problem.empty())
    throw ModelError(uncertain.place(field), "'" + field + "' of uncertain '" + uncertain.name + "': " + quantity.problem);
  return quantity.value;
}

const TableKind& uncertain_kind() {
  static const TableKind kind = [] {
    using T = Uncertain;
    TableKind k;
    k.name = "uncertain";
    k.doc = "A number of the model that is not known exactly. Usual runs take the model's own value; `steplap assess` draws it from the "
            "distribution. Of several models a name stands for one number.";
    FieldTable& f = k.fields;
    f.add("paths", &T::paths).required().doc("fields of the model that get the value, as in [\"core.core.static_friction\"]");
    f.add("factor", &T::is_factor).doc("true: the value multiplies what the model has at the paths");
    f.add("distribution", &T::distribution)
        .one_of({"normal", "lognormal", "uniform", "triangular", "gumbel"})
        .required()
        .doc("by its moments, or by 'low' and 'high'");
    f.add("mean", &T::mean).as(FieldType::quantity).doc("of the distribution, in the unit of the paths");
    f.add("standard_deviation", &T::standard_deviation).as(FieldType::quantity).doc("of the distribution, in the unit of the paths");
    f.add("cov", &T::cov).positive().doc("coefficient of variation: standard deviation over mean");
    f.add("low", &T::low).as(FieldType::quantity).doc("lower end of a uniform or triangular distribution");
    f.add("high", &T::high).as(FieldType::quantity).doc("upper end");
    f.add("mode", &T::mode).as(FieldType::quantity).doc("most likely value of a triangular distribution");
    f.add("lower", &T::lower).as(FieldType::quantity).doc("the distribution is truncated below");
    f.add("upper", &T::upper).as(FieldType::quantity).doc("the distribution is truncated above");
    f.add("source", &T::source).one_of({"assumed", "specified", "measured"}).required().doc("how the distribution is known");
    f.add("source_text", &T::source_text).doc("needed: by whom, when, from which document");
    k.holds<T>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element& table, Model& model) { check(static_cast<const Uncertain&>(table), model); };
    return k;
  }();
  return kind;
}

std::vector<const Uncertain*> uncertain_of(const Model& model) {
  std::vector<const Uncertain*> all;
  for (const TableEntry& entry : model.tables)
    if (entry.kind == &uncertain_kind()) all.push_back(static_cast<const Uncertain*>(entry.table.get()));
  return all;
}

} // namespace steplap
