// Runs steplap on the scenes of tools/bench/peers over a sequence of tolerances and prints the results together with those of the peers.
//
// Usage: compare_steplap [--csv FILE] [--only PROBLEM] [PEERS.csv ...]
//
// Times and errors are measured as for the peers: CPU time of the integration only (without reading and compiling), one thread, minimum of
// several runs, no samples. Errors:
//
//   B6           larger of θ1 and the bottom arresting force over 1 kHz samples, each scaled by its range, against the program's
//                own run with the tightest tolerance, both conditions together
//   B1           largest of the seven angles at the end
//   B2           larger of both coordinates
//   B0, B3, B4   largest component of the state
//   B5           largest height over samples every 10 ms, against the program's own run with the tightest tolerance
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"
#include "tools/bench/peers/ladder.h"
#include "tools/bench/peers/mechanisms.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>

using namespace steplap;

namespace {

using peers::Rung;

constexpr double k_tightest = 1e-13;
constexpr double k_longest_run = 10.0; // CPU time, s; settings that take longer are omitted

struct ComparedModel {
  Model model;
  std::unique_ptr<const System> system;
  std::vector<std::string> channels; // channels, in the order of the arguments of `error`
  double sample_step = 0.0;          // sampling step, s
};

struct Problem {
  std::string name; // name used by the peers
  // true if the reference is the program's own run with the tightest tolerance; otherwise the exact solution is known
  bool is_against_tightest;
  std::vector<ComparedModel> scenes;
  // Computes the error from the channels of one run and of the run with the tightest tolerance.
  std::function<double(const std::vector<std::vector<double>>&, const std::vector<std::vector<double>>&)> error;
};

ComparedModel scene(const std::string& file, std::vector<std::string> channels, double sample_step) {
  Model model = read_model(STEPLAP_MODELS "/" + file + ".toml", transformer_catalog());
  auto system = compile(model);
  return {std::move(model), std::move(system), std::move(channels), sample_step};
}

RunResult run(const ComparedModel& scene, const std::string& method, double tolerance, bool is_sampled) {
  SimulationOptions options = options_of(scene.model);
  options.integrator = method;
  options.settings.tolerance = tolerance;
  options.settings.step = 0.0;
  options.channels = scene.channels;
  options.output_step = is_sampled ? scene.sample_step : 0.0;
  options.has_extremes = false; // the compared programs compute no extremes
  const double begin = thread_cpu_seconds();
  Simulation simulation(*scene.system, scene.system->initial_state(), options);
  while (simulation.advance())
    if (thread_cpu_seconds() - begin > k_longest_run) throw NumericalFailure("takes too long");
  return std::move(simulation).result();
}

std::vector<std::vector<double>> series(const ComparedModel& scene, const RunResult& result) {
  std::vector<std::vector<double>> all;
  for (const std::string& channel : scene.channels) all.push_back(result.trajectory->series(channel));
  return all;
}

// --- errors -------------------------------------------------------------------------------------

using Series = std::vector<std::vector<double>>;

double over_samples(const Series& a, const Series& b, bool is_scaled) {
  double worst = 0.0;
  for (std::size_t c = 0; c < b.size(); ++c) {
    if (a[c].size() != b[c].size()) return std::nan("");
    const auto [low, high] = std::minmax_element(b[c].begin(), b[c].end());
    const double scale = is_scaled ? *high - *low : 1.0;
    for (std::size_t i = 0; i < b[c].size(); ++i) worst = std::max(worst, std::abs(a[c][i] - b[c][i]) / scale);
  }
  return worst;
}

double at_the_end(const Series& a, const std::vector<double>& exact, double factor = 1.0) {
  double worst = 0.0;
  for (std::size_t c = 0; c < exact.size(); ++c) worst = std::max(worst, std::abs(factor * a[c].back() - exact[c]));
  return worst;
}

// Converts the bodies' angles to β, Θ, γ, Φ, δ, Ω, ε of the literature.
double andrews_error(const Series& k, const peers::AndrewsAngles& exact) {
  const auto a = [&k](int i) { return k[i - 1].back(); };
  const double angles[7] = {a(1), a(2) - a(1), a(3), a(4) - a(5), a(5), a(6) - a(7), a(7)};
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) worst = std::max(worst, std::abs(angles[i] - exact[i]));
  return worst;
}

// --- problems -----------------------------------------------------------------------------------

Problem ending(const char* name, const std::string& file, std::vector<std::string> channels, std::vector<double> exact,
               double factor = 1.0) {
  Problem problem{
      name, false, {}, [exact = std::move(exact), factor](const Series& a, const Series&) { return at_the_end(a, exact, factor); }};
  ComparedModel s = scene("benchmarks/" + file, std::move(channels), 0.0);
  s.sample_step = s.model.simulation.end;
  problem.scenes.push_back(std::move(s));
  return problem;
}

Problem andrews(const char* name, const std::string& file, int variant) {
  Problem problem{name, false, {}, [variant](const Series& a, const Series&) { return andrews_error(a, peers::k_andrews_exact[variant]); }};
  std::vector<std::string> angles;
  for (int i = 1; i <= 7; ++i) angles.push_back("K" + std::to_string(i) + ".theta");
  problem.scenes.push_back(scene("benchmarks/" + file, angles, peers::k_andrews_end[variant]));
  return problem;
}

