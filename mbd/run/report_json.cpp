#include "mbd/formula/unit_dimension.h"
#include "mbd/io/digest.h"
#include "mbd/run/asked_channels.h"
#include "mbd/run/ordered_json.h"
#include "mbd/run/overview.h"
#include "mbd/run/prominence.h"
#include "mbd/run/range_index.h"
#include "mbd/run/result_files.h"
#include "mbd/run/summary.h"
#include "mbd/run/version.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace steplap {

namespace {

using Json = nlohmann::ordered_json;

// Text around the checksum of the text before it, the last entry of a file.
constexpr std::string_view k_before_checksum = ",\n  \"checksum\": \"", k_after_checksum = "\"\n}\n";

Json inputs_json(const std::vector<InputFile>& inputs) {
  Json json = Json::array();
  for (const InputFile& input : inputs)
    json.push_back({{"file", input.path}, {"path", absolute_path(input)}, {"bytes", input.bytes}, {"sha256", input.sha256}});
  return json;
}

// Returns the parameters of the model; "given" is the text in the file.
Json parameters_json(const Parameters& parameters) {
  Json json = Json::array();
  for (std::size_t i = 0; i < parameters.entries.size(); ++i) {
    const Parameter& p = parameters.entries[i];
    json.push_back(
        {{"name", p.name}, {"given", p.text}, {"value", parameters.values[i]}, {"unit", unit_text(p.powers)}, {"meaning", p.meaning}});
  }
  return json;
}

Json files_json(const FileRecords& files) {
  Json json = Json::object();
  for (const FileRecord& file : files) append(json, file.name) = {{"bytes", file.bytes}, {"sha256", file.sha256}};
  return json;
}

Json findings_json(const std::vector<Finding>& findings) {
  Json json = Json::array();
  for (const Finding& f : findings)
    json.push_back({{"code", f.code},
                    {"level", f.level == FindingLevel::warning ? "warning" : "note"},
                    {"text", f.text},
                    {"file", f.where.file},
                    {"line", f.where.line}});
  return json;
}

Json settings_json(const Model& model) {
  const SimulationSettings& s = model.simulation;
  Json json;
  json["end"] = s.end;
  json["step"] = s.step ? Json(*s.step) : Json();
  json["tolerance"] = s.tolerance ? Json(*s.tolerance) : Json();
  json["initial"] = s.initial;
  json["projection_tolerance"] = s.projection_tolerance;
  json["output_step"] = model.output.step;
  return json;
}

const char* name_of(EstimateStatus status) {
  switch (status) {
  case EstimateStatus::known: return "known";
  case EstimateStatus::left_out: return "left out";
  case EstimateStatus::too_expensive: return "too dear";
  case EstimateStatus::failed: return "failed";
  }
  return "";
}

// CPU time is omitted because it differs between runs.
Json statistics_json(const RunStatistics& s) {
  return {{"steps", s.steps}, {"rejections", s.rejections}, {"evaluations", s.evaluations}, {"events", s.events}};
}

// Missing numbers (no such channel, infinite margin, no extremes) are null.
Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(); }

// JSON has no infinity: the value is null, and "…_is" states which infinity it was.
void note_infinity(Json& json, const std::string& key, double value) {
  if (std::isinf(value)) json[key + "_is"] = value > 0.0 ? "∞" : "-∞";
}

void add_number(Json& json, const std::string& key, double value) {
  json[key] = number_json(value);
  note_infinity(json, key, value);
}

// Adds the error of a number if it was estimated; null if it is unknown.
void add_error(Json& json, const char* key, std::optional<double> error) {
  if (error) json[key] = number_json(*error);
}

Json accuracy_json(const RunStatistics& s, const Report& report) {
  Json json{{"energy_residual", s.energy_residual},
            {"energy_exchanged", s.energy_exchanged},
            {"relative_energy_residual", report.relative_energy_residual},
            {"dissipated", s.dissipated},
            {"work", s.work},
            {"max_position_residual", s.max_position_residual},
            {"max_velocity_residual", s.max_velocity_residual},
            {"rests", is_at_rest(report.run)}};
  add_error(json, "error_dissipated", report.dissipated_error());
  add_error(json, "error_work", report.work_error());
  return json;
}

Json method_json(const SimulationOptions& options) {
  return {{"integrator", options.integrator}, {"step", options.settings.step}, {"tolerance", options.settings.tolerance}};
}

