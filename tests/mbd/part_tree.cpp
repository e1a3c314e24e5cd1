#include "tests/mbd/part_tree.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "tests/random/random_number.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace steplap::testing {

namespace {

std::string text_of(double value) {
  const std::string text = number_text(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}
std::string text_of(const std::array<double, 2>& p) { return "[" + text_of(p[0]) + ", " + text_of(p[1]) + "]"; }

// A frame in the ground.
struct Frame {
  double x = 0.0, y = 0.0, angle = 0.0;

  [[nodiscard]] bool is_turned() const { return angle != 0.0; }
  [[nodiscard]] bool is_placed() const { return x != 0.0 || y != 0.0 || is_turned(); }
  [[nodiscard]] std::array<double, 2> turned(const std::array<double, 2>& p) const {
    if (!is_turned()) return p;
    const portable::SinCos k = portable::sin_cos(angle);
    return {k.cos * p[0] - k.sin * p[1], k.sin * p[0] + k.cos * p[1]};
  }
  [[nodiscard]] std::array<double, 2> placed(const std::array<double, 2>& p) const {
    if (!is_placed()) return p;
    const auto q = turned(p);
    return {x + q[0], y + q[1]};
  }
  [[nodiscard]] Frame within(const std::array<double, 2>& p, double by) const {
    const auto q = placed(p);
    return {q[0], q[1], by == 0.0 ? angle : is_turned() ? angle + by : by};
  }
};

// A file: one block that hangs on springs, and what else it may have; the same for all who take it.
struct File {
  struct Sub {
    std::string name;
    int file = 0;
    std::array<double, 2> at{};
    double angle = 0.0;
    bool is_by_formula = false;   // its x is two of the file's pitch, its angle the file's tilt
    std::optional<double> factor; // stiffness given from outside: so many times the file's own
  };
  std::string name;
  double mass = 1.0, inertia = 1.0, stiffness = 1000.0, pitch = 0.3, tilt = 0.2;
  std::array<double, 2> position{}, velocity{}, point{}, anchor{}, wind{};
  double angle = 0.0;
  bool has_pose = true, has_bushing = false, has_arm = false, has_post = false, has_wind = false, has_push = false, has_channel = false;
  double arm_angle = 0.0, peak = 5.0, post_angle = 0.0;
  std::vector<Sub> subs;
};

class Tree {
public:
  explicit Tree(std::uint64_t seed) : draw_(seed) {
    const int count = 1 + draw_.below(4);
    for (int k = 0; k < count; ++k) files_.push_back(random_file(k));
  }

  PartTree made() {
    PartTree tree;
    for (const File& file : files_) tree.files[file.name] = part_text(file);
    tree.files["model.toml"] = head() + tree.files[files_.back().name];
    tree.files.erase(files_.back().name);
    write_out(files_.back(), "", {}, files_.back().stiffness, 0);
    std::string& text = tree.written_out;
    text = head();
    for (const auto* part : {&bodies_, &markers_, &signals_, &elements_, &channels_}) text += *part;
    tree.depth = depth_;
    tree.parts = parts_;
    return tree;
  }

private:
  static std::string head() {
    return "gravity = [0.7, -9.81]\n[simulation]\nend = 0.02\nintegrator = \"dop853\"\ntolerance = 1e-8\n[output]\nstep = 0.002\n";
  }

  std::array<double, 2> point(double size) {
    const double x = draw_.either(0.01, size);
    return {x, draw_.either(0.01, size)};
  }

  // File k takes only those before it: no rings.
  File random_file(int k) {
    File f;
    f.name = "file" + std::to_string(k) + ".toml";
    f.mass = draw_.between(0.5, 5.0);
    f.inertia = draw_.between(0.05, 0.5);
    f.stiffness = draw_.between(500.0, 5000.0);
    f.pitch = draw_.between(0.1, 0.5);
    f.tilt = draw_.either(0.1, 3.0);
    f.position = point(0.5);
    f.velocity = point(1.0);
    f.point = point(0.2);
    f.anchor = point(1.0);
    f.wind = point(20.0);
    f.angle = draw_.either(0.1, 3.0);
    f.has_bushing = draw_.chance(0.5);
    f.has_arm = draw_.chance(0.5);
    f.has_pose = f.has_arm || draw_.chance(0.7); // of two bodies that a joint places one has to have a pose
    f.has_post = draw_.chance(0.5);
    f.has_wind = draw_.chance(0.5);
    f.has_push = draw_.chance(0.4);
    f.has_channel = draw_.chance(0.5);
    f.arm_angle = draw_.either(0.1, 3.0);
    f.peak = draw_.between(1.0, 9.0);
    f.post_angle = draw_.either(0.1, 3.0);
    const int subs = k == 0 ? 0 : 1 + draw_.below(2);
    for (int s = 0; s < subs; ++s) f.subs.push_back(random_sub(s, k));
    return f;
  }

  File::Sub random_sub(int s, int k) {
    File::Sub sub;
    sub.name = (s % 2 == 0 ? "left arm " : "r.") + std::to_string(s);
    sub.file = draw_.below(k);
    if (draw_.chance(0.8)) sub.at = point(2.0);
    if (draw_.chance(0.6)) sub.angle = draw_.either(0.1, 3.0);
    sub.is_by_formula = draw_.chance(0.3);
    if (draw_.chance(0.5)) sub.factor = draw_.between(0.5, 2.0);
    return sub;
  }

  [[nodiscard]] std::string part_text(const File& f) const {
    std::string text = "[parameters]\nstiffness = \"" + text_of(f.stiffness) + " N/m\"\npitch = \"" + text_of(f.pitch) +
                       " m\"\ntilt = " + text_of(f.tilt) + "\n";
    text += "[[body]]\nname = \"block\"\nmass = " + text_of(f.mass) + "\ninertia = " + text_of(f.inertia) +
            "\nvelocity = " + text_of(f.velocity) + "\n";
    if (f.has_pose) text += "position = " + text_of(f.position) + "\nangle = " + text_of(f.angle) + "\n";
    text += "[[marker]]\nname = \"port\"\nbody = \"block\"\npoint = " + text_of(f.point) + "\n";
    text += "[[element]]\nkind = \"spring_damper\"\nname = \"hanger\"\na = \"port\"\nb = { body = \"ground\", at = " + text_of(f.anchor) +
            " }\nstiffness = \"= 2*stiffness\"\ndamping = 3.0\n";
    if (f.has_bushing)
      text += "[[element]]\nkind = \"bushing\"\nname = \"pad\"\na = \"block\"\nstiffness = [900.0, 400.0]\nrotational_stiffness = 12.0\n";
    if (f.has_arm)
      text += "[[body]]\nname = \"arm\"\nmass = 0.3\ninertia = 0.02\n[[element]]\nkind = \"revolute\"\nname = \"pin\"\na = { body = "
              "\"arm\", point = [0.1, 0.0] }\nb = \"port\"\nangle = " +
              text_of(f.arm_angle) + "\n";
    if (f.has_post)
      text += "[[marker]]\nname = \"post\"\nbody = \"ground\"\nat = " + text_of(f.anchor) + "\nangle = " + text_of(f.post_angle) +
              "\n[[element]]\nkind = \"spring_damper\"\nname = \"guide\"\na = { body = \"block\", at = " + text_of(f.anchor) +
              " }\nb = \"post\"\naxis = [1.0, 0.0]\nstiffness = 300.0\n";
    if (f.has_push) text += "[[signal]]\nname = \"push\"\nkind = \"half_sine\"\npeak = " + text_of(f.peak) + "\nduration = 0.01\n";
    if (f.has_wind)
      text += "[[element]]\nkind = \"load\"\nname = \"wind\"\nat = \"port\"\nforce = " + text_of(f.wind) + "\n" +
              (f.has_push ? "torque = \"push\"\n" : "");
    if (f.has_channel) text += "[[channel]]\nname = \"sum\"\nexpression = \"hanger.force/'1 N' + 2*block.x/'1 m'\"\n";
    for (const File::Sub& sub : f.subs) {
      text += "[[part]]\nname = \"" + sub.name + "\"\nfile = \"" + files_[static_cast<std::size_t>(sub.file)].name + "\"\n";
      if (sub.is_by_formula) text += "x = \"= 2*pitch\"\nangle = \"= tilt\"\n";
      else text += "x = " + text_of(sub.at[0]) + "\ny = \"" + text_of(sub.at[1]) + " m\"\nangle = " + text_of(sub.angle) + "\n";
      if (sub.factor) text += "parameters = { stiffness = \"= " + text_of(*sub.factor) + "*stiffness\" }\n";
    }
    for (const File::Sub& sub : f.subs)
      text += "[[element]]\nkind = \"spring_damper\"\nname = \"tie " + sub.name + "\"\na = \"port\"\nb = \"" + sub.name +
              ".port\"\nstiffness = \"= stiffness\"\n";
    return text;
  }

  void write_out(const File& f, const std::string& prefix, const Frame& frame, double stiffness, int depth) {
    depth_ = std::max(depth_, depth);
    const auto named = [&](const std::string& name) { return "name = \"" + prefix + name + "\"\n"; };
    const auto point = [&](const std::string& body, const std::array<double, 2>& p) {
      return "{ body = \"" + prefix + body + "\", point = " + text_of(p) + " }\n";
    };
    const auto ground = [&](const std::array<double, 2>& p) { // a marker of the ground turns with the part
      return "{ body = \"ground\", at = " + text_of(frame.placed(p)) +
             (frame.is_turned() ? ", angle = " + text_of(frame.angle) : std::string()) + " }\n";
    };
    bodies_ += "[[body]]\n" + named("block") + "mass = " + text_of(f.mass) + "\ninertia = " + text_of(f.inertia) +
               "\nvelocity = " + text_of(frame.turned(f.velocity)) + "\n";
    if (f.has_pose)
      bodies_ += "position = " + text_of(frame.placed(f.position)) +
                 "\nangle = " + text_of(frame.is_turned() ? frame.angle + f.angle : f.angle) + "\n";
    else bodies_ += "position = " + text_of(frame.placed({0.0, 0.0})) + "\nangle = " + text_of(frame.angle) + "\n";
    markers_ += "[[marker]]\n" + named("port") + "body = \"" + prefix + "block\"\npoint = " + text_of(f.point) + "\n";
    elements_ += "[[element]]\nkind = \"spring_damper\"\n" + named("hanger") + "a = \"" + prefix + "port\"\nb = " + ground(f.anchor) +
                 "stiffness = " + text_of(2 * stiffness) + "\ndamping = 3.0\n";
    if (f.has_bushing)
      elements_ += "[[element]]\nkind = \"bushing\"\n" + named("pad") + "a = \"" + prefix +
                   "block\"\nstiffness = [900.0, 400.0]\nrotational_stiffness = 12.0\n" +
                   (frame.is_placed() ? "b = " + ground({0.0, 0.0}) : std::string());
    if (f.has_arm) {
      bodies_ += "[[body]]\n" + named("arm") + "mass = 0.3\ninertia = 0.02\n";
      elements_ += "[[element]]\nkind = \"revolute\"\n" + named("pin") + "a = " + point("arm", {0.1, 0.0}) + "b = \"" + prefix +
                   "port\"\nangle = " + text_of(f.arm_angle) + "\n";
    }
    if (f.has_post) {
      markers_ += "[[marker]]\n" + named("post") + "body = \"ground\"\nat = " + text_of(frame.placed(f.anchor)) +
                  "\nangle = " + text_of(frame.is_turned() ? frame.angle + f.post_angle : f.post_angle) + "\n";
      elements_ += "[[element]]\nkind = \"spring_damper\"\n" + named("guide") + "a = { body = \"" + prefix +
                   "block\", at = " + text_of(frame.placed(f.anchor)) + " }\nb = \"" + prefix +
                   "post\"\naxis = [1.0, 0.0]\nstiffness = 300.0\n";
    }
    if (f.has_push) signals_ += "[[signal]]\n" + named("push") + "kind = \"half_sine\"\npeak = " + text_of(f.peak) + "\nduration = 0.01\n";
    if (f.has_wind)
      elements_ += "[[element]]\nkind = \"load\"\n" + named("wind") + "at = \"" + prefix +
                   "port\"\nforce = " + text_of(frame.turned(f.wind)) + "\n" + (f.has_push ? "torque = \"" + prefix + "push\"\n" : "");
    if (f.has_channel)
      channels_ +=
          "[[channel]]\n" + named("sum") + "expression = \"{" + prefix + "hanger.force}/'1 N' + 2*{" + prefix + "block.x}/'1 m'\"\n";
    for (const File::Sub& sub : f.subs)
      elements_ += "[[element]]\nkind = \"spring_damper\"\n" + named("tie " + sub.name) + "a = \"" + prefix + "port\"\nb = \"" + prefix +
                   sub.name + ".port\"\nstiffness = " + text_of(stiffness) + "\n";
    for (const File::Sub& sub : f.subs) {
      ++parts_;
      const File& inner = files_[static_cast<std::size_t>(sub.file)];
      const Frame where = sub.is_by_formula ? frame.within({2 * f.pitch, 0.0}, f.tilt) : frame.within(sub.at, sub.angle);
      write_out(inner, prefix + sub.name + ".", where, sub.factor ? *sub.factor * stiffness : inner.stiffness, depth + 1);
    }
  }

  random::RandomNumber draw_;
  std::vector<File> files_;
  std::string bodies_, markers_, signals_, elements_, channels_;
  int depth_ = 0, parts_ = 0;
};

} // namespace

PartTree random_part_tree(std::uint64_t seed) { return Tree(seed).made(); }

} // namespace steplap::testing
