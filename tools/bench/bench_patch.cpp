// Measures the computing time of friction in step-lap joints: closed form and adaptive quadrature of equal accuracy; required pressure with
// and without a start value; the certified bound; fast and exact overlap; non-convex and convex sheets.
#include "elements/step_lap/patch/overlap.h"
#include "elements/step_lap/patch/required_pressure.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

using namespace steplap;

namespace {

/// Returns a sheet of the paper's joint (one limb) as an outline: yoke or limb sheet, at the upper (+1) or lower (−1) corner.
Outline sheet(double k, double s0, double s1, double q0, double q1) {
  const double r = std::sqrt(0.5);
  const Vec2 corner(-0.25, 1.15 * k), t(r, r * k), n(r, -r * k);
  const auto at = [&](double s, double q) -> Vec2 { return corner + s * t + q * n; };
  return make_outline({{at(s0, q0), at(s1, q0), at(s1, q1), at(s0, q1)}, {}});
}
Outline limb_sheet(double k) { return sheet(k, 0, std::sqrt(0.5), -0.005, 0.05); }
Outline yoke_sheet(double k) { return sheet(k, -0.02, std::sqrt(0.5) + 0.02, -0.05, 0.005); }

Patch joint() {
  Patch patch;
  OverlapWorkspace workspace;
  Region overlap;
  for (const double k : {1.0, -1.0}) {
    intersect(yoke_sheet(k), limb_sheet(k), {}, workspace, overlap);
    patch.add(overlap, 1165 * 0.25 * 0.10e6);
  }
  patch.prepare();
  return patch;
}

Polygon quadrilateral() { return {{{-0.5, -0.3}, {0.6, -0.4}, {0.5, 0.35}, {-0.4, 0.3}}, {}}; }

/// Returns twists about points inside and around the quadrilateral.
std::array<Vec3, 256> near_twists() {
  std::array<Vec3, 256> twists;
  for (std::size_t i = 0; i < twists.size(); ++i) {
    const double a = 2.399963 * static_cast<double>(i), r = std::sqrt(static_cast<double>(i) / 256.0);
    twists[i] = {r * std::sin(a), -r * std::cos(a), 1};
  }
  return twists;
}

/// Integrates by adaptive Gauss-Kronrod (7, 15) quadrature, applied in both directions to the triangles from the first vertex: the usual
/// method without a closed form. Only h is computed; the wrench requires three more integrands.
double adaptive(const auto& f, double a, double b, double tolerance, int depth) {
  static constexpr double x[8] = {0.991455371120813, 0.949107912342759, 0.864864423359769, 0.741531185599394,
                                  0.586087235467691, 0.405845151377397, 0.207784955007898, 0.0};
  static constexpr double wk[8] = {0.022935322010529, 0.063092092629979, 0.104790010322250, 0.140653259715525,
                                   0.169004726639267, 0.190350578064785, 0.204432940075298, 0.209482141084728};
  static constexpr double wg[4] = {0.129484966168870, 0.279705391489277, 0.381830050505119, 0.417959183673469};
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  double kronrod = 0, gauss = 0;
  for (int i = 0; i < 8; ++i) {
    const double v = i == 7 ? f(middle) : f(middle - half * x[i]) + f(middle + half * x[i]);
    kronrod += wk[i] * v;
    if (i % 2 == 1) gauss += wg[i / 2] * v;
  }
  if (std::abs(kronrod - gauss) * half <= tolerance || depth == 0) return kronrod * half;
  return adaptive(f, a, middle, 0.5 * tolerance, depth - 1) + adaptive(f, middle, b, 0.5 * tolerance, depth - 1);
}

double h_by_quadrature(const Polygon& polygon, const Vec3& nu, double tolerance) {
  double sum = 0;
  const Vec2 origin = polygon.outer[0];
  for (std::size_t i = 1; i + 1 < polygon.outer.size(); ++i) {
    const Vec2 e = polygon.outer[i] - origin, f = polygon.outer[i + 1] - origin;
    sum += cross(e, f) * adaptive(
                             [&](double s) {
                               return adaptive(
                                   [&](double t) {
                                     const Vec2 r = origin + s * (e + t * (f - e));
                                     return s * std::hypot(nu[0] - nu[2] * r.y(), nu[1] + nu[2] * r.x());
                                   },
                                   0, 1, 0.1 * tolerance, 30);
                             },
                             0, 1, tolerance, 30);
  }
  return sum;
}

void h_gradient_closed_form(benchmark::State& state) {
  Patch patch;
  patch.add(quadrilateral(), 1);
  patch.prepare();
  const auto twists = near_twists();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(evaluate_gradient(patch, twists[i++ % 256]));
}
BENCHMARK(h_gradient_closed_form);

void h_gradient_hessian_closed_form(benchmark::State& state) {
  Patch patch;
  patch.add(quadrilateral(), 1);
  patch.prepare();
  const auto twists = near_twists();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(patch, twists[i++ % 256]));
}
BENCHMARK(h_gradient_hessian_closed_form);

