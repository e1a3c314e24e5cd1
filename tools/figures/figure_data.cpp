// Computes the data of figures in docs/: figure_data DIR writes the files that limit_surface.gp and overlap.gp read.
//
// The joint is the front limb of the paper's transformer: two corners mitred at 45°, 1165 interfaces with an overlap of 10 mm, μ = 0.25, p
// = 0.10 MPa. Wrenches refer to the limb's centre of gravity.
#include "elements/step_lap/patch/overlap.h"
#include "elements/step_lap/patch/required_pressure.h"
#include "mbd/base/portable_math.h"
#include "transformer/core/book.h"
#include "transformer/core/corner.h"

#include <cmath>
#include <fstream>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

using namespace steplap;

namespace {

constexpr double k_tongue = 0.05, k_margin = 0.02, k_traction = 0.25 * 1e5;
const Mitre k_mitre{0.5, 3.3, 0.5, {}};

// Overlap of the sheets of neighbouring layers, across the mitre.
struct LapBand {
  double inner = 0.0, outer = 0.0; // edges, m
  double count = 1.0;              // number of interfaces
};
const LapBand k_lap{-0.005, 0.005, 1165.0};

struct Sheets {
  Outline yoke, limb;
};

Sheets sheets(const CornerFrame& corner, const LapBand& lap) {
  return {make_outline({band(corner, -k_margin, corner.length + k_margin, -k_tongue, lap.outer), {}}),
          make_outline({band(corner, 0.0, corner.length, lap.inner, k_tongue), {}})};
}

Region overlap(const Sheets& s, const Pose& moved) {
  OverlapWorkspace workspace;
  Region region;
  intersect(s.yoke, s.limb, moved, workspace, region);
  return region;
}

std::ofstream open(const std::string& path) {
  std::ofstream file(path);
  if (!file) throw std::runtime_error("cannot write " + path);
  file.precision(9);
  return file;
}

/// Returns the overlaps of the joint at the given levels: both corners, or one.
Patch joint(std::initializer_list<double> levels) {
  Patch patch;
  for (const double level : levels) patch.add(overlap(sheets(corner_frame(k_mitre, 1.0, level), k_lap), {}), k_lap.count * k_traction);
  patch.prepare();
  return patch;
}

// --- limit surface -----------------------------------------------------------------------------------------

// Writes the boundary of the limit surface in the plane of wrench components i and j, the third being zero, in kN and kN m. Also writes an
// ellipse with the same capacities along both axes.
void write_section(const std::string& path, const Patch& patch, int i, int j) {
  std::ofstream file = open(path);
  const double a = 1.0 / required_pressure(patch, Vec3::Unit(i)).u, b = 1.0 / required_pressure(patch, Vec3::Unit(j)).u;
  constexpr int k_points = 360;
  for (int k = 0; k <= k_points; ++k) {
    const double phi = 2.0 * std::numbers::pi * k / k_points;
    const Vec3 w = a * portable::cos(phi) * Vec3::Unit(i) + b * portable::sin(phi) * Vec3::Unit(j);
    const double u = required_pressure(patch, w).u;
    file << w[i] / u / 1e3 << ' ' << w[j] / u / 1e3 << ' ' << w[i] / 1e3 << ' ' << w[j] / 1e3 << '\n';
  }
}

// Writes Fx–Fy sections of the limit surface at fixed couples, given as fractions of the largest couple. For each direction the force with
// u = 1 is found by bisection, because u increases along a ray from a point inside.
void write_slices(const std::string& path, const Patch& patch) {
  std::ofstream file = open(path);
  const double most = 1.0 / required_pressure(patch, Vec3::Unit(2)).u;
  for (const double share : {0.0, 0.5, 0.8, 0.95}) {
    for (int k = 0; k <= 180; ++k) {
      const double phi = 2.0 * std::numbers::pi * k / 180;
      double low = 0.0, high = patch.force();
      for (int step = 0; step < 40; ++step) {
        const double f = 0.5 * (low + high);
        const bool is_inside = required_pressure(patch, {f * portable::cos(phi), f * portable::sin(phi), share * most}).u < 1.0;
        (is_inside ? low : high) = f;
      }
      file << low * portable::cos(phi) / 1e3 << ' ' << low * portable::sin(phi) / 1e3 << '\n';
    }
    file << "\n\n";
  }
}

// --- overlap ---------------------------------------------------------------------------------------------------

// Writes a ring in mm along and across the mitre of the top corner.
void write_ring(std::ofstream& file, const CornerFrame& corner, const Ring& ring, const Pose& moved) {
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const Vec2 p = placed(ring[i % ring.size()], moved) - corner.origin;
    file << p.dot(corner.along) * 1e3 << ' ' << p.dot(corner.across) * 1e3 << '\n';
  }
  file << "\n\n";
}

// Writes three blocks: outlines of yoke sheet, limb sheet and overlap.
void write_overlap(const std::string& path, const Pose& moved) {
  std::ofstream file = open(path);
  const CornerFrame corner = corner_frame(k_mitre, 1.0, 1.0);
  const Sheets s = sheets(corner, k_lap);
  write_ring(file, corner, s.yoke.polygon.outer, {});
  write_ring(file, corner, s.limb.polygon.outer, moved);
  for (const Polygon& piece : overlap(s, moved)) write_ring(file, corner, piece.outer, {});
}

// Writes the remaining overlap area of the top corner, relative to the initial one, over the displacement of the limb across its mitre, mm:
// for equal overlaps of 10 mm, and for a book of five steps of 6.25 mm (mean 10 mm).
void write_shrinking(const std::string& path) {
  std::ofstream file = open(path);
  const CornerFrame corner = corner_frame(k_mitre, 1.0, 1.0);
  Book book;
  book.steps = 5;
  book.pitch = 6.25e-3;
  const double half = 0.5 * mean_overlap(book);
  const std::vector<LapBand> mean{{-half, half}};
  std::vector<LapBand> each{
      {line_at(book, 0), line_at(book, book.steps - 1)}}; // between the last layer of a book and the first of the next
  for (long k = 0; k + 1 < book.steps; ++k) each.push_back({line_at(book, k), line_at(book, k + 1)});
  const auto left = [&](const std::vector<LapBand>& bands, double d) {
    double sum = 0.0;
    for (const LapBand& b : bands) sum += area(overlap(sheets(corner, b), {d * corner.across.x(), d * corner.across.y(), 0.0}));
    return sum / static_cast<double>(bands.size());
  };
  const double whole = left(mean, 0.0);
  for (int k = 0; k <= 260; ++k) {
    const double d = k * 1e-4;
    file << d * 1e3 << ' ' << left(mean, d) / whole << ' ' << left(each, d) / whole << '\n';
  }
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: figure_data DIR\n";
    return 2;
  }
  try {
    const std::string folder = std::string(argv[1]) + "/";
    const Patch both = joint({1.0, -1.0});
    write_section(folder + "section_fx_m.dat", both, 0, 2);
    write_section(folder + "section_fy_m.dat", both, 1, 2);
    write_slices(folder + "slices.dat", both);
    const double d = 6e-3 / std::sqrt(2.0); // 6 mm across the mitre
    write_overlap(folder + "overlap_rest.dat", {});
    write_overlap(folder + "overlap_slid.dat", {d, -d, 0.0});
    write_overlap(folder + "overlap_turned.dat", {0.0, 0.0, -0.005});
    write_shrinking(folder + "shrinking.dat");
  } catch (const std::exception& error) {
    std::cerr << "figure_data: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
