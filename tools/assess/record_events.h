// Reads a shock recorder's file and extracts its shocks as drive data: filtered windows without gravity, and a list of missing evidence.
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

/// Assumed shape of shocks of which only the peak is known.
struct AssumedPulse {
  PulseShape shape = PulseShape::half_sine;
  std::optional<double> duration; ///< duration, s, for entries that give neither duration nor velocity change
  std::optional<char> axis;       ///< "x", "y" or "z", for peaks without a direction
};

/// How a file is read and searched for shocks.
struct EventReading {
  ReadOptions read;
  EventRules rules;
  std::optional<double> frequency_class;     ///< Hz
  std::optional<double> rate;                ///< sampling rate of the conditioned signal, Hz; none: that of the record
  std::optional<std::string> gravity;        ///< axis from which gravity is subtracted, "z", "-z", …; "none": it is not subtracted
  std::optional<std::array<double, 2>> rest; ///< s; the mean over this interval is subtracted
  std::optional<AssumedPulse> pulse;         ///< for lists of peaks; none: they drive no model
};

/// A shock with its samples.
struct RecordedEvent {
  ShockEvent event;
  Window window;
  bool is_below = false; ///< true if it stays below the requested threshold
};

/// Contents of a recorder's file.
struct RecordEvents {
  std::string file, sha256;
  Recording recording;
  EventRules rules;
  std::array<double, 3> offset{};     ///< subtracted from the axes, m/s²
  double rate = 0.0, bandwidth = 0.0; ///< Hz, of the conditioned signal
  bool is_filtered = false;
  FallWatch fall;
  std::vector<RecordedEvent> events; ///< in order of time
  std::array<double, 3> rest{};      ///< reading at rest of each axis, m/s²: mean over the interval of --rest, otherwise median of the
                                     ///< first second
  std::array<double, 3> greatest{};  ///< largest magnitude of each axis, filtered, m/s²
  std::vector<MissingEvidence> missing;
  std::optional<std::int64_t> clock_ns; ///< ns since 1970 at time 0 of the record; none if unknown
  bool clock_has_zone = false;
  std::optional<AssumedPulse> pulse; ///< for lists of peaks that drive models
  std::vector<std::string> assumed;  ///< assumptions made for such a list, as sentences

  /// Returns the letters of the axes of its events.
  [[nodiscard]] std::string axes() const;

  /// Returns the index of an axis in its events; nothing if the record lacks it.
  [[nodiscard]] std::optional<std::size_t> axis(char letter) const;
  /// Returns the magnitude of the reading at rest over all axes, m/s².
  [[nodiscard]] double size_at_rest() const;
};

/// Reads a file without searching its waveform for events. Throws RecordError or FileError if it cannot be read or data is missing, if the
/// reading at rest alone would exceed the threshold, or if a list of peaks lacks data for pulses.
[[nodiscard]] RecordEvents read_without_events(const std::string& file, const EventReading& reading);
/// Reads a waveform file again and fills its events according to `rules`. Returns false, without events, if their total duration would
/// exceed `longest`, s.
[[nodiscard]] bool find_events(const EventReading& reading, const EventRules& rules, double longest, RecordEvents& record);
/// Reads a file and its events, with the rules in `reading`.
[[nodiscard]] RecordEvents read_events(const std::string& file, const EventReading& reading);

/// Sorts records by time: by their clocks if all have one, otherwise in the given order. Throws FileError if two of them overlap. `note`
/// receives a sentence about the criterion; "" for a single record. `is_known` becomes false if the clocks cannot be compared.
void order_records(std::vector<RecordEvents>& records, std::string& note, bool& is_known);

} // namespace steplap::assess
