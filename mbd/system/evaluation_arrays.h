// Arrays that elements read and write in an evaluation, and scratch memory of friction elements. Each evaluator (Dynamics, Statics, a tape
// that calls elements, tests) has its own, allocated once for a system.
#pragma once

#include "mbd/system/system.h"

#include <limits>
#include <memory>
#include <vector>

namespace steplap {

/// Arrays for the results of an evaluation. Initial values: event functions 1 (not triggered), their rates NaN (unknown), all others 0.
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

/// Computes the motions of all links from those of the bodies. `motion` has one entry per slot of LinkTable, bodies first.
inline void place_links(const LinkTable& links, std::vector<Motion<double>>& motion) {
  for (int i = 0; i < links.size(); ++i) motion[links.slot(i)] = seen_from(motion[links[i].a], motion[links[i].b]);
}

/// Adds the force in each link to the forces on its two bodies. `motion` and `force` have one entry per slot of LinkTable.
inline void add_link_forces(const LinkTable& links, const std::vector<Motion<double>>& motion, std::vector<BodyForce>& force) {
  for (int i = 0; i < links.size(); ++i) {
    const int slot = links.slot(i);
    add_link_force(force[slot], motion[slot], motion[links[i].b], force[links[i].a], force[links[i].b]);
  }
}

/// The caches of all friction elements of a system (FrictionScratch) for one thread; null for elements without a cache.
class FrictionScratches {
public:
  explicit FrictionScratches(const System& system) {
    for (const FrictionUnit& unit : system.frictions) {
      owned_.push_back(unit.friction->make_scratch());
      pointers_.push_back(owned_.back().get());
    }
  }
  [[nodiscard]] FrictionScratch* const* pointers() const { return pointers_.data(); }
  /// Passes the relative tolerance of the run to all caches.
  void follow(double tolerance) {
    for (FrictionScratch* const scratch : pointers_)
      if (scratch) scratch->follow(tolerance);
  }

private:
  std::vector<std::unique_ptr<FrictionScratch>> owned_;
  std::vector<FrictionScratch*> pointers_;
};

} // namespace steplap
