// Study kind "needs": finds which parts of a scene matter. Each element is removed or made rigid and each body is fixed, one at a time, and
// the change of the responses is measured.
#include "tools/study/kinds.h"

#include "elements/joints.h"
#include "mbd/model/completion.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

namespace {

/// Settings of a "needs" study.
struct NeedsSettings : KindSettings {
  double accuracy = 0.01; ///< relative changes of responses up to this value do not matter
};

FieldTable needs_fields() {
  FieldTable t;
  t.add("accuracy", &NeedsSettings::accuracy).positive().at_most(1).doc("changes of responses up to this share of them do not matter");
  return t;
}

// Removes plots and criteria, which may refer to channels that a variant lacks and do not affect the motion. Removes requested channels of
// the removed element `gone`; responses may use the others.
void drop_presentation(Model& model, const std::string& gone = "") {
  std::erase_if(model.tables, [](const TableEntry& e) { return e.kind->name == "plot" || e.kind->name == "acceptance"; });
  model.plots.clear();
  model.criteria.clear();
  if (gone.empty()) return;
  const auto is_of_it = [&gone](const std::string& text) { return text.find(gone) != std::string::npos; };
  std::erase_if(model.output.also, [&](const std::string& pattern) { return is_of_it(pattern); });
  std::erase_if(model.tables, [&](const TableEntry& e) {
    const auto* channel = dynamic_cast<const DefinedChannel*>(e.table.get());
    return channel && is_of_it(channel->expression);
  });
}

std::string marker_in(const ElementEntry& entry, const char* field_name) {
  const Field* field = entry.kind->fields.find(field_name);
  if (!field || field->type != FieldType::marker) return "";
  const FieldValue value = field->get(entry.element.get());
  const std::string* name = std::get_if<std::string>(&value);
  return name ? *name : "";
}

ElementEntry weld_between(const std::string& name, const std::string& a, const std::string& b) {
  const ElementKind& kind = weld_kind();
  std::shared_ptr<Element> weld = kind.create();
  weld->name = name;
  kind.fields.find("a")->set(weld.get(), a);
  kind.fields.find("b")->set(weld.get(), b);
  return {&kind, std::move(weld)};
}

// Returns the relative change of a response; infinite if it was zero.
double change_of(double before, double after) {
  if (before == after) return 0.0;
  return std::abs(after - before) / std::abs(before);
}

// Returns true if completing the model, for example by [[core]], creates the removed element again.
bool comes_back(const Model& given, const ModelVariant& variant) {
  if (variant.gone.empty()) return false;
  try {
    Model model = given;
    variant.apply(model);
    const Model whole = completed(model);
    return std::any_of(whole.elements.begin(), whole.elements.end(),
                       [&](const ElementEntry& e) { return e.element->name == variant.gone; });
  } catch (const ModelError&) {
    return false; // the sample reports the error
  }
}

struct Row {
  std::string name, response, refused;
  double change = 0.0;
};

// Returns all variants of a model as given. Findings use their names.
std::vector<ModelVariant> variants_of(const Model& model) {
  std::vector<ModelVariant> variants;
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    const ElementEntry& entry = model.elements[e];
    const std::string name = entry.element->name, a = marker_in(entry, "a"), b = marker_in(entry, "b");
    variants.push_back({"without '" + name + "'",
                        [e, name](Model& m) {
                          m.elements.erase(m.elements.begin() + static_cast<long>(e));
                          drop_presentation(m, name);
                        },
                        name});
    if (a.empty() || b.empty() || entry.kind->name == "weld") continue;
    variants.push_back({"'" + name + "' rigid", [e, name, a, b](Model& m) {
                          m.elements[e] = weld_between(name, a, b);
                          drop_presentation(m);
                        }});
  }
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (model.bodies[i].fixed) continue;
    variants.push_back({"body '" + model.bodies[i].name + "' fixed", [i](Model& m) {
                          m.bodies[i].fixed = true;
                          m.bodies[i].velocity = Vec2::Zero();
                          m.bodies[i].angular_velocity = 0.0;
                          drop_presentation(m);
                        }});
  }
  return variants;
}

