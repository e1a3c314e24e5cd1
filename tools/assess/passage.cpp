#include "tools/assess/passage.h"

#include "mbd/base/portable_math.h"
#include "tools/assess/assumed_limits.h"
#include "transformer/program.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace steplap::assess {

namespace {

// Returns the largest speed of a body relative to the driven body, m/s.
double final_speed(const System& system, const State& state, const std::string& driven) {
  std::size_t base = 0;
  for (std::size_t i = 1; i < system.bodies.size(); ++i)
    if (system.bodies[i].name == driven) base = i;
  double fastest = 0.0;
  for (std::size_t i = 1; i < system.bodies.size(); ++i)
    fastest = std::max(fastest, portable::hypot(state.v[3 * i] - state.v[3 * base], state.v[3 * i + 1] - state.v[3 * base + 1]));
  return fastest;
}

LimitPassage limit_of(const CriterionResult& criterion, bool is_assumed, const Overview& overview) {
  LimitPassage limit;
  limit.is_assumed = is_assumed;
  limit.name = criterion.name;
  limit.unit = criterion.unit;
  limit.text = criterion.text;
  limit.outcome = criterion.outcome;
  limit.is_met = criterion.outcome == Verdict::hold;
  limit.value = criterion.value.value_or(std::nan(""));
  limit.allowed = criterion.limit.value_or(std::nan(""));
  limit.share = std::nan("");
  for (const Utilisation& u : overview.utilisations)
    if (u.channel == criterion.channel && u.limit == criterion.limit) limit.share = u.share;
  return limit;
}

// Returns true for findings that only result from the removal of replaced elements.
bool is_of_replaced(const Finding& finding) { return finding.code == "unused_signal" || finding.code == "unused_marker"; }

constexpr std::array<const char*, 3> k_pose = {".x", ".y", ".theta"};

// Returns the poses of the moving bodies at the output sample nearest to time t, s.
std::vector<BodyPose> poses_at(const System& system, const Trajectory& samples, double t) {
  const auto& times = samples.times();
  if (times.empty()) return {};
  const auto is_nearer = [t](double a, double b) { return std::abs(a - t) < std::abs(b - t); };
  const auto row = static_cast<std::size_t>(std::min_element(times.begin(), times.end(), is_nearer) - times.begin());
  const auto& channels = samples.channels();
  std::vector<BodyPose> poses;
  for (std::size_t i = 1; i < system.bodies.size(); ++i) {
    const std::string& name = system.bodies[i].name;
    std::array<double, 3> pose{};
    bool is_written = true;
    for (std::size_t k = 0; k < pose.size(); ++k) {
      const auto found = std::find_if(channels.begin(), channels.end(), [&](const Channel* c) { return c->name == name + k_pose[k]; });
      is_written = is_written && found != channels.end();
      if (is_written) pose[k] = samples.value(row, static_cast<std::size_t>(found - channels.begin()));
    }
    if (is_written) poses.push_back({name, pose[0], pose[1], pose[2]});
  }
  return poses;
}

// Returns the channels to be written: poses of all bodies, and those that shared frictions need.
std::vector<std::string> sampled_channels(const Model& model, const std::vector<std::string>& traced) {
  std::vector<std::string> channels = traced_channels(traced);
  for (const Body& body : model.bodies)
    for (const char* const part : k_pose) channels.push_back(body.name + part);
  return channels;
}

std::vector<FootPassage> feet_of(const Report& report) {
  std::vector<FootPassage> feet;
  for (const Event& event : report.run.result.events) {
    const bool is_known = std::any_of(feet.begin(), feet.end(), [&](const FootPassage& f) { return f.name == event.element; });
    if (event.kind != EventKind::opens || is_known) continue;
    FootPassage foot{event.element, event.t, {}};
    if (const ChannelRange* const gap = report.find(event.element + ".gap"); gap && std::isfinite(gap->high.value))
      foot.height = gap->high.value;
    feet.push_back(std::move(foot));
  }
  return feet;
}

} // namespace

Passage VoyageModel::broken(const std::string& why) {
  Passage passage;
  passage.reason = why;
  passage.trust = "Nothing is known of this event.";
  ended_ = why;
  return passage;
}

