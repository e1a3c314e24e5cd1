// Parts: `[[part]]` includes another model file as a sub-assembly, any number of times.
//
//   [[part]]
//   name = "wagon 2"
//   file = "wagon.toml"                  # relative to this file
//   x = "-14 m"                          # position of the file's origin, and angle of its axes
//   parameters = { load = "= heavy" }    # values for its [parameters]
//
// Parts are expanded before anything is read. Each body, marker, signal, element and table of the part's file becomes one of the model with
// a prefixed name, "wagon 2.buffer"; the same holds for its [parameters], "wagon 2.load". Names within the file refer to that file. Other
// files use the prefixed names, mainly of its markers, which serve as ports. Title, gravity, [simulation] and [output] of the part's file
// apply only if it is run alone. The model's own entries come first, then those of its parts in the order of the file.
//
// The effect of a part's position on a field follows from the field's table. In ground axes are: `position`, `angle` and `velocity` of
// bodies, `at` of markers, values of ground markers, and vectors of kinds with `frame` = "ground"; lengths among them are positions. All
// other fields are in axes of markers or bodies and move with these. In a part, "ground" means a marker at its origin.
#pragma once

#include "mbd/io/document.h"
#include "mbd/model/model.h"

namespace steplap {

/// Sub-assembly, an entry of [[part]].
struct PartEntry {
  std::string name, file;               ///< unique name; path of the file
  double x = 0.0, y = 0.0, angle = 0.0; ///< position and angle of its frame, m, rad
  long repeat = 1;                      ///< number of copies

  /// Returns the fields of a part in a model file, except the table `parameters`.
  [[nodiscard]] static const FieldTable& fields();
};

/// Reads the files of all parts, and expands parts and repetitions. Throws ModelError with all problems, including those found before this
/// call.
void write_out_parts(Document& document, const Catalogue& catalogue);

/// Adds to each message about the file of a part how the part was included: "part 'buffer', wagon.toml:8:1". Messages that differ only by
/// the part or the repetition are reduced to one.
void name_parts(std::vector<Diagnostic>& problems, const Document& document);

/// Effect of a part's position on a field of an element, signal or table; `name`: the field's texts are names, which get the prefix.
enum class PartTreatment { none, name, place, direction, fixed_axis };
[[nodiscard]] PartTreatment part_treatment(const FieldTable& kind, const Field& field);
/// Returns false for tables that concern the model as a whole, and so cannot be in the file of a part.
[[nodiscard]] bool is_allowed_in_part(const TableKind& kind);

} // namespace steplap
