// Records: tables of numbers as CSV. What was read is written and read again: the same numbers.
#include "tests/fuzz/fuzz.h"

#include "mbd/io/csv.h"

#include <cmath>

using namespace steplap;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const CsvTable table = parse_csv(std::string(data, data + size), "given.csv");
    std::vector<std::string> names = table.names;
    if (names.empty())
      for (std::size_t i = 0; i < table.columns.size(); ++i) names.push_back("c" + std::to_string(i));
    fuzz::require(names.size() == table.columns.size(), "as many names as columns");
    CsvText text(names);
    std::vector<double> row(table.columns.size());
    for (std::size_t k = 0; k < table.lines.size(); ++k) {
      for (std::size_t i = 0; i < row.size(); ++i) {
        fuzz::require(table.columns[i].size() == table.lines.size(), "columns of one length");
        row[i] = table.columns[i][k];
        fuzz::require(std::isfinite(row[i]), "finite numbers");
      }
      text.add_row(row);
    }
    // Names may need more than a reader of records understands (line breaks, delimiters): the numbers are held against.
    const std::string body = text.text().substr(text.text().find('\n', CsvText(names).text().size() - 1) + 1);
    fuzz::require(parse_csv(body, "written.csv").columns == table.columns, "numbers come back as they were");
  } catch (const ModelError& error) {
    fuzz::require_readable(error);
  }
  return 0;
}
