#include "mbd/io/record_signal.h"

#include "mbd/base/number_text.h"
#include "mbd/io/csv.h"
#include "mbd/io/units.h"

#include <cmath>

namespace steplap {

namespace {

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

Quantity one(const std::string& unit, const std::string& wanted) { return parse_quantity("1 " + unit, wanted); }

// Returns the unit in the header of a column, as parse_quantity() reads it; "" if there is none. No record is in grams.
std::string unit_in_header(const std::string& text, const std::string& wanted) {
  if (text == "-") return "";
  return wanted != "s" && (text == "g" || text == "G") ? "gravity" : text;
}

// Refuses a column such as "force (kN)" without `key`: parentheses may hold a unit or a part of the name.
void refuse_unit_in_parentheses(const Record& record, const std::string& key, const std::string& name, const std::string& wanted) {
  const std::size_t open = name.rfind('(');
  if (open == std::string::npos || name.back() != ')') return;
  const Quantity found = one(unit_in_header(name.substr(open + 1, name.size() - open - 2), wanted), wanted);
  if (found.problem.empty() && found.value != 1.0)
    throw ModelError(record.where, "record '" + record.name + "': column '" + name +
                                       "' may be in the unit in its parentheses: say which by '" + key + "'");
}

// Returns the factor to `wanted` from the unit that `given`, the field `key`, or else the header of the column names; 1 if neither does.
double unit_factor(const Record& record, const std::string& key, const std::string& given, const CsvTable& table, std::size_t column,
                   const std::string& wanted) {
  constexpr double k_same = 1e-9; // two spellings of one unit may differ by rounding
  const std::string in_header = table.units.empty() ? std::string() : table.units[column];
  const std::string header = unit_in_header(in_header, wanted), &unit = given.empty() ? header : given;
  if (given.empty() && header.empty() && !table.names.empty()) refuse_unit_in_parentheses(record, key, table.names[column], wanted);
  if (unit.empty()) return 1.0;
  if (!given.empty() && !header.empty() && one(header, wanted).problem.empty())
    if (const Quantity ratio = one(given, header); !ratio.problem.empty() || !(std::abs(ratio.value - 1.0) <= k_same))
      throw ModelError(record.where, "'" + key + "' of record '" + record.name + "' is '" + given + "', but the column says [" + in_header +
                                         "]: drop '" + key + "', or correct the file");
  const Quantity zero = parse_quantity("0 " + unit, wanted), factor = one(unit, wanted);
  if (!factor.problem.empty() && given.empty())
    throw ModelError(record.where,
                     "the column's unit [" + in_header + "] of record '" + record.name + "' is not known: give it by '" + key + "'");
  if (!factor.problem.empty()) throw ModelError(record.where, "'" + key + "' of record '" + record.name + "': " + factor.problem);
  if (zero.value != 0.0)
    throw ModelError(record.where,
                     "'" + key + "' of record '" + record.name + "' must be a unit with its zero at zero, got '" + unit + "'");
  return factor.value;
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
  signal.doubt_cut_end();
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
