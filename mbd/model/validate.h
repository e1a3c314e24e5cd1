// Validation of a whole model before compilation: names, ranges, references, contradictory settings. The same checks apply to models from
// files and from code; a reader supplies the location of each field for messages.
#pragma once

#include "mbd/model/model.h"

#include <unordered_map>
#include <unordered_set>

namespace steplap {

/// Part of a model file, for locating a field. Section::header contains the top-level keys and, for errors about missing bodies, the key
/// "body".
enum class Section { header, simulation, output, body, marker, signal, element };

/// Returns the location of a field of entry `index` of a section; nullopt if an error of this field has already been reported.
using FieldLocator = std::function<std::optional<Location>(Section, std::size_t index, const std::string& field)>;

/// Returns all errors of the model; empty if it can be compiled. Without `locate`, messages refer to the location of the whole object.
[[nodiscard]] std::vector<Diagnostic> validate(const Model& model, const FieldLocator& locate = {});

/// Checks fields of single objects against their tables and against the names of the model.
class FieldChecker {
public:
  /// Returns the location of a field of the object; nullopt if an error of this field has already been reported.
  using Locate = std::function<std::optional<Location>(const std::string& field)>;

  /// Keeps references to both arguments. Names that are added to the model later are not recognised.
  FieldChecker(const Model& model, std::vector<Diagnostic>& problems);

  /// Checks all fields of `object`. `subject` is its name in messages: "body 'tank'".
  void check(const FieldTable& table, const void* object, const std::string& subject, const Locate& locate);
  /// Returns true if a body with this name exists, or for "ground".
  [[nodiscard]] bool is_body(const std::string& name) const { return bodies_.count(name) > 0; }

private:
  using Names = std::unordered_set<std::string>;

  void check_field(const Field& field, const FieldValue& value, const std::string& subject, const Locate& locate);
  void check_reference(const Field& field, const std::string& name, const std::string& subject, const Locate& locate);
  [[nodiscard]] bool refers(FieldType type, const std::string& name) const;
  [[nodiscard]] std::string suggestion(FieldType type, const std::string& name);

  std::vector<Diagnostic>& problems_;
  Names bodies_, markers_, signals_, elements_; // includes "ground"
  int suggestions_left_ = 20;                   // limits the cost, since each suggestion compares all names
};

/// Returns a message such as "must be at least 0 kg, got -1" or "must be one of ..." if numbers or choices in `value` are outside the
/// allowed range; "" otherwise, also for other types.
[[nodiscard]] std::string range_problem(const Field& field, const FieldValue& value);
/// Returns true if the object's field is within its range, or not given.
[[nodiscard]] bool is_in_range(const Field& field, const void* object);

/// Returns the message for a required field that is missing.
[[nodiscard]] std::string missing_field_message(const Field& field, const std::string& subject);

/// Returns "body 'tank'", or "a body" for an empty name.
[[nodiscard]] std::string subject_text(const std::string& kind, const std::string& name);

/// Returns true if the integration method has a fixed step, so that 'step' is required rather than 'tolerance'.
[[nodiscard]] bool has_fixed_step(const std::string& integrator);
/// Returns true for required fields that this body may omit: a fixed body needs no mass and inertia.
[[nodiscard]] bool is_excused(const Body& body, const Field& field);

} // namespace steplap
