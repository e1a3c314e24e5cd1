// Steps allocate nothing: every operator new is counted. Only events may (the list of events grows, a
// layout is made).
#include "tests/physics/paper_runs.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

namespace {
std::atomic<long> allocations{0};

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}
} // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
// The library's temporary buffers ask in this way and give back through the plain delete.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size ? size : 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const std::size_t a = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(a, (size + a - 1) / a * a)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

using namespace steplap;
using namespace steplap::testing;

TEST_CASE("no step of the paper's transformer allocates, whatever the method") {
  for (const Condition condition : {Condition::no_interference, Condition::interference})
    for (const char* integrator : {"rk4", "tsit5", "dop853"}) {
      CAPTURE(std::string(integrator));
      const auto system = compile(paper_model(condition));
      SimulationOptions o = options({integrator, std::string(integrator) == "rk4" ? 1e-4 : 1e-9, 0.8});
      o.output_step = 0.0; // samples go into a growing trajectory
      Simulation simulation(*system, system->initial_state(), o);
      long steps = 0, allocating = 0, at_breakpoints = 0;
      for (;;) {
        const std::size_t events = simulation.events().size();
        const long restarts = simulation.statistics().events, before = allocations;
        const bool is_on = simulation.advance();
        const long made = allocations - before;
        if (!is_on) break;
        if (simulation.events().size() != events || simulation.statistics().events != restarts) continue;
        ++steps;
        if (made > 0) ++allocating;
        if (made > 0 && (std::abs(simulation.state().t - 0.05) < 1e-12 || std::abs(simulation.state().t - 0.15) < 1e-12))
          ++at_breakpoints;
      }
      CHECK(steps > 100);
      CHECK(allocating - at_breakpoints == 0); // at a breakpoint all modes are decided anew
      CHECK(at_breakpoints <= 2);
    }
}
