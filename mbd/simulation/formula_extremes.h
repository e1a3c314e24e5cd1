// Extremes of channels that are formulas of others (mbd/formula/). A formula may have kinks anywhere and peaks as narrow as one
// likes, of which neither values nor slopes beside them show anything; so it is not sampled but bounded. Its operands are
// curves that steps resolve: polynomials with an error (operand_curves.h). Of these the formula's tree makes an enclosure over
// any span of time (mbd/formula/enclosure.h), and the span whose bound lies furthest out is halved, until no bound is beyond
// what was reached by more than is asked for (R. E. Moore, Interval Analysis, 1966; E. Hansen, Numer. Math. 34 (1980) 247).
// What was reached is a value of the motion itself, looked at where the enclosure is certain.
//
// Work is bounded: in spans, in looks, and of both in the whole run. What cannot be closed within it (a pole, a tie of
// infinitely many peaks, an operand with a kink of its own) is kept as a bound: the extreme lies between it and the value found.
#pragma once

#include "mbd/simulation/operand_curves.h"

#include <functional>
#include <limits>
#include <vector>

namespace steplap {

struct ChannelRange;

/// What the search needs of the run, whose stretch it looks into.
class ExtremeSite {
public:
  virtual ~ExtremeSite() = default;
  /// Where the channel's extremes are kept.
  [[nodiscard]] virtual ChannelRange& range(std::size_t channel) = 0;
  /// What an extreme of the channel has to be known to.
  [[nodiscard]] virtual double tolerance(std::size_t channel) const = 0;
  /// The motion at theta of the stretch.
  [[nodiscard]] virtual Snapshot look(double theta) = 0;
  /// Notes a value of the channel met at theta.
  virtual void note(std::size_t channel, double value, double theta) = 0;
};

/// Bounds channels that are formulas, stretch by stretch.
class FormulaExtremes {
public:
  /// `rate_of`: per channel the one that is its rate, −1 if there is none.
  FormulaExtremes(const System& system, const std::vector<int>& rate_of);

  /// Is no channel a formula?
  [[nodiscard]] bool is_empty() const { return formulas_.empty(); }
  /// Is this channel a formula?
  [[nodiscard]] bool is_formula(std::size_t channel) const { return is_formula_[channel] != 0; }

  /// At the beginning of a stretch: a state from which the motion goes on anew.
  void begin(const Snapshot& snapshot);
  /// At its end.
  void arrive(const Snapshot& snapshot);
  /// Looks for extremes in the stretch from t, h long, between begin() or the last end, and arrive().
  void search(double t, double h, ExtremeSite& site);
  /// The same where there is nothing between the ends but the straight line, as between the ends of steps of time stepping.
  void search_straight(double t, double h, ExtremeSite& site);
  /// The next stretch begins where this one ended.
  void pass(double h);
  /// By how much the least and the largest value of a channel may lie beyond those found; 0 of what is no formula.
  [[nodiscard]] double unclosed(std::size_t channel, const ChannelRange& found) const;

private:
  struct Sought {
    std::size_t channel = 0;
    const FormulaChannel* formula = nullptr;
    std::vector<std::size_t> leaves; ///< of the formula's operands
    bool is_number = false;          ///< it has no unit
    /// Beyond what was found it may go as far as this, where bounds could not be closed.
    double low_bound = std::numeric_limits<double>::infinity(), high_bound = -std::numeric_limits<double>::infinity();
  };
  struct Span {
    double bound = 0.0;  ///< of the value times the sign
    double likely = 0.0; ///< where the largest value may be, from −1 at its begin to 1
    int panel = 0, depth = 0;
    double begin = 0.0, end = 0.0;
  };
  using Whole = Enclosure<OperandCurves::k_degree>;

  void read(const Snapshot& snapshot, std::vector<double>& values, std::vector<double>& rates);
  void bend(double h);
  void reach(double h, std::vector<double>& error) const;
  [[nodiscard]] bool is_worth_looking(const Sought& sought, ExtremeSite& site);
  void look_for(Sought& sought, ExtremeSite& site);
  void seek(Sought& sought, double sign, ExtremeSite& site);
  void push(const Sought& sought, double sign, Span span);
  [[nodiscard]] Span pop();
  void push_parts(const Sought& sought, double sign, const Span& span);
  [[nodiscard]] static double gained(const Sought& sought, double promised, double record);
  [[nodiscard]] bool improve(const Sought& sought, int panel, ExtremeSite& site);
  static void keep_bound(Sought& sought, double sign, double bound);
  void check(Sought& sought, double sign, double theta, double promised, ExtremeSite& site);
  void seek_missing(const Sought& sought, ExtremeSite& site);
  void seek_first(const Sought& sought, ExtremeSite& site);
  [[nodiscard]] double real_value(const Sought& sought, double theta, ExtremeSite& site);
  [[nodiscard]] const Whole& enclose(const Sought& sought, const Span& span);
  [[nodiscard]] const Enclosure<0>& enclose_at(const Sought& sought, int panel, double theta);
  [[nodiscard]] bool is_shortest(const Span& span) const;
  [[nodiscard]] double top_about(const Sought& sought, double sign, double theta, double width);
  [[nodiscard]] int panel_at(double theta) const;
  [[nodiscard]] long spans_left() const;

  std::vector<Sought> formulas_;
  std::vector<char> is_formula_;
  OperandCurves curves_;
  std::vector<std::function<double(const Snapshot&)>> rate_; ///< per operand; null: not known
  std::vector<double> rate_factor_;

  double t_ = 0.0, h_ = 0.0, h_last_ = 0.0;
  bool is_straight_ = false, has_looked_ = false;
  std::vector<double> first_, last_, before_, first_rate_, last_rate_, curvature_, error_;
  std::vector<Span> spans_; ///< a heap
  std::vector<Whole> leaf_, node_;
  std::vector<Enclosure<0>> leaf_at_, node_at_;
  long run_spans_ = 0; ///< looked at so far
  int run_panels_ = 0;
};

} // namespace steplap
