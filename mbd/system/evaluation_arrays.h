// Arrays that elements read and write in an evaluation, and scratch memory of friction elements. Each evaluator (Dynamics, Statics, the
// calls of a tape, tests) has its own, allocated once for a system.
#pragma once

#include "mbd/system/system.h"

#include <limits>
#include <memory>
#include <vector>

namespace steplap {

/// Initial values: event functions 1 (not triggered), their rates NaN (unknown), all others 0.
struct EvaluationArrays {
  std::vector<BodyForce> force;                      ///< per slot (LinkTable)
  std::vector<double> contact_force;                 ///< per contact
  std::vector<double> event_value, event_derivative; ///< per event function
  std::vector<double> inner_rate;                    ///< per inner state

  explicit EvaluationArrays(const System& system)
      : force(static_cast<std::size_t>(system.links.slot_count())), contact_force(static_cast<std::size_t>(system.contact_count), 0.0),
        event_value(static_cast<std::size_t>(system.event_count), 1.0),
        event_derivative(event_value.size(), std::numeric_limits<double>::quiet_NaN()),
        inner_rate(static_cast<std::size_t>(system.inner_count()), 0.0) {}

  /// Makes `e` write to these arrays and read `motion`, which has one entry per slot. Both must outlive `e`.
  void connect(Evaluation& e, const std::vector<Motion<double>>& motion) {
    e.motion = e.link_motion = motion.data();
    e.force = e.link_force = force.data();
    e.contact_force = contact_force.data();
    e.event_value = event_value.data();
    e.event_derivative = event_derivative.data();
    e.inner_rate = inner_rate.data();
  }
};

/// Computes the motions of all links from those of the bodies; `motion` has one entry per slot, bodies first.
inline void place_links(const LinkTable& links, std::vector<Motion<double>>& motion) {
  for (int i = 0; i < links.size(); ++i) motion[links.slot(i)] = seen_from(motion[links[i].a], motion[links[i].b]);
}

/// Adds the forces in all links to those of their bodies; `motion` and `force` have one entry per slot.
inline void add_link_forces(const LinkTable& links, const std::vector<Motion<double>>& motion, std::vector<BodyForce>& force) {
  for (int i = 0; i < links.size(); ++i) {
    const int slot = links.slot(i);
    add_link_force(force[slot], motion[slot], motion[links[i].b], force[links[i].a], force[links[i].b]);
  }
}

/// Scratch objects of the friction elements of a system, for one thread; null for elements that need none.
class FrictionScratches {
public:
  explicit FrictionScratches(const System& system) {
    for (const FrictionUnit& unit : system.frictions) {
      owned_.push_back(unit.friction->make_scratch());
      pointers_.push_back(owned_.back().get());
    }
  }
  [[nodiscard]] FrictionScratch* const* pointers() const { return pointers_.data(); }

private:
  std::vector<std::unique_ptr<FrictionScratch>> owned_;
  std::vector<FrictionScratch*> pointers_;
};

} // namespace steplap
