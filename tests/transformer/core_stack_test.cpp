// A core's stack laid sheet by sheet: every sheet a polygon, every pair of neighbours intersected, by plain clipping
// of convex rings and counting in and out, with nothing of transformer/. What [[core]] makes of the same core, at the
// pose in which it stands and slid a little, has the same area and the same centre to rounding.
#include "elements/step_lap/patch/overlap.h"
#include "elements/step_lap/step_lap_friction.h"
#include "elements/step_lap/step_lap_interface.h"
#include "mbd/io/reader.h"
#include "mbd/system/system.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <cmath>
#include <iomanip>
#include <numbers>
#include <random>
#include <sstream>

using namespace steplap;

namespace {

constexpr double k_thickness = 0.3e-3, k_density = 7650.0;

struct Case {
  std::vector<Vec2> packets;         ///< width, depth
  std::vector<double> yokes, shares; ///< shares of the pressure: none, or one a packet
  std::string yoke_steps = "both", book = "saw_tooth", direction = "across";
  double core_height = 2.4, pitch = 5e-3, clearance = 0.6e-3, notch = 0.25 * std::numbers::pi;
  double mitre = 0.0; ///< 0: from corner to corner
  long steps = 5, per_layer = 1;
  std::vector<double> ducts;
  std::vector<Vec2> holes;
  double hole = 22e-3;
  bool is_middle = false;
  double side = 1.0;
};

// --- the stack by brute force ---------------------------------------------------------------------------------

struct Line { // n·p ≥ c
  Vec2 n;
  double c;
};

std::vector<Vec2> clipped(const std::vector<Vec2>& ring, const Line& line) {
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const double d = line.n.dot(a) - line.c, e = line.n.dot(b) - line.c;
    if (d >= 0) out.push_back(a);
    if ((d < 0) != (e < 0)) out.emplace_back(a + (b - a) * (d / (d - e)));
  }
  return out;
}

/// Sums of area, its first and its second moment.
struct Sum {
  double area = 0, second = 0;
  Vec2 first{0, 0};
  void add(const std::vector<Vec2>& ring, double weight) {
    if (ring.size() < 3) return;
    const Vec2 o = ring[0]; // thin rings far from the origin: about their own corner, else digits are lost
    double area_here = 0;
    Vec2 first_here{0, 0};
    double second_here = 0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      const Vec2 u = ring[i] - o, v = ring[i + 1] - o;
      const double half = 0.5 * (u.x() * v.y() - u.y() * v.x());
      area_here += half;
      first_here += half * (u + v) / 3;
      second_here += half * (u.squaredNorm() + v.squaredNorm() + u.dot(v)) / 6;
    }
    area += weight * area_here;
    first += weight * (first_here + area_here * o);
    second += weight * (second_here + 2 * first_here.dot(o) + area_here * o.squaredNorm());
  }
};

using Convex = std::vector<Line>;

std::vector<Vec2> ring_of(const Convex& lines) {
  std::vector<Vec2> ring = {{-9, -9}, {9, -9}, {9, 9}, {-9, 9}};
  for (const Line& line : lines) ring = clipped(ring, line);
  return ring;
}

