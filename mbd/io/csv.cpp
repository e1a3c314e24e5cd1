#include "mbd/io/csv.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/named_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

namespace steplap {

namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string_view unquoted(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return text.substr(1, text.size() - 2);
  return text;
}

// Splits a line at the delimiter outside quotes.
void split(std::string_view line, char delimiter, std::vector<std::string_view>& fields) {
  fields.clear();
  std::size_t start = 0;
  bool is_quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') is_quoted = !is_quoted;
    if (i < line.size() && (is_quoted || line[i] != delimiter)) continue;
    fields.push_back(unquoted(line.substr(start, i - start)));
    start = i + 1;
  }
}

char delimiter_of(std::string_view line) {
  for (const char candidate : {'\t', ';'})
    if (line.find(candidate) != std::string_view::npos) return candidate;
  return ',';
}

std::optional<double> number_of(std::string_view field, bool has_decimal_comma) {
  std::string buffer;
  if (has_decimal_comma && field.find(',') != std::string_view::npos) {
    buffer = field;
    std::replace(buffer.begin(), buffer.end(), ',', '.');
    field = buffer;
  }
  if (field.starts_with('+')) field.remove_prefix(1);
  double value = 0.0;
  const auto [end, status] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (status != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

bool begins_like_number(std::string_view field) {
  if (number_of(field, true)) return true; // also for "inf"
  if (!field.empty() && (field.front() == '+' || field.front() == '-')) field.remove_prefix(1);
  if (!field.empty() && (field.front() == '.' || field.front() == ',')) field.remove_prefix(1);
  return !field.empty() && field.front() >= '0' && field.front() <= '9';
}

// Kind of a field in the first row: a column name, a number, or without letters and digits.
enum class FirstField { name, number, nothing };

// Returns the number of bytes of the first character of `text` if it occurs in garbled numbers but not in names: dashes, blanks and digits
// beyond ASCII; 0 if there is none.
std::size_t strange_bytes_of_number(std::string_view text) {
  for (const std::string_view such :
       {"\xE2\x88\x92", "\xE2\x80", "\xEF\xBC", "\xC2\xA0", "\xD9"}) // −, dashes and thin blanks, full-width, blank, Arabic
    if (text.starts_with(such)) return such == "\xE2\x80" || such == "\xEF\xBC" ? 3 : such == "\xD9" ? 2 : such.size();
  return 0;
}

// Classifies a field of the first row. A name contains a letter other than that of an exponent. `is_doubtful` is set if a name could be a
// mistyped number ("O.25", "x0.1"): at most two letters, at least as many digits, and a point or comma.
FirstField first_field(std::string_view field, bool& is_doubtful) {
  std::size_t letters = 0, digits = 0, points = 0, strange = 0;
  bool has_exponent = false;
  for (std::size_t i = 0; i < field.size(); ++i) {
    const auto c = static_cast<unsigned char>(field[i]);
    const bool is_behind_digit = i > 0 && field[i - 1] >= '0' && field[i - 1] <= '9';
    if (const std::size_t count = strange_bytes_of_number(field.substr(i)); count > 0) ++strange, i += count - 1;
    else if (c >= '0' && c <= '9') ++digits;
    else if (c == '.' || c == ',') ++points;
    else if ((c == 'e' || c == 'E') && is_behind_digit && !has_exponent) has_exponent = true;
    else if (c >= 0x80 || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_') ++letters;
  }
  is_doubtful = letters <= 2 && digits >= letters && points > 0 && digits > 0;
  if (letters > 0) return FirstField::name;
  return digits + strange > 0 ? FirstField::number : FirstField::nothing;
}

// Returns the name without unit: "time [s]" → "time".
std::string column_name(std::string_view field) {
  const auto bracket = field.find('[');
  if (bracket != std::string_view::npos && bracket > 0) field = trimmed(field.substr(0, bracket));
  return std::string(field);
}

// Returns the unit in brackets: "time [s]" → "s"; "" if there is none.
std::string column_unit(std::string_view field) {
  const auto open = field.find('['), close = field.rfind(']');
  if (open == std::string_view::npos || open == 0 || close == std::string_view::npos || close < open) return {};
  return std::string(trimmed(field.substr(open + 1, close - open - 1)));
}

class CsvReader {
public:
  explicit CsvReader(const std::string& file) { table_.file = file; }

  CsvTable read(std::string_view text) {
    if (text.starts_with(k_byte_order_mark)) text.remove_prefix(k_byte_order_mark.size());
    while (!text.empty()) {
      const auto end = text.find('\n');
      ++line_;
      read_line(text.substr(0, end));
      text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    }
    if (table_.lines.empty()) throw ModelError({table_.file, 0, 0}, "the record holds no row of numbers");
    return std::move(table_);
  }

  CsvTable read_first_row(std::istream& lines) {
    for (std::string line; table_.columns.empty() && std::getline(lines, line);) {
      std::string_view text = line;
      if (++line_ == 1 && text.starts_with(k_byte_order_mark)) text.remove_prefix(k_byte_order_mark.size());
      if (is_skipped(text)) continue;
      begin_line(text);
      read_header();
    }
    return std::move(table_);
  }

private:
  static constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";

  static bool is_skipped(std::string_view line) { return trimmed(line).empty() || trimmed(line).front() == '#'; }

  void begin_line(std::string_view line) {
    if (delimiter_ == 0) delimiter_ = delimiter_of(line);
    split(line, delimiter_, fields_);
  }

  void read_line(std::string_view line) {
    if (is_skipped(line)) return;
    begin_line(line);
    if (table_.columns.empty() && read_header()) return;
    if (fields_.size() != table_.columns.size())
      fail("expected " + counted(table_.columns.size(), "column", "columns") + ", got " + std::to_string(fields_.size()));
    for (std::size_t i = 0; i < fields_.size(); ++i) table_.columns[i].push_back(value(i));
    table_.lines.push_back(line_);
  }

  // Reads the first row. Returns true if it contains column names. It counts as data if its first field begins like a number, or if no
  // field is a name. A mistyped number is therefore reported with its column, and the row is not lost as a row of names.
  bool read_header() {
    table_.columns.resize(fields_.size());
    if (begins_like_number(fields_.front())) return false;
    const std::string_view *name = nullptr, *number = nullptr;
    bool is_certain = false; // one of the fields is certainly a name
    for (const std::string_view& field : fields_) {
      bool is_doubtful = false;
      const FirstField kind = first_field(field, is_doubtful);
      const bool is_number = kind == FirstField::number || number_of(field, delimiter_ != ',').has_value(); // also for "inf"
      if (is_number && !number) number = &field;
      if (!is_number && kind == FirstField::name && !name) name = &field;
      is_certain = is_certain || (!is_number && kind == FirstField::name && !is_doubtful);
    }
    if (!is_certain && (!name || !number)) return false;
    if (number)
      fail("the first row holds both words and numbers: '" + std::string(*name) + "' in column " +
           std::to_string(name - &fields_.front() + 1) + ", '" + std::string(*number) + "' in column " +
           std::to_string(number - &fields_.front() + 1) +
           ". If it is data, correct the word; if it names the columns, take names that are not numbers");
    for (const std::string_view field : fields_) {
      table_.names.push_back(column_name(field));
      table_.units.push_back(column_unit(field));
    }
    return true;
  }

  double value(std::size_t column) {
    const std::string_view field = fields_[column];
    const std::optional<double> number = number_of(field, delimiter_ != ',');
    const std::string place = " in column " + std::to_string(column + 1);
    if (field.empty()) fail("no value" + place);
    if (!number) fail("'" + std::string(field) + "'" + place + " is not a number");
    if (!std::isfinite(*number)) fail("'" + std::string(field) + "'" + place + " is not finite");
    note_decimals(field, place);
    return *number;
  }

  // Checks that decimal marks are not mixed: "1,000" next to "0.5" may mean one thousand.
  void note_decimals(std::string_view field, const std::string& place) {
    if (delimiter_ == ',') return;
    const char mark = field.find(',') != std::string_view::npos ? ',' : field.find('.') != std::string_view::npos ? '.' : '\0';
    if (mark == '\0' || mark == decimal_) return;
    if (decimal_ != '\0')
      fail("'" + std::string(field) + "'" + place + " has a decimal " + (mark == ',' ? "comma" : "point") +
           ", and numbers before it have a " + (mark == ',' ? "point" : "comma") + ": write all of them alike");
    decimal_ = mark;
  }

  [[noreturn]] void fail(const std::string& message) const { throw ModelError({table_.file, line_, 1}, message); }

  CsvTable table_;
  std::vector<std::string_view> fields_;
  char delimiter_ = 0, decimal_ = '\0';
  int line_ = 0;
};

} // namespace

std::size_t CsvTable::column(const std::string& name_or_number, const Location& where) const {
  const auto found = std::find(names.begin(), names.end(), name_or_number);
  if (found != names.end() && std::find(found + 1, names.end(), name_or_number) != names.end())
    throw ModelError(where, "the record '" + file + "' has several columns '" + name_or_number + "': name one by its number, from \"1\"");
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  std::size_t number = 0;
  const char* end = name_or_number.data() + name_or_number.size();
  const auto [rest, status] = std::from_chars(name_or_number.data(), end, number);
  if (status == std::errc() && rest == end && number >= 1 && number <= columns.size()) return number - 1;
  throw ModelError(where, "the record '" + file + "' has no column '" + name_or_number + "'" + did_you_mean(name_or_number, names) +
                              "; it has " + counted(columns.size(), "column", "columns"));
}

CsvTable parse_csv(const std::string& text, const std::string& file_name) { return CsvReader(file_name).read(text); }

CsvTable read_csv(const std::string& path, const Location& where, const std::string& wanted) {
  return parse_csv(read_named_file(path, where, "the record ", wanted), path);
}

CsvTable read_csv_header(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  std::ifstream lines(path, std::ios::binary);
  try {
    return CsvReader(path).read_first_row(lines);
  } catch (const ModelError&) { // of the first row
    return {};
  }
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r#") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

namespace {

constexpr std::size_t k_most = 25; // bytes of the longest number with its comma: -1.2345678901234567e-308,

} // namespace

CsvText::CsvText(std::span<const std::string> names, std::size_t rows) {
  constexpr std::size_t k_usual_length = 20; // of a number and its comma
  text_.reserve(rows * names.size() * k_usual_length);
  for (const std::string& name : names) text_ += (text_.empty() ? "" : ",") + csv_field(name);
  text_ += '\n';
}

// Adds a row. A number that equals the one above it is copied from the text of the previous row, which is faster than formatting; this is
// frequent for modes, areas and bodies at rest.
void CsvText::add_row(std::span<const double> values) {
  const std::size_t before = text_.size();
  row_.resize(values.size() * k_most + k_number_room);
  char* at = row_.data();
  const bool has_last = last_.size() == values.size();
  if (!has_last) last_.assign(values.size(), {});
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto bits = std::bit_cast<std::uint64_t>(values[i]);
    Field& last = last_[i];
    const char* const begin = at;
    if (has_last && last.bits == bits) {
      std::memcpy(at, text_.data() + last.start, last.length);
      at += last.length;
    } else {
      at = write_number(at, values[i]);
      *at++ = ',';
      last.bits = bits;
      last.length = static_cast<std::size_t>(at - begin);
    }
    last.start = before + static_cast<std::size_t>(begin - row_.data());
  }
  if (!values.empty()) at[-1] = '\n';
  else *at++ = '\n';
  text_.append(row_.data(), at);
}

} // namespace steplap
