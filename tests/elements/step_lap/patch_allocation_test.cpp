// The functions that an integrator calls do not allocate once their storage has grown.
#include "patch_cases.h"

#include "elements/step_lap/patch/admissible_projection.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<long> g_allocations{0};
}

void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

using namespace steplap;

TEST_CASE("patch: nothing allocates inside a step") {
  const Outline unit = make_outline({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}});
  const Outline skew = make_outline({{{0, 0}, {1, 0.1}, {1.2, 1}, {0.1, 1.1}}, {}});
  OverlapWorkspace workspace;
  Region overlap;
  Patch patch;
  double sink = 0;
  const Outline ring = make_outline({{{-1, -1}, {2, -1}, {2, 2}, {1, 2}, {0.5, 0.75}, {0, 2}, {-1, 2}},
                                     {{{0.25, 0.25}, {0.75, 0.25}, {0.5, 0.5}}, {{1, 0}, {1.5, 0}, {1.5, 0.25}}}});
  const Outline ell = make_outline({{{0, 0}, {2, 0}, {2, 0.5}, {0.5, 0.5}, {0.5, 2}, {0, 2}}, {}});
  const auto step = [&](double x) {
    intersect(ring, ell, {x, 0.2, 2 * x}, workspace, overlap);
    sink += penetration(ring, ell, {x, 0.2, 2 * x}, workspace) + area(overlap);
    intersect(ring, ring, {x, 0.2, x}, workspace, overlap);
    sink += area(overlap);
    intersect(unit, skew, {x, 0.2, 0.3 * x}, workspace, overlap);
    sink += penetration(unit, skew, {x, 0.2, 0.3 * x}, workspace);
    patch.clear({0.5, 0.5});
    patch.add(overlap, 1.0);
    sink += evaluate(patch, {x, 1, 0.2}).h + evaluate(patch, {1, 1, 1e-3}).h;
    const RequiredPressure r = required_pressure(patch, {x, 0.3, 0.1});
    sink += required_pressure(patch, {x, 0.2, 0.1}, r.direction).evaluations;
    sink += admissible_wrench(patch, Mat3::Identity(), {x, 2, 1}).wrench[0];
  };
  const long at_start = g_allocations;
  const auto steps = [&] {
    for (const double x : {0.1, 0.5, 3.0, -0.3, -4.0, 0.0, 0.2}) // 3 and −4: apart
      step(x);
  };
  steps();
  const long grown = g_allocations;
  steps();
  const long after = g_allocations;
  CHECK(grown > at_start); // the counter counts
  CHECK(after == grown);
  CHECK(std::isfinite(sink));
}
