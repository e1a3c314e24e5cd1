#include "transformer/recorder/header.h"

#include "transformer/recorder/fields.h"

#include <algorithm>
#include <initializer_list>

namespace steplap {

bool is_comment(std::string_view line, char delimiter) {
  line = trimmed_blanks(line);
  if (line.empty()) return false;
  return line.front() == '#' || line.front() == '*' || (line.front() == ';' && delimiter != ';');
}

const Metadata::Value* Metadata::find(std::initializer_list<const char*> keys) const {
  for (const char* key : keys)
    if (const auto found = entries.find(key); found != entries.end()) return &found->second;
  return nullptr;
}

Metadata metadata_of(const std::vector<HeaderLine>& lines) {
  Metadata metadata;
  for (const HeaderLine& line : lines) {
    std::string_view text = trimmed_blanks(line.text);
    while (!text.empty() && (text.front() == ';' || text.front() == '#' || text.front() == '*')) text.remove_prefix(1);
    const auto place = text.find_first_of(":=;,\t");
    if (place == std::string_view::npos) continue;
    std::string key;
    for (const char c : lower_case(text.substr(0, place)))
      if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) key += c;
    if (key.empty()) continue;
    const char separator = text[place] == ':' || text[place] == '=' ? ',' : text[place];
    std::vector<std::string_view> fields;
    if (!split_fields(text.substr(place + 1), separator, fields)) continue;
    Metadata::Value value{line.number, {}};
    for (const std::string_view field : fields) value.values.emplace_back(field);
    metadata.entries.emplace(key, std::move(value)); // emplace() keeps the first occurrence of a key
  }
  return metadata;
}

namespace {

// Parses "100 Hz", or "100" and "Hz" in separate fields.
std::optional<double> with_unit(const std::vector<std::string>& values, std::string& unit) {
  std::string_view number = values.front();
  const auto blank = number.find_first_not_of("0123456789.+-eE");
  unit = values.size() > 1 ? values[1] : "";
  if (blank != std::string_view::npos && blank > 0) {
    unit = trimmed_blanks(number.substr(blank));
    number = number.substr(0, blank);
  }
  return parse_number(number, '.');
}

} // namespace

std::optional<HeaderRate> rate_of(const Metadata& metadata) {
  std::string unit;
  if (const auto* said = metadata.find({"samplerate", "samplingrate", "sampleratehz", "samplingratehz", "samplingfrequency",
                                        "samplefrequency", "samplespersecond", "rate", "fs", "frequency", "scanrate"})) {
    const auto value = with_unit(said->values, unit);
    const std::string lower = lower_case(unit);
    const double factor = lower == "khz" || lower == "ks/s" ? 1000.0 : 1.0;
    const bool is_known = lower.empty() || lower == "hz" || lower == "khz" || lower == "s/s" || lower == "ks/s" || lower == "sps" ||
                          lower == "1/s" || lower == "samples/s";
    if (value && *value > 0.0 && is_known) return HeaderRate{*value * factor, said->line};
  }
  if (const auto* said = metadata.find({"samplinginterval", "sampleinterval", "sampleperiod", "deltat", "dt", "interval"})) {
    const auto value = with_unit(said->values, unit);
    const auto seconds = time_unit(unit);
    if (value && seconds && *value > 0.0) return HeaderRate{1.0 / (*value * *seconds), said->line};
  }
  return std::nullopt;
}

std::optional<double> low_pass_of(const Metadata& metadata) {
  std::string unit;
  const auto* said =
      metadata.find({"lowpass", "lowpassfilter", "lowpassfrequency", "lowpasshz", "filter", "filterhz", "filterfrequency",
                     "antialiasfilter", "antialiasingfilter", "cutoff", "cutofffrequency", "cornerfrequency", "bandwidth", "bandwidthhz"});
  if (!said) return std::nullopt;
  const auto value = with_unit(said->values, unit);
  const std::string lower = lower_case(unit);
  if (!value || !(*value > 0.0) || !(lower.empty() || lower == "hz" || lower == "khz")) return std::nullopt;
  return *value * (lower == "khz" ? 1000.0 : 1.0);
}

