// The scenes of scaling.h in Simbody: a tree of pins (recursive equations of order n), and free planar bodies on springs. Integrated by
// Simbody's Runge-Kutta-Merson method with constant step.
#include "scaling.h"

#include <Simbody.h>

#include <memory>
#include <vector>

namespace steplap::peers {

namespace {

using SimTK::MobilizedBody;
using SimTK::Transform;
using SimTK::Vec3;

struct SimbodyModel {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  SimTK::Force::UniformGravity gravity{forces, matter, Vec3(0, -k_gravity, 0)};
};

SimTK::Body::Rigid flat_body(double inertia, const Vec3& centre) {
  const SimTK::Inertia about_centre(0.5 * inertia, 0.5 * inertia, inertia);
  return SimTK::Body::Rigid(SimTK::MassProperties(1.0, centre, about_centre.shiftFromMassCenter(centre, 1.0)));
}

ScalingResult run(const SimbodyModel& scene, const SimTK::State& start, int bodies, const MobilizedBody& last, const Vec3& point) {
  SimTK::RungeKuttaMersonIntegrator integrator(scene.system);
  integrator.setFixedStepSize(k_scaling_step);
  integrator.setAccuracy(0.9); // so low that no step is rejected
  integrator.initialize(start);
  ScalingResult result;
  int done = 0;
  const int before = integrator.getNumRealizations();
  result.step_us = least_step_us(bodies, [&](int steps) {
    done += steps;
    const double end = done * k_scaling_step;
    // The first call only reports the initial state.
    while (integrator.getTime() < end * (1.0 - 1e-12)) integrator.stepTo(end);
  });
  const double taken = integrator.getNumStepsTaken();
  result.step_us *= done / taken;
  result.evaluations = (integrator.getNumRealizations() - before) / taken;
  scene.system.realize(integrator.getState(), SimTK::Stage::Position);
  result.probe = last.findStationLocationInGround(integrator.getState(), point)[1];
  return result;
}

} // namespace

ScalingResult run_chain_simbody(int rods) {
  SimbodyModel scene;
  const SimTK::Body::Rigid rod = flat_body(k_rod_inertia, Vec3(0.5, 0, 0));
  MobilizedBody last = scene.matter.Ground();
  for (int i = 0; i < rods; ++i) last = MobilizedBody::Pin(last, Transform(Vec3(i == 0 ? 0.0 : 1.0, 0, 0)), rod, Transform());
  const SimTK::State state = scene.system.realizeTopology();
  return run(scene, state, rods, last, Vec3(0.5, 0, 0));
}

ScalingResult run_grid_simbody(int side) {
  SimbodyModel scene;
  const SimTK::Body::Rigid mass = flat_body(0.01, Vec3(0));
  std::vector<MobilizedBody::Planar> bodies;
  const auto spring = [&scene](const MobilizedBody& a, const MobilizedBody& b, const Vec3& at) {
    SimTK::Force::TwoPointLinearSpring(scene.forces, a, Vec3(0), b, at, k_grid_stiffness, 1.0);
    SimTK::Force::TwoPointLinearDamper(scene.forces, a, Vec3(0), b, at, k_grid_damping);
  };
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      bodies.emplace_back(scene.matter.Ground(), Transform(), mass, Transform());
      const std::size_t i = bodies.size() - 1;
      if (r == 0) spring(bodies[i], scene.matter.Ground(), Vec3(c, 1, 0));
      else spring(bodies[i], bodies[i - static_cast<std::size_t>(side)], Vec3(0));
      if (c > 0) spring(bodies[i], bodies[i - 1], Vec3(0));
    }
  SimTK::State state = scene.system.realizeTopology();
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) bodies[static_cast<std::size_t>(r * side + c)].setQ(state, Vec3(0, c, -r));
  return run(scene, state, side * side, bodies.back(), Vec3(0));
}

} // namespace steplap::peers
