#include "tests/physics/rubbing_bodies.h"

#include "tests/physics/model_text.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace steplap::testing {

namespace {

using random::number;
using random::RandomNumber;

// Tables of a scene, gathered and then written in their order or in the opposite one.
struct Tables {
  std::vector<std::string> signals, bodies, elements;

  [[nodiscard]] std::string text(bool is_reversed) {
    if (is_reversed)
      for (std::vector<std::string>* tables : {&bodies, &elements}) std::reverse(tables->begin(), tables->end());
    std::string all;
    for (const std::vector<std::string>* tables : {&signals, &bodies, &elements})
      all = std::accumulate(tables->begin(), tables->end(), all);
    return all;
  }
};

// A load or a drive that begins within `end` and lasts beyond it; one in four jumps.
std::string lasting_signal(const std::string& name, double peak, double end, RandomNumber& r) {
  const double start = end * r.between(0.1, 0.8), rise = end * r.between(0.05, 0.4);
  const std::string when = "peak = " + number(peak) + "; start = " + number(start) + "; duration = " + number(2.0 * end);
  if (r.chance(0.25)) return signal_entry("rectangle", name, when);
  return signal_entry("trapezoid", name, when + "; rise = " + number(rise) + "; fall = 0.0");
}

void add_deck(Tables& tables, double peak, double end, RandomNumber& r) {
  const double rise = end * r.between(0.1, 0.8);
  tables.signals.push_back(signal_entry(
      "trapezoid", "deck", "peak = " + number(peak) + "; duration = " + number(2.0 * end) + "; rise = " + number(rise) + "; fall = 0.0"));
  tables.bodies.push_back(body("deck", "mass = 10.0; inertia = 1.0"));
  tables.elements.push_back(element("prismatic", "road", "a = 'deck'"));
  tables.elements.push_back(element("prescribed_motion", "drive", "a = 'deck'; signal = 'deck'"));
}

void add_push(Tables& tables, const std::string& on, double peak, double end, RandomNumber& r) {
  tables.signals.push_back(lasting_signal("push " + on, peak, end, r));
  tables.elements.push_back(element("load", "push " + on, "at = '" + on + "'; force_x = 'push " + on + "'"));
}

struct Rubbing {
  int on = -1; // body, or −1: the deck
  double holds = 0.0, drags = 0.0;
};

} // namespace

RubbingBodies rubbing_on_guides(int seed, const Writing& writing) {
  RandomNumber r(seed);
  RubbingBodies scene;
  Tables tables;
  scene.end = 1.0;
  const int count = 2 + r.below(4);
  const double deck = r.either(3.0, 10.0), size = std::abs(deck);
  add_deck(tables, writing.sign * deck, scene.end, r);
  std::vector<double> mass, carried;
  std::vector<std::vector<Rubbing>> rubs(count);
  for (int i = 0; i < count; ++i) {
    mass.push_back(r.between(0.5, 4.0));
    rubs[i].push_back({i == 0 ? -1 : r.below(i + 1) - 1});
    if (r.chance(0.25)) rubs[i].push_back({i == 0 ? -1 : r.below(i + 1) - 1});
  }
  carried = mass;
  for (int i = count; i-- > 0;)
    if (rubs[i][0].on >= 0) carried[rubs[i][0].on] += carried[i];
  std::vector<double> force(count, 0.0);
  for (int i = 0; i < count; ++i) {
    const std::string name = "m" + std::to_string(i);
    tables.bodies.push_back(body(name, "inertia = 1.0; mass = " + number(mass[i])));
    tables.elements.push_back(element("prismatic", "guide " + name, "a = '" + name + "'"));
    for (std::size_t k = 0; k < rubs[i].size(); ++k) {
      Rubbing& rub = rubs[i][k];
      rub.holds = carried[i] * size * (k == 0 ? r.between(0.3, 1.3) : r.between(0.1, 0.5));
      rub.drags = rub.holds * r.between(0.2, 0.7);
      const std::string on = rub.on < 0 ? "deck" : "m" + std::to_string(rub.on), friction = "f" + std::to_string(k) + " " + name;
      tables.elements.push_back(element("joint_friction", friction,
                                        "a = '" + name + "'; b = '" + on + "'; coordinate = 'x'; holds = " +
                                            number(writing.grip * rub.holds) + "; drags = " + number(writing.grip * rub.drags)));
      scene.frictions.push_back(friction);
      force[i] += rub.holds;
      if (rub.on >= 0) force[rub.on] += rub.holds;
    }
    if (r.chance(0.6)) {
      const double push = mass[i] * size * r.either(0.2, 1.0);
      add_push(tables, name, writing.sign * push, scene.end, r);
      force[i] += std::abs(push);
    }
    scene.places.push_back(name + ".x");
  }
  scene.acceleration = size;
  for (int i = 0; i < count; ++i) scene.acceleration = std::max(scene.acceleration, force[i] / mass[i]);
  scene.text = k_no_gravity + tables.text(writing.is_reversed);
  return scene;
}

