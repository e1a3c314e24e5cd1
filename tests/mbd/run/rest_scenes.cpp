#include "tests/mbd/run/rest_scenes.h"

#include "tests/random/random_number.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace steplap::testing {

namespace {

using random::RandomNumber;

constexpr double k_gravity = 9.81;

std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}
std::string point(double x, double y) { return "[" + digits(x) + ", " + digits(y) + "]"; }
std::string field(const char* name, const std::string& value) { return std::string(name) + " = " + value + "\n"; }
std::string field(const char* name, double value) { return field(name, digits(value)); }
std::string words(const char* name, const std::string& value) { return field(name, "\"" + value + "\""); }
std::string element(const char* kind, const char* name) { return "[[element]]\n" + words("kind", kind) + words("name", name); }

class Maker {
public:
  explicit Maker(std::uint64_t seed) : r_(seed) {}

  RestScene made() {
    choose_kind();
    choose_sizes();
    std::string scene;
    if (s_.kind == "slope") scene = on_slope();
    else if (s_.kind == "deck") scene = on_deck();
    else if (s_.kind == "hung") scene = hung();
    else if (s_.kind == "bushing") scene = on_bushings();
    else if (s_.kind == "lap") scene = by_sheets();
    else scene = by_a_brake();
    s_.text = "gravity = " + point(-k_gravity * std::sin(tilt_), -k_gravity * std::cos(tilt_)) + "\n[simulation]\n" + field("end", end_) +
              words("integrator", s_.method) + step_ + (is_equilibrium_ ? words("initial", "equilibrium") : "") + "[output]\n" +
              field("step", end_ / 50.0) + scene;
    return s_;
  }

private:
  void choose_kind() {
    s_.kind = r_.one_of(std::vector<std::string>{"slope", "slope", "deck", "hung", "pinned", "lap", "rail", "bushing"});
    s_.method = r_.one_of(std::vector<std::string>{"auto", "auto", "dop853", "tsit5", "rodas5p", "rk4", "moreau"});
    s_.load = r_.one_of(std::vector<std::string>{"none", "constant", "pulse", "tiny"});
    // Its steps of a two thousandth of the run are too coarse for pulses and drives beside a stiff body, and its estimate says so by right.
    if (s_.method == "moreau" && (s_.load != "constant" || s_.kind == "deck")) s_.load = "none";
  }

  void choose_sizes() {
    double least = 11.0;
    while (least >= 10.0) {
      size_ = r_.decades(-3.0, 2.0);
      mass_ = r_.decades(-3.0, 6.0);
      least = std::max(4.0, std::log10(mass_ * k_gravity / (1e-3 * size_)));
    }
    stiffness_ = r_.decades(least, 10.0);
    const double rate = std::sqrt(2.0 * stiffness_ / mass_), share = r_.decades(-2.0, 0.3);
    damping_ = 2.0 * share * std::sqrt(stiffness_ * mass_);
    tilt_ = r_.between(-std::numbers::pi, std::numbers::pi);
    friction_ = r_.between(0.1, 1.0);
    inertia_ = mass_ * size_ * size_ * r_.between(0.1, 0.5);
    // Explicit methods step by the fastest motion, whether or not it is there: the method itself, or the second one that is asked.
    const double fastest = rate * std::max(1.0, 2.0 * share), most = s_.method == "rk4" ? 1e3 : 1e4;
    end_ = std::min(r_.decades(-2.0, 2.0), most / fastest);
    if (s_.method == "rk4") step_ = field("step", std::min(end_ / 50.0, 0.3 / fastest));
    if (s_.method == "moreau") step_ = field("step", end_ / 2000.0);
    share_ = s_.load == "none" ? 0.0 : s_.load == "tiny" ? r_.decades(-9.0, -3.0) : r_.between(0.1, 0.9);
  }

  [[nodiscard]] double weight() const { return mass_ * k_gravity; }

