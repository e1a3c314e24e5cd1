// Determines delimiter, decimal sign and header lines of a table.
#include "transformer/recorder/fields.h"
#include "transformer/recorder/layout.h"
#include "transformer/recorder/record_error.h"
#include "transformer/recorder/time_text.h"

#include "mbd/base/shown_text.h"

#include <algorithm>
#include <map>

namespace steplap {

namespace {

using Fields = std::vector<std::string_view>;

bool is_number(std::string_view field) { return parse_number(field, '.') || parse_number(field, ','); }

bool is_stamp(std::string_view field) {
  const unsigned orders = possible_date_orders(field);
  for (const unsigned order : {unsigned{k_year_first}, unsigned{k_day_first}, unsigned{k_month_first}})
    if ((orders & order) && parse_stamp(field, order)) return true;
  return parse_stamp(field, k_year_first).has_value();
}

bool has_all_values(const Fields& fields) {
  return !fields.empty() &&
         std::all_of(fields.begin(), fields.end(), [](std::string_view f) { return is_number(f) || is_missing(f) || is_stamp(f); });
}

// Returns true if the line may be a row: not empty, not a comment, and beginning like a number or a quote.
bool may_be_row(std::string_view line) {
  line = trimmed_blanks(line);
  if (line.starts_with('"')) line.remove_prefix(1);
  return begins_like_number(line);
}

char choose_delimiter(const std::vector<HeaderLine>& head) {
  std::size_t rows = 0, tabs = 0, semicolons = 0, commas = 0, comma_rows = 0, blank_rows = 0;
  Fields fields;
  for (const HeaderLine& line : head) {
    if (!may_be_row(line.text)) continue;
    ++rows;
    tabs += line.text.find('\t') != std::string::npos;
    semicolons += line.text.find(';') != std::string::npos;
    commas += line.text.find(',') != std::string::npos;
    comma_rows += split_fields(line.text, ',', fields) && has_all_values(fields);
    static_cast<void>(split_fields(line.text, ' ', fields));
    blank_rows += fields.size() > 1 && has_all_values(fields);
    if (rows == 2000) break;
  }
  if (2 * tabs > rows) return '\t';
  if (2 * semicolons > rows) return ';';
  if (2 * commas > rows && (2 * comma_rows > rows || 2 * blank_rows <= rows)) return ',';
  return 2 * blank_rows > rows ? ' ' : ',';
}

// Evidence for the decimal sign, from the numbers in the head of the file.
struct DecimalSigns {
  std::size_t points = 0, commas = 0;
  std::size_t comma_line = 0, comma_column = 0, point_line = 0, point_column = 0; ///< position of the first comma and of the first point
  bool may_be_thousands = true;                                                   ///< every comma so far separates groups of three digits
};

bool is_in_thousands(std::string_view number) {
  if (number.starts_with('-') || number.starts_with('+')) number.remove_prefix(1);
  const auto first = number.find(',');
  if (first == 0 || first > 3 || number.front() == '0') return false;
  for (std::size_t at = first; at < number.size(); at += 4)
    if (number[at] != ',' || at + 4 > number.size() || (at + 4 < number.size() && number[at + 4] != ',')) return false;
  return true;
}

DecimalSigns decimal_signs(const std::vector<HeaderLine>& head, const TableShape& shape) {
  DecimalSigns signs;
  Fields fields;
  for (std::size_t i = shape.first_data; i < head.size() && i < shape.first_data + 4000; ++i) {
    if (is_comment(head[i].text, shape.delimiter) || !split_fields(head[i].text, shape.delimiter, fields)) continue;
    for (const std::string_view field : fields) {
      const bool has_point = field.find('.') != std::string_view::npos && parse_number(field, '.');
      const bool has_comma = field.find(',') != std::string_view::npos && (parse_number(field, ',') || is_in_thousands(field));
      const auto column = static_cast<std::size_t>(field.data() - head[i].text.data()) + 1;
      if (has_point && signs.points++ == 0) signs.point_line = head[i].number, signs.point_column = column;
      if (has_comma && signs.commas++ == 0) signs.comma_line = head[i].number, signs.comma_column = column;
      if (has_comma) signs.may_be_thousands &= is_in_thousands(field);
    }
  }
  return signs;
}

// Returns true if pairs of comma-separated fields could be numbers with a decimal comma.
bool may_be_pairs(const std::vector<HeaderLine>& head, const TableShape& shape) {
  Fields fields;
  std::size_t rows = 0;
  for (std::size_t i = shape.first_data; i < head.size() && rows < 200; ++i) {
    if (trimmed_blanks(head[i].text).empty() || is_comment(head[i].text, ',') || !split_fields(head[i].text, ',', fields) ||
        !looks_like_row(fields))
      continue;
    ++rows;
    if (fields.size() % 2 != 0) return false;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const bool is_digits = !fields[k].empty() && fields[k].find_first_not_of("0123456789") == std::string_view::npos;
      if (!(is_digits || (k % 2 == 0 && is_number(fields[k]) && fields[k].find_first_of(".eE") == std::string_view::npos))) return false;
    }
  }
  return rows > 0;
}

void settle_decimal(const std::vector<HeaderLine>& head, const std::string& file, const ReadOptions& options, TableShape& shape) {
  const std::size_t line = head[shape.first_data].number;
  const DecimalSigns signs = decimal_signs(head, shape);
  if (shape.delimiter == ',' && signs.commas == 0) { // if unquoted numbers contain no comma; otherwise numbers are quoted
    const bool may_join = may_be_pairs(head, shape);
    const bool is_as_named = !shape.names.empty() && shape.names.size() == shape.width;
    if (options.decimal == ',') {
      if (!may_join)
        throw RecordError(file, line, 1,
                          "The rows do not consist of numbers with a decimal comma, parted by commas. Give --decimal point, or export the "
                          "file with ';' between the columns.");
      shape.joins_pairs = true;
      shape.decimal = ',';
      shape.width /= 2;
    } else if (may_join && !is_as_named && options.decimal != '.') {
      throw RecordError(file, line, 1,
                        "A comma may part columns or be the decimal sign here: '" + shown(head[shape.first_data].text.substr(0, 40)) +
                            "'. Give --decimal comma or --decimal point.");
    }
    return;
  }
  shape.has_decimals = signs.points + signs.commas > 0;
  if (options.decimal) {
    shape.decimal = *options.decimal;
    shape.has_decimals = true;
    return;
  }
  if (signs.points > 0 && signs.commas > 0)
    throw RecordError(file, std::max(signs.comma_line, signs.point_line),
                      signs.comma_line > signs.point_line ? signs.comma_column : signs.point_column,
                      "Some numbers have a decimal point and some a comma. Give --decimal comma or --decimal point; numbers with the other "
                      "sign are then refused where they stand.");
  if (signs.commas > 0 && signs.may_be_thousands)
    throw RecordError(file, signs.comma_line, signs.comma_column,
                      "The comma may be the decimal sign or part thousands here. Give --decimal comma, or export the file without "
                      "separators of thousands.");
  shape.decimal = signs.commas > 0 ? ',' : '.';
}

bool is_units_row(const Fields& fields) {
  std::size_t units = 0;
  for (const std::string_view field : fields) {
    if (field.empty() || field == "-") continue;
    std::string_view bare = field;
    if (bare.size() > 2 && (bare.front() == '[' || bare.front() == '(')) bare = bare.substr(1, bare.size() - 2);
    if (!acceleration_unit(bare) && !time_unit(bare) && lower_case(bare).find_first_of("0123456789hyd%\xC2") == std::string::npos)
      return false;
    units += acceleration_unit(bare) || time_unit(bare);
  }
  return units > 0;
}

// Returns true if the fields are names of columns: words, none of which is a number. With blanks as delimiter a sentence looks similar, so
// half of the words must be known names.
bool is_names_row(const Fields& fields, char delimiter) {
  if (std::any_of(fields.begin(), fields.end(), [](std::string_view f) { return is_number(f) || is_stamp(f); })) return false;
  const auto known = static_cast<std::size_t>(
      std::count_if(fields.begin(), fields.end(), [](std::string_view f) { return role_of(heading_of(f).name).role != Role::other; }));
  return known > 0 && (delimiter != ' ' || 2 * known >= fields.size());
}

// Returns true if all fields are units and none names an axis or similar. Fields such as "s" can be a unit or a name.
bool are_only_units(const Fields& fields) {
  return is_units_row(fields) && std::all_of(fields.begin(), fields.end(), [](std::string_view f) {
           const Role role = role_of(heading_of(f).name).role;
           return role == Role::other || role == Role::time;
         });
}

// Removes the comment sign and the word "Headers": "; Headers, time, Ax", "; Time, Ax".
std::string uncommented(std::string_view line) {
  line = trimmed_blanks(line);
  while (!line.empty() && (line.front() == ';' || line.front() == '#' || line.front() == '*')) line.remove_prefix(1);
  line = trimmed_blanks(line);
  const std::string lower = lower_case(line.substr(0, 7));
  if (lower == "headers") line = trimmed_blanks(line.substr(7));
  if (lower == "headers" && (line.starts_with(',') || line.starts_with(':') || line.starts_with(';'))) line.remove_prefix(1);
  return std::string(trimmed_blanks(line));
}

void take_names(const Fields& fields, std::vector<std::string>& texts) {
  texts.clear();
  for (const std::string_view field : fields) texts.emplace_back(field);
}

// Searches names and units of columns in the last lines before the data, or in the last comments.
void find_names(const std::vector<HeaderLine>& head, const std::string& file, std::size_t row_width, TableShape& shape) {
  Fields fields;
  for (const bool in_comments : {false, true})
    for (std::size_t back = 1; back <= shape.first_data && shape.names.empty(); ++back) {
      const HeaderLine& line = head[shape.first_data - back];
      const bool is_beside = is_comment(line.text, shape.delimiter);
      if (trimmed_blanks(line.text).empty() || is_beside != in_comments) continue;
      const std::string text = is_beside ? uncommented(line.text) : line.text;
      if (!split_fields(text, shape.delimiter, fields) || fields.empty()) continue;
      const std::size_t numbers = static_cast<std::size_t>(std::count_if(fields.begin(), fields.end(), is_number));
      const bool is_key =
          // a line such as "Rate: 100 Hz"
          !begins_like_number(fields.front()) && fields.front().find_first_of(":=") != std::string_view::npos;
      if (!in_comments && back == 1 && !is_key && numbers > 0 && 2 * (numbers + 1) >= fields.size() && fields.size() >= row_width)
        throw RecordError(file, line.number, 1,
                          "This line before the first row holds both words and numbers: '" + shown(line.text.substr(0, 40)) +
                              "'. If it is a row, correct the word in it; if it names columns, take names that are not numbers.");
      if (fields.size() > 1 && shape.units_line == 0 && are_only_units(fields)) {
        take_names(fields, shape.units);
        std::replace(shape.units.begin(), shape.units.end(), std::string("-"), std::string());
        shape.units_line = line.number;
      } else if (is_names_row(fields, shape.delimiter) && (fields.size() >= row_width || fields.size() > 1 || row_width == 1)) {
        take_names(fields, shape.names);
        shape.names_line = line.number;
      } else if (!in_comments && shape.units_line == 0) {
        break; // names directly precede the data, so the search ends at any other line
      }
    }
}

// Returns the number of fields of the longest rows. Some recorders add columns without a name, for slow sensors, to some of their rows. A
// single long row may be two joined rows and is ignored.
std::size_t most_fields(const std::vector<HeaderLine>& head, const TableShape& shape) {
  constexpr std::size_t k_regular = 3; // least number of long rows that count
  std::map<std::size_t, std::size_t> rows_with;
  Fields fields;
  for (std::size_t i = shape.first_data; i < head.size(); ++i)
    if (!is_comment(head[i].text, shape.delimiter) && split_fields(head[i].text, shape.delimiter, fields) && looks_like_row(fields))
      ++rows_with[fields.size()];
  std::size_t most = shape.width;
  for (const auto& [count, rows] : rows_with)
    if (rows >= k_regular) most = std::max(most, count);
  return most;
}

bool leaves_columns_unnamed(const std::vector<HeaderLine>& head, const TableShape& shape) {
  return !shape.names.empty() &&
         family_of({head.begin(), head.begin() + static_cast<std::ptrdiff_t>(shape.first_data)}) == "Gulf Coast Data Concepts";
}

// Returns the line after the mark of files in blocks, for example "*DATA"; 0 without a mark.
std::size_t begin_of_data(const std::vector<HeaderLine>& head) {
  for (std::size_t i = 0; i < head.size(); ++i)
    if (lower_case(trimmed_blanks(head[i].text)) == "*data") return i + 1;
  return 0;
}

// Returns true if a line such as the start date, which looks like a row, is followed by the names of columns.
bool is_before_names(const std::vector<HeaderLine>& head, const std::string& file, std::size_t row, const TableShape& shape) {
  Fields fields;
  const auto has_names = [&](std::size_t i) {
    return !is_comment(head[i].text, shape.delimiter) && split_fields(head[i].text, shape.delimiter, fields) &&
           is_names_row(fields, shape.delimiter);
  };
  for (std::size_t i = 0; i < row; ++i)
    if (has_names(i) || (is_comment(head[i].text, shape.delimiter) && split_fields(uncommented(head[i].text), shape.delimiter, fields) &&
                         is_names_row(fields, shape.delimiter)))
      return false;
  for (std::size_t i = row + 1, seen = 0; i < head.size() && seen < 4; ++i) {
    seen += !trimmed_blanks(head[i].text).empty();
    if (!has_names(i)) continue;
    if (fields.size() > shape.width) return true;
    throw RecordError(file, head[row].number, 1,
                      "This row stands before line " + std::to_string(head[i].number) +
                          ", which names the columns. Take it out, or put the line with the names before it.");
  }
  return false;
}

} // namespace

