// Impact of two wagons of masses m and M with closing speed v₀. Each end has two buffers, all alike. If each buffer is compressed by s, the
// wagons have approached by x = 2 s. F is the force of the two pairs in series:
//
//   μ ẍ = −F,   μ = m M/(m + M),   F = 2 (f(s) + c ṡ)
//
// f is the loading curve while s grows and the unloading curve while it decreases. Beyond the end of the curves a stop of stiffness k per
// buffer adds k (s − s_end). Buffers do not pull: contact ends when F becomes zero.
//
// Integration: classical Runge–Kutta method of order 4 with steps of 1/50 rad of the highest frequency, restarted at each corner of the
// curves, which is located by bisection of the last step. The acceleration F/m is interpolated by cubic Hermite polynomials over every two
// steps, with an error of (2/50)⁴/384 = 7e-9 of the peak, half of that in the integral. As a check, the energy absorbed by the curves and
// the change of velocity of the pulse are compared with the motion; a relative deviation above 1e-7 is an error.
#include "mbd/model/shunting_signal.h"

#include "mbd/base/shown_text.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_step = 0.02; // rad
constexpr int k_steps_per_piece = 2;
constexpr int k_most_steps = 1000000;
constexpr int k_halvings = 60;
constexpr double k_agrees = 1e-7;
constexpr double k_buffers = 2.0; // buffers at one end of a wagon; also the number of ends in contact

struct Shunting : SignalDefinition {
  double mass = 0.0, other_mass = 0.0;   // kg
  double speed = 0.0, other_speed = 0.0; // m/s
  std::vector<Vec2> buffer, unloading;   // m, N
  double damping = 0.0;                  // N s/m
  std::optional<double> stop_stiffness;  // N/m
  double start = 0.0;                    // s
};

// A linear segment of the curve: force at s = `from`, constant slope up to `to`.
struct Part {
  double from = 0.0, to = 0.0, force = 0.0, slope = 0.0;
};

struct Node {
  double t = 0.0, s = 0.0, rate = 0.0, work = 0.0; // state of one buffer: time, travel, rate of the travel, absorbed work
};

class WagonImpact {
public:
  explicit WagonImpact(const Shunting& given) : given_(given) {
    check();
    loading_ = parts_of(given.buffer);
    unloading_ = parts_of(given.unloading.empty() ? given.buffer : given.unloading);
    closing_ = std::abs(given.speed - given.other_speed);
    reduced_ = given.mass / (1.0 + given.mass / given.other_mass);
  }

  Signal pulse() {
    Node now;
    now.rate = closing_ / k_buffers;
    bool is_loading = true;
    for (std::size_t p = 0; is_loading; ++p) {
      if (p == loading_.size()) fail_at_end(now);
      follow(loading_[p], true, now);
      is_loading = now.rate > 0.0;
    }
    for (std::size_t p = unloading_.size(); p-- > 0;) {
      if (unloading_[p].from >= now.s) continue;
      if (!(force(unloading_[p], now) > 0.0)) continue; // because of damping the force is not yet, or no longer, positive
      follow(unloading_[p], false, now);
    }
    Signal::Piece rest;
    rest.start = given_.start + now.t;
    pieces_.push_back(rest);
    Signal signal(std::move(pieces_));
    hold_against_motion(signal, now);
    return signal;
  }

private:
  [[noreturn]] void fail(const std::string& what) const { throw ModelError(given_.where, "shunting '" + given_.name + "': " + what); }
  [[noreturn]] void fail_at_end(const Node& now) const {
    const double left = 0.5 * reduced_ * (k_buffers * now.rate) * (k_buffers * now.rate);
    fail("the buffers reach the end of their 'buffer' curve and " + rounded_text(left, 4) +
         " J are left: give the 'stop_stiffness' of what is behind them, or points up to their full travel");
  }