// Errors are relative to the scales of mbd/trust/run_comparison.h.
Json global_error_json(const Report& report) {
  const GlobalErrorEstimate& estimate = *report.estimate.errors;
  Json json;
  for (std::size_t k = 0; k < k_error_kinds; ++k) {
    const WorstError& worst = estimate.error.worst[k];
    json[name_of(static_cast<ErrorKind>(k))] = {{"error", number_json(worst.value)}, {"where", worst.where}, {"t", worst.t}};
  }
  if (!estimate.reason_unknown.empty()) json["unknown_because"] = estimate.reason_unknown;
  if (!estimate.references.empty()) json["references"] = estimate.references;
  json["unmatched_events"] = estimate.error.unmatched_events;
  json["evaluations_of_finer_runs"] = estimate.cost.evaluations;
  json["run"] = method_json(options_of(report.run.loaded->model));
  json["finer_runs"] = Json::array();
  for (const SimulationOptions& options : estimate.finer) json["finer_runs"].push_back(method_json(options));
  return json;
}

// Stores each text once, and for every channel the index of its text, because there are only few different texts.
class MeaningIndex {
public:
  [[nodiscard]] std::size_t place_of(const Channel& channel) {
    std::string text = channel.doc;
    for (const std::string* more : {&channel.sign, &channel.codes})
      if (!more->empty()) text += "; " + *more;
    const auto [place, is_new] = places_.try_emplace(std::move(text), places_.size());
    if (is_new) list_.push_back(place->first);
    return place->second;
  }
  [[nodiscard]] const Json& list() const { return list_; }

private:
  std::unordered_map<std::string, std::size_t> places_;
  Json list_ = Json::array();
};

Json extremes_of(const ChannelRange& range, const Report& report, MeaningIndex& meanings) {
  constexpr std::size_t k_most_entries = 16;
  Json entry = object_with_room(k_most_entries);
  const auto time = [](const Extreme& extreme) { return std::isnan(extreme.value) ? Json() : Json(extreme.t); };
  append(entry, "unit") = range.channel->unit;
  append(entry, "meaning") = meanings.place_of(*range.channel);
  add_number(entry, "min", range.low.value);
  entry["t_min"] = time(range.low);
  add_number(entry, "max", range.high.value);
  entry["t_max"] = time(range.high);
  add_number(entry, "final", range.final);
  if (range.channel->is_on_request) entry["on_request"] = true;
  if (range.is_low_singular) entry["min_singular"] = true; // the extreme is near a singular position, where reactions may diverge
  if (range.is_high_singular) entry["max_singular"] = true;
  if (range.had_no_value && range.channel->is_on_request) entry["had_no_value"] = true; // the formula divided by zero
  const auto add = [&](const char* key, double ChannelError::*which) { add_error(entry, key, report.error_of(range, which)); };
  add("error_min", &ChannelError::low);
  add("error_t_min", &ChannelError::t_low);
  add("error_max", &ChannelError::high);
  add("error_t_max", &ChannelError::t_high);
  add("error_final", &ChannelError::final);
  return entry;
}

Json extremes_json(const Report& report, MeaningIndex& meanings) {
  Json json = object_with_room(report.ranges().size());
  const AskedChannels asked(report.run.loaded->model, *report.run.loaded->system);
  for (const ChannelRange& range : report.ranges())
    if (!asked.leave_out(*range.channel)) append(json, range.channel->name) = extremes_of(range, report, meanings);
  return json;
}

void add_errors(Json& entry, const JointAssessment& a, const JointErrors& e) {
  entry["error_first_slip"] = a.first_slip ? number_json(e.first_slip) : Json();
  entry["error_largest_required_pressure"] = number_json(e.largest_required_pressure);
  entry["error_t_largest_required_pressure"] = number_json(e.time_of_largest);
  entry["error_smallest_margin"] = number_json(e.smallest_margin);
  entry["error_slid_x"] = number_json(e.slid_x);
  entry["error_slid_y"] = number_json(e.slid_y);
  entry["error_slid_angle"] = number_json(e.slid_angle);
  entry["error_area_lost"] = number_json(e.area_lost);
  entry["error_largest_slide_share"] = number_json(e.slid_share);
  entry["error_least_overlap_left"] = number_json(e.overlap_left);
  entry["error_least_clearance_left"] = number_json(e.clearance_left);
  if (!a.has_edges) return;
  entry["error_largest_edge_load"] = number_json(e.edge_load);
  if (a.allowed_line_load) entry["error_largest_edge_share"] = number_json(e.edge_share);
}

