#include "tools/steplap/shown_run.h"

#include "mbd/io/atomic_file.h"
#include "mbd/run/summary.h"
#include "tools/steplap/json_screen.h"

#include <cmath>

namespace steplap {

namespace {

std::vector<ResultEvent> events_of(const Report& report) {
  std::vector<ResultEvent> shown;
  const std::vector<Event>& events = report.run.result.events;
  shown.reserve(events.size());
  for (std::size_t i = 0; i < events.size(); ++i)
    shown.push_back({events[i].t, events[i].element, events[i].words(), events[i].kind, report.event_error(i)});
  return shown;
}

} // namespace

ShownRun overview_of_run(const Report& report, const std::string& folder, ShownDigits digits) {
  return {summary_head(report, digits), {}, folder, {}};
}

ShownRun shown_run(const Report& report, const std::string& folder) {
  const RunResult& result = report.run.result;
  return {summary_document(report), events_of(report), folder,
          RunCost{result.statistics.cpu_seconds, report.estimate.cost, result.trajectory->size(), result.trajectory->channels().size()}};
}

bool put_runs(std::ostream& out, const std::vector<ShownRun>& runs) {
  JsonScreen* const screen = json_screen(out);
  if (!screen) return false;
  for (const ShownRun& run : runs) {
    screen->begin(About{run.summary.at("model").at("name").get<std::string>()});
    screen->put("folder", run.folder);
    OrderedJson events = OrderedJson::array();
    for (const ResultEvent& event : run.events) {
      OrderedJson entry = OrderedJson::object();
      entry["t"] = event.t;
      entry["element"] = event.element;
      entry["event"] = event.words;
      if (event.error) entry["error_t"] = std::isfinite(*event.error) ? OrderedJson(*event.error) : OrderedJson();
      events.push_back(std::move(entry));
    }
    screen->put("events", std::move(events));
    screen->put("summary", run.summary);
  }
  return true;
}

ShownRun shown_run(const std::string& folder) {
  Results results = read_results(folder, Reading::without_rows);
  ShownRun run{parse_ordered(results.summary), std::move(results.events), folder, {}};
  if (!run.summary.contains("error_estimate")) // written by an earlier version
    throw FileError(folder, "'" + folder +
                                "' was written by another version of steplap, whose results cannot be shown: run the model again, or make "
                                "its page with steplap report");
  return run;
}

} // namespace steplap
