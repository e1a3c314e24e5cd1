#include "tools/explore/slider.h"

#include "mbd/formula/unit_dimension.h"
#include "mbd/model/field_units.h"
#include "mbd/run/model_entries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace steplap {

namespace {

constexpr std::size_t k_longest_list = 40; ///< longest list of numbers that gets sliders; longer lists are samples of a record

// Groups of sliders: a field whose name contains the first text belongs to the group named by the second.
constexpr std::array<std::array<const char*, 2>, 13> k_groups{{{"friction", "friction"},
                                                               {"pressure", "pressure"},
                                                               {"peak", "peak"},
                                                               {"amplitude", "peak"},
                                                               {"duration", "duration"},
                                                               {"gap", "gap"},
                                                               {"clearance", "gap"},
                                                               {"slack", "gap"},
                                                               {"lower", "gap"},
                                                               {"upper", "gap"},
                                                               {"preload", "pressure"},
                                                               {"pretension", "pressure"},
                                                               {"stiffness", "stiffness"}}};

std::string group_of(const std::string& field) {
  for (const auto& [part, group] : k_groups)
    if (field.find(part) != std::string::npos) return group;
  return "";
}

// Sets the slider's range to 0.2 to 2 times its value. At zero the field's own range is used, or ±1 unit if it has none.
void choose_range(Slider& slider, double minimum, double maximum) {
  const double value = slider.value;
  slider.least = value > 0.0 ? 0.2 * value : value < 0.0 ? 2.0 * value : -1.0;
  slider.most = value > 0.0 ? 2.0 * value : value < 0.0 ? 0.2 * value : 1.0;
  slider.least = std::max(slider.least, minimum);
  slider.most = std::min(slider.most, maximum);
  if (slider.is_whole) {
    slider.least = std::floor(slider.least);
    slider.most = std::ceil(slider.most);
  }
  if (slider.most > slider.least) return;
  slider.least = std::min(value, slider.least);
  slider.most = slider.least + std::max(1.0, std::abs(value));
}

class Finder {
public:
  explicit Finder(const Model& given) : given_(given) {
    for (const ParameterUse& use : given.parameters.uses) follows_.insert(use.path);
  }

  std::vector<Slider> found() {
    add_parameters();
    for (const ModelEntry& entry : entries_of(given_))
      for (const FieldTable* table : {entry.fields, entry.common})
        if (table)
          for (const Field& field : table->fields()) add_field(entry, *table, field);
    return std::move(sliders_);
  }

private:
  void add_parameters() {
    const Parameters& parameters = given_.parameters;
    for (std::size_t i = 0; i < parameters.entries.size(); ++i) {
      const Parameter& parameter = parameters.entries[i];
      if (parameter.formula) continue;
      Slider slider{"parameters." + parameter.name, "parameters", unit_text(parameter.powers), parameter.meaning, parameters.values[i]};
      constexpr double k_infinity = std::numeric_limits<double>::infinity();
      choose_range(slider, parameter.least.value_or(-k_infinity), parameter.most.value_or(k_infinity));
      slider.has_own_range = parameter.least && parameter.most && *parameter.most > *parameter.least;
      if (slider.has_own_range) {
        slider.least = *parameter.least;
        slider.most = *parameter.most;
      }
      slider.needs_file = std::any_of(parameters.uses.begin(), parameters.uses.end(),
                                      [&](const ParameterUse& use) { return !use.can_be_set && parameters.needs(use.formula, i); });
      sliders_.push_back(std::move(slider));
    }
  }

  void add_field(const ModelEntry& entry, const FieldTable& table, const Field& field) {
    const std::string path = entry.path.empty() ? field.name : entry.path + "." + field.name;
    const FieldValue value = field.get(entry.object);
    const std::string unit = unit_in(table, field, entry.object);
    const auto add = [&](const std::string& where, double number, const std::string& in) { add_number(where, number, in, field); };
    if (const auto* x = std::get_if<double>(&value)) add(path, *x, unit);
    if (const auto* n = std::get_if<long>(&value)) add(path, static_cast<double>(*n), unit);
    if (const auto* p = std::get_if<Vec2>(&value))
      for (int k = 0; k < 2; ++k) add(path + "." + std::to_string(k), (*p)[k], unit);
    if (const auto* list = std::get_if<std::vector<double>>(&value); list && list->size() <= k_longest_list)
      for (std::size_t k = 0; k < list->size(); ++k) add(path + "." + std::to_string(k), (*list)[k], unit);
    if (const auto* points = std::get_if<std::vector<Vec2>>(&value); points && 2 * points->size() <= k_longest_list)
      for (std::size_t k = 0; k < points->size(); ++k)
        for (int c = 0; c < 2; ++c)
          add(path + "." + std::to_string(k) + "." + std::to_string(c), (*points)[k][c],
              c == 1 && !field.unit2.empty() ? field.unit2 : unit);
  }

  void add_number(const std::string& path, double number, const std::string& unit, const Field& field) {
    if (!std::isfinite(number) || follows_.contains(path)) return;
    // Values outside their range are placeholders, for example of a fixed body.
    if (number < field.minimum || number > field.maximum || (field.is_minimum_excluded && number == field.minimum)) return;
    Slider slider{path, group_of(field.name), unit == "*" ? "" : unit, field.doc, number};
    slider.is_whole = field.type == FieldType::integer;
    if (number == 0.0) slider.group.clear(); // zero values have no group and appear in search results only
    choose_range(slider, field.minimum, field.maximum);
    if (field.is_minimum_excluded && slider.least <= field.minimum) slider.least += 0.01 * (slider.most - slider.least);
    sliders_.push_back(std::move(slider));
  }

  const Model& given_;
  std::set<std::string> follows_;
  std::vector<Slider> sliders_;
};

} // namespace

std::vector<Slider> sliders_of(const Model& given) { return Finder(given).found(); }

} // namespace steplap
