// Extremes of channels that are formulas of others (mbd/formula/).
//
// A formula can have kinks anywhere and arbitrarily narrow peaks that no samples show; it is therefore bounded. Its operands are
// polynomials with an error bound over each stretch (operand_curves.h). The formula's tree gives an enclosure over any time interval
// (mbd/formula/enclosure.h). The interval with the largest upper bound is bisected until no bound exceeds the best value found by more than
// the tolerance (R. E. Moore, Interval Analysis, 1966; E. Hansen, Numer. Math. 34 (1980) 247). Values are evaluated on the motion itself.
//
// The work is limited: numbers of intervals and evaluations, per stretch and per run. If the search cannot be completed within these limits
// (a pole, a tie of infinitely many peaks, an operand with a kink), the remaining bound is kept: the extreme lies between it and the value
// found.
#pragma once

#include "mbd/simulation/operand_curves.h"

#include <functional>
#include <limits>
#include <vector>

namespace steplap {

struct ChannelRange;

/// Access of a search to the stretch of the run in which it works.
class ExtremeSite {
public:
  virtual ~ExtremeSite() = default;
  /// Returns the range in which the channel's extremes are stored.
  [[nodiscard]] virtual ChannelRange& range(std::size_t channel) = 0;
  /// Returns the required accuracy of an extreme, in the unit of the channel.
  [[nodiscard]] virtual double tolerance(std::size_t channel) const = 0;
  /// Returns the motion at theta of the stretch, 0 … 1.
  [[nodiscard]] virtual Snapshot evaluate_dense(double theta) = 0;
  /// Stores a value of the channel found at theta.
  virtual void note(std::size_t channel, double value, double theta) = 0;
};

/// Computes extremes of all channels that are formulas, stretch by stretch.
class FormulaExtremes {
public:
  /// `searched`: indices of the channels that have extremes; all functions identify a channel by its place in this list. `rate_of`: per
  /// channel of the system the index of the channel that is its rate; −1: none.
  FormulaExtremes(const System& system, const std::vector<std::size_t>& searched, const std::vector<int>& rate_of);

  /// Returns true if no channel is a formula.
  [[nodiscard]] bool is_empty() const { return formulas_.empty(); }
  /// Returns true if the channel is a formula.
  [[nodiscard]] bool is_formula(std::size_t channel) const { return is_formula_[channel] != 0; }

  /// To be called at the first state of a stretch, after a jump of the motion.
  void begin(const Snapshot& snapshot);
  /// To be called at the end of a stretch, before search().
  void arrive(const Snapshot& snapshot);
  /// Searches the stretch of length h, s, from t, s. Precondition: begin() or pass() at its start, arrive() at its end.
  void search(double t, double h, ExtremeSite& site);
  /// As search(), with linear interpolation between the ends, as between the ends of time steps.
  void search_linear_step(double t, double h, ExtremeSite& site);
  /// Makes the end of this stretch, of length h in s, the start of the next one.
  void pass(double h);
  /// Returns the largest amount by which minimum and maximum of a channel may exceed those in `found`; 0 for channels that are not
  /// formulas.
  [[nodiscard]] double unclosed(std::size_t channel, const ChannelRange& found) const;

private:
  struct FormulaTarget {
    std::size_t channel = 0;
    const FormulaChannel* formula = nullptr;
    std::vector<std::size_t> leaves; ///< indices of the formula's operands
    bool is_number = false;          ///< the channel has no unit
    /// Bounds of the extremes where the search was not completed.
    double low_bound = std::numeric_limits<double>::infinity(), high_bound = -std::numeric_limits<double>::infinity();
  };
  struct Span {
    double bound = 0.0;  ///< upper bound of sign · value in the interval
    double likely = 0.0; ///< expected position of the maximum, from −1 (start) to 1 (end)
    int panel = 0, depth = 0;
    double begin = 0.0, end = 0.0;
  };
  using Whole = Enclosure<OperandCurves::k_degree>;

  void read(const Snapshot& snapshot, std::vector<double>& values, std::vector<double>& rates);
  void bend(double h);
  void reach(double h, std::vector<double>& error) const;
  [[nodiscard]] bool may_improve_extremes(const FormulaTarget& sought, ExtremeSite& site);
  void search_extremes(FormulaTarget& sought, ExtremeSite& site);
  void seek(FormulaTarget& sought, double sign, ExtremeSite& site);
  void push(const FormulaTarget& sought, double sign, Span span);
  [[nodiscard]] Span pop();
  void push_parts(const FormulaTarget& sought, double sign, const Span& span);
  [[nodiscard]] static double gained(const FormulaTarget& sought, double promised, double record);
  [[nodiscard]] bool improve(const FormulaTarget& sought, int panel, ExtremeSite& site);
  static void keep_bound(FormulaTarget& sought, double sign, double bound);
  void check(FormulaTarget& sought, double sign, double theta, double promised, ExtremeSite& site);
  void seek_missing(const FormulaTarget& sought, ExtremeSite& site);
  void seek_first(const FormulaTarget& sought, ExtremeSite& site);
  [[nodiscard]] double real_value(const FormulaTarget& sought, double theta, ExtremeSite& site);
  [[nodiscard]] const Whole& enclose(const FormulaTarget& sought, const Span& span);
  [[nodiscard]] const Enclosure<0>& enclose_at(const FormulaTarget& sought, int panel, double theta);
  [[nodiscard]] bool is_shortest(const Span& span) const;
  [[nodiscard]] double top_about(const FormulaTarget& sought, double sign, double theta, double width);
  [[nodiscard]] int panel_at(double theta) const;
  [[nodiscard]] long spans_left() const;

  std::vector<FormulaTarget> formulas_;
  std::vector<char> is_formula_;
  OperandCurves curves_;
  std::vector<std::function<double(const Snapshot&)>> rate_; ///< per operand: function for its rate; null: unknown
  std::vector<double> rate_factor_;

  double t_ = 0.0, h_ = 0.0, h_last_ = 0.0;
  bool is_straight_ = false, has_evaluated_ = false;
  std::vector<double> first_, last_, before_, first_rate_, last_rate_, curvature_, error_;
  std::vector<Span> spans_; ///< heap of intervals, the largest bound on top
  std::vector<Whole> leaf_, node_;
  std::vector<Enclosure<0>> leaf_at_, node_at_;
  long run_spans_ = 0; ///< number of intervals evaluated in the run so far
  int run_panels_ = 0;
};

} // namespace steplap
