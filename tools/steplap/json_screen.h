// Option --json: writes the output of a command as JSON.
//
//   {"program": "steplap", "version": "0.1.0", "command": "check", "results": [
//     {"about": "my.toml", "text": ["my.toml: fine"], "tables": {"contacts": [{"contact": "foot", "force": {"value": 12, "unit": "N"}}]}}],
//    "exit_code": 0}
//
// A table with column heads becomes a list of objects, one per row; a table without heads becomes one object. Numbers are SI with all
// digits: a plain number if it has no unit, otherwise {"value", "unit"}, with "error" if it was estimated. Other cells are text, or null
// for a missing number. "text" contains the lines outside tables.
#pragma once

#include "mbd/run/ordered_json.h"
#include "tools/steplap/text_table.h"

#include <sstream>

namespace steplap {

/// Output stream that collects a command's lines and tables and returns them as one JSON document.
class JsonScreen : public std::ostringstream, public TableSink {
public:
  void begin(const About& about) override;
  void take(const TextTable& table) override;
  /// Adds a JSON document to the result of the present subject, in addition to its tables.
  void put(const std::string& name, OrderedJson document);
  /// Returns the whole output as JSON text.
  [[nodiscard]] std::string document(const std::string& program, const std::string& command, int exit_code);

private:
  OrderedJson& result();
  void keep_text();

  OrderedJson results_ = OrderedJson::array();
};

/// Returns the stream as a JsonScreen; nullptr if it is an ordinary text stream.
[[nodiscard]] JsonScreen* json_screen(std::ostream& stream);

} // namespace steplap
