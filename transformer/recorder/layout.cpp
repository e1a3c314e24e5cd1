#include "transformer/recorder/layout.h"

#include "transformer/recorder/fields.h"
#include "transformer/recorder/record_error.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace steplap {

namespace {

std::string quoted_list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + shown(name) + "'";
  return text;
}

std::string heading_text(const TableShape& shape, std::size_t column) {
  return column < shape.names.size() && !shape.names[column].empty() ? shown(shape.names[column]) : "column " + std::to_string(column + 1);
}

// Returns the axis columns that the options name; "-" reverses the sign.
std::vector<AxisColumn> chosen_axes(const RecordLayout& layout, const ReadOptions& options) {
  std::vector<AxisColumn> axes;
  const std::pair<char, const std::optional<std::string>*> chosen[] = {{'x', &options.x}, {'y', &options.y}, {'z', &options.z}};
  for (const auto& [axis, option] : chosen) {
    if (!*option) continue;
    const bool is_turned = (*option)->starts_with('-');
    AxisColumn column{axis, column_of(layout.shape, (*option)->substr(is_turned ? 1 : 0), std::string("--") + axis, layout.file),
                      "",   is_turned ? -1.0 : 1.0,
                      "",   ""};
    axes.push_back(column);
  }
  return axes;
}

// Adds the column with the highest weight for an axis. Two columns with equal weight are an error.
void add_named_axis(const RecordLayout& layout, char axis, Role role, std::vector<AxisColumn>& axes) {
  int best = 0;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < layout.shape.names.size(); ++i) {
    const NamedRole named = role_of(heading_of(layout.shape.names[i]).name);
    if (named.role != role || named.weight < best) continue;
    if (named.weight > best) found.clear();
    best = named.weight;
    found.push_back(i);
  }
  if (found.size() > 1)
    throw RecordError(layout.file, layout.shape.names_line, 1,
                      std::string("Several columns may be the axis ") + axis + ": '" + heading_text(layout.shape, found[0]) + "' and '" +
                          heading_text(layout.shape, found[1]) + "'. Choose one with --" + axis + " COLUMN.");
  if (!found.empty()) axes.push_back({axis, found.front(), "", 1.0, "", ""});
}

std::vector<AxisColumn> named_axes(const RecordLayout& layout) {
  std::vector<AxisColumn> axes;
  add_named_axis(layout, 'x', Role::x, axes);
  add_named_axis(layout, 'y', Role::y, axes);
  add_named_axis(layout, 'z', Role::z, axes);
  for (std::size_t i = 0; i < layout.shape.names.size() && axes.empty(); ++i)
    if (const std::string name = heading_of(layout.shape.names[i]).name; role_of(name).role == Role::acceleration)
      throw RecordError(layout.file, layout.shape.names_line, 1,
                        "The column '" + shown(name) +
                            "' is an acceleration, but its name gives no axis. Give --x, --y or --z with its number, for example --x " +
                            std::to_string(i + 1) + ".");
  if (axes.empty())
    throw RecordError(layout.file, layout.shape.names_line, 1,
                      "No column is named as an axis of acceleration: there are " + quoted_list(layout.shape.names) +
                          ". Choose columns with --x, --y or --z, by name or number.");
  return axes;
}