  [[nodiscard]] std::string box(const char* name, double mass, const std::string& more = "") const {
    return "[[body]]\n" + words("name", name) + field("mass", mass) + field("inertia", inertia_ * mass / mass_) + more;
  }

  // A share of `bound`.
  std::string load_on(const char* body, double bound, double x, double y) {
    if (s_.load == "none") return "";
    const std::string shape = r_.chance(0.5) ? "half_sine" : "haversine";
    const double start = r_.between(0.0, 0.2) * end_, duration = r_.between(0.1, 0.6) * end_;
    std::string text;
    for (const bool is_x : {true, false}) {
      const double size = share_ * bound * (is_x ? x : y);
      text += "[[signal]]\n" + words("name", is_x ? "push x" : "push y");
      if (s_.load == "constant") text += words("kind", "constant") + field("value", size);
      else text += words("kind", shape) + field("peak", size) + field("start", start) + field("duration", duration);
    }
    return text + element("load", "push") + words("at", body) + words("force_x", "push x") + words("force_y", "push y");
  }

  static std::string never_slips() {
    return "[[acceptance]]\n" + words("name", "holds") + words("event", "slips*") + words("consequence", "reject");
  }
  [[nodiscard]] static std::string within(const char* channel, double limit) {
    return "[[acceptance]]\n" + words("name", "stays") + words("channel", channel) + field("within", limit) +
           words("consequence", "reject");
  }

  // A box whose sides are b and h half, on a plane that friction holds it on; it does not tip.
  std::string on_slope() {
    const double slope = r_.between(-0.95, 0.95) * std::atan(friction_), left = 1.0 - std::abs(std::tan(slope)) / friction_;
    const double b = size_ * r_.between(0.3, 0.6);
    const double h = std::min(size_ * r_.between(0.2, 0.5), 0.6 * b / (std::abs(std::tan(slope)) + friction_));
    const double x = size_ * r_.between(-3.0, 3.0), y = size_ * r_.between(-3.0, 3.0);
    inertia_ = mass_ * (b * b + h * h) / 3.0;
    is_equilibrium_ = true;
    tilt_ = 0.0;
    std::string text =
        box("box", mass_,
            field("position", point(x - h * std::sin(slope), y + h * std::cos(slope))) + field("angle", slope) +
                field("outline", "[" + point(-b, -h) + ", " + point(b, -h) + ", " + point(b, h) + ", " + point(-b, h) + "]"));
    text += "[[marker]]\n" + words("name", "plane") + words("body", "ground") + field("at", point(x, y)) + field("angle", slope);
    for (const bool is_front : {false, true})
      text += element("unilateral_contact", is_front ? "front" : "rear") +
              field("a", "{ body = \"box\", point = " + point(is_front ? b : -b, -h) + " }") + words("b", "plane") +
              field("stiffness", stiffness_) + field("damping", damping_);
    text += element("coulomb_stick", "friction") + field("contacts", "[\"rear\", \"front\"]") + field("static_friction", friction_) +
            field("kinetic_friction", friction_ * r_.between(0.6, 1.0));
    return text + load_on("box", 0.9 * left * friction_ * weight() * std::cos(slope), std::cos(slope), std::sin(slope)) + never_slips();
  }

  // A block that friction holds on a deck that is driven.
  std::string on_deck() {
    tilt_ = 0.0;
    std::string text = box("deck", 10.0 * mass_) + box("block", mass_, field("position", point(0.0, 0.1 * size_))) +
                       element("prismatic", "road") + words("a", "deck");
    text += "[[signal]]\n" + words("name", "push");
    if (s_.load == "none") text += words("kind", "constant") + field("value", 0.0);
    else
      text += words("kind", "half_sine") + field("peak", share_ * friction_ * k_gravity) + field("start", 0.2 * end_) +
              field("duration", 0.2 * end_);
    text += element("prescribed_motion", "drive") + words("a", "deck") + words("signal", "push");
    for (const bool is_front : {false, true})
      text += element("unilateral_contact", is_front ? "front" : "rear") +
              field("a", "{ body = \"block\", point = " + point(is_front ? size_ : -size_, -0.1 * size_) + " }") + words("b", "deck") +
              field("stiffness", stiffness_) + field("damping", damping_) + field("preload", 0.5 * weight());
    return text + element("coulomb_stick", "friction") + field("contacts", "[\"rear\", \"front\"]") + field("static_friction", friction_) +
           field("kinetic_friction", 0.8 * friction_) + never_slips();
  }

