// The model checked as a whole, before anything is compiled: names, ranges, references, settings
// that contradict each other. Models built in code and models read from a file go through the same
// checks; a reader tells where each field stands, so that a message points at the key.
#pragma once

#include "mbd/model/model.h"

#include <unordered_map>
#include <unordered_set>

namespace steplap {

/// A section's fields are those of its table; Section::header has the key "body" besides.
enum class Section { header, simulation, output, body, marker, signal, element };

/// Where a field of the index-th object of a section stands; nullopt: its error is reported
/// already.
using FieldLocator = std::function<std::optional<Location>(Section, std::size_t index, const std::string& field)>;

/// All that is wrong with the model, empty if it can be compiled. Without `locate` every message
/// points at the object's own place.
[[nodiscard]] std::vector<Diagnostic> validate(const Model& model, const FieldLocator& locate = {});

/// Checks the fields of single objects against their tables and the names in a model.
class FieldChecker {
public:
  /// Where a field of the object stands; nullopt: its error is reported already.
  using Locate = std::function<std::optional<Location>(const std::string& field)>;

  /// Refers to both; names added to the model later are not known.
  FieldChecker(const Model& model, std::vector<Diagnostic>& problems);

  /// `subject` is what messages call the object: "body 'tank'".
  void check(const FieldTable& table, const void* object, const std::string& subject, const Locate& locate);
  /// True for "ground", too.
  [[nodiscard]] bool is_body(const std::string& name) const { return bodies_.count(name) > 0; }

private:
  using Names = std::unordered_set<std::string>;

  void check_field(const Field& field, const FieldValue& value, const std::string& subject, const Location& where);
  void check_reference(const Field& field, const std::string& name, const std::string& subject, const Location& where);
  [[nodiscard]] bool refers(FieldType type, const std::string& name) const;
  [[nodiscard]] std::string suggestion(FieldType type, const std::string& name);

  std::vector<Diagnostic>& problems_;
  Names bodies_, markers_, signals_, elements_; // bodies_ holds "ground"
  int suggestions_left_ = 20;                   // each looks at all names
};

/// "must be at least 0 kg, got -1" of a number, or of numbers in the value, that the field does not allow, or "must be
/// one of ...": "" if all is well, and for values that are neither.
[[nodiscard]] std::string range_problem(const Field& field, const FieldValue& value);
/// Has the object nothing there, or what the field allows?
[[nodiscard]] bool is_in_range(const Field& field, const void* object);

/// What a reader adds to "needs" and what an unset required field is reported as.
[[nodiscard]] std::string missing_field_message(const Field& field, const std::string& subject);

/// "body 'tank'", or "a body" for an empty name.
[[nodiscard]] std::string subject_text(const std::string& kind, const std::string& name);

/// True for methods that take 'step' and not 'tolerance'.
[[nodiscard]] bool has_fixed_step(const std::string& integrator);
/// True for fields that an object may leave out although the table requires them: mass and inertia
/// of a fixed body.
[[nodiscard]] bool is_excused(const Body& body, const Field& field);

} // namespace steplap