// Adds the results for sheet edges in contact, if the joint has edges. The margin is infinite (null) while no edge carries load.
void add_edges(Json& entry, const JointAssessment& a) {
  if (!a.has_edges) return;
  entry["largest_edge_load"] = number_json(a.edge_load.value);
  entry["t_largest_edge_load"] = a.edge_load.t;
  entry["largest_edge_pressure"] = number_json(a.edge_pressure.value);
  entry["allowed_line_load"] = a.allowed_line_load ? Json(*a.allowed_line_load) : Json();
  if (!a.allowed_line_load) return;
  entry["largest_edge_share"] = number_json(a.edge_share.value);
  entry["smallest_edge_margin"] = number_json(a.edge_margin());
  entry["crushed_edges"] = std::isnan(a.edge_share.value) ? Json() : Json(a.has_crushed_edges());
}

// Adds the elements that carry load in parallel with the joint. The joint's values refer to its own share of the load.
void add_shared(Json& entry, const JointAssessment& a) {
  if (a.shared_with.empty()) return;
  entry["shares_before_it_slides"] = a.is_elastic;
  entry["shared_with"] = Json::array();
  for (const SharedLoad& shared : a.shared_with)
    entry["shared_with"].push_back({{"element", shared.element}, {"largest_force", number_json(shared.largest)}});
}

Json joints_json(const Report& report) {
  const Run& run = report.run;
  Json json = Json::object();
  for (const JointAssessment& a : report.joints) {
    Json& entry = append(json, a.joint);
    entry = {{"verdict", words_of(a.verdict)},
             {"outcome", name_of(outcome_of(a.verdict))},
             {"slipped", a.has_slipped},
             {"monitored", a.is_monitored},
             {"first_slip", a.first_slip ? Json(*a.first_slip) : Json()},
             {"largest_required_pressure", number_json(a.largest_required_pressure)},
             {"t_largest_required_pressure", a.time_of_largest},
             {"smallest_margin", number_json(a.smallest_margin)},
             {"least_margin_asked", a.least_margin},
             {"least_pressure", number_json(a.least_pressure.value)},
             {"smallest_corner_margin", number_json(a.corner_margin.value)},
             {"smallest_packet_margin", number_json(a.part_margin.value)},
             {"largest_demand", number_json(a.largest_demand)},
             {"limb_weight", number_json(a.weight)},
             {"was_loaded", a.is_loaded},
             {"slid_x", number_json(a.slid_x)},
             {"slid_y", number_json(a.slid_y)},
             {"slid_angle", number_json(a.slid_angle)},
             {"area_lost", number_json(a.area_lost)},
             {"largest_slide_share", number_json(a.slid_share.value)},
             {"most_slide_share", a.most_slide},
             {"least_overlap_left", number_json(a.overlap_left.value)},
             {"least_clearance_left", number_json(a.clearance_left.value)}};
    note_infinity(entry, "largest_required_pressure", a.largest_required_pressure);
    add_edges(entry, a);
    add_shared(entry, a);
    if (report.estimate.errors) add_errors(entry, a, joint_errors(a, *run.loaded->system, run.result, *report.estimate.errors));
  }
  return json;
}

Json second_opinion_json(const SecondOpinion& opinion) {
  return {{"method", opinion.method},
          {"drawn_step", opinion.drawn_step > 0.0 ? Json(opinion.drawn_step) : Json()},
          {"agrees", opinion.none_because.empty() ? Json(opinion.disagreement.empty()) : Json()},
          {"disagreement", opinion.disagreement},
          {"none_because", opinion.none_because},
          {"worst_ratio", number_json(opinion.worst_ratio)},
          {"known_until", opinion.known_until}};
}

Json story_json(const std::vector<StoryEntry>& story) {
  Json json = Json::array();
  for (const StoryEntry& e : story)
    json.push_back({{"from", e.from},
                    {"to", e.to ? Json(*e.to) : Json()},
                    {"what", key_of(e.what)},
                    {"who", e.who},
                    {"count", e.count},
                    {"amount", e.amount ? Json{{"value", number_json(e.amount->value)}, {"unit", e.amount->unit}} : Json()},
                    {"text", e.text}});
  return json;
}

// Returns the summary for screen and page (overview.h).
Json overview_json(const Overview& overview, ShownDigits digits) {
  const auto optional = [](const std::optional<double>& value) { return value ? number_json(*value) : Json(); };
  Json utilisations = Json::array();
  for (const Utilisation& u : overview.utilisations)
    utilisations.push_back({{"name", u.name},
                            {"channel", u.channel},
                            {"share", u.share},
                            {"value", optional(u.value)},
                            {"limit", optional(u.limit)},
                            {"unit", u.unit},
                            {"at", optional(u.at)},
                            {"percent", shown_share(u.share, u.error, digits)},
                            {"detail", u.detail},
                            {"text", u.text},
                            {"beyond", u.beyond},
                            {"is_judged", u.criterion.has_value()},
                            {"error", optional(u.error)}});
  return {{"verdict", name_of(overview.verdict)},
          {"is_judged", overview.is_judged},
          {"reason", overview.reason},
          {"trust", {{"level", name_of(overview.trust.level)}, {"text", overview.trust.text}, {"guards", overview.trust.guards}}},
          {"worst_instant", optional(overview.worst_instant)},
          {"story", story_json(overview.story)},
          {"utilisations", std::move(utilisations)},
          {"moved", overview.moved}};
}

