// Motions that the constraint rows of a model at rest leave free, in coordinates of comparable size.
#pragma once

#include "mbd/rest/statics.h"

#include <Eigen/Core>

#include <vector>

namespace steplap {

/// Restricts dense matrix products to this thread while it exists. For matrices of this size several threads gain nothing, and waiting
/// threads take processor time from others.
class OneThread {
public:
  OneThread() : before_(Eigen::nbThreads()) { Eigen::setNbThreads(1); }
  ~OneThread() { Eigen::setNbThreads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

private:
  int before_;
};

/// Lengths by which the coordinates of a model are scaled.
struct SceneScale {
  /// Length scale of the model, m: the larger of the extent of the bodies' centres in x or y and the largest distance of a joint from the
  /// centre of its body. If both are almost zero, it is the largest radius of gyration.
  double length = 1.0;
  double reach = 1.0; ///< largest position in x or y, at least `length`, m
  VecX scale;         ///< per coordinate: 1 for positions, 1/radius for angles
};
[[nodiscard]] SceneScale scale_of(const System& system, const State& state);

struct Tangent {
  MatX held;             ///< orthonormal basis of the motions that the independent rows hold, scaled coordinates
  MatX free;             ///< orthonormal basis of the free motions, the complement of `held`
  std::vector<int> kept; ///< indices of independent rows
  MatX triangle;         ///< held · triangle = gradients of the kept rows
  VecX row_size;         ///< length of each row's scaled gradient
};
/// Returns the tangent at the last evaluation of `statics`. `kept`: indices of the independent rows, if they are known; then `free` is left
/// empty.
[[nodiscard]] Tangent tangent_of(const Statics& statics, const VecX& scale, const std::vector<int>* kept = nullptr);
/// Returns the multipliers of all rows that balance the forces; those of dependent rows are zero.
[[nodiscard]] VecX multipliers_of(const Statics& statics, const VecX& scale, const Tangent& tangent);

} // namespace steplap
