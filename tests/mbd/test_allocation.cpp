// Steps allocate nothing: every operator new is counted. Only events may (the list of events grows, a
// layout is made).
#include "tests/physics/model_text.h"
#include "tests/physics/paper_runs.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <utility>

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

namespace {

struct Count {
  long steps = 0, allocating = 0, events = 0;
};

// Steps of a run that neither change a mode nor pass a kink of a signal nor follow on such a one, and those of them
// that allocate. `warm`: from this time on, where lists grow to their length during the first steps.
Count count_allocations(const System& system, SimulationOptions o, double warm) {
  o.output_step = 0.0; // samples go into a growing trajectory
  Simulation simulation(system, system.initial_state(), o);
  Count count;
  bool is_first = true;  // after a change: matrices take the size of the new layout
  std::vector<int> feet; // of each friction element, after the last step
  for (;;) {
    const std::size_t events = simulation.events().size();
    const long restarts = simulation.statistics().events, before = allocations;
    const bool is_on = simulation.advance();
    const long made = allocations - before;
    count.events = static_cast<long>(simulation.events().size());
    if (!is_on) return count;
    const double t = simulation.state().t;
    // At a kink all modes are decided anew.
    const bool is_kink =
        std::any_of(system.breakpoints.begin(), system.breakpoints.end(), [t](double b) { return std::abs(t - b) < 1e-12; });
    // A change between feet at one height is no event, but other rows of friction.
    std::vector<int> feet_now;
    for (const FrictionState& friction : simulation.current_state().friction) feet_now.push_back(friction.foot);
    const bool is_other_foot = std::exchange(feet, feet_now) != feet_now;
    const bool is_change = is_kink || is_other_foot || simulation.events().size() != events || simulation.statistics().events != restarts;
    const bool is_after = std::exchange(is_first, is_change);
    if (t < warm || is_change || is_after) continue;
    ++count.steps;
    if (made > 0) ++count.allocating;
  }
}

// Recording a stage and compiling it allocate: each once for a set of modes, of which there are at most as many as events. No other step
// allocates.
void check_steps(const System& system, SimulationOptions o, double warm, long fewest) {
  o.stage_code = StageCode::never;
  const Count count = count_allocations(system, o, warm);
  CHECK(count.steps > fewest);
  CHECK(count.allocating == 0);
  o.stage_code = StageCode::when_it_pays;
  const Count with_code = count_allocations(system, o, warm);
  CHECK(with_code.steps == count.steps);
  CHECK(with_code.allocating <= 2 * (with_code.events + 1));
}

// A hanging chain, long enough for sparse stage systems, with dry friction in its first bearing.
std::string hanging_chain(int links) {
  std::string text = signal_entry("harmonics", "sway", "amplitudes = [30.0]; frequencies = [1.5]");
  for (int i = 1; i <= links; ++i) {
    const std::string name = "link" + std::to_string(i), last = i == 1 ? "ground" : "link" + std::to_string(i - 1);
    const std::string x = std::to_string(0.1 * i - 0.1), middle = std::to_string(0.1 * i - 0.05);
    text += body(name, "mass = 1.0; inertia = 0.01; position = [" + middle + ", 0.0]") +
            element("revolute", "pin" + std::to_string(i),
                    "a = { body = '" + name + "', at = [" + x + ", 0.0] }; b = { body = '" + last + "', at = [" + x + ", 0.0] }");
  }
  return text + element("joint_friction", "bearing", "a = 'link1'; coordinate = 'angle'; holds = 2.0") +
         element("load", "sway", "at = 'link2'; torque = 'sway'") + "[simulation]\nstep = 1e-3\n";
}

} // namespace

TEST_CASE("no step of the paper's transformer allocates, whatever the method") {
  for (const Condition condition : {Condition::no_interference, Condition::interference})
    for (const char* integrator : {"rk4", "tsit5", "dop853", "rodas5p", "auto", "moreau"}) {
      CAPTURE(std::string(integrator));
      const auto system = compile(paper_model(condition));
      const bool is_fixed = std::string(integrator) == "rk4" || std::string(integrator) == "moreau";
      SimulationOptions o = options({integrator, 1e-9, 0.8});
      o.settings.step = is_fixed ? 1e-4 : 0.0;
      const double warm = is_fixed ? 0.01 : 0.05;
      check_steps(*system, o, warm, 100);
    }
}

TEST_CASE("no step of a chain with sparse stage systems allocates") {
  const auto system = compile(scene(hanging_chain(30)));
  for (const char* integrator : {"rodas5p", "auto", "moreau"}) {
    CAPTURE(std::string(integrator));
    SimulationOptions o = options({integrator, 1e-6, 0.3});
    o.settings.step = std::string(integrator) == "moreau" ? 1e-3 : 0.0;
    const Count count = count_allocations(*system, o, 0.05);
    CHECK(count.steps > 10);
    CHECK(count.allocating == 0);
  }
}

TEST_CASE("no step of an elastic joint that yields allocates, with edges that bear and pressures that change") {
  const std::string text = R"(
gravity = [0.0, 0.0]
[[signal]]
name = "fading"
kind = "trapezoid"
peak = 1.0
start = -10.0
rise = 5.0
fall = 10.0
duration = 20.0
[[signal]]
name = "turn"
kind = "harmonics"
amplitudes = [8e-3]
frequencies = [0.7]
[[signal]]
name = "along"
kind = "harmonics"
amplitudes = [1e-3]
frequencies = [0.5]
phases = [-1.5]
[[body]]
name = "limb"
mass = 10.0
inertia = 1.0
[[element]]
kind = "prescribed_motion"
name = "drive y"
a = "limb"
coordinate = "y"
signal = "along"
[[element]]
kind = "prescribed_motion"
name = "drive turn"
a = "limb"
coordinate = "angle"
signal = "turn"
[[element]]
kind = "step_lap_joint"
name = "joint"
limb = "limb"
active_part = "ground"
tangential_stiffness = 1e6
edge_stiffness = 1e6
pressure_signal = "fading"
[[element]]
kind = "step_lap_interface"
name = "sheets"
joint = "joint"
yoke = [[-0.5, 0.0], [0.5, 0.0], [0.5, 0.4], [-0.5, 0.4]]
limb = [[-0.25, -1.0], [0.25, -1.0], [0.25, 0.01], [-0.25, 0.01]]
pressure = 1e5
pressure_gradient = [1e5, 0.0]
static_friction = 0.2
clearance = 1e-4
[simulation]
step = 1e-3
)";
  const auto system = compile(scene(text));
  for (const char* integrator : {"rk4", "dop853", "rodas5p"}) {
    CAPTURE(std::string(integrator));
    SimulationOptions o = options({integrator, std::string(integrator) == "rk4" ? 1e-4 : 1e-8, 0.3, 0.3});
    check_steps(*system, o, 0.05, 0);
    CHECK(count_allocations(*system, o, 0.2).allocating == 0); // by then the code exists, or is not worth while
  }
}
