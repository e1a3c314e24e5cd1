#include "elements/views/kind_checks.h"

#include "elements/coulomb_stick.h"
#include "elements/unilateral_contact.h"
#include "mbd/model/entries.h"
#include "mbd/run/quantity_text.h"
#include "mbd/system/places.h"

#include <algorithm>
#include <unordered_map>

namespace steplap {

namespace {

constexpr double k_step_share = 0.01; // largest error of the couple, relative to N times the distance between the feet
constexpr double k_same = 1e-9;       // tolerance of positions, m: accuracy of typed coordinates

struct Spread {
  double low = 0.0, high = 0.0;
  int count = 0;
  void add(double value) {
    low = count == 0 ? value : std::min(low, value);
    high = count == 0 ? value : std::max(high, value);
    ++count;
  }
  [[nodiscard]] double size() const { return high - low; }
};

// Adds the height of the contact line along the normal, and the position along the line, both in b's frame.
void add_foot(const LoadedModel& loaded, const State& given, const UnilateralContact& contact, Spread& height, Spread& way) {
  const Place a = place_of(loaded.model, contact.a), b = place_of(loaded.model, contact.b);
  const Vec3 at = pose_of(*loaded.system, given, a.body), on = pose_of(*loaded.system, given, b.body);
  const Vec2 foot = rotated(Vec2(at.x() - on.x(), at.y() - on.y()) + rotated(a.point, at.z()), -on.z());
  const Vec2 normal = rotated(contact.normal.normalized(), b.angle);
  const bool is_by_pose = contact.gap || contact.interference || contact.preload;
  height.add(is_by_pose ? normal.dot(foot) - contact.gap.value_or(0.0) + contact.interference.value_or(0.0) : normal.dot(b.point));
  way.add(normal.y() * foot.x() - normal.x() * foot.y());
}

} // namespace

std::vector<Finding> stepped_feet(const LoadedModel& loaded) {
  const State given = loaded.system->initial_state();
  std::unordered_map<std::string, const UnilateralContact*> contacts;
  for (const UnilateralContact* const contact : elements_of<UnilateralContact>(loaded.model)) contacts[contact->name] = contact;
  std::vector<Finding> found;
  for (const CoulombStick* const stick : elements_of<CoulombStick>(loaded.model)) {
    Spread height, way;
    for (const std::string& name : stick->contacts)
      if (const auto contact = contacts.find(name); contact != contacts.end()) add_foot(loaded, given, *contact->second, height, way);
    if (!(height.size() > k_step_share * way.size() + k_same)) continue;
    found.push_back({"stepped_feet", FindingLevel::warning,
                     "the contacts of coulomb_stick '" + stick->name + "' touch on lines " + quantity_text(height.size(), "m", 1e-3) +
                         " apart, but their friction acts on one of them: give those of each line their own coulomb_stick",
                     stick->where});
  }
  return found;
}

} // namespace steplap
