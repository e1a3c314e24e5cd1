// The least and the largest value of every channel over a whole run, whatever is written and how often.
//
// A run is cut into *stretches* in which everything is smooth: one accepted step (several of a fixed-step
// method, as long as the curves are well resolved), up to an event or a breakpoint, whose two sides are both
// looked at. All channels are evaluated at the stretch's ends. Where a channel may have passed its extreme so
// far inside the stretch, which its second difference over three ends tells, all are evaluated on the dense
// output as well (of a body's coordinates and velocities also the slopes at both ends tell): at the middle, then at the 5 and the 9 points of Chebyshev and Lobatto, until the
// polynomial through them tells the next ones within `k_resolution` of the channel's range. The extreme is
// the polynomial's. Where none is found (a kink) the search goes on by sections around the outermost point, for each channel by
// itself; of many channels those that are rounding are told first, all together, and left as they are.
//
// Channels that are formulas of others are bounded instead (formula_extremes.h): kinks and peaks of theirs may be anywhere.
//
// Where a slip that ends is slower than rates are known to, nobody knows which way it goes, nor its wrench and what hangs on that. What is
// met there counts, and by how much it goes beyond all that was met elsewhere is told (ChannelRange::unsure_low).
//
// What is looked at depends on the steps alone: not on the samples written. Limits: a peak that rises and
// falls within one step of which neither the ends nor the curve before show anything is not seen, nor is it
// by the integrator's own error control; of methods that decide contact modes themselves (moreau, storms) the
// ends of steps are all there is, and of formulas what the straight lines between them make of them.
#pragma once

