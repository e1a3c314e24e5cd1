#include "tools/steplap/commands.h"

#include "mbd/base/name_pattern.h"
#include "mbd/io/csv.h"
#include "mbd/run/run.h"
#include "mbd/system/requested_channels.h"
#include "tools/steplap/output_files.h"
#include "tools/steplap/text_table.h"
#include "transformer/program.h"

#include <algorithm>
#include <memory>
#include <ostream>
#include <unordered_set>

namespace steplap {

namespace {

using Align = TextTable::Align;

struct ChannelsOptions {
  std::string model;
  std::vector<std::string> overrides, patterns;
  std::optional<std::string> output;
  bool is_overwriting = false;
};

struct ListedChannel {
  const Channel* channel;
  const char* made; ///< "written", "not written" or "on request"
};

std::vector<ListedChannel> list_channels(const LoadedModel& loaded, const System& all, const std::vector<std::string>& patterns) {
  const Trajectory trajectory(*loaded.system, loaded.model.output.channels);
  std::unordered_set<std::string> made, written;
  for (const Channel& channel : loaded.system->channels) made.insert(channel.name);
  for (const Channel* channel : trajectory.channels()) written.insert(channel->name);
  std::vector<ListedChannel> list;
  for (const Channel& channel : all.channels) {
    const auto matches = [&](const std::string& pattern) { return matches_pattern(channel.name, pattern); };
    if (!patterns.empty() && std::none_of(patterns.begin(), patterns.end(), matches)) continue;
    const bool is_written = written.contains(channel.name), is_made = made.contains(channel.name);
    list.push_back({&channel, is_written ? "written" : is_made ? "not written" : "on request"});
  }
  return list;
}

std::string table_csv(const std::vector<ListedChannel>& list) {
  std::string text = "channel,unit,made,sign,meaning,codes\n";
  for (const ListedChannel& each : list) {
    const Channel& c = *each.channel;
    const std::string made = each.made;
    for (const std::string* cell : {&c.name, &c.unit, &made, &c.sign, &c.doc}) text += csv_field(*cell) + ",";
    text += csv_field(c.codes) + "\n";
  }
  return text;
}

void print_channels(std::ostream& out, const LoadedModel& loaded, const std::vector<ListedChannel>& list) {
  TextTable table({Align::left, Align::left, Align::left, Align::left, Align::left});
  table.set_head("channels", {"channel", "unit", "made", "sign", "meaning"});
  bool is_any_on_request = false;
  for (const ListedChannel& each : list) {
    const Channel& c = *each.channel;
    is_any_on_request |= std::string_view(each.made) == "on request";
    table.add_row({c.name, c.unit.empty() ? "-" : c.unit, each.made, c.sign, c.codes.empty() ? c.doc : c.doc + ": " + c.codes});
  }
  out << About{loaded.path} << loaded.name << ": " << list.size() << " channels\n\n" << table;
  if (is_any_on_request)
    out << "\nThose on request are made if [output] names them: also = [\"" << list.back().channel->name << "\"]; patterns with * and ?\n";
}

ExitCode channels(const ChannelsOptions& options, Console& console) {
  const OutputFiles files(console, {{"-o", options.output}}, options.is_overwriting);
  const auto loaded = load_model(options.model, options.overrides);
  const std::unique_ptr<System> all = compile_with_all_channels(loaded->model);
  const std::vector<ListedChannel> list = list_channels(*loaded, *all, options.patterns);
  if (list.empty()) {
    std::vector<std::string> known;
    for (const Channel& channel : all->channels) known.push_back(channel.name);
    throw UsageError("no channel matches '" + options.patterns.front() + "'" + did_you_mean(options.patterns.front(), known));
  }
  files.write(options.output, table_csv(list));
  if (files.may_print()) print_channels(console.out, *loaded, list);
  return ExitCode::done;
}

} // namespace

Command channels_command() {
  const auto o = std::make_shared<ChannelsOptions>();
  Command command;
  command.name = "channels";
  command.summary = "the channels of a model, each with unit, sign, meaning and codes; those on request, too";
  command.examples = R"(  steplap channels my.toml
  steplap channels my.toml --only "elbow.*"
  steplap channels my.toml -o channels.csv
What formulas of channels may hold, and how to ask for channels: docs/reference/channels.md.
)";
  command.options = {
      {"MODEL", &o->model, "FILE", "model file (TOML); - is the standard input", true},
      {"--only", &o->patterns, "PATTERN", "those that match, * and ?; may be repeated"},
      {"-o,--output", &o->output, "FILE", "also write the list as CSV; - is the standard output, which then holds nothing else"},
      {"--set", &o->overrides, "PATH=VALUE", "lay a value over the model; may be repeated"},
      {"-f,--force", &o->is_overwriting, "", "overwrite the file"}};
  command.prints_tables = true;
  command.run = [o](Console& console) { return channels(*o, console); };
  return command;
}

} // namespace steplap