void VoyageModel::look(const Report& report, Passage& passage) {
  const RunResult& result = report.run.result;
  const Overview overview = overview_of(report);
  passage.verdict = overview.verdict;
  passage.reason = overview.reason;
  passage.trust = overview.trust.text;
  passage.trust_level = overview.trust.level;
  passage.is_trusted = report.judgement.distrust.empty() && overview.trust.level != TrustLevel::none;
  slid_x_.resize(report.joints.size(), 0.0), slid_y_.resize(report.joints.size(), 0.0), slid_total_.resize(report.joints.size(), 0.0);
  for (std::size_t i = 0; i < report.joints.size(); ++i) {
    const JointAssessment& joint = report.joints[i];
    if (joint.verdict == JointVerdict::not_assessed) {
      passage.unjudged.push_back(joint.joint);
      continue;
    }
    JointPassage p;
    p.name = joint.joint;
    p.slips = would_slip(joint);
    p.came_apart = joint.has_come_apart;
    p.margin = joint.smallest_margin;
    p.at = joint.time_of_smallest;
    if (joint.has_slipped)
      // a joint that has not slipped may have moved by rounding or elastically; that is not counted
      p.slid = portable::hypot(joint.slid_x - slid_x_[i], joint.slid_y - slid_y_[i]);
    slid_x_[i] = joint.slid_x, slid_y_[i] = joint.slid_y;
    p.slid_total = slid_total_[i] += p.slid;
    if (const ChannelRange* const left = report.find(joint.joint + ".overlap_left")) p.overlap_left = left->final;
    if (report.estimate.errors) p.error = joint_errors(joint, *report.run.loaded->system, result, *report.estimate.errors).smallest_margin;
    passage.joints.push_back(std::move(p));
  }
  passage.worst_instant = overview.worst_instant;
  if (overview.worst_instant && result.trajectory)
    passage.poses = poses_at(*report.run.loaded->system, *result.trajectory, *overview.worst_instant);
  passage.feet = feet_of(report);
  for (std::size_t i = 0; i < report.judgement.criteria.size(); ++i) {
    const CriterionResult& criterion = report.judgement.criteria[i];
    const bool is_limit_assumed = is_assumed(model_.assumed_limits, report.run.loaded->model, report.judgement, i);
    (criterion.unit == "N"   ? passage.reactions
     : criterion.unit == "m" ? passage.clearances
                             : passage.others)
        .push_back(limit_of(criterion, is_limit_assumed, overview));
  }
  for (const Finding& finding : report.findings)
    if (finding.level == FindingLevel::warning && !is_of_replaced(finding)) passage.findings.push_back(text_with_place(finding));
  for (const Finding& finding : report.findings)
    if (finding.code == "criterion_still_grows") passage.still_grows = finding.text + " ('settle' of [[recorder]]).";
  if (!report.judgement.distrust.empty()) passage.findings.push_back(report.judgement.distrust);
  for (const std::string& cap : report.judgement.caps)
    if (std::find(passage.findings.begin(), passage.findings.end(), cap) == passage.findings.end()) passage.findings.push_back(cap);
}

Passage VoyageModel::pass(const DriveHistory& history, Estimating estimating) {
  if (!ended_.empty()) return broken(std::string(ended_));
  Model model = model_.given;
  drive_by(model, {history}, history.end() + (history.goes_on ? 0.0 : model_.recorder.settle));
  model.output.step = std::min(trace_step(history), model.simulation.end);
  model.output.channels = sampled_channels(model, model_.traced);
  const std::shared_ptr<const LoadedModel> loaded = load_given(model, model_.name);
  RunOptions options;
  options.estimating = estimating;
  options.start = state_;
  try {
    const Report report = judged_run(loaded, options);
    if (report.run.failure) return broken(report.run.failure->text);
    Passage passage;
    passage.is_made = true;
    look(report, passage);
    if (history.goes_on) passage.still_grows.clear(); // the next event continues this one
    if (!model_.traced.empty())
      passage.traces = friction_traces(loaded->model, *loaded->system, report.run.result, model_.traced, 0.0, model.output.step);
    if (!report.run.result.stop_reason.empty()) ended_ = report.run.result.stop_reason;
    state_ = report.run.result.final_state;
    state_->t = state_->dissipated = state_->work = 0.0;
    passage.final_speed = final_speed(*loaded->system, *state_, model_.body);
    return passage;
  } catch (const NumericalFailure& failure) {
    return broken(failure.what());
  }
}

} // namespace steplap::assess
