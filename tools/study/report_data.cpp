#include "tools/study/report_data.h"

#include "mbd/run/quantity_text.h"
#include "mbd/run/version.h"
#include "tools/study/kinds.h"
#include "tools/study/report_findings.h"
#include "tools/study/report_tally.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace steplap::study {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t k_most_text = 400000; ///< longest texts of study and models, in bytes
constexpr std::size_t k_most_reasons = 200; ///< largest number of reasons in the list
constexpr std::size_t k_most_growth = 1500; ///< largest number of intermediate estimates per method
constexpr std::size_t k_most_columns = 60;  ///< largest number of columns with a plot of their distribution
constexpr std::size_t k_most_times = 3000;  ///< largest number of points of a measured record

template <class T> std::string base64(const std::vector<T>& values) {
  static const char* const k_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data()); // NOLINT: bytes
  const std::size_t size = values.size() * sizeof(T);
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const unsigned three = bytes[i] << 16U | (i + 1 < size ? bytes[i + 1] << 8U : 0U) | (i + 2 < size ? bytes[i + 2] : 0U);
    text += k_digits[three >> 18U];
    text += k_digits[three >> 12U & 63U];
    text += i + 1 < size ? k_digits[three >> 6U & 63U] : '=';
    text += i + 2 < size ? k_digits[three & 63U] : '=';
  }
  return text;
}

// All samples of a study, stored by column.
struct Samples {
  std::vector<ReportColumn> columns;
  std::vector<std::string> is;             ///< description of each column
  std::vector<std::vector<double>> values; ///< values of each column
  std::vector<std::uint8_t> status;
  std::vector<std::uint32_t> reason; ///< reason of each sample, as an index in `reasons`
  std::vector<std::string> reasons{""};
  [[nodiscard]] std::size_t size() const { return status.size(); }
};

// Returns the description of a name from the store; nullptr for stores of older versions.
const Json* entry_of(const Json& list, const std::string& name) {
  if (!list.is_array()) return nullptr;
  for (const Json& entry : list)
    if (entry.is_object() && entry.value("name", "") == name) return &entry;
  return nullptr;
}

void add_column(Samples& samples, const std::string& name, const Json* about, const char* role, const char* key) {
  ReportColumn column{name, about ? about->value("unit", "") : "", about ? about->value("role", role) : role};
  samples.is.push_back(about ? about->value(key, "") : "");
  samples.columns.push_back(std::move(column));
}

Samples read_samples(Store& store, const Json& about) {
  Samples samples;
  const StoreIdentity& identity = store.identity();
  for (const std::string& name : identity.variables) add_column(samples, name, entry_of(about["variables"], name), "variable", "varies");
  for (const std::string& name : identity.numbers) add_column(samples, name, entry_of(about["numbers"], name), "response", "is");
  const bool has_runs = about["models"].is_array() && !about["models"].empty();
  if (has_runs) {
    samples.columns.insert(samples.columns.end(), {{"energy error", "", "cost"}, {"evaluations", "", "cost"}});
    samples.is.insert(samples.is.end(), {"energy that does not balance, of what was turned over", "of the equations of motion"});
  }
  samples.values.resize(samples.columns.size());
  std::map<std::string, std::uint32_t> places{{"", 0}};
  std::vector<StoredSample> rows;
  constexpr long k_block = 10000;
  for (long first = 1; first <= store.size(); first += k_block) {
    store.read(first, std::min(k_block, store.size() - first + 1), rows);
    for (const StoredSample& row : rows) {
      std::size_t c = 0;
      for (const double x : row.values) samples.values[c++].push_back(x);
      for (const double x : row.outcome.numbers) samples.values[c++].push_back(x);
      if (has_runs) {
        samples.values[c++].push_back(row.outcome.error);
        samples.values[c++].push_back(row.outcome.evaluations);
      }
      samples.status.push_back(static_cast<std::uint8_t>(row.outcome.status));
      const auto [place, is_new] = places.try_emplace(row.outcome.reason, static_cast<std::uint32_t>(samples.reasons.size()));
      if (is_new) samples.reasons.push_back(row.outcome.reason);
      samples.reason.push_back(place->second);
    }
  }
  return samples;
}

std::vector<std::size_t> columns_of(const Samples& samples, const std::string& role) {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < samples.columns.size(); ++c)
    if (samples.columns[c].role == role) found.push_back(c);
  return found;
}

