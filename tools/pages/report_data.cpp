#include "tools/pages/report_data.h"

#include "mbd/io/atomic_file.h"
#include "mbd/io/digest.h"
#include "mbd/run/drawing.h"
#include "mbd/run/measured_text.h"
#include "mbd/run/version.h"
#include "mbd/simulation/trajectory.h"
#include "tools/pages/thinning.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <unordered_set>

namespace steplap {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t k_most_events = 2000;       ///< largest number of events on the page
constexpr std::size_t k_most_model_text = 400000; ///< longest text of a model, bytes
constexpr std::size_t k_most_bodies = 2000;       ///< largest number of bodies drawn
/// largest number of channels of all runs; each adds its name and extremes, whatever the number of samples
constexpr std::size_t k_most_channels = 10000;
constexpr std::size_t k_least_stretches = 60; ///< smallest number of intervals of a thinned curve; with fewer it is useless
constexpr double k_base64 = 4.0 / 3.0;

template <class T> std::string base64_of(const std::vector<T>& values) { return base64(std::as_bytes(std::span(values))); }

Json parsed(const Results& run, const std::string& text, const char* file) {
  Json json = parse_ordered(text);
  if (json.is_discarded())
    throw FileError(run.folder + "/" + file, "'" + run.folder + "/" + file + "' is not as steplap wrote it: run the model again");
  return json;
}

// Channels to be included in the page, and the resolution of their curves.
struct Plan {
  std::vector<std::vector<std::size_t>> kept; ///< per run: indices of channels, in the order of the file
  std::size_t stretches = 0;                  ///< number of intervals per curve; 0: all samples are kept
};

// Returns the priority of a channel: 0 if the page needs it, then reactions and similar, then others. Channels with large numbers are
// omitted first.
int rank_of(const ResultChannel& channel, const Json& drawing) {
  for (const Json& plot : drawing["plots"])
    for (const char* list : {"channels", "bounds"})
      for (const Json& pattern : plot[list])
        if (matches_pattern(channel.name, pattern.get<std::string>())) return 0;
  const std::string part = channel.name.substr(channel.name.rfind('.') + 1);
  if (part == "mode" || part == "slip_rate" || part == "p_req" || part == "margin") return 1;
  if (part == "x" || part == "y" || part == "theta") return 2;
  return part == "force" || part == "friction" || part == "slide" ? 3 : 4;
}

Plan plan_for(const std::vector<Results>& runs, const std::vector<Json>& drawings, std::size_t budget) {
  Plan plan;
  std::size_t rows = 0, channels = 0;
  for (const Results& run : runs) {
    rows = std::max(rows, run.times.size());
    channels += run.channels.size();
    plan.kept.emplace_back(run.channels.size());
    std::iota(plan.kept.back().begin(), plan.kept.back().end(), std::size_t{0});
  }
  const double bytes = static_cast<double>(budget) / k_base64;
  const auto kept_bytes = [&](std::size_t count) { return static_cast<double>(count * rows) * sizeof(float); };
  if (kept_bytes(channels) <= bytes && channels <= k_most_channels) return plan;
  // Bytes per interval of a thinned curve: two points with time and value.
  constexpr double k_stretch = 4.0 * sizeof(float);
  const auto thinned_most = static_cast<std::size_t>(bytes / (k_stretch * k_least_stretches));
  const std::size_t most =
      kept_bytes(std::min(channels, k_most_channels)) <= bytes ? k_most_channels : std::min(k_most_channels, thinned_most);
  if (channels > most)
    for (std::size_t r = 0; r < runs.size(); ++r) {
      auto& kept = plan.kept[r];
      std::vector<int> rank;
      for (const ResultChannel& channel : runs[r].channels) rank.push_back(rank_of(channel, drawings[r]));
      std::stable_sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) { return rank[a] < rank[b]; });
      kept.resize(std::min(kept.size(), std::max<std::size_t>(1, most / runs.size())));
      std::sort(kept.begin(), kept.end());
    }
  channels = 0;
  for (const auto& kept : plan.kept) channels += kept.size();
  if (kept_bytes(channels) <= bytes) return plan;
  plan.stretches = std::max(k_least_stretches, static_cast<std::size_t>(bytes / (k_stretch * static_cast<double>(channels))));
  return plan;
}

