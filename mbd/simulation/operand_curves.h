// Polynomials with error bounds for the operands of formulas, over parts ("panels") of a stretch of a run.
//
// theta goes from 0 to 1 over the stretch. A panel is sampled at nine Chebyshev–Lobatto points, which define a polynomial of degree 8, the
// degree of dop853's dense output. The error is estimated from the decrease of its coefficients, and a tenth sample between the nodes must
// agree with the polynomial. If it does not, or if the coefficients do not decrease (a kink or a jump), the curve is only enclosed by the
// range of its samples, extended by its width on either side. Halving a panel gives better bounds. Limit: a feature between the nodes that
// no sample shows is missed.
#pragma once

#include "mbd/formula/enclosure.h"
#include "mbd/system/formula_channel.h"

#include <functional>
#include <vector>

namespace steplap {

/// Polynomials of all operands over the panels of one stretch.
class OperandCurves {
public:
  static constexpr int k_degree = k_enclosure_degree; ///< degree of the polynomials
  static constexpr int k_nodes = k_degree + 1;        ///< number of samples that determine a polynomial
  using Coefficients = std::array<double, k_nodes>;   ///< of 1, s, s² …

  /// An operand over one panel; s goes from −1 to 1.
  struct Curve {
    Coefficients c{};          ///< coefficients of the polynomial
    double error = 0.0;        ///< error bound of the polynomial
    double floor = 0.0;        ///< part of `error` due to rounding, which halving does not reduce
    Interval hull;             ///< enclosure of the curve by its samples, if it is not smooth
    bool is_smooth = false;    ///< false: only `hull` is valid
    bool lacks_values = false; ///< some values are NaN
    bool is_halving = true;    ///< halving the parent panel has reduced the error considerably
  };
  /// A part of the stretch.
  struct Panel {
    double begin = 0.0, end = 1.0; ///< begin and end in theta
    int half = -1;                 ///< index of the first of its two halves; −1: not halved
    int depth = 0;                 ///< number of halvings
  };
  /// Returns the motion at theta of the stretch.
  using DenseEvaluation = std::function<Snapshot(double theta)>;

  /// `leaves`: operands of all formulas.
  explicit OperandCurves(std::vector<FormulaChannel::Leaf> leaves);

  /// Returns the number of operands.
  [[nodiscard]] std::size_t count() const { return leaves_.size(); }
  /// Writes the operands at `snapshot` to `values`, in SI units.
  void read(const Snapshot& snapshot, double* values) const;

  /// Uses the straight lines between the values at both ends; `error` is the largest deviation of each curve from its line.
  void begin_straight(const double* first, const double* last, const double* error);
  /// Samples the stretch. `first`, `last`: values at both ends.
  void begin(const double* first, const double* last, const DenseEvaluation& evaluate_dense);
  /// Samples both halves of a panel.
  void halve(int panel, const DenseEvaluation& evaluate_dense);

  /// Returns panel i.
  [[nodiscard]] const Panel& panel(int i) const { return panels_[static_cast<std::size_t>(i)]; }
  /// Returns the number of panels, including halved ones.
  [[nodiscard]] int panels() const { return static_cast<int>(panels_.size()); }
  /// Returns the curve of an operand over a panel.
  [[nodiscard]] const Curve& curve(int panel, std::size_t leaf) const {
    return curves_[static_cast<std::size_t>(panel) * leaves_.size() + leaf];
  }
  /// Returns true if halving the panel would improve its bounds.
  [[nodiscard]] bool can_improve(int panel, std::size_t leaf) const;

  /// Returns an enclosure of an operand over part of a panel; begin and end in theta.
  [[nodiscard]] Enclosure<k_degree> over(int panel, std::size_t leaf, double begin, double end) const;
  /// Returns node i of a panel, in s.
  [[nodiscard]] static double node(int i);
  /// Returns the polynomial with these values at the nodes.
  [[nodiscard]] static Coefficients polynomial_through(const Coefficients& values);
  /// Returns an enclosure of a polynomial in s over middle ± half. `error`: its error bound.
  [[nodiscard]] static Enclosure<k_degree> part_of(const Coefficients& polynomial, double middle, double half, double error);
  /// Returns an enclosure of an operand at one point of a panel.
  [[nodiscard]] Enclosure<0> at(int panel, std::size_t leaf, double theta) const;

private:
  int add_panel(double begin, double end, int depth, int whole);
  void sample(int panel, const DenseEvaluation& evaluate_dense, const double* first, const double* last);
  void fit(int panel, std::size_t leaf, int whole, double checked);

  std::vector<FormulaChannel::Leaf> leaves_;
  std::vector<Panel> panels_;
  std::vector<Curve> curves_;              ///< for each panel, all operands
  std::vector<std::vector<double>> nodes_; ///< samples of the present panel, by node
  std::vector<double> check_, first_, middle_, last_;
};

} // namespace steplap
