// Program peer_transformer: runs the hand-written transformer with three integrators and both conditions over a sequence of tolerances.
//
// Usage: peer_transformer [--csv FILE] [--reference DIRECTORY] [--events TOLERANCE]
// DIRECTORY contains no_interference.csv and interference.csv. The error is the larger one of θ1 and of the bottom arresting force over 1
// kHz samples, relative to their ranges, and the larger one of both conditions. Times are sums over both conditions.

#include "ladder.h"
#include "transformer_programs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

namespace steplap::peers {
namespace {

constexpr std::array<Condition, 2> k_conditions = {Condition::no_interference, Condition::interference};
constexpr std::array<const char*, 2> k_names = {"no_interference", "interference"};
constexpr double k_tightest = 1e-12;

struct Program {
  const char* name;
  TransformerProgram run;
  double tightest;
  std::vector<double> tolerances;
};

std::vector<double> decades(double from, double to) {
  std::vector<double> ladder;
  for (double e = std::log10(from); e > std::log10(to) - 0.1; e -= 0.5) ladder.push_back(std::pow(10.0, e));
  return ladder;
}

std::vector<Program> programs() {
  std::vector<Program> all;
  all.push_back({"own DOP853", run_transformer_dop853, k_tightest, decades(1e0, 1e-11)});
#ifdef STEPLAP_PEER_ARKODE
  all.push_back({"ARKODE Dormand-Prince", run_transformer_arkode, 1e-12, decades(1e-1, 1e-10)});
#endif
#ifdef STEPLAP_PEER_CVODE
  all.push_back({"CVODE Adams", run_transformer_cvode, 1e-11, decades(1e-2, 3e-11)});
#endif
  return all;
}

using History = std::vector<Outputs>;

double scaled_error(const History& run, const History& reference, double Outputs::*column) {
  if (run.size() != reference.size()) return std::nan("");
  double low = 1e300, high = -1e300, worst = 0.0;
  for (std::size_t i = 0; i < run.size(); ++i) {
    low = std::min(low, reference[i].*column);
    high = std::max(high, reference[i].*column);
    worst = std::max(worst, std::abs(run[i].*column - reference[i].*column));
  }
  return worst / (high - low);
}

double error_of(const History& run, const History& reference) {
  return std::max(scaled_error(run, reference, &Outputs::theta1), scaled_error(run, reference, &Outputs::bottom_arrest));
}

// Reads the two compared columns of a reference file. Returns nothing if the file does not exist.
History read_reference(const std::string& path) {
  History rows;
  std::ifstream file(path);
  std::string line, cell;
  int theta = -1, bottom = -1;
  while (std::getline(file, line)) {
    std::stringstream cells(line);
    Outputs row{};
    for (int column = 0; std::getline(cells, cell, ','); ++column) {
      if (cell == "theta1") theta = column;
      if (cell == "bottom_arrest") bottom = column;
      if (column == theta) row.theta1 = std::atof(cell.c_str());
      if (column == bottom) row.bottom_arrest = std::atof(cell.c_str());
    }
    rows.push_back(row);
  }
  if (!rows.empty()) rows.erase(rows.begin()); // removes the header
  return rows;
}

std::string short_number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", x);
  return text;
}

void climb(const Program& program, const std::array<History, 2>& files, std::vector<Rung>& rungs) {
  std::array<History, 2> own;
  for (int c = 0; c < 2; ++c) {
    Record record;
    (void)program.run(k_conditions[c], program.tightest, &record);
    own[c] = record.samples;
  }
  std::printf("%-22s its tightest run (%.0e) against the reference files: %.2e %.2e\n", program.name, program.tightest,
              error_of(own[0], files[0]), error_of(own[1], files[1]));
  std::printf("%9s %11s %11s %10s %7s %9s %11s %7s %7s\n", "tolerance", "error", "error(file)", "CPU ms", "steps", "rejected",
              "evaluations", "events", "ns/eval");
  for (const double tolerance : program.tolerances) {
    Rung rung{"transformer", program.name, short_number(tolerance)};
    double file_error = 0.0;
    long rejected = 0;
    for (int c = 0; c < 2; ++c) {
      Record record;
      (void)program.run(k_conditions[c], tolerance, &record);
      rung.error = std::max(rung.error, error_of(record.samples, own[c]));
      file_error = std::max(file_error, error_of(record.samples, files[c]));
      const RunCounts counts = program.run(k_conditions[c], tolerance, nullptr);
      rung.steps += counts.steps;
      rung.evaluations += counts.evaluations;
      rung.events += counts.events;
      rejected += counts.rejected;
    }
    rung.cpu_ms = least_ms([&] {
      (void)program.run(k_conditions[0], tolerance, nullptr);
      (void)program.run(k_conditions[1], tolerance, nullptr);
    });
    std::printf("%9s %11.2e %11.2e %10.4f %7ld %9ld %11ld %7ld %7.0f\n", rung.setting.c_str(), rung.error, file_error, rung.cpu_ms,
                rung.steps, rejected, rung.evaluations, rung.events, 1e6 * rung.cpu_ms / static_cast<double>(rung.evaluations));
    rungs.push_back(rung);
  }
  std::printf("\n");
}

void print_events(double tolerance) {
  for (const Program& program : programs())
    for (int c = 0; c < 2; ++c) {
      Record record;
      (void)program.run(k_conditions[c], tolerance, &record);
      std::printf("%s, %s\n", program.name, k_names[c]);
      for (const Happening& h : record.happenings) std::printf("  %.9f  %s\n", h.time, h.what);
    }
}

// Prints the cost of one evaluation in the initial mode (sticking, feet closed).
void print_evaluation_cost() {
  Transformer model(Condition::no_interference);
  State y = model.initial_state();
  State f{};
  constexpr int k_repeats = 1000000;
  const double ms = least_ms([&] {
    for (int i = 0; i < k_repeats; ++i) {
      y[0] = 1e-9 * f[6];
      model.rates(0.1, y.data(), f.data());
    }
  });
  std::printf("one evaluation while sticking, inside the pulse: %.1f ns\n\n", 1e6 * ms / k_repeats);
}

} // namespace
} // namespace steplap::peers

int main(int argc, char** argv) {
  using namespace steplap::peers;
  std::string csv, directory;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--csv") == 0) csv = argv[i + 1];
    if (std::strcmp(argv[i], "--reference") == 0) directory = argv[i + 1];
    if (std::strcmp(argv[i], "--events") == 0) {
      print_events(std::atof(argv[i + 1]));
      return 0;
    }
  }
  std::array<History, 2> files;
  for (int c = 0; c < 2; ++c) files[c] = read_reference(directory + "/" + k_names[c] + ".csv");
  print_evaluation_cost();
  std::vector<Rung> rungs;
  for (const Program& program : programs()) climb(program, files, rungs);
  print_summary(rungs);
  if (!csv.empty()) {
    std::FILE* file = std::fopen(csv.c_str(), "w");
    if (file == nullptr) {
      std::fprintf(stderr, "cannot write %s\n", csv.c_str());
      return 2;
    }
    write_csv(file, rungs);
    std::fclose(file);
  }
  return 0;
}
