// --json: what a command would write on the screen, for programs.
//
//   {"program": "steplap", "version": "0.1.0", "command": "check", "results": [
//     {"about": "my.toml", "text": ["my.toml: fine"], "tables": {"contacts": [{"contact": "foot", "force": {"value": 12, "unit": "N"}}]}}],
//    "exit_code": 0}
//
// A table with a head is a list of objects, one for each row; a table without is one object of its pairs. Numbers are SI with all
// digits: a plain number without a unit, else {"value", "unit"} and "error" where it was estimated. What is no number is text, null where the
// number is missing. "text" holds the lines that people read beside the tables.
#pragma once

#include "run/ordered_json.h"
#include "tools/steplap/text_table.h"

#include <sstream>

namespace steplap {

/// A stream for a command to write on.
class JsonScreen : public std::ostringstream, public TableSink {
public:
  void begin(const About& about) override;
  void take(const TextTable& table) override;
  /// A document of the result's own, besides its tables.
  void put(const std::string& name, OrderedJson document);
  /// All that was written.
  [[nodiscard]] std::string document(const std::string& program, const std::string& command, int exit_code);

private:
  OrderedJson& result();
  void keep_text();

  OrderedJson results_ = OrderedJson::array();
};

/// The stream as such a screen; nullptr if people read it.
[[nodiscard]] JsonScreen* json_screen(std::ostream& stream);

} // namespace steplap
