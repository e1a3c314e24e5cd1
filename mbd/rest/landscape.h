// Forces and stiffness at a pose, along the motions that the rows allow, and steps computed from them for descent.h.
//
// Coordinates are scaled (SceneScale). There are two implementations. Dense: an orthonormal basis of the motions and all eigenvalues λᵢ
// (1/s²) of the stiffness in the mass metric. Sparse, for models beyond some tens of bodies: equations bordered by the rows
// (bordered_system.h) take the place of the basis, signs of pivots that of signs of eigenvalues, and filters λ/(λ + σ), one solution each,
// that of eigenvalues.
#pragma once

#include "mbd/rest/motion_part.h"
#include "mbd/rest/tangent.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace steplap {

[[nodiscard]] MotionPart largest_part(const VecX& scaled);

class Landscape {
public:
  struct StepProblem {
    const System& system;
    const Statics& statics;
    const VecX& scale;
    const VecX& mass; ///< masses of the scaled coordinates
    double length = 1.0;
  };
  /// Function that returns the size of a step: 1 at the border of the trust region.
  using StepSize = std::function<double(const VecX&)>;
  /// Direction of negative stiffness; the force along it, and the rounding error of that force.
  struct Unstable {
    VecX direction;
    double force = 0.0, rounding = 0.0;
  };

  explicit Landscape(const StepProblem& scene) : scene_(scene) {}
  virtual ~Landscape() = default;
  Landscape(const Landscape&) = delete;
  Landscape& operator=(const Landscape&) = delete;

  /// Linearises at the last evaluation of the statics, with its present rows.
  virtual void linearise(const State& state) = 0;
  // The following refer to the pose of the last linearise().
  [[nodiscard]] const VecX& force() const { return force_; }        ///< force along the motions that the rows allow
  [[nodiscard]] const VecX& multipliers() const { return lambda_; } ///< multipliers of all rows
  /// Returns the Newton step to the balance of forces, without components along directions that have no stiffness.
  [[nodiscard]] virtual VecX newton_step() = 0;
  /// Returns true if forces act along directions without stiffness, so that Newton's method cannot balance them.
  [[nodiscard]] virtual bool is_pushed() = 0;
  /// Returns true if the stiffness is not symmetric: follower loads and sliding friction have no potential.
  [[nodiscard]] virtual bool is_skew() const = 0;
  /// Returns a norm of the unbalanced force in the mass metric.
  [[nodiscard]] virtual double imbalance() const = 0;
  /// Returns a downhill step within the trust region that `size` defines.
  [[nodiscard]] virtual VecX trust_step(const StepSize& size) = 0;
  /// Returns the direction of the most negative stiffness; nothing if there is none.
  [[nodiscard]] virtual std::optional<Unstable> most_unstable_direction() = 0;
  /// Returns the number of directions along which small displacements meet no resistance.
  [[nodiscard]] virtual int count_yielding() = 0;
  /// Returns the acceleration of the scaled coordinates.
  [[nodiscard]] virtual VecX acceleration() = 0;
  /// Returns the directions without stiffness, each by its largest component. `unnamed` receives the number of further ones.
  [[nodiscard]] virtual std::vector<MotionPart> indifferent(int& unnamed) = 0;

  // The following refer to the present evaluation of the statics, which may be at another pose with the same rows.
  /// Computes the least displacement `way` (in scaled coordinates) that removes the errors `off` of the rows. Returns its size.
  virtual double displacement_to_rows(const VecX& off, VecX& way) = 0;
  /// Returns the lengths of the rows' scaled gradients at the last displacement_to_rows().
  [[nodiscard]] virtual const VecX& row_size() const = 0;
  /// Returns the component of a vector along the motions that the rows allow, with the rows of the last displacement_to_rows().
  [[nodiscard]] virtual VecX along_rows(const VecX& vector) const = 0;
  /// Returns the displacement that balances the forces in the stiff directions. `size` receives its largest component.
  [[nodiscard]] virtual VecX stiff_imbalance(double& size) = 0;

protected:
  [[nodiscard]] VecX scaled_force() const { return scene_.scale.cwiseProduct(scene_.statics.force()); }
  /// Returns rounding errors of the forces, due to rounding of poses, stiffness and reactions. `sizes`: sums of the absolute terms of the
  /// forces.
  [[nodiscard]] VecX rounding_of(const State& state, const VecX& sizes, const std::function<VecX(const VecX&)>& stiffness) const;

  StepProblem scene_;
  VecX force_, lambda_;
};

[[nodiscard]] std::unique_ptr<Landscape> dense_landscape(const Landscape::StepProblem& scene);
[[nodiscard]] std::unique_ptr<Landscape> sparse_landscape(const Landscape::StepProblem& scene);

} // namespace steplap
