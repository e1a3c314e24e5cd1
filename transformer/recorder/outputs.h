// Writes the results for a record: the conditioned signal as CSV for `record` signals, events and spectra as CSV, and a summary of all
// results as JSON.
#pragma once

#include "transformer/recorder/events.h"
#include "transformer/recorder/shock_spectrum.h"

#include "mbd/io/csv.h"

#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// A file written piece by piece under a temporary name. commit() renames it; without commit() it is removed.
class PartFile {
public:
  /// Opens the temporary file. Throws FileError if `path` exists and must not be replaced, or cannot be written.
  PartFile(std::string path, bool is_overwriting);
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  ~PartFile();
  void put(const std::string& text);
  void commit();

private:
  [[noreturn]] void fail(const char* what) const;
  std::string path_, temporary_;
  std::FILE* file_ = nullptr;
};

/// Writes the conditioned signal while it arrives: signal.csv, or for several segments one file each, signal_001.csv, signal_002.csv …,
/// because a `record` signal would interpolate across a gap. No file appears before commit().
class SignalWriter : public SignalSink {
public:
  SignalWriter(std::string folder, bool is_overwriting) : folder_(std::move(folder)), is_overwriting_(is_overwriting) {}

  void begin(const RecordLayout& layout, double rate) override;
  void begin_segment(std::size_t line) override;
  void put(double t, const double* plain, const double* filtered) override;
  void end_segment() override;
  /// Renames the files to their final names and returns these names.
  std::vector<std::string> commit();

private:
  [[nodiscard]] std::string path(std::size_t segment) const;
  void write_out();
  std::string folder_;
  bool is_overwriting_ = false;
  std::vector<std::string> names_;
  std::unique_ptr<CsvText> text_;
  std::unique_ptr<PartFile> first_, now_;
  std::vector<std::string> written_;
  std::vector<double> row_;
  std::size_t rows_ = 0, segments_ = 0;
};

/// Drift correction of a window.
enum class DriftCorrection { none, line };
/// Returns the filtered signal of a window as CSV, with times from 0. `line` subtracts a constant acceleration so that the velocity at the
/// end equals that at the begin.
[[nodiscard]] std::string window_csv(const Window& window, const RecordLayout& layout, DriftCorrection correction);

/// An event with its shock response spectra, one for each axis.
struct EventResult {
  ShockEvent event;
  std::vector<std::vector<ShockPoint>> spectra;
};
/// All results for a record.
struct RecordResult {
  Recording recording;
  Conditioning conditioning;
  EventRules rules;
  double rate = 0.0, bandwidth = 0.0; ///< sampling rate and bandwidth of the conditioned signal, Hz
  std::size_t interpolated = 0;
  Drift drift;
  std::vector<EventResult> events;
};
/// Returns CSV text with one row for each event and axis.
[[nodiscard]] std::string record_events_csv(const RecordResult& result);
/// Returns CSV text with one row for each frequency of each event.
[[nodiscard]] std::string spectra_csv(const RecordResult& result);
/// Returns all results as JSON text.
[[nodiscard]] std::string record_json(const RecordResult& result);

} // namespace steplap