Json channel_json(const ResultChannel& channel, const std::vector<double>& times, std::size_t stretches) {
  const auto first = std::find_if(channel.values.begin(), channel.values.end(), [](double v) { return std::isfinite(v); });
  const double zero = first == channel.values.end() ? 0.0 : *first;
  std::vector<float> values, own_times;
  const bool is_thinned = stretches > 0 && times.size() > 2 * stretches + 2;
  if (is_thinned) {
    for (const std::size_t i : thinned(channel.values, stretches)) {
      values.push_back(static_cast<float>(channel.values[i] - zero));
      own_times.push_back(static_cast<float>(times[i]));
    }
  } else {
    for (const double value : channel.values) values.push_back(static_cast<float>(value - zero));
  }
  Json json{{"name", channel.name}, {"unit", channel.unit}, {"zero", zero}, {"values", base64_of(values)}};
  if (is_thinned) json["times"] = base64_of(own_times);
  return json;
}

// Returns the code of an event kind for the page's scripts, which do not interpret texts.
const char* role_of(EventKind kind) {
  if (is_slip(kind)) return "slip";
  switch (kind) {
  case EventKind::sticks: return "stick";
  case EventKind::comes_apart: return "apart";
  case EventKind::breaks:
  case EventKind::loses_interface: return "break";
  case EventKind::opens:
  case EventKind::leaves_stop:
  case EventKind::enters_gap: return "open";
  case EventKind::closes:
  case EventKind::closes_gap: return "close";
  case EventKind::reaches_lower_stop:
  case EventKind::reaches_upper_stop: return "strike";
  case EventKind::loses_normal_force: return "free"; // the contact that presses this friction has opened
  default: return "";
  }
}

Json events_json(const Results& run) {
  Json json = Json::array();
  for (std::size_t i = 0; i < std::min(run.events.size(), k_most_events); ++i) {
    const ResultEvent& event = run.events[i];
    json.push_back({event.t, event.element, event.words, measured_time_text(event.t, event.error), role_of(event.kind)});
  }
  return json;
}

// Adds to a number of summary.json the text with its error, as printed on the screen. The page formats numbers without an error itself.
void add_text(Json& entry, const std::string& value, const std::string& error, const std::string& unit) {
  if (!entry.contains(error) || !entry.contains(value) || !entry[value].is_number()) return;
  const double known_to = entry[error].is_number() ? entry[error].get<double>() : std::numeric_limits<double>::quiet_NaN();
  entry["text_" + value] = measured_text(entry[value].get<double>(), known_to, unit);
}

void add_texts(Json& summary) {
  if (!summary.contains("global_error")) return;
  for (Json& entry : summary["extremes"]) {
    const std::string unit = entry["unit"].get<std::string>();
    for (const char* key : {"min", "max", "final"}) add_text(entry, key, std::string("error_") + key, unit);
    for (const char* key : {"t_min", "t_max"}) add_text(entry, key, std::string("error_") + key, "s");
  }
  if (summary.contains("joints"))
    for (Json& entry : summary["joints"]) {
      const std::pair<const char*, const char*> figures[] = {
          {"first_slip", "s"},   {"smallest_margin", ""}, {"largest_required_pressure", "Pa"}, {"slid_x", "m"},           {"slid_y", "m"},
          {"slid_angle", "rad"}, {"area_lost", "m^2"},    {"largest_edge_load", "N/m"},        {"largest_edge_share", ""}};
      for (const auto& [key, unit] : figures) add_text(entry, key, std::string("error_") + key, unit);
    }
  if (summary.contains("judgement"))
    for (Json& entry : summary["judgement"]["criteria"]) {
      add_text(entry, "value", "error", entry["unit"].get<std::string>());
      add_text(entry, "t", "error_t", "s");
    }
  for (const char* key : {"dissipated", "work"}) add_text(summary["accuracy"], key, std::string("error_") + key, "J");
}

// Removes the extremes of omitted channels, which would be most of the page for large models.
void keep_extremes(Json& summary, const Results& run, const std::vector<std::size_t>& kept) {
  std::unordered_set<std::string> names;
  for (const std::size_t i : kept) names.insert(run.channels[i].name);
  Json extremes = Json::object();
  for (auto& [name, entry] : summary["extremes"].items())
    if (names.count(name) > 0) append(extremes, name) = std::move(entry);
  summary["extremes"] = std::move(extremes);
  summary.erase("final_state");
}

