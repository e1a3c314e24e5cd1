// What a record leaves behind: the cleaned signal as CSV that a `record` signal reads, events and spectra as CSV, all together as JSON.
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

/// A file written piece by piece under a temporary name, which becomes its own when all is there. Without commit() nothing stays.
class PartFile {
public:
  /// Throws FileError: it exists and may not be replaced, or cannot be written.
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

/// Writes the conditioned signal while it comes: signal.csv, or signal_001.csv, signal_002.csv … from the second segment on, because a
/// `record` signal would draw a straight line across a gap. Nothing is there before commit().
class SignalWriter : public SignalSink {
public:
  SignalWriter(std::string folder, bool is_overwriting) : folder_(std::move(folder)), is_overwriting_(is_overwriting) {}

  void begin(const RecordLayout& layout, double rate) override;
  void begin_segment(std::size_t line) override;
  void put(double t, const double* plain, const double* filtered) override;
  void end_segment() override;
  /// Gives the files their names, which it returns.
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

/// How a window's drift is corrected.
enum class DriftCorrection { none, line };
/// The filtered signal of a window, times from 0. `line`: less a constant acceleration, so that velocity ends where it began.
[[nodiscard]] std::string window_csv(const Window& window, const RecordLayout& layout, DriftCorrection correction);

/// An event with its shock response spectra, one for each axis.
struct EventResult {
  ShockEvent event;
  std::vector<std::vector<ShockPoint>> spectra;
};
/// All that was found.
struct RecordResult {
  Recording recording;
  Conditioning conditioning;
  EventRules rules;
  double rate = 0.0, bandwidth = 0.0; ///< Hz, of the conditioned signal
  std::size_t interpolated = 0;
  Drift drift;
  std::vector<EventResult> events;
};
/// One row for each event and axis.
[[nodiscard]] std::string record_events_csv(const RecordResult& result);
/// One row for each frequency of each event.
[[nodiscard]] std::string spectra_csv(const RecordResult& result);
[[nodiscard]] std::string record_json(const RecordResult& result);

} // namespace steplap
