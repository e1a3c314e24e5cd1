// One friction in two planes: models of one machine that lie in different planes share the friction under it.
//
// Friction is one vector. Each model judges the part along its plane against all of mu N; together they ask for the root of the sum of
// squares. Frictions (coulomb_stick) are one and the same where models name them alike, by their names or by `shared_friction`, and the
// axes of the record along them differ; several of a model with one name count by their sum. Judged at the same instants of the record:
//
//   use = sqrt(T_1² + T_2²) / (mu N),  N = min over i of N_i - N_i(0) (1 - c / c_i),  c² = c_1² + c_2² - 1
//
// T_i and N_i are of the models. c_i is the cosine of the tilt of plane i, the angle of gravity against the normal of its contacts;
// c is that of both tilts together. Every N_i contains the vertical axis of the record, and the least of them counts: once. N_i(0)
// is the normal force at rest, the only part that a standing tilt takes away from.
//
// Where both planes together slip, a point is integrated in the plane of the contact (sliding_point.h) under the force that the machine
// asks of the contact: -T_i while plane i holds, -m a_i from the record (gravity along the slope included) while it does not. m is what
// T_i = m a_i of the holding stretches fits best, at most the weight on the contact. What the point slides is the length of its path.
// Whatever else holds the load (ropes, stops, other frictions) holds it before it has slid, and no part of a point lifts: then the path
// is an upper bound. Turning about the vertical axis is not modelled.
#pragma once

#include "tools/assess/friction_trace.h"
#include "tools/assess/voyage_summary.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// A shared friction in one model.
struct PlaneOfFriction {
  std::size_t model = 0;            ///< index
  std::string model_name;           ///< for people
  std::vector<std::size_t> traces;  ///< of DrivenModel::traced: their sum is the friction
  Vec2 tangent = Vec2(1.0, 0.0);    ///< of the contacts, ground axes
  double gravity = 0.0;             ///< m/s², its size
  double downhill = 0.0;            ///< m/s², gravity along the tangent
  double tilt = 1.0;                ///< cosine of the angle between gravity and the contacts' normal
  std::vector<std::string> holders; ///< elements that hold the load besides
  struct Limit {
    std::string name;
    double most = 0.0; ///< m
    Verdict consequence = Verdict::inspect;
  };
  std::vector<Limit> limits; ///< [[acceptance]] of the slide
};

/// A friction that two models have in common.
struct SharedFriction {
  std::string name;
  std::array<PlaneOfFriction, 2> planes;
};

/// Finds them, and sets `traced` of the models. Throws ModelError if frictions that are to be summed do not lie along one line.
[[nodiscard]] std::vector<SharedFriction> find_shared_frictions(std::vector<DrivenModel>& models);

/// The outcome of an event for a shared friction.
struct SharedPassage {
  std::size_t friction = 0; ///< index
  double use = 0.0;         ///< largest, of mu N
  double at = 0.0;          ///< s, when
  bool slips = false;       ///< both planes together, with a part of each
  double slid = 0.0;        ///< m, length of the point's path in this event; infinite: it does not come to rest
  double slid_total = 0.0;  ///< m, of all events so far
  std::string bound;        ///< not empty: why the path is an upper bound
  std::string disagreement; ///< not empty: the models cannot be of one machine
};

/// A shared friction on its way through the voyage.
class SharedFrictionCourse {
public:
  explicit SharedFrictionCourse(const SharedFriction& friction) : friction_(friction) {}

  /// `traces`, `histories`: of the event in both planes.
  [[nodiscard]] SharedPassage pass(const std::array<FrictionTrace, 2>& traces, const std::array<const DriveHistory*, 2>& histories);

private:
  struct Instant;
  [[nodiscard]] std::vector<Instant> instants(const std::array<FrictionTrace, 2>& traces,
                                              const std::array<const DriveHistory*, 2>& histories) const;
  [[nodiscard]] std::string disagreement_at_rest() const;
  void slide(const std::vector<Instant>& instants, const std::array<FrictionTrace, 2>& traces, bool goes_on, SharedPassage& passage);

  const SharedFriction& friction_;
  std::optional<std::array<double, 2>> at_rest_; ///< N, normal forces with which the voyage began
  Vec2 velocity_ = Vec2::Zero();                 ///< m/s, with which the last event ended
  double slid_total_ = 0.0;
};

/// The courses of all shared frictions of a voyage.
class SharedFrictions {
public:
  explicit SharedFrictions(const std::vector<SharedFriction>& frictions);
  /// The next event; `traces` and `histories` of it, one entry per model.
  [[nodiscard]] std::vector<SharedPassage> pass(const std::vector<const std::vector<FrictionTrace>*>& traces,
                                                const std::vector<const DriveHistory*>& histories);

private:
  const std::vector<SharedFriction>& frictions_;
  std::vector<SharedFrictionCourse> courses_;
};

/// Adds a passage to the summary that criteria look at. `number`: of the event, from 1.
void add_to(VoyageSummary& summary, const SharedFriction& friction, const SharedPassage& passage, std::size_t number);
/// Sentences on what is taken for granted.
[[nodiscard]] std::vector<std::string> assumptions_of(const std::vector<SharedFriction>& frictions);

} // namespace steplap::assess
