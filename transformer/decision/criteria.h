// Acceptance criteria for a machine after transport: a TOML file of the user, or one of the presets.
//
//   name = "…"  text = "…"  source = "…"  tests = ["dew point of the gas"]
//   [[criterion]]
//   name = "3 g"  quantity = "peak"  at_most = "3 gravity"  outcome = "inspect"  tests = ["core insulation resistance"]
//
// A criterion that is not met gives its outcome; one that cannot be judged gives "open". The decision is "energise" if all criteria are
// met.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/model/fields.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// Decisions in ascending severity.
enum class Decision { energise, open, inspect, send_back };
/// Returns "energise", "open", "inspect" or "return".
[[nodiscard]] const char* name_of(Decision decision);

/// Origin of the quantity of a criterion: the recorder's reading, the runs of the voyage, or the repetition of the runs with uncertain
/// values.
enum class CriterionBasis { reading, runs, probability };

/// One criterion.
struct DecisionCriterion {
  std::string name, quantity;
  CriterionBasis basis = CriterionBasis::runs; ///< origin of `quantity`
  std::string axis = "any";                    ///< axis of the record: "any", "x", "y" or "z"
  std::string bandwidth = "record";            ///< for a peak: "record", "100 Hz" (CFC 60) or "17 Hz" (CFC 10)
  std::string at_most_text, at_least_text;
  std::optional<double> at_most, at_least; ///< limits, SI
  std::string outcome = "inspect";         ///< outcome if the criterion is not met: "inspect" or "return"
  std::string text, source;
  std::vector<std::string> tests; ///< tests that would reveal the damage
  Location where;
};

/// A set of criteria.
struct DecisionCriteria {
  std::string name, text, source;
  std::vector<std::string> tests; ///< usual tests on arrival, carried out with any decision
  std::string file;               ///< file name, or name of the preset
  std::string toml;               ///< text of the file or preset
  std::vector<DecisionCriterion> criteria;
};

/// Reads a file, or a preset by its name. Throws ModelError with all errors, FileError if neither exists.
[[nodiscard]] DecisionCriteria read_criteria(const std::string& file_or_preset);
/// As read_criteria(), for a text in memory.
[[nodiscard]] DecisionCriteria parse_criteria(const std::string& text, const std::string& file_name);

/// A set of criteria built into the program.
struct CriteriaPreset {
  std::string name, toml;
};
[[nodiscard]] const std::vector<CriteriaPreset>& criteria_presets();

} // namespace steplap::assess