std::vector<Problem> problems() {
  std::vector<Problem> all;
  Problem transformer{"transformer", true, {}, [](const Series& a, const Series& b) { return over_samples(a, b, true); }};
  for (const char* file : {"paper/no_interference", "paper/interference"})
    transformer.scenes.push_back(scene(file, {"active part.theta", "bottom arresting.force"}, 1e-3));
  all.push_back(std::move(transformer));
  all.push_back(andrews("B1 Andrews 0.03 s", "andrews", 0));
  all.push_back(andrews("B1 A03 0.05 s", "andrews_a03", 1));
  for (const peers::FourBarExact& exact : peers::k_four_bar_exact) {
    const std::string n = std::to_string(exact.windows);
    // point B0 is the reflection of the ground pin about the rod's middle
    all.push_back(ending(("B2 N = " + n).c_str(), "four_bar_" + n, {"rod 0.x", "rod 0.y"}, {exact.x, exact.y}, 2.0));
  }
  all.push_back(ending("B3 pendulum", "simple_pendulum", {"bob.x", "bob.y"}, {peers::k_pendulum_x, peers::k_pendulum_y}));
  all.push_back(ending("B4a belt", "stick_slip_belt", {"mass.x", "mass.vx"}, {0.0314469318813080, -0.198980397472595}));
  all.push_back(ending("B4b Den Hartog", "den_hartog", {"mass.x", "mass.vx"}, {-0.0363829137728667, 0.370762125122938}));
  Problem bounce{"B5 bouncing mass", true, {}, [](const Series& a, const Series& b) { return over_samples(a, b, false); }};
  bounce.scenes.push_back(scene("benchmarks/bouncing_mass", {"mass.y"}, 1e-2));
  all.push_back(std::move(bounce));
  return all;
}

// --- measurement over tolerances ----------------------------------------------------------------

Rung measure(const Problem& problem, const std::string& method, double tolerance, const std::vector<Series>& tightest) {
  char setting[32];
  std::snprintf(setting, sizeof setting, "%.1e", tolerance);
  Rung rung{problem.name, "steplap " + method, setting};
  for (std::size_t s = 0; s < problem.scenes.size(); ++s) {
    const ComparedModel& scene = problem.scenes[s];
    rung.error = std::max(rung.error, problem.error(series(scene, run(scene, method, tolerance, true)), tightest[s]));
    const RunStatistics counts = run(scene, method, tolerance, false).statistics;
    rung.steps += counts.steps;
    rung.evaluations += counts.evaluations;
    rung.events += counts.events;
  }
  rung.cpu_ms = peers::least_ms([&] {
    for (const ComparedModel& scene : problem.scenes) (void)run(scene, method, tolerance, false);
  });
  return rung;
}

void climb(const Problem& problem, std::vector<Rung>& rungs) {
  std::vector<Series> tightest;
  for (const ComparedModel& scene : problem.scenes)
    if (!problem.is_against_tightest) tightest.emplace_back();
    else tightest.push_back(series(scene, run(scene, "dop853", k_tightest, true)));
  for (const char* method : {"dop853", "tsit5", "auto"})
    for (int exponent = 2; exponent <= 24; ++exponent) {
      try {
        rungs.push_back(measure(problem, method, std::pow(10.0, -0.5 * exponent), tightest));
      } catch (const NumericalFailure& failure) {
        std::fprintf(stderr, "%s, %s at 1e-%.1f: %s\n", problem.name.c_str(), method, 0.5 * exponent, failure.what());
      }
    }
}

bool read_rungs(const std::string& path, const std::string& only, std::vector<Rung>& rungs) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) return false;
  while (std::getline(file, line)) {
    std::stringstream cells(line);
    Rung r;
    std::string cell[5];
    std::getline(cells, r.problem, ',');
    cells.ignore(1, '"');
    std::getline(cells, r.program, '"');
    cells.ignore(1, ',');
    std::getline(cells, r.setting, ',');
    for (std::string& text : cell) std::getline(cells, text, ',');
    r.error = std::strtod(cell[0].c_str(), nullptr);
    r.cpu_ms = std::strtod(cell[1].c_str(), nullptr);
    r.steps = std::strtol(cell[2].c_str(), nullptr, 10);
    r.evaluations = std::strtol(cell[3].c_str(), nullptr, 10);
    r.events = std::strtol(cell[4].c_str(), nullptr, 10);
    if (r.problem.compare(0, only.size(), only) == 0) rungs.push_back(r);
  }
  return true;
}

int fail(const std::string& message) {
  std::fprintf(stderr, "compare_steplap: %s\n", message.c_str());
  return 2;
}

} // namespace

int main(int argc, char** argv) {
  std::string csv, only;
  std::vector<Rung> rungs;
  std::vector<std::string> peer_files;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--csv") == 0 && i + 1 < argc) csv = argv[++i];
    else if (std::strcmp(argv[i], "--only") == 0 && i + 1 < argc) only = argv[++i];
    else peer_files.push_back(argv[i]);
  }
  for (const std::string& file : peer_files)
    if (!read_rungs(file, only, rungs)) return fail("cannot read '" + file + "'");
  for (const Problem& problem : problems())
    if (problem.name.compare(0, only.size(), only) == 0) climb(problem, rungs);
  std::stable_sort(rungs.begin(), rungs.end(), [](const Rung& a, const Rung& b) { return a.problem < b.problem; });
  peers::print_table(rungs);
  peers::print_summary(rungs);
  if (csv.empty()) return 0;
  std::FILE* file = std::fopen(csv.c_str(), "w");
  if (file == nullptr) return fail("cannot write '" + csv + "'");
  peers::write_csv(file, rungs);
  return std::fclose(file) == 0 ? 0 : fail("cannot write '" + csv + "'");
}
