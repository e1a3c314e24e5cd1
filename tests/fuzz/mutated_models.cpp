// Models changed at random (mutation.h), each run for 0.02 s, in a process that another one watches.
//   mutated_models COUNT SEED [--first NUMBER] [--limit SECONDS] FILE_OR_FOLDER…   runs COUNT cases, prints those that crash or hang
//   mutated_models --show NUMBER SEED FILE_OR_FOLDER…                              prints the text of one, for its model's folder
// An answer is a run, an error of the model or a numerical failure; everything else is a finding: signals, other exceptions, memory
// beyond 4 GB, and more than 10 s of a processor. Exit code 1 if there was a crash; hangs are printed to be explained.
#include "mbd/acceptance/judge.h"
#include "mbd/analysis/assembly.h"
#include "mbd/analysis/equilibrium.h"
#include "mbd/base/diagnostics.h"
#include "mbd/io/presentation.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "tests/fuzz/mutation.h"
#include "tests/sanitized.h"
#include "transformer/catalog.h"

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
constexpr std::uint64_t k_memory = 4'000'000'000ULL; // bytes

struct Cases {
  std::vector<fs::path> files;
  std::vector<std::string> texts;
  std::uint64_t seed = 1;

  std::size_t corpus = 0; ///< the last so many files are a fuzzer's corpus, malformed or studies: most of them are refused as they are

  [[nodiscard]] std::size_t file_of(std::uint64_t number) const {
    const std::size_t models = files.size() - corpus;
    if (models == 0 || (corpus > 0 && fuzz::drawn(10, seed, number, 3) == 0)) return models + fuzz::drawn(corpus, seed, number, 1);
    return fuzz::drawn(models, seed, number, 1);
  }
  [[nodiscard]] std::string text_of(std::uint64_t number) const {
    return fuzz::mutated(texts[file_of(number)], texts[fuzz::drawn(files.size(), seed, number, 2)], seed, number);
  }
};

// What the watching process and the running one share.
struct Progress {
  std::atomic<std::uint64_t> number{0};
  std::atomic<std::uint64_t> refused{0}, failed{0}, run{0};
};

void run_one(const std::string& text, const fs::path& file, Progress& progress) {
  try {
    Model model = parse_model(text, file.string(), transformer_catalog());
    const auto system = compile(model);
    (void)check_presentation(model, *system);
    State start = assembled_start(*system, assemble(model, *system));
    if (model.simulation.initial == "equilibrium") start = find_equilibrium(*system, start).state;
    SimulationOptions options = options_of(model);
    options.end = std::min(options.end, k_run);
    options.output_step = 0.25 * options.end;
    const RunResult result = simulate(*system, start, options);
    (void)judge(model, *system, result, "");
    ++progress.run;
  } catch (const ModelError&) {
    ++progress.refused;
  } catch (const NumericalFailure&) {
    ++progress.failed;
  } catch (const std::exception& other) {
    std::fprintf(stderr, "%s: an exception that nobody expects: %s\n", file.c_str(), other.what());
    std::abort();
  }
}

[[noreturn]] void run_from(const Cases& cases, std::uint64_t first, std::uint64_t end, unsigned limit, Progress& progress) {
  const rlimit memory{k_memory, k_memory};
  if (!steplap::testing::k_is_sanitized) (void)setrlimit(RLIMIT_AS, &memory); // a sanitizer reserves terabytes of addresses
  const rlimit no_core{0, 0};
  (void)setrlimit(RLIMIT_CORE, &no_core);
  for (std::uint64_t i = first; i < end; ++i) {
    progress.number = i;
    const itimerval of_processor{{0, 0}, {static_cast<time_t>(limit), 0}};
    setitimer(ITIMER_PROF, &of_processor, nullptr);
    alarm(30 * limit); // whoever waits for a file takes no processor time
    run_one(cases.text_of(i), cases.files[cases.file_of(i)], progress);
  }
  std::_Exit(0);
}

