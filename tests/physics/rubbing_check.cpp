#include "tests/physics/rubbing_check.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace steplap::testing {

namespace {

using random::number;

// How often each friction element begins to slide.
std::map<std::string, int> slips_of(const Run& run) {
  std::map<std::string, int> slips;
  for (const Event& event : run.result.events)
    if (event.kind == EventKind::slips || event.kind == EventKind::slips_forward || event.kind == EventKind::slips_backward)
      ++slips[event.element];
  return slips;
}

Run exact_run(const RubbingBodies& scene) { return run(scene.text, {"dop853", 1e-10, scene.end}); }

} // namespace

RubbingTruth::RubbingTruth(RubbingScene make, int seed) : scene_(make(seed, {})) {
  const Run exact = exact_run(scene_);
  const std::map<std::string, int> slips = slips_of(exact);
  for (const auto& [name, times] : slips) slips_.insert(name);
  for (const std::string& place : scene_.places) places_.push_back(exact.last(place));
  changes_ = exact.result.events.size();
  is_robust_ = true;
  for (const double grip : {0.97, 1.03}) {
    Writing changed;
    changed.grip = grip;
    is_robust_ = is_robust_ && slips_of(exact_run(make(seed, changed))) == slips;
  }
}

std::string RubbingTruth::differs(RubbingScene make, int seed, double step, const Writing& writing) const {
  const Run run = stepped(make(seed, writing).text, step, scene_.end);
  const std::map<std::string, int> slips = slips_of(run);
  for (const std::string& friction : scene_.frictions)
    if (slips.contains(friction) != slips_.contains(friction))
      return "'" + friction + (slips_.contains(friction) ? "' holds, and slides in truth" : "' slides, and holds in truth");
  // Each change of friction comes up to a step and a half late or early, and as long acts an acceleration that is wrong by twice the
  // largest at most.
  const double allowed = 3.0 * step * scene_.acceleration * scene_.end * static_cast<double>(changes_ + 1);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const double off = std::abs(writing.sign * run.last(scene_.places[i]) - places_[i]);
    if (!(off <= allowed)) return scene_.places[i] + " is off by " + number(off) + " of at most " + number(allowed);
  }
  return "";
}

} // namespace steplap::testing