  void check_curve(const std::vector<Vec2>& curve, const char* key) const {
    const std::string name = std::string("'") + key + "'";
    if (curve.size() < 2) fail(name + " needs two points or more, [travel, force] each, the first at travel 0");
    if (curve.front().x() != 0.0) fail(name + " has to begin at travel 0");
    for (std::size_t i = 0; i < curve.size(); ++i) {
      if (curve[i].y() < 0.0) fail(name + " has a negative force: buffers push");
      if (i > 0 && !(curve[i].x() > curve[i - 1].x())) fail(name + ": travels have to ascend");
      if (i > 0 && !(curve[i].y() > 0.0)) fail(name + " has no force at a travel beyond 0");
    }
  }
  static double on_curve(const std::vector<Vec2>& curve, double s) {
    for (std::size_t i = 1; i < curve.size(); ++i)
      if (s <= curve[i].x())
        return curve[i - 1].y() + (curve[i].y() - curve[i - 1].y()) * (s - curve[i - 1].x()) / (curve[i].x() - curve[i - 1].x());
    return curve.back().y();
  }
  void check() const {
    check_curve(given_.buffer, "buffer");
    if (given_.speed == given_.other_speed) fail("the wagons have the same speed and never meet: 'speed' and 'other_speed' have to differ");
    if (given_.unloading.empty()) return;
    check_curve(given_.unloading, "unloading");
    if (given_.unloading.back().x() != given_.buffer.back().x()) fail("'buffer' and 'unloading' have to end at the same travel");
    for (const std::vector<Vec2>* curve : {&given_.buffer, &given_.unloading})
      for (const Vec2& point : *curve)
        if (on_curve(given_.unloading, point.x()) > on_curve(given_.buffer, point.x()))
          fail("'unloading' is above 'buffer' somewhere: the buffers would give back more than they take");
  }

  [[nodiscard]] std::vector<Part> parts_of(const std::vector<Vec2>& curve) const {
    std::vector<Part> parts;
    for (std::size_t i = 1; i < curve.size(); ++i)
      parts.push_back(
          {curve[i - 1].x(), curve[i].x(), curve[i - 1].y(), (curve[i].y() - curve[i - 1].y()) / (curve[i].x() - curve[i - 1].x())});
    const Vec2 &last = given_.buffer.back(), &before = given_.buffer[given_.buffer.size() - 2];
    // Both curves continue with the slope of the last loading segment, so that their difference stays constant.
    const double slope = (last.y() - before.y()) / (last.x() - before.x());
    if (given_.stop_stiffness) parts.push_back({curve.back().x(), 1e30, curve.back().y(), slope + *given_.stop_stiffness});
    return parts;
  }

  // Returns the force of one buffer, N: curve plus damping.
  [[nodiscard]] double force(const Part& part, const Node& n) const {
    return part.force + part.slope * (n.s - part.from) + given_.damping * n.rate;
  }
  // Returns s̈ = −F/(2 μ) = −f/μ, since F = 2 f and the wagons approach by 2 s; f is the force of one buffer.
  [[nodiscard]] double second_rate(const Part& part, const Node& n) const { return -force(part, n) / reduced_; }

  [[nodiscard]] Node step(const Part& part, const Node& from, double h) const {
    double ds[4], dv[4], dw[4];
    for (int i = 0; i < 4; ++i) {
      const double c = i == 0 ? 0.0 : i == 3 ? h : 0.5 * h;
      const Node at = i == 0 ? from : Node{0.0, from.s + c * ds[i - 1], from.rate + c * dv[i - 1], 0.0};
      ds[i] = at.rate;
      dv[i] = second_rate(part, at);
      dw[i] = force(part, at) * at.rate;
    }
    const auto sum = [h](const double* d) { return h / 6.0 * (d[0] + 2.0 * (d[1] + d[2]) + d[3]); };
    return {from.t + h, from.s + sum(ds), from.rate + sum(dv), from.work + sum(dw)};
  }

  // Returns true if the motion has reached the end of this segment: its last travel, the turning point, or the loss of contact.
  [[nodiscard]] bool is_over(const Part& part, const Node& n, bool is_loading) const {
    return is_loading ? n.s >= part.to || n.rate <= 0.0 : n.s <= part.from || force(part, n) <= 0.0;
  }

