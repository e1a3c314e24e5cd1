// [[recorder]]: where a shock recorder sat on the tank, which way it pointed, and what its record takes the place of.
//
// A model is one plane: two of the recorder's axes lie in it, each mapped with its sign onto an axis of the marker. The third one may
// press the sheets of a core. The table
// changes nothing of a usual run. An assessment drives the marker's body by the recorded acceleration (tools/assess/driven_model.h).
// Assumes that the body of the marker is rigid from the recorder to where the rest of the machine stands on it.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// A recorder as a model file describes it.
struct Recorder : TableObject {
  std::string marker;                 ///< where it sat; a marker of a body that can move
  std::string x, y;                   ///< axis of the record along the marker's x and y: "x", "-z", …, or "none"
  std::string across = "none";        ///< axis of the record out of the plane, from the front of a core's stack to its back
  std::string plane = "lengthwise";   ///< a word for people
  std::vector<std::string> replaces;  ///< elements that moved the tank and give way to the record
  std::string mounted = "lid";        ///< "lid" or "frame": how far a margin can be believed
  std::string rotation = "held";      ///< of the driven body: "held" or "free"
  std::string drift = "none";         ///< of each event: "none", or "line": velocity ends where it began
  double settle = 0.5;                ///< s, run on after each event without a load
  std::vector<std::string> knows_not; ///< what the model leaves out, for the reader of a decision
};

/// The table's kind: it checks itself and adds nothing to the model.
[[nodiscard]] const TableKind& recorder_kind();

/// Of the model; nullptr if it has none.
[[nodiscard]] const Recorder* recorder_of(const Model& model);

} // namespace steplap
