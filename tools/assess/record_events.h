// Reads the file of a shock recorder and extracts its shocks as motions for models: filtered windows without gravity, and a list of missing
// evidence.
#pragma once

#include "tools/assess/evidence.h"
#include "tools/assess/fall_watch.h"
#include "transformer/recorder/events.h"
#include "transformer/recorder/read_options.h"
#include "transformer/recorder/reader.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// Shape of an assumed pulse.
enum class PulseShape { half_sine, haversine, triangle };

/// Pulse assumed for shocks of which only the peak is known.
struct AssumedPulse {
  PulseShape shape = PulseShape::half_sine;
  std::optional<double> duration; ///< duration, s, for entries that give neither duration nor velocity change
  std::optional<char> axis;       ///< "x", "y" or "z", for peaks without a direction
};

/// How a file is read and searched for shocks.
struct EventReading {
  ReadOptions read;
  EventRules rules;
  std::optional<double> frequency_class;     ///< class of the channel filter: frequency in Hz (CFC)
  std::optional<double> rate;                ///< sampling rate of the conditioned signal, Hz; empty: that of the record
  std::optional<std::string> gravity;        ///< axis from which gravity is subtracted, "z", "-z", …; "none": it is not subtracted
  std::optional<std::array<double, 2>> rest; ///< s; the mean over this interval is subtracted
  std::optional<AssumedPulse> pulse;         ///< pulse for lists of peaks; without it such a list drives no model
};

/// A shock with the samples of its window.
struct RecordedEvent {
  ShockEvent event;
  Window window;
  bool is_below = false; ///< true if the shock stays below the requested threshold
};

/// Contents of a recorder's file.
struct RecordEvents {
  std::string file, sha256;
  Recording recording;
  EventRules rules;
  std::array<double, 3> offset{};     ///< values subtracted from the axes, m/s²
  double rate = 0.0, bandwidth = 0.0; ///< Hz, of the conditioned signal
  bool is_filtered = false;
  FallWatch fall;
  std::vector<RecordedEvent> events; ///< shocks found, in order of time
  std::array<double, 3> rest{};      ///< reading at rest of each axis, m/s²: mean over the interval of --rest, otherwise median of the
                                     ///< first second
  std::array<double, 3> greatest{};  ///< largest magnitude of each axis, filtered, m/s²
  std::array<double, 3> sustained{}; ///< largest magnitude of each axis in the mean over about 0.2 s, m/s²
  std::vector<MissingEvidence> missing;
  std::optional<std::int64_t> clock_ns; ///< ns since 1970 at time 0 of the record; none if unknown
  bool clock_has_zone = false;
  std::optional<AssumedPulse> pulse; ///< assumed pulse, for lists of peaks that drive models
  std::vector<std::string> assumed;  ///< assumptions about the pulses, as sentences

  /// Returns the letters of the recorded axes, in the order of the event data.
  [[nodiscard]] std::string axes() const;

  /// Returns the index of an axis in the event data; nothing if it was not recorded.
  [[nodiscard]] std::optional<std::size_t> axis(char letter) const;
  /// Returns the magnitude of the vector of readings at rest, m/s².
  [[nodiscard]] double size_at_rest() const;
};

/// Reads a file without searching its waveform for events. Throws RecordError or FileError if the file cannot be read or lacks data, if the
/// reading at rest exceeds the threshold, or if a list of peaks lacks data for pulses.
[[nodiscard]] RecordEvents read_without_events(const std::string& file, const EventReading& reading);
/// Reads a waveform file again and fills its events according to `rules`. Returns false, without events, if their total duration would
/// exceed `longest_total`, s.
[[nodiscard]] bool find_events(const EventReading& reading, const EventRules& rules, double longest_total, RecordEvents& record);
/// Reads a file and its events, with the rules in `reading`.
[[nodiscard]] RecordEvents read_events(const std::string& file, const EventReading& reading);

/// Sorts records by their clocks, or leaves the given order if one has none. Throws FileError if two records overlap. `note` receives a
/// sentence about the order; "" for a single record. `is_known` becomes false if the clocks are not comparable.
void order_records(std::vector<RecordEvents>& records, std::string& note, bool& is_known);

} // namespace steplap::assess
