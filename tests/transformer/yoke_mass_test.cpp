// What the yokes of a core weigh, against a sum over all sheets and, of each sheet, over rows of its yoke: in every row the stretch that the
// cuts of the limbs leave, with nothing of transformer/.
#include "mbd/io/reader.h"
#include "tests/random/random_number.h"
#include "transformer/catalog.h"
#include "transformer/core/core_builder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <sstream>

using namespace steplap;
using steplap::random::RandomNumber;

namespace {

constexpr double k_thickness = 0.3e-3, k_density = 7650.0, k_limb = 1.5; // m, kg/m³, m: axes of the outer limbs at ±1.5 m

struct Yokes {
  std::vector<Vec2> packets; ///< width, depth, m
  std::vector<double> heights;
  std::string book = "saw_tooth", steps_of_yokes = "both";
  double pitch = 5e-3, clearance = 0.5e-3, mitre = 0.0, notch = 0.25 * std::numbers::pi; ///< mitre of zero: from corner to corner
  long steps = 5, per_layer = 1;
  bool has_middle = false;

  explicit Yokes(RandomNumber& random) {
    const int count = 1 + static_cast<int>(random.between(0.0, 2.99));
    for (int i = 0; i < count; ++i) {
      packets.emplace_back(random.between(0.42, 0.6), random.between(0.01, 0.03));
      heights.push_back(random.between(0.45, 0.6));
    }
    const char* const books[] = {"saw_tooth", "zig_zag", "zig_zag_doubled"};
    book = books[static_cast<int>(random.between(0.0, 2.99))];
    const char* const places[] = {"both", "window", "outside"};
    steps_of_yokes = places[static_cast<int>(random.between(0.0, 2.99))];
    pitch = random.between(3e-3, 9e-3);
    clearance = random.between(0.0, 2e-3);
    steps = 2 + static_cast<long>(random.between(0.0, 4.99));
    per_layer = 1 + static_cast<long>(random.between(0.0, 1.99));
    has_middle = random.between(0.0, 1.0) < 0.5;
    if (random.between(0.0, 1.0) < 0.5) mitre = 0.25 * std::numbers::pi;
  }

  [[nodiscard]] std::string text() const {
    std::ostringstream out;
    out << std::setprecision(17) << "[[body]]\nname = \"part\"\nmass = 80000\ninertia = 60000\n";
    for (const double x : {k_limb, -k_limb})
      out << "[[body]]\nname = \"" << (x > 0.0 ? "front" : "rear") << "\"\nposition = [" << x << ", 0.0]\n";
    if (has_middle) out << "[[body]]\nname = \"middle\"\n";
    out << "[[core]]\nname = \"core\"\nactive_part = \"part\"\nlimbs = [\"front\", \"rear\"]\n"
        << (has_middle ? "middle_limbs = [\"middle\"]\n" : "") << "core_height = 2.6\npackets = [";
    for (const Vec2& packet : packets) out << "[" << packet.x() << ", " << packet.y() << "], ";
    out << "]\nyoke_heights = [";
    for (const double height : heights) out << height << ", ";
    out << "]\nyoke_steps = \"" << steps_of_yokes << "\"\nstacking_factor = 1.0\nsheet_thickness = " << k_thickness
        << "\nsheets_per_layer = " << per_layer << "\nsteps = " << steps << "\nstep_pitch = " << pitch
        << "\npitch_direction = \"across\"\nbook = \"" << book << "\"\nclearance = " << clearance << "\nnotch_angle = " << notch
        << "\npressure = 1e5\nstatic_friction = 0.2\n";
    if (mitre > 0.0) out << "mitre_angle = " << mitre << "\n";
    return out.str();
  }

  /// kg
  [[nodiscard]] double weighed() const {
    double area = 0.0;
    for (std::size_t p = 0; p < packets.size(); ++p)
      for (long i = 0; i < std::lround(std::floor(packets[p].y() / k_thickness + 1e-9)); ++i)
        area += 2.0 * yoke_sheet(p, line(i / per_layer));
    return k_density * k_thickness * area;
  }

private:
  // Across the mitre, off its middle: the order of the book, written out.
  [[nodiscard]] double line(long layer) const {
    std::vector<long> order;
    for (long k = 0; k < steps; ++k) order.push_back(k);
    if (book == "zig_zag")
      for (long k = steps - 2; k > 0; --k) order.push_back(k);
    if (book == "zig_zag_doubled")
      for (long k = steps - 1; k >= 0; --k) order.push_back(k);
    return (static_cast<double>(order[static_cast<std::size_t>(layer) % order.size()]) - 0.5 * static_cast<double>(steps - 1)) * pitch;
  }

  // Height above the window's edge of the row is `y`. A cut at q across the mitre meets it at the place from the window's corner outwards
  // where x sin α − y cos α = q, and what lies farther out is the limb's.
  [[nodiscard]] double yoke_sheet(std::size_t p, double q) const {
    constexpr int k_rows = 3000; // 0.1 to 0.2 mm each: a corner of the outline costs at most the square of that
    const double w = packets[p].x(), height = heights[p], alpha = mitre > 0.0 ? mitre : std::atan2(height, w), own = q - 0.5 * clearance;
    double area = 0.0;
    for (int i = 0; i < k_rows; ++i) {
      const double y = (i + 0.5) * height / k_rows;
      const double outer = (own + y * std::cos(alpha)) / std::sin(alpha); // from the window's corner of an outer limb
      double row = 2.0 * (k_limb - 0.5 * w + std::min(outer, w));
      if (has_middle) row -= 2.0 * std::max(0.0, 0.5 * w - (own + y * std::cos(notch)) / std::sin(notch)); // from there to its axis
      area += row * height / k_rows;
    }
    return area;
  }
};

} // namespace

TEST_CASE("yokes weigh what their sheets do, the slivers beside the windows taken off") {
  RandomNumber random(31);
  for (int i = 0; i < 20; ++i) {
    const Yokes yokes(random);
    CAPTURE(yokes.text());
    const auto steel = yoke_steel(parse_model(yokes.text(), "core.toml", transformer_catalog()), "part");
    REQUIRE(steel);
    // Rows leave less than 1e-8 of a sheet; a sliver forgotten is some 1e-5 of it.
    CHECK(*steel == doctest::Approx(yokes.weighed()).epsilon(3e-8));
  }
}
