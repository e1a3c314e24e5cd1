// A model whose tank moves as recorded: the acceleration at the recorder's marker, of both axes in the plane.
//
// What moved the tank before gives way (`replaces` of [[recorder]]). The marker of the recorder is driven along the ground's axes by
// two prescribed motions; with rotation = "held" a third keeps the angle of its body, so that every place of it has the same
// acceleration; with "free" the body turns about the marker as its inertia and what else acts on it make it turn.
// The recorder reads in its own axes, which are taken to stay where they are in the reference pose: right while angles are small.
// Gravity acts in the model, so the record comes without it. A velocity that the record leaves goes on as it is: inside a tank
// that moves evenly nothing notices.
#pragma once

#include "mbd/model/model.h"
#include "tools/assess/record_events.h"
#include "transformer/recorder/recorder.h"

#include <string>
#include <vector>

namespace steplap::assess {

/// Acceleration of the marker along the ground's axes, m/s², linear between samples at equal times from `begin` on, 0 elsewhere.
struct DriveHistory {
  double begin = 0.0, step = 0.0; ///< s
  bool goes_on = false;           ///< the next event is its continuation: nothing comes to rest between
  std::vector<double> x, y;       ///< m/s²
  std::vector<double> across;     ///< m/s², out of the plane, from the front of the sheets to their back; empty: nothing asks for it
  [[nodiscard]] double end() const { return begin + step * static_cast<double>(x.empty() ? 0 : x.size() - 1); }
};

/// Of an event, seen by a recorder whose marker's axes are turned by `angle` (rad) against the ground's. Begins at 0. Throws FileError
/// if the record lacks an axis that the model wants.
[[nodiscard]] DriveHistory drive_history(const RecordEvents& record, const RecordedEvent& event, const Recorder& recorder, double angle);

struct DrivenModel;
/// Throws FileError if the record reads gravity at rest along another axis, or with another sign, than a recorder does that sits as the
/// model says: its axes are not where the model has them. "" or a sentence: what could not be seen.
[[nodiscard]] std::string check_gravity(const RecordEvents& record, const DrivenModel& model);

/// A model made ready to be driven.
struct DrivenModel {
  std::string file, name, sha256;
  std::string text; ///< the effective model; "" of one made in code
  Recorder recorder;
  std::string body;                ///< that the recorder sits on, and that is driven
  double marker_angle = 0.0;       ///< rad, of the marker's axes against the ground's in the reference pose
  Model given;                     ///< as given, without what gives way, with drives at rest
  std::vector<std::string> notes;  ///< what was changed, for people
  std::vector<std::string> traced; ///< frictions that models of other planes share (shared_friction.h)
};

/// Reads a model file for an assessment. Throws ModelError: it has no [[recorder]], or something else drives its body.
[[nodiscard]] DrivenModel read_driven_model(const std::string& path, const std::vector<std::string>& overrides = {});
/// The same of a model made in code.
[[nodiscard]] DrivenModel driven_model(Model given, const std::string& name);

/// Puts the histories, one after the other in time, into the drives of the model and sets its end, s.
void drive_by(Model& driven, std::vector<DriveHistory> histories, double end);

} // namespace steplap::assess
