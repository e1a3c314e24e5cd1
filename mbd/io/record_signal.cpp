#include "mbd/io/record_signal.h"

#include "mbd/base/number_text.h"
#include "mbd/io/column_unit.h"
#include "mbd/io/csv.h"
#include "mbd/io/units.h"

namespace steplap {

namespace {

constexpr double k_noise = 0.5; // largest acceleration that is noise of a recorder, m/s²

struct Record : SignalDefinition {
  std::string file;
  std::string time_column = "1";
  std::string column = "2";
  std::string time_unit;
  std::string unit;
  double scale = 1.0;
  double offset = 0.0; // s
  std::string after = "zero";
  std::string sha256;
};

// Returns the factor from the unit of a column to `wanted`, whose zero must be that of the unit.
double unit_factor(const Record& record, const std::string& key, const std::string& given, const CsvTable& table, std::size_t column,
                   const std::string& wanted) {
  const UnitConversion unit = conversion_of(table, column, {"record '" + record.name + "'", key, given, record.where, wanted});
  if (unit.shift != 0.0)
    throw ModelError(record.where, "'" + key + "' of record '" + record.name + "' must be a unit with its zero at zero");
  return unit.factor;
}

bool is_acceleration(const Record& record, const CsvTable& table, std::size_t column) {
  const std::string unit = record.unit.empty() ? unit_in_header(table, column, "m/s^2") : record.unit;
  return !unit.empty() && parse_quantity("1 " + unit, "m/s^2").problem.empty();
}

void check_ascending(const CsvTable& table, const std::vector<double>& times) {
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1]))
      throw ModelError({table.file, table.lines[i], 1}, "time " + number_text(times[i]) + " does not come after " +
                                                            number_text(times[i - 1]) + " of the row before: times must ascend");
}

Signal build_record(const SignalDefinition& definition) {
  const Record& record = static_cast<const Record&>(definition);
  const CsvTable table = read_csv(record.file, record.where, record.sha256);
  const std::size_t time_column = table.column(record.time_column, record.where), column = table.column(record.column, record.where);
  const auto &times = table.columns[time_column], &values = table.columns[column];
  check_ascending(table, times);
  const double time_scale = unit_factor(record, "time_unit", record.time_unit, table, time_column, "s");
  const double scale = record.scale * unit_factor(record, "unit", record.unit, table, column, "*");
  std::vector<Signal::Piece> pieces(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    pieces[i].start = times[i] * time_scale + record.offset;
    pieces[i].c[0] = values[i] * scale;
    if (i > 0) pieces[i - 1].c[1] = (pieces[i].c[0] - pieces[i - 1].c[0]) / (pieces[i].start - pieces[i - 1].start);
  }
  if (record.after != "zero") return Signal(std::move(pieces));
  pieces.back().c[0] = 0.0;
  Signal signal(std::move(pieces));
  // Only of an acceleration it is known that nothing acted before it was measured: a record without a unit may be a table of anything.
  if (is_acceleration(record, table, column)) {
    signal.doubt_cut_end(k_noise);
    signal.doubt_cut_begin(k_noise);
  } else {
    signal.doubt_cut_end();
  }
  return signal;
}

} // namespace

const SignalKind& record_signal_kind() {
  static const SignalKind kind = [] {
    SignalKind k{"record",
                 "A measured history from a CSV file, linear between its rows, 0 before "
                 "the first; it may be shorter than the run.",
                 {},
                 create_object<SignalDefinition, Record>,
                 copy_object<SignalDefinition, Record>,
                 build_record};
    k.fields.add("file", &Record::file).as(FieldType::file).required().doc("CSV file, relative to the model file");
    k.fields.add("time_column", &Record::time_column).doc("name of the column of times, or its number from \"1\"");
    k.fields.add("column", &Record::column).doc("name of the column of values, or its number from \"1\"");
    k.fields.add("time_unit", &Record::time_unit).doc("unit of the times; if not given that in brackets in the header, or s");
    k.fields.add("unit", &Record::unit)
        .doc("unit of the values, such as \"gravity\" or \"km/h\"; if not given that in brackets in the header, or SI");
    k.fields.add("scale", &Record::scale).doc("factor on the values; -1 turns the sign");
    k.fields.add("offset", &Record::offset).in("s").doc("added to the times");
    k.fields.add("after", &Record::after).one_of({"zero", "hold"}).doc("value after the last row: 0, or the last one kept");
    k.fields.add("sha256", &Record::sha256).doc("SHA-256 of the file, as sha256sum prints it: another content is refused. Results give it");
    return k;
  }();
  return kind;
}

} // namespace steplap
