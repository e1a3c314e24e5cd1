// Parts: `[[part]]` takes another model file as a sub-assembly, as often as it is wanted.
//
//   [[part]]
//   name = "wagon 2"
//   file = "wagon.toml"                  # relative to the file that says so
//   x = "-14 m"                          # where the file's origin lies, and how its axes are turned
//   parameters = { load = "= heavy" }    # what its [parameters] get from outside
//
// A document with parts is written out before anything is read: each body, marker, signal, element and table of the part's file
// becomes one of the model, called "wagon 2.buffer"; so do its [parameters], "wagon 2.load". Names within the file are names of the
// file; others refer to what is in a part by the long name, and to its markers in the first place, which are its ports. Title,
// gravity, [simulation] and [output] of a part's file hold where that file is run alone. The model's own entries come before those of
// its parts, and these in the order of the file.
//
// What the place of a part does to a field follows from the field's table: `position`, `angle` and `velocity` of bodies, `at` of
// markers, what a marker of the ground says, and the vectors of kinds that have a `frame` = "ground" are in ground axes, and lengths
// among them are places. All others stand in axes of markers or bodies and go with these. "ground" is, in a part, a marker at its origin.
#pragma once

#include "mbd/io/document.h"
#include "mbd/model/model.h"

namespace steplap {

/// [[part]]: a sub-assembly.
struct PartEntry {
  std::string name, file;               ///< unique name; path of the file
  double x = 0.0, y = 0.0, angle = 0.0; ///< of its frame, m, rad
  long repeat = 1;                      ///< how many

  /// Its fields as a model file has them, besides `parameters`, a table.
  [[nodiscard]] static const FieldTable& fields();
};

/// Reads the files of all parts, and writes parts and repetitions out. Throws ModelError with all that is wrong with them, and with
/// what was found before.
void write_out_parts(Document& document, const Catalogue& catalogue);

/// Adds to each message about a file of a part by which parts it was reached, and says once what several parts or repetitions of one
/// entry have in common.
void name_parts(std::vector<Diagnostic>& problems, const Document& document);

/// How the place of a part changes a field of an element, signal or table, and whether its texts are names.
enum class PartTreatment { none, name, place, direction, fixed_axis };
[[nodiscard]] PartTreatment part_treatment(const FieldTable& kind, const Field& field);
/// May a table of that kind stand in a part? If not it is about the model as a whole.
[[nodiscard]] bool can_stand_in_part(const TableKind& kind);

} // namespace steplap
