#include "tests/random/slip_ends.h"

#include "elements/step_lap/patch/required_pressure.h"
#include "mbd/io/reader.h"
#include "mbd/model/method.h"
#include "mbd/simulation/simulation.h"
#include "tests/elements/step_lap/step_lap_scene.h"
#include "tests/random/random_number.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <cmath>

namespace steplap::random {

namespace {

using step_lap_scene::number;

Patch patch_of(const SlidingSheet& sheet, double traction) {
  Patch patch;
  Polygon polygon;
  polygon.outer = sheet.outline;
  patch.add(polygon, traction);
  patch.prepare();
  return patch;
}

Vec3 turned(const Vec3& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
}

/// Of one sheet: place and angle, velocities.
struct Motion6 {
  Vec3 place = Vec3::Zero(), velocity = Vec3::Zero();
};

class Follower {
public:
  explicit Follower(const SlidingSheet& sheet) : sheet_(sheet), patch_(patch_of(sheet, sheet.kinetic_traction)) {}

  [[nodiscard]] const Patch& patch() const { return patch_; }
  /// Of the joint on the sheet, ground axes.
  [[nodiscard]] Vec3 wrench(const Motion6& m) const {
    const double angle = m.place[2];
    return -turned(evaluate_gradient(patch_, turned(m.velocity, -angle)).gradient, angle);
  }
  [[nodiscard]] Vec3 acceleration(const Motion6& m) const {
    const Vec3 w = wrench(m) + sheet_.load;
    return {w[0] / sheet_.mass, w[1] / sheet_.mass, w[2] / sheet_.inertia};
  }
  /// Of the joint's centre, a rate of turning as a velocity at the gyration radius.
  [[nodiscard]] double speed(const Vec3& velocity, double angle) const {
    const Vec3 nu = turned(velocity, -angle);
    const Vec2 arm = patch_.centroid();
    return Vec3(nu[0] - nu[2] * arm.y(), nu[1] + nu[2] * arm.x(), patch_.gyration() * nu[2]).norm();
  }
  struct Step {
    Motion6 end;
    Vec3 velocity_error = Vec3::Zero(); ///< beside order 4
  };
  /// One step of Dormand and Prince's order 5.
  [[nodiscard]] Step step(const Motion6& m, double h) const {
    static constexpr double a[6][5] = {{0.0, 0.0, 0.0, 0.0, 0.0},
                                       {1.0 / 5, 0.0, 0.0, 0.0, 0.0},
                                       {3.0 / 40, 9.0 / 40, 0.0, 0.0, 0.0},
                                       {44.0 / 45, -56.0 / 15, 32.0 / 9, 0.0, 0.0},
                                       {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729, 0.0},
                                       {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656}};
    static constexpr double b[6] = {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84};
    static constexpr double e[7] = {71.0 / 57600, 0.0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    Vec3 rates[6], pulls[6];
    Step made{m};
    Motion6& end = made.end;
    for (int i = 0; i < 6; ++i) {
      Motion6 at = m;
      for (int j = 0; j < i; ++j) {
        at.place += h * a[i][j] * rates[j];
        at.velocity += h * a[i][j] * pulls[j];
      }
      rates[i] = at.velocity;
      pulls[i] = acceleration(at);
      end.place += h * b[i] * rates[i];
      end.velocity += h * b[i] * pulls[i];
      made.velocity_error += h * e[i] * pulls[i];
    }
    made.velocity_error += h * e[6] * acceleration(end);
    return made;
  }

private:
  const SlidingSheet& sheet_;
  Patch patch_;
};

void widen(const Vec3& w, SlipEnd::Range& range) {
  range.least = range.least.cwiseMin(w);
  range.most = range.most.cwiseMax(w);
}

// What a step's tolerance lets through of the velocity of a joint's centre, m/s: tolerance × (that floor × size + |v|).
double let_through(double tolerance, const SlidingSheet& sheet, double gyration, double fastest) {
  constexpr double k_floor = 0.06; // 1/s
  const double radius = std::sqrt(sheet.inertia / sheet.mass);
  return tolerance * (k_floor * std::max(1.0, radius / gyration) * radius + fastest);
}

// What other directions of slip would have the joint bear where the speed is no more than what a run may be wrong by.
void widen_by_errors(const Follower& follower, const Motion6& m, double speed, double velocity_error, SlipEnd::Range& range) {
  constexpr double k_felt = 1e-3; // turned by less, a wrench is within what is allowed anyway
  if (velocity_error < k_felt * speed) return;
  for (int c = 0; c < 3; ++c)
    for (const double sign : {-1.0, 1.0}) {
      Motion6 wrong = m;
      wrong.velocity[c] += sign * velocity_error / (c < 2 ? 1.0 : follower.patch().gyration());
      widen(follower.wrench(wrong), range);
    }
}

} // namespace

// Steps are this share of speed over grip, so that direction and speed change by no more in one, or shorter where the traction
// turns faster: the centre of rotation passes by a corner or along a slender sheet. Directions tend to their limit as powers of the
// time left, some of them slow: they are followed to a speed below all that a run knows.
SlipEnd follow(const SlidingSheet& sheet, double tolerance) {
  constexpr double k_share = 0.1, k_known = 1e-6, k_last = 1e-12;
  constexpr double k_step_error = 1e-10; // of the speed: some hundred steps sum to less than 1e-7
  constexpr double k_least_share = 1e-6; // a kink is passed by steps so short that it is nothing
  constexpr int k_most_steps = 20000;
  const Follower follower(sheet);
  const Vec2 arm = follower.patch().centroid();
  const double gyration = follower.patch().gyration();
  const double mobility = 1.0 / sheet.mass + (gyration * gyration + arm.squaredNorm()) / sheet.inertia;
  const double grip = mobility * (follower.patch().force() + sheet.load.head<2>().norm() + std::abs(sheet.load[2]) / gyration);
  Motion6 m;
  m.velocity = sheet.velocity;
  SlipEnd end;
  end.size = gyration;
  end.surely = end.perhaps = {-sheet.load, -sheet.load}; // what it holds against at last
  const double first = follower.speed(m.velocity, 0.0);
  double speed = first, fall = grip, share = k_share;
  end.fastest = first;
  const double unknown = let_through(tolerance, sheet, gyration, first); // m/s
  for (int steps = 0; speed > k_last * first; ++steps) {
    if (steps == k_most_steps) return end; // it does not come to rest
    if (speed > k_known * first) widen(follower.wrench(m), end.surely);
    widen(follower.wrench(m), end.perhaps);
    widen_by_errors(follower, m, speed, unknown, end.perhaps);
    const Follower::Step step = follower.step(m, share * speed / grip);
    if (follower.speed(step.velocity_error, m.place[2]) > k_step_error * speed && share > k_least_share) {
      share *= 0.5;
      continue;
    }
    const double h = share * speed / grip;
    share = std::min(2.0 * share, k_share);
    m = step.end;
    end.time += h;
    const double next = follower.speed(m.velocity, m.place[2]);
    fall = (speed - next) / h;
    end.fastest = std::max(end.fastest, next);
    speed = next;
  }
  end.time += speed / fall;
  end.last_fall = fall;
  end.rests = true;
  end.moved = m.place;
  return end;
}

// --- scenes -------------------------------------------------------------------------------------------------------

namespace {

std::vector<Vec2> random_outline(RandomNumber& random, double size) {
  std::vector<Vec2> outline;
  if (random.chance(0.3)) {
    const int sides = 8 + 4 * random.below(3);
    outline = step_lap_scene::disc(0.5 * size, sides);
  } else {
    const double slenderness = random.decades(-1.0, 0.0);
    outline = step_lap_scene::rectangle(-0.5 * size, -0.5 * size * slenderness, 0.5 * size, 0.5 * size * slenderness);
  }
  if (random.chance(0.5)) return outline; // about its centre of gravity
  const Vec2 off(random.between(-0.4, 0.4) * size, random.between(-0.4, 0.4) * size);
  for (Vec2& p : outline) p += off;
  return outline;
}

/// A sheet of a size and a mass that comes to rest within about `time`.
SlidingSheet random_sheet(RandomNumber& random, double time) {
  SlidingSheet sheet;
  const double size = random.decades(-1.5, 1.0);
  sheet.outline = random_outline(random, size);
  sheet.mass = random.decades(-2.0, 4.0);
  const double radius = size * random.decades(-0.4, 0.3);
  sheet.inertia = sheet.mass * radius * radius;
  const double speed = size / time * random.decades(-1.5, 0.3);
  const int kind = random.below(3);
  const double way = random.between(0.0, 2.0 * M_PI);
  if (kind != 1) sheet.velocity.head<2>() = speed * Vec2(std::cos(way), std::sin(way));
  if (kind != 0) sheet.velocity[2] = random.either(0.3, 3.0) * speed / size;
  const double area = patch_of(sheet, 1.0).area();
  sheet.kinetic_traction = sheet.mass * speed / (time * area);
  sheet.static_traction = sheet.kinetic_traction * (random.chance(0.5) ? 1.0 : random.between(1.0, 1.8));
  if (random.chance(0.3)) return sheet;
  // A load that uses some of what the joint bears while it slides: −∇h of any direction is all of it.
  const Vec3 any(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0) / size);
  const double share = random.between(0.05, 0.75);
  sheet.load = share * evaluate_gradient(patch_of(sheet, sheet.kinetic_traction), any).gradient;
  return sheet;
}

bool has_step(const SlipEndScene& scene) { return method(scene.integrator).has_fixed_step || method(scene.integrator).is_time_stepping; }

std::vector<SlipEnd> ends_of(const SlipEndScene& scene) {
  std::vector<SlipEnd> ends;
  for (const SlidingSheet& sheet : scene.sheets) ends.push_back(follow(sheet, has_step(scene) ? 0.0 : scene.tolerance));
  return ends;
}

std::string model_text(const SlipEndScene& scene, const std::vector<SlipEnd>& exact) {
  constexpr double k_held = 1.5; // of the time that sliding takes
  double end = 0.0;
  for (const SlipEnd& e : exact) end = std::max(end, k_held * e.time);
  std::string text = "gravity = [0.0, 0.0]\n[simulation]\nend = " + number(end) + "\nintegrator = \"" + scene.integrator + "\"\n";
  text += has_step(scene) ? "step = " + number(scene.tolerance * exact[0].time) + "\n" : "tolerance = " + number(scene.tolerance) + "\n";
  text += "[output]\n";
  for (std::size_t i = 0; i < scene.sheets.size(); ++i) {
    const SlidingSheet& s = scene.sheets[i];
    const std::string sheet = "sheet" + std::to_string(i), joint = "joint" + std::to_string(i);
    text += step_lap_scene::body(sheet, s.mass, s.inertia, {0.0, 0.0}, s.velocity.head<2>(), s.velocity[2]);
    text += "[[element]]\nkind = \"step_lap_joint\"\nname = \"" + joint + "\"\nlimb = \"" + sheet + "\"\nactive_part = \"ground\"\n";
    const double far = 1e4;
    text += "[[element]]\nkind = \"step_lap_interface\"\nname = \"faces" + std::to_string(i) + "\"\njoint = \"" + joint +
            "\"\nyoke = " + step_lap_scene::points(step_lap_scene::rectangle(-far, -far, far, far)) +
            "\nlimb = " + step_lap_scene::points(s.outline) + "\npressure = " + number(s.static_traction / 0.5) +
            "\nstatic_friction = 0.5\nkinetic_friction = " + number(0.5 * s.kinetic_traction / s.static_traction) + "\n";
    static constexpr const char* components[] = {"force_x", "force_y", "torque"};
    for (int c = 0; c < 3; ++c) {
      if (s.load[c] == 0.0) continue;
      const std::string name = std::string(components[c]) + std::to_string(i);
      text += "[[signal]]\nname = \"of " + name + "\"\nkind = \"constant\"\nvalue = " + number(s.load[c]) + "\n";
      text += "[[element]]\nkind = \"load\"\nname = \"" + name + "\"\nat = { body = \"" + sheet + "\", at = [0.0, 0.0] }\n" +
              components[c] + " = \"of " + name + "\"\n";
    }
  }
  return text;
}

// What a run may be off by: errors of velocity, or k_slip_share of the speed, over how fast the speed falls. They are summed
// over some tens of steps.
double time_slack(const SlipEndScene& scene, const SlipEnd& exact, const SlidingSheet& sheet) {
  constexpr double k_steps = 30.0;
  const Method& m = method(scene.integrator);
  const double rounding = 1e-7 * exact.time; // of follow()
  if (m.is_time_stepping) return rounding + 4.0 * scene.tolerance * exact.time;
  if (m.has_fixed_step) return rounding + 1e-4 * exact.time;
  return rounding + k_steps * let_through(scene.tolerance, sheet, exact.size, exact.fastest) / exact.last_fall;
}

std::string compare(const SlipEndScene& scene, std::size_t i, const SlipEnd& exact, const RunResult& result) {
  const std::string joint = "joint" + std::to_string(i);
  std::vector<double> ends;
  for (const Event& e : result.events)
    if (e.element == joint && e.kind == EventKind::sticks) ends.push_back(e.t);
    else if (e.element == joint && e.t > 0.0) return joint + " " + e.words() + " at " + number(e.t);
  if (ends.size() != 1) return joint + " sticks " + std::to_string(ends.size()) + " times";
  const double late = ends[0] - exact.time, slack = time_slack(scene, exact, scene.sheets[i]);
  if (!(std::abs(late) <= slack)) return joint + " sticks " + number(late) + " s late, for " + number(slack);
  const Patch patch = patch_of(scene.sheets[i], scene.sheets[i].kinetic_traction);
  const double force = patch.force(), couple = force * (patch.gyration() + patch.centroid().norm());
  // Directions are known to a few thousandths near both ends, and to the tolerance.
  const double share = method(scene.integrator).is_time_stepping ? 1.0 : 0.02 + 10.0 * scene.tolerance;
  constexpr double k_symmetric = 1e-4;
  static constexpr const char* components[] = {".fx", ".fy", ".m"};
  for (const ChannelRange& range : result.ranges)
    for (int c = 0; c < 3; ++c) {
      if (range.channel->name != joint + components[c]) continue;
      // What is none by symmetry may be unstable: rounding grows to any direction before the end.
      const double capacity = c < 2 ? force : couple, bound = share * capacity;
      if (exact.perhaps.most[c] - exact.perhaps.least[c] < k_symmetric * capacity) continue;
      const double low = range.low.value, high = range.high.value;
      const bool is_reached = low <= exact.surely.least[c] + bound && high >= exact.surely.most[c] - bound;
      if (!is_reached || low < exact.perhaps.least[c] - bound || high > exact.perhaps.most[c] + bound)
        return range.channel->name + " from " + number(range.low.value) + " at " + number(range.low.t) + " to " + number(range.high.value) +
               " at " + number(range.high.t) + ", exactly " + number(exact.perhaps.least[c]) + " to " + number(exact.perhaps.most[c]);
    }
  return {};
}

} // namespace

// Is the load borne where the sheet comes to rest? In the sheet's axes it has turned.
static bool is_held(const SlidingSheet& sheet) {
  constexpr double k_surely = 0.9;
  const SlipEnd end = follow(sheet);
  const Vec3 pull = turned(sheet.load, -end.moved[2]);
  return end.rests && required_pressure(patch_of(sheet, sheet.kinetic_traction), pull).u <= k_surely;
}

SlipEndScene slip_end_scene(std::uint64_t seed) {
  RandomNumber random(seed);
  SlipEndScene scene;
  const double time = random.decades(-2.5, 0.5);
  const int sheets = random.chance(0.25) ? 2 : 1;
  for (int i = 0; i < sheets; ++i) {
    SlidingSheet sheet = random_sheet(random, time);
    if (!is_held(sheet)) sheet.load *= 0.3;
    if (!is_held(sheet)) sheet.load.setZero();
    scene.sheets.push_back(sheet);
  }
  static const std::vector<std::string> methods = {"auto", "dop853", "tsit5", "rodas5p", "dop853", "tsit5", "rodas5p", "rk4"};
  scene.integrator = random.one_of(methods);
  scene.tolerance = method(scene.integrator).has_fixed_step ? 0.005 : random.decades(-12.0, -3.0);
  return scene;
}

std::string model_text(const SlipEndScene& scene) { return model_text(scene, ends_of(scene)); }

std::string disagreement(const SlipEndScene& scene) {
  const std::vector<SlipEnd> exact = ends_of(scene);
  const step_lap_scene::Run run = step_lap_scene::run_text(model_text(scene, exact));
  for (std::size_t i = 0; i < exact.size(); ++i)
    if (std::string wrong = compare(scene, i, exact[i], run.result); !wrong.empty()) return wrong;
  return {};
}

} // namespace steplap::random
