// Models changed at random (mutation.h), each run for 0.02 s, in a process that another one watches.
//   mutated_models COUNT SEED [OPTION…] FILE_OR_FOLDER…              runs COUNT cases, prints those that crash or hang
//   mutated_models --show NUMBER SEED FILE_OR_FOLDER…                prints the text of one, for its model's folder
//   mutated_models --times 0 SEED FILE_OR_FOLDER…                    what each file costs as it is, in ms of a processor
// Options: --first NUMBER of the cases; --limit SECONDS of a processor that one may take, 10; --evaluations COUNT, or so many events, after
// which a run is left (0, as without it: none is); --whole NUMBER: one in so many cases is not left, and goes the whole way of `steplap
// simulate`: findings, extremes, errors by finer runs, summary.json; --said FILE, to which the counts so far are written now and then.
// An answer is a run, an error of the model, a numerical failure or, from a whole run, the stop that it is asked for after half the limit,
// which is printed. Everything else is a finding: signals, other exceptions, memory beyond 2 GB, and more than the limit of a processor.
// Exit code 1 if there was a crash; hangs are printed to be explained.
#include "mbd/base/budget.h"
#include "mbd/base/diagnostics.h"
#include "mbd/io/presentation.h"
#include "mbd/io/reader.h"
#include "mbd/rest/assembly.h"
#include "mbd/rest/equilibrium.h"
#include "mbd/run/findings.h"
#include "mbd/run/report.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judge.h"
#include "tests/fuzz/mutation.h"
#include "tests/sanitized.h"
#include "transformer/program.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace steplap;
namespace fs = std::filesystem;

namespace {

constexpr double k_run = 0.02;                       // s of simulated time
constexpr std::uint64_t k_memory = 2'000'000'000ULL; // bytes
constexpr double k_stops_at = 0.5;                   // share of the limit after which a whole run is asked to stop

struct Options {
  std::uint64_t count = 0, seed = 1, first = 0;
  unsigned limit = 10;     // s of a processor
  long evaluations = 0;    // after which a run is left; 0: none is
  std::uint64_t whole = 0; // one in so many cases goes the whole way; 0: none
  std::string said;        // file for the counts so far
  bool shows = false, times = false;
  std::vector<fs::path> files;

  [[nodiscard]] bool is_whole(std::uint64_t number) const { return whole > 0 && number % whole == 0; }
};

struct Cases {
  struct Source {
    fs::path file;
    std::string text;
  };
  std::vector<Source> sources;
  std::size_t refused =
      0; // the last so many sources are no models as they are (studies, a fuzzer's corpus): one case in ten is made of them
  std::uint64_t seed = 1;