// Returns axis columns of a table without names: x, y and z, if three columns remain after a first column with times.
std::vector<AxisColumn> unnamed_axes(const RecordLayout& layout, const std::vector<HeaderLine>& head, const ReadOptions& options) {
  const std::size_t width = layout.shape.width, line = head[layout.shape.first_data].number;
  std::vector<std::string_view> fields;
  static_cast<void>(layout.shape.split(head[layout.shape.first_data].text, fields));
  const bool begins_with_stamp = !parse_number(fields.front(), layout.shape.decimal);
  std::optional<std::size_t> time;
  if (options.time && *options.time != "none") time = column_of(layout.shape, *options.time, "--time", layout.file);
  else if (!options.time && begins_with_stamp) time = 0;
  const bool is_settled = time || options.time == "none";
  if (!is_settled || width != (time ? 4U : 3U))
    throw RecordError(layout.file, line, 1,
                      "No line names the " + counted(width, "column", "columns") +
                          " of this table. Say which is which by number, for example --time 1 --x 2 --y 3 --z 4 (--time none if there is "
                          "no column of times).");
  std::vector<AxisColumn> axes;
  for (std::size_t i = 0; i < width; ++i)
    if (i != time) axes.push_back({"xyz"[axes.size()], i, "", 1.0, "", ""});
  return axes;
}

std::string unit_of_column(const TableShape& shape, std::size_t column, std::string& source) {
  if (column < shape.names.size()) {
    const std::string unit = heading_of(shape.names[column]).unit;
    source = "line " + std::to_string(shape.names_line);
    if (!unit.empty()) return unit;
  }
  source = "line " + std::to_string(shape.units_line);
  return column < shape.units.size() ? shape.units[column] : "";
}

// Interprets ";Accel, 225, 1000, 16, g": rate, counts per unit, range, unit.
struct StatedScale {
  double counts_per_unit = 0.0;
  AccelerationUnit unit;
  double range = 0.0;
  std::size_t line = 0;
};
std::optional<StatedScale> scale_of(const Metadata& metadata) {
  const auto* said = metadata.find({"accel"});
  if (!said || said->values.size() < 4) return std::nullopt;
  const auto counts = parse_number(said->values[1], '.'), range = parse_number(said->values[2], '.');
  const auto unit = acceleration_unit(said->values[3]);
  if (!counts || !unit || unit->is_counts || !(*counts > 0.0)) return std::nullopt;
  return StatedScale{*counts, *unit, range.value_or(0.0) * unit->factor, said->line};
}

void scale_counts(AxisColumn& axis, const RecordLayout& layout, std::size_t line, const Metadata& metadata, const ReadOptions& options) {
  axis.unit = "counts";
  if (options.counts_per_g) {
    axis.factor *= k_gravity / *options.counts_per_g;
    axis.unit_source = "--counts-per-g " + number_text(*options.counts_per_g);
  } else if (const auto scale = scale_of(metadata)) {
    axis.factor *= scale->unit.factor / scale->counts_per_unit;
    axis.unit_source =
        number_text(scale->counts_per_unit) + " counts are 1 " + scale->unit.name + " by line " + std::to_string(scale->line);
  } else {
    throw RecordError(layout.file, line, 1,
                      "The column '" + axis.heading +
                          "' holds counts, and no line states how many are 1 g. Look it up in the recorder's data sheet and give "
                          "--counts-per-g NUMBER.");
  }
}

// A unit of all accelerations, given in the lines before the data.
struct StatedUnit {
  std::string text;
  std::size_t line = 0;
};

// Finds "Units: mG", or ", Units, mG" within a line about a sensor. Contradictory lines are ignored.
std::optional<StatedUnit> unit_of(const Metadata& metadata) {
  if (const auto* said = metadata.find({"units", "unit", "accelunits", "accelerationunit", "accelerationunits"}))
    return StatedUnit{said->values.front(), said->line};
  std::optional<StatedUnit> found;
  for (const auto& [key, value] : metadata.entries)
    for (std::size_t i = 0; i + 1 < value.values.size(); ++i) {
      const std::string word = lower_case(value.values[i]);
      const auto unit = acceleration_unit(value.values[i + 1]);
      if ((word != "units" && word != "unit") || !unit) continue;
      if (found && acceleration_unit(found->text)->name != unit->name) return std::nullopt;
      found = StatedUnit{value.values[i + 1], value.line};
    }
  return found;
}