Json state_json(const System& system, const State& state, const Report& report) {
  Json bodies = Json::object(), errors = Json::object();
  const RangeIndex ranges(report.ranges());
  for (std::size_t i = 1; i < system.bodies.size(); ++i) {
    const double* q = &state.q[3 * i];
    const double* v = &state.v[3 * i];
    append(bodies, system.bodies[i].name) = {{"x", q[0]}, {"y", q[1]}, {"theta", q[2]}, {"vx", v[0]}, {"vy", v[1]}, {"omega", v[2]}};
    if (!report.estimate.errors) continue;
    Json error = Json::object();
    for (const char* part : {"x", "y", "theta", "vx", "vy", "omega"})
      if (const ChannelRange* const range = ranges.find(system.bodies[i].name + "." + part))
        add_error(error, part, report.error_of(*range, &ChannelError::final));
    if (!error.empty()) append(errors, system.bodies[i].name) = std::move(error);
  }
  Json json{{"t", state.t}, {"bodies", std::move(bodies)}};
  if (report.estimate.errors) json["errors"] = std::move(errors);
  return json;
}

} // namespace

OrderedJson model_json(const LoadedModel& loaded) {
  Json json{{"file", loaded.path},
            {"name", loaded.name},
            {"title", loaded.model.header.title},
            {"overrides", loaded.overrides},
            {"inputs", inputs_json(loaded.inputs)}};
  if (!loaded.model.parameters.entries.empty()) json["parameters"] = parameters_json(loaded.model.parameters);
  return json;
}

OrderedJson judgement_json(const Judgement& judgement) {
  const auto optional = [](const std::optional<double>& value) { return value ? number_json(*value) : Json(); };
  Json criteria = Json::array();
  for (const CriterionResult& c : judgement.criteria) {
    criteria.push_back({{"name", c.name},
                        {"criterion", c.text},
                        {"reason", c.reason},
                        {"is_met", c.outcome == Verdict::open ? Json() : Json(c.outcome == Verdict::hold)},
                        {"consequence", name_of(c.consequence)},
                        {"outcome", name_of(c.outcome)},
                        {"where", c.where},
                        {"value", optional(c.value)},
                        {"limit", optional(c.limit)},
                        {"unit", c.unit},
                        {"t", optional(c.t)},
                        {"error", optional(c.error)},
                        {"error_t", optional(c.t_error)},
                        {"doubt", c.doubt}});
    if (c.value) note_infinity(criteria.back(), "value", *c.value);
    // Distinguishes an unknown error from one that was not estimated, which is null, too.
    if (c.error && !std::isfinite(*c.error)) criteria.back()["error_is"] = "unknown";
    if (c.t_error && !std::isfinite(*c.t_error)) criteria.back()["error_t_is"] = "unknown";
  }
  return {{"verdict", name_of(judgement.verdict)},
          {"so_far", name_of(judgement.so_far)},
          {"distrust", judgement.distrust},
          {"capped_by", judgement.caps},
          {"criteria", std::move(criteria)}};
}

OrderedJson summary_head(const Report& report, ShownDigits digits) {
  const Run& run = report.run;
  const LoadedModel& loaded = *run.loaded;
  Json json = object_with_room(32); // capacity includes the entries that summary_document() adds
  json["program"] = {{"name", "steplap"}, {"version", k_version}};
  json["model"] = model_json(loaded);
  json["overview"] = overview_json(overview_of(report, digits), digits);
  json["completed"] = !run.failure;
  if (run.failure) json["failure"] = run.failure->text;
  json["findings"] = findings_json(report.findings);
  json["error_estimate"] = name_of(report.estimate.status);
  if (!report.estimate.errors) json["error_not_estimated"] = report.estimate.reason;
  const auto main = std::count_if(run.result.events.begin(), run.result.events.end(), is_main_event);
  json["events"] = {{"count", run.result.events.size()}, {"main", main}, {"by_kind", report.event_counts}};
  return json;
}