// Returns the class of each sample: 2 for a failed run, 1 for a negative limit state, 0 otherwise.
std::vector<char> classes_of(const Samples& samples) {
  std::vector<char> classes(samples.size(), 0);
  const std::vector<std::size_t> limits = columns_of(samples, "limit state");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.status[i] != 0) classes[i] = 2;
    else classes[i] = std::any_of(limits.begin(), limits.end(), [&](std::size_t c) { return samples.values[c][i] < 0.0; });
  }
  return classes;
}

template <class T> std::vector<T> taken(const std::vector<T>& all, const std::vector<std::size_t>& which) {
  std::vector<T> some;
  some.reserve(which.size());
  for (const std::size_t i : which) some.push_back(all[i]);
  return some;
}

Json samples_json(const Samples& samples, const std::vector<char>& classes, std::size_t budget) {
  const double row = (8.0 * static_cast<double>(samples.columns.size()) + 9.0) * 4.0 / 3.0;
  const std::vector<std::size_t> chosen = chosen_samples(classes, static_cast<std::size_t>(static_cast<double>(budget) / row));
  Json json{{"total", samples.size()}};
  Json counts = Json::array();
  for (int kind = 0; kind < 3; ++kind) {
    const auto shown = std::count_if(chosen.begin(), chosen.end(), [&](std::size_t i) { return classes[i] == kind; });
    counts.push_back({{"all", std::count(classes.begin(), classes.end(), kind)}, {"shown", shown}});
  }
  json["classes"] = std::move(counts);
  std::vector<std::uint32_t> numbers;
  for (const std::size_t i : chosen) numbers.push_back(static_cast<std::uint32_t>(i + 1));
  json["numbers"] = base64(numbers);
  json["status"] = base64(taken(samples.status, chosen));
  // Lists the reasons of the samples shown only, because their total number has no limit.
  Json reasons = Json::array({""});
  std::map<std::uint32_t, std::uint32_t> places{{0U, 0U}};
  std::vector<std::uint32_t> reason;
  for (const std::size_t i : chosen) {
    const auto [place, is_new] = places.try_emplace(samples.reason[i], static_cast<std::uint32_t>(reasons.size()));
    if (is_new) reasons.push_back(samples.reasons[samples.reason[i]]);
    reason.push_back(place->second);
  }
  json["reasons"] = std::move(reasons);
  json["reason"] = base64(reason);
  json["columns"] = Json::array();
  for (std::size_t c = 0; c < samples.columns.size(); ++c) {
    const ReportColumn& column = samples.columns[c];
    double size = 0.0;
    for (const double x : samples.values[c])
      if (std::isfinite(x)) size = std::max(size, std::abs(x));
    const UnitPrefix prefix = prefix_for(size, column.unit);
    json["columns"].push_back({{"name", column.name},
                               {"role", column.role},
                               {"unit", prefix.text + column.unit},
                               {"factor", std::pow(10.0, prefix.exponent)},
                               {"is", samples.is[c]},
                               {"data", base64(taken(samples.values[c], chosen))}});
  }
  return json;
}

Json curve_json(const Curve& c) { return {{"x", c.x}, {"p", c.p}, {"low", c.low}, {"high", c.high}}; }

Json tally_json(const std::string& name, const Tally& t) {
  return {
      {"name", name},
      {"total", t.total},
      {"missing", t.missing},
      {"above", t.above},
      {"below", t.below},
      {"mean", t.mean},
      {"cumulative", curve_json(t.cumulative)},
      {"histogram", {{"edges", t.histogram.edges}, {"counts", t.histogram.counts}, {"low", t.histogram.low}, {"high", t.histogram.high}}}};
}

// Returns the settings described in the store.
ShownSettings shown_settings(const Json& settings) {
  ShownSettings shown;
  for (const auto& [key, value] : settings.items()) {
    std::vector<std::string>& texts = shown[key];
    for (const Json& one : value.is_array() ? value : Json::array({value}))
      if (one.is_string()) texts.push_back(one.get<std::string>());
  }
  return shown;
}

Json distributions_json(const Samples& samples, Drawn drawn) {
  Json json{{"drawn", drawn == Drawn::independently ? "independently"
                      : drawn == Drawn::by_design   ? "by design"
                                                    : "otherwise"},
            {"of", Json::array()}};
  std::size_t left_out = 0;
  for (std::size_t c = 0; c < samples.columns.size() && drawn != Drawn::otherwise; ++c) {
    const std::vector<double>& values = samples.values[c];
    if (samples.columns[c].role == "cost") continue;
    if (samples.columns[c].role == "variable" && std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end())
      continue; // constant variables are not shown
    if (json["of"].size() < k_most_columns)
      json["of"].push_back(tally_json(samples.columns[c].name, tally_of(values, drawn == Drawn::independently)));
    else ++left_out;
  }
  json["left_out"] = left_out;
  return json;
}

