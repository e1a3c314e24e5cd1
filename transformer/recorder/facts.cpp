// Describes the layout of a recorder's file, and how it was read, as text.
#include "transformer/recorder/fields.h"
#include "transformer/recorder/reader.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

std::string in_g(double a) { return rounded_text(a / k_gravity, 4) + " g"; }

std::string times_text(const Counted& counted_, const char* one, const char* several) {
  return counted(counted_.count, one, several) + " (first in line " + std::to_string(counted_.line) + ")";
}

void add_axes(const Recording& recording, std::vector<std::string>& lines) {
  const RecordLayout& layout = recording.layout;
  for (std::size_t i = 0; i < layout.axes.size(); ++i) {
    const AxisColumn& axis = layout.axes[i];
    const AxisFacts& facts = recording.facts.axes[i];
    std::string text = std::string(1, axis.axis) + ": '" + axis.heading + "' in " + axis.unit + " (" + axis.unit_source + "), 1 " +
                       (axis.unit == "counts" ? "count" : axis.unit) + " = " + rounded_text(axis.factor) + " m/s^2; " + in_g(facts.least) +
                       " to " + in_g(facts.greatest);
    lines.push_back(text);
  }
}

// Returns a sentence about gravity at rest. Its subtraction is only suggested.
std::string gravity_text(const Recording& recording) {
  double size2 = 0.0;
  std::size_t most = 0;
  const auto& axes = recording.facts.axes;
  for (std::size_t i = 0; i < recording.layout.axes.size(); ++i) {
    size2 += axes[i].rest * axes[i].rest;
    if (std::abs(axes[i].rest) > std::abs(axes[most].rest)) most = i;
  }
  const double size = std::sqrt(size2) / k_gravity;
  const std::string axis = std::string(axes[most].rest < 0.0 ? "-" : "") + recording.layout.axes[most].axis;
  const auto& given = recording.facts.rest;
  const std::string at_rest =
      given ? "from " + number_text((*given)[0]) + " s to " + number_text((*given)[1]) + " s it reads " : "the first second reads ";
  const std::string if_given = "; the mean of that stretch is subtracted";
  if (size > 0.9 && size < 1.1)
    return "gravity: in the record, as it seems (" + at_rest + rounded_text(size, 4) + " g, mostly along " + axis + ")" +
           (given ? if_given : "; --gravity " + axis + " subtracts it");
  if (size < 0.1) return "gravity: not in the record, as it seems (" + at_rest + rounded_text(size, 3) + " g)";
  return "gravity: cannot be told (" + at_rest + rounded_text(size, 3) + " g)" +
         (given ? if_given : "; --gravity AXIS or --rest FROM,TO subtracts what is there at rest");
}

void add_clipping(const Recording& recording, std::vector<std::string>& lines) {
  for (std::size_t i = 0; i < recording.layout.axes.size(); ++i) {
    const AxisFacts& facts = recording.facts.axes[i];
    const std::string axis(1, recording.layout.axes[i].axis);
    if (facts.beyond_range.count > 0)
      lines.push_back("Axis " + axis + " is at the end of the sensor's range in " + times_text(facts.beyond_range, "sample", "samples") +
                      ": its peaks were higher.");
    else if (facts.flat_longest >= 3 && !recording.layout.holds)
      lines.push_back("Axis " + axis + " stays at " + in_g(facts.flat_value) + " for " + std::to_string(facts.flat_longest) +
                      " samples (first line " + std::to_string(facts.flat_line) + "): it seems clipped, and its peaks were higher.");
  }
}

