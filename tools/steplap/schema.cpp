#include "tools/steplap/commands.h"

#include "mbd/io/json_schema.h"
#include "tools/steplap/study.h"
#include "transformer/program.h"

#include <memory>
#include <ostream>

namespace steplap {

Command schema_command() {
  const auto is_study = std::make_shared<bool>(false);
  Command command;
  command.name = "schema";
  command.summary = "a JSON Schema of model files, for editors that complete and check TOML";
  command.examples = "  steplap schema > steplap.schema.json\n  steplap schema --study > study.schema.json\n";
  command.options = {{"--study", is_study.get(), "", "of study files instead"}};
  command.run = [is_study](Console& console) {
    if (*is_study) return static_cast<ExitCode>(run_study_program({"schema"}));
    console.out << json_schema(program_catalogue());
    return ExitCode::done;
  };
  return command;
}

} // namespace steplap