// Adds the variable "variant", whose value selects the variant.
void add_variants(LoadedStudy& loaded) {
  if (loaded.models.size() != 1) return;
  loaded.variants = variants_of(loaded.models.front()->given);
  Variable v;
  v.name = "variant";
  v.value = 0.0;
  v.where = loaded.study.where;
  loaded.study.variables.push_back(v);
}

void check_needs(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const Study& study = loaded.study;
  if (loaded.models.size() != 1) problems.push_back({study.where, "a study of the kind 'needs' takes one model"});
  if (study.responses.empty()) problems.push_back({study.where, "a study of the kind 'needs' needs a [[response]]"});
  for (const Response& r : study.responses)
    if (r.measure == Measure::verdict) problems.push_back({r.where, "a verdict is no response here: variants drop the model's criteria"});
}

Answer run_needs(StudyRun& run) {
  const std::vector<ModelVariant>& variants = run.loaded.variants;
  const std::size_t responses = run.study().responses.size();
  std::vector<double> points;
  for (std::size_t k = 0; k <= variants.size(); ++k) {
    points.insert(points.end(), run.law.nominal().begin(), run.law.nominal().end());
    points.back() = static_cast<double>(k); // the variable "variant" is the last one
  }
  run.evaluator.expect(static_cast<long>(variants.size() + 1));
  const std::vector<StoredSample>& samples = run.evaluator.evaluate(points);
  Answer answer;
  const Outcome& base = samples[0].outcome;
  if (base.status != SampleStatus::ok) {
    Finding f{"needs", "the model as it is", "responses"};
    f.samples = 1;
    f.status = std::string(name_of(base.status)) + ": " + base.reason;
    answer.findings.push_back(f);
    answer.degrade(Standing::not_trusted);
    return answer;
  }
  std::vector<Row> rows;
  for (std::size_t k = 0; k < variants.size(); ++k) {
    const Outcome& outcome = samples[k + 1].outcome;
    Row row{variants[k].name, "", "", 0.0};
    if (outcome.status != SampleStatus::ok) {
      row.refused = std::string("cannot be: ") + name_of(outcome.status) + ": " + outcome.reason;
      row.change = std::numeric_limits<double>::infinity();
    }
    if (comes_back(run.loaded.models.front()->given, variants[k])) row.refused = "cannot be: a table of the model puts it in again";
    for (std::size_t r = 0; r < responses && row.refused.empty(); ++r) {
      const double change = change_of(base.numbers[r], outcome.numbers[r]);
      if (std::isnan(change)) row.refused = "'" + run.study().responses[r].name + "' has no value then";
      if (change > row.change || row.response.empty()) row.change = change, row.response = run.study().responses[r].name;
    }
    rows.push_back(row);
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return a.refused.empty() != b.refused.empty() ? a.refused.empty() : a.change < b.change;
  });
  long dispensable = 0;
  for (const Row& row : rows) {
    Finding f{"needs", row.name, "largest change"};
    f.samples = run.evaluator.asked();
    if (row.refused.empty()) f.value = row.change;
    const bool is_small = row.refused.empty() && row.change <= settings_of<NeedsSettings>(run.study()).accuracy;
    dispensable += is_small;
    f.status = !row.refused.empty() ? row.refused : "of '" + row.response + "'" + (is_small ? "; may be" : "");
    answer.findings.push_back(f);
  }
  char text[160];
  std::snprintf(text, sizeof text, "%ld of %zu simplifications change no response by more than %g of its value alone; together they may.",
                dispensable, rows.size(), settings_of<NeedsSettings>(run.study()).accuracy);
  answer.notes.emplace_back(text);
  return answer;
}

} // namespace

StudyKind needs_kind() {
  StudyKind kind;
  kind.name = "needs";
  kind.doc = "what the scene needs: every element and body in turn left out, rigid or fixed";
  kind.fields = needs_fields();
  kind.holds<NeedsSettings>();
  kind.shown = {"accuracy"};
  kind.parts = {{"need", "largest change", UnitOf::none, 3}};
  kind.prepare = add_variants;
  kind.check = check_needs;
  kind.run = run_needs;
  return kind;
}

} // namespace steplap::study