Convex both(Convex a, const Convex& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A sheet: a convex outline with a convex notch and holes taken out.
struct Sheet {
  Convex outline, notch; ///< no notch: empty
  std::vector<Convex> holes;
};

// Of a regular polygon of 24 sides and the circle's area.
Convex hole_at(const Vec2& centre, double diameter) {
  const double step = 2 * std::numbers::pi / 24, radius = 0.5 * diameter * std::sqrt(step / std::sin(step));
  Convex lines;
  for (int i = 0; i < 24; ++i) {
    const double middle = (i + 0.5) * step;
    const Vec2 n(-std::cos(middle), -std::sin(middle));
    lines.push_back({n, n.dot(centre) - radius * std::cos(0.5 * step)});
  }
  return lines;
}

class Brute {
public:
  explicit Brute(const Case& c) : c_(c) {
    for (std::size_t p = 0; p < c.packets.size(); ++p) {
      const long n = std::lround(std::floor(c.packets[p].y() / k_thickness + 1e-9));
      for (long i = 0; i < n; ++i) sheets_.push_back({p, position(i / c.per_layer)});
    }
    for (const double yoke : c.yokes) highest_ = std::max(highest_, yoke);
  }

  /// Of all overlaps at all corners, the limb moved by `move` and turned by `turn` about `pivot`.
  [[nodiscard]] Sum overlaps(const Vec2& move, double turn, const Vec2& pivot, double reach) const {
    Sum sum;
    for (const double level : {1.0, -1.0})
      for (std::size_t i = 0; i + 1 < sheets_.size(); ++i) add_interface(sum, 1.0, i, level, move, turn, pivot, reach);
    return sum;
  }

  /// Force of μ = 0.2 on all interfaces, pressed by p + g·(r − middle of the corner), g outwards and away from the window.
  [[nodiscard]] double force_of(double p, const Vec2& gradient, const Vec2& move, double turn, const Vec2& pivot, double reach) const {
    double force = 0;
    for (const double level : {1.0, -1.0})
      for (const double side : {1.0, -1.0}) {
        if (!c_.is_middle && side != c_.side) continue;
        const Convex half = c_.is_middle ? Convex{{{side, 0}, 0}} : Convex{}; // of a notched yoke, off the axis to that side
        Sum sum;
        for (std::size_t i = 0; i + 1 < sheets_.size(); ++i) add_interface(sum, 1.0, i, level, move, turn, pivot, reach, half);
        const Vec2 g(side * gradient.x(), level * gradient.y());
        // Middle of the mitre: from corner to corner, or from the window's corner to the limb's axis.
        const double quarter = 0.25 * c_.packets[0].x();
        const Vec2 middle = c_.is_middle ? Vec2(side * quarter, level * (0.5 * c_.core_height - highest_ + quarter * std::tan(c_.notch)))
                                         : Vec2(0.0, level * 0.5 * (c_.core_height - highest_));
        force += 0.2 * (p * sum.area + g.dot(sum.first - sum.area * middle));
      }
    return force;
  }

  /// μ = 0.2 of what the interfaces gain per m/s²: held by the share `held` of the steel, less what is in front of each.
  [[nodiscard]] double transverse_force(double held, double reach) const {
    Sum sum;
    for (const double level : {1.0, -1.0})
      for (std::size_t i = 0; i + 1 < sheets_.size(); ++i)
        add_interface(sum, held * static_cast<double>(sheets_.size()) - static_cast<double>(i + 1), i, level, {0, 0}, 0, {0, 0}, reach);
    return 0.2 * k_density * k_thickness * sum.area;
  }

  [[nodiscard]] Sum limb_sheets() const {
    Sum sum;
    for (std::size_t i = 0; i < sheets_.size(); ++i) {
      const double w = c_.packets[sheets_[i].packet].x(), h = 0.5 * height(sheets_[i].packet);
      Convex lines = box(-0.5 * w, 0.5 * w, -h, h);
      for (const double level : {1.0, -1.0}) lines = both(lines, beyond(i, level, 0.5 * c_.clearance));
      sum.add(ring_of(lines), 1);
      for (const double level : {1.0, -1.0})
        for (const Convex& hole : holes(level)) sum.add(ring_of(both(lines, hole)), -1);
    }
    return sum;
  }

  [[nodiscard]] std::size_t sheet_count() const { return sheets_.size(); }

private:
  struct Place {
    std::size_t packet;
    long position;
  };

  // The lines in their order, written out.
  [[nodiscard]] long position(long layer) const {
    std::vector<long> order;
    const long n = c_.steps;
    for (long k = 0; k < n; ++k) order.push_back(k);
    if (c_.book == "zig_zag")
      for (long k = n - 2; k > 0; --k) order.push_back(k);
    if (c_.book == "zig_zag_doubled")
      for (long k = n - 1; k >= 0; --k) order.push_back(k);
    return order[static_cast<std::size_t>(layer) % order.size()];
  }
  [[nodiscard]] double share_of(std::size_t sheet) const { return c_.shares.empty() ? 1.0 : c_.shares[sheets_[sheet].packet]; }
  [[nodiscard]] bool is_parted(std::size_t sheet) const {
    for (const double duct : c_.ducts)
      if (static_cast<std::size_t>(std::lround(duct / k_thickness)) == sheet) return true;
    return false;
  }
  [[nodiscard]] double height(std::size_t packet) const {
    const double less = highest_ - c_.yokes[packet];
    return c_.core_height - (c_.yoke_steps == "both" ? less : c_.yoke_steps == "outside" ? 2 * less : 0.0);
  }
  static Convex box(double x0, double x1, double y0, double y1) {
    return {{{1, 0}, std::min(x0, x1)}, {{-1, 0}, -std::max(x0, x1)}, {{0, 1}, std::min(y0, y1)}, {{0, -1}, -std::max(y0, y1)}};
  }
  [[nodiscard]] double angle(std::size_t packet) const {
    if (c_.is_middle) return c_.notch;
    return c_.mitre > 0 ? c_.mitre : std::atan2(c_.yokes[packet], c_.packets[packet].x());
  }
  /// The cut of sheet i, its limb's side, `shift` off the line.
  [[nodiscard]] Convex beyond(std::size_t i, double level, double shift) const {
    const std::size_t p = sheets_[i].packet;
    const double a = angle(p), w = c_.packets[p].x();
    const double pitch = c_.pitch * (c_.direction == "along_limb" ? std::cos(a) : c_.direction == "along_yoke" ? std::sin(a) : 1.0);
    const double q = (static_cast<double>(sheets_[i].position) - 0.5 * static_cast<double>(c_.steps - 1)) * pitch + shift;
    Convex lines;
    for (const double side : {1.0, -1.0}) {
      if (!c_.is_middle && side != c_.side) continue;
      const Vec2 n(side * std::sin(a), -level * std::cos(a)), corner(-0.5 * side * w, level * (0.5 * height(p) - c_.yokes[p]));
      lines.push_back({n, n.dot(corner) + q});
    }
    return lines;
  }
  [[nodiscard]] std::vector<Convex> holes(double level) const {
    std::vector<Convex> all;
    for (const Vec2& h : c_.holes)
      all.push_back(hole_at({(c_.is_middle ? 1.0 : c_.side) * h.x(), level * (0.5 * (c_.core_height - highest_) + h.y())}, c_.hole));
    return all;
  }
  [[nodiscard]] Sheet limb(std::size_t i, double level) const {
    const std::size_t p = sheets_[i].packet;
    const double w = c_.packets[p].x();
    return {both(box(-0.5 * w, 0.5 * w, 0, 0.5 * level * height(p)), beyond(i, level, 0.5 * c_.clearance)), {}, holes(level)};
  }
  [[nodiscard]] Sheet yoke(std::size_t i, double level, double reach) const {
    const std::size_t p = sheets_[i].packet;
    const double w = c_.packets[p].x(), top = 0.5 * level * height(p), r = std::max(reach, w);
    const Convex strip =
        c_.is_middle ? box(-w, w, top - level * c_.yokes[p], top) : box(-c_.side * r, 0.5 * c_.side * w, top - level * c_.yokes[p], top);
    return {strip, beyond(i, level, -0.5 * c_.clearance), holes(level)};
  }

  // Interface i, behind sheet i: weighted with its packets' share of the pressure, too.
  void add_interface(Sum& sum, double weight, std::size_t i, double level, const Vec2& move, double turn, const Vec2& pivot, double reach,
                     const Convex& half = {}) const {
    if (is_parted(i + 1)) return;
    const double share = weight * 0.5 * (share_of(i) + share_of(i + 1));
    for (const std::size_t of_limb : {i, i + 1}) {
      Sheet of_yoke = yoke(2 * i + 1 - of_limb, level, reach);
      of_yoke.outline = both(of_yoke.outline, half);
      add(sum, share, limb(of_limb, level), of_yoke, move, turn, pivot);
    }
  }

  // limb ∩ yoke = (limb ∩ strip) − (limb ∩ strip ∩ notch), each less the holes of either, what both holes take once.
  void add(Sum& sum, double share, const Sheet& limb, const Sheet& yoke, const Vec2& move, double turn, const Vec2& pivot) const {
    const auto moved = [&](const Convex& lines) {
      Convex out;
      for (const Line& l : lines) {
        const Vec2 n = rotated(l.n, turn);
        out.push_back({n, l.c - l.n.dot(pivot) + n.dot(Vec2(pivot + move))});
      }
      return out;
    };
    const Convex outline = moved(limb.outline);
    for (const bool is_notch : {false, true}) {
      const Convex here = both(both(outline, yoke.outline), is_notch ? yoke.notch : Convex{});
      if (ring_of(here).size() < 3) continue;
      const double sign = is_notch ? -share : share;
      sum.add(ring_of(here), sign);
      for (const Convex& a : limb.holes) {
        const Convex hole = moved(a);
        sum.add(ring_of(both(here, hole)), -sign);
        for (const Convex& b : yoke.holes) sum.add(ring_of(both(both(here, hole), b)), sign);
      }
      for (const Convex& b : yoke.holes) sum.add(ring_of(both(here, b)), -sign);
    }
  }

  const Case& c_;
  std::vector<Place> sheets_;
  double highest_ = 0;
};

// --- the same by [[core]] -----------------------------------------------------------------------------------------

std::string list(const std::vector<double>& numbers) {
  std::ostringstream out;
  out << std::setprecision(17) << "[";
  for (std::size_t i = 0; i < numbers.size(); ++i) out << (i ? ", " : "") << numbers[i];
  out << "]";
  return out.str();
}

std::string list(const std::vector<Vec2>& points) {
  std::string text = "[";
  for (std::size_t i = 0; i < points.size(); ++i) text += (i ? ", " : "") + list(std::vector<double>{points[i].x(), points[i].y()});
  return text + "]";
}

std::string core_text(const Case& c) {
  std::ostringstream out;
  out << std::setprecision(17)
      << "[simulation]\nstep = 1e-3\n[[body]]\nname = \"active part\"\nmass = 40000\ninertia = "
         "60000\n"
      << "[[body]]\nname = \"limb\"\nposition = [" << (c.is_middle ? 0.0 : 1.25 * c.side) << ", 0.0]\n"
      << "[[core]]\nname = \"core\"\nactive_part = \"active part\"\n"
      << (c.is_middle ? "middle_limbs" : "limbs") << " = [\"limb\"]\ncore_height = " << c.core_height << "\npackets = " << list(c.packets)
      << "\nyoke_heights = " << list(c.yokes) << "\nyoke_steps = \"" << c.yoke_steps << "\"\nbook = \"" << c.book
      << "\"\nstep_pitch = " << c.pitch << "\npitch_direction = \"" << c.direction << "\"\nclearance = " << c.clearance
      << "\nsteps = " << c.steps << "\nsheets_per_layer = " << c.per_layer << "\nstacking_factor = 1.0\nsheet_thickness = " << k_thickness
      << "\nnotch_angle = " << c.notch << "\npressure = 1e5\nstatic_friction = 0.2\ndensity = " << k_density << "\n";
  if (c.mitre > 0) out << "mitre_angle = " << c.mitre << "\n";
  std::vector<Vec2> ducts;
  for (const double duct : c.ducts) ducts.emplace_back(duct, 4e-3);
  if (!c.shares.empty()) out << "pressure_shares = " << list(c.shares) << "\n";
  if (!ducts.empty()) out << "ducts = " << list(ducts) << "\n";
  if (!c.holes.empty()) out << "bolt_holes = " << list(c.holes) << "\nbolt_hole_diameter = " << c.hole << "\n";
  return out.str();
}

void compare(const Case& c) {
  const std::string text = core_text(c);
  CAPTURE(text);
  const Model model = parse_model(text, "core.toml", transformer_catalog());
  const Body &limb = *model.find_body("limb"), &part = *model.find_body("active part");
  const Brute stack(c);

  // Steel: sums of some hundred sheets of a square metre each.
  const Sum steel = stack.limb_sheets();
  const double surface = k_density * k_thickness;
  const Vec2 centre = steel.first / steel.area;
  CHECK(limb.mass == doctest::Approx(surface * steel.area).epsilon(1e-12));
  CHECK((limb.cg - centre).norm() < 1e-12);
  CHECK(limb.inertia == doctest::Approx(surface * (steel.second - steel.area * centre.squaredNorm())).epsilon(1e-11));

  const auto system = compile(model);
  const auto& friction = dynamic_cast<const StepLapFriction&>(*system->frictions.at(0).friction);
  const State state = system->initial_state();
  std::vector<Motion<double>> motion(static_cast<std::size_t>(system->body_count()));
  place_bodies(state.q, state.v, motion);
  const Vec2 middle = limb.position - part.position;
  for (const Vec3& slid : {Vec3(0, 0, 0), Vec3(0.15e-3, -0.1e-3, 0), Vec3(-0.1e-3, 0.12e-3, 1e-4)}) {
    CAPTURE(slid);
    Pose pose = friction.pose_of(motion.data());
    pose.x += slid.x();
    pose.y += slid.y();
    pose.theta += slid.z();
    const Patch patch = friction.patch_at(pose, GripLaw::holding);
    const Sum sum = stack.overlaps(slid.head<2>(), slid.z(), limb.cg, std::abs(middle.x()));
    // Corners are good to a few roundings of coordinates of 2 m: 1e-15 m of overlaps some millimetres wide.
    CHECK(patch.force() == doctest::Approx(0.2 * 1e5 * sum.area).epsilon(1e-12));
    CHECK((patch.centroid() - middle - sum.first / sum.area).norm() < 1e-12);
  }
}

class Dice {
public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double between(double a, double b) { return a + (b - a) * static_cast<double>(engine_() % 100000u) / 1e5; }
  long one_of(long n) { return static_cast<long>(engine_() % static_cast<unsigned long>(n)); }

private:
  std::mt19937 engine_;
};

const char* const k_books[] = {"saw_tooth", "zig_zag", "zig_zag_doubled"};
const char* const k_directions[] = {"across", "along_limb", "along_yoke"};

} // namespace

