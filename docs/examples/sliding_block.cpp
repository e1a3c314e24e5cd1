// Builds a model in C++: a block on two feet is pushed along the floor, slides, and sticks.
//
// Closed form: it sticks after v/(μg) = 0.8495 s, having slid v²/(2μg) = 1.0618 m.
#include <steplap/elements.h>
#include <steplap/model.h>
#include <steplap/simulate.h>

#include <cstdio>
#include <string>

using namespace steplap;

void add_foot(Model& model, const std::string& name, double x) {
  Marker tip;
  tip.name = name;
  tip.body = "block";
  tip.point = Vec2(x, -0.3); // relative to the block's centre, m
  model.markers.push_back(tip);

  auto& foot = add_element<UnilateralContact>(model, unilateral_contact_kind(), name);
  foot.a = name;            // pressed against b, the ground, from above
  foot.stiffness = 20e6;    // N/m
  foot.damping = 50e3;      // N s/m
  foot.preload = 50 * 9.81; // N, half the weight
}

int main() {
  Model model;
  model.simulation.end = 2.0; // s
  model.simulation.tolerance = 1e-9;
  model.output.step = 0.01; // s

  Body block;
  block.name = "block";
  block.mass = 100.0;          // kg
  block.inertia = 10.0;        // kg m²
  block.position = {0.0, 0.3}; // m
  block.velocity = {2.5, 0.0}; // m/s
  model.bodies.push_back(block);
  add_foot(model, "rear foot", -0.5);
  add_foot(model, "front foot", 0.5);

  auto& friction = add_element<CoulombStick>(model, coulomb_stick_kind(), "floor");
  friction.contacts = {"rear foot", "front foot"};
  friction.static_friction = 0.3;

  const Model whole = completed(model); // checks the model; throws ModelError with all errors
  const auto system = compile(whole);
  const RunResult run = simulate(*system, start_of(whole, *system), options_of(whole));

  for (const Event& event : run.events)
    if (event.kind == EventKind::sticks) std::printf("sticks after %.4f s\n", event.t);
  std::printf("has slid %.4f m\n", run.trajectory->series("block.x").back());
}
