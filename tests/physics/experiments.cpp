#include "tests/physics/experiments.h"

#include "mbd/base/number_text.h"
#include "mbd/io/csv.h"
#include "mbd/run/run.h"
#include "transformer/program.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>

namespace steplap::testing {

namespace {

constexpr double k_g = 9.81, k_mile_per_hour = 0.44704, k_first_runs = 20.0;

using Overrides = std::vector<std::string>;

std::string set(const std::string& path, double value) { return path + "=" + number_text(value); }

std::string set(const std::string& path, double x, double y) { return path + "=[" + number_text(x) + ", " + number_text(y) + "]"; }

Run run_of(const std::string& model, const Overrides& overrides = {}) {
  Run run = run_model(load_model(STEPLAP_MODELS "/experiments/" + model + ".toml", overrides));
  if (run.failure || !run.result.stop_reason.empty()) throw std::runtime_error(model + " did not reach its end");
  return run;
}

// When a channel, sampled every millisecond, first reaches a level: its samples are joined by straight lines, which is off by a/8
// of their spacing squared over the speed, 1e-6 s here.
double time_at(const Run& run, const std::string& channel, double level) {
  const std::vector<double>& t = run.result.trajectory->times();
  const std::vector<double> x = run.result.trajectory->series(channel);
  for (std::size_t i = 1; i < x.size(); ++i)
    if (x[i - 1] < level && x[i] >= level) return t[i - 1] + (t[i] - t[i - 1]) * (level - x[i - 1]) / (x[i] - x[i - 1]);
  throw std::runtime_error(channel + " does not reach its level");
}

// Rows of a data file, by columns.
struct Data {
  explicit Data(const std::string& name) : table(read_csv(STEPLAP_TEST_DATA "/experiments/" + name + ".csv", {})) {}
  [[nodiscard]] double value(std::size_t row, const std::string& column) const { return table.columns[table.column(column, {})][row]; }
  [[nodiscard]] std::vector<double> values(const std::string& column, const std::function<bool(std::size_t)>& wants) const {
    std::vector<double> found;
    for (std::size_t row = 0; row < table.lines.size(); ++row)
      if (wants(row)) found.push_back(value(row, column));
    return found;
  }
  CsvTable table;
};

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation(const std::vector<double>& values) {
  const double middle = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

Compared compared(const std::string& experiment, const std::string& what, double setting, const std::vector<double>& measured,
                  double predicted) {
  Compared c;
  c.experiment = experiment;
  c.what = what;
  c.setting = setting;
  c.count = static_cast<int>(measured.size());
  c.measured = mean(measured);
  c.scatter = deviation(measured);
  c.predicted = predicted;
  return c;
}

// Where f, which rises from `low` to `high` or falls, is zero: halving of a logarithmic interval, to 1e-9 of the value.
double zero_between(double low, double high, const std::function<double(double)>& f) {
  const bool rises = f(high) > 0.0;
  if (rises == (f(low) > 0.0)) throw std::runtime_error("no zero between the bounds");
  while (high / low > 1.0 + 1e-9) {
    const double middle = std::sqrt(low * high);
    (f(middle) > 0.0) == rises ? high = middle : low = middle;
  }
  return std::sqrt(low * high);
}

} // namespace

std::vector<Compared> bounces(const std::string& ball, double fitted_height) {
  const Data data(ball);
  std::vector<double> heights = data.table.columns[data.table.column("height", {})];
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  std::vector<Compared> all;
  for (const double height : heights) {
    const Run run = run_of(ball, {set("body.ball.position", 0.0, height)});
    std::vector<double> touches;
    for (const Event& event : run.result.events)
      if (event.element == "floor" && event.kind == EventKind::closes) touches.push_back(event.t);
    for (int bounce = 1; bounce <= 8; ++bounce) {
      const auto wants = [&](std::size_t row) {
        return data.value(row, "height") == height && data.value(row, "bounce") == bounce && data.value(row, "used") == 1.0;
      };
      const auto i = static_cast<std::size_t>(bounce);
      Compared c = compared(ball, "interval between bounces", height, data.values("interval", wants), touches.at(i) - touches.at(i - 1));
      c.number = bounce;
      c.is_fitted = height == fitted_height;
      all.push_back(c);
    }
  }
  return all;
}

std::vector<Compared> flywheel_trolley() {
  const Data data("flywheel_trolley");
  const Run run = run_of("flywheel_trolley");
  const auto all = [](std::size_t) { return true; };
  Compared free = compared("flywheel_trolley", "flywheels free", 0.0, data.values("free", all), time_at(run, "free.x", 1.0));
  free.is_fitted = true;
  return {free, compared("flywheel_trolley", "flywheels locked", 1.0, data.values("locked", all), time_at(run, "flywheels.x", 1.0))};
}

std::vector<Compared> balls_on_rail() {
  const Data data("inclined_rail");
  const auto time = [](double friction) {
    return time_at(run_of("inclined_rail_ball", {set("element.grip.static_friction", friction)}), "ball.x", 1.279);
  };
  const auto runs_of = [&](double body) { return data.values("time", [&](std::size_t row) { return data.value(row, "body") == body; }); };
  const std::vector<double> metal = runs_of(4), rubber = runs_of(5);
  const double friction = zero_between(0.01, 0.18, [&](double mu) { return time(mu) - mean(metal); });
  Compared slides = compared("inclined_rail", "metal ball", friction, metal, time(friction));
  slides.is_fitted = true;
  return {compared("inclined_rail", "rubber ball", 0.5, rubber, time(0.5)), slides,
          compared("inclined_rail", "metal ball (if it rolled)", 0.5, metal, time(0.5))};
}

std::vector<Compared> cylinders_on_rail() {
  const Data data("inclined_rail");
  const auto time = [](double friction) {
    return time_at(run_of("inclined_rail_cylinder", {set("element.friction.static_friction", friction)}), "cylinder.x", 1.279);
  };
  std::vector<Compared> all;
  for (const auto& [body, name] : {std::pair{1.0, "plastic cylinder"}, {2.0, "metal cylinder 1"}, {3.0, "metal cylinder 2"}}) {
    const auto half = [&](bool is_first) {
      return data.values(
          "time", [&](std::size_t row) { return data.value(row, "body") == body && (data.value(row, "run") <= k_first_runs) == is_first; });
    };
    const std::vector<double> first = half(true), last = half(false);
    const double friction = zero_between(0.05, 0.64, [&](double mu) { return time(mu) - mean(first); });
    Compared fitted = compared("inclined_rail", std::string(name) + " (first runs)", friction, first, time(friction));
    fitted.is_fitted = true;
    all.push_back(fitted);
    all.push_back(compared("inclined_rail", std::string(name) + " (last runs)", friction, last, fitted.predicted));
  }
  return all;
}

std::vector<Compared> friction_damper() {
  const Data data("friction_damper");
  std::vector<Compared> all;
  for (const int number : {1, 2, 3}) {
    const auto cycles = [&](const std::string& column, double frequency, double nominal) {
      return data.values(column, [&](std::size_t row) {
        return data.value(row, "set") == number && data.value(row, "frequency") == frequency && data.value(row, "nominal") == nominal;
      });
    };
    // A cycle with friction F and slack d turns E = 4 F (A - d/2) into heat, a straight line over the amplitude A.
    const double small = mean(cycles("amplitude", 0.25, 0.0127)), large = mean(cycles("amplitude", 0.25, 0.0254));
    const double energy = mean(cycles("energy", 0.25, 0.0127));
    const double friction = (mean(cycles("energy", 0.25, 0.0254)) - energy) / (4.0 * (large - small));
    const double slack = 2.0 * (small - energy / (4.0 * friction));
    for (const double frequency : {0.25, 0.5, 1.0, 2.0})
      for (const double nominal : {0.0127, 0.0254, 0.0381}) {
        const std::vector<double> energies = cycles("energy", frequency, nominal);
        if (energies.empty()) continue;
        const Run run = run_of("friction_damper", {set("element.band friction.holds", friction), set("element.connection.gap", slack),
                                                   set("signal.way.amplitude", mean(cycles("amplitude", frequency, nominal))),
                                                   set("signal.way.frequency", frequency), set("simulation.end", 2.0 / frequency),
                                                   set("output.step", 1.0 / frequency), "output.also=[\"actuator drive.work\"]"});
        const std::vector<double> work = run.result.trajectory->series("actuator drive.work"); // after each cycle
        Compared c = compared("friction_damper", "energy of a cycle at " + number_text(frequency) + " Hz", nominal, energies,
                              work.back() - work.end()[-2]);
        c.number = number;
        c.is_fitted = frequency == 0.25 && nominal < 0.03;
        all.push_back(c);
      }
  }
  return all;
}

std::vector<Compared> air_track(bool is_ideal) {
  const Data data("air_track");
  std::vector<double> masses = data.table.columns[data.table.column("hanging mass", {})];
  masses.erase(std::unique(masses.begin(), masses.end()), masses.end());
  std::vector<Compared> all;
  for (const double mass : masses) {
    Overrides overrides = {set("body.weight.mass", 1e-3 * mass)};
    if (is_ideal) overrides.insert(overrides.end(), {"body.trolley.position=[0, 0]", "element.drag.holds=1e-9"});
    const Run run = run_of("air_track", overrides);
    const double start = is_ideal ? 0.0 : time_at(run, "trolley.x", 0.0), end = time_at(run, "trolley.x", 0.67);
    const auto wants = [&](std::size_t row) { return data.value(row, "hanging mass") == mass; };
    Compared c = compared("air_track", is_ideal ? "from masses and way alone" : "with offset and drag", mass, data.values("time", wants),
                          end - start);
    c.is_fitted = !is_ideal && (mass == masses.front() || mass == masses.back());
    all.push_back(c);
  }
  return all;
}

std::vector<Compared> car_to_car(double restitution) {
  const Data data("car_to_car");
  const auto speeds = [](double damping) {
    const Run run = run_of("car_to_car", {set("element.bumpers.damping", damping)});
    const auto last = [&](const char* channel) { return run.result.trajectory->series(channel).back(); };
    return std::pair{last("striking.vx"), last("struck.vx")};
  };
  const double before = data.value(1, "speed before") * k_mile_per_hour;
  const double damping = zero_between(1e3, 1e5, [&](double c) {
    const auto [striking, struck] = speeds(c);
    return (struck - striking) / before - restitution;
  });
  const auto [striking, struck] = speeds(damping);
  std::vector<Compared> all(2);
  for (std::size_t i = 0; i < 2; ++i) {
    all[i].experiment = "car_to_car";
    all[i].what = i == 0 ? "struck car" : "striking car";
    all[i].setting = restitution;
    all[i].count = 1;
    all[i].measured = data.value(i, "change of speed") * k_mile_per_hour;
    all[i].scatter = 0.05 * k_mile_per_hour;
    all[i].predicted = i == 0 ? struck : before - striking;
  }
  return all;
}

std::vector<Compared> toppling_brick() {
  const Data data("toppling_brick");
  const double lies = 1.57; // rad: 90 degrees less what rounding and the floor's compliance leave
  return {compared("toppling_brick", "from 35 degrees to the ground", 35.0, data.values("time", [](std::size_t) { return true; }),
                   time_at(run_of("toppling_brick"), "brick.theta", lies))};
}

double housner_ratio(const RockingBlock& block) {
  const double sine = std::sin(std::atan2(block.width, block.height));
  return 1.0 - 1.5 * sine * sine;
}

std::vector<double> rocking_ratios(const RockingBlock& block, std::size_t impacts) {
  const double w = block.width, h = block.height, m = block.density * w * w * h, a = std::atan2(w, h), r = 0.5 * std::hypot(w, h),
               tilt = block.tilt * a;
  Overrides overrides = {set("body.block.mass", m), set("body.block.inertia", m * (w * w + h * h) / 12.0), set("body.block.angle", -tilt),
                         set("body.block.position", 0.5 * w - r * std::sin(a - tilt), r * std::cos(a - tilt) - m * k_g / block.stiffness)};
  for (const auto& [corner, side] : {std::pair{"left corner", -0.5}, {"right corner", 0.5}}) {
    const std::string element = std::string("element.") + corner;
    overrides.push_back(set(element + ".stiffness", block.stiffness));
    overrides.push_back(set(element + ".damping", 2.0 * block.damping_ratio * std::sqrt(block.stiffness * m)));
    overrides.push_back(set(element + ".a.point", side * w, -0.5 * h));
  }
  const Run run = run_of("rocking_block", overrides);
  // Largest angle of each swing, and the energy that it takes: m g r (cos(a − |θ|) − cos a).
  std::vector<double> swings = {0.0};
  double before = 0.0;
  for (const double theta : run.result.trajectory->series("block.theta")) {
    if (theta * before < 0.0) swings.push_back(0.0);
    swings.back() = std::max(swings.back(), std::abs(theta));
    before = theta;
  }
  const auto energy = [&](double angle) { return std::cos(a - angle) - std::cos(a); };
  std::vector<double> ratios;
  for (std::size_t i = 0; i < impacts && i + 1 < swings.size(); ++i) ratios.push_back(std::sqrt(energy(swings[i + 1]) / energy(swings[i])));
  return ratios;
}

std::vector<Compared> rocking_blocks(double tilt) {
  const Data data("rocking_blocks");
  // A corner that does not bounce, whatever its stiffness. No second swing: the impact left nothing.
  const auto share = [&](double aspect, double stiffness) {
    const RockingBlock block{.height = 0.2 * aspect, .stiffness = stiffness, .damping_ratio = 2.0, .tilt = tilt};
    const std::vector<double> ratios = rocking_ratios(block, 1);
    return ratios.empty() ? 0.0 : ratios.front() / housner_ratio(block);
  };
  std::vector<double> stiffness_of_base(3, 0.0);
  std::vector<Compared> all;
  for (std::size_t row = 0; row < data.table.lines.size(); ++row) {
    const double aspect = data.value(row, "aspect ratio"), measured = data.value(row, "measured over Housner");
    const auto base = static_cast<std::size_t>(data.value(row, "base"));
    double& stiffness = stiffness_of_base.at(base);
    Compared c;
    c.experiment = "rocking_blocks";
    c.what = base == 1 ? "concrete" : "rubber";
    c.setting = aspect;
    c.count = 1;
    c.measured = measured;
    c.scatter = 0.005; // half of the last digit written; the source says "approximately"
    c.is_fitted = aspect == 5.0;
    if (c.is_fitted) stiffness = zero_between(1.5e5, 1e8, [&](double k) { return share(aspect, k) - measured; });
    c.predicted = share(aspect, stiffness);
    all.push_back(c);
  }
  return all;
}

} // namespace steplap::testing
