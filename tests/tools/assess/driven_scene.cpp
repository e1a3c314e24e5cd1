#include "driven_scene.h"

#include "mbd/io/reader.h"
#include "mbd/run/run.h"
#include "transformer/program.h"
#include "transformer/recorder/fields.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace assess_test {

using namespace steplap;
using namespace steplap::assess;

std::string block_text(double mu, const std::string& more) {
  return R"(title = "Block on a tank"
[simulation]
end = 1.0
integrator = "dop853"
tolerance = 1e-10
[[body]]
name = "tank"
mass = 5000.0
inertia = 5000.0
position = [0.0, 1.0]
[[body]]
name = "block"
mass = 1000.0
inertia = 100.0
position = [0.0, 0.1]
[[marker]]
name = "lid"
body = "tank"
at = [0.5, 3.0]
[[recorder]]
name = "recorder"
marker = "lid"
x = "x"
y = "z"
settle = 0.3
[[element]]
kind = "unilateral_contact"
name = "front foot"
a = { body = "block", at = [1.0, 0.0] }
b = { body = "tank", at = [0.0, 0.0] }
normal = [0.0, 1.0]
stiffness = 1e8
damping = 1e5
preload = 4905.0
[[element]]
kind = "unilateral_contact"
name = "rear foot"
a = { body = "block", at = [-1.0, 0.0] }
b = { body = "tank", at = [0.0, 0.0] }
normal = [0.0, 1.0]
stiffness = 1e8
damping = 1e5
preload = 4905.0
[[element]]
kind = "coulomb_stick"
name = "floor"
contacts = ["rear foot", "front foot"]
source = "chosen, so that the block holds or slides"
)" + std::string("static_friction = ") +
         std::to_string(mu) + "\n" + more;
}

DrivenModel driven(const std::string& text) { return driven_model(parse_given_model(text, "scene.toml", program_catalogue()), "scene"); }

DriveHistory triangles(const std::vector<double>& peaks, double duration, double quiet, double step) {
  DriveHistory history;
  history.step = step;
  const auto each = static_cast<std::size_t>(std::lround((duration + quiet) / step));
  history.x.push_back(0.0);
  for (const double peak : peaks)
    for (std::size_t i = 1; i <= each; ++i) {
      const double t = static_cast<double>(i) * step;
      history.x.push_back(t >= duration ? 0.0 : peak * (1.0 - std::abs(2.0 * t / duration - 1.0)));
    }
  history.y.assign(history.x.size(), 0.0);
  return history;
}

double final_value(const DrivenModel& model, const DriveHistory& history, const std::string& channel) {
  Model given = model.given;
  drive_by(given, {history}, history.end() + model.recorder.settle);
  const Run run = run_model(load_given(given, "scene"));
  if (run.failure) throw std::runtime_error(run.failure->text);
  for (const ChannelRange& range : run.result.ranges)
    if (range.channel->name == channel) return range.final;
  throw std::runtime_error("no channel " + channel);
}

Folder::Folder() {
  static int count = 0;
  path = (std::filesystem::temp_directory_path() / ("steplap-assess-" + std::to_string(getpid()) + "-" + std::to_string(++count))).string();
  std::filesystem::create_directories(path);
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

std::string record_csv(double rate, double duration, const std::function<double(double)>& x) {
  std::string text = "time [s],x [g],y [g],z [g]\n";
  const long count = std::lround(duration * rate);
  for (long i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / rate;
    char row[80];
    const double noise = 1e-4 * std::sin(1e5 * t); // an axis that never moves is no axis
    std::snprintf(row, sizeof row, "%.6f,%.6f,%.6f,%.6f\n", t, x(t) / k_gravity, noise, 1.0 - noise);
    text += row;
  }
  return text;
}

} // namespace assess_test
