// The curves of channels inside a stretch of a run, as polynomials over *panels* of it: what formulas of them are bounded by.
//
// theta goes from 0 to 1 over the stretch. A panel is looked at in nine Chebyshev–Lobatto points, whose polynomial is of degree
// 8, as that of the dense output of dop853; how fast its coefficients fall tells what is left out, and a tenth look, beside all
// nodes, has to agree. Where it does not, or the coefficients do not fall, as at a kink or a jump, all that is said of the curve
// is the hull of the values seen, widened by as much on either side. Halves of a panel know more. Limit: what a curve does
// between nodes of which none of them shows anything, as of all that is looked at in points.
#pragma once

#include "mbd/formula/enclosure.h"
#include "mbd/system/formula_channel.h"

#include <functional>
#include <vector>

namespace steplap {

/// Polynomials of all operands over the panels of one stretch.
class OperandCurves {
public:
  static constexpr int k_degree = k_enclosure_degree; ///< of the polynomials

  /// One curve over one panel, in s from −1 to 1.
  struct Curve {
    std::array<double, k_degree + 1> c{}; ///< of powers of s
    double error = 0.0;                   ///< at most, of the polynomial
    double floor = 0.0;                   ///< of rounding: no panel makes the error less
    Interval hull;                        ///< of what is not smooth
    bool is_smooth = false;               ///< false: only `hull` is known
    bool lacks_values = false;            ///< somewhere
    bool is_halving = true;               ///< the error is much less than that of the panel of which this is a half
  };
  /// A part of the stretch.
  struct Panel {
    double begin = 0.0, end = 1.0; ///< in theta
    int half = -1;                 ///< the first of its two, −1: it is whole
    int depth = 0;                 ///< halvings of the whole
  };
  /// A look at theta: everything that is wanted there.
  using Look = std::function<Snapshot(double theta)>;

  /// Of these operands.
  explicit OperandCurves(std::vector<FormulaChannel::Leaf> leaves);

  /// Operands there are.
  [[nodiscard]] std::size_t count() const { return leaves_.size(); }
  /// Values now, in SI.
  void read(const Snapshot& snapshot, double* values) const;

  /// A straight line between values at both ends, each curve within `error` of it.
  void begin_straight(const double* first, const double* last, const double* error);
  /// Looks inside; values at both ends are known.
  void begin(const double* first, const double* last, const Look& look);
  /// Looks at both halves.
  void halve(int panel, const Look& look);

  /// By its number, from 0.
  [[nodiscard]] const Panel& panel(int i) const { return panels_[static_cast<std::size_t>(i)]; }
  /// Panels there are, halved ones among them.
  [[nodiscard]] int panels() const { return static_cast<int>(panels_.size()); }
  /// Of an operand over a panel.
  [[nodiscard]] const Curve& curve(int panel, std::size_t leaf) const {
    return curves_[static_cast<std::size_t>(panel) * leaves_.size() + leaf];
  }
  /// Would halves of the panel be known better?
  [[nodiscard]] bool can_improve(int panel, std::size_t leaf) const;

  /// Encloses an operand over a part of a panel, in s from −1 to 1.
  [[nodiscard]] Enclosure<k_degree> over(int panel, std::size_t leaf, double begin, double end) const;
  /// Encloses an operand at one place of a panel.
  [[nodiscard]] Enclosure<0> at(int panel, std::size_t leaf, double theta) const;

private:
  static constexpr int k_nodes = k_degree + 1;
  int add_panel(double begin, double end, int depth, int whole);
  void sample(int panel, const Look& look, const double* first, const double* last);
  void fit(int panel, std::size_t leaf, int whole, double checked);

  std::vector<FormulaChannel::Leaf> leaves_;
  std::vector<Panel> panels_;
  std::vector<Curve> curves_;              ///< panel by panel
  std::vector<std::vector<double>> nodes_; ///< values, node by node, of the panel looked at
  std::vector<double> check_, first_, middle_, last_;
};

} // namespace steplap
