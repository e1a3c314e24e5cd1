#include "tests/physics/paper_scheme.h"

#include "mbd/model/model_path.h"

#include <Eigen/Dense>

#include <array>
#include <cmath>

namespace steplap::testing {

namespace {

enum Coordinate { k_x1, k_y1, k_theta1, k_x5, k_y5, k_theta5, k_s4, k_coordinates };
using Row = Eigen::Matrix<double, k_coordinates, 1>;
using Mass = Eigen::Matrix<double, k_coordinates, k_coordinates>;
using PointRows = Eigen::Matrix<double, 2, k_coordinates>; // ∂(point)/∂q

enum class Part { ground, active, upper, lower };

struct State {
  Row q = Row::Zero(), v = Row::Zero();
};

Vec2 along(double angle) { return {std::cos(angle), std::sin(angle)}; }
Vec2 across(double angle) { return {-std::sin(angle), std::cos(angle)}; }

// Centres of gravity in the settled pose, m.
const Vec2 k_active(0.0, 1.95), k_upper(0.0, 3.20), k_lower(0.0, 0.79);
constexpr double k_gravity = 9.81;

// Force max(0, −kδ − cδ̇) of a contact, −kδ − cδ̇ of a spring; δ is counted from `free`.
struct Law {
  double k = 0, c = 0, free = 0;

  [[nodiscard]] double pull(double length, double rate) const { return -k * (length - free) - c * rate; }
  [[nodiscard]] double press(double length, double rate) const { return length < free ? std::max(0.0, pull(length, rate)) : 0.0; }
};

struct Element {
  Law law;
  Vec2 at; ///< m, in the settled pose
};

struct Machine {
  double m1 = 65e3, j1 = 0, m4 = 20e3, j4 = 28e3, m5 = 34.6e3, j5 = 55e3;
  std::array<Element, 2> feet, blocks, suspensions;
  Element top, bottom;
  Law tank;
  double mu_static = 0, mu_kinetic = 0, peak = 0, start = 0, duration = 0, speed = 0;
  bool is_triangle = false;

  // Returns the acceleration of the vehicle, m/s².
  [[nodiscard]] double acceleration(double t) const {
    const double share = (t - start) / duration;
    if (share <= 0.0 || share >= 1.0) return 0.0;
    return peak * (is_triangle ? 1.0 - std::abs(2.0 * share - 1.0) : 0.5 * (1.0 - std::cos(2.0 * M_PI * share)));
  }
};

// Interference and gap shift the length at which the force begins: preload/k and −gap.
Element read_element(const Model& model, const std::string& name) {
  const std::string path = "element." + name + ".";
  const auto number = [&](const std::string& field) { return number_of(model, path + field); };
  const auto optional = [&](const char* field) {
    const FieldValue value = value_of(model, path + field);
    const double* given = std::get_if<double>(&value);
    return given ? *given : 0.0;
  };
  Element e;
  e.law = {number("stiffness"), number("damping"), 0.0};
  e.law.free = optional("preload") / e.law.k - optional("gap");
  const std::string marker = std::get<std::string>(value_of(model, path + "a"));
  for (const Marker& candidate : model.markers)
    if (candidate.name == marker) e.at = candidate.at.value();
  return e;
}

Machine read_machine(const Model& model) {
  Machine m;
  m.j1 = number_of(model, "body.active part.inertia") + 2.0 * (6500.0 + 9e3 * 1.25 * 1.25); // two limbs, 1.25 m from the centre
  const std::array<std::string, 2> ends = {"rear", "front"};
  for (std::size_t i = 0; i < 2; ++i) {
    m.feet[i] = read_element(model, ends[i] + " foot");
    m.blocks[i] = read_element(model, ends[i] + " block");
    m.suspensions[i] = read_element(model, ends[i] + " suspension");
  }
  m.top = read_element(model, "top arresting");
  m.bottom = read_element(model, "bottom arresting");
  for (Element* pair : {&m.top, &m.bottom}) {
    pair->law.k *= 2.0;
    pair->law.c *= 2.0;
  }
  m.tank = {number_of(model, "element.tank flexibility.stiffness"), number_of(model, "element.tank flexibility.damping"), 0.0};
  m.mu_static = number_of(model, "element.tank bottom.static_friction");
  const FieldValue kinetic = value_of(model, "element.tank bottom.kinetic_friction");
  m.mu_kinetic = std::holds_alternative<double>(kinetic) ? std::get<double>(kinetic) : m.mu_static;
  m.peak = number_of(model, "signal.braking.peak");
  m.start = number_of(model, "signal.braking.start");
  m.duration = number_of(model, "signal.braking.duration");
  for (const SignalEntry& signal : model.signals)
    if (signal.definition->name == "braking") m.is_triangle = signal.kind->name == "triangle";
  m.speed = 1.1 / 3.6;
  return m;
}

// Kinematics of one state.
struct Pose {
  explicit Pose(const Row& q_)
      : q(q_), e1(along(q[k_theta1])), n1(across(q[k_theta1])), e5(along(q[k_theta5])), n5(across(q[k_theta5])), r1(q[k_x1], q[k_y1]),
        r5(q[k_x5], q[k_y5]) {}

