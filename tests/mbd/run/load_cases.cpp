#include "tests/mbd/run/load_cases.h"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace steplap::testing {

namespace {

std::string signal(const std::string& name, const std::string& kind, const std::string& fields) {
  return "[[signal]]\nname = \"" + name + "\"\nkind = \"" + kind + "\"\n" + fields + "\n";
}

std::string text_of(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

const char* const k_deck = R"([[body]]
name = "deck"
mass = 10.0
inertia = 1.0
[[element]]
kind = "prescribed_motion"
name = "deck across"
a = "deck"
coordinate = "x"
signal = "none"
as = "position"
zero = "reference"
[[element]]
kind = "prescribed_motion"
name = "deck upright"
a = "deck"
coordinate = "angle"
signal = "none"
as = "position"
zero = "reference"
)";

std::string drive(const std::string& as) {
  return std::string(k_deck) +
         "[[element]]\nkind = \"prescribed_motion\"\nname = \"l\"\na = \"deck\"\ncoordinate = \"y\"\nsignal = \"p\"\nas = \"" + as +
         "\"\n" + (as == "position" ? "zero = \"reference\"\n" : "");
}

std::string action(const std::string& name, double t, const std::string& step, const std::string& more = "") {
  return "[[action]]\nname = \"" + name + "\"\nwhen = \"" + text_of(t) + " s\"\ndo = [\"" + step + "\"]\n" + more;
}

std::string scene(const LoadKind& kind, double end, bool is_active, const std::string& first_signal, const std::string& more) {
  std::string text = "[simulation]\nend = " + text_of(end) + R"(
[output]
step = 0.1
[[body]]
name = "b"
mass = 100.0
inertia = 10.0
position = [0.0, 0.5]
[[element]]
kind = "prismatic"
name = "rail"
a = "b"
axis = [1.0, 0.0]
[[element]]
kind = "joint_friction"
name = "f"
a = "b"
coordinate = "x"
holds = 300.0
[[acceptance]]
name = "stays"
channel = "b.x"
within = 0.001
[[signal]]
name = "none"
kind = "constant"
value = 0.0
)" + kind.signals;
  const std::string active = is_active ? "" : "active = false\n";
  if (kind.is_force) text += "[[element]]\nkind = \"load\"\nname = \"l\"\nat = \"b\"\nforce_x = \"" + first_signal + "\"\n" + active;
  else if (const std::size_t at = text.find("name = \"l\"\n"); at != std::string::npos) text.insert(at, active);
  return text + more;
}

std::string never(const std::string& step) { return "[[action]]\nname = \"n\"\nwhen = \"b.x > '1 m'\"\ndo = [\"" + step + "\"]\n"; }

std::string record_file(const std::string& name, const std::string& rows) {
  const auto file = std::filesystem::temp_directory_path() / ("steplap_load_" + name + ".csv");
  std::ofstream(file) << "t [s],p\n" << rows;
  return file.string();
}
// Rises from 0 at 0.5 s to 200 at 1 s.
std::string ramp_file() { return record_file("ramp", "0.5,0\n0.75,100\n1.0,200\n"); }
// Rises from 0 at 0.5 s to 200, and is 0 again at 1 s.
std::string triangle_file() { return record_file("triangle", "0.5,0\n0.75,200\n1.0,0\n"); }

} // namespace

