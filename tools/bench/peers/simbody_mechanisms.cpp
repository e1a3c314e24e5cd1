// B1, B2 and B3 in Simbody, a general multibody program. Mechanisms are trees of pins about z; a loop is closed by constraining a point to
// a line along z (two equations). Integrated by Simbody's Runge-Kutta-Merson method with projection.

#include "ladder.h"
#include "mechanisms.h"

#include <Simbody.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <vector>

namespace steplap::peers {
namespace {

using SimTK::MobilizedBody;
using SimTK::Transform;
using SimTK::Vec3;

const SimTK::UnitVec3 k_normal(0, 0, 1);

// Returns a flat body, whose moments of inertia about x and y are half of that about z.
SimTK::Body::Rigid flat_body(double mass, double inertia, const Vec3& centre) {
  const SimTK::Inertia about_centre(0.5 * inertia, 0.5 * inertia, inertia);
  return SimTK::Body::Rigid(SimTK::MassProperties(mass, centre, about_centre.shiftFromMassCenter(centre, mass)));
}

struct SimbodyModel {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
};

// Projection after every step onto tight constraints costs little, and keeps the four-bars on their branch in the flat positions. With the
// integrator's default they leave it. With tolerances below 1e-9 the integrator stops in these positions.
enum class Projection { own_choice, every_step };
constexpr double k_tight_constraints = 1e-9;

MechanismResult integrate(const SimbodyModel& scene, SimTK::State& state, double end, double accuracy, Projection projection) {
  SimTK::RungeKuttaMersonIntegrator integrator(scene.system);
  integrator.setAccuracy(accuracy);
  if (projection == Projection::every_step) {
    integrator.setConstraintTolerance(k_tight_constraints);
    integrator.setProjectEveryStep(true);
  }
  MechanismResult result;
  const double start = cpu_seconds();
  try {
    integrator.initialize(state);
    integrator.setFinalTime(end);
    while (integrator.getTime() < end && integrator.stepTo(end) != SimTK::Integrator::EndOfSimulation) {}
  } catch (const std::exception&) {
    // the integrator failed; the error is that of the last state
  }
  result.cpu_ms = 1e3 * (cpu_seconds() - start);
  state = integrator.getState();
  result.steps = integrator.getNumStepsTaken();
  result.evaluations = integrator.getNumRealizations();
  return result;
}

} // namespace

MechanismResult run_pendulum_simbody(double accuracy) {
  SimbodyModel scene;
  SimTK::Force::UniformGravity(scene.forces, scene.matter, Vec3(0, -9.81, 0));
  const SimTK::Body::Rigid point(SimTK::MassProperties(1.0, Vec3(0, -1, 0), SimTK::Inertia(Vec3(0, -1, 0), 1.0)));
  MobilizedBody::Pin arm(scene.matter.Ground(), Transform(), point, Transform());
  SimTK::State state = scene.system.realizeTopology();
  arm.setAngle(state, -0.5 * SimTK::Pi);
  MechanismResult result = integrate(scene, state, k_pendulum_end, accuracy, Projection::own_choice);
  const double angle = arm.getAngle(state);
  result.error = std::max(std::abs(std::sin(angle) - k_pendulum_x), std::abs(-std::cos(angle) - k_pendulum_y));
  return result;
}

MechanismResult run_four_bar_simbody(const FourBarExact& exact, double accuracy) {
  SimbodyModel scene;
  SimTK::Force::UniformGravity(scene.forces, scene.matter, Vec3(0, -9.81, 0));
  const SimTK::Body::Rigid rod = flat_body(1.0, 1.0 / 12.0, Vec3(0, 0.5, 0));
  const SimTK::Body::Rigid bar = flat_body(1.0, 1.0 / 12.0, Vec3(0.5, 0, 0));
  std::vector<MobilizedBody::Pin> rods;
  std::vector<MobilizedBody::Pin> bars;
  for (int i = 0; i <= exact.windows; ++i) rods.emplace_back(scene.matter.Ground(), Transform(Vec3(i, 0, 0)), rod, Transform());
  for (int i = 0; i < exact.windows; ++i) {
    auto& carrier = rods[static_cast<std::size_t>(i)];
    auto& next = rods[static_cast<std::size_t>(i) + 1];
    bars.emplace_back(carrier, Transform(Vec3(0, 1, 0)), bar, Transform());
    SimTK::Constraint::PointOnLine(next, k_normal, Vec3(0, 1, 0), bars.back(), Vec3(1, 0, 0));
  }
  SimTK::State state = scene.system.realizeTopology();
  for (auto& r : rods) r.setRate(state, -1.0);
  for (auto& b : bars) b.setRate(state, 1.0); // rate relative to the rod: the bar stays horizontal
  MechanismResult result = integrate(scene, state, k_four_bar_end, accuracy, Projection::every_step);
  const double angle = rods[0].getAngle(state);
  result.error = std::max(std::abs(-std::sin(angle) - exact.x), std::abs(std::cos(angle) - exact.y));
  return result;
}

MechanismResult run_andrews_simbody(AndrewsVariant variant, double accuracy) {
  SimbodyModel scene;
  auto& ground = scene.matter.Ground();
  const Transform a(Vec3(-0.06934, -0.00227, 0));
  const Transform b(Vec3(-0.03635, 0.03273, 0));
  MobilizedBody::Pin crank(ground, Transform(), flat_body(0.04325, 2.194e-6, Vec3(0.00092, 0, 0)), Transform());
  MobilizedBody::Pin k2(crank, Transform(Vec3(0.007, 0, 0)), flat_body(0.00365, 4.410e-7, Vec3(-0.0115, 0, 0)), Transform());
  MobilizedBody::Pin k3(ground, b, flat_body(0.02373, 5.255e-6, Vec3(0.01043, -0.01874, 0)), Transform());
  MobilizedBody::Pin k5(ground, a, flat_body(0.07050, 1.169e-5, Vec3(0.02308, 0.00916, 0)), Transform());
  MobilizedBody::Pin k4(k5, Transform(Vec3(0.04, 0, 0)), flat_body(0.00706, 5.667e-7, Vec3(0, -0.00579, 0)), Transform());
  MobilizedBody::Pin k7(ground, a, flat_body(0.05498, 1.912e-5, Vec3(-0.00449, -0.01228, 0)), Transform());
  MobilizedBody::Pin k6(k7, Transform(Vec3(0, -0.04, 0)), flat_body(0.00706, 5.667e-7, Vec3(0.00579, 0, 0)), Transform());
  const Vec3 meeting(0, -0.035, 0);
  SimTK::Constraint::PointOnLine(k3, k_normal, meeting, k2, Vec3(-0.028, 0, 0));
  SimTK::Constraint::PointOnLine(k3, k_normal, meeting, k4, Vec3(0, -0.02, 0));
  SimTK::Constraint::PointOnLine(k3, k_normal, meeting, k6, Vec3(0.02, 0, 0));
  SimTK::Force::TwoPointLinearSpring(scene.forces, ground, Vec3(0.014, 0.072, 0), k3, Vec3(0.02, -0.018, 0), 4530.0, 0.07785);
  SimTK::Force::MobilityConstantForce(scene.forces, crank, SimTK::MobilizerUIndex(0), 0.033);
  SimTK::State state = scene.system.realizeTopology();
  MobilizedBody::Pin* const order[7] = {&crank, &k2, &k3, &k4, &k5, &k6, &k7};
  const AndrewsAngles start = assemble_andrews(andrews_start(variant));
  for (int i = 0; i < 7; ++i) order[i]->setAngle(state, start[static_cast<std::size_t>(i)]);
  const int v = static_cast<int>(variant);
  MechanismResult result = integrate(scene, state, k_andrews_end[v], accuracy, Projection::own_choice);
  for (int i = 0; i < 7; ++i)
    result.error = std::max(result.error, std::abs(order[i]->getAngle(state) - k_andrews_exact[v][static_cast<std::size_t>(i)]));
  return result;
}

} // namespace steplap::peers