Json running_json(const std::string& subject, const char* quantity, const std::string& unit, const Running& r) {
  return {{"subject", subject}, {"quantity", quantity}, {"unit", unit},  {"samples", r.samples},
          {"value", r.value},   {"low", r.low},         {"high", r.high}};
}

// Returns how failure fractions and means converge with the number of independent samples.
Json running_estimates(const Samples& samples, const std::string& failed) {
  Json json = Json::array();
  for (const std::size_t c : columns_of(samples, "limit state")) {
    std::vector<char> sure, possible;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const bool is_bad = samples.status[i] != 0, fails = !is_bad && samples.values[c][i] < 0.0;
      sure.push_back(fails || (is_bad && failed == "unsafe"));
      possible.push_back(fails || (is_bad && failed != "safe"));
    }
    json.push_back(running_json(samples.columns[c].name, "share of failures", "", running_share(sure, possible)));
  }
  for (const std::size_t c : columns_of(samples, "response"))
    json.push_back(running_json(samples.columns[c].name, "mean", samples.columns[c].unit, running_mean(samples.values[c])));
  return json;
}

Json findings_json(const std::vector<Finding>& findings, const std::vector<ReportColumn>& columns) {
  Json json = Json::array();
  for (const Finding& f : findings) {
    const FindingView view = view_of(f, columns);
    json.push_back({{"method", f.method},
                    {"subject", f.subject},
                    {"quantity", f.quantity},
                    {"value", f.value},
                    {"low", f.low},
                    {"high", f.high},
                    {"samples", f.samples},
                    {"status", f.status},
                    {"role", view.role},
                    {"variable", view.variable},
                    {"place", view.place},
                    {"text", view.value},
                    {"interval", view.interval},
                    {"unit", view.unit}});
  }
  return json;
}

// Returns all columns to which findings may refer: samples and measured records.
std::vector<ReportColumn> named_columns(const Samples& samples, const Json& about) {
  std::vector<ReportColumn> columns = samples.columns;
  for (const Json& h : about["histories"]) columns.push_back({h.value("name", ""), h.value("unit", ""), "history"});
  return columns;
}

// Returns intermediate estimates by method, in the order of the methods.
Json growth_json(const std::vector<Finding>& growth) {
  std::vector<std::string> methods;
  std::map<std::string, std::vector<const Finding*>> of;
  for (const Finding& f : growth) {
    const std::string name = f.method + "\n" + f.subject + "\n" + f.quantity;
    if (of[name].empty()) methods.push_back(name);
    of[name].push_back(&f);
  }
  Json json = Json::array();
  for (const std::string& name : methods) {
    const std::vector<const Finding*>& all = of[name];
    Json one{{"method", all.front()->method}, {"subject", all.front()->subject}, {"quantity", all.front()->quantity}, {"all", all.size()}};
    const std::size_t shown = std::min(all.size(), k_most_growth);
    for (const char* key : {"samples", "value", "low", "high"}) one[key] = Json::array();
    for (std::size_t k = 0; k < shown; ++k) {
      const Finding& f = *all[shown == 1 ? all.size() - 1 : k * (all.size() - 1) / (shown - 1)];
      one["samples"].push_back(f.samples);
      one["value"].push_back(f.value);
      one["low"].push_back(f.low);
      one["high"].push_back(f.high);
    }
    json.push_back(std::move(one));
  }
  return json;
}

// Returns the reasons of failed runs with their counts. Reasons that differ in numbers only are counted together.
Json reasons_json(Store& store) {
  struct Group {
    Store::Reason first;
    long kinds = 0, samples = 0;
  };
  std::vector<Group> groups;
  std::map<std::string, std::size_t> places;
  long failed = 0;
  for (const Store::Reason& r : store.reasons()) {
    if (r.status == name_of(SampleStatus::ok)) continue;
    failed += r.count;
    std::string key = r.status + " ";
    for (const char c : r.reason)
      if (std::string_view("0123456789.+-e").find(c) == std::string_view::npos) key += c;
    const auto [place, is_new] = places.try_emplace(key, groups.size());
    if (is_new) groups.push_back({r, 0, 0});
    Group& group = groups[place->second];
    ++group.kinds;
    group.samples += r.count;
    if (r.first < group.first.first) group.first = r;
  }
  Json list = Json::array();
  long more = 0;
  for (const Group& g : groups) {
    if (list.size() >= k_most_reasons) more += g.samples;
    else
      list.push_back(
          {{"status", g.first.status}, {"reason", g.first.reason}, {"alike", g.kinds - 1}, {"count", g.samples}, {"first", g.first.first}});
  }
  return {{"failed", failed},
          {"list", std::move(list)},
          {"more", groups.size() > k_most_reasons ? groups.size() - k_most_reasons : 0},
          {"more_runs", more}};
}

