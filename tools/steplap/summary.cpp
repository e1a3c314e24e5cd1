#include "tools/steplap/summary.h"

#include <cmath>

namespace steplap {

namespace {

// "front foot.force" -> "force"
std::string last_part(const std::string& channel) {
  return channel.substr(channel.rfind('.') + 1);
}

} // namespace

const ChannelRange* RunSummary::find(const std::string& channel) const {
  for (const ChannelRange& range : ranges)
    if (range.channel->name == channel) return &range;
  return nullptr;
}

// Ranges are of all channels, in their order.
std::optional<double> RunSummary::error_of(const ChannelRange& range, double ChannelError::*which) const {
  if (!global_error) return {};
  return global_error->channels[static_cast<std::size_t>(&range - ranges.data())].*which;
}

std::optional<double> RunSummary::event_error(std::size_t i) const {
  return global_error ? std::optional(global_error->event_times[i]) : std::nullopt;
}

std::optional<double> RunSummary::dissipated_error() const {
  return global_error ? std::optional(global_error->dissipated) : std::nullopt;
}

std::optional<double> RunSummary::work_error() const {
  return global_error ? std::optional(global_error->work) : std::nullopt;
}

RunSummary summarise(const Run& run) {
  RunSummary summary;
  summary.ranges = run.result.ranges;
  for (const Event& event : run.result.events)
    ++summary.event_counts[words_of(event.kind)];
  const RunStatistics& s = run.result.statistics;
  if (s.energy_exchanged > 0.0)
    summary.relative_energy_residual = s.energy_residual / s.energy_exchanged;
  summary.judgement = judge(run.loaded->model, *run.loaded->system, run.result, run.failure);
  return summary;
}

bool is_reaction(const Channel& channel) {
  const bool is_load = channel.unit == "N" || channel.unit == "N m" || channel.unit == "Pa";
  return is_load && last_part(channel.name) != "capacity";
}

bool is_slide(const Channel& channel) {
  const std::string part = last_part(channel.name);
  return part == "slide" || part.rfind("slide_", 0) == 0;
}

bool is_main_event(const Event& event) {
  return is_main(event.kind);
}

} // namespace steplap
