// Faces that a contact law continues without end although the part that carries them ends: the line of a unilateral_contact, a half-plane,
// the road of a tyre. Beyond the outline of the part the law still exerts a force, although nothing is there; a run in which that happens
// must not count as held.
#pragma once

#include "mbd/base/types.h"
#include "mbd/system/motion.h"

#include <string>
#include <vector>

namespace steplap {

/// A face of body b without ends, on a part whose outline has ends.
struct EndlessFace {
  int element = 0;          ///< index in System::element_names
  int contact = 0;          ///< index of its normal force (EvaluationData::contact_force)
  int a = 0, b = 0;         ///< bodies of the system
  std::vector<Vec2> points; ///< points of a that may press, in a's axes from its centre of gravity, m
  Vec2 origin;              ///< a point of the face, in b's axes from its centre of gravity, m
  Vec2 normal;              ///< unit vector towards a, in b's axes
  double low = 0.0;         ///< smallest coordinate of b's outline along (n_y, −n_x), from b's centre of gravity, m
  double high = 0.0;        ///< largest coordinate in that direction, m
  std::string part;         ///< name of the body whose outline it is
  std::string remedy;       ///< clause for messages that says how the model can give the face an end
};

/// Position of a contact along its face.
struct FacePlace {
  double along = 0.0; ///< coordinate along (n_y, −n_x) from b's centre of gravity, m
  double rate = 0.0;  ///< its rate, m/s
};

/// Returns the length by which `along` lies beyond the outline, m; negative within it.
[[nodiscard]] double distance_beyond(const EndlessFace& face, double along);

/// Returns the position along the face of the contact point farthest beyond the outline, or nearest to its end if all lie within. With
/// several points only those behind the face count. Precondition: one of the points presses.
[[nodiscard]] FacePlace place_on(const EndlessFace& face, const Motion<double>* motion);

} // namespace steplap
