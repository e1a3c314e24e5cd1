#include "mbd/run/tipping_feet.h"

#include "mbd/rest/statics.h"
#include "mbd/system/contact_description.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_near = 1e-3; // largest gap of a foot, relative to the radius of gyration

class FootFinder {
public:
  FootFinder(const LoadedModel& loaded, const State& state)
      : loaded_(loaded), state_(state), pose_(loaded.model, *loaded.system, state_), statics_(*loaded.system) {
    statics_.evaluate(state_);
  }

  std::vector<Foot> run() {
    for (const ElementEntry& entry : loaded_.model.elements)
      if (const auto contact = contact_of(entry, loaded_.model)) add(*entry.element, *contact);
    return std::move(feet_);
  }

private:
  [[nodiscard]] bool touches(const std::string& name, int a, int b) const {
    if (is_closed(*loaded_.system, state_, name)) return true;
    const Channel* const gap = loaded_.system->find_channel(name + ".gap");
    if (!gap) return false;
    Snapshot snapshot;
    snapshot.t = state_.t;
    snapshot.motion = statics_.motion().data();
    snapshot.evaluation = &statics_.evaluation();
    snapshot.impacts = state_.impacts.data();
    double size = 0.0;
    for (const int i : {a, b})
      if (i != k_ground) size = std::max(size, std::sqrt(loaded_.system->bodies[i].inertia / loaded_.system->bodies[i].mass));
    return gap->value(snapshot) <= k_near * size;
  }

  void add(const Element& element, const ContactDescription& contact) {
    const int a = pose_.marker(contact.a).body, b = pose_.marker(contact.b).body;
    if (!touches(element.name, a, b)) return;
    const std::vector<ContactPoint> points = contact.points(element, pose_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const char* const which = points.size() == 1 ? "" : i == 0 ? " (left end)" : " (right end)";
      feet_.push_back({element.name, element.name + which, a, b, points[i].point, points[i].normal});
    }
  }

  const LoadedModel& loaded_;
  State state_;
  ScenePose pose_;
  Statics statics_;
  std::vector<Foot> feet_;
};

} // namespace

std::vector<Foot> feet_of(const LoadedModel& loaded, const State& state) { return FootFinder(loaded, state).run(); }

} // namespace steplap
