// Simulates one event in one model, starting from the state after the previous event, with error estimate and verdict.
#pragma once

#include "elements/step_lap/step_lap_assessment.h"
#include "elements/views/friction_plane.h"
#include "mbd/run/overview.h"
#include "tools/assess/driven_model.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// Returns true if the joint slipped or, in mode "monitor", if its capacity was exceeded.
[[nodiscard]] inline bool would_slip(const JointAssessment& joint) {
  return joint.has_slipped || (joint.is_monitored && joint.smallest_margin < 1.0);
}

/// Results of one event for a step-lap joint.
struct JointPassage {
  std::string name;
  bool slips = false, came_apart = false;
  double margin = 0.0, at = 0.0;       ///< smallest ratio of capacity to demand, and its time, s
  double slid = 0.0, slid_total = 0.0; ///< slide during this event, and sum over all events so far, m
  double overlap_left = 1.0;           ///< remaining overlap at the end, as a fraction of the initial overlap
  std::optional<double> error;         ///< error of the margin; NaN if unknown; empty if not estimated
};

/// A contact that opened during an event.
struct FootPassage {
  std::string name;
  double from = 0.0;            ///< time at which the contact opened, s
  std::optional<double> height; ///< largest gap during the event, m
};

/// A limit of an [[acceptance]] table, with its result for one event.
struct LimitPassage {
  std::string name, unit, text;
  double value = 0.0, allowed = 0.0;
  double share = 0.0;                     ///< utilisation; 1 is the limit
  bool is_met = true, is_assumed = false; ///< `is_assumed`: true if the limit itself is assumed (assumed_limits.h)
  Verdict outcome = Verdict::hold;
};

/// Pose of a body.
struct BodyPose {
  std::string body;
  double x = 0.0, y = 0.0, angle = 0.0; ///< centre of gravity, m; rad
};

/// Results of one event in one model.
struct Passage {
  std::size_t event = 0, model = 0; ///< indices of the event and of the model
  bool is_made = false;             ///< false if the run failed, or if the voyage of this model ended in an earlier event
  Verdict verdict = Verdict::open;
  std::string reason, trust;
  TrustLevel trust_level = TrustLevel::none;
  bool is_trusted = false; ///< true if there is no reason to distrust the numbers
  std::vector<JointPassage> joints;
  std::vector<std::string> unjudged; ///< names of joints without a result
  std::vector<FootPassage> feet;
  std::vector<LimitPassage> reactions, clearances, others;
  std::vector<std::string> findings;
  std::optional<double> worst_instant; ///< time at which a utilisation is largest, s after the begin of the event
  std::vector<BodyPose> poses;         ///< poses of the bodies at the output sample nearest to that time; empty if there is none
  std::string still_grows;             ///< why a criterion that is met may not be after the event; "" if no criterion grows on
  double final_speed = 0.0;            ///< largest speed of a body relative to the tank at the end of the event, m/s
  std::vector<SampledFriction> traces; ///< friction histories of the elements in DrivenModel::traced
};

/// A model during the voyage: keeps the state between its events.
class VoyageModel {
public:
  explicit VoyageModel(const DrivenModel& model) : model_(model) {}

  /// Simulates the next event. `estimating` decides whether errors are estimated by finer runs. Throws ModelError if the model cannot be
  /// run.
  [[nodiscard]] Passage pass(const DriveHistory& history, Estimating estimating);

private:
  [[nodiscard]] Passage broken(const std::string& why);
  void look(const Report& report, Passage& passage);
  const DrivenModel& model_;
  std::optional<State> state_;
  std::vector<double> slid_x_, slid_y_, slid_total_;
  std::string ended_; ///< reason why the voyage ended for this model
};

} // namespace steplap::assess
