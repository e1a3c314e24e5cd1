// What an evaluation of doubles works on beside motions: the arrays that elements write, and the scratch of friction elements.
//
// Whoever evaluates elements (Dynamics, Statics, a tape's calls, tests) has one of each kind for itself, sized once for a system.
#pragma once

#include "mbd/system/system.h"

#include <limits>
#include <memory>
#include <vector>

namespace steplap {

/// Watch values begin as holding (1), their rates as unknown (NaN), all else at zero.
struct EvaluationArrays {
  std::vector<BodyForce> force;          ///< per slot (LinkTable)
  std::vector<double> contact_force;     ///< per contact
  std::vector<double> watch, watch_rate; ///< per watch slot
  std::vector<double> inner_rate;        ///< per inner state

  explicit EvaluationArrays(const System& system)
      : force(static_cast<std::size_t>(system.links.slot_count())), contact_force(static_cast<std::size_t>(system.contact_count), 0.0),
        watch(static_cast<std::size_t>(system.watch_count), 1.0), watch_rate(watch.size(), std::numeric_limits<double>::quiet_NaN()),
        inner_rate(static_cast<std::size_t>(system.inner_count()), 0.0) {}

  /// Lets `e` write here; `motion` per slot is what it reads. Both must outlive it.
  void connect(Evaluation& e, const std::vector<Motion<double>>& motion) {
    e.motion = e.link_motion = motion.data();
    e.force = e.link_force = force.data();
    e.contact_force = contact_force.data();
    e.watch = watch.data();
    e.watch_rate = watch_rate.data();
    e.inner_rate = inner_rate.data();
  }
};

/// Motions of all links of a system, from those of its bodies before them; `motion` per slot.
inline void place_links(const LinkTable& links, std::vector<Motion<double>>& motion) {
  for (int i = 0; i < links.size(); ++i) motion[links.slot(i)] = seen_from(motion[links[i].a], motion[links[i].b]);
}

/// Adds the forces in all links to those of their bodies; both per slot.
inline void add_link_forces(const LinkTable& links, const std::vector<Motion<double>>& motion, std::vector<BodyForce>& force) {
  for (int i = 0; i < links.size(); ++i) {
    const int slot = links.slot(i);
    add_link_force(force[slot], motion[slot], motion[links[i].b], force[links[i].a], force[links[i].b]);
  }
}

/// The scratch of each friction element of a system, null where it wants none: one per thread.
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
