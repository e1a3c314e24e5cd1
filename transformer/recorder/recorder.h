// Model table [[recorder]]: position and orientation of a shock recorder on the tank, and the elements that its record replaces.
//
// A model shows one plane. Two axes of the recorder lie in this plane; each is assigned, with its sign, to an axis of the marker. The third
// axis can press on the sheets of a core. The table does not affect an ordinary run. An assessment drives the marker's body with the
// recorded acceleration (tools/assess/driven_model.h). The body is assumed to be rigid between the recorder and the points where the
// machine stands on it.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// A recorder as described in a model file.
struct Recorder : TableObject {
  std::string marker;                ///< marker at the recorder's position, on a movable body
  std::string x, y;                  ///< axes of the record along the marker's x and y: "x", "-z", …, or "none"
  std::string across = "none";       ///< axis of the record out of the plane, from the front of the core's stack to its back
  std::string plane = "lengthwise";  ///< name of the plane for display
  std::vector<std::string> replaces; ///< names of the elements that move the tank in ordinary runs and are replaced by the record
  std::string mounted = "lid";       ///< "lid" or "frame"; affects the reliability of a margin
  std::string rotation = "held";     ///< rotation of the driven body: "held" or "free"
  std::string drift = "none"; ///< drift correction of each event: "none", or "line": the velocity at the end equals that at the begin
  double settle = 0.5;        ///< time simulated after each event without a load, s
  std::vector<std::string> knows_not; ///< effects that the model leaves out, listed with the decision
};

/// Returns the kind of the table. The table is checked and adds nothing to the model.
[[nodiscard]] const TableKind& recorder_kind();

/// Returns the recorder of the model; nullptr if it has none.
[[nodiscard]] const Recorder* recorder_of(const Model& model);

} // namespace steplap