  [[nodiscard]] const Source& source_of(std::uint64_t number) const {
    const std::size_t models = sources.size() - refused;
    if (models == 0 || (refused > 0 && fuzz::drawn(10, seed, number, 3) == 0))
      return sources[models + fuzz::drawn(refused, seed, number, 1)];
    return sources[fuzz::drawn(models, seed, number, 1)];
  }
  [[nodiscard]] const fs::path& file_of(std::uint64_t number) const { return source_of(number).file; }
  [[nodiscard]] std::string text_of(std::uint64_t number) const {
    return fuzz::mutated(source_of(number).text, sources[fuzz::drawn(sources.size(), seed, number, 2)].text, seed, number);
  }
};

// What the watching process and the running one share.
struct Progress {
  std::atomic<std::uint64_t> number{0};
  std::atomic<std::uint64_t> refused{0}, failed{0}, run{0}, left{0}, whole{0}, stopped{0};
};

// To the end, or until it has taken as many evaluations as it is given.
void run_a_little(const Model& model, const System& system, long evaluations, Progress& progress) {
  State start = assembled_start(system, assemble(model, system));
  if (model.simulation.initial == "equilibrium") start = find_equilibrium(system, start).state;
  SimulationOptions options = options_of(model);
  options.end = std::min(options.end, k_run);
  options.output_step = 0.25 * options.end;
  Simulation simulation(system, start, options);
  bool goes_on = true;
  const auto spent = [&] { return std::max(simulation.statistics().evaluations, simulation.statistics().events); };
  while (goes_on && (evaluations == 0 || spent() < evaluations)) goes_on = simulation.advance();
  const RunResult result = std::move(simulation).result();
  (void)judge(model, system, result, "");
  ++(goes_on ? progress.left : progress.run);
}

// As `steplap simulate --time-limit` does it, but for the files: a mutated frequency may need billions of steps.
void run_whole(Model model, std::shared_ptr<const System> system, const std::string& path, double seconds, Progress& progress) {
  const auto loaded = load_completed(std::move(model), std::move(system), path);
  for (const Finding& finding : findings_of(*loaded)) (void)text_with_place(finding);
  RunOptions options;
  options.output_step = 0.25 * *(options.end = std::min(loaded->model.simulation.end, k_run));
  options.stop = within(Budget{seconds, {}}, {});
  const Report report = judged_run(loaded, options);
  (void)report.json();
  ++progress.whole;
  if (report.run.failure && report.run.failure->kind == FailureKind::stopped) throw RunStopped(report.run.failure->text);
  ++(report.run.failure ? progress.failed : progress.run);
}

void run_one(const Cases::Source& source, bool is_whole, const Options& options, Progress& progress) {
  const std::string file = source.file.string();
  try {
    Model model = parse_model(source.text, file, program_catalogue());
    std::shared_ptr<const System> system = compile(model);
    (void)check_presentation(model, *system);
    if (is_whole) run_whole(std::move(model), std::move(system), file, k_stops_at * options.limit, progress);
    else run_a_little(model, *system, options.evaluations, progress);
  } catch (const RunStopped& stopped) {
    ++progress.stopped;
    std::printf("stopped: case %llu, %s: %s\n", static_cast<unsigned long long>(progress.number.load()), file.c_str(), stopped.what());
    std::fflush(stdout); // the process may end by a signal
  } catch (const ModelError&) {
    ++progress.refused;
  } catch (const FileError&) { // a name that no folder can have
    ++progress.refused;
  } catch (const NumericalFailure&) {
    ++progress.failed;
  } catch (const std::exception& other) {
    std::fprintf(stderr, "%s: an exception that nobody expects: %s\n", file.c_str(), other.what());
    std::abort();
  }
}

[[noreturn]] void run_from(const Cases& cases, const Options& options, std::uint64_t first, Progress& progress) {
  const rlimit memory{k_memory, k_memory};
  if (!steplap::testing::k_is_sanitized) (void)setrlimit(RLIMIT_AS, &memory); // a sanitizer reserves terabytes of addresses
  const rlimit no_core{0, 0};
  (void)setrlimit(RLIMIT_CORE, &no_core);
  for (std::uint64_t i = first; i < options.first + options.count; ++i) {
    progress.number = i;
    const itimerval of_processor{{0, 0}, {static_cast<time_t>(options.limit), 0}};
    setitimer(ITIMER_PROF, &of_processor, nullptr);
    alarm(30 * options.limit); // whoever waits for a file takes no processor time
    run_one({cases.file_of(i), cases.text_of(i)}, options.is_whole(i), options, progress);
    if (!options.said.empty() && i % 500 == 0)
      std::ofstream(options.said) << i + 1 - options.first << " of " << options.count << " cases, " << progress.run << " run, "
                                  << progress.left << " left, " << progress.refused << " refused, " << progress.failed
                                  << " could not be followed\n";
  }
  std::_Exit(0);
}

void add_files(const fs::path& path, std::vector<fs::path>& files) {
  if (!fs::is_directory(path)) return files.push_back(path);
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    const bool is_text = entry.path().extension() == ".toml" || !entry.path().has_extension(); // a corpus has no extensions
    if (entry.is_regular_file() && is_text) files.push_back(entry.path());
  }
}

const char* ending_of(int status) {
  if (!WIFSIGNALED(status)) return "it ended by itself";
  return strsignal(WTERMSIG(status));
}