void h_gradient_hessian_far(benchmark::State& state) {
  Patch patch;
  patch.add(quadrilateral(), 1);
  patch.prepare();
  auto twists = near_twists();
  for (Vec3& nu : twists) nu[2] = 0.05;
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(patch, twists[i++ % 256]));
}
BENCHMARK(h_gradient_hessian_far);

/// Benchmark argument: exponent of the tolerance. The counter "largest_error" shows which tolerance gives 1e-10.
void h_only_quadrature(benchmark::State& state) {
  Patch patch;
  patch.add(quadrilateral(), 1);
  const auto twists = near_twists();
  const double tolerance = std::pow(10.0, -static_cast<double>(state.range(0)));
  double worst = 0;
  for (const Vec3& nu : twists)
    worst = std::max(worst, std::abs(h_by_quadrature(quadrilateral(), nu, tolerance) - evaluate_gradient(patch, nu).h));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(h_by_quadrature(quadrilateral(), twists[i++ % 256], tolerance));
  state.counters["largest_error"] = worst;
}
BENCHMARK(h_only_quadrature)->DenseRange(6, 10, 1);

/// Returns wrenches as they occur in a run: rotating force, varying couple.
std::array<Vec3, 1024> wrenches() {
  std::array<Vec3, 1024> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t = 2 * std::numbers::pi * static_cast<double>(i) / 1024;
    out[i] = {5e4 * std::cos(t), 9e4 + 2e4 * std::sin(3 * t), 3e4 * std::sin(t + 1)};
  }
  return out;
}

void required_pressure_cold(benchmark::State& state) {
  const Patch patch = joint();
  const auto w = wrenches();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(required_pressure(patch, w[i++ % 1024]));
}
BENCHMARK(required_pressure_cold);

void required_pressure_warm(benchmark::State& state) {
  const Patch patch = joint();
  const auto w = wrenches();
  std::size_t i = 0;
  double evaluations = 0;
  Vec3 direction = Vec3::Zero();
  for (auto _ : state) {
    const RequiredPressure r = required_pressure(patch, w[i++ % 1024], direction);
    direction = r.direction;
    evaluations += r.evaluations;
  }
  state.counters["evaluations"] = evaluations / static_cast<double>(state.iterations());
}
BENCHMARK(required_pressure_warm);

void usage_bound_only(benchmark::State& state) {
  const Capacity limits = capacity(joint());
  const auto w = wrenches();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(usage_bounds(limits, w[i++ % 1024]));
}
BENCHMARK(usage_bound_only);

Pose wander(std::size_t i) {
  const double t = static_cast<double>(i % 64) / 64;
  return {2e-3 * t, -1e-3 * t, 1e-3 * t};
}

void overlap_fast(benchmark::State& state) {
  const Outline yoke = yoke_sheet(1), limb = limb_sheet(1);
  OverlapWorkspace workspace;
  Region overlap;
  std::size_t i = 0;
  for (auto _ : state) {
    intersect(yoke, limb, wander(i++), workspace, overlap);
    benchmark::DoNotOptimize(overlap.data());
  }
}
BENCHMARK(overlap_fast);

void overlap_exact(benchmark::State& state) {
  const Outline yoke = yoke_sheet(1), limb = limb_sheet(1);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(exact_intersection(yoke.polygon, limb.polygon, wander(i++)));
}
BENCHMARK(overlap_exact);

/// Measures the work of a sliding joint per evaluation, for both corners: overlap, patch, wrench.
void sliding_joint(benchmark::State& state) {
  const std::array yokes{yoke_sheet(1), yoke_sheet(-1)}, limbs{limb_sheet(1), limb_sheet(-1)};
  OverlapWorkspace workspace;
  Region overlap;
  Patch patch;
  std::size_t i = 0;
  for (auto _ : state) {
    const Pose at = wander(i++);
    patch.clear(Vec2(at.x, at.y));
    for (std::size_t k = 0; k < 2; ++k) {
      intersect(yokes[k], limbs[k], at, workspace, overlap);
      patch.add(overlap, 1165 * 0.25 * 0.10e6);
    }
    benchmark::DoNotOptimize(evaluate_gradient(patch, {0.02, 0.1, 0.1}));
  }
}
BENCHMARK(sliding_joint);

// --- non-convex sheets and convex ones with as many corners ----------------------------------------------

/// Returns a regular polygon of radius 1, or a star if every other corner has the radius `inner`.
Ring regular(int corners, double inner = 1, double scale = 1) {
  Ring ring;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners, r = scale * (i % 2 == 0 ? 1 : inner);
    ring.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  return ring;
}

