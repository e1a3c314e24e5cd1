#include "tools/steplap/schema.h"

#include "mbd/io/json_schema.h"
#include "tools/steplap/catalogue.h"

#include <ostream>

namespace steplap {

Command schema_command() {
  Command command;
  command.name = "schema";
  command.summary = "a JSON Schema of model files, for editors that complete and check TOML";
  command.examples = "  steplap schema > steplap.schema.json\n";
  command.run = [](Console& console) {
    console.out << json_schema(program_catalogue());
    return ExitCode::done;
  };
  return command;
}

} // namespace steplap
