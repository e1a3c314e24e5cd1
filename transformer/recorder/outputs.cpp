#include "transformer/recorder/outputs.h"

#include "mbd/base/number_text.h"

#include <nlohmann/json.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>

namespace steplap {

PartFile::PartFile(std::string path, bool is_overwriting)
    : path_(std::move(path)), temporary_(path_ + ".partial-" + std::to_string(::getpid())) {
  struct ::stat status {};
  if (!is_overwriting && ::stat(path_.c_str(), &status) == 0)
    throw FileError(path_, "'" + path_ + "' exists. Choose another folder with -o, or give --force to overwrite it.");
  file_ = std::fopen(temporary_.c_str(), "wbe");
  if (!file_) fail("cannot be written");
}

PartFile::~PartFile() {
  if (!file_) return;
  std::fclose(file_);
  std::remove(temporary_.c_str());
}

void PartFile::fail(const char* what) const { throw FileError(path_, "'" + path_ + "' " + what + ": " + std::strerror(errno)); }

void PartFile::put(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail("cannot be written");
}

void PartFile::commit() {
  if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail("cannot be written");
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot be written");
  std::fclose(file_);
  file_ = nullptr;
}

namespace {

std::vector<std::string> signal_names(const RecordLayout& layout) {
  std::vector<std::string> names{"time [s]"};
  for (const AxisColumn& axis : layout.axes) names.push_back(std::string(1, axis.axis) + " [m/s^2]");
  return names;
}

} // namespace

void SignalWriter::begin(const RecordLayout& layout, double) {
  names_ = signal_names(layout);
  row_.resize(names_.size());
}

std::string SignalWriter::path(std::size_t segment) const {
  std::string number = std::to_string(segment);
  number.insert(0, number.size() < 3 ? 3 - number.size() : 0, '0');
  return folder_ + "/signal_" + number + ".csv";
}

void SignalWriter::begin_segment(std::size_t) {
  ++segments_;
  text_ = std::make_unique<CsvText>(names_);
  rows_ = 0;
  if (segments_ == 1) { // file names are assigned only here, because a single segment is called signal.csv
    first_ = std::make_unique<PartFile>(folder_ + "/signal.csv", is_overwriting_);
  } else {
    now_ = std::make_unique<PartFile>(path(segments_), is_overwriting_);
  }
}

void SignalWriter::write_out() {
  (segments_ == 1 ? *first_ : *now_).put(text_->text());
  text_->clear();
}

void SignalWriter::put(double t, const double*, const double* filtered) {
  row_[0] = t;
  std::copy(filtered, filtered + row_.size() - 1, row_.begin() + 1);
  text_->add_row(row_);
  if (++rows_ % 16384 == 0) write_out();
}

void SignalWriter::end_segment() {
  write_out();
  if (segments_ == 1) return;
  now_->commit();
  now_.reset();
  written_.push_back(path(segments_));
}

std::vector<std::string> SignalWriter::commit() {
  if (!first_) return {};
  first_->commit();
  first_.reset();
  std::string name = folder_ + "/signal.csv";
  if (segments_ > 1) {
    if (std::rename(name.c_str(), path(1).c_str()) != 0)
      throw FileError(path(1), "'" + path(1) + "' cannot be written: " + std::strerror(errno));
    name = path(1);
  }
  written_.insert(written_.begin(), name);
  return written_;
}

std::string window_csv(const Window& window, const RecordLayout& layout, DriftCorrection correction) {
  const std::size_t axes = layout.axes.size(), size = window.times.size();
  CsvText text(signal_names(layout), size);
  std::array<double, 3> mean{};
  for (std::size_t i = 0; i < axes && correction == DriftCorrection::line && size > 1; ++i) {
    double velocity = 0.0; // velocity in units of acceleration times sampling interval
    for (std::size_t k = 1; k < size; ++k) velocity += 0.5 * (window.filtered[i][k - 1] + window.filtered[i][k]);
    mean[i] = velocity / static_cast<double>(size - 1);
  }
  std::vector<double> row(axes + 1);
  for (std::size_t k = 0; k < size; ++k) {
    row[0] = window.times[k] - window.times.front();
    for (std::size_t i = 0; i < axes; ++i) row[i + 1] = window.filtered[i][k] - mean[i];
    text.add_row(row);
  }
  return std::move(text).text();
}

namespace {

std::string number_or_nothing(double value) { return std::isnan(value) ? "" : number_text(value); }

nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json axis_json(const RecordResult& result, std::size_t i) {
  const AxisColumn& axis = result.recording.layout.axes[i];
  const AxisFacts& facts = result.recording.facts.axes[i];
  return {{"axis", std::string(1, axis.axis)},
          {"column", axis.column + 1},
          {"heading", axis.heading},
          {"unit", axis.unit},
          {"unit_by", axis.unit_source},
          {"factor", axis.factor},
          {"least", json_number(facts.least)},
          {"greatest", json_number(facts.greatest)},
          {"first_second", facts.rest},
          {"subtracted", result.conditioning.offset[i]},
          {"flat_samples", facts.flat_longest},
          {"samples_beyond_range", facts.beyond_range.count},
          {"velocity_at_end", result.drift.velocity[i]},
          {"displacement_at_end", result.drift.displacement[i]}};
}

nlohmann::ordered_json event_json(const EventResult& found, const RecordLayout& layout) {
  const ShockEvent& event = found.event;
  nlohmann::ordered_json json{{"event", event.number}, {"segment", event.segment}, {"segment_line", event.line},
                              {"begin", event.begin},  {"end", event.end},         {"goes_on", event.goes_on}};
  for (std::size_t i = 0; i < event.axes.size(); ++i) {
    const AxisEvent& axis = event.axes[i];
    nlohmann::ordered_json entry{{"axis", std::string(1, layout.axes[i].axis)},
                                 {"peak", axis.peak},
                                 {"peak_time", axis.peak_time},
                                 {"duration", axis.duration},
                                 {"velocity_change", axis.velocity_change},
                                 {"frequency", axis.frequency},
                                 {"peak_cfc60", json_number(axis.at_cfc60)},
                                 {"peak_cfc10", json_number(axis.at_cfc10)}};
    json["axes"].push_back(std::move(entry));
  }
  return json;
}

} // namespace

std::string record_events_csv(const RecordResult& result) {
  const RecordLayout& layout = result.recording.layout;
  if (layout.is_peaks) {
    std::string text = "entry,line,time [s],x peak [m/s^2],y peak [m/s^2],z peak [m/s^2],peak [m/s^2],duration [s],velocity change [m/s]\n";
    std::size_t number = 0;
    for (const PeakEntry& entry : result.recording.peaks) {
      text += std::to_string(++number) + "," + std::to_string(entry.line);
      for (const double value :
           {entry.t, entry.axis[0], entry.axis[1], entry.axis[2], entry.magnitude, entry.duration, entry.velocity_change})
        text += "," + number_or_nothing(value);
      text += "\n";
    }
    return text;
  }
  std::string text = "event,axis,segment,begin [s],end [s],peak time [s],peak [m/s^2],bandwidth [Hz],duration [s],velocity change "
                     "[m/s],frequency [Hz],peak CFC 60 [m/s^2],peak CFC 10 [m/s^2]\n";
  for (const EventResult& found : result.events)
    for (std::size_t i = 0; i < found.event.axes.size(); ++i) {
      const AxisEvent& axis = found.event.axes[i];
      text += std::to_string(found.event.number) + "," + layout.axes[i].axis + "," + std::to_string(found.event.segment);
      for (const double value : {found.event.begin, found.event.end, axis.peak_time, axis.peak, result.bandwidth, axis.duration,
                                 axis.velocity_change, axis.frequency, axis.at_cfc60, axis.at_cfc10})
        text += "," + number_or_nothing(value);
      text += "\n";
    }
  return text;
}

std::string spectra_csv(const RecordResult& result) {
  std::string text = "event,frequency [Hz]";
  for (const AxisColumn& axis : result.recording.layout.axes) text += std::string(",") + axis.axis + " [m/s^2]";
  text += "\n";
  for (const EventResult& found : result.events)
    for (std::size_t k = 0; !found.spectra.empty() && k < found.spectra.front().size(); ++k) {
      text += std::to_string(found.event.number) + "," + number_or_nothing(found.spectra.front()[k].frequency);
      for (const auto& spectrum : found.spectra) text += "," + number_or_nothing(spectrum[k].acceleration);
      text += "\n";
    }
  return text;
}

std::string record_json(const RecordResult& result) {
  const RecordLayout& layout = result.recording.layout;
  const ReadFacts& facts = result.recording.facts;
  nlohmann::ordered_json json{{"file", layout.file},         {"family", layout.family},    {"taken_for", facts_text(result.recording)},
                              {"is_peaks", layout.is_peaks}, {"start", layout.time.start}, {"rows", facts.rows},
                              {"segments", facts.segments},  {"gaps", facts.gaps.count},   {"first", facts.first},
                              {"last", facts.last}};
  if (!layout.is_peaks) {
    json["rate"] = layout.time.rate;
    json["conditioned"] = {{"rate", result.rate}, {"bandwidth", result.bandwidth}, {"interpolated_samples", result.interpolated}};
    if (result.conditioning.frequency_class) json["conditioned"]["cfc"] = *result.conditioning.frequency_class;
    if (result.conditioning.high_pass) json["conditioned"]["high_pass"] = *result.conditioning.high_pass;
    if (!result.conditioning.segment_offsets.empty()) json["conditioned"]["drift"] = "line";
    for (std::size_t i = 0; i < layout.axes.size(); ++i) json["axes"].push_back(axis_json(result, i));
    json["threshold"] = result.rules.threshold;
    json["events"] = nlohmann::ordered_json::array();
    for (const EventResult& found : result.events) json["events"].push_back(event_json(found, layout));
  }
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace steplap