TEST_CASE("ten layers of a book of five: the last book and the ends as they are") {
  for (const char* book : k_books)
    for (const bool is_middle : {false, true}) {
      Case c;
      c.packets = {{0.5, 10 * k_thickness}};
      c.yokes = {0.5};
      c.book = book;
      c.is_middle = is_middle;
      compare(c);
    }
}

TEST_CASE("one packet: any book, any number of layers and sheets in a layer") {
  Dice dice(1);
  for (int i = 0; i < 24; ++i) {
    Case c;
    c.steps = 2 + dice.one_of(6);
    c.per_layer = 1 + dice.one_of(3);
    c.packets = {{dice.between(0.35, 0.7), static_cast<double>(c.per_layer * c.steps + dice.one_of(40)) * k_thickness}};
    c.yokes = {dice.between(0.36, 0.7)};
    c.book = k_books[dice.one_of(3)];
    c.direction = k_directions[dice.one_of(3)];
    c.pitch = dice.between(3e-3, 8e-3);
    c.is_middle = i % 3 == 2;
    c.side = i % 2 ? 1.0 : -1.0;
    if (i % 4 == 1) c.mitre = dice.between(0.7, 0.9);
    c.notch = dice.between(0.5, 0.75);
    compare(c);
  }
}

TEST_CASE("stepped sections with ducts: packets, and where they meet") {
  Dice dice(2);
  for (int i = 0; i < 18; ++i) {
    Case c;
    c.steps = 2 + dice.one_of(4);
    c.per_layer = 1 + dice.one_of(2);
    c.book = k_books[dice.one_of(3)];
    c.yoke_steps = i % 3 == 0 ? "both" : i % 3 == 1 ? "window" : "outside";
    const bool is_round = i % 2 == 0; // yokes as wide as limbs, widths that come again
    const double widths[] = {0.4, 0.5, 0.56, 0.5, 0.4};
    double depth = 0;
    for (const double w : widths) {
      // Three layers at least: of two a duct may leave none that overlap, and such a packet is refused.
      const double d = static_cast<double>(c.per_layer * std::max(3L, c.steps) + dice.one_of(12)) * k_thickness;
      c.packets.emplace_back(w, d);
      c.yokes.push_back(is_round ? w : w + 0.02);
      depth += d;
    }
    for (int k = 0; k < 3; ++k) c.ducts.push_back(static_cast<double>(2 + dice.one_of(std::lround(depth / k_thickness) - 4)) * k_thickness);
    c.ducts.push_back(c.packets[0].y()); // between two packets
    if (i % 3 == 1) c.shares = {0.8, 0.9, 1.2, 0.9, 0.7};
    c.is_middle = i % 4 == 3;
    c.side = i % 2 ? 1.0 : -1.0;
    compare(c);
  }
}

