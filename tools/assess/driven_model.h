// Prepares a model whose tank moves with the recorded acceleration, in the plane of the model.
//
// Elements that move the tank in the given model are removed (`replaces` of [[recorder]]). Two prescribed motions along the ground's axes
// drive the recorder's marker. With rotation = "held" a third one fixes the angle of its body, so all points of the body have the same
// acceleration. With "free" the body turns about the marker under its inertia and the other forces.
//
// The recorder's axes are assumed to keep the direction that they have in the reference pose, which is valid for small angles. Gravity acts
// in the model and is therefore subtracted from the record. The velocity at the end of an event is kept: a uniformly moving tank exerts no
// forces on its contents.
#pragma once

#include "mbd/model/model.h"
#include "tools/assess/record_events.h"
#include "transformer/recorder/recorder.h"

#include <string>
#include <vector>

namespace steplap::assess {

/// Acceleration of the marker along the ground's axes, m/s²: linear between equidistant samples from `begin` on, 0 elsewhere.
struct DriveHistory {
  double begin = 0.0, step = 0.0; ///< time of the first sample, and sampling interval, s
  bool goes_on = false;           ///< true if the next event follows without an interval at rest
  std::vector<double> x, y;       ///< acceleration, m/s²
  std::vector<double> across; ///< acceleration normal to the plane, from the front of the sheets to their back, m/s²; empty if not used
  /// Returns the time of the last sample, s.
  [[nodiscard]] double end() const { return begin + step * static_cast<double>(x.empty() ? 0 : x.size() - 1); }
};

/// Returns the history of an event, beginning at time 0. `angle` is the rotation of the marker's axes relative to the ground's, rad. Throws
/// FileError if the record lacks an axis that the model needs.
[[nodiscard]] DriveHistory drive_history(const RecordEvents& record, const RecordedEvent& event, const Recorder& recorder, double angle);

/// Returns the output step of frictions during an event, s, at most 1 ms. Output times include the sample times of the record, unless these
/// are closer than 0.5 ms.
[[nodiscard]] double trace_step(const DriveHistory& history);

struct DrivenModel;
/// Compares the direction of gravity in the record at rest with the recorder's orientation in the model. Throws FileError if axis or sign
/// differ. Returns a sentence if the record contains no gravity, otherwise "".
[[nodiscard]] std::string check_gravity(const RecordEvents& record, const DrivenModel& model);

/// A model prepared to be driven by a record.
struct DrivenModel {
  std::string file, name, sha256;
  std::string text; ///< text of the model file with overrides; "" for a model built in code
  Recorder recorder;
  std::string body;                        ///< body that carries the recorder and is driven
  double marker_angle = 0.0;               ///< orientation of the marker relative to the ground's axes in the reference pose, rad
  Model given;                             ///< the model without the replaced elements and with drives at rest
  std::vector<std::string> notes;          ///< sentences for the user about changes to the model
  std::vector<std::string> assumed_limits; ///< names of [[acceptance]] tables (assumed_limits.h)
  std::vector<std::string> traced;         ///< names of friction elements shared with models of other planes (shared_friction.h)
};

/// Reads a model file for an assessment. Throws ModelError if it has no [[recorder]], or if another element drives the recorder's body.
[[nodiscard]] DrivenModel read_driven_model(const std::string& path, const std::vector<std::string>& overrides = {});
/// As read_driven_model(), for a model built in code.
[[nodiscard]] DrivenModel driven_model(Model given, const std::string& name);

/// Sets the histories, one after the other, as the motion of the drives. `end`: end time of the model, s.
void drive_by(Model& driven, std::vector<DriveHistory> histories, double end);

} // namespace steplap::assess
