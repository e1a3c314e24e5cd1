// Writes assessment.json, which the printed page and scripts read. SI unless a unit is given; null for unknown values.
#include "mbd/model/completion.h"
#include "mbd/run/drawing.h"
#include "mbd/run/ordered_json.h"
#include "mbd/run/result_files.h"
#include "mbd/run/version.h"
#include "tools/assess/assessment.h"
#include "transformer/core/left_out_of_cores.h"
#include "transformer/recorder/time_text.h"

#include "mbd/io/digest.h"
#include "transformer/program.h"

#include <algorithm>
#include <cmath>

namespace steplap::assess {

namespace {

using Json = OrderedJson;
constexpr std::size_t k_figure_points = 600; // largest number of points of a curve, which suffices for the width of a page

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json probability(const Probability& p) {
  if (p.runs == 0) return nullptr;
  return {{"value", number(p.value)}, {"low", p.low}, {"high", p.high}, {"runs", p.runs}, {"unknown", p.unknown}};
}

Json records(const Assessment& a) {
  Json all = Json::array();
  for (const RecordEvents& record : a.records) {
    Json faults = Json::array();
    Json warnings = Json::array();
    for (const MissingEvidence& missing : record.missing) {
      faults.push_back({{"what", name_of(missing.item)}, {"accepted", a.is_accepted(missing.item)}});
      warnings.push_back(missing.reason);
    }
    Json subtracted = Json::object();
    for (std::size_t i = 0; i < record.recording.layout.axes.size(); ++i)
      subtracted[std::string(1, record.recording.layout.axes[i].axis)] = record.offset[i];
    Json peaks = Json::array();
    for (const PeakEntry& entry : record.recording.peaks)
      peaks.push_back({{"time", number(entry.t)},
                       {"line", entry.line},
                       {"x", number(entry.axis[0])},
                       {"y", number(entry.axis[1])},
                       {"z", number(entry.axis[2])},
                       {"magnitude", number(entry.magnitude)},
                       {"duration", number(entry.duration)},
                       {"velocity_change", number(entry.velocity_change)}});
    all.push_back({{"file", record.file},
                   {"sha256", record.sha256},
                   {"taken_for", facts_text(record.recording)},
                   {"warnings", warnings},
                   {"faults", faults},
                   {"rate", number(record.rate)},
                   {"bandwidth", number(record.bandwidth)},
                   {"sensor_range", number(record.recording.layout.range)},
                   {"threshold", record.rules.threshold},
                   {"subtracted", subtracted},
                   {"events", record.events.size()},
                   {"peaks_only", peaks}});
  }
  return all;
}

Json uncertain_of_model(const Assessment& a, std::size_t model) {
  Json all = Json::array();
  const std::vector<UncertainValue>& values = a.uncertain->values();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const UncertainValue& value = values[i];
    const auto here =
        std::find_if(value.settings.begin(), value.settings.end(), [&](const UncertainValue::Setting& s) { return s.model == model; });
    if (here == value.settings.end()) continue;
    constexpr double k_low = 0.05, k_high = 0.95;
    all.push_back({{"path", here->path},
                   {"name", value.name},
                   {"nominal", value.nominal},
                   {"unit", value.is_factor ? "" : value.unit},
                   {"is_factor", value.is_factor},
                   {"law", a.uncertain->law_text(i)},
                   {"low", a.uncertain->quantile(i, k_low)},
                   {"high", a.uncertain->quantile(i, k_high)},
                   {"source", value.source},
                   {"source_text", value.source_text},
                   {"share", i < a.shares.size() ? number(a.shares[i]) : Json(nullptr)}});
  }
  return all;
}

Json models(const Assessment& a) {
  Json all = Json::array();
  for (std::size_t m = 0; m < a.models.size(); ++m) {
    const DrivenModel& model = a.models[m];
    const Recorder& r = model.recorder;
    std::vector<std::string> unknown = r.knows_not;
    for (std::string& text : left_out_of_cores(model.given)) unknown.push_back(std::move(text));
    all.push_back({{"name", model.name},
                   {"file", model.file},
                   {"sha256", model.sha256},
                   {"plane", r.plane},
                   {"recorder",
                    {{"name", r.name},
                     {"marker", r.marker},
                     {"body", model.body},
                     {"x", r.x},
                     {"y", r.y},
                     {"across", r.across},
                     {"angle", model.marker_angle},
                     {"rotation", r.rotation},
                     {"drift", r.drift},
                     {"settle", r.settle}}},
                   {"replaced", r.replaces},
                   {"notes", model.notes},
                   {"knows_not", unknown},
                   {"uncertain", uncertain_of_model(a, m)},
                   {"drawing", parse_ordered(drawing_json(completed(model.given), *program_catalogue().views))}});
  }
  return all;
}

// Returns the curves of an event. Of each interval only the sample with the largest magnitude is kept, so that peaks remain.
Json figure(const RecordEvents& record, const Window& window) {
  const std::size_t count = window.times.size(), stride = std::max<std::size_t>(1, (count + k_figure_points - 1) / k_figure_points);
  const std::string axes = record.axes();
  Json curve = {{"times", Json::array()}};
  for (std::size_t i = 0; i < axes.size(); ++i) curve[std::string(1, axes[i])] = Json::array();
  for (std::size_t from = 0; from < count; from += stride) {
    std::size_t best = from;
    double furthest = -1.0;
    for (std::size_t k = from; k < std::min(count, from + stride); ++k)
      for (std::size_t i = 0; i < axes.size(); ++i)
        if (std::abs(window.filtered[i][k]) > furthest) furthest = std::abs(window.filtered[i][k]), best = k;
    curve["times"].push_back(window.times[best]);
    for (std::size_t i = 0; i < axes.size(); ++i) curve[std::string(1, axes[i])].push_back(window.filtered[i][best]);
  }
  return curve;
}

Json limits(const std::vector<LimitPassage>& all, const char* value_name) {
  Json list = Json::array();
  for (const LimitPassage& limit : all)
    list.push_back({{"name", limit.name},
                    {value_name, number(limit.value)},
                    {"allowed", number(limit.allowed)},
                    {"unit", limit.unit},
                    {"share", number(limit.share)},
                    {"met", limit.is_met},
                    {"assumed", limit.is_assumed},
                    {"outcome", name_of(limit.outcome)},
                    {"text", limit.text}});
  return list;
}

// Returns the results of one event in one model. `begin` is the event's begin in the record, s.
Json passage(const Passage& p, const Assessment& a, double begin, const Probability* slip) {
  Json joints = Json::array(), feet = Json::array(), poses = Json::object();
  for (const BodyPose& pose : p.poses) append(poses, pose.body) = {pose.x, pose.y, pose.angle};
  for (const JointPassage& joint : p.joints)
    joints.push_back({{"name", joint.name},
                      {"slips", joint.slips},
                      {"came_apart", joint.came_apart},
                      {"margin", number(joint.margin)},
                      {"at", joint.at},
                      {"slid", joint.slid},
                      {"slid_total", joint.slid_total},
                      {"overlap_left", number(joint.overlap_left)},
                      {"error", number(joint.error)}});
  for (const FootPassage& foot : p.feet)
    feet.push_back({{"name", foot.name}, {"lifts", true}, {"from", foot.from}, {"height", number(foot.height)}});
  static constexpr const char* k_trust[] = {"good", "limited", "none"};
  return {{"model", a.models[p.model].name},
          {"made", p.is_made},
          {"verdict", name_of(p.verdict)},
          {"reason", p.reason},
          {"trust", p.trust},
          {"trust_level", k_trust[static_cast<int>(p.trust_level)]},
          {"joints", joints},
          {"feet", feet},
          {"reactions", limits(p.reactions, "value")},
          {"clearances", limits(p.clearances, "left")},
          {"criteria", limits(p.others, "value")},
          {"findings", p.findings},
          {"worst_time", p.worst_instant ? Json(begin + *p.worst_instant) : Json(nullptr)},
          {"poses", poses},
          {"still_moving", p.final_speed},
          {"slip_probability", slip ? probability(*slip) : Json(nullptr)}};
}

Json event(const Assessment& a, std::size_t number_) {
  const VoyageEvent& e = a.events[number_];
  const RecordEvents& record = a.records[e.record];
  const RecordedEvent& recorded = record.events[e.event];
  const ShockEvent& shock = recorded.event;
  const std::string axes = record.axes();
  Json peaks = Json::array(), passages = Json::array();
  for (std::size_t i = 0; i < shock.axes.size(); ++i) {
    const AxisEvent& axis = shock.axes[i];
    peaks.push_back({{"axis", std::string(1, axes[i])},
                     {"value", axis.peak},
                     {"unit", "m/s^2"},
                     {"bandwidth", record.pulse ? Json(nullptr) : Json(record.bandwidth)},
                     {"time", axis.peak_time},
                     {"velocity_change", axis.velocity_change},
                     {"duration", axis.duration},
                     {"frequency", axis.frequency},
                     {"up_to_100_Hz", number(axis.at_cfc60)},
                     {"up_to_17_Hz", number(axis.at_cfc10)}});
  }
  const double begin = recorded.window.times.empty() ? shock.begin : recorded.window.times.front();
  for (std::size_t m = 0; m < e.passages.size(); ++m)
    passages.push_back(passage(e.passages[m], a, begin, m < e.slip.size() ? &e.slip[m] : nullptr));
  const double time = shock.axes.empty() ? shock.begin : shock.axes[shock.worst].peak_time;
  Json clock = nullptr;
  if (record.clock_ns) {
    std::string stamp = stamp_text(*record.clock_ns + static_cast<std::int64_t>(std::llround(time * 1e9)));
    if (const std::size_t blank = stamp.find(' '); blank != std::string::npos) stamp[blank] = 'T';
    clock = stamp;
  }
  return {{"number", number_ + 1},
          {"record", record.file},
          {"in_record", shock.number},
          {"line", shock.line},
          {"time", time},
          {"begin", shock.begin},
          {"end", shock.end},
          {"clock", clock},
          {"duration", shock.axes.empty() ? 0.0 : shock.axes[shock.worst].duration},
          {"goes_on", shock.goes_on},
          {"below_threshold", recorded.is_below},
          {"peaks", peaks},
          {"figure", figure(record, recorded.window)},
          {"models", passages}};
}

Json shared_frictions(const Assessment& a) {
  Json all = Json::array();
  for (std::size_t f = 0; f < a.shared.size(); ++f) {
    const SharedFriction& friction = a.shared[f];
    Json events = Json::array();
    for (std::size_t e = 0; e < a.events.size(); ++e)
      if (f < a.events[e].shared.size()) {
        const SharedPassage& p = a.events[e].shared[f];
        events.push_back({{"number", e + 1},
                          {"use", number(p.use)},
                          {"at", p.at},
                          {"slips", p.slips},
                          {"slid", number(p.slid)},
                          {"slid_total", number(p.slid_total)},
                          {"upper_bound", p.bound},
                          {"disagreement", p.disagreement}});
      }
    all.push_back(
        {{"name", friction.name}, {"models", {friction.planes[0].model_name, friction.planes[1].model_name}}, {"events", events}});
  }
  return all;
}

// Returns the totals of each joint after the last simulated event.
Json voyage(const Assessment& a) {
  Json joints = Json::array();
  for (std::size_t m = 0; m < a.models.size(); ++m) {
    std::vector<JointPassage> last;
    std::vector<std::string> names;
    std::vector<long> slips;
    for (const VoyageEvent& e : a.events)
      for (const JointPassage& joint : e.passages[m].joints) {
        const auto known = std::find(names.begin(), names.end(), joint.name);
        const auto i = static_cast<std::size_t>(known - names.begin());
        if (known == names.end()) names.push_back(joint.name), slips.push_back(0), last.push_back(joint);
        slips[i] += joint.slips ? 1 : 0;
        const double least = std::min(last[i].margin, joint.margin);
        last[i] = joint;
        last[i].margin = least;
      }
    for (std::size_t i = 0; i < last.size(); ++i)
      joints.push_back({{"model", a.models[m].name},
                        {"name", last[i].name},
                        {"slid_total", last[i].slid_total},
                        {"slips", slips[i]},
                        {"overlap_left", number(last[i].overlap_left)},
                        {"least_margin", number(last[i].margin)}});
  }
  Json json = {{"joints", joints}, {"damage_probability", probability(a.damage)}};
  if (!a.shared.empty()) json["shared_frictions"] = shared_frictions(a);
  return json;
}

Json reasons(const Assessment& a) {
  Json all = Json::array();
  for (const Reason& r : a.reasons)
    all.push_back(
        {{"criterion", r.criterion}, {"outcome", name_of(r.outcome)}, {"text", r.text}, {"source", r.source}, {"tests", r.tests}});
  return all;
}

// Returns the shipping data as given; "" for missing entries.
Json shipment(const Shipment& s) {
  Json recorders = Json::array(), handovers = Json::array();
  for (const ShippedRecorder& r : s.recorders)
    recorders.push_back({{"serial", r.serial},
                         {"record", r.record},
                         {"calibrated", r.calibrated},
                         {"range", r.range},
                         {"filter", r.filter},
                         {"place", r.place}});
  for (const Handover& h : s.handovers) handovers.push_back({{"place", h.place}, {"time", h.time}});
  return {{"file", s.file},       {"transformer", s.transformer}, {"departure", s.departure},
          {"arrival", s.arrival}, {"recorders", recorders},       {"handovers", handovers}};
}

Json recorders(const Assessment& a) {
  Json all = Json::array();
  for (const RecorderFindings& found : a.recorders)
    all.push_back({{"files", found.files},
                   {"covered", found.covered},
                   {"greatest", {{"x", number(found.greatest[0])}, {"y", number(found.greatest[1])}, {"z", number(found.greatest[2])}}},
                   {"events", found.events},
                   {"least_margin", number(found.least_margin)},
                   {"decision", name_of(found.decision)},
                   {"reason", found.reason}});
  return all;
}

Json missing_evidence(const Assessment& a) {
  Json all = Json::array();
  for (const MissingEvidence& missing : a.missing)
    all.push_back({{"what", name_of(missing.item)},
                   {"reason", missing.reason},
                   {"remedy", missing.remedy},
                   {"accepted", a.is_accepted(missing.item)}});
  return all;
}

} // namespace

