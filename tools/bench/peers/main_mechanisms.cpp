// Program peer_mechanisms: runs B1 … B5 in hand-written programs, and B1 … B3 in Simbody, over a sequence of tolerances.
//
// Usage: peer_mechanisms [--csv FILE] [--only PROBLEM] [--slow]
// --slow adds runs of many seconds (N-four-bar with N = 40 at tight settings).
// Error: largest error of an angle (B1) or coordinate (B2 … B4) at the end, relative to the exact solution; for B5 the largest error of the
// height over 10 ms samples, relative to the program's own run with the tightest tolerance.

#include "andrews.h"
#include "ladder.h"
#include "mechanisms.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>

namespace steplap::peers {
namespace {

struct ProgramRuns {
  std::string problem;
  std::string program;
  std::vector<double> settings;
  std::function<MechanismResult(double)> run;
};

std::vector<double> decades(double from, double to, double ratio = 10.0) {
  std::vector<double> ladder;
  for (double x = from; x > to * 0.9; x /= ratio) ladder.push_back(x);
  return ladder;
}

MechanismResult judged(const AndrewsResult& r, AndrewsVariant variant) {
  MechanismResult result{0.0, r.steps, r.evaluations, 0};
  const AndrewsAngles& exact = k_andrews_exact[static_cast<int>(variant)];
  for (std::size_t i = 0; i < exact.size(); ++i) result.error = std::max(result.error, std::abs(r.angles[i] - exact[i]));
  return result;
}

void add_andrews(std::vector<ProgramRuns>& all) {
  for (const AndrewsVariant v : {AndrewsVariant::test_set, AndrewsVariant::a03}) {
    const std::string problem = v == AndrewsVariant::a03 ? "B1 A03 0.05 s" : "B1 Andrews 0.03 s";
    auto add = [&](const char* name, AndrewsResult (*run)(AndrewsVariant, double), double last) {
      all.push_back({problem, name, decades(1e-3, last), [run, v](double tolerance) { return judged(run(v, tolerance), v); }});
    };
    add("reduced, own DOP853", run_andrews_dop853, 1e-13);
#ifdef STEPLAP_PEER_ARKODE
    add("reduced, ARKODE", run_andrews_arkode, 1e-12);
    add("KKT, ARKODE", run_andrews_kkt_arkode, 1e-12);
    add("KKT, IDA", run_andrews_kkt_ida, 1e-11);
#endif
#ifdef STEPLAP_PEER_SIMBODY
    all.push_back({problem, "Simbody", decades(1e-3, 1e-11), [v](double accuracy) { return run_andrews_simbody(v, accuracy); }});
#endif
  }
}

void add_four_bar(std::vector<ProgramRuns>& all, bool slow) {
  for (const FourBarExact& exact : k_four_bar_exact) {
    const bool large = exact.windows > 2;
    const std::string problem = "B2 N = " + std::to_string(exact.windows);
    all.push_back({problem, "one coordinate, DOP853", decades(1e-2, 1e-13), [&exact](double e) { return run_four_bar_dop853(exact, e); }});
#ifdef STEPLAP_PEER_ARKODE
    all.push_back({problem, "one coordinate, ARKODE", decades(1e-2, 1e-13), [&exact](double e) { return run_four_bar_arkode(exact, e); }});
#endif
    all.push_back({problem, "KKT RK4 (step)", decades(8e-2, large ? (slow ? 5e-3 : 2e-2) : 6e-4, 2.0),
                   [&exact](double h) { return run_four_bar_kkt_rk4(exact, h); }});
#ifdef STEPLAP_PEER_SIMBODY
    if (large && !slow) continue;
    all.push_back({problem, "Simbody", large ? decades(1e-4, 1e-6) : decades(1e-3, 1e-9),
                   [&exact](double e) { return run_four_bar_simbody(exact, e); }});
#endif
  }
}

void add_pendulum(std::vector<ProgramRuns>& all) {
  all.push_back({"B3 pendulum", "angle, own DOP853", decades(1e-2, 1e-13), run_pendulum_dop853});
#ifdef STEPLAP_PEER_ARKODE
  all.push_back({"B3 pendulum", "angle, ARKODE", decades(1e-2, 1e-13), run_pendulum_arkode});
#endif
#ifdef STEPLAP_PEER_SIMBODY
  all.push_back({"B3 pendulum", "Simbody", decades(1e-2, 1e-10), run_pendulum_simbody});
#endif
}

#ifdef STEPLAP_PEER_ARKODE
constexpr double k_bounce_tightest = 1e-14;

void add_switching(std::vector<ProgramRuns>& all) {
  all.push_back({"B4a belt", "ARKODE with roots", decades(1e-2, 1e-13), run_belt_arkode});
  all.push_back({"B4b Den Hartog", "ARKODE with roots", decades(1e-2, 1e-13), run_den_hartog_arkode});
  std::vector<double> reference;
  (void)run_bounce_arkode(k_bounce_tightest, &reference);
  auto bounce = [reference](double tolerance) {
    std::vector<double> samples;
    (void)run_bounce_arkode(tolerance, &samples);
    double error = samples.size() == reference.size() ? 0.0 : std::nan("");
    for (std::size_t i = 0; i < std::min(samples.size(), reference.size()); ++i)
      error = std::max(error, std::abs(samples[i] - reference[i]));
    const double start = cpu_seconds();
    MechanismResult result = run_bounce_arkode(tolerance, nullptr); // timed without samples
    result.cpu_ms = 1e3 * (cpu_seconds() - start);
    result.error = error;
    return result;
  };
  all.push_back({"B5 bouncing mass", "ARKODE with roots", decades(1e-3, 1e-13), bounce});
}
#endif

Rung measure(const ProgramRuns& entry, double setting) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", setting);
  MechanismResult result = entry.run(setting);
  if (result.cpu_ms == 0.0) {
    result.cpu_ms = least_ms([&] { (void)entry.run(setting); }, 0.1);
  } else { // the program measures the time of its integration itself
    for (double spent = result.cpu_ms; spent < 100.0; spent += 10.0) result.cpu_ms = std::min(result.cpu_ms, entry.run(setting).cpu_ms);
  }
  return {entry.problem, entry.program, text, result.error, result.cpu_ms, result.steps, result.evaluations, result.events};
}

} // namespace
} // namespace steplap::peers

int main(int argc, char** argv) {
  using namespace steplap::peers;
  std::string csv, only;
  bool slow = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--slow") == 0) slow = true;
    if (i + 1 < argc && std::strcmp(argv[i], "--csv") == 0) csv = argv[i + 1];
    if (i + 1 < argc && std::strcmp(argv[i], "--only") == 0) only = argv[i + 1];
  }
  std::vector<ProgramRuns> all;
  add_andrews(all);
  add_four_bar(all, slow);
  add_pendulum(all);
#ifdef STEPLAP_PEER_ARKODE
  add_switching(all);
#endif
  std::vector<Rung> rungs;
  for (const ProgramRuns& entry : all) {
    if (!only.empty() && entry.problem.compare(0, only.size(), only) != 0) continue;
    for (const double setting : entry.settings) rungs.push_back(measure(entry, setting));
  }
  print_table(rungs);
  print_summary(rungs);
  if (csv.empty()) return 0;
  std::FILE* file = std::fopen(csv.c_str(), "w");
  if (file == nullptr) {
    std::fprintf(stderr, "cannot write %s\n", csv.c_str());
    return 2;
  }
  write_csv(file, rungs);
  std::fclose(file);
  return 0;
}
