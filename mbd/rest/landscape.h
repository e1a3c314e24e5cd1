// Forces and stiffness of a scene about a pose, along the motions that its rows allow: what the way downhill asks of them.
//
// Scaled coordinates (SceneScale). Two kinds of algebra answer: dense, with an orthonormal basis of the motions and all
// eigenvalues λᵢ (1/s²) of the stiffness in the masses' metric, and sparse, for scenes beyond some tens of bodies, where
// equations bordered by the rows (bordered_system.h) take the place of the basis, the signs of their pivots that of the
// eigenvalues, and filters λ/(λ + σ), a solution each, that of looking at each of them.
#pragma once

#include "mbd/rest/tangent.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace steplap {

/// Largest part of a motion: coordinate 0, 1, 2 (x, y, θ) of a body, and which way.
struct MotionPart {
  int body = 0, coordinate = 0;
  double sign = 1.0;
};
[[nodiscard]] MotionPart largest_part(const VecX& scaled);

enum class RestAlgebra { by_size, dense, sparse };

class Landscape {
public:
  struct Scene {
    const System& system;
    const Statics& statics;
    const VecX& scale;
    const VecX& mass; ///< of the scaled coordinates
    double length = 1.0;
  };
  /// Of a step: 1 at the border of the region in which the linear equations are trusted.
  using StepSize = std::function<double(const VecX&)>;
  /// A direction in which a nudge is not resisted, and the force along it.
  struct Unstable {
    VecX direction;
    double force = 0.0, rounding = 0.0;
  };

  explicit Landscape(const Scene& scene) : scene_(scene) {}
  virtual ~Landscape() = default;
  Landscape(const Landscape&) = delete;
  Landscape& operator=(const Landscape&) = delete;

  /// At the last evaluation of the statics and its rows.
  virtual void linearise(const State& state) = 0;
  // From there on, about that pose:
  [[nodiscard]] const VecX& force() const { return force_; }        ///< along the rows
  [[nodiscard]] const VecX& multipliers() const { return lambda_; } ///< of all rows
  /// To where forces balance; along what nothing holds there is none.
  [[nodiscard]] virtual VecX newton_step() = 0;
  /// Forces push along what nothing holds.
  [[nodiscard]] virtual bool is_pushed() = 0;
  /// Loads that turn with a body and friction that slides have no potential.
  [[nodiscard]] virtual bool is_skew() const = 0;
  /// What is out of balance, in the masses' metric.
  [[nodiscard]] virtual double imbalance() const = 0;
  /// Downhill, to the border of the region at most.
  [[nodiscard]] virtual VecX trust_step(const StepSize& size) = 0;
  [[nodiscard]] virtual std::optional<Unstable> most_unstable() = 0;
  /// Directions in which the forces do not hold it back.
  [[nodiscard]] virtual int count_yielding() = 0;
  /// Of the scaled coordinates.
  [[nodiscard]] virtual VecX acceleration() = 0;
  /// What nothing holds, by largest parts; `unnamed`: how many more directions there are.
  [[nodiscard]] virtual std::vector<MotionPart> indifferent(int& unnamed) = 0;

  // At the present evaluation of the statics, which may be another pose with the same rows:
  /// The least motion that meets the rows, and how far off they are.
  virtual double way_to_rows(const VecX& off, VecX& way) = 0;
  /// Lengths of the rows' scaled gradients, as of the last way_to_rows().
  [[nodiscard]] virtual const VecX& row_size() const = 0;
  /// The part of a vector that the rows allow, as of the last way_to_rows().
  [[nodiscard]] virtual VecX along_rows(const VecX& vector) const = 0;
  /// Displacements that would restore the balance there in the stiff directions; their largest in `size`.
  [[nodiscard]] virtual VecX stiff_imbalance(double& size) = 0;

protected:
  [[nodiscard]] VecX scaled_force() const { return scene_.scale.cwiseProduct(scene_.statics.force()); }
  /// What rounding of poses, stiffness and reactions leaves of forces of these sizes.
  [[nodiscard]] VecX rounding_of(const State& state, const VecX& sizes, const std::function<VecX(const VecX&)>& stiffness) const;

  Scene scene_;
  VecX force_, lambda_;
};

[[nodiscard]] std::unique_ptr<Landscape> dense_landscape(const Landscape::Scene& scene);
[[nodiscard]] std::unique_ptr<Landscape> sparse_landscape(const Landscape::Scene& scene);

} // namespace steplap