TEST_CASE("bolt holes: inside the sheets, across their cuts, and across the overlaps") {
  Dice dice(3);
  for (int i = 0; i < 8; ++i) {
    Case c;
    c.packets = {{0.5, 23 * k_thickness}, {0.44, 11 * k_thickness}};
    c.yokes = {0.5, 0.44};
    c.book = k_books[dice.one_of(3)];
    c.is_middle = i % 4 == 3;
    c.side = i % 2 ? 1.0 : -1.0;
    // One on the mitre, one near it, one in the limb alone; of a T-joint's point one on its axis.
    if (c.is_middle) c.holes = {{dice.between(-0.1, -0.06), -0.16}, {dice.between(0.05, 0.08), -0.1}};
    else c.holes = {{0.0, dice.between(-3e-3, 3e-3)}, {0.12, dice.between(0.10, 0.14)}, {0.05, dice.between(-0.4, -0.3)}};
    compare(c);
  }
}

TEST_CASE("a pressure linear over a corner, on the polygons as they are: at rest and slid") {
  Dice dice(4);
  for (int i = 0; i < 12; ++i) {
    Case c;
    c.steps = 2 + dice.one_of(4);
    c.book = k_books[dice.one_of(3)];
    c.yoke_steps = i % 3 == 0 ? "both" : i % 3 == 1 ? "window" : "outside";
    for (const double w : {0.4, 0.5, 0.44}) {
      c.packets.emplace_back(w, static_cast<double>(c.steps + dice.one_of(12)) * k_thickness);
      c.yokes.push_back(w);
    }
    if (i % 2 == 0) c.shares = {0.8, 1.1, 0.9};
    c.side = i % 4 < 2 ? 1.0 : -1.0;
    if (i % 3 == 2) c.holes = {{0.0, 0.0}, {0.1, 0.08}};
    const Vec2 gradient(dice.between(-1e5, 1e5), dice.between(-1e5, 1e5));
    const std::string bands = i == 5 ? "bands = \"mean\"\n" : "";
    const Model model =
        parse_model(core_text(c) + bands + "pressure_gradient = " + list(std::vector<double>{gradient.x(), gradient.y()}) + "\n",
                    "core.toml", transformer_catalog());
    const auto system = compile(model);
    const auto& friction = dynamic_cast<const StepLapFriction&>(*system->frictions.at(0).friction);
    const State state = system->initial_state();
    std::vector<Motion<double>> motion(static_cast<std::size_t>(system->body_count()));
    place_bodies(state.q, state.v, motion);
    const Body& limb = *model.find_body("limb");
    for (const Vec3& slid : {Vec3(0, 0, 0), Vec3(0.15e-3, -0.1e-3, 1e-4)}) {
      if (i == 5 && slid.x() != 0.0) continue; // mean bands narrow otherwise than those they stand for
      Pose pose = friction.pose_of(motion.data());
      pose.x += slid.x();
      pose.y += slid.y();
      pose.theta += slid.z();
      const double force = friction.patch_at(pose, GripLaw::holding).force();
      const double brute = Brute(c).force_of(1e5, gradient, slid.head<2>(), slid.z(), limb.cg, 1.25);
      // A band of the mean area has its own middle: off the bands' by a share of its width at the corners, 1e-4 of the mitre.
      CHECK(force == doctest::Approx(brute).epsilon(i == 5 ? 1e-4 : 1e-12));
    }
  }
}

