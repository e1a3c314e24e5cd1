#include "tests/random/scene_writer.h"

#include <cmath>
#include <numbers>

namespace steplap::random {

SceneWriter::SceneWriter(std::uint64_t seed) : r(seed) {
  scene.seed = seed;
  duration = r.decades(-1.0, 0.4);
  gravity = r.chance(0.2) ? 0.0 : 9.81;
  size = neat(r.decades(-0.7, 0.5));
  mass = r.decades(-1.0, 4.0);
  // As the text has it, so that what is computed from it here is what the run sees.
  duration = std::stod(number(duration));
  scene.end = duration;
  scene.output_step = duration / 400.0;
  scene.gravity = gravity;
}

std::string SceneWriter::new_name(const std::string& stem) { return stem + std::to_string(++count_); }

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

std::string marker(const std::string& body, At at) { return "{ body = " + quoted(body) + ", at = " + pair(at.x, at.y) + " }"; }

namespace {

// A phase with which a cosine begins at zero: to all its digits, for a drive has to begin where its body is.
const char* const k_from_zero = "-1.5707963267948966";

// Seeds up to here mean the scenes that they have always meant: what is known of them stays true.
constexpr std::uint64_t k_last_without_transport = 1500;
// Beyond this one there are chirps and sines as well.
constexpr std::uint64_t k_last_without_chirps = 15000;

std::string lines(const SceneWriter::Fields& fields) {
  std::string text;
  for (const auto& [key, value] : fields) text += key + " = " + value + "\n";
  return text;
}

// Up or down between one wave and thirty in the scene's time, without a random number.
std::string chirp(const SceneWriter& w, double amplitude, double start, double length, bool is_up) {
  const std::string low = number(1.0 / w.duration), high = number(30.0 / w.duration);
  return lines({{"amplitude", number(amplitude)},
                {"from", is_up ? low : high},
                {"to", is_up ? high : low},
                {"course", quoted(w.scene.seed % 3 == 0 ? "exponential" : "linear")},
                {"start", number(start)},
                {"duration", number(length)},
                {"phase", std::to_string(w.scene.seed % 5)}});
}

} // namespace

std::string SceneWriter::body(double body_mass, double inertia, At at, const Fields& more) {
  Block block{"body", "", new_name("b"), {}, {}};
  block.fields = lines({{"mass", number(body_mass)}, {"inertia", number(inertia)}, {"position", pair(at.x, at.y)}}) + lines(more);
  scene.blocks.push_back(block);
  return block.name;
}

std::string SceneWriter::element(const std::string& kind, const Fields& fields, const std::vector<std::string>& uses) {
  const Block block{"element", kind, new_name(kind.substr(0, 4) + "_"), lines(fields), uses};
  scene.blocks.push_back(block);
  return block.name;
}

std::string SceneWriter::action(const Fields& fields, const std::vector<std::string>& uses) {
  const Block block{"action", "", new_name("action_"), lines(fields), uses};
  scene.blocks.push_back(block);
  return block.name;
}

// A measured history, quiet but for a few spikes of one sample.
std::string SceneWriter::record(double peak) {
  const std::string file = "record_" + std::to_string(scene.seed) + "_" + std::to_string(count_) + ".csv";
  const int rows = 40 + r.below(160);
  std::string text = "t,value\n";
  const double noise = r.chance(0.5) ? 0.02 : 0.0;
  double value = 0.0;
  for (int i = 0; i < rows; ++i) {
    const double t = duration * i / rows;
    value = r.chance(0.06) ? peak * r.between(-1.3, 1.3) : peak * noise * r.between(-1.0, 1.0);
    text += number(t) + "," + number(i == 0 ? 0.0 : value) + "\n";
  }
  scene.files[file] = text;
  return file;
}

std::string SceneWriter::signal(double peak, bool is_smooth) {
  static const std::vector<std::string> all{"haversine", "harmonics", "harmonics", "half_sine", "triangle",
                                            "trapezoid", "rectangle", "record",    "constant"};
  const std::string kind = is_smooth ? (r.chance(0.5) ? "haversine" : "harmonics") : r.one_of(all);
  Block block{"signal", kind, new_name("s"), {}, {}};
  const double start = duration * r.between(0.0, 0.4), length = duration * r.between(0.05, 0.9);
  if (kind == "constant") block.fields = lines({{"value", number(peak)}});
  else if (kind == "record") block.fields = lines({{"file", quoted(record(peak))}, {"after", r.chance(0.5) ? "\"zero\"" : "\"hold\""}});
  else if (kind == "harmonics") {
    const int count = is_smooth ? 1 : 1 + r.below(4);
    std::string amplitudes, frequencies, phases;
    for (int i = 0; i < count; ++i) {
      const std::string comma = i > 0 ? ", " : "";
      amplitudes += comma + number(peak * r.either(0.2, 1.0) / std::sqrt(count));
      frequencies += comma + number((is_smooth ? r.decades(-0.3, 0.6) : r.decades(-0.3, 1.6)) / duration);
      phases += comma + (is_smooth ? k_from_zero : number(r.between(-3.1, 3.1)));
    }
    block.fields =
        lines({{"amplitudes", "[" + amplitudes + "]"}, {"frequencies", "[" + frequencies + "]"}, {"phases", "[" + phases + "]"}});
    if (is_smooth && scene.seed > k_last_without_chirps) { // the same signal
      block.kind = "sine";
      block.fields = lines({{"amplitude", amplitudes}, {"frequency", frequencies}});
    }
    if (!is_smooth && r.chance(0.3)) block.fields += lines({{"start", number(start)}, {"duration", number(length)}});
    if (!is_smooth && scene.seed > k_last_without_chirps && (scene.seed + static_cast<std::uint64_t>(count_)) % 2 == 0) {
      block.kind = "chirp";
      block.fields = chirp(*this, 0.5 * peak, start, length, count % 2 == 0);
    }
  } else {
    block.fields = lines({{"peak", number(peak)}, {"start", number(start)}, {"duration", number(length)}});
    if (kind == "trapezoid")
      block.fields += lines({{"rise", number(length * r.between(0.02, 0.4))}, {"fall", number(length * r.between(0.02, 0.4))}});
    if (kind == "triangle" && r.chance(0.5)) block.fields += lines({{"rise", number(length * r.between(0.05, 0.9))}});
    // Two wagons whose linear buffers make a half sine of this peak and length.
    if (kind == "triangle" && scene.seed > k_last_without_transport && scene.seed % 4 == 1) {
      const double omega = 3.14159265358979 / length, speed = 2.0 * std::abs(peak) / omega, stroke = speed / omega;
      block.kind = "shunting";
      block.fields = lines({{"mass", "2.0"},
                            {"other_mass", "2.0"},
                            {"speed", number(peak < 0.0 ? speed : 0.0)},
                            {"other_speed", number(peak < 0.0 ? 0.0 : speed)},
                            {"buffer", "[[0, 0], [" + number(stroke) + ", " + number(omega * omega * stroke) + "]]"},
                            {"start", number(start)}});
    }
  }
  scene.blocks.push_back(block);
  return composed(block.name, peak);
}

// Now and then the same history by way of a signal that is made of others, or with a small load of a transport beside it. No
// random number is drawn for it: scenes are otherwise what they were.
std::string SceneWriter::composed(const std::string& part, double peak) {
  const std::uint64_t choice = (scene.seed + static_cast<std::uint64_t>(count_)) % 12;
  Block block{"signal", "", part + "_whole", {}, {part}};
  const std::string twice = "[" + quoted(part) + ", " + quoted(part) + "]";
  if (choice == 0) {
    block.kind = "sum";
    block.fields = lines({{"signals", twice}, {"factors", "[1.5, -0.5]"}});
  } else if (choice == 1) {
    block.kind = "scaled";
    block.fields = lines({{"signal", quoted(part)}, {"factor", "0.5"}});
    scene.blocks.push_back(block);
    block = {"signal", "scaled", part + "_double", lines({{"signal", quoted(block.name)}, {"factor", "2.0"}}), {block.name}};
  } else if (choice == 2) {
    const Block one{"signal", "constant", part + "_one", lines({{"value", "1.0"}}), {}};
    scene.blocks.push_back(one);
    block.kind = "product";
    block.uses.push_back(one.name);
    block.fields = lines({{"signals", "[" + quoted(part) + ", " + quoted(one.name) + "]"}});
  } else if (choice >= 3 && choice <= 5 && scene.seed > k_last_without_transport) {
    // Beside it a load that begins with nothing, of some waves within the run; of unit size but for the sea's angle of 0.35.
    const std::string seed = std::to_string(scene.seed), f = number(1.0 / duration), end = number(duration);
    Block load{"signal", choice == 3 ? "road" : choice == 4 ? "random" : "sea", part + "_load", {}, {}};
    if (choice == 3)
      load.fields = lines({{"roughness", "1.1"}, {"speed", f}, {"from", "1.0"}, {"to", "9.0"}, {"run_in", "0.3"}, {"seed", seed}});
    else if (choice == 4)
      load.fields = lines({{"frequencies", "[" + f + ", " + number(9.0 / duration) + "]"},
                           {"densities", "[" + number(duration / 8.0) + ", " + number(duration / 8.0) + "]"},
                           {"duration", end},
                           {"seed", seed}});
    else load.fields = lines({{"component", "\"angle\""}, {"period", number(duration / 4.0)}});
    scene.blocks.push_back(load);
    block.kind = "sum";
    block.uses.push_back(load.name);
    block.fields =
        lines({{"signals", "[" + quoted(part) + ", " + quoted(load.name) + "]"}, {"factors", "[1.0, " + number(0.01 * peak) + "]"}});
  } else {
    return part;
  }
  scene.blocks.push_back(block);
  return block.name;
}

double SceneWriter::rate(double least_periods, double most_periods) {
  const double periods = r.decades(std::log10(least_periods), std::log10(most_periods));
  return 2.0 * std::numbers::pi * periods / duration;
}

double SceneWriter::stiffness_for(double m, double least_periods, double most_periods) {
  const double omega = rate(least_periods, most_periods);
  return m * omega * omega;
}

double SceneWriter::damping_for(double m, double k) { return r.chance(0.3) ? 0.0 : 2.0 * r.decades(-2.5, -0.3) * std::sqrt(k * m); }

double SceneWriter::inertia_of(double m, double length) { return m * length * length * r.decades(-1.3, 0.0); }

} // namespace steplap::random
