// Shocks of a recorder's file, ready to drive a model: conditioned windows with gravity taken away once, and what the record cannot say.
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

enum class PulseShape { half_sine, haversine, triangle };

/// What a shock is taken for of which only the peak is known.
struct AssumedPulse {
  PulseShape shape = PulseShape::half_sine;
  std::optional<double> duration; ///< s, of entries that tell neither it nor a change of velocity
  std::optional<char> axis;       ///< "x", "y" or "z", of peaks without a direction
};

/// How a file is read and searched for shocks.
struct EventReading {
  ReadOptions read;
  EventRules rules;
  std::optional<double> frequency_class;     ///< Hz
  std::optional<double> rate;                ///< Hz of the conditioned signal; none: that of the record
  std::optional<std::string> gravity;        ///< "z", "-z", …: axis that it is subtracted from; "none": it stays
  std::optional<std::array<double, 2>> rest; ///< s: the mean of this stretch is subtracted
  std::optional<AssumedPulse> pulse;         ///< of lists of peaks; none: no model is driven by them
};

/// A shock with its samples.
struct RecordedEvent {
  ShockEvent event;
  Window window;
  bool is_below = false; ///< it stays below the threshold that was asked for
};

/// A file, read.
struct RecordEvents {
  std::string file, sha256;
  Recording recording;
  EventRules rules;
  std::array<double, 3> offset{};     ///< m/s², subtracted from the axes
  double rate = 0.0, bandwidth = 0.0; ///< Hz, of the conditioned signal
  bool is_filtered = false;
  FallWatch fall;
  std::vector<RecordedEvent> events; ///< in order of time
  std::array<double, 3> rest{};      ///< m/s², of each axis: the mean over the stretch of --rest, else the median of the first second
  std::array<double, 3> greatest{};  ///< m/s² without sign, of each axis, filtered
  std::vector<MissingEvidence> missing;
  std::optional<std::int64_t> clock_ns; ///< since 1970, of the time 0 of the record; none: it does not tell
  bool clock_has_zone = false;
  std::optional<AssumedPulse> pulse; ///< of a list of peaks that models are driven by
  std::vector<std::string> assumed;  ///< of such a list, in whole sentences

  /// Letters of the axes that its events have.
  [[nodiscard]] std::string axes() const;

  /// Index of an axis in its events; nothing if the record has none of that letter.
  [[nodiscard]] std::optional<std::size_t> axis(char letter) const;
  /// m/s², all axes together.
  [[nodiscard]] double size_at_rest() const;
};

/// All but events of waveforms. Throws RecordError and FileError for what cannot be read or known, and if what an axis reads at rest would
/// count as a shock, or a list of peaks leaves open what a pulse of it needs.
[[nodiscard]] RecordEvents read_without_events(const std::string& file, const EventReading& reading);
/// Reads the file of a record with waveforms again and fills its events by these rules. False: they would be longer than `longest`, s, in
/// all, and there are none.
[[nodiscard]] bool find_events(const EventReading& reading, const EventRules& rules, double longest, RecordEvents& record);
/// Both, with the rules of the reading.
[[nodiscard]] RecordEvents read_events(const std::string& file, const EventReading& reading);

/// In order of time: by their clocks where all have one, else as given. Throws FileError if two of them overlap in time. `note`
/// becomes a sentence that says by what they were ordered; "" of a single one. `is_known` becomes false if their clocks cannot be compared.
void order_records(std::vector<RecordEvents>& records, std::string& note, bool& is_known);

} // namespace steplap::assess