std::string family_of(const std::vector<HeaderLine>& lines) {
  struct Mark {
    const char* word;
    const char* family;
  };
  constexpr Mark k_marks[] = {{"gcdc", "Gulf Coast Data Concepts"},
                              {"gulf coast", "Gulf Coast Data Concepts"},
                              {"gcdataconcepts", "Gulf Coast Data Concepts"},
                              {";deadband", "Gulf Coast Data Concepts"},
                              {"; deadband", "Gulf Coast Data Concepts"},
                              {"shocklog", "ShockLog"},
                              {"monilog", "MONILOG"},
                              {"lansmont", "Lansmont"},
                              {"endaq", "enDAQ"},
                              {"slam stick", "enDAQ"},
                              {"solve", "SOLVE"},
                              {"palt", "PALT"},
                              {"*creator", "MSR"},
                              {"msr", "MSR"}};
  for (const Mark& mark : k_marks)
    for (const HeaderLine& line : lines)
      if (lower_case(line.text).find(mark.word) != std::string::npos) return mark.family;
  return "";
}

std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  bool is_inside = false;
  for (const char c : lower_case(name)) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80;
    if (is_letter && !is_inside) words.emplace_back();
    if (is_letter) words.back() += c;
    is_inside = is_letter;
  }
  return words;
}

namespace {

bool holds(const std::vector<std::string>& words, std::initializer_list<const char*> wanted) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::any_of(wanted.begin(), wanted.end(), [&](const char* each) { return word == each; });
  });
}

// Returns the axis 'x', 'y' or 'z' with a weight, which is 3 if the name also contains acceleration.
std::pair<char, int> axis_of(const std::vector<std::string>& words) {
  const bool is_acceleration =
      std::any_of(words.begin(), words.end(), [](const std::string& w) { return w.starts_with("acc") || w == "shock" || w == "a"; });
  for (const std::string& word : words)
    for (const char axis : {'x', 'y', 'z'}) {
      const std::string a(1, axis);
      if (word == "a" + a || word == "acc" + a || word == "accel" + a || word == "acceleration" + a || word == a + "acc" ||
          word == a + "accel")
        return {axis, 3};
      if (word == a || word == a + "axis" || word == "axis" + a || word == a + "achse") return {axis, is_acceleration ? 3 : 2};
    }
  return {0, 0};
}

} // namespace

NamedRole role_of(std::string_view name) {
  const std::vector<std::string> words = words_of(name);
  if (words.empty()) return trimmed_blanks(name) == "#" ? NamedRole{Role::index, 1} : NamedRole{};
  // Axes of other sensors are excluded.
  const bool is_other_sensor = std::any_of(words.begin(), words.end(), [](const std::string& w) {
    return w.starts_with("gyr") || w.starts_with("rot") || w.starts_with("ang") || w.starts_with("mag") || w.starts_with("quat") ||
           w.starts_with("orient") || w.starts_with("temp") || w.starts_with("press") || w.starts_with("hum") || w.starts_with("veloc") ||
           w.starts_with("tilt") || w.starts_with("filter") || w == "rms" || w == "freq";
  });
  const bool is_peak = holds(words, {"peak", "max", "maximum", "spitze", "peaks"});
  const auto [axis, weight] = axis_of(words);
  if (is_peak && !is_other_sensor) {
    if (axis != 0) return {axis == 'x' ? Role::peak_x : axis == 'y' ? Role::peak_y : Role::peak_z, 3};
    if (!holds(words, {"time", "date"})) return {Role::peak, 2};
  }
  if (holds(words, {"duration", "dauer", "width"})) return {Role::duration, 2};
  if (holds(words, {"slot", "period"})) return {Role::slot, 1};
  if (holds(words, {"strength", "dv", "deltav", "impulse"}) || (holds(words, {"velocity"}) && holds(words, {"change", "delta"})))
    return {Role::velocity_change, 2};
  if (axis != 0 && !is_other_sensor) return {axis == 'x' ? Role::x : axis == 'y' ? Role::y : Role::z, weight};
  if (holds(words, {"magnitude", "resultant", "vector", "total", "norm"})) return {Role::magnitude, 1};
  if (is_other_sensor) return {};
  if (holds(words, {"datetime", "timestamp", "zeitstempel"}) || (holds(words, {"date"}) && holds(words, {"time"}))) return {Role::time, 3};
  if (holds(words, {"date", "datum"})) return {Role::date, 2};
  if (holds(words, {"time", "times", "zeit", "elapsed", "epoch", "uhrzeit"})) return {Role::time, 2};
  if (trimmed_blanks(name) == "T") return {}; // "T" is temperature or time; it is used as time only if no other column is a time
  if (words.size() == 1 && holds(words, {"t", "seconds", "sec", "s", "ms", "millis"})) return {Role::time, 1};
  if (holds(words, {"sample", "samples", "index", "idx", "nr", "no", "n", "scan"})) return {Role::index, 1};
  if (std::any_of(words.begin(), words.end(), [](const std::string& w) { return w.starts_with("accel"); }) ||
      holds(words, {"acc", "shock", "a"}))
    return {Role::acceleration, 1};
  return {};
}

} // namespace steplap