int storm(const Cases& cases, const Options& options) {
  void* const shared = mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) return 2;
  auto& progress = *new (shared) Progress;
  using Number = unsigned long long;
  Number crashes = 0, hangs = 0;
  for (std::uint64_t next = options.first; next < options.first + options.count;) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) return 2;
    if (child == 0) run_from(cases, options, next, progress);
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) break;
    const std::uint64_t at = progress.number;
    const bool is_hang = WIFSIGNALED(status) && (WTERMSIG(status) == SIGALRM || WTERMSIG(status) == SIGPROF);
    ++(is_hang ? hangs : crashes);
    std::printf("%s: seed %llu, case %llu%s, %s, %s\n", is_hang ? "hang" : "crash", Number{cases.seed}, Number{at},
                options.is_whole(at) ? " (whole)" : "", cases.file_of(at).c_str(), ending_of(status));
    next = at + 1;
  }
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const double seconds = static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                         1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  std::printf("%llu cases of seed %llu from %llu: %llu run, %llu left after %ld evaluations, %llu refused, %llu could not be followed, "
              "%llu the whole way, "
              "%llu stopped, %llu crashes, %llu beyond %u s; %.0f a second of a processor\n",
              Number{options.count}, Number{cases.seed}, Number{options.first}, Number{progress.run}, Number{progress.left},
              options.evaluations, Number{progress.refused}, Number{progress.failed}, Number{progress.whole}, Number{progress.stopped},
              crashes, hangs, options.limit, static_cast<double>(options.count) / seconds);
  return crashes > 0 ? 1 : 0;
}

void print_times(const Cases& cases, const Options& options) {
  Progress progress;
  for (const Cases::Source& source : cases.sources) {
    const double before = thread_cpu_seconds();
    run_one(source, options.whole > 0, options, progress);
    std::printf("%.2f %s\n", 1e3 * (thread_cpu_seconds() - before), source.file.c_str());
  }
}

Options options_of(int argc, char** argv) {
  Options o;
  std::vector<std::uint64_t> numbers;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto next = [&] { return i + 1 < argc ? std::strtoull(argv[++i], nullptr, 10) : 0; };
    if (word == "--show") o.shows = true;
    else if (word == "--times") o.times = true;
    else if (word == "--first") o.first = next();
    else if (word == "--limit") o.limit = static_cast<unsigned>(next());
    else if (word == "--evaluations") o.evaluations = static_cast<long>(next());
    else if (word == "--whole") o.whole = next();
    else if (word == "--said" && i + 1 < argc) o.said = argv[++i];
    else if (numbers.size() < 2) numbers.push_back(std::strtoull(argv[i], nullptr, 10));
    else add_files(word, o.files);
  }
  if (numbers.size() < 2) o.files.clear();
  else o.count = numbers[0], o.seed = numbers[1];
  return o;
}

// Returns true if the text, as it is, is a model without errors.
bool is_model(const Cases::Source& source) {
  try {
    (void)parse_model(source.text, source.file.string(), program_catalogue());
    return true;
  } catch (const ModelError&) {
    return false;
  }
}

Cases cases_of(const Options& options) {
  Cases cases;
  cases.seed = options.seed;
  std::vector<fs::path> files = options.files;
  std::sort(files.begin(), files.end()); // folders list their files in any order
  for (const fs::path& file : files) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    cases.sources.push_back({file, text.str()});
  }
  const auto refused = std::stable_partition(cases.sources.begin(), cases.sources.end(), is_model);
  cases.refused = static_cast<std::size_t>(cases.sources.end() - refused);
  return cases;
}

} // namespace

int main(int argc, char** argv) {
  const Options options = options_of(argc, argv);
  if (options.files.empty()) {
    std::fprintf(stderr, "usage: mutated_models [--show | --times] COUNT_OR_NUMBER SEED [--first NUMBER] [--limit SECONDS] [--evaluations "
                         "COUNT] [--whole NUMBER]\n"
                         "                      [--said FILE] FILE_OR_FOLDER...\n");
    return 2;
  }
  const Cases cases = cases_of(options);
  if (options.times) return print_times(cases, options), 0;
  if (!options.shows) return storm(cases, options);
  std::fprintf(stderr, "%s\n", cases.file_of(options.count).c_str());
  std::fputs(cases.text_of(options.count).c_str(), stdout);
  return 0;
}