std::vector<LoadKind> load_kinds() {
  const std::string half_sine = signal("p", "half_sine", "peak = 200.0\nstart = 0.5\nduration = 0.2");
  std::vector<LoadKind> kinds = {
      {"haversine", signal("p", "haversine", "peak = 200.0\nstart = 0.5\nduration = 0.2"), true, 0.5, 0.7},
      {"half sine", half_sine, true, 0.5, 0.7},
      {"triangle", signal("p", "triangle", "peak = -200.0\nstart = 0.5\nduration = 0.2\nrise = 0.01"), true, 0.5, 0.7},
      {"trapezoid", signal("p", "trapezoid", "peak = 200.0\nstart = 0.5\nduration = 0.4\nrise = 0.1\nfall = 0.1"), true, 0.5, 0.9},
      {"rectangle", signal("p", "rectangle", "peak = 200.0\nstart = 0.5\nduration = 0.2"), true, 0.5, 0.7},
      {"long pulse", signal("p", "haversine", "peak = 200.0\nstart = 0.5\nduration = 200.0"), true, 0.5, 200.5},
      {"sine", signal("p", "harmonics", "amplitudes = [200.0]\nfrequencies = [5.0]\nphases = [-1.5707963267948966]\nstart = 0.5"), true,
       0.5, 2.5, true},
      // Periods of two sines of equal size, 0.2 s and 0.1 s: 2π √(2 / (4π² (25 + 100))) = 0.1265 s.
      {"two sines", signal("p", "harmonics", "amplitudes = [80.0, 80.0]\nfrequencies = [5.0, 10.0]\nstart = 0.5"), true, 0.5, 0.5 + 1.2650,
       true},
      {"short sine", signal("p", "harmonics", "amplitudes = [200.0]\nfrequencies = [5.0]\nstart = 0.5\nduration = 0.6"), true, 0.5, 1.1},
      {"chirp", signal("p", "chirp", "amplitude = 200.0\nfrom = 2.0\nto = 20.0\nstart = 0.5\nduration = 1.0"), true, 0.5, 1.5},
      {"step", signal("one", "constant", "value = 200.0") + signal("p", "scaled", "signal = \"one\"\ndelay = 0.5"), true, 0.5, 0.5, true},
      {"later",
       signal("early", "half_sine", "peak = 100.0\nduration = 0.2") +
           signal("p", "scaled", "signal = \"early\"\ndelay = 0.5\nfactor = 2.0"),
       true, 0.5, 0.7},
      {"on an offset",
       signal("early", "half_sine", "peak = 100.0\nduration = 0.2") +
           signal("p", "scaled", "signal = \"early\"\ndelay = 0.5\nfactor = 2.0\noffset = 50.0"),
       true, 0.5, 0.7},
      {"two pulses",
       signal("p1", "half_sine", "peak = 200.0\nstart = 0.5\nduration = 0.2") +
           signal("p2", "triangle", "peak = 100.0\nstart = 0.8\nduration = 0.2") + signal("p", "sum", "signals = [\"p1\", \"p2\"]"),
       true, 0.5, 1.0},
      {"wave in an envelope",
       signal("wave", "harmonics", "amplitudes = [200.0]\nfrequencies = [5.0]") +
           signal("envelope", "trapezoid", "peak = 1.0\nstart = 0.5\nduration = 1.0\nrise = 0.2\nfall = 0.2") +
           signal("p", "product", "signals = [\"wave\", \"envelope\"]"),
       true, 0.5, 1.5},
      // The road's mean period of its height is about 0.5 s; ten of them at full size, from 2.3 s on, are over at 8 s for certain.
      {"road", signal("p", "road", "class = \"C\"\nspeed = \"40 km/h\"\nseed = 1\nstart = 0.5") + drive("position"), false, 0.5, 9.0, true},
      {"sea",
       signal("p", "sea", "component = \"height\"\nmotion = \"pitch\"\nheave_period = 0.5\nperiod = 0.5\nheave = 0.5\nstart = 0.5") +
           drive("position"),
       false, 0.5, 6.0, true},
      {"random",
       signal("p", "random", "frequencies = [5.0, 40.0]\ndensities = [1e-4, 1e-4]\nfactor = \"1 gravity\"\nstart = 0.5\nduration = 10.0") +
           drive("acceleration"),
       false, 0.5, 4.0, true},
      {"bump", signal("p", "haversine", "peak = 0.1\nstart = 0.5\nduration = 0.5") + drive("position"), false, 0.5, 1.0},
      {"ramp and hold", signal("p", "record", "file = \"" + ramp_file() + "\"\nafter = \"hold\""), true, 0.5, 1.0, true},
      {"record", signal("p", "record", "file = \"" + triangle_file() + "\""), true, 0.5, 1.0},
  };
  return kinds;
}

std::vector<LoadCase> load_cases() {
  std::vector<LoadCase> cases;
  for (const LoadKind& kind : load_kinds()) {
    const double length = kind.acted - kind.begins;
    // Two periods of what goes on alike suffice where nothing moves: "inside" is less than that, in shares of ten periods or a rise.
    const std::vector<double> inside = !kind.is_endless ? std::vector<double>{0.05, 0.5, 0.95}
                                       : length > 0.0   ? std::vector<double>{0.02, 0.15}
                                                        : std::vector<double>{};
    std::vector<std::pair<std::string, double>> cuts{{"before", 0.4 * kind.begins},
                                                     {"just before", kind.begins - 1e-3},
                                                     {"behind", kind.acted + 0.05},
                                                     {"far behind", kind.acted + 1.0}};
    for (const double share : inside) cuts.emplace_back("inside at " + text_of(share), kind.begins + share * length);
    for (const auto& [where, t] : cuts) {
      const bool has_acted = t >= kind.acted;
      const double long_end = kind.acted + 2.0;
      const auto add = [&](const std::string& way, std::string text, bool is_hold) {
        cases.push_back({kind.name + ", " + way + " " + where, std::move(text), is_hold});
      };
      const auto with = [&](const std::string& more) { return scene(kind, long_end, true, "p", more); };
      const std::string why = "reason = \"the car has stopped\"\n";
      add("the run ends", scene(kind, t, true, "p", ""), has_acted);
      add("an action ends the run", with(action("q", t, "stop")), has_acted);
      add("an action with a reason ends the run", with(action("q", t, "stop", why)), true);
      add("an action releases it", with(action("q", t, "release l")), has_acted);
      add("an action with a reason releases it", with(action("q", t, "release l", why)), true);
      if (kind.is_force) {
        add("an action sets another signal", with(action("q", t, "set l.force_x = none")), has_acted);
        // It acts from t on: wholly if that is before it begins, and not at all behind its end.
        if (where == "before" || (has_acted && !kind.is_endless))
          add("an action begins it", scene(kind, long_end, false, "p", action("q", t, "hold l")), where == "before");
        add("an action sets it", scene(kind, t, true, "none", action("q", 0.3 * kind.begins, "set l.force_x = p")), has_acted);
      }
    }
    if (!kind.is_force) continue;
    cases.push_back({kind.name + ", never held", scene(kind, kind.acted + 1.0, false, "p", never("hold l")), false});
    cases.push_back({kind.name + ", never set", scene(kind, kind.acted + 1.0, true, "none", never("set l.force_x = p")), false});
    const std::string alarm = "[[acceptance]]\nname = \"no alarm\"\nelement = \"n\"\nevent = \"happens\"\n";
    cases.push_back({kind.name + ", of an alarm", scene(kind, kind.acted + 1.0, false, "p", never("hold l") + alarm), true});
  }
  return cases;
}

} // namespace steplap::testing
