// Random trains of masses on a line with buffers, draw gears, brakes that signals press, seals and stops: three methods that follow
// events have to agree with each other, and momentum and energy with what forces and friction say.
#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace steplap;
using namespace steplap::testing;

namespace {

// One number a statement: C++ leaves open which operand is found first.
class Train {
public:
  explicit Train(std::uint64_t seed) : draw_(seed) {
    count_ = 2 + draw_.below(4);
    text_ << "gravity = [0.0, 0.0]\n";
    add_signals();
    for (int i = 0; i < count_; ++i) add_mass(i);
    for (int i = 0; i + 1 < count_; ++i) add_buffer(i);
    if (draw_.chance(0.5)) add_push();
  }
  [[nodiscard]] std::string text() const { return text_.str(); }
  [[nodiscard]] int count() const { return count_; }

private:
  void add_signals() {
    for (int i = 0; i < 3; ++i) {
      const char* kind = draw_.one_of(std::vector<const char*>{"rectangle", "trapezoid", "triangle", "haversine", "half_sine"});
      const double start = draw_.chance(0.3) ? 0.0 : draw_.between(0.0, 1.0);
      const double duration = draw_.between(0.1, 1.5);
      text_ << "[[signal]]\nkind = \"" << kind << "\"\nname = \"s" << i << "\"\nstart = " << start << "\nduration = " << duration
            << "\npeak = 1.0\n";
      if (std::string(kind) == "trapezoid") text_ << "rise = " << 0.3 * duration << "\nfall = " << 0.2 * duration << "\n";
    }
    text_ << "[[signal]]\nkind = \"sum\"\nname = \"s3\"\nsignals = [\"s0\", \"s1\"]\n";
  }
  void add_mass(int i) {
    const double mass = draw_.decades(0.0, 1.0);
    const double speed = draw_.chance(0.3) ? 0.0 : draw_.either(0.2, 2.0);
    text_ << "[[body]]\nname = \"m" << i << "\"\nmass = " << mass << "\ninertia = 1.0\nposition = [" << -i << ", 0.0]\nvelocity = ["
          << speed << ", 0.0]\n[[element]]\nkind = \"prismatic\"\nname = \"rails " << i << "\"\na = \"m" << i << "\"\naxis = [1.0, 0.0]\n";
    if (!draw_.chance(0.7)) return;
    const double holds = mass * draw_.decades(-1.0, 1.0);
    const double drags = holds * draw_.between(0.3, 1.0);
    text_ << "[[element]]\nkind = \"joint_friction\"\nname = \"brake " << i << "\"\na = \"m" << i
          << "\"\ncoordinate = \"x\"\nholds = " << holds << "\ndrags = " << drags << "\n";
    if (draw_.chance(0.3)) text_ << "stribeck_velocity = " << draw_.decades(-2.0, 0.0) << "\n";
    if (draw_.chance(0.3)) text_ << "viscous = " << mass * draw_.decades(-2.0, 0.0) << "\n";
    if (draw_.chance(0.7)) text_ << "signal = \"s" << draw_.below(4) << "\"\n";
  }
  void add_buffer(int i) {
    const double slope = draw_.decades(2.0, 4.0);
    const double share = draw_.between(0.1, 1.0);
    const double corner = draw_.between(0.02, 0.2);
    const double gap = draw_.between(0.0, 0.3);
    text_ << "[[element]]\nkind = \"buffer\"\nname = \"buffer " << i << "\"\na = \"m" << i << "\"\nb = \"m" << i + 1 << "\"\ngap = " << gap
          << "\nloading = [[0.0, 0.0], [" << corner << ", " << slope * corner << "], [" << 2.0 * corner << ", " << 4.0 * slope * corner
          << "]]\nunloading = [[0.0, 0.0], [" << 1.5 * corner << ", " << share * slope * corner << "]]\n";
    if (!draw_.chance(0.4)) return;
    const double pull = draw_.decades(2.0, 3.5);
    const double slack = draw_.between(0.0, 0.2);
    text_ << "[[element]]\nkind = \"buffer\"\nname = \"gear " << i << "\"\na = \"m" << i << "\"\nb = \"m" << i + 1
          << "\"\naxis = [-1.0, 0.0]\ngap = " << slack << "\nloading = [[0.0, 0.0], [1.0, " << pull << "]]\nunloading = [[0.0, 0.0], [1.0, "
          << 0.4 * pull << "]]\n";
  }
  void add_push() {
    const double force = draw_.either(0.5, 20.0);
    text_ << "[[signal]]\nkind = \"scaled\"\nname = \"f\"\nsignal = \"s2\"\nfactor = " << force
          << "\n[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"m0\"\nforce_x = \"f\"\n";
  }

  random::RandomNumber draw_;
  std::ostringstream text_;
  int count_ = 0;
};

// Of metres a second. Where a friction is just held or just not, another digit makes another motion: those are counted.
double difference(const Run& one, const Run& other, int count) {
  double most = 0.0;
  for (int i = 0; i < count; ++i) {
    const std::string name = "m" + std::to_string(i) + ".vx";
    most = std::max(most, std::abs(one.last(name) - other.last(name)));
  }
  return most;
}

} // namespace

TEST_CASE("random trains with brakes and buffers: three methods agree, and energy balances") {
  constexpr int k_scenes = 120;
  int apart = 0;
  for (int seed = 1; seed <= k_scenes; ++seed) {
    CAPTURE(seed);
    const Train train(static_cast<std::uint64_t>(seed));
    CAPTURE(train.text());
    const Run reference = run(train.text(), {"dop853", 1e-11, 2.5});
    const RunStatistics& s = reference.result.statistics;
    CHECK(s.energy_residual < 1e-7 * (1.0 + s.energy_exchanged));
    for (const char* method : {"tsit5", "rodas5p"}) {
      CAPTURE(method);
      const Run r = run(train.text(), {method, 1e-10, 2.5});
      // A tolerance of 1e-10 of some metres a second, over tens of events.
      const double off = difference(reference, r, train.count());
      if (off > 1e-6) ++apart;
      CHECK(off < 1e-6);
    }
  }
  CHECK(apart == 0);
}
