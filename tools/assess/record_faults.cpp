#include "tools/assess/record_faults.h"

#include "mbd/base/shown_text.h"
#include "transformer/recorder/fields.h"

#include <algorithm>
#include <cmath>

namespace steplap::assess {

namespace {

constexpr double k_felt = 0.5;         // of the threshold: what rests there is quiet, not clipped
constexpr double k_slowest = 100.0;    // Hz: at 50 Hz the needed pressure of a joint is up to 22 % wrong (docs/evidence/recorders.md)
constexpr double k_gravity_seen = 0.7; // g that the record reads at rest, at least, where it has gravity in it
constexpr std::size_t k_many = 100;    // rows: fewer may be alike by chance where steps are coarse

bool is_flat(const AxisFacts& axis, double threshold) {
  return axis.flat_longest >= 3 && std::abs(axis.flat_value - axis.rest) > k_felt * threshold;
}

// Recorders tell in a last line why they stopped. A full memory or an empty battery is no arrival.
bool ended_early(const std::string& comment) {
  const std::string words = lower_case(comment);
  for (const char* sign :
       {"batt", "vbat", "low power", "power low", "power fail", "power lost", "brown", "memory full", "card full", "disk full",
        "out of memory", "full memory", "error", "watchdog", "abort", "\\x"}) // the last: bytes that are no text
    if (words.find(sign) != std::string::npos) return true;
  return false;
}

double size_at_rest(const Recording& recording) {
  double sum = 0.0;
  for (std::size_t i = 0; i < recording.layout.axes.size(); ++i) sum += recording.facts.axes[i].rest * recording.facts.axes[i].rest;
  return std::sqrt(sum);
}

std::string dead_axes(const Recording& recording) {
  std::string names;
  for (std::size_t i = 0; i < recording.layout.axes.size(); ++i)
    if (recording.facts.axes[i].least == recording.facts.axes[i].greatest)
      names += (names.empty() ? "" : ", ") + std::string(1, recording.layout.axes[i].axis);
  return names;
}

} // namespace

void find_faults(RecordEvents& record) {
  const Recording& recording = record.recording;
  const ReadFacts& facts = recording.facts;
  const auto found = [&](RecordFault fault, bool is_so) {
    if (is_so) record.faults.push_back(fault);
  };
  // What stays where it rests is quiet, not clipped, as where a signal without noise begins at once.
  const auto is_clipped = [&](const AxisFacts& axis) {
    return axis.beyond_range.count > 0 || (is_flat(axis, record.rules.threshold) && !recording.layout.holds);
  };
  found(RecordFault::peaks_only, recording.layout.is_peaks);
  found(RecordFault::clipped, std::any_of(facts.axes.begin(), facts.axes.end(), is_clipped));
  found(RecordFault::gaps, facts.gaps.count > 0 || facts.missing.count > 0 || facts.backward.count > 0);
  found(RecordFault::cut, facts.cut_line > 0 || ended_early(facts.last_comment));
  if (recording.layout.is_peaks) return;
  found(RecordFault::fall, record.fall.longest() >= FallWatch::k_least && size_at_rest(recording) > k_gravity_seen * k_gravity);
  found(RecordFault::dead, !recording.layout.holds && facts.rows >= k_many && !dead_axes(recording).empty());
  found(RecordFault::slow, recording.layout.time.rate < k_slowest * (1.0 - 0.02)); // clocks of recorders are that wrong
}

const char* name_of(RecordFault fault) {
  static constexpr const char* k_names[] = {"clipped", "gaps", "peaks", "cut", "fall", "dead", "slow"};
  return k_names[static_cast<int>(fault)];
}

std::vector<std::string> RecordEvents::warnings() const {
  const auto text_of = [&](RecordFault fault) -> std::string {
    switch (fault) {
    case RecordFault::clipped: return "The record is clipped: its peaks were higher than what the models are driven by.";
    case RecordFault::gaps: return "The record has gaps: what happened in them is not known.";
    case RecordFault::peaks_only:
      return std::string("The record holds peaks and no waveform: ") +
             (pulse ? "models are driven by pulses that are assumed." : "no model can be driven by it.");
    case RecordFault::cut:
      return recording.facts.cut_line > 0 ? "The last line of the record is cut: what came after it is not known."
                                          : "The record ends with '" + recording.facts.last_comment + "': what came after it is not known.";
    case RecordFault::fall:
      return "The recorder read less than 0.3 g, gravity included, for " + rounded_text(fall.longest(), 3) + " s from " +
             rounded_text(fall.at(), 7) + " s on, as if it fell.";
    case RecordFault::dead: return "Axis " + dead_axes(recording) + " reads the same from the first row to the last: it did not measure.";
    case RecordFault::slow: break;
    }
    return "The record has " + rounded_text(recording.layout.time.rate, 3) +
           " Hz: below 100 Hz the pressure that joints need comes out too low.";
  };
  std::vector<std::string> texts;
  for (const RecordFault fault : faults) texts.push_back(text_of(fault));
  return texts;
}

} // namespace steplap::assess