#include "mbd/integrators/integrator.h"
#include "mbd/simulation/formula_extremes.h"

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace steplap {

/// One end of a channel's range.
struct Extreme {
  double value = std::numeric_limits<double>::quiet_NaN(); ///< in the channel's unit; not-a-number: none
  double t = 0.0;                                          ///< s, when it was reached
};

/// What a run tells of one channel.
struct ChannelRange {
  const Channel* channel = nullptr; ///< of the system, which has to outlive it
  Extreme low, high;                ///< not-a-number where the channel had no value, or has no extremes (Channel::has_extremes)
  double first = 0.0;               ///< at the start
  double final = 0.0;               ///< at the end
  double final_rate = std::numeric_limits<double>::quiet_NaN(); ///< per s, at the end; not-a-number: unknown
  /// Extremes are located to within this; smaller ones were not looked for. Infinite: they may be anywhere beyond.
  double resolution = 0.0;
  /// By how much they go beyond what was met where each slip was known to go its way; not-a-number: nothing was.
  double unsure_low = 0.0, unsure_high = 0.0;
  bool had_no_value = false;                              ///< it was not-a-number at some time
  bool is_low_singular = false, is_high_singular = false; ///< met beside a singular position of the joints, where reactions may diverge
  std::optional<double> first_above_one;                  ///< s; of channels without a unit: the first time they passed 1

  /// Whichever is further from zero.
  [[nodiscard]] const Extreme& largest() const;
};

/// Follows all channels through one run. Made, fed and asked by Simulation.
class ExtremeFinder {
public:
  /// `max_dimension`: of the packed state. Refers to the system.
  ExtremeFinder(const System& system, int max_dimension);

  /// A state from which the motion goes on anew: the start, the far side of an event. `snapshot` is there.
  void begin(double t, const Snapshot& snapshot);
  /// The same of a method that finds events; `dynamics` was last evaluated there.
  void begin(double t, const Snapshot& snapshot, const Integrator& integrator, Dynamics& dynamics);
  /// After a step. `is_at_end`: `dynamics` was last evaluated at the step's end. `is_last`: of its stretch.
  void add_step(Integrator& integrator, Dynamics& dynamics, bool is_at_end, bool is_last);
  /// The stretch ends at t, inside the step made.
  void end_at(double t, Integrator& integrator, Dynamics& dynamics);
  /// The end of the run.
  void finish(const Snapshot& snapshot);
  /// Behind finish(): the same motion `before` seconds earlier, from which the rates at the end follow.
  void finish_rates(const Snapshot& snapshot, double before);

  /// Of every channel, in the system's order; complete after finish().
  [[nodiscard]] const std::vector<ChannelRange>& ranges() const { return ranges_; }

  static constexpr double k_resolution = 1e-6; ///< of a channel's range
  static constexpr double k_at_pole = 1e9;     ///< numbers without a unit beyond it

private:
  static constexpr int k_nodes = 9;           ///< at most, inside a stretch
  static constexpr int k_longest = 16;        ///< steps of a fixed size in a stretch
  static constexpr double k_noise = 1e-9;     ///< of the largest range of channels in the same unit
  static constexpr double k_rounding = 1e-12; ///< of the largest value in the same unit
  class Site;
  /// Pivots of the constraints, squares of distances in rad²: nearer than a hundredth of a milliradian nothing but a singular
  /// position is met.
  static constexpr double k_singular_pivot = 1e-10;
  /// What is known of a channel's curve in the stretch being looked at.
  struct Curve {
    bool is_open = false; ///< it may still have an extreme that is not found
    double error = 0.0;   ///< of the polynomial through the nodes
  };
  struct Kind { ///< of channels in the same unit
    double range = 0.0, largest = 0.0;
    double scale = 0.0; ///< size of what moves, where nothing moves yet
  };

  struct Top { ///< of the polynomial through a channel's nodes
    std::size_t channel = 0;
    double theta = 0.0, value = 0.0;
  };
  struct Sure { ///< met where each slip was known to go its way
    double low = std::numeric_limits<double>::quiet_NaN(), high = low;
  };

  void set_scales();
  void look_at_slips(const Integrator& integrator, Dynamics& dynamics, bool is_new);
  void note_sure(std::size_t c, double value);
  void note(std::size_t c, double value, double t);
  void evaluate(double t, const Snapshot& snapshot, double* values, bool is_everything);
  void take(std::size_t c, double t, const Snapshot& snapshot, double* values);
  void take(std::size_t c, double t, double value);
  void pass_between(double t, const Snapshot& snapshot);
  Snapshot look(double theta, Integrator& integrator, Dynamics& dynamics);
  void state_at(double t, Integrator& integrator, Dynamics& dynamics);
  void close(double t, Integrator& integrator, Dynamics& dynamics);
  void screen(const Snapshot& snapshot);
  [[nodiscard]] bool suspect(double h);
  [[nodiscard]] bool turns_inside(std::size_t c, double h) const;
  void search(Integrator& integrator, Dynamics& dynamics);
  void refine(int level, Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] bool settle(std::size_t c, int level);
  void check_tops(Integrator& integrator, Dynamics& dynamics);
  void drop_jittery(Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] bool is_jitter(std::size_t c, double change);
  [[nodiscard]] double spread_about(std::size_t c, int middle) const;
  void section(std::size_t c, Integrator& integrator, Dynamics& dynamics);
  void find_crossings(Integrator& integrator, Dynamics& dynamics);
  void keep_step(const Integrator& integrator, const Dynamics& dynamics);
  void arrive(double t, const Snapshot& snapshot, Integrator& integrator, Dynamics& dynamics);
  void end_stretch(double t, const double* dy, Integrator& integrator, Dynamics& dynamics);
  void adapt_length();
  [[nodiscard]] double tolerance(std::size_t c) const;
  [[nodiscard]] double at(std::size_t c, int node) const { return node_[node][c]; }
  [[nodiscard]] bool is_ruled_out(std::size_t c) const { return screened_slot_[c] >= 0 && !is_wanted_[screened_slot_[c]]; }

  const System& system_;
  std::size_t count_; ///< of channels
  std::vector<ChannelRange> ranges_;
  std::vector<Kind> kinds_;
  std::vector<int> kind_;            ///< per channel
  std::vector<int> screened_slot_;   ///< per channel with bounds: place in bounds_, else −1
  std::vector<int> rate_of_;         ///< per channel: the channel that is its rate, −1 if there is none
  std::vector<std::size_t> tracked_; ///< channels that have extremes
  std::vector<std::size_t> dimensionless_;

  double t_ = 0.0, t_last_ = 0.0, h_last_ = 0.0; ///< the stretch begins at t_; length of the one before, 0: none
  double t1_ = 0.0;                              ///< its end
  std::vector<double> before_;                   ///< values at the beginning of the stretch before
  std::vector<std::vector<double>> node_;        ///< values at the nodes, 0 and 8 are the ends
  std::vector<Curve> curve_;
  std::vector<double> curvature_; ///< second derivative as seen lately, per s²
  std::vector<std::size_t> open_; ///< channels still followed in this stretch
  std::vector<Top> unchecked_;    ///< whose polynomial may be off by more than the tolerance
  std::vector<double> jitter_;    ///< per channel: what rounding was seen to change it by; empty as long as nobody had to ask
  std::vector<ValueBounds> bounds_, bounds_before_;
  std::vector<char> is_wanted_; ///< per screened channel: it may be beyond its extremes at the last end

  int steps_ = 0, longest_ = 1;                  ///< steps in the stretch, and how many there may be
  std::vector<double> step_t_, step_y_, step_k_; ///< their beginnings
  std::size_t stride_;
  std::vector<double> y_, dy_, scratch_;
  bool is_begun_ = false;
  double slip_ = std::numeric_limits<double>::infinity(); ///< speed of the slowest slip that may turn at the last end, m/s
  bool is_unsure_ = false;                                ///< that is less than it is known to
  std::vector<Sure> sure_;                                ///< per channel; empty as long as that is all
  bool is_singular_ = false;                              ///< what was looked at last lies beside a singular position of the joints
  std::unique_ptr<FormulaExtremes> formulas_;             ///< of channels that are formulas
};

} // namespace steplap
