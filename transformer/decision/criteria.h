// What decides about a machine that has arrived: a TOML file of criteria, shipped presets or a user's own.
//
//   name = "…"  text = "…"  source = "…"
//   [[criterion]]
//   name = "3 g"  quantity = "peak"  at_most = "3 gravity"  outcome = "inspect"  tests = ["core insulation resistance"]
// A criterion that is not met has its outcome; one that cannot be judged leaves the decision open. "energise" is what remains.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/model/fields.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// In the order of their weight.
enum class Decision { energise, open, inspect, send_back };
/// "energise", "open", "inspect" or "return"
[[nodiscard]] const char* name_of(Decision decision);

/// One thing that is asked.
struct DecisionCriterion {
  std::string name, quantity;
  std::string axis = "any";         ///< of the record: "any", "x", "y" or "z"
  std::string bandwidth = "record"; ///< of a peak: "record", "100 Hz" (CFC 60) or "17 Hz" (CFC 10)
  std::string at_most_text, at_least_text;
  std::optional<double> at_most, at_least; ///< SI
  std::string outcome = "inspect";         ///< if it is not met: "inspect" or "return"
  std::string text, source;
  std::vector<std::string> tests; ///< that would show the damage
  Location where;
};

/// A file of criteria.
struct DecisionCriteria {
  std::string name, text, source;
  std::string file; ///< or the name of the preset
  std::string toml; ///< what was read
  std::vector<DecisionCriterion> criteria;
};

/// Reads a file, or a preset by its name. Throws ModelError with all that is wrong, FileError for what is neither.
[[nodiscard]] DecisionCriteria read_criteria(const std::string& file_or_preset);
/// The same for text at hand.
[[nodiscard]] DecisionCriteria parse_criteria(const std::string& text, const std::string& file_name);

/// A set of criteria that comes with the program.
struct CriteriaPreset {
  std::string name, toml;
};
[[nodiscard]] const std::vector<CriteriaPreset>& criteria_presets();

} // namespace steplap::assess
