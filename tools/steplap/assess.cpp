#include "tools/steplap/assess.h"

#include "tools/steplap/static_proof.h"

#include <memory>

namespace steplap {

Command assess_command() {
  const auto o = std::make_shared<StaticProofArguments>();
  Command command;
  command.name = "assess";
  command.summary = "what loads do to a machine: a static proof";
  command.examples = R"(  steplap assess --static iec-1g models/paper/interference.toml
  steplap assess --static road --plane lengthwise models/paper/interference.toml -o out/road
Exit code 0: the machine is proven to hold; 5: it is not; 4: the verdict is open, or nothing could be computed.
)";
  command.options = {{"MODEL", &o->models, "FILE", "model files (TOML)", true},
                     {"--set", &o->overrides, "PATH=VALUE", "lay a value over the model; may be repeated"},
                     {"-o,--output", &o->output, "DIR", "write static.json there"},
                     {"--json", &o->is_json, "", "print the result as JSON"},
                     {"-f,--force", &o->is_overwriting, "", "overwrite earlier results"}};
  for (Option& option : static_proof_options(*o)) command.options.push_back(std::move(option));
  command.run = [o](Console& console) {
    if (!o->preset) throw UsageError("say by which loads: --static iec-1g, road, sea or a file of your own");
    return prove_statically(*o, console);
  };
  return command;
}

} // namespace steplap
