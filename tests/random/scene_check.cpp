#include "tests/random/scene_check.h"

#include "mbd/base/number_text.h"
#include "mbd/rest/assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap::random {

namespace {

// A foot that changes at angles that cross slowly has no sharp time, and kinks of forces are the integrator's.
bool is_friction_event(const Event& event) { return is_slip(event.kind) || event.kind == EventKind::sticks; }

std::string text_of(const Disagreement& d) {
  std::string text = std::string(name_of(d.doubt)) + ": " + d.first;
  if (!d.second.empty()) text += " / " + d.second;
  return text + " " + d.where + " at " + number_text(d.t) + " s, ratio " + number_text(d.ratio) + " (" + d.text + ")";
}

bool is_same_fault(const SceneResult& a, const SceneResult& b) {
  if (!b.model_error.empty() || b.check.disagreements.empty()) return false;
  const Disagreement& wanted = a.check.disagreements.front();
  const double least = std::sqrt(std::min(wanted.ratio, 1e12)); // nor a trifle in its place
  return std::any_of(b.check.disagreements.begin(), b.check.disagreements.end(), [&](const Disagreement& d) {
    return d.doubt == wanted.doubt && d.ratio >= least && (d.first == wanted.first || d.second == wanted.first || d.first == wanted.second);
  });
}

} // namespace

std::string SceneResult::text() const {
  if (!model_error.empty()) return "no model: " + model_error;
  if (check.disagreements.empty())
    return check.outcome == CrossOutcome::vague ? "no comparison is possible after " + number_text(check.known_until) + " s" : "agrees";
  return text_of(check.disagreements.front());
}

SceneResult check_scene(const Scene& scene, const std::string& folder, long evaluation_limit) {
  SceneResult result;
  const double start = thread_cpu_seconds();
  try {
    const Model model = model_of(scene, folder);
    const std::unique_ptr<System> system = compile(model);
    const State initial = assembled_start(*system, assemble(model, *system));
    add_audit_channels(*system, model);
    CrossCheckOptions options;
    options.cpu_limit = std::numeric_limits<double>::infinity(); // machines differ
    options.evaluation_limit = evaluation_limit;
    options.is_event_counted = is_friction_event;
    options.free_groups = free_groups(model, *system);
    result.check = cross_check(*system, initial, options_of(model), options);
    for (CrossRun& run : result.check.runs) run.result.trajectory.reset();
  } catch (const ModelError& error) {
    result.model_error = error.what();
  }
  result.seconds = thread_cpu_seconds() - start;
  return result;
}

Scene shrunk(const Scene& scene, const SceneResult& result, const std::string& folder) {
  Scene best = scene;
  if (result.check.disagreements.empty()) return best;
  for (bool is_smaller = true; is_smaller;) {
    is_smaller = false;
    for (const Block& block : best.blocks) {
      const Scene smaller = best.without(block.name);
      if (smaller.blocks.empty()) continue;
      const SceneResult of_smaller = check_scene(smaller, folder);
      if (!is_same_fault(result, of_smaller)) continue;
      best = smaller;
      is_smaller = true;
      break;
    }
  }
  return best;
}

} // namespace steplap::random
