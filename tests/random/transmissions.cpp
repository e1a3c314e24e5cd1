#include "tests/random/transmissions.h"

#include <cmath>
#include <iterator>
#include <numbers>

namespace steplap::random {

namespace {

using Fields = SceneWriter::Fields;

constexpr std::uint64_t k_last_without_blows = 15000; // of seeds: scenes in which one-way clutches begin free

// A wheel on a pin, with a brake beside it or none.
struct Wheel {
  std::string name;
  At at;
  double inertia = 0.0, spin = 0.0;
};

Wheel wheel(SceneWriter& w, RandomNumber& own, At at, double radius, double more = 0.0) { // `more`: of its spin, rad/s
  Wheel made;
  const double m = w.mass * own.between(0.5, 2.0);
  made.at = at;
  made.inertia = std::stod(number(0.5 * m * radius * radius));
  made.spin = own.between(-8.0, 8.0) / w.duration + more;
  made.name = w.body(m, made.inertia, at, {{"angular_velocity", number(made.spin)}});
  w.element("revolute", {{"a", marker(made.name, at)}, {"b", marker("ground", at)}}, {made.name});
  if (own.chance(0.5))
    w.element("joint_friction",
              {{"a", quoted(made.name)}, {"holds", number(made.inertia * std::abs(made.spin) / w.duration * own.between(0.2, 3.0))}},
              {made.name});
  return made;
}

void belt(SceneWriter& w, RandomNumber& own, At at) {
  const double radius_a = neat(w.size * own.between(0.2, 0.5)), radius_b = neat(w.size * own.between(0.2, 0.5));
  const Wheel a = wheel(w, own, at, radius_a), b = wheel(w, own, {at.x + 2.0 * w.size, at.y}, radius_b);
  const double k = w.stiffness_for(w.mass, 3.0, 20.0), pull = w.mass * w.size / (w.duration * w.duration) * own.decades(-0.3, 1.0);
  Fields fields{{"a", quoted(a.name)},
                {"b", quoted(b.name)},
                {"radius_a", number(radius_a)},
                {"radius_b", number(radius_b)},
                {"friction_a", number(own.between(0.1, 0.6))},
                {"friction_b", number(own.between(0.1, 0.6))},
                {"stiffness", number(k)},
                {"damping", number(k * w.duration * own.decades(-3.0, -2.0))},
                {"pretension", number(pull)}};
  if (own.chance(0.3)) fields.push_back({"crossed", "true"});
  w.element("belt", fields, {a.name, b.name});
}

// Two masses on a band over a wheel.
void band(SceneWriter& w, RandomNumber& own, At at) {
  const double radius = neat(w.size * own.between(0.3, 0.6)), gravity = std::max(w.gravity, w.size / (w.duration * w.duration));
  const Wheel drum = wheel(w, own, at, radius);
  const double left = w.mass * own.between(0.5, 2.0), right = w.mass * own.between(0.5, 2.0);
  const At at_left{at.x - radius, at.y - 3.0 * w.size}, at_right{at.x + radius, at.y - 3.0 * w.size};
  const std::string a = w.body(left, w.inertia_of(left, 0.2 * w.size), at_left, {}),
                    b = w.body(right, w.inertia_of(right, 0.2 * w.size), at_right, {});
  const double k = w.stiffness_for(left, 3.0, 20.0);
  for (const std::string& hung : {a, b})
    w.element("load", {{"at", quoted(hung)}, {"force", pair(0.0, -(hung == a ? left : right) * gravity)}}, {hung});
  w.element("band",
            {{"a", quoted(a)},
             {"b", quoted(b)},
             {"drum", quoted(drum.name)},
             {"radius", number(-radius)},
             {"friction", number(own.between(0.05, 0.5))},
             {"stiffness", number(k)},
             {"damping", number(k * w.duration * own.decades(-3.0, -2.0))},
             {"pretension", number(left * gravity * own.between(0.3, 1.0))}},
            {a, b, drum.name});
}

void cam(SceneWriter& w, RandomNumber& own, At at) {
  const Wheel turning = wheel(w, own, at, w.size);
  const double m = w.mass * own.between(0.1, 1.0), k = w.stiffness_for(m, 5.0, 40.0), lift = 0.05 * w.size * own.between(0.3, 1.0);
  const At above{at.x, at.y + w.size};
  const std::string follower = w.body(m, w.inertia_of(m, 0.2 * w.size), above, {});
  w.element("prismatic", {{"a", quoted(follower)}, {"b", marker("ground", above)}, {"axis", "[0.0, 1.0]"}}, {follower});
  w.element("load", {{"at", quoted(follower)}, {"force", pair(0.0, -m * lift * 60.0 / (w.duration * w.duration) * own.between(0.3, 3.0))}},
            {follower});
  std::string curve = "[";
  for (int i = 0; i < 8; ++i) curve += (i ? ", " : "") + pair(2.0 * std::numbers::pi * i / 8.0, lift * own.between(0.0, 1.0));
  Fields fields{{"a", quoted(follower)},     {"cam", quoted(turning.name)}, {"lift", curve + "]"},
                {"gap", number(0.1 * lift)}, {"stiffness", number(k)},      {"damping", number(w.damping_for(m, k))}};
  if (own.chance(0.3)) fields.push_back({"holds", "true"});
  w.element("cam", fields, {follower, turning.name});
}

void clutch(SceneWriter& w, RandomNumber& own, At at) {
  const bool is_clockwise = own.chance(0.5);
  // It begins free, or in later scenes often against its lock, which is a blow.
  const double ahead = w.scene.seed > k_last_without_blows ? 0.0 : (is_clockwise ? -17.0 : 17.0) / w.duration;
  const Wheel a = wheel(w, own, at, w.size, ahead), b = wheel(w, own, {at.x, at.y + 3.0 * w.size}, w.size);
  Fields fields{{"a", quoted(a.name)}, {"b", quoted(b.name)}};
  if (is_clockwise) fields.push_back({"free", "\"clockwise\""});
  if (own.chance(0.3)) fields.push_back({"holds", number(a.inertia * 4.0 / (w.duration * w.duration) * own.decades(-0.5, 1.0))});
  w.element("freewheel", fields, {a.name, b.name});
  const std::string s = w.signal(a.inertia * 20.0 / (w.duration * w.duration));
  w.element("load", {{"at", quoted(b.name)}, {"torque", quoted(s)}}, {b.name, s});
}

void gear(SceneWriter& w, RandomNumber& own, At at) {
  const Wheel a = wheel(w, own, at, w.size), b = wheel(w, own, {at.x, at.y + 3.0 * w.size}, w.size);
  const double k = w.stiffness_for(a.inertia, 2.0, 10.0);
  w.element("lossy_gear",
            {{"a", quoted(a.name)},
             {"b", quoted(b.name)},
             {"ratio", number(own.either(0.5, 3.0))},
             {"efficiency", number(own.between(0.6, 1.0))},
             {"stiffness", number(k)},
             {"damping", number(w.damping_for(a.inertia, k) + 0.02 * k * w.duration / 10.0)}},
            {a.name, b.name});
  const std::string s = w.signal(a.inertia * 20.0 / (w.duration * w.duration));
  w.element("load", {{"at", quoted(a.name)}, {"torque", quoted(s)}}, {a.name, s});
}

// A mass at the end of a part of a beam that grows out of a wall.
void beam(SceneWriter& w, RandomNumber& own, At at) {
  const double m = w.mass * own.between(0.5, 2.0), length = neat(w.size), k = w.stiffness_for(m, 0.5, 5.0);
  const double speed = 0.01 * w.size / w.duration, vy = speed * own.between(-3.0, 3.0), vx = speed * own.between(-3.0, 3.0);
  const std::string body = w.body(m, w.inertia_of(m, 0.3 * w.size), at, {{"velocity", pair(vx, vy)}});
  Fields fields{{"a", quoted(body)},
                {"b", marker("ground", at)},
                {"length", number(length)},
                {"axial_stiffness", number(10.0 * k * length)},
                {"bending_stiffness", number(k * length * length * length / 12.0)}};
  if (own.chance(0.5)) fields.push_back({"shear_stiffness", number(5.0 * k * length)});
  if (own.chance(0.5)) fields.push_back({"damping_time", number(w.duration * own.decades(-4.0, -2.0))});
  w.element("beam_part", fields, {body});
}

} // namespace

void add_transmission(SceneWriter& w, RandomNumber own) {
  using Make = void (*)(SceneWriter&, RandomNumber&, At);
  constexpr Make k_all[] = {belt, band, cam, clutch, gear, beam};
  k_all[own.below(static_cast<int>(std::size(k_all)))](w, own, {60.0 * w.size, 0.0});
}

} // namespace steplap::random
