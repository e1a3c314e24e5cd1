#include "mbd/simulation/swallowed_check.h"

#include "mbd/base/number_text.h"
#include "mbd/system/element_failure.h"

namespace steplap {

SwallowedCheck::SwallowedCheck(const System& system) {
  for (const auto& group : system.groups)
    if (const auto* const contacts = dynamic_cast<const SwallowingContacts*>(group.get())) contacts_.push_back(contacts);
}

void SwallowedCheck::check(Dynamics& dynamics, double t, const double* y, const std::vector<UnitMode>& modes,
                           const std::vector<double>& event_value) const {
  const auto motion = [&dynamics, t, y] {
    (void)dynamics.mechanical_energy(t, y); // called because it computes the motions of all bodies
    return static_cast<const Motion<double>*>(dynamics.evaluation().motion);
  };
  for (const SwallowingContacts* group : contacts_) {
    const int unit = group->first_swallowed(modes, event_value, motion);
    if (unit < 0) continue;
    const System& system = dynamics.system();
    const std::string& name = system.element_names[system.units[unit].element];
    throw ElementFailure(
        "at t = " + number_text(t) + " s one body of '" + name + "' lies wholly within the other, where nothing pushes it out: " +
            (t > 0.0 ? "the contact is too soft for what comes upon it, or the step too long. Give it more 'stiffness', or take a "
                       "smaller tolerance or step"
                     : "place them apart, or touching"),
        {name});
  }
}

} // namespace steplap
