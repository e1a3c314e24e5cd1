// Measures the cost per body in scenes of 10 to 100 000 bodies: reading, compiling, starting, a step of rk4, memory.
//
// The scenes are chains of pendulums (two constraint rows per body: sparse constraint algebra), square grids of masses on springs (no
// constraints), and adjacent four-bar linkages (islands). If the cost is linear, columns do not change with n.
//
//   bench_scaling [largest number of bodies, default 100000] [smallest number, default 10] [scene]
#include "elements/catalog.h"
#include "mbd/io/reader.h"
#include "mbd/simulation/simulation.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <sstream>
#include <string>

using namespace steplap;

namespace {

constexpr int k_batches = 5;

const char* const k_header = "gravity = [0.0, -9.81]\n[simulation]\nend = 10.0\nintegrator = \"rk4\"\nstep = 1e-4\n";

// Returns a chain of n pinned links that falls from the horizontal.
std::string chain(int n) {
  std::ostringstream text;
  text << k_header;
  for (int i = 1; i <= n; ++i)
    text << "[[body]]\nname = \"" << i << "\"\nmass = 1.0\ninertia = 0.083\nposition = [" << i - 1 << ".5, 0.0]\n";
  for (int i = 1; i <= n; ++i) {
    text << "[[element]]\nkind = \"revolute\"\nname = \"pin " << i << "\"\na = { body = \"" << i << "\", at = [" << i - 1
         << ".0, 0.0] }\nb = { body = \"";
    if (i == 1) text << "ground";
    else text << i - 1;
    text << "\", at = [" << i - 1 << ".0, 0.0] }\n";
  }
  return text.str();
}

// Returns a square grid of masses at distances of 1 m, suspended at its first row.
std::string grid(int n) {
  const int side = std::max(2, static_cast<int>(std::lround(std::sqrt(n))));
  std::ostringstream text;
  text << k_header;
  const auto name = [&](int row, int column) { return std::to_string(row * side + column); };
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      text << "[[body]]\nname = \"" << name(r, c) << "\"\nmass = 1.0\ninertia = 0.01\nposition = [" << c << ".0, " << -r << ".0]\n";
    }
  const auto spring = [&](const std::string& a, const std::string& b, double x, double y) {
    text << "[[element]]\nkind = \"spring_damper\"\nname = \"" << a << " to " << b << "\"\na = \"" << a << "\"\nb = ";
    if (b == "ground") text << "{ body = \"ground\", at = [" << x << ", " << y << "] }";
    else text << '"' << b << '"';
    text << "\nstiffness = 1e4\ndamping = 1.0\n";
  };
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      if (r == 0) spring(name(r, c), "ground", c, 1.0);
      else spring(name(r, c), name(r - 1, c), 0.0, 0.0);
      if (c > 0) spring(name(r, c), name(r, c - 1), 0.0, 0.0);
    }
  return text.str();
}

// Returns linkages of crank, coupler and rocker, 4 m apart, that fall under gravity.
std::string linkages(int n) {
  std::ostringstream text;
  text << k_header;
  const auto body = [&](const std::string& name, double x, double y, double inertia) {
    text << "[[body]]\nname = \"" << name << "\"\nmass = 1.0\ninertia = " << inertia << "\nposition = [" << x << ", " << y << "]\n";
  };
  const auto pin = [&](const std::string& a, const std::string& b, double x, double y) {
    text << "[[element]]\nkind = \"revolute\"\nname = \"" << a << " on " << b << "\"\na = { body = \"" << a << "\", at = [" << x << ", "
         << y << "] }\nb = { body = \"" << b << "\", at = [" << x << ", " << y << "] }\n";
  };
  for (int i = 0; i < std::max(1, n / 3); ++i) {
    const double x = 4.0 * i;
    const std::string name = std::to_string(i);
    body("crank " + name, x + 0.25, 0.5, 0.1);
    body("coupler " + name, x + 1.5, 1.25, 0.4);
    body("rocker " + name, x + 2.25, 0.75, 0.2);
    pin("crank " + name, "ground", x, 0.0);
    pin("coupler " + name, "crank " + name, x + 0.5, 1.0);
    pin("rocker " + name, "coupler " + name, x + 2.5, 1.5);
    pin("rocker " + name, "ground", x + 2.0, 0.0);
  }
  return text.str();
}

double allocated() { return static_cast<double>(mallinfo2().uordblks); }

void measure(const char* scene, const std::string& text, bool is_absolute = false) {
  const double empty = allocated();
  const double start = thread_cpu_seconds();
  const Model model = parse_model(text, scene, element_catalog());
  const double read = thread_cpu_seconds();
  const auto system = compile(model);
  const double compiled = thread_cpu_seconds();
  const double n = system->body_count() - 1.0;
  SimulationOptions options = options_of(model);
  options.output_step = 0.0;
  if (is_absolute) options.coordinates = Coordinates::absolute;
  options.has_extremes = false; // the search for extremes of all channels is not part of the measurement
  Simulation simulation(*system, system->initial_state(), options);
  const double started = thread_cpu_seconds();
  const double memory = allocated() - empty;
  const int steps = std::max(3, static_cast<int>(20000 / n));
  double best = std::numeric_limits<double>::infinity();
  const long evaluated = simulation.statistics().evaluations;
  for (int batch = 0; batch < k_batches; ++batch) {
    const double begin = thread_cpu_seconds();
    for (int i = 0; i < steps; ++i) simulation.advance();
    best = std::min(best, (thread_cpu_seconds() - begin) / steps);
  }
  const double evaluations = static_cast<double>(simulation.statistics().evaluations - evaluated) / (k_batches * steps);
  std::printf("%-10s %7.0f %10.1f %10.2f %10.2f %10.3f %13.4f %10.2f\n", scene, n, 1e6 * (read - start) / n, 1e6 * (compiled - read) / n,
              1e6 * (started - compiled) / n, 1e6 * best / n, 1e6 * best / n / evaluations, memory / n / 1024.0);
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::atoi(argv[1]) : 100000;
  const int smallest = argc > 2 ? std::atoi(argv[2]) : 10;
  const std::string only = argc > 3 ? argv[3] : "";
  std::printf("per body, µs: %19s %10s %10s %10s %13s   kB\n", "read", "compile", "start", "step (rk4)", "an evaluation");
  const auto is_wanted = [&only](const char* scene) { return only.empty() || only == scene; };
  try {
    for (int n = smallest; n <= largest; n *= 10) {
      if (is_wanted("chain")) measure("chain", chain(n));
      if (is_wanted("grid")) measure("grid", grid(n));
      if (is_wanted("linkages")) measure("linkages", linkages(n));
      if (is_wanted("absolute")) measure("absolute", linkages(n), true);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 4;
  }
}
