#include "tools/steplap/elements.h"

#include "mbd/base/diagnostics.h"
#include "mbd/io/reference.h"
#include "run/catalogue.h"

#include <memory>
#include <ostream>

namespace steplap {

namespace {

struct ElementsOptions {
  std::string kind;
  bool is_markdown = false;
};

ExitCode print_reference(const ElementsOptions& options, Console& console) {
  if (options.is_markdown) {
    console.out << reference_markdown(program_catalogue());
  } else if (options.kind.empty()) {
    console.out << kinds_text(program_catalogue());
  } else {
    try {
      console.out << kind_text(program_catalogue(), options.kind);
    } catch (const ModelError& error) {
      throw UsageError(error.diagnostics().front().message);
    }
  }
  return ExitCode::done;
}

} // namespace

Command elements_command() {
  const auto o = std::make_shared<ElementsOptions>();
  Command command;
  command.name = "elements";
  command.summary = "what a model file may contain: all kinds, or the fields of one";
  command.examples = R"(  steplap elements
  steplap elements unilateral_contact
  steplap elements simulation
  steplap elements --markdown > reference.md
)";
  command.options = {
      {"KIND", &o->kind, "KIND", "a kind of element or signal, body, marker, simulation, output, model"},
      {"--markdown", &o->is_markdown, "", "the whole reference in Markdown"}};
  command.run = [o](Console& console) { return print_reference(*o, console); };
  return command;
}

} // namespace steplap
