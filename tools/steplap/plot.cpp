#include "tools/steplap/commands.h"

#include "mbd/base/diagnostics.h"
#include "mbd/io/atomic_file.h"
#include "tools/pages/figure.h"
#include "tools/steplap/output_files.h"

#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <ostream>

namespace steplap {

namespace {

namespace fs = std::filesystem;

struct PlotOptions {
  std::vector<std::string> results, channels, plots;
  std::string output;
  bool is_beside = false, is_overwriting = false;
};

// Figure as requested on the command line, before the runs have been read.
struct FigureRequest {
  std::string title;
  std::vector<std::string> channels, bounds;
};

std::vector<FigureRequest> plots_of_model(const Results& run, const std::vector<std::string>& names) {
  const auto drawing = nlohmann::json::parse(run.drawing, nullptr, false);
  if (drawing.is_discarded()) throw UsageError("'" + run.folder + "/drawing.json' is not as steplap wrote it: run the model again");
  std::vector<FigureRequest> wanted;
  std::vector<std::string> known;
  for (const auto& plot : drawing["plots"]) known.push_back(plot["name"]);
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) throw UsageError("the model of '" + run.folder + "' has no plot '" + name + "'" + did_you_mean(name, known));
    const auto& plot = drawing["plots"][static_cast<std::size_t>(found - known.begin())];
    const std::string title = plot["title"];
    wanted.push_back({name + (title.empty() ? "" : ": " + title), plot["channels"], plot["bounds"]});
  }
  return wanted;
}

std::vector<const ResultChannel*> asked_channels(const Results& run, const std::string& pattern) {
  const std::vector<const ResultChannel*> found = matching_channels(run, pattern);
  if (!found.empty()) return found;
  std::vector<std::string> known;
  for (const ResultChannel& channel : run.channels) known.push_back(channel.name);
  throw UsageError("'" + run.folder + "': no channel matches '" + pattern + "'" + did_you_mean(pattern, known));
}

void add_curves(const Results& run, const std::string& suffix, int dash, const FigureRequest& wanted, Panel& panel) {
  int colour = 0;
  const auto add = [&](const ResultChannel& channel, const std::string& label, int its_colour, int its_dash, double sign) {
    if (!panel.curves.empty() && channel.unit != panel.unit)
      throw UsageError("'" + channel.name + "' is in '" + channel.unit + "', the channels before it in '" + panel.unit +
                       "': plot them apart");
    panel.unit = channel.unit;
    panel.curves.push_back({label, &run.times, &channel.values, its_colour, its_dash, sign});
  };
  for (const std::string& pattern : wanted.channels)
    for (const ResultChannel* channel : asked_channels(run, pattern)) add(*channel, channel->name + suffix, colour++, dash, 1.0);
  for (const std::string& bound : wanted.bounds)
    for (const ResultChannel* channel : asked_channels(run, bound)) {
      add(*channel, "± " + channel->name + suffix, 6, 2, 1.0);
      add(*channel, "", 6, 2, -1.0);
    }
}

Figure figure_of(const std::vector<Results>& runs, const std::vector<FigureRequest>& figures, bool is_beside) {
  Figure figure;
  figure.columns = is_beside ? static_cast<int>(runs.size()) : 1;
  for (const FigureRequest& wanted : figures) {
    Panel all{wanted.title, "", {}};
    for (std::size_t r = 0; r < runs.size(); ++r) {
      Panel own{wanted.title + " (" + runs[r].name + ")", "", {}};
      const bool is_named = runs.size() > 1 && !is_beside;
      add_curves(runs[r], is_named ? ", " + runs[r].name : "", is_beside ? 0 : static_cast<int>(r), wanted, is_beside ? own : all);
      if (is_beside) figure.panels.push_back(std::move(own));
    }
    if (!is_beside) figure.panels.push_back(std::move(all));
  }
  return figure;
}

std::string shell_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

// A temporary folder for script and image, removed at the end.
class TemporaryFolder {
public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "steplap-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw FileError(name, "cannot write to '" + fs::temp_directory_path().string() + "'");
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (path_ / name).string(); }

private:
  fs::path path_;
};

std::string drawn(const Figure& figure, const std::string& ending, const std::string& output) {
  const TemporaryFolder scratch;
  const std::string image = scratch.at("image"), script = scratch.at("script");
  write_file(script, gnuplot_script(figure, ending, image));
  const int status =
      std::system(("gnuplot " + shell_quoted(script) + " >" + shell_quoted(scratch.at("said")) + " 2>&1").c_str()); // NOLINT: quoted
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == 127) throw UsageError("gnuplot is not there: install it (Debian: apt-get install gnuplot-nox)");
  if (code != 0 || !fs::exists(image)) throw FileError(output, "gnuplot could not draw '" + output + "': " + read_text(scratch.at("said")));
  return read_text(image);
}

ExitCode plot(const PlotOptions& options, Console& console) {
  const OutputFiles files(console, {{"-o", options.output}}, options.is_overwriting);
  const std::string ending = is_standard_output(options.output) ? ".svg" : fs::path(options.output).extension().string();
  if (ending != ".svg" && ending != ".png" && ending != ".pdf")
    throw UsageError("-o '" + options.output + "': the file must end in .svg, .png or .pdf, or be -, the standard output");
  if (options.channels.empty() == options.plots.empty()) throw UsageError("say what to plot: either --channels or --plot");
  std::vector<Results> runs;
  for (const std::string& folder : options.results) runs.push_back(read_results(folder));
  std::vector<FigureRequest> figures{{"", options.channels, {}}};
  if (!options.plots.empty()) figures = plots_of_model(runs.front(), options.plots);
  files.write(options.output, drawn(figure_of(runs, figures, options.is_beside), ending.substr(1), options.output));
  if (files.may_print()) console.out << "Written to " << options.output << "\n";
  return ExitCode::done;
}

} // namespace

Command plot_command() {
  const auto o = std::make_shared<PlotOptions>();
  Command command;
  command.name = "plot";
  command.summary = "time histories of runs as an image, drawn by gnuplot";
  command.examples = R"(  steplap plot out/my --channels "*foot.force" -o feet.svg
  steplap plot out/paper/no_interference out/paper/interference --plot "Fig. 6" --beside -o friction.png
Channels may be patterns with * and ?; all of one image are of one unit. Several --plot come one below
the other.
)";
  command.options = {{"RESULT", &o->results, "DIR", "folders of runs", true},
                     {"--channels", &o->channels, "PATTERN", "channels to plot"},
                     {"--plot", &o->plots, "NAME", "a [[plot]] of the model; may be repeated"},
                     {"-o,--output", &o->output, "FILE", "the image: .svg, .png or .pdf; - is the standard output, as SVG", true},
                     {"--beside", &o->is_beside, "", "runs side by side instead of in one panel"},
                     {"-f,--force", &o->is_overwriting, "", "overwrite an earlier image"}};
  command.run = [o](Console& console) { return plot(*o, console); };
  return command;
}

} // namespace steplap
