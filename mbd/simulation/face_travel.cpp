#include "mbd/simulation/face_travel.h"

#include <cmath>

namespace steplap {

FaceWatch::FaceWatch(const System& system) : faces_(system.endless_faces), farthest_(faces_.size(), {0.0, 0.0}), before_(faces_.size()) {}

std::vector<FaceTravel> FaceWatch::travels() const {
  std::vector<FaceTravel> found;
  for (std::size_t i = 0; i < faces_.size(); ++i)
    if (farthest_[i].beyond > 0.0) found.push_back({faces_[i], farthest_[i].beyond, farthest_[i].t});
  return found;
}

FaceWatch::End FaceWatch::end_of(const EndlessFace& face, const Snapshot& snapshot) {
  if (!(snapshot.evaluation->contact_force[face.contact] > 0.0)) return {};
  return {true, place_on(face, snapshot.motion)};
}

void FaceWatch::note(std::size_t face, double along, double t) {
  if (const double beyond = distance_beyond(faces_[face], along); beyond > farthest_[face].beyond) farthest_[face] = {beyond, t};
}

void FaceWatch::begin(const Snapshot& snapshot) {
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    before_[i] = end_of(faces_[i], snapshot);
    if (before_[i].is_pressed) note(i, before_[i].place.along, snapshot.t);
  }
  t_ = snapshot.t;
}

void FaceWatch::arrive(const Snapshot& snapshot) {
  const double h = snapshot.t - t_;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const End first = before_[i], last = end_of(faces_[i], snapshot);
    before_[i] = last;
    if (last.is_pressed) note(i, last.place.along, snapshot.t);
    if (!first.is_pressed || !last.is_pressed) continue;
    // Travel along a face within a step, as cubic s(θ), θ = 0 … 1, through positions and rates at the ends. Its extremes are where s′ = s0
    // + 2 b θ + 3 a θ² = 0.
    const double s0 = h * first.place.rate, s1 = h * last.place.rate, rise = last.place.along - first.place.along;
    const double a = s0 + s1 - 2.0 * rise, b = 3.0 * rise - 2.0 * s0 - s1, square = b * b - 3.0 * a * s0;
    if (!(square >= 0.0)) continue;
    const double q = -(b + std::copysign(std::sqrt(square), b));
    for (const double theta : {q / (3.0 * a), s0 / q})
      if (theta > 0.0 && theta < 1.0) note(i, first.place.along + theta * (s0 + theta * (b + theta * a)), t_ + theta * h);
  }
  t_ = snapshot.t;
}

} // namespace steplap
