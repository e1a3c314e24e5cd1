// Closed outlines from drawings: LWPOLYLINE and POLYLINE of ASCII DXF files, by layer.
//
// A DXF file is a list of pairs of lines: a group code, a value. Read are $INSUNITS of the header and the entities of the model space; blocks
// are not inserted. Source: AutoCAD DXF reference, group codes of these entities.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/base/types.h"

#include <string>
#include <vector>

namespace steplap {

/// Returns the corners of the only closed polyline on a layer of a drawing, in metres, in the order of the file; a last corner on the first
/// one is left out. `unit` is the unit of its coordinates, such as "mm"; "" for the one that the drawing states. Throws ModelError with the
/// line of the drawing, or at `where` for what concerns it as a whole: it is no ASCII DXF file, states no unit or another one, has no such
/// layer, or the layer has an open or second polyline, arcs, or other entities.
[[nodiscard]] std::vector<Vec2> parse_dxf_outline(const std::string& text, const std::string& file_name, const std::string& layer,
                                                  const std::string& unit, const Location& where);

} // namespace steplap