bool TableShape::split(std::string_view line, std::vector<std::string_view>& fields) const {
  if (!split_fields(line, delimiter, fields)) return false;
  if (!joins_pairs) return true;
  if (fields.size() % 2 != 0) return false;
  for (std::size_t i = 0; 2 * i < fields.size(); ++i) {
    const std::string_view whole = fields[2 * i], rest = fields[2 * i + 1];
    fields[i] = {whole.data(), static_cast<std::size_t>(rest.data() + rest.size() - whole.data())};
  }
  fields.resize(fields.size() / 2);
  return true;
}

bool looks_like_row(const std::vector<std::string_view>& fields) {
  if (fields.empty()) return false;
  std::size_t values = 0, numbers = 0;
  for (const std::string_view field : fields) {
    const bool is_value = is_number(field), is_instant = !is_value && is_stamp(field);
    numbers += is_value || is_instant;
    values += is_value || is_instant || is_missing(field);
  }
  const bool begins = begins_like_number(fields.front()) || is_missing(fields.front()) || is_stamp(fields.front());
  return numbers > 0 && begins && 2 * values >= fields.size();
}

TableShape find_shape(const std::vector<HeaderLine>& head, const std::string& file, const ReadOptions& options) {
  TableShape shape;
  shape.delimiter = options.delimiter.value_or(choose_delimiter(head));
  Fields fields;
  const auto is_row = [&](std::size_t i) {
    return !is_comment(head[i].text, shape.delimiter) && split_fields(head[i].text, shape.delimiter, fields) && looks_like_row(fields);
  };
  std::size_t first = begin_of_data(head);
  for (bool is_found = false; first < head.size(); ++first) {
    if (!is_row(first)) continue;
    shape.width = fields.size();
    std::size_t seen = 0, rows = 0;
    for (std::size_t i = first + 1; i < head.size() && seen < 4; ++i) {
      if (trimmed_blanks(head[i].text).empty() || is_comment(head[i].text, shape.delimiter)) continue;
      ++seen;
      rows += is_row(i);
    }
    is_found = 2 * rows >= seen && !is_before_names(head, file, first, shape);
    if (is_found) break;
  }
  if (first >= head.size())
    throw RecordError(file, head.empty() ? 0 : head.back().number, head.empty() ? 0 : 1,
                      head.empty() ? "The file is empty. Copy it again from the recorder."
                                   : "No row of numbers was found up to here. If the file is a recorder's own binary format, export it as "
                                     "CSV; if another sign parts the columns, give --delimiter.");
  shape.first_data = first;
  static_cast<void>(split_fields(head[first].text, shape.delimiter, fields));
  // Omits empty fields after delimiters at the end of rows.
  while (shape.width > 1 && fields.back().empty()) fields.pop_back(), --shape.width;
  find_names(head, file, shape.width, shape);
  settle_decimal(head, file, options, shape);
  if (!shape.names.empty()) {
    while (shape.names.size() > shape.width && shape.names.back().empty()) shape.names.pop_back();
    if (shape.names.size() < shape.width && !leaves_columns_unnamed(head, shape))
      throw RecordError(file, head[first].number, 1,
                        "This row has " + counted(shape.width, "field", "fields") + ", but line " + std::to_string(shape.names_line) +
                            " names " + counted(shape.names.size(), "column", "columns") +
                            ". If the comma is the decimal sign, give --decimal comma; else correct the header.");
    shape.width = shape.names.size();
  }
  shape.most_fields = leaves_columns_unnamed(head, shape) ? most_fields(head, shape) : shape.width;
  return shape;
}

} // namespace steplap
