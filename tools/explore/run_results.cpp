#include "tools/explore/run_results.h"

#include "mbd/run/drawing.h"
#include "mbd/run/result_files.h"

namespace steplap {

Results results_of(const Report& report, SummaryText summary) {
  const RunResult& result = report.run.result;
  const Trajectory& trajectory = *result.trajectory;
  Results results;
  results.name = report.run.loaded->name;
  results.folder = results.name;
  results.is_partial = report.run.failure.has_value();
  const std::size_t rows = trajectory.size();
  results.times.resize(rows);
  for (std::size_t i = 0; i < rows; ++i) results.times[i] = trajectory.time(i);
  results.channels.resize(trajectory.channels().size());
  for (std::size_t c = 0; c < results.channels.size(); ++c) {
    ResultChannel& channel = results.channels[c];
    channel.name = trajectory.channels()[c]->name;
    channel.unit = trajectory.channels()[c]->unit;
    channel.values.resize(rows);
    for (std::size_t i = 0; i < rows; ++i) channel.values[i] = trajectory.value(i, c);
  }
  for (std::size_t i = 0; i < result.events.size(); ++i) {
    const Event& event = result.events[i];
    results.events.push_back({event.t, event.element, event.words(), event.kind, report.event_error(i)});
  }
  results.model = model_file_text(*report.run.loaded);
  results.drawing = drawing_json(report.run.loaded->model, *report.run.loaded->views);
  if (summary == SummaryText::made) results.summary = report.json();
  return results;
}

} // namespace steplap
