// One event through one model: from the state in which the event before left it, with errors estimated, judged.
#pragma once

#include "elements/step_lap/step_lap_assessment.h"
#include "run/overview.h"
#include "tools/assess/driven_model.h"
#include "tools/assess/friction_trace.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// Did it slide, or, of a joint that is watched and held, would it have?
[[nodiscard]] inline bool would_slip(const JointAssessment& joint) {
  return joint.has_slipped || (joint.is_monitored && joint.smallest_margin < 1.0);
}

/// What an event did to a step-lap joint.
struct JointPassage {
  std::string name;
  bool slips = false, came_apart = false;
  double margin = 0.0, at = 0.0;       ///< least capacity over demand; s, when
  double slid = 0.0, slid_total = 0.0; ///< m: moved by this event; sum over all events so far
  double overlap_left = 1.0;           ///< share, at the end
  std::optional<double> error;         ///< of the margin; not-a-number: unknown
};

/// A contact that opened.
struct FootPassage {
  std::string name;
  double from = 0.0;            ///< s
  std::optional<double> height; ///< m, at most
};

/// What an acceptance of the model asks, and what came of it.
struct LimitPassage {
  std::string name, unit, text;
  double value = 0.0, allowed = 0.0;
  double share = 0.0; ///< 1: the limit
  bool is_met = true;
  Verdict outcome = Verdict::hold;
};

/// An event through a model.
struct Passage {
  std::size_t event = 0, model = 0; ///< indices
  bool is_made = false;             ///< false: the run could not be begun or finished, or an event before ended the voyage
  Verdict verdict = Verdict::open;
  std::string reason, trust;
  TrustLevel trust_level = TrustLevel::none;
  bool is_trusted = false; ///< nothing forbids to believe it
  std::vector<JointPassage> joints;
  std::vector<std::string> unjudged; ///< joints of which nothing can be said
  std::vector<FootPassage> feet;
  std::vector<LimitPassage> reactions, clearances, others;
  std::vector<std::string> findings;
  double still_moving = 0.0;         ///< m/s: fastest body against the tank at the end
  std::vector<FrictionTrace> traces; ///< of DrivenModel::traced
};

/// A model on its way through the voyage.
class Traveller {
public:
  explicit Traveller(const DrivenModel& model) : model_(model) {}

  /// `estimating`: whether errors of its numbers are found by finer runs. Throws ModelError for a model that cannot be run.
  [[nodiscard]] Passage pass(const DriveHistory& history, Estimating estimating);

private:
  [[nodiscard]] Passage broken(const std::string& why);
  void look(const Report& report, Passage& passage);
  const DrivenModel& model_;
  std::optional<State> state_;
  std::vector<double> slid_x_, slid_y_, slid_total_;
  std::string ended_; ///< why the voyage ended for this model
};

} // namespace steplap::assess
