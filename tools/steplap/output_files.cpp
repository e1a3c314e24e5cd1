#include "tools/steplap/output_files.h"

#include "mbd/io/atomic_file.h"
#include "tools/steplap/json_screen.h"

#include <algorithm>
#include <ostream>

namespace steplap {

namespace {

// Counts how often the value is "-".
struct CountStandard {
  std::size_t operator()(const bool*) const { return 0; }
  std::size_t operator()(const std::string* value) const { return is_standard_output(*value) ? 1 : 0; }
  std::size_t operator()(const std::optional<std::string>* value) const { return *value && is_standard_output(**value) ? 1 : 0; }
  std::size_t operator()(const std::vector<std::string>* values) const {
    return static_cast<std::size_t>(std::count_if(values->begin(), values->end(), is_standard_output));
  }
};

bool has_json(const Command& command) {
  return command.prints_tables ||
         std::any_of(command.options.begin(), command.options.end(), [](const Option& option) { return option.names == "--json"; });
}

} // namespace

void refuse_wrong_streams(const Command& command) {
  std::size_t read = 0;
  for (const Option& option : command.options) {
    const std::size_t count = std::visit(CountStandard{}, option.target);
    if (count == 0) continue;
    const bool is_positional = option.names.front() != '-', is_folder = option.value_name == "DIR", is_store = option.value_name == "STORE";
    if (is_positional && is_folder)
      throw UsageError(option.names +
                       " '-': the results of a run are a folder of files, which the standard input cannot be: name the folder");
    if (is_folder || is_store)
      throw UsageError(option.names.substr(0, option.names.find(',')) + " -: what is written there is " +
                       (is_folder ? "a folder of files" : "a file that is read and written in many places") +
                       ", which the standard output cannot be: give it a name" +
                       (has_json(command) ? "; --json writes what was found to the standard output" : ""));
    if (is_positional) read += count;
  }
  if (read > 1) throw UsageError("'-' is given " + std::to_string(read) + " times: the standard input can be read only once");
}

OutputFiles::OutputFiles(Console& console, std::initializer_list<OutputFile> files, bool is_overwriting)
    : console_(console), is_overwriting_(is_overwriting), may_print_(console.verbosity != Verbosity::quiet) {
  const char* taken = nullptr;
  for (const OutputFile& file : files) {
    if (!file.path || !is_standard_output(*file.path)) continue;
    if (taken) throw UsageError(std::string(taken) + " - and " + file.option + " -: the standard output can hold one file only");
    if (json_screen(console.out))
      throw UsageError(std::string(file.option) + " - and --json: the standard output can hold one of them only");
    taken = file.option;
    may_print_ = false;
  }
}

void OutputFiles::write(const std::optional<std::string>& path, const std::string& content) const {
  if (!path) return;
  if (is_standard_output(*path)) console_.out << content;
  else write_file(*path, content, is_overwriting_ ? IfExists::replace : IfExists::refuse);
}

} // namespace steplap