  std::string hung() {
    is_equilibrium_ = true;
    const double x = std::sin(tilt_), y = std::cos(tilt_);
    return box("box", mass_) + "[[marker]]\n" + words("name", "hook") + words("body", "ground") + field("at", point(size_ * x, size_ * y)) +
           element("spring_damper", "spring") + words("a", "box") + words("b", "hook") + field("stiffness", stiffness_) +
           field("damping", damping_) + field("free_length", 0.999 * size_) + load_on("box", weight(), -x, -y) +
           within("spring.force", 5.0 * weight());
  }

  std::string on_bushings() {
    is_equilibrium_ = true;
    std::string text = box("box", mass_);
    for (const bool is_right : {false, true}) {
      const std::string at = point(is_right ? size_ : -size_, 0.0);
      text += element("bushing", is_right ? "right" : "left") + field("a", "{ body = \"box\", at = " + at + " }") +
              field("b", "{ body = \"ground\", at = " + at + " }") + field("stiffness", point(stiffness_, 2.0 * stiffness_)) +
              field("damping", point(damping_, damping_));
    }
    return text + load_on("box", weight(), 0.3, 0.8) + within("box.x", 0.1 * size_);
  }

  // Sheets whose friction holds one and a half times the weight.
  std::string by_sheets() {
    const double half = 0.3 * size_, pressure = 1.5 * weight() / (2.0 * friction_ * 4.0 * half * half);
    const std::string square =
        "[" + point(-half, -half) + ", " + point(half, -half) + ", " + point(half, half) + ", " + point(-half, half) + "]";
    return "[[body]]\nname = \"yoke\"\nfixed = true\n" + box("limb", mass_) + element("step_lap_joint", "joint") + words("limb", "limb") +
           words("active_part", "yoke") + element("step_lap_interface", "sheets") + words("joint", "joint") + field("yoke", square) +
           field("limb", square) + field("pressure", pressure) + field("static_friction", friction_) + field("count", "2") +
           load_on("limb", 0.3 * weight(), 0.95, 0.3) + never_slips();
  }

  std::string by_a_brake() {
    const bool is_rail = s_.kind == "rail";
    const std::string at = point(0.3 * size_, 0.0);
    std::string text = box("box", mass_);
    if (is_rail) text += element("prismatic", "rail") + words("a", "box");
    else
      text += element("revolute", "pin") + field("a", "{ body = \"box\", at = " + at + " }") +
              field("b", "{ body = \"ground\", at = " + at + " }");
    const double bound = is_rail ? 1.5 * weight() : weight() * size_;
    return text + element("joint_friction", "brake") + words("a", "box") + words("coordinate", is_rail ? "x" : "angle") +
           field("holds", bound) + field("drags", 0.7 * bound) + load_on("box", 0.4 * weight(), 0.9, 0.4) + never_slips();
  }

  RandomNumber r_;
  RestScene s_;
  double size_ = 1.0, mass_ = 1.0, stiffness_ = 1.0, damping_ = 0.0, friction_ = 0.5, inertia_ = 1.0, tilt_ = 0.0, end_ = 1.0, share_ = 0.0;
  std::string step_;
  bool is_equilibrium_ = false;
};

} // namespace

RestScene random_rest_scene(std::uint64_t seed) { return Maker(seed).made(); }

} // namespace steplap::testing