TEST_CASE("a T-joint's pressure grows off its axis to either side: the joint stays symmetric") {
  Case c;
  c.packets = {{0.5, 20 * k_thickness}};
  c.yokes = {0.5};
  c.is_middle = true;
  const auto grip = [&](const std::string& more) {
    const Model model = parse_model(core_text(c) + more, "core.toml", transformer_catalog());
    const auto system = compile(model);
    const auto& friction = dynamic_cast<const StepLapFriction&>(*system->frictions.at(0).friction);
    const State state = system->initial_state();
    std::vector<Motion<double>> motion(static_cast<std::size_t>(system->body_count()));
    place_bodies(state.q, state.v, motion);
    return friction.patch_at(friction.pose_of(motion.data()), GripLaw::holding);
  };
  const Patch uniform = grip(""), outwards = grip("pressure_gradient = [2e5, 0.0]\n");
  CHECK(outwards.centroid().x() == doctest::Approx(uniform.centroid().x()).epsilon(1e-12).scale(1.0));
  CHECK(outwards.gyration() < uniform.gyration()); // off the axis the mitres come nearer to the middle of the limb
  CHECK(outwards.force() == doctest::Approx(Brute(c).force_of(1e5, {2e5, 0.0}, {0, 0}, 0, {0, 0}, 0.0)).epsilon(1e-12));
  const Patch at_top = grip("pressure_gradient = [0.0, 2e5]\nbottom_pressure_gradient = [0.0, 0.0]\n");
  CHECK(at_top.centroid().y() > uniform.centroid().y());
}