std::string assessment_json(const Assessment& a) {
  Json events = Json::array();
  for (std::size_t i = 0; i < a.events.size(); ++i) events.push_back(event(a, i));
  const Json json = {{"program", std::string("steplap ") + k_version},
                     {"decision", name_of(a.decision)},
                     {"reason", a.reason},
                     {"reasons", reasons(a)},
                     {"missing_evidence", missing_evidence(a)},
                     {"shipment", shipment(a.shipment)},
                     {"journey", a.voyage ? Json(a.voyage->text) : Json(nullptr)},
                     {"covered", coverage_text(a.records)},
                     {"covered_share", number(covered_share(a.records, a.voyage))},
                     {"records", records(a)},
                     {"recorders", recorders(a)},
                     {"models", models(a)},
                     {"events", std::move(events)},
                     {"voyage", voyage(a)},
                     {"hangs_on", a.hangs_on},
                     {"assumptions", a.assumptions},
                     {"tests", a.tests},
                     {"criteria",
                      {{"name", a.criteria.name},
                       {"file", a.criteria.file},
                       {"sha256", sha256(a.criteria.toml)},
                       {"text", a.criteria.text},
                       {"source", a.criteria.source}}}};
  return with_checksum(json.dump(1) + "\n");
}

} // namespace steplap::assess
