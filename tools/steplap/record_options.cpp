#include "tools/steplap/record_options.h"

#include "mbd/base/shown_text.h"
#include "transformer/recorder/fields.h"

namespace steplap {

double acceleration_of(const std::string& text, const char* option) {
  const auto end = text.find_first_not_of("0123456789.+-eE");
  const auto value = parse_number(trimmed_blanks(text.substr(0, end)), '.');
  const auto unit = acceleration_unit(end == std::string::npos ? "g" : text.substr(end));
  if (!value || !(*value > 0.0) || !unit || unit->is_counts)
    throw UsageError(std::string(option) + " '" + text + "': give an acceleration above zero, such as \"3 g\" or \"20 m/s^2\"");
  return *value * unit->factor;
}

double number_of(const ReadingOptions::Text& text, const char* option, double least, const char* unit) {
  const auto value = parse_number(*text, '.');
  if (!value || !(*value > least))
    throw UsageError(std::string(option) + " '" + *text + "': a number above " + rounded_text(least) + " is needed" + unit);
  return *value;
}

ReadOptions read_options(const ReadingOptions& o) {
  ReadOptions r;
  r.x = o.x, r.y = o.y, r.z = o.z, r.time = o.time, r.time_unit = o.time_unit, r.unit = o.unit, r.holds = o.holds;
  if (o.rate) r.rate = number_of(o.rate, "--rate", 0.0, ", in Hz");
  if (o.counts_per_g) r.counts_per_g = number_of(o.counts_per_g, "--counts-per-g", 0.0);
  if (o.gap) r.gap = number_of(o.gap, "--gap", 1.5, ", in sampling intervals");
  if (o.range) r.range = acceleration_of(*o.range, "--range");
  if (o.delimiter) r.delimiter = choice(*o.delimiter, "--delimiter", k_delimiters);
  if (o.decimal) r.decimal = choice(*o.decimal, "--decimal", k_decimals);
  if (o.dates) r.dates = choice(*o.dates, "--dates", k_dates);
  if (o.missing) r.missing = choice(*o.missing, "--missing", k_missing);
  if (o.repeated) r.repeated = choice(*o.repeated, "--repeated", k_repeated);
  if (o.backward) r.backward = choice(*o.backward, "--backward", k_backward);
  return r;
}

EventRules event_rules(const ReadingOptions& o) {
  EventRules rules;
  if (o.threshold) rules.threshold = acceleration_of(*o.threshold, "--threshold");
  if (o.before) rules.before = number_of(o.before, "--before", 0.0, ", in s");
  if (o.after) rules.after = number_of(o.after, "--after", 0.0, ", in s");
  if (o.merge) rules.merge = number_of(o.merge, "--merge", 0.0, ", in s");
  return rules;
}

std::array<double, 2> rest_stretch(const std::string& text) {
  const auto comma = text.find(',');
  const auto from = parse_number(text.substr(0, comma), '.'),
             to = comma == std::string::npos ? std::nullopt : parse_number(text.substr(comma + 1), '.');
  if (!from || !to || !(*to > *from)) throw UsageError("--rest '" + text + "': give two times in s, such as 0,2");
  return {*from, *to};
}

std::vector<Option> reading_options(ReadingOptions& options) {
  ReadingOptions* const o = &options;
  return {{"--x", &o->x, "COLUMN", "column of axis x, by name or number; \"-\" before it turns the sign. Axes not given are then not read"},
          {"--y", &o->y, "COLUMN", "the same of axis y"},
          {"--z", &o->z, "COLUMN", "the same of axis z"},
          {"--time", &o->time, "COLUMN", "column of times, or none"},
          {"--time-unit", &o->time_unit, "UNIT", "s, ms, us, min, h, epoch, \"epoch ms\" or days (of a spreadsheet)"},
          {"--rate", &o->rate, "HZ", "rate of sampling"},
          {"--unit", &o->unit, "UNIT", "of accelerations: g, mg, m/s^2 or counts"},
          {"--counts-per-g", &o->counts_per_g, "N", "counts that are 1 g"},
          {"--range", &o->range, "A", "how far the sensor reads, such as \"16 g\": beyond 0.95 of it a record is clipped"},
          {"--delimiter", &o->delimiter, "SIGN", "comma, semicolon, tab or blank"},
          {"--decimal", &o->decimal, "SIGN", "point or comma"},
          {"--dates", &o->dates, "ORDER", "day-first, month-first or year-first"},
          {"--missing", &o->missing, "HOW", "rows with empty or NaN fields: refuse (default), skip or hold"},
          {"--repeated", &o->repeated, "HOW", "rows with the time of the row before: refuse (default), first or last"},
          {"--backward", &o->backward, "HOW", "times before that of the row before: refuse (default), split or drop"},
          {"--hold", &o->holds, "", "left-out samples have the value before them"},
          {"--gap", &o->gap, "N", "sampling intervals beyond which a gap splits the record: 3.5"},
          {"--rest", &o->quiet, "FROM,TO", "subtract the mean from FROM to TO, s"},
          {"--gravity", &o->gravity, "AXIS", "subtract gravity from x, y, z, -x, -y or -z; none keeps what the record has"},
          {"--cfc", &o->cfc, "HZ", "low-pass of a channel frequency class (ISO 6487): 10 to 1000"},
          {"--resample", &o->resample, "HZ", "higher rate of the cleaned signal"},
          {"--threshold", &o->threshold, "A", "events begin beyond it: \"1 g\""},
          {"--before", &o->before, "S", "kept before an event: 0.1"},
          {"--after", &o->after, "S", "kept after an event: 0.3"},
          {"--merge", &o->merge, "S", "what follows sooner belongs to the same event: 0.3"}};
}

} // namespace steplap
