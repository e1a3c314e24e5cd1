#include "tools/steplap/commands.h"

#include "mbd/base/diagnostics.h"
#include "mbd/io/reference.h"
#include "tools/steplap/text_table.h"
#include "transformer/program.h"

#include <memory>
#include <ostream>

namespace steplap {

namespace {

struct ElementsOptions {
  std::string kind;
  bool is_markdown = false, is_example = false;
};

// Prints rows, the first of which contains the heads.
void print_rows(std::ostream& out, const std::string& name, const ReferenceRows& rows) {
  TextTable table(std::vector<TextTable::Align>(rows.front().size(), TextTable::Align::left));
  table.set_head(name, rows.front());
  for (std::size_t i = 1; i < rows.size(); ++i) table.add_row(TextTable::Row(rows[i].begin(), rows[i].end()));
  out << table;
}

void print_kind(std::ostream& out, const KindReference& kind) {
  out << kind.heading << "\n" << kind.doc << "\n\n";
  print_rows(out, "fields", kind.fields);
  if (!kind.channels.empty()) {
    out << "\n";
    print_rows(out, "channels", kind.channels);
  }
  if (!kind.example.empty()) out << "\nExample:\n" << kind.example;
}

void print_kinds(std::ostream& out, const std::string& name) {
  const char* separator = "";
  for (const KindReference& kind : kind_references(program_catalogue(), name)) {
    out << separator;
    print_kind(out, kind);
    separator = "\n";
  }
}

void print_named(const ElementsOptions& options, std::ostream& out) {
  try {
    if (options.is_example) {
      out << example_model(program_catalogue(), options.kind);
    } else {
      print_kinds(out, options.kind);
    }
  } catch (const ModelError& error) {
    throw UsageError(error.diagnostics().front().message);
  }
}

ExitCode print_reference(const ElementsOptions& options, Console& console) {
  if (options.is_example && options.kind.empty())
    throw UsageError("--example needs a kind of element, such as: steplap elements rope --example");
  if (options.is_markdown) {
    console.out << reference_markdown(program_catalogue());
  } else if (options.kind.empty()) {
    print_rows(console.out, "kinds", kinds_rows(program_catalogue()));
  } else {
    print_named(options, console.out);
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
  steplap elements rope --example > rope.toml
  steplap elements --markdown > reference.md
)";
  command.options = {{"KIND", &o->kind, "KIND", "a kind of element or signal, body, marker, simulation, output, model"},
                     {"--example", &o->is_example, "", "a whole model with an element of the kind"},
                     {"--markdown", &o->is_markdown, "", "the whole reference in Markdown"}};
  command.prints_tables = true;
  command.run = [o](Console& console) { return print_reference(*o, console); };
  return command;
}

} // namespace steplap