RubbingBodies stacked_crates(int seed, const Writing& writing) {
  constexpr double k_gravity = 9.81, k_half_height = 0.1;
  RandomNumber r(seed);
  RubbingBodies scene;
  Tables tables;
  scene.end = 1.0;
  const int count = 2 + r.below(2);
  const double deck = r.either(2.0, 7.0);
  add_deck(tables, writing.sign * deck, scene.end, r);
  std::vector<double> mass;
  for (int i = 0; i < count; ++i) mass.push_back(100.0 * r.between(0.5, 2.0));
  scene.acceleration = std::abs(deck);
  for (int i = 0; i < count; ++i) {
    const std::string n = std::to_string(i), name = "crate " + n, on = i == 0 ? "deck" : "crate " + std::to_string(i - 1);
    const double weight = k_gravity * std::accumulate(mass.begin() + i, mass.end(), 0.0), level = i == 0 ? 0.0 : k_half_height;
    tables.bodies.push_back(body(name, "mass = " + number(mass[i]) + "; inertia = " + number(0.5 * mass[i]) + "; position = [0.0, " +
                                           number((2.0 * i + 1.0) * k_half_height) + "]"));
    for (const double side : {-1.0, 1.0})
      tables.elements.push_back(element("unilateral_contact", (side < 0.0 ? "left " : "right ") + n,
                                        "a = { body = '" + name + "', point = [" + number(writing.sign * side) + ", " +
                                            number(-k_half_height) + "] }; b = { body = '" + on + "', point = [0.0, " + number(level) +
                                            "] }; stiffness = 1e7; damping = 1e5; preload = " + number(0.5 * weight)));
    const double mu = std::abs(deck) / k_gravity * r.between(0.6, 1.8), falls_to = r.between(0.3, 0.95);
    tables.elements.push_back(element("coulomb_stick", "friction " + n,
                                      "contacts = ['left " + n + "', 'right " + n + "']; static_friction = " + number(writing.grip * mu) +
                                          "; kinetic_friction = " + number(writing.grip * mu * falls_to)));
    scene.frictions.push_back("friction " + n);
    const double push = mass[i] * std::abs(deck) * r.either(0.2, 1.0);
    add_push(tables, name, writing.sign * push, scene.end, r);
    scene.places.push_back(name + ".x");
    scene.acceleration = std::max(scene.acceleration, (std::abs(push) + 2.0 * mu * weight) / mass[i]);
  }
  scene.text = tables.text(writing.is_reversed);
  return scene;
}

RubbingBodies limbs_on_sliding_base(int seed, const Writing& writing) {
  constexpr double k_count = 100.0, k_half_side = 0.3;
  RandomNumber r(seed);
  RubbingBodies scene;
  Tables tables;
  scene.end = 0.5;
  const int count = 1 + r.below(2);
  const double acceleration = r.between(3.0, 10.0), mass = r.between(1000.0, 5000.0);
  double whole = mass;
  tables.bodies.push_back(body("base", "inertia = 3000.0; mass = " + number(mass)));
  tables.elements.push_back(element("prismatic", "road", "a = 'base'"));
  scene.acceleration = acceleration;
  for (int i = 0; i < count; ++i) {
    const std::string n = std::to_string(i), name = "limb " + n;
    const double limb = r.between(500.0, 2000.0), at = writing.sign * (1.5 * i - 0.75 * (count - 1)), height = r.between(-0.1, 0.1);
    whole += limb;
    tables.bodies.push_back(body(name, "mass = " + number(limb) + "; inertia = " + number(0.5 * limb) + "; position = [" + number(at) +
                                           ", " + number(height) + "]"));
    const double mu = 0.25, falls_to = r.between(0.3, 0.95), area = 4.0 * k_half_side * k_half_side;
    const double pressure = limb * acceleration * r.between(0.6, 2.0) / (mu * k_count * area);
    const auto square = [](double x, double half) {
      return "[[" + number(x - half) + ", " + number(-half) + "], [" + number(x + half) + ", " + number(-half) + "], [" + number(x + half) +
             ", " + number(half) + "], [" + number(x - half) + ", " + number(half) + "]]";
    };
    tables.elements.push_back(element("step_lap_joint", "joint " + n, "limb = '" + name + "'; active_part = 'base'"));
    tables.elements.push_back(element("step_lap_interface", "corner " + n,
                                      "joint = 'joint " + n + "'; yoke = " + square(at, 1.0) + "; limb = " + square(0.0, k_half_side) +
                                          "; count = " + number(k_count) + "; static_friction = " + number(mu) + "; kinetic_friction = " +
                                          number(mu * falls_to) + "; pressure = " + number(writing.grip * pressure)));
    scene.frictions.push_back("joint " + n);
    scene.places.push_back(name + ".x");
    scene.places.push_back(name + ".theta");
    if (r.chance(0.7)) {
      const double push = limb * acceleration * r.either(0.1, 0.6);
      add_push(tables, name, writing.sign * push, scene.end, r);
      scene.acceleration = std::max(scene.acceleration, acceleration + std::abs(push) / limb);
    }
  }
  const double holds = whole * r.between(2.0, 5.0), drags = holds * r.between(0.3, 0.95);
  tables.elements.push_back(
      element("joint_friction", "skids",
              "a = 'base'; coordinate = 'x'; holds = " + number(writing.grip * holds) + "; drags = " + number(writing.grip * drags)));
  scene.frictions.push_back("skids");
  scene.places.push_back("base.x");
  add_push(tables, "base", writing.sign * (whole * acceleration + drags), scene.end, r);
  scene.acceleration += 2.0 * (holds + whole * acceleration) / mass;
  scene.text = k_no_gravity + tables.text(writing.is_reversed);
  return scene;
}

} // namespace steplap::testing
