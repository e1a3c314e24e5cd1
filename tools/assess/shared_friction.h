// Friction contact on which both models of a machine rest, each in its own plane.
//
// Models share friction elements by name (elements/views/friction_plane.h, which defines their combined utilisation). The record's axes
// along them must differ.
//
// If the combined load causes slip, a point mass is integrated in the plane of the contact (sliding_point.h). The force that drives it is
// the force of the machine on the contact: −T_i while plane i sticks, otherwise −m a_i from the record, including gravity along the slope.
// m is fitted to T_i = m a_i over the intervals of sticking, and is at most the weight on the contact. The slide is the length of the
// point's path. It is an upper bound if other elements hold the load (ropes, stops, other frictions), because the point ignores them, or if
// a part lifts. Rotation about the vertical axis is not modelled.
#pragma once

#include "elements/views/friction_plane.h"
#include "tools/assess/driven_model.h"
#include "tools/assess/voyage_summary.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// The part of a shared friction that one model computes.
struct PlaneOfFriction : FrictionPlane {
  std::size_t model = 0;            ///< index of the model
  std::vector<std::size_t> traces;  ///< indices into DrivenModel::traced; the friction force is the sum over them
  std::vector<std::string> holders; ///< other elements that hold the load
  struct Limit {
    std::string name;
    double most = 0.0; ///< largest permitted slide, m
    Verdict consequence = Verdict::inspect;
    bool is_assumed = false; ///< true if the limit is assumed (assumed_limits.h)
  };
  std::vector<Limit> limits; ///< [[acceptance]] limits of the slide
};

/// A friction contact shared by two models.
struct SharedFriction {
  std::string name;
  std::array<PlaneOfFriction, 2> planes;
};

/// Finds the shared frictions of all models and sets their `traced`. Throws ModelError if elements with forces to be summed do not act
/// along the same line.
[[nodiscard]] std::vector<SharedFriction> find_shared_frictions(std::vector<DrivenModel>& models);
/// Returns the frictions of the first two models that lie in different planes, both rest on friction and share none of it, as "'floor' of
/// 'length.toml' and 'floor across' of 'across.toml'"; "" if there are none.
[[nodiscard]] std::string unshared_planes(const std::vector<DrivenModel>& models, const std::vector<SharedFriction>& shared);

/// Result of one event for a shared friction.
struct SharedPassage : SharedUse {
  std::size_t friction = 0; ///< index of the shared friction
  double slid = 0.0;        ///< length of the path during this event, m; infinite if the point does not come to rest
  double slid_total = 0.0;  ///< sum over all events so far, m
  std::string bound;        ///< reason why the path is an upper bound; "" if it is not
  std::string disagreement; ///< contradiction between the models, which cannot show the same machine then; "" if there is none
};

/// A shared friction during the voyage: keeps the state between its events.
class SharedFrictionCourse {
public:
  explicit SharedFrictionCourse(const SharedFriction& friction) : friction_(friction) {}

  /// Evaluates the next event. `traces` and `histories` belong to the two planes.
  [[nodiscard]] SharedPassage pass(const std::array<SampledFriction, 2>& traces, const std::array<const DriveHistory*, 2>& histories);

private:
  struct Instant;
  [[nodiscard]] std::vector<Instant> instants(const std::array<SampledFriction, 2>& traces,
                                              const std::array<const DriveHistory*, 2>& histories) const;
  void slide(const std::vector<Instant>& instants, const std::array<SampledFriction, 2>& traces, bool goes_on, SharedPassage& passage);

  const SharedFriction& friction_;
  std::optional<SharedContact> contact_; ///< contact with the normal forces at the begin of the voyage
  Vec2 velocity_ = Vec2::Zero();         ///< velocity at the end of the previous event, m/s
  double slid_total_ = 0.0;
};

/// The states of all shared frictions of a voyage.
class SharedFrictions {
public:
  explicit SharedFrictions(const std::vector<SharedFriction>& frictions);
  /// Evaluates the next event. `traces` and `histories` have one entry per model.
  [[nodiscard]] std::vector<SharedPassage> pass(const std::vector<const std::vector<SampledFriction>*>& traces,
                                                const std::vector<const DriveHistory*>& histories);

private:
  const std::vector<SharedFriction>& frictions_;
  std::vector<SharedFrictionCourse> courses_;
};

/// Merges a result into the summary to which the criteria are applied. `number`: that of the event, from 1.
void add_to(VoyageSummary& summary, const SharedFriction& friction, const SharedPassage& passage, std::size_t number);
/// Returns the assumptions of this calculation as sentences.
[[nodiscard]] std::vector<std::string> assumptions_of(const std::vector<SharedFriction>& frictions);

} // namespace steplap::assess