Polygon ell() { return {{{-1, -1}, {1, -1}, {1, -0.3}, {-0.3, -0.3}, {-0.3, 1}, {-1, 1}}, {}}; }
Polygon u_shape() { return {{{-1, -1}, {1, -1}, {1, 1}, {0.5, 1}, {0.5, -0.4}, {-0.5, -0.4}, {-0.5, 1}, {-1, 1}}, {}}; }
Polygon comb(int teeth) {
  Polygon polygon{{{-1, -1}, {1, -1}}, {}};
  const double width = 2.0 / (2 * teeth - 1);
  for (int i = teeth - 1; i >= 0; --i) {
    const double x = -1 + 2 * i * width;
    polygon.outer.insert(polygon.outer.end(), {{x + width, 1}, {x, 1}});
    if (i > 0) polygon.outer.insert(polygon.outer.end(), {{x, -0.5}, {x - width, -0.5}});
  }
  return polygon;
}
Polygon star(int tips) { return {regular(2 * tips, 0.6), {}}; }
Polygon plate(int hole_corners) { return {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {regular(hole_corners, 1, 0.6)}}; }
Polygon polygon_with(int corners) { return {regular(corners), {}}; }

/// Returns the time of f(pose), s, as the minimum of several trials. Poses are shifts of up to 20 % of the sheet and rotations of up to 1
/// rad.
double seconds(const auto& f) {
  double best = 1;
  for (int trial = 0; trial < 7; ++trial) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 128; ++i) f(Pose{0.003 * i, -0.002 * i + 0.1, 0.0078 * i + 0.01});
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / 128);
  }
  return best;
}

struct SheetTimes {
  double overlap, along_itself, way_apart, evaluation, pieces = 0;
  explicit SheetTimes(const Outline& sheet) {
    OverlapWorkspace workspace;
    Region region;
    Patch patch;
    overlap = seconds([&](const Pose& at) { intersect(sheet, sheet, at, workspace, region); });
    along_itself = seconds([&](const Pose& at) { intersect(sheet, sheet, {at.x, 0, 0}, workspace, region); });
    way_apart = seconds([&](const Pose& at) { benchmark::DoNotOptimize(penetration(sheet, sheet, at, workspace)); });
    evaluation = seconds([&](const Pose& at) {
      intersect(sheet, sheet, at, workspace, region);
      patch.clear(Vec2(at.x, at.y));
      patch.add(region, 1.0);
      benchmark::DoNotOptimize(evaluate_gradient(patch, {0.02, 0.1, 0.1}));
      benchmark::DoNotOptimize(penetration(sheet, sheet, at, workspace));
    });
    seconds([&](const Pose& at) {
      intersect(sheet, sheet, at, workspace, region);
      pieces += static_cast<double>(region.size()) / (128 * 7);
    });
  }
};

/// Measures a sheet on a shifted and rotated copy of itself: overlap alone (µs, and relative to a regular polygon with as many corners),
/// depth for the detection of separation, and the complete work of a sliding joint per evaluation.
void concave_to_convex(benchmark::State& state, const Polygon& polygon) {
  const Outline sheet = make_outline(polygon);
  std::size_t corners = polygon.outer.size();
  for (const Ring& hole : polygon.holes) corners += hole.size();
  const Outline convex = make_outline(polygon_with(static_cast<int>(corners)));
  OverlapWorkspace workspace;
  Region region;
  std::size_t i = 0;
  for (auto _ : state) {
    intersect(sheet, sheet, {0.003 * static_cast<double>(i % 128), 0.1, 0.01 + 0.0078 * static_cast<double>(i % 128)}, workspace, region);
    benchmark::DoNotOptimize(region.data());
    ++i;
  }
  const SheetTimes own(sheet), reference(convex);
  state.counters["corners"] = static_cast<double>(corners);
  state.counters["overlap_us"] = 1e6 * own.overlap;
  state.counters["overlap_ratio"] = own.overlap / reference.overlap;
  state.counters["edge_on_edge_ratio"] = own.along_itself / reference.along_itself;
  state.counters["pieces"] = own.pieces;
  state.counters["apart_ratio"] = own.way_apart / reference.way_apart;
  state.counters["all_us"] = 1e6 * own.evaluation;
  state.counters["all_ratio"] = own.evaluation / reference.evaluation;
}
BENCHMARK_CAPTURE(concave_to_convex, ell, ell());
BENCHMARK_CAPTURE(concave_to_convex, u_shape, u_shape());
BENCHMARK_CAPTURE(concave_to_convex, comb_5_teeth, comb(5));
BENCHMARK_CAPTURE(concave_to_convex, comb_25_teeth, comb(25));
BENCHMARK_CAPTURE(concave_to_convex, star_5_tips, star(5));
BENCHMARK_CAPTURE(concave_to_convex, star_50_tips, star(50));
BENCHMARK_CAPTURE(concave_to_convex, plate_with_square_hole, plate(4));
BENCHMARK_CAPTURE(concave_to_convex, plate_with_round_hole_24, plate(24));
BENCHMARK_CAPTURE(concave_to_convex, plate_with_round_hole_360, plate(360));
BENCHMARK_CAPTURE(concave_to_convex, convex_4, polygon_with(4));
BENCHMARK_CAPTURE(concave_to_convex, convex_24, polygon_with(24));
BENCHMARK_CAPTURE(concave_to_convex, convex_100, polygon_with(100));
BENCHMARK_CAPTURE(concave_to_convex, convex_400, polygon_with(400));

} // namespace

BENCHMARK_MAIN();
