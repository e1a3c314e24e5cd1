// The motions that the rows of a scene at rest leave free, in coordinates of comparable size.
#pragma once

#include "mbd/rest/statics.h"

#include <Eigen/Core>

#include <vector>

namespace steplap {

/// While it lives, dense products are made by this thread alone: threads are not worth their while
/// in products of this size, and where they wait they take the time of others.
class OneThread {
public:
  OneThread() : before_(Eigen::nbThreads()) { Eigen::setNbThreads(1); }
  ~OneThread() { Eigen::setNbThreads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

private:
  int before_;
};

/// Lengths of a scene: of the whole, and for each body the radius at which its angle counts as a displacement.
struct SceneScale {
  double length = 1.0; ///< m: extent of its bodies, or the farthest place of a joint on one
  double reach = 1.0;  ///< m: the largest coordinate, or the length
  VecX scale;          ///< per coordinate: 1 for metres, for radians one over the radius
};
[[nodiscard]] SceneScale scale_of(const System& system, const State& state);

struct Tangent {
  MatX held;             ///< orthonormal: what the independent rows hold, scaled coordinates
  MatX free;             ///< and its complement
  std::vector<int> kept; ///< the independent rows
  MatX triangle;         ///< held · triangle = gradients of the kept rows
  VecX row_size;         ///< of each row's scaled gradient
};
/// At the last evaluation of `statics`. `kept`: the independent rows, if they are known; then `free` is not filled in.
[[nodiscard]] Tangent tangent_of(const Statics& statics, const VecX& scale, const std::vector<int>* kept = nullptr);
/// Multipliers of all rows that balance the forces; zero for those that depend on others.
[[nodiscard]] VecX multipliers_of(const Statics& statics, const VecX& scale, const Tangent& tangent);

} // namespace steplap
