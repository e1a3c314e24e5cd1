#include "transformer/decision/criteria.h"

#include "mbd/io/document.h"
#include "mbd/io/read_input.h"
#include "mbd/io/units.h"
#include "transformer/decision/checked_table.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace steplap::assess {

namespace {

/// A quantity for criteria: the unit of its limit, whether it takes 'at_most', 'at_least' or no limit, and its basis.
struct CriterionQuantity {
  const char* name;
  const char* unit;
  enum class Limit { none, most, least } limit;
  CriterionBasis basis = CriterionBasis::runs;
};
using Limit = CriterionQuantity::Limit;
constexpr CriterionQuantity k_quantities[] = {{"peak", "m/s^2", Limit::most, CriterionBasis::reading},
                                              {"velocity_change", "m/s", Limit::most, CriterionBasis::reading},
                                              {"slip", "", Limit::none},
                                              {"slid", "m", Limit::most},
                                              {"overlap_left", "", Limit::least},
                                              {"margin", "", Limit::least},
                                              {"comes_apart", "", Limit::none},
                                              {"lift", "", Limit::none},
                                              {"acceptance", "", Limit::none},
                                              {"slip_probability", "", Limit::most, CriterionBasis::probability},
                                              {"damage_probability", "", Limit::most, CriterionBasis::probability}};

std::vector<std::string> quantity_names() {
  std::vector<std::string> names;
  for (const CriterionQuantity& q : k_quantities) names.push_back(q.name);
  return names;
}

FieldTable header_fields() {
  FieldTable t;
  t.add("name", &DecisionCriteria::name).required().doc("of the criteria together");
  t.add("text", &DecisionCriteria::text).doc("what they come to");
  t.add("source", &DecisionCriteria::source).doc("where they come from");
  t.add("tests", &DecisionCriteria::tests).doc("usual tests on arrival, whatever the decision");
  return t;
}

FieldTable criterion_fields() {
  using T = DecisionCriterion;
  FieldTable t;
  t.add("name", &T::name).required().doc("of the criterion");
  t.add("quantity", &T::quantity).one_of(quantity_names()).required().doc("what is asked");
  t.add("axis", &T::axis).one_of({"any", "x", "y", "z"}).doc("of the record");
  t.add("bandwidth", &T::bandwidth)
      .one_of({"record", "100 Hz", "17 Hz"})
      .doc("of a peak: as the record was filtered, or filtered by CFC 60 or CFC 10");
  t.add("at_most", &T::at_most_text).as(FieldType::quantity).doc("largest value");
  t.add("at_least", &T::at_least_text).as(FieldType::quantity).doc("smallest value");
  t.add("outcome", &T::outcome).one_of({"inspect", "return"}).doc("if it is not met");
  t.add("text", &T::text).doc("reason of the criterion");
  t.add("source", &T::source).doc("where it comes from");
  t.add("tests", &T::tests).doc("physical tests that would show the damage");
  return t;
}

class Reader {
public:
  Reader(Document document, DecisionCriteria& criteria) : document_(std::move(document)), criteria_(criteria) {
    refuse_control_characters(document_);
    problems_ = document_.problems;
  }
  void read() {
    TableReading reading;
    reading.subject = "the criteria";
    reading.known_keys = {"criterion"};
    read_checked_table(document_.root, header_fields(), &criteria_, reading, problems_);
    const Node* const array = document_.root.find("criterion");
    if (!array || !array->is_array_of_tables())
      problems_.push_back(
          {array ? array->where_key() : Location{criteria_.file, 1, 1}, "the criteria need a table [[criterion]] for each requirement"});
    else
      for (const Node& entry : array->children) read_criterion(entry);
    if (!problems_.empty()) throw ModelError(problems_);
  }

private:
  void read_criterion(const Node& entry) {
    DecisionCriterion criterion;
    criterion.where = entry.where();
    const std::size_t before = problems_.size();
    TableReading reading;
    reading.subject = "criterion '" + entry_name(entry) + "'";
    read_checked_table(entry, criterion_fields(), &criterion, reading, problems_);
    if (problems_.size() != before) return;
    read_limits(entry, criterion);
    criteria_.criteria.push_back(std::move(criterion));
  }
  void read_limits(const Node& entry, DecisionCriterion& c) {
    const auto& q = *std::find_if(std::begin(k_quantities), std::end(k_quantities),
                                  [&](const CriterionQuantity& each) { return c.quantity == each.name; });
    const auto at = [&](const char* key) { return entry.find(key) ? entry.find(key)->where() : entry.where(); };
    const auto add = [&](const char* key, const std::string& message) {
      problems_.push_back({at(key), "criterion '" + c.name + "': " + message});
    };
    if (q.limit == Limit::most && c.at_most_text.empty()) add("at_most", "'" + c.quantity + "' needs 'at_most'");
    if (q.limit == Limit::least && c.at_least_text.empty()) add("at_least", "'" + c.quantity + "' needs 'at_least'");
    if (q.limit != Limit::most && !c.at_most_text.empty()) add("at_most", "'" + c.quantity + "' takes no 'at_most'");
    if (q.limit != Limit::least && !c.at_least_text.empty()) add("at_least", "'" + c.quantity + "' takes no 'at_least'");
    if (c.quantity != "peak" && c.bandwidth != "record") add("bandwidth", "only a peak has a bandwidth");
    c.basis = q.basis;
    if (c.basis != CriterionBasis::reading && c.axis != "any") add("axis", "only what the recorder read has an axis");
    c.at_most = limit(c.at_most_text, q.unit, at("at_most"), c);
    c.at_least = limit(c.at_least_text, q.unit, at("at_least"), c);
  }
  std::optional<double> limit(const std::string& text, const std::string& unit, const Location& where, const DecisionCriterion& c) {
    if (text.empty()) return {};
    Quantity quantity;
    const auto [rest, status] = std::from_chars(text.data(), text.data() + text.size(), quantity.value);
    if (status != std::errc() || rest != text.data() + text.size()) quantity = parse_quantity(text, unit);
    if (quantity.problem.empty() && !(quantity.value >= 0.0 && quantity.value < 1e300))
      quantity.problem = "must be a number that is not negative, got " + text;
    if (quantity.problem.empty()) return quantity.value;
    problems_.push_back({where, "criterion '" + c.name + "': " + quantity.problem});
    return {};
  }

  Document document_;
  DecisionCriteria& criteria_;
  std::vector<Diagnostic> problems_;
};

} // namespace

const char* name_of(Decision decision) {
  static constexpr const char* k_names[] = {"energise", "open", "inspect", "return"};
  return k_names[static_cast<int>(decision)];
}

DecisionCriteria parse_criteria(const std::string& text, const std::string& file_name) {
  DecisionCriteria criteria;
  criteria.file = file_name;
  criteria.toml = text;
  Reader(parse_document(text, file_name), criteria).read();
  return criteria;
}

DecisionCriteria read_criteria(const std::string& file_or_preset) {
  std::vector<std::string> names;
  for (const CriteriaPreset& preset : criteria_presets()) {
    if (preset.name == file_or_preset) return parse_criteria(preset.toml, preset.name);
    names.push_back(preset.name);
  }
  if (!std::filesystem::exists(file_or_preset)) {
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    throw FileError(file_or_preset, "'" + file_or_preset + "' is neither a file of criteria nor one of those that come with the program (" +
                                        known + ")" + did_you_mean(file_or_preset, names));
  }
  return parse_criteria(read_input(file_or_preset, {shown_input(file_or_preset), 0, 0}, "the criteria "), shown_input(file_or_preset));
}

} // namespace steplap::assess