TEST_CASE("acceleration across the stack: every packet gains by what leans on it, sheet by sheet") {
  Dice dice(5);
  const std::pair<const char*, double> supports[] = {{"both", 0.5}, {"front", 1.0}, {"back", 0.0}};
  for (int i = 0; i < 9; ++i) {
    const auto& [support, held] = supports[i % 3];
    Case c;
    c.steps = 3;
    c.per_layer = 1 + dice.one_of(2);
    c.book = k_books[dice.one_of(3)];
    for (const double w : {0.4, 0.5, 0.4}) {
      c.packets.emplace_back(w, static_cast<double>(6 * c.per_layer + dice.one_of(20)) * k_thickness);
      c.yokes.push_back(w);
    }
    c.ducts = {c.packets[0].y(), c.packets[0].y() + 4 * k_thickness};
    c.is_middle = i % 4 == 3;
    const std::string slices = std::to_string(1 + dice.one_of(3));
    const Model model = parse_model(core_text(c) + "transverse_acceleration = \"across\"\ntransverse_support = \"" + support +
                                        "\"\ntransverse_slices = " + slices +
                                        "\n[[signal]]\nname = \"across\"\nkind = \"haversine\"\npeak = 9.81\nduration = 0.1\n",
                                    "core.toml", transformer_catalog());
    CAPTURE(support);
    double gained = 0.0, held_now = 0.0;
    for (const ElementEntry& entry : model.elements)
      if (const auto* face = dynamic_cast<const StepLapInterface*>(entry.element.get())) {
        OverlapWorkspace workspace;
        Region region;
        Polygon yoke{face->yoke, face->yoke_cutouts}, limb{face->limb, face->limb_cutouts};
        intersect_exactly(make_outline(yoke), make_outline(limb), {}, workspace, region);
        gained += 0.2 * face->count * area(region) * face->transverse_pressure;
        held_now += 0.2 * face->count * area(region) * face->pressure;
      }
    const double reach = c.is_middle ? 0.0 : 1.25;
    CHECK(gained == doctest::Approx(Brute(c).transverse_force(held, reach)).epsilon(1e-10).scale(1.0));
    CHECK(held_now == doctest::Approx(0.2 * 1e5 * Brute(c).overlaps({0, 0}, 0, {0, 0}, reach).area).epsilon(1e-12));
  }
}
