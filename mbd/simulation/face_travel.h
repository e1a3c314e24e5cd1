// Distances by which contacts on endless faces (endless_face.h) have pressed beyond the ends of their parts during a run.
#pragma once

#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Largest distance by which a contact has pressed beyond the end of its part.
struct FaceTravel {
  EndlessFace face;    ///< face; its contact and bodies are indices of the leg in which this happened
  double beyond = 0.0; ///< distance beyond the end, m, above 0
  double t = 0.0;      ///< time, s
};

/// Finds the travels of one leg of a run from the motion at the ends of steps, interpolated by cubics.
class FaceWatch {
public:
  /// Keeps a reference to the system.
  explicit FaceWatch(const System& system);

  /// Starts a smooth stretch of motion.
  void begin(const Snapshot& snapshot);
  /// Ends a stretch at `snapshot`, where the next one starts.
  void arrive(const Snapshot& snapshot);

  /// Returns the travels of the faces that contacts have left.
  [[nodiscard]] std::vector<FaceTravel> travels() const;

private:
  struct End { ///< motion at one end of a stretch
    bool is_pressed = false;
    FacePlace place;
  };
  struct Farthest {
    double beyond, t;
  };
  [[nodiscard]] static End end_of(const EndlessFace& face, const Snapshot& snapshot);
  void note(std::size_t face, double along, double t);

  const std::vector<EndlessFace>& faces_;
  std::vector<Farthest> farthest_; ///< per face
  std::vector<End> before_;
  double t_ = 0.0; ///< start of the stretch, s
};

} // namespace steplap
