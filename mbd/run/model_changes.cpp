#include "mbd/run/model_changes.h"

#include "mbd/base/number_text.h"
#include "mbd/formula/unit_dimension.h"
#include "mbd/model/field_units.h"
#include "mbd/run/model_entries.h"

#include <filesystem>
#include <unordered_map>

namespace steplap {

namespace {

std::string text_of(const FieldValue& value) {
  const auto listed = [](const auto& list, const auto& text) {
    std::string all;
    for (const auto& item : list) all += (all.empty() ? "" : ", ") + text(item);
    return "[" + all + "]";
  };
  const auto point = [](const Vec2& p) { return "[" + number_text(p.x()) + ", " + number_text(p.y()) + "]"; };
  const auto points = [&](const std::vector<Vec2>& list) { return listed(list, point); };
  if (const auto* x = std::get_if<double>(&value)) return number_text(*x);
  if (const auto* n = std::get_if<long>(&value)) return std::to_string(*n);
  if (const auto* is = std::get_if<bool>(&value)) return *is ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* p = std::get_if<Vec2>(&value)) return point(*p);
  if (const auto* list = std::get_if<std::vector<double>>(&value)) return listed(*list, [](double x) { return number_text(x); });
  if (const auto* list = std::get_if<std::vector<Vec2>>(&value)) return points(*list);
  if (const auto* list = std::get_if<std::vector<std::string>>(&value)) return listed(*list, [](const std::string& text) { return text; });
  return listed(std::get<std::vector<std::vector<Vec2>>>(value), points);
}

std::optional<double> number_in(const FieldValue& value) {
  if (const auto* x = std::get_if<double>(&value)) return *x;
  if (const auto* n = std::get_if<long>(&value)) return static_cast<double>(*n);
  return std::nullopt;
}

bool is_same(const Field& field, const FieldValue& a, const FieldValue& b) {
  const auto* first = std::get_if<std::string>(&a);
  const auto* second = std::get_if<std::string>(&b);
  if (field.type == FieldType::file && first && second)
    return std::filesystem::path(*first).lexically_normal() == std::filesystem::path(*second).lexically_normal();
  return a == b;
}

class Comparison {
public:
  Comparison(const Model& a, const Model& b) : a_(a), b_(b) {}

  std::vector<ModelChange> changes() {
    compare_parameters();
    const std::vector<ModelEntry> before = entries_of(a_), after = entries_of(b_);
    const auto by_path = [](const std::vector<ModelEntry>& list) {
      std::unordered_map<std::string, const ModelEntry*> found;
      for (const ModelEntry& entry : list) found.emplace(entry.path, &entry);
      return found;
    };
    const auto first = by_path(before), second = by_path(after);
    for (const ModelEntry& entry : before) {
      const auto other = second.find(entry.path);
      if (other == second.end()) add(ModelChange::Kind::removed, entry);
      else compare(entry, *other->second);
    }
    for (const ModelEntry& entry : after)
      if (!first.contains(entry.path)) add(ModelChange::Kind::added, entry);
    return std::move(changes_);
  }

private:
  void add(ModelChange::Kind kind, const ModelEntry& entry) {
    ModelChange change;
    change.kind = kind;
    change.path = entry.path;
    (kind == ModelChange::Kind::added ? change.after_text : change.before_text) = entry.kind.empty() ? "there" : entry.kind;
    changes_.push_back(std::move(change));
  }

  // Compares formulas by name: a value with the same formula in both models is not a change.
  void compare_parameters() {
    const Parameters &before = a_.parameters, &after = b_.parameters;
    for (std::size_t i = 0; i < before.entries.size(); ++i) {
      const Parameter& p = before.entries[i];
      const auto j = after.find(p.name);
      ModelChange change;
      change.path = "parameters." + p.name;
      change.unit = unit_text(p.powers);
      change.before = before.values[i];
      change.before_text = p.text;
      if (!j) change.kind = ModelChange::Kind::removed;
      else {
        const Parameter& other = after.entries[*j];
        if (before.values[i] == after.values[*j] && p.powers == other.powers) continue;
        change.after = after.values[*j];
        change.after_text = other.text;
        change.follows = p.formula && other.formula && p.text == other.text;
      }
      changes_.push_back(std::move(change));
    }
    for (std::size_t j = 0; j < after.entries.size(); ++j) {
      const Parameter& p = after.entries[j];
      if (before.find(p.name)) continue;
      ModelChange change;
      change.kind = ModelChange::Kind::added;
      change.path = "parameters." + p.name;
      change.unit = unit_text(p.powers);
      change.after = after.values[j];
      change.after_text = p.text;
      changes_.push_back(std::move(change));
    }
  }

  void compare(const ModelEntry& before, const ModelEntry& after) {
    if (before.kind != after.kind) {
      ModelChange change;
      change.path = before.path + ".kind";
      change.before_text = before.kind;
      change.after_text = after.kind;
      changes_.push_back(std::move(change));
      return; // fields of other types cannot be compared
    }
    for (const FieldTable* table : {before.fields, before.common})
      if (table)
        for (const Field& field : table->fields()) compare_field(before, after, *table, field);
  }

  void compare_field(const ModelEntry& before, const ModelEntry& after, const FieldTable& table, const Field& field) {
    const FieldValue a = field.get(before.object), b = field.get(after.object);
    if (is_same(field, a, b)) return;
    const std::string path = before.path.empty() ? field.name : before.path + "." + field.name;
    const std::string unit = unit_in(table, field, before.object);
    const auto* p = std::get_if<Vec2>(&a);
    const auto* q = std::get_if<Vec2>(&b);
    if (p && q) {
      for (int k = 0; k < 2; ++k) add_value(path + "." + std::to_string(k), unit, (*p)[k], (*q)[k]);
      return;
    }
    const auto* list = std::get_if<std::vector<double>>(&a);
    const auto* other = std::get_if<std::vector<double>>(&b);
    if (list && other && list->size() == other->size()) {
      for (std::size_t k = 0; k < list->size(); ++k) add_value(path + "." + std::to_string(k), unit, (*list)[k], (*other)[k]);
      return;
    }
    add_value(path, unit, a, b);
  }

  void add_value(const std::string& path, const std::string& unit, const FieldValue& a, const FieldValue& b) {
    if (a == b) return;
    ModelChange change;
    change.path = path;
    change.before = number_in(a);
    change.after = number_in(b);
    if ((change.before || change.after) && unit != "*") change.unit = unit; // fields with the unit "*" accept any unit
    change.before_text = text_of(a);
    change.after_text = text_of(b);
    change.follows = !formula_at(a_, path).empty() && formula_at(a_, path) == formula_at(b_, path);
    changes_.push_back(std::move(change));
  }

  static std::string formula_at(const Model& model, const std::string& path) {
    for (const ParameterUse& use : model.parameters.uses)
      if (use.path == path) return use.text;
    return "";
  }

  const Model &a_, &b_;
  std::vector<ModelChange> changes_;
};

} // namespace

std::vector<ModelChange> changes_between(const Model& a, const Model& b) { return Comparison(a, b).changes(); }

} // namespace steplap
