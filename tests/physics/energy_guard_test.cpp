// The guard of energy (mbd/simulation/energy_account.h): it finds faults sown into forces and friction, and lets honest runs pass with
// the reserve that docs/explanation/theory.md states.
#include "mbd/simulation/energy_account.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_stiffness = 100.0; // N/m

// A spring along x from the ground to a body that stores `told` of what it takes, and pushes the body on with a force of
// `push` that it books as dissipation: −|push| a metre is what friction takes, +|push| what no friction gives.
struct Faulty : Element {
  std::string body;
  double told = 1.0, push = 0.0;
};

class FaultyGroup final : public ForceGroup {
public:
  struct FaultyElement {
    int body = 0;
    double told = 1.0, push = 0.0;
  };
  std::vector<FaultyElement> entries;

  void add_forces(Evaluation& e) const override {
    for (const FaultyElement& entry : entries) {
      const Motion<double>& m = e.motion[entry.body];
      e.force[entry.body].fx += entry.push - k_stiffness * m.x;
      e.dissipation -= entry.push * m.vx;
    }
  }
  [[nodiscard]] double potential(const Motion<double>* motion) const override {
    double sum = 0.0;
    for (const FaultyElement& entry : entries) sum += entry.told * 0.5 * k_stiffness * motion[entry.body].x * motion[entry.body].x;
    return sum;
  }
  void add_jacobian(const Evaluation&, std::vector<PairJacobian>& out) const override {
    for (const FaultyElement& entry : entries) {
      PairJacobian& j = out.emplace_back();
      j.a = entry.body;
      j.b = k_ground;
      j.stiffness.setZero();
      j.damping.setZero();
      j.stiffness(0, 0) = -k_stiffness;
    }
  }
  void mark_bodies(std::vector<char>& is_used) const override {
    for (const FaultyElement& entry : entries) is_used[entry.body] = 1;
  }
};

const ElementKind& faulty_kind() {
  static const ElementKind kind = [] {
    ElementKind k;
    k.name = "faulty";
    k.fields.add("body", &Faulty::body).as(FieldType::body).required().doc("body");
    k.fields.add("told", &Faulty::told).doc("share");
    k.fields.add("push", &Faulty::push).doc("force");
    k.holds<Faulty>();
    k.compile = [](const Element& element, SystemBuilder& builder) {
      const auto& e = static_cast<const Faulty&>(element);
      builder.group<FaultyGroup>().entries.push_back({builder.body(e.body), e.told, e.push});
    };
    return k;
  }();
  return kind;
}

// 1 kg at 1 m/s, followed until it has gone 0.09 m out, where it has not yet turned round; what stopped it.
std::string stop_of(double told, double push, const Settings& settings) {
  static const Catalogue catalogue = [] {
    Catalogue c = transformer_catalog();
    c.elements.push_back(&faulty_kind());
    return c;
  }();
  const Model model =
      parse_model(k_no_gravity + "[simulation]\nstep = 1e-3\n" + body("mass", "mass = 1; inertia = 1; velocity = [1.0, 0.0]") +
                      element("faulty", "spring", "body = \"mass\""),
                  "a.toml", catalogue, {"element.spring.told=" + std::to_string(told), "element.spring.push=" + std::to_string(push)});
  try {
    (void)run(model, settings);
  } catch (const NumericalFailure& failure) {
    return failure.what();
  }
  return "";
}

const std::vector<std::string> k_adaptive = {"auto", "dop853", "tsit5", "rodas5p"};

} // namespace

TEST_CASE("energy guard: a force that lies about its potential energy by so much as a hundred bounds of a step stops the run") {
  // 0.5 J are turned over; of a body's 8 numbers the bound is √88 · 1e-9 · 1.5 J = 1.4e-8 J, a stop 1.4e-6 J. A lie of 1e-2 is
  // 5e-3 J until the body has come to rest, in the 10 to 300 steps that it takes there.
  for (const std::string& method : k_adaptive) {
    CAPTURE(method);
    CHECK(stop_of(1.0, 0.0, {method, 1e-9, 0.11}).empty());
    CHECK(stop_of(0.99, 0.0, {method, 1e-9, 0.11}).find("turned over: its result is not to be trusted") != std::string::npos);
    CHECK(stop_of(1.01, 0.0, {method, 1e-9, 0.11}).find(" made ") != std::string::npos);
  }
}

TEST_CASE("energy guard: friction that pushes is found though its books balance") {
  for (const std::string& method : k_adaptive) {
    CAPTURE(method);
    CHECK(stop_of(1.0, -1e-2, {method, 1e-9, 0.11}).empty());
    CHECK(stop_of(1.0, 1e-2, {method, 1e-9, 0.11}).find("friction or dampers gave back") != std::string::npos);
  }
  // 1e-3 s of a fixed step at 1 m/s and 50 N, of 0.5 J: a tenth; a twentieth is let pass at most.
  CHECK(stop_of(1.0, -50.0, {"rk4", 1e-3, 0.01}).empty());
  CHECK(stop_of(1.0, 50.0, {"rk4", 1e-3, 0.01}).find("friction or dampers gave back") != std::string::npos);
}

TEST_CASE("energy guard: honest steps stay within their bound, but for the onset of a joint's slip") {
  struct Case {
    const char* model;
    double most; ///< measured: below 0.5, but for 19 of the last
  };
  double largest = 0.0;
  for (const Case& c : {Case{"benchmarks/bouncing_mass", 1.0}, Case{"benchmarks/double_pendulum", 1.0},
                        Case{"benchmarks/slider_crank", 1.0}, Case{"benchmarks/hard/patch_vanishes", 1.0},
                        Case{"paper/no_interference", 1.0}, Case{"benchmarks/hard/patch_translation", 0.3 * EnergyAccount::k_reserve}})
    for (const double tolerance : {1e-3, 1e-6, 1e-9})
      for (const char* method : {"auto", "rodas5p"}) {
        CAPTURE(c.model);
        CAPTURE(tolerance);
        CAPTURE(method);
        const Model model = read_model(std::string(STEPLAP_MODELS) + "/" + c.model + ".toml", transformer_catalog());
        const Run r = run(model, {method, tolerance, std::min(model.simulation.end, 0.8)});
        CHECK(r.result.statistics.energy_worst_step <= c.most);
        largest = std::max(largest, r.result.statistics.energy_worst_step);
      }
  CHECK(largest > 0.1); // it is measured at all
}

TEST_CASE("energy guard: the bound follows from the tolerance, the state and what was turned over") {
  // √(11 n) tol (3 S + T₀), by hand.
  CHECK(EnergyAccount::step_bound(1e-6, 44, 2.0, 0.5) == doctest::Approx(22.0 * 1e-6 * 6.5).epsilon(1e-14));
}