void add_files(const fs::path& path, std::vector<fs::path>& files) {
  if (!fs::is_directory(path)) return files.push_back(path);
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    const bool is_model = entry.path().extension() == ".toml" || (!entry.path().has_extension() && path.string().find("corpus") != std::string::npos);
    if (entry.is_regular_file() && is_model) files.push_back(entry.path());
  }
}

int storm(const Cases& cases, std::uint64_t first, std::uint64_t end, unsigned limit) {
  void* const shared = mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) return 2;
  auto& progress = *new (shared) Progress;
  std::uint64_t crashes = 0, hangs = 0;
  for (std::uint64_t next = first; next < end;) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) return 2;
    if (child == 0) run_from(cases, next, end, limit, progress);
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) break;
    const std::uint64_t at = progress.number;
    const bool is_hang = WIFSIGNALED(status) && (WTERMSIG(status) == SIGALRM || WTERMSIG(status) == SIGPROF);
    ++(is_hang ? hangs : crashes);
    std::printf("%s: seed %llu, case %llu, %s%s\n", is_hang ? "hang" : "crash", static_cast<unsigned long long>(cases.seed), static_cast<unsigned long long>(at),
                cases.files[cases.file_of(at)].c_str(), is_hang ? "" : WIFSIGNALED(status) ? (std::string(", ") + strsignal(WTERMSIG(status))).c_str() : ", it ended by itself");
    next = at + 1;
  }
  std::printf("%llu cases of seed %llu: %llu run, %llu refused, %llu could not be followed, %llu crashes, %llu beyond %u s\n",
              static_cast<unsigned long long>(end - first), static_cast<unsigned long long>(cases.seed), static_cast<unsigned long long>(progress.run),
              static_cast<unsigned long long>(progress.refused), static_cast<unsigned long long>(progress.failed), static_cast<unsigned long long>(crashes),
              static_cast<unsigned long long>(hangs), limit);
  return crashes > 0 ? 1 : 0;
}

} // namespace

int main(int argc, char** argv) {
  Cases cases;
  std::uint64_t count = 0, first = 0;
  unsigned limit = 10;
  bool shows = false;
  std::vector<std::uint64_t> numbers;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--show") shows = true;
    else if (word == "--first" && i + 1 < argc) first = std::strtoull(argv[++i], nullptr, 10);
    else if (word == "--limit" && i + 1 < argc) limit = static_cast<unsigned>(std::strtoul(argv[++i], nullptr, 10));
    else if (numbers.size() < 2) numbers.push_back(std::strtoull(argv[i], nullptr, 10));
    else add_files(word, cases.files);
  }
  if (numbers.size() < 2 || cases.files.empty()) {
    std::fprintf(stderr, "usage: mutated_models COUNT SEED [--first NUMBER] [--limit SECONDS] FILE_OR_FOLDER...\n"
                         "       mutated_models --show NUMBER SEED FILE_OR_FOLDER...\n");
    return 2;
  }
  count = numbers[0];
  cases.seed = numbers[1];
  const auto is_of_corpus = [](const fs::path& file) {
    const std::string folder = file.parent_path().string();
    return folder.find("corpus") != std::string::npos || folder.find("malformed") != std::string::npos || folder.find("studies") != std::string::npos;
  };
  const auto is_before = [&](const fs::path& a, const fs::path& b) { // folders list their files in any order
    return is_of_corpus(a) != is_of_corpus(b) ? is_of_corpus(b) : a < b;
  };
  std::sort(cases.files.begin(), cases.files.end(), is_before);
  cases.corpus = static_cast<std::size_t>(std::count_if(cases.files.begin(), cases.files.end(), is_of_corpus));
  for (const fs::path& file : cases.files) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    cases.texts.push_back(text.str());
  }
  if (!shows) return storm(cases, first, first + count, limit);
  std::fprintf(stderr, "%s\n", cases.files[cases.file_of(count)].c_str());
  std::fputs(cases.text_of(count).c_str(), stdout);
  return 0;
}