void scale_axis(AxisColumn& axis, const RecordLayout& layout, const std::vector<HeaderLine>& head, const Metadata& metadata,
                const ReadOptions& options) {
  const std::size_t line = layout.shape.names_line > 0 ? layout.shape.names_line : head[layout.shape.first_data].number;
  std::string text = options.unit.value_or("");
  axis.heading = heading_text(layout.shape, axis.column);
  axis.unit_source = "--unit";
  if (text.empty()) text = unit_of_column(layout.shape, axis.column, axis.unit_source);
  if (const auto said = unit_of(metadata); said && text.empty()) {
    text = said->text;
    axis.unit_source = "line " + std::to_string(said->line);
  }
  if (text.empty() && (options.counts_per_g || scale_of(metadata))) return scale_counts(axis, layout, line, metadata, options);
  if (text.empty() && layout.family == "Gulf Coast Data Concepts")
    throw RecordError(
        layout.file, line, 1,
        "The file gives no unit for '" + axis.heading +
            "'; recorders of this family write counts. Give --counts-per-g NUMBER from the data sheet, or --unit if these are no counts.");
  if (text.empty())
    throw RecordError(layout.file, line, 1,
                      "The file gives no unit for '" + axis.heading + "'. Give --unit g, mg, m/s^2 or counts (with --counts-per-g).");
  const auto unit = acceleration_unit(text);
  if (!unit)
    throw RecordError(layout.file, line, 1,
                      "'" + shown(text) + "' (" + axis.unit_source + ") is no unit of acceleration for '" + axis.heading +
                          "'. Give --unit g, mg, m/s^2 or counts, or choose other columns with --x, --y, --z.");
  if (unit->is_counts) return scale_counts(axis, layout, line, metadata, options);
  axis.unit = unit->name;
  axis.factor *= unit->factor;
}

// Returns true if columns are named as peaks and none as an axis: the file is then a list of peaks, without waveforms.
bool find_peaks(RecordLayout& layout) {
  PeakColumns& peaks = layout.peaks;
  std::string unit_text, source;
  for (std::size_t i = 0; i < layout.shape.names.size(); ++i) {
    const int column = static_cast<int>(i);
    const Role role = role_of(heading_of(layout.shape.names[i]).name).role;
    const bool is_peak = role == Role::peak || role == Role::peak_x || role == Role::peak_y || role == Role::peak_z;
    if (role == Role::x || role == Role::y || role == Role::z) return false;
    const std::string unit = unit_of_column(layout.shape, i, source);
    if (role == Role::peak_x) peaks.axis[0] = column;
    if (role == Role::peak_y) peaks.axis[1] = column;
    if (role == Role::peak_z) peaks.axis[2] = column;
    if (role == Role::peak) peaks.magnitude = column;
    if (is_peak && !unit_text.empty() && unit != unit_text)
      throw RecordError(layout.file, layout.shape.names_line, 1,
                        "Peaks have different units: '" + shown(unit_text) + "' and '" + shown(unit) +
                            "'. Give --unit if one of them is meant for all.");
    if (is_peak) unit_text = unit;
    if (role == Role::duration) {
      peaks.duration = column;
      const auto factor = time_unit(unit);
      if (!factor)
        throw RecordError(layout.file, layout.shape.names_line, 1,
                          "The durations have no unit of time. Write one after the name of the column, such as 'Duration [ms]'.");
      peaks.duration_factor = *factor;
    }
    if (role == Role::velocity_change) {
      const std::string lower = lower_case(unit);
      const double factor = lower == "m/s"                                      ? 1.0
                            : lower == "mm/s"                                   ? 0.001
                            : lower == "cm/s"                                   ? 0.01
                            : lower == "gs" || lower == "g s" || lower == "g*s" ? k_gravity
                                                                                : 0.0;
      if (factor == 0.0)
        layout.notes.push_back("The column '" + heading_text(layout.shape, i) +
                               "' is left out: its unit is none of m/s, mm/s, cm/s and g s.");
      else peaks.velocity_change = column, peaks.velocity_factor = factor;
    }
  }
  return peaks.magnitude >= 0 || peaks.axis[0] >= 0 || peaks.axis[1] >= 0 || peaks.axis[2] >= 0;
}