void add_irregularities(const ReadFacts& facts, const RecordLayout& layout, std::vector<std::string>& lines) {
  const auto add = [&](const Counted& what, const char* one, const char* several, const std::string& said) {
    if (what.count > 0) lines.push_back(times_text(what, one, several) + said);
  };
  add(facts.gaps, "gap", "gaps", ", the longest " + rounded_text(facts.longest_gap, 4) + " s: the record is split there.");
  constexpr std::size_t k_told = 5; // number of gaps listed individually
  for (std::size_t i = 0; i < std::min(k_told, facts.hole_list.size()); ++i) {
    const Hole& hole = facts.hole_list[i];
    lines.push_back(counted(hole.rows, "row is", "rows are") + " missing after " + number_text(hole.t) + " s, before line " +
                    std::to_string(hole.line) + ": the signal is drawn smoothly across.");
  }
  if (facts.holes.count > k_told) lines.push_back("In all " + times_text(facts.holes, "hole", "holes") + " of missing rows.");
  add(facts.block_gaps, "block begins", "blocks begin",
      std::isfinite(facts.longest_block_gap)
          ? " later than the one before ended, at most by " + rounded_text(facts.longest_block_gap, 4) + " s."
          : " without a word on how long after the one before.");
  add(facts.blocks, "line of text among the rows", "lines of text among the rows", ": a new block of the record begins after it.");
  add(facts.comments, "comment among or after the rows", "comments among or after the rows", " left out.");
  add(facts.short_rows, "row is", "rows are", " shorter than the header; the axes are there.");
  const std::size_t named = layout.shape.width, most = layout.shape.most_fields;
  add(facts.long_rows, "row is", "rows are",
      " longer than the header: " + (most == named + 1 ? "column " + std::to_string(most) + ", which has no name, was left out."
                                                       : "columns " + std::to_string(named + 1) + " to " + std::to_string(most) +
                                                             ", which have no names, were left out."));
  add(facts.other_rows, "row", "rows", " without acceleration left out (other sensors).");
  add(facts.missing, "row", "rows", " with missing values left out or held, as asked.");
  add(facts.repeated, "row", "rows", " with a repeated time left out, as asked.");
  add(facts.backward, "step", "steps", " back in time, as asked.");
  add(facts.midnights, "midnight", "midnights", " passed.");
  add(facts.held, "place", "places", " where samples were left out: the value before is held (" + layout.hold_reason + ").");
  if (facts.cut_line > 0) lines.push_back("The last line (" + std::to_string(facts.cut_line) + ") is cut: it was left out.");
  if (facts.unended_line > 0)
    lines.push_back("The last line (" + std::to_string(facts.unended_line) + ") does not end with a line break. " +
                    (facts.is_unended_left_out ? "Its last number may lack digits: the line was left out."
                                               : "It has all fields, and its last number as many decimals as those before: it was kept."));
}

std::string delimiter_text(char delimiter) {
  return delimiter == '\t' ? "tab" : delimiter == ' ' ? "blanks" : std::string("'") + delimiter + "'";
}

} // namespace

std::string impossible_reading(const Recording& recording) {
  // Accelerations beyond this, m/s², are impossible in transport; shocks that destroy a machine have less than a tenth.
  constexpr double k_beyond_transport = 1000.0 * k_gravity;
  const auto text = [](const std::string& what, double value) { return what + " reads " + in_g(value) + ", which no transport gives."; };
  for (std::size_t i = 0; i < recording.layout.axes.size(); ++i) {
    const double most = std::max(std::abs(recording.facts.axes[i].least), std::abs(recording.facts.axes[i].greatest));
    if (most >= k_beyond_transport) return text(std::string("Axis ") + recording.layout.axes[i].axis, most);
  }
  for (const PeakEntry& entry : recording.peaks)
    for (const double peak : {entry.axis[0], entry.axis[1], entry.axis[2], entry.magnitude})
      if (std::abs(peak) >= k_beyond_transport) return text("The entry in line " + std::to_string(entry.line), peak);
  return "";
}

std::vector<std::string> facts_text(const Recording& recording) {
  const RecordLayout& layout = recording.layout;
  const ReadFacts& facts = recording.facts;
  std::vector<std::string> lines;
  lines.push_back("table: " + (layout.family.empty() ? std::string("no recorder named") : layout.family) + ", " + layout.encoding +
                  ", columns parted by " + delimiter_text(layout.shape.delimiter) + ", decimal " +
                  (layout.shape.decimal == ',' ? "comma" : "point") + ", " +
                  (layout.shape.names_line > 0 ? "names in line " + std::to_string(layout.shape.names_line) : "no names"));
  lines.push_back("time: " + layout.time.text + (layout.time.start.empty() ? "" : "; starts " + layout.time.start));
  const std::string what = layout.is_peaks
                               ? counted(facts.rows, "entry", "entries")
                               : counted(facts.rows, "sample", "samples") + " in " + counted(facts.segments, "segment", "segments");
  lines.push_back(
      (layout.is_peaks ? std::string("entries: ") : "rate: " + rounded_text(layout.time.rate) + " Hz (" + layout.time.rate_text + "); ") +
      what + ", from " + number_text(facts.first) + " s to " + number_text(facts.last) + " s");
  add_axes(recording, lines);
  if (layout.is_peaks) lines.push_back("peaks: in " + layout.peaks.unit + ", no waveform");
  else lines.push_back(gravity_text(recording));
  if (const std::string impossible = impossible_reading(recording); !impossible.empty())
    lines.push_back(impossible + " Check the unit, or the counts that are 1 g.");
  add_clipping(recording, lines);
  add_irregularities(facts, layout, lines);
  lines.insert(lines.end(), layout.notes.begin(), layout.notes.end());
  if (!facts.last_comment.empty()) lines.push_back("The file ends with '" + facts.last_comment + "'.");
  return lines;
}

} // namespace steplap