  Row q;
  Vec2 e1, n1, e5, n5, r1, r5;

  [[nodiscard]] Vec2 point(Part part, const Vec2& settled) const {
    if (part == Part::ground) return settled;
    if (part == Part::active) return r1 + e1 * (settled - k_active).x() + n1 * (settled - k_active).y();
    const Vec2 local = settled - k_lower;
    return r5 + e5 * (local.x() + (part == Part::upper ? q[k_s4] : 0.0)) + n5 * local.y();
  }
  // Returns the velocity rows of a point that is fixed in `part` and is now at `p`.
  [[nodiscard]] PointRows rows(Part part, const Vec2& p) const {
    PointRows j = PointRows::Zero();
    if (part == Part::ground) return j;
    const int first = part == Part::active ? k_x1 : k_x5;
    const Vec2 arm = p - (part == Part::active ? r1 : r5);
    j(0, first) = j(1, first + 1) = 1.0;
    j.col(first + 2) = Vec2(-arm.y(), arm.x());
    if (part == Part::upper) j.col(k_s4) = e5;
    return j;
  }
  [[nodiscard]] Row gradient(Part a, Part b, const Vec2& p, const Vec2& direction) const {
    return (rows(a, p) - rows(b, p)).transpose() * direction;
  }
};

// A tip on the axis of `a` that touches a line of `b` with normal n: length δ along the axis, its gradient, the tip's place.
struct Touch {
  double length;
  Row gradient;
  Vec2 tip;
};

Touch touch(const Pose& pose, Part a, const Vec2& marker, const Vec2& axis, Part b, const Vec2& line, const Vec2& n) {
  const Vec2 p = pose.point(a, marker);
  const double length = n.dot(p - pose.point(b, line)) / n.dot(axis);
  const Vec2 tip = p - length * axis;
  return {length, pose.gradient(a, b, tip, n / n.dot(axis)), tip};
}

Touch foot(const Pose& pose, const Vec2& marker) { return touch(pose, Part::active, marker, pose.n1, Part::lower, Vec2::Zero(), pose.n5); }

// Gradient of the paper's (8), the place of the last foot on the floor: rear-most foot while θ1 ≥ θ5, else the front-most.
Row slide_gradient(const Machine& m, const Row& q) {
  const Pose pose(q);
  const Touch last = foot(pose, m.feet[q[k_theta1] >= q[k_theta5] ? 0 : 1].at);
  const Vec2 direction = pose.e5 - pose.n5 * (pose.e5.dot(pose.n1) / pose.n5.dot(pose.n1));
  return pose.gradient(Part::active, Part::lower, last.tip, direction);
}

// Applied generalised forces without friction, and the force on the feet.
struct Forces {
  Row q = Row::Zero();
  double normal = 0;
};

void add(Forces& forces, double force, const Row& gradient) { forces.q += force * gradient; }

Forces applied_forces(const Machine& m, const Pose& pose, const Row& v) {
  Forces f;
  for (const Element& e : m.feet) {
    const Touch t = foot(pose, e.at);
    const double force = e.law.press(t.length, t.gradient.dot(v));
    f.normal += force;
    add(f, force, t.gradient);
  }
  for (const Element& e : m.blocks) {
    const Touch t = touch(pose, Part::upper, e.at, pose.n1, Part::active, {0.0, 3.9}, pose.n1);
    add(f, e.law.press(t.length, t.gradient.dot(v)), t.gradient);
  }
  const auto spring = [&](const Element& e, Part a, Part b, const Vec2& axis) {
    const Vec2 p = pose.point(a, e.at);
    const Row gradient = pose.gradient(a, b, p, axis);
    add(f, e.law.pull(axis.dot(p - pose.point(b, e.at)), gradient.dot(v)), gradient);
  };
  for (const Element& e : m.suspensions) spring(e, Part::lower, Part::ground, {0.0, 1.0});
  spring(m.top, Part::active, Part::upper, pose.e5);
  spring(m.bottom, Part::active, Part::lower, pose.e5);
  f.q[k_s4] += m.tank.pull(pose.q[k_s4], v[k_s4]);
  return f;
}

Mass mass_matrix(const Machine& m, const PointRows& upper) {
  Mass mass = m.m4 * upper.transpose() * upper;
  for (const int i : {k_x1, k_y1}) mass(i, i) += m.m1;
  for (const int i : {k_x5, k_y5}) mass(i, i) += m.m5;
  mass(k_theta1, k_theta1) += m.j1;
  mass(k_theta5, k_theta5) += m.j5 + m.j4;
  return mass;
}

struct Solution {
  Row acceleration;
  double friction = 0, normal = 0; ///< N, friction on the active part
};

// The paper's (31): accelerations and multipliers of the driven vehicle and, if `slip` is zero, of the stick restriction.
Solution solve(const Machine& m, double t, const State& s, int slip) {
  const Pose pose(s.q);
  Forces f = applied_forces(m, pose, s.v);
  const Vec2 centre = pose.point(Part::upper, k_upper);
  const PointRows upper = pose.rows(Part::upper, centre);
  const double omega = s.v[k_theta5];
  const Vec2 bias = -omega * omega * (centre - pose.r5) + 2.0 * omega * s.v[k_s4] * pose.n5;
  f.q -= upper.transpose() * (m.m4 * (bias + Vec2(0.0, k_gravity)));
  f.q[k_y1] -= m.m1 * k_gravity;
  f.q[k_y5] -= m.m5 * k_gravity;

  const Row row = slide_gradient(m, s.q);
  const bool is_held = slip == 0 && f.normal > 0.0;
  Solution result;
  result.normal = f.normal;
  result.friction = -m.mu_kinetic * f.normal * slip;
  if (!is_held) f.q += result.friction * row;

  // Rows of the vehicle's motion and of the stick restriction; while slipping, the last row says that its multiplier is zero.
  constexpr int k_drive = k_coordinates, k_stick = k_coordinates + 1, k_size = k_coordinates + 2;
  using Vector = Eigen::Matrix<double, k_size, 1>;
  Eigen::Matrix<double, k_size, k_size> a = Eigen::Matrix<double, k_size, k_size>::Zero();
  Vector right = Vector::Zero();
  a.topLeftCorner<k_coordinates, k_coordinates>() = mass_matrix(m, upper);
  right.head<k_coordinates>() = f.q;
  a(k_x5, k_drive) = a(k_drive, k_x5) = 1.0;
  right[k_drive] = m.acceleration(t);
  if (is_held) {
    constexpr double h = 1e-4; // s, of the difference for J̇: velocities of some 10 mm/s change J by 1e-6 of itself
    const Row rate = (slide_gradient(m, s.q + h * s.v) - slide_gradient(m, s.q - h * s.v)) / (2.0 * h);
    a.block<k_coordinates, 1>(0, k_stick) = row;
    a.block<1, k_coordinates>(k_stick, 0) = row.transpose();
    right[k_stick] = -rate.dot(s.v);
  } else {
    a(k_stick, k_stick) = 1.0;
  }
  const Vector x = a.partialPivLu().solve(right);
  result.acceleration = x.head<k_coordinates>();
  if (is_held) result.friction = -x[k_stick];
  return result;
}

int sign_of(double x) { return (x > 0.0) - (x < 0.0); }

class Scheme {
public:
  Scheme(const Machine& machine, const SchemeSettings& settings) : m_(machine), settings_(settings) {
    s_.q << k_active, 0.0, k_lower, 0.0, 0.0;
    s_.v[k_x1] = s_.v[k_x5] = m_.speed;
  }