  void follow(const Part& part, bool is_loading, Node& now) {
    const double omega = std::max(
        {std::sqrt(std::abs(part.slope) / reduced_), given_.damping / reduced_, closing_ / (k_buffers * given_.buffer.back().x())});
    const double h = k_step / omega;
    Node begin = now;
    for (int i = 1;; ++i) {
      if (i > k_most_steps) fail("the buffers take too long to close: is one of their forces far too small?");
      Node next = step(part, now, h);
      const bool ends = is_over(part, next, is_loading);
      if (ends) {
        double low = 0.0, high = h;
        for (int k = 0; k < k_halvings; ++k) {
          const double middle = 0.5 * (low + high);
          (is_over(part, step(part, now, middle), is_loading) ? high : low) = middle;
        }
        next = step(part, now, high);
      }
      now = next;
      if (!ends && i % k_steps_per_piece != 0) continue;
      add_piece(part, begin, now);
      begin = now;
      if (ends) break;
    }
    if (is_loading && now.rate <= 0.0) now.rate = 0.0;
  }

  // Adds the cubic Hermite polynomial with the values and slopes of the wagon's acceleration at nodes a and b.
  void add_piece(const Part& part, const Node& a, const Node& b) {
    const double h = b.t - a.t;
    if (!(h > 0.0)) return;
    const double scale = (given_.speed > given_.other_speed ? -1.0 : 1.0) * k_buffers / given_.mass;
    const auto slope = [&](const Node& n) { return scale * (part.slope * n.rate + given_.damping * second_rate(part, n)); };
    const double va = scale * force(part, a), vb = scale * force(part, b), da = slope(a), db = slope(b);
    Signal::Piece piece;
    piece.start = given_.start + a.t;
    piece.c[0] = va;
    piece.c[1] = da;
    piece.c[2] = (3.0 * (vb - va) / h - 2.0 * da - db) / h;
    piece.c[3] = (2.0 * (va - vb) / h + da + db) / (h * h);
    pieces_.push_back(piece);
  }

  void hold_against_motion(const Signal& signal, const Node& end) const {
    const double before = closing_, after = k_buffers * end.rate; // velocities of approach; negative after the impact
    const double energy = 0.5 * reduced_ * before * before, taken = energy - 0.5 * reduced_ * after * after;
    if (!(std::abs(2.0 * k_buffers * end.work - taken) <= k_agrees * energy))
      fail("its energy is not found to 1e-7: are its curves in N and m?");
    const double change = reduced_ / given_.mass * (before - after);
    const double found = std::abs(signal.mean(given_.start, given_.start + end.t)) * end.t;
    if (!(std::abs(found - change) <= k_agrees * change)) fail("its momentum is not found to 1e-7: are its curves in N and m?");
  }

  const Shunting& given_;
  std::vector<Part> loading_, unloading_;
  double closing_ = 0.0, reduced_ = 0.0;
  std::vector<Signal::Piece> pieces_;
};

} // namespace

const SignalKind& shunting_kind() {
  static const SignalKind kind = [] {
    SignalKind k{"shunting",
                 "Acceleration of a wagon, a point mass with all that it carries, that meets another buffer to buffer: two buffers at each "
                 "end, all alike. "
                 "It is slowed where it runs into one ahead (speed > other_speed), and pushed where one runs into it from behind.",
                 {},
                 create_object<SignalDefinition, Shunting>,
                 copy_object<SignalDefinition, Shunting>,
                 [](const SignalDefinition& d) { return WagonImpact(static_cast<const Shunting&>(d)).pulse(); }};
    k.fields.add("mass", &Shunting::mass).in("kg").positive().required().doc("of the wagon with all that it carries");
    k.fields.add("other_mass", &Shunting::other_mass).in("kg").positive().required().doc("of the other wagon, or of a group of wagons");
    k.fields.add("speed", &Shunting::speed).in("m/s").required().doc("of the wagon, along x, before they meet");
    k.fields.add("other_speed", &Shunting::other_speed).in("m/s").doc("of the other one");
    k.fields.add("buffer", &Shunting::buffer)
        .in("m", "N")
        .required()
        .doc("[travel, force] of one buffer that is pressed in, straight between them; the first at travel 0");
    k.fields.add("unloading", &Shunting::unloading).in("m", "N").doc("the same during release; default: as for compression");
    k.fields.add("damping", &Shunting::damping).in("N s/m").not_negative().doc("of one buffer, in addition to its curves");
    k.fields.add("stop_stiffness", &Shunting::stop_stiffness)
        .in("N/m")
        .positive()
        .doc("of what is behind one buffer, beyond its last point; elastic, added to the last slope of 'buffer'");
    k.fields.add("start", &Shunting::start).in("s").not_negative().doc("time at which they touch");
    return k;
  }();
  return kind;
}

} // namespace steplap
