// Prepares a model so that its tank moves with the recorded acceleration in the plane of the model.
//
// Elements that moved the tank before are removed (`replaces` of [[recorder]]). Two prescribed motions along the ground's axes drive the
// recorder's marker. With rotation = "held" a third one fixes the angle of its body, so all points of the body have the same acceleration.
// With "free" the body turns about the marker under its inertia and the other forces.
//
// The recorder's axes are assumed to keep their direction of the reference pose, which is valid for small angles. Gravity acts in the model
// and is therefore removed from the record. A velocity left at the end of an event is kept: a uniformly moving tank exerts no forces on its
// contents.
#pragma once

#include "mbd/model/model.h"
#include "tools/assess/record_events.h"
#include "transformer/recorder/recorder.h"

#include <string>
#include <vector>

namespace steplap::assess {

/// Acceleration of the marker along the ground's axes, m/s²: linear between equidistant samples from `begin` on, 0 elsewhere.
struct DriveHistory {
  double begin = 0.0, step = 0.0; ///< s
  bool goes_on = false;           ///< the next event continues this one, without a phase of rest between
  std::vector<double> x, y;       ///< m/s²
  std::vector<double> across;     ///< out of the plane, from the front of the sheets to their back, m/s²; empty if not used
  /// Returns the time of the last sample, s.
  [[nodiscard]] double end() const { return begin + step * static_cast<double>(x.empty() ? 0 : x.size() - 1); }
};

/// Returns the history of an event for a recorder whose marker's axes are turned by `angle`, rad, relative to the ground's. It begins at 0.
/// Throws FileError if the record lacks an axis that the model needs.
[[nodiscard]] DriveHistory drive_history(const RecordEvents& record, const RecordedEvent& event, const Recorder& recorder, double angle);

/// Returns the step at which frictions are sampled during an event, s. The sample times of the record are among its times, unless they are
/// closer than 0.5 ms.
[[nodiscard]] double trace_step(const DriveHistory& history);

struct DrivenModel;
/// Compares the direction of gravity in the record at rest with the recorder's orientation in the model. Throws FileError if axis or sign
/// differ. Returns a sentence if the check was not possible, otherwise "".
[[nodiscard]] std::string check_gravity(const RecordEvents& record, const DrivenModel& model);

/// A model prepared to be driven by a record.
struct DrivenModel {
  std::string file, name, sha256;
  std::string text; ///< effective model; "" for a model built in code
  Recorder recorder;
  std::string body;                        ///< body that carries the recorder and is driven
  double marker_angle = 0.0;               ///< orientation of the marker relative to the ground's axes in the reference pose, rad
  Model given;                             ///< the model without the replaced elements and with drives at rest
  std::vector<std::string> notes;          ///< changes made, for the user
  std::vector<std::string> assumed_limits; ///< names of [[acceptance]] tables (assumed_limits.h)
  std::vector<std::string> traced;         ///< friction elements shared with models of other planes (shared_friction.h)
};

/// Reads a model file for an assessment. Throws ModelError if it has no [[recorder]], or if another element drives the recorder's body.
[[nodiscard]] DrivenModel read_driven_model(const std::string& path, const std::vector<std::string>& overrides = {});
/// As read_driven_model(), for a model built in code.
[[nodiscard]] DrivenModel driven_model(Model given, const std::string& name);

/// Puts the histories one after the other into the drives of the model and sets its end time, s.
void drive_by(Model& driven, std::vector<DriveHistory> histories, double end);

} // namespace steplap::assess