  SchemeHistory run() {
    SchemeHistory history;
    const auto steps = std::lround(settings_.end / settings_.step);
    for (long i = 0; i < steps; ++i) {
      const double t = static_cast<double>(i) * settings_.step;
      if (test_stick(t)) history.onsets.push_back(t);
      history.angle.push_back(s_.q[k_theta1] - s_.q[k_theta5]);
      history.friction.push_back(solve(m_, t, s_, slip_).friction);
      advance(t);
    }
    return history;
  }

private:
  [[nodiscard]] double velocity(const State& s) const { return slide_gradient(m_, s.q).dot(s.v); }

  // Chooses the mode of the next step. Returns true if a slip begins.
  bool test_stick(double t) {
    const double v = velocity(s_);
    const bool was_slipping = slip_ != 0;
    const bool may_stick =
        !was_slipping || (settings_.test == StickTest::at_reversal ? v * slip_ <= 0.0 : std::abs(v) < settings_.stick_speed);
    if (may_stick) {
      const Solution held = solve(m_, t, s_, 0);
      slip_ = std::abs(held.friction) <= m_.mu_static * held.normal ? 0 : -sign_of(held.friction);
    } else {
      slip_ = sign_of(v);
    }
    return slip_ != 0 && !was_slipping;
  }

  // Direction of friction at a stage.
  [[nodiscard]] int slip_at(const State& s) const {
    if (slip_ == 0 || settings_.test == StickTest::at_reversal) return slip_;
    const int sign = sign_of(velocity(s));
    return sign == 0 ? slip_ : sign;
  }

  State rates(double t, const State& s) const { return {s.v, solve(m_, t, s, slip_at(s)).acceleration}; }

  void advance(double t) {
    const double h = settings_.step;
    const auto moved = [this](const State& k, double by) { return State{s_.q + by * k.q, s_.v + by * k.v}; };
    const State k1 = rates(t, s_), k2 = rates(t + 0.5 * h, moved(k1, 0.5 * h)), k3 = rates(t + 0.5 * h, moved(k2, 0.5 * h)),
                k4 = rates(t + h, moved(k3, h));
    s_.q += h / 6.0 * (k1.q + 2.0 * k2.q + 2.0 * k3.q + k4.q);
    s_.v += h / 6.0 * (k1.v + 2.0 * k2.v + 2.0 * k3.v + k4.v);
  }

  const Machine& m_;
  SchemeSettings settings_;
  State s_;
  int slip_ = 0; ///< 0 sticks, ±1 direction of sliding
};

} // namespace

SchemeHistory run_scheme(const Model& model, const SchemeSettings& settings) {
  const Machine machine = read_machine(model);
  return Scheme(machine, settings).run();
}

} // namespace steplap::testing