void scale_peaks(RecordLayout& layout, const std::vector<HeaderLine>& head, const Metadata& metadata, const ReadOptions& options) {
  AxisColumn axis;
  for (const int column : {layout.peaks.magnitude, layout.peaks.axis[2], layout.peaks.axis[1], layout.peaks.axis[0]})
    if (column >= 0) axis.column = static_cast<std::size_t>(column);
  scale_axis(axis, layout, head, metadata, options);
  layout.peaks.factor = axis.factor;
  layout.peaks.unit = axis.unit;
  layout.notes.push_back(
      "The file holds peaks only, no waveform: durations of shocks and changes of velocity are known only if a column states them.");
}

void find_range_and_holding(RecordLayout& layout, const Metadata& metadata, const ReadOptions& options) {
  if (const auto scale = scale_of(metadata); scale && scale->range > 0.0) layout.range = scale->range;
  if (options.range) layout.range = options.range;
  const auto* deadband = metadata.find({"deadband"});
  const auto band = deadband ? parse_number(deadband->values.front(), '.') : std::nullopt;
  if (options.holds) layout.holds = true, layout.hold_reason = "--hold";
  else if (band && *band > 0.0)
    layout.holds = true, layout.hold_reason = "a deadband of " + deadband->values.front() + " by line " + std::to_string(deadband->line);
}

} // namespace

std::size_t column_of(const TableShape& shape, const std::string& name_or_number, const std::string& option, const std::string& file) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < shape.names.size(); ++i) {
    const std::string bare = heading_of(shape.names[i]).name;
    if (shape.names[i] == name_or_number || bare == name_or_number) return i;
    known.push_back(bare);
  }
  std::size_t number = 0;
  const char* end = name_or_number.data() + name_or_number.size();
  const auto [rest, status] = std::from_chars(name_or_number.data(), end, number);
  if (status == std::errc() && rest == end && number >= 1 && number <= shape.width) return number - 1;
  throw RecordError(file, shape.names_line, shape.names_line > 0 ? 1 : 0,
                    "There is no column '" + shown(name_or_number) + "' for " + option + did_you_mean(name_or_number, known) +
                        ". The table has " + counted(shape.width, "column", "columns") +
                        (known.empty() ? ", by numbers from 1." : ": " + quoted_list(shape.names) + "."));
}

RecordLayout find_record_layout(const std::vector<HeaderLine>& head, const std::string& file, const ReadOptions& options) {
  RecordLayout layout;
  layout.file = file;
  layout.shape = find_shape(head, file, options);
  const std::vector<HeaderLine> before(head.begin(), head.begin() + static_cast<std::ptrdiff_t>(layout.shape.first_data));
  const Metadata metadata = metadata_of(before);
  layout.family = family_of(before);
  find_range_and_holding(layout, metadata, options);
  const bool is_chosen = options.x || options.y || options.z;
  layout.is_peaks = !is_chosen && find_peaks(layout);
  if (layout.is_peaks) {
    scale_peaks(layout, head, metadata, options);
  } else {
    layout.axes = is_chosen                    ? chosen_axes(layout, options)
                  : layout.shape.names.empty() ? unnamed_axes(layout, head, options)
                                               : named_axes(layout);
    for (AxisColumn& axis : layout.axes) scale_axis(axis, layout, head, metadata, options);
  }
  layout.time = find_time(layout, head, metadata, options, layout.notes);
  if (layout.time.index_column && layout.family == "PALT" && !layout.holds)
    layout.holds = true, layout.hold_reason = "recorders of this family leave repeated samples out";
  return layout;
}

} // namespace steplap
