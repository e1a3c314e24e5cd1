#include "tools/assess/voyage_runner.h"

#include "elements/step_lap/step_lap_assessment.h"
#include "elements/step_lap/step_lap_joint.h"
#include "mbd/base/event_kind.h"
#include "mbd/base/name_pattern.h"
#include "mbd/base/portable_math.h"
#include "mbd/io/presentation.h"
#include "mbd/model/completion.h"
#include "mbd/rest/start.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judge.h"
#include "tools/assess/assumed_limits.h"
#include "tools/assess/passage.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steplap::assess {

namespace {

std::vector<double> begins_of(const std::vector<DriveHistory>& histories, double settle) {
  std::vector<double> begins{0.0};
  for (const DriveHistory& history : histories) begins.push_back(begins.back() + history.end() + (history.goes_on ? 0.0 : settle));
  return begins;
}

// Returns the channels whose extremes are needed: joints, criteria and checks of the run. Those of all channels would take most of the
// time.
std::vector<std::string> channels_wanted(const Model& whole, const System& system, const std::vector<std::string>& traced) {
  std::vector<std::string> wanted = traced_channels(traced);
  for (std::string& channel : channels_of_trust(whole)) wanted.push_back(std::move(channel));
  const auto is_wanted = [&](const std::string& name) {
    for (const ElementEntry& entry : whole.elements)
      if (entry.kind == &step_lap_joint_kind() && name.starts_with(entry.element->name + ".")) return true;
    for (const Criterion& criterion : whole.criteria)
      if (!criterion.channel.empty() && matches_pattern(name, criterion.channel)) return true;
    return false;
  };
  for (const Channel& channel : system.channels)
    if (is_wanted(channel.name)) wanted.push_back(channel.name);
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  return wanted;
}

} // namespace

VoyageRunner::VoyageRunner(const DrivenModel& model, const std::vector<DriveHistory>& histories, std::vector<std::string> paths)
    : model_(model), begins_(begins_of(histories, model.recorder.settle)), given_(model.given) {
  for (const DriveHistory& history : histories) steps_.push_back(trace_step(history));
  std::vector<DriveHistory> placed = histories;
  for (std::size_t i = 0; i < placed.size(); ++i) placed[i].begin = begins_[i];
  drive_by(given_, std::move(placed), std::max(begins_.back(), 1e-9));
  Model whole = completed(given_);
  const std::unique_ptr<System> system = compile(whole);
  static_cast<void>(check_presentation(whole, *system));
  const std::vector<std::string> wanted = channels_wanted(whole, *system, model_.traced);
  variants_ = std::make_unique<Variants>(given_, std::move(paths), &wanted);
}

VoyageRunner::~VoyageRunner() = default;

struct VoyageRunner::Course {
  const Model& whole;
  const System& system;
  const std::function<bool()>& stop;
  VoyageOutcome outcome;
  std::vector<double> x, y, slid; ///< relative position and slide of each joint, m
};

// Evaluates one event of the run.
static void look(const Model& whole, const System& system, const RunResult& result, std::size_t event,
                 const std::vector<std::string>& assumed, VoyageOutcome& outcome, std::vector<double>& x, std::vector<double>& y,
                 std::vector<double>& slid) {
  VoyageSummary now;
  const Judgement judgement = judge(whole, system, result, "");
  now.unknown = judgement.distrust;
  for (std::size_t i = 0; i < judgement.criteria.size(); ++i)
    now.note_limit(judgement.criteria[i].outcome, is_assumed(assumed, whole, judgement, i), 0.0,
                   "'" + judgement.criteria[i].name + "' is not met in event " + std::to_string(event + 1));
  const std::vector<JointAssessment> joints = assess_joints(whole, result);
  x.resize(joints.size(), 0.0), y.resize(joints.size(), 0.0), slid.resize(joints.size(), 0.0);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JointAssessment& joint = joints[i];
    if (joint.verdict == JointVerdict::not_assessed) continue;
    if (joint.smallest_margin < now.least_margin) now.least_margin = joint.smallest_margin;
    if (joint.has_slipped) slid[i] += portable::hypot(joint.slid_x - x[i], joint.slid_y - y[i]);
    x[i] = joint.slid_x, y[i] = joint.slid_y;
    now.slid = std::max(now.slid, slid[i]);
    for (const ChannelRange& range : result.ranges)
      if (range.channel->name == joint.joint + ".overlap_left") now.overlap_left = std::min(now.overlap_left, range.final);
    now.comes_apart |= joint.has_come_apart;
    if (std::isnan(joint.smallest_margin) && now.unknown.empty()) now.unknown = "the margin of '" + joint.joint + "' is not known";
    if (!would_slip(joint)) continue;
    now.slips = true;
    outcome.slips[event] = 1;
    if (now.first_slip.empty()) now.first_slip = "'" + joint.joint + "' slips in event " + std::to_string(event + 1);
  }
  now.lifts = std::any_of(result.events.begin(), result.events.end(), [](const Event& e) { return e.kind == EventKind::opens; });
  now.moves = now.slips || now.lifts || std::any_of(result.events.begin(), result.events.end(), [](const Event& e) {
                return is_slip(e.kind) || e.kind == EventKind::breaks;
              });
  worsen(outcome.summary, now);
}

void VoyageRunner::pass_events(Course& course) {
  State state = start_of(course.whole, course.system);
  for (std::size_t i = 0; i + 1 < begins_.size(); ++i) {
    if (course.stop && course.stop()) {
      course.outcome.summary.unknown = "stopped";
      return;
    }
    SimulationOptions options = options_of(course.whole);
    options.end = begins_[i + 1];
    options.output_step = model_.traced.empty() ? 0.0 : steps_[i];
    options.channels = traced_channels(model_.traced);
    Simulation simulation(course.system, state, std::move(options));
    simulation.run();
    const RunResult result = std::move(simulation).result();
    look(course.whole, course.system, result, i, model_.assumed_limits, course.outcome, course.x, course.y, course.slid);
    ++course.outcome.events_made;
    if (!model_.traced.empty())
      course.outcome.traces.push_back(friction_traces(course.whole, course.system, result, model_.traced, begins_[i], steps_[i]));
    state = result.final_state;
    state.t = begins_[i + 1]; // avoids the rounding error of the run's end time
    state.dissipated = state.work = 0.0;
    if (result.stop_reason.empty()) continue;
    if (course.outcome.summary.unknown.empty()) course.outcome.summary.unknown = result.stop_reason;
    return;
  }
}

VoyageOutcome VoyageRunner::run(const std::vector<double>& numbers, const std::function<bool()>& stop) {
  VoyageOutcome failed;
  failed.slips.assign(begins_.size() - 1, 0);
  try {
    const std::unique_ptr<System> system = variants_->make(numbers);
    Model whole = variants_->model();
    convert_limits(whole, *system); // limits may depend on varied numbers, and are given in the units of their channels
    Course course{whole, *system, stop, failed, {}, {}, {}};
    try {
      pass_events(course);
    } catch (const NumericalFailure& failure) {
      course.outcome.summary.unknown = failure.what();
    }
    return std::move(course.outcome);
  } catch (const NumericalFailure& failure) {
    failed.summary.unknown = failure.what();
  } catch (const ModelError& error) {
    failed.summary.unknown = error.diagnostics().empty() ? error.what() : error.diagnostics().front().message;
  }
  return failed;
}

} // namespace steplap::assess