namespace {

// Returns the document up to the extremes.
Json document_before_extremes(const Report& report, ShownDigits digits) {
  const Run& run = report.run;
  const LoadedModel& loaded = *run.loaded;
  const RunStatistics& statistics = run.result.statistics;
  Json json = summary_head(report, digits);
  json["integrator"] = loaded.model.simulation.integrator;
  json["settings"] = settings_json(loaded.model);
  if (!run.result.ended_by.empty()) json["ended_by"] = run.result.ended_by;
  json["statistics"] = statistics_json(statistics);
  json["accuracy"] = accuracy_json(statistics, report);
  if (report.estimate.errors) json["global_error"] = global_error_json(report);
  if (Json joints = joints_json(report); !joints.empty()) json["joints"] = std::move(joints);
  // Without criteria there is no verdict, unless the run itself cannot be trusted.
  if (report.judgement.has_criteria || !report.judgement.distrust.empty()) json["judgement"] = judgement_json(report.judgement);
  std::vector<std::string> left_out;
  for (const auto effects_of : loaded.views->left_out)
    for (std::string& effect : effects_of(loaded.model)) left_out.push_back(std::move(effect));
  if (!left_out.empty()) json["left_out"] = left_out;
  if (report.second_opinion) json["second_opinion"] = second_opinion_json(*report.second_opinion);
  return json;
}

// Appends the entries after the extremes.
void add_after_extremes(Json& json, const Report& report, const MeaningIndex& meanings) {
  json["meanings"] = meanings.list();
  json["final_state"] = state_json(*report.run.loaded->system, report.run.result.final_state, report);
}

// Invalid UTF-8 in names is replaced, because an exception after a long run would lose its results.
std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace); }

// Returns the entries of an object as text, each on new lines, indented by `more` blanks more than in an object that is a document. JSON
// text contains line breaks only between its parts.
std::string entries_text(const Json& object, std::string_view more = "") {
  const std::string text = text_of(object);
  std::string entries;
  for (const char c : std::string_view(text).substr(1, text.size() - 3)) { // without "{" and "\n}"
    entries += c;
    if (c == '\n') entries += more;
  }
  return entries;
}

} // namespace

OrderedJson summary_document(const Report& report, ShownDigits digits) {
  Json json = document_before_extremes(report, digits);
  MeaningIndex meanings;
  json["extremes"] = extremes_json(report, meanings);
  add_after_extremes(json, report, meanings);
  return json;
}

// Writes the text of summary_document() with `files`. The extremes become text one by one: as one tree they take ten times as much memory.
void write_summary(const Report& report, const FileRecords& files, const FileSink& put) {
  constexpr std::size_t k_part = 1 << 16; // bytes per piece, about the size of a cache
  Sha256 digest;
  std::string text = "{" + entries_text(document_before_extremes(report, {})) + ",\n  \"extremes\": {";
  const auto put_text = [&] {
    digest.add(text);
    put(text);
    text.clear();
  };
  MeaningIndex meanings;
  const AskedChannels asked(report.run.loaded->model, *report.run.loaded->system);
  bool is_first = true;
  for (const ChannelRange& range : report.ranges()) {
    if (asked.leave_out(*range.channel)) continue;
    Json entry = Json::object();
    append(entry, range.channel->name) = extremes_of(range, report, meanings);
    text += (is_first ? "" : ",") + entries_text(entry, "  ");
    is_first = false;
    if (text.size() >= k_part) put_text();
  }
  text += is_first ? "}" : "\n  }";
  Json rest = Json::object();
  add_after_extremes(rest, report, meanings);
  rest["files"] = files_json(files);
  text += "," + entries_text(rest);
  put_text();
  put(std::string(k_before_checksum) + digest.hex() + std::string(k_after_checksum));
}

std::string summary_json(const Report& report, const FileRecords& files) {
  std::string text;
  write_summary(report, files, [&text](std::string_view part) { text += part; });
  return text;
}

std::string with_checksum(std::string_view json) {
  const std::string content(json.substr(0, json.size() - std::string_view("\n}\n").size()));
  return content + std::string(k_before_checksum) + sha256(content) + std::string(k_after_checksum);
}

std::string_view checked_content(std::string_view text) {
  constexpr std::size_t k_digits = 64;
  const std::size_t tail = k_before_checksum.size() + k_digits + k_after_checksum.size();
  if (text.size() < tail) return {};
  const std::string_view content = text.substr(0, text.size() - tail);
  const std::string wanted = std::string(k_before_checksum) + sha256(content) + std::string(k_after_checksum);
  return text.substr(content.size()) == wanted ? content : std::string_view{};
}

} // namespace steplap