// Returns measured records with the fitted values, if the store has any.
template <class AnyStore> Json histories_json(AnyStore& store) {
  Json json = Json::array();
  if constexpr (requires { store.histories(); }) {
    std::vector<std::string> names;
    std::map<std::string, std::vector<std::size_t>> of;
    const auto points = store.histories();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (of[points[i].history].empty()) names.push_back(points[i].history);
      of[points[i].history].push_back(i);
    }
    for (const std::string& name : names) {
      const std::vector<std::size_t>& all = of[name];
      Json one{{"name", name}, {"all", all.size()}, {"t", Json::array()}, {"measured", Json::array()}, {"fitted", Json::array()}};
      for (std::size_t k = 0, shown = std::min(all.size(), k_most_times); k < shown; ++k) {
        const auto& p = points[all[k * all.size() / shown]];
        one["t"].push_back(p.t);
        one["measured"].push_back(p.measured);
        one["fitted"].push_back(p.fitted);
      }
      json.push_back(std::move(one));
    }
  }
  return json;
}

std::string shortened(const std::string& text) {
  return text.size() <= k_most_text ? text : text.substr(0, k_most_text) + "\n# … the rest is in the store\n";
}

// Escapes '<', which would end the script element. It occurs within JSON strings only.
std::string for_script(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json)
    if (c == '<') safe += "\\u003c";
    else safe += c;
  return safe;
}

Json about_in(Store& store) {
  Json about = Json::parse(store.setting("about"), nullptr, false);
  if (!about.is_object()) about = Json::object();
  for (const char* key : {"variables", "numbers", "models", "variants", "histories"})
    if (!about.contains(key)) about[key] = Json::array();
  if (!about.contains("settings") || !about["settings"].is_object()) about["settings"] = Json::object();
  return about;
}

Json status_names() {
  Json names = Json::array();
  for (int i = 0; i <= static_cast<int>(SampleStatus::undecided); ++i) names.push_back(name_of(static_cast<SampleStatus>(i)));
  return names;
}

} // namespace

// Selects at most `most` samples: up to a third of each class. Places that a class does not use go to the others, first to the rarest.
std::vector<std::size_t> chosen_samples(const std::vector<char>& classes, std::size_t most) {
  std::vector<std::size_t> of[3], chosen;
  for (std::size_t i = 0; i < classes.size(); ++i) of[static_cast<std::size_t>(classes[i])].push_back(i);
  std::size_t left = most;
  std::size_t share[3] = {0, 0, 0};
  for (const std::size_t c : {2U, 1U, 0U}) {
    share[c] = std::min(of[c].size(), c == 0 ? left : most / 3);
    left -= share[c];
  }
  for (const std::size_t c : {1U, 2U}) {
    const std::size_t more = std::min(left, of[c].size() - share[c]);
    share[c] += more;
    left -= more;
  }
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < share[c]; ++k) chosen.push_back(of[c][k * of[c].size() / share[c]]);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::string report_data(Store& store, const std::string& store_path, std::size_t budget) {
  store.hold();
  const Json about = about_in(store);
  const StoreIdentity& identity = store.identity();
  const Samples samples = read_samples(store, about);
  const StudyKind* kind = find_kind(identity.kind); // nullptr for a kind of another version
  const Drawn drawn = kind && kind->drawn ? kind->drawn(shown_settings(about["settings"])) : Drawn::otherwise;
  const bool is_random_sample = kind && kind->shows_running_means && drawn == Drawn::independently;
  Json json{{"program", std::string("steplap ") + k_version},
            {"version", identity.version},
            {"kind", identity.kind},
            {"standing", store.setting("standing")},
            {"store", store_path},
            {"about", about},
            {"statuses", status_names()}};
  json["samples"] = samples_json(samples, classes_of(samples), budget);
  json["reasons"] = reasons_json(store);
  json["distributions"] = distributions_json(samples, drawn);
  json["running"] = is_random_sample ? running_estimates(samples, about.value("failed", "bounds")) : Json::array();
  json["findings"] = findings_json(store.findings(), named_columns(samples, about));
  json["growth"] = growth_json(store.growth());
  json["histories"] = histories_json(store);
  json["notes"] = store.notes();
  json["study_text"] = shortened(identity.study);
  json["scene_text"] = shortened(identity.scene);
  return for_script(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

} // namespace steplap::study