std::string shortened(const std::string& model) {
  if (model.size() <= k_most_model_text) return model;
  return model.substr(0, k_most_model_text) + "\n# … the rest is in model.toml\n";
}

Json run_json(const Results& run, Json summary, Json drawing, const std::vector<std::size_t>& kept, std::size_t stretches) {
  keep_extremes(summary, run, kept);
  add_texts(summary);
  const std::size_t bodies = drawing["bodies"].size();
  if (bodies > k_most_bodies) {
    drawing["bodies"].erase(drawing["bodies"].begin() + k_most_bodies, drawing["bodies"].end());
    drawing["elements"] = Json::array();
  }
  Json channels = Json::array();
  for (const std::size_t i : kept) channels.push_back(channel_json(run.channels[i], run.times, stretches));
  const bool is_thinned = stretches > 0 && run.times.size() > 2 * stretches + 2;
  // Thinned channels have their own times; of the common times only the ends are needed.
  const std::vector<double> ends{run.times.front(), run.times.back()};
  return {{"name", run.name},
          {"model_text", shortened(run.model)},
          {"model_sha256", sha256(run.model)},
          {"model_date", run.model_date},
          {"summary", std::move(summary)},
          {"events", events_json(run)},
          {"events_left_out", run.events.size() - std::min(run.events.size(), k_most_events)},
          {"bodies_left_out", bodies - std::min(bodies, k_most_bodies)},
          {"drawing", std::move(drawing)},
          {"is_thinned", is_thinned},
          {"channels_left_out", run.channels.size() - kept.size()},
          {"times", base64_of(is_thinned ? ends : run.times)},
          {"channels", std::move(channels)}};
}

std::string data_of(const std::vector<Results>& runs, std::vector<Json> summaries, std::size_t budget) {
  std::vector<Json> drawings;
  for (const Results& run : runs) drawings.push_back(parsed(run, run.drawing, "drawing.json"));
  const Plan plan = plan_for(runs, drawings, budget);
  Json json{{"program", std::string("steplap ") + k_version}, {"runs", Json::array()}};
  for (std::size_t r = 0; r < runs.size(); ++r)
    json["runs"].push_back(run_json(runs[r], std::move(summaries[r]), std::move(drawings[r]), plan.kept[r], plan.stretches));
  return in_script(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

} // namespace

std::string report_data(const std::vector<Results>& runs, std::size_t budget) {
  std::vector<Json> summaries;
  for (const Results& run : runs) summaries.push_back(parsed(run, run.summary, "summary.json"));
  return data_of(runs, std::move(summaries), budget);
}

std::string report_data(const Results& run, OrderedJson summary, std::size_t budget) {
  std::vector<Json> summaries;
  summaries.push_back(std::move(summary));
  return data_of({run}, std::move(summaries), budget);
}

OrderedJson run_without_histories(const LoadedModel& loaded) {
  return {{"name", loaded.name},
          {"summary", {{"extremes", Json::object()}}},
          {"events", Json::array()},
          {"channels", Json::array()},
          {"drawing", parse_ordered(drawing_json(loaded.model, *loaded.views))}};
}

OrderedJson run_without_histories(Results run) {
  Json summary = parsed(run, run.summary, "summary.json"), drawing = parsed(run, run.drawing, "drawing.json");
  const Json worst = summary.value(Json::json_pointer("/overview/worst_instant"), Json());
  const double t = worst.is_number() ? worst.get<double>() : run.times.back();
  const auto distance = [t](double a, double b) { return std::abs(a - t) < std::abs(b - t); };
  const std::size_t nearest = static_cast<std::size_t>(std::min_element(run.times.begin(), run.times.end(), distance) - run.times.begin());
  run.times = {run.times[nearest]};
  for (ResultChannel& channel : run.channels) channel.values = {channel.values[nearest]};
  const Plan plan = plan_for({run}, {drawing}, std::numeric_limits<std::size_t>::max() / 2);
  return run_json(run, std::move(summary), std::move(drawing), plan.kept.front(), 0);
}

std::string in_script(const std::string& json) {
  std::string safe;
  for (const char c : json)
    if (c == '<') safe += "\\u003c";
    else safe += c;
  return safe;
}

} // namespace steplap
