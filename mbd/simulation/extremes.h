// Minimum and maximum of every channel over a whole run, independent of the output.
//
// A run is divided into stretches in which everything is smooth. A stretch is one accepted step (for fixed steps several, as long as the
// curves are well resolved), up to an event or breakpoint, both sides of which are evaluated. All channels are evaluated at the ends of a
// stretch. If the second difference over three ends (for coordinates and velocities of bodies also the slopes at both ends) indicates a
// possible extreme inside, the channel is evaluated on the dense output: in the middle, then at 5 and 9 Chebyshev–Lobatto points, until the
// interpolating polynomial predicts the next points to `k_resolution` of the channel's range. The extreme is that of the polynomial. If
// this fails (a kink), golden sections around the outermost point follow, for each channel separately. If there are many such channels,
// those that contain only rounding noise are first identified together and excluded.
//
// Channels that are formulas of others can have kinks and peaks anywhere; they are bounded instead (formula_extremes.h).
//
// When a slip velocity is below the accuracy of rates, its direction is unknown, and so are its wrench and all values that depend on the
// wrench. Values at such times are included, and the amount by which they exceed all other values is reported (ChannelRange::unsure_low).
//
// The evaluated points depend on the steps only, not on the samples written. Limits: a peak that rises and falls within one step without a
// trace at its ends or in the curve before is not found; the integrator's error control does not detect it either. For methods that
// determine contact modes themselves (moreau, storms) only the ends of steps are used, and for formulas the straight lines between them.
#pragma once

#include "mbd/integrators/integrator.h"
#include "mbd/simulation/channel_range.h"
#include "mbd/simulation/face_travel.h"
#include "mbd/simulation/formula_extremes.h"

#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace steplap {

/// Computes the ranges of all channels during one run. Used by Simulation.
class ExtremeFinder {
public:
  /// `max_dimension`: upper limit of the dimension of the packed state. Keeps a reference to the system.
  ExtremeFinder(const System& system, int max_dimension);

  /// Restarts at a state: the start of the run, or after an event. `snapshot`: evaluation at this state.
  void begin(double t, const Snapshot& snapshot);
  /// As begin() above, for a method that locates events. Precondition: the last evaluation of `dynamics` was at this state.
  void begin(double t, const Snapshot& snapshot, const Integrator& integrator, Dynamics& dynamics);
  /// To be called after each step. `is_at_end`: the last evaluation of `dynamics` was at the end of the step. `is_last`: the step ends the
  /// stretch.
  void add_step(Integrator& integrator, Dynamics& dynamics, bool is_at_end, bool is_last);
  /// Ends the stretch at time t, s, within the last step.
  void end_at(double t, Integrator& integrator, Dynamics& dynamics);
  /// To be called at the end of the run.
  void finish(const Snapshot& snapshot);
  /// Computes ChannelRange::final_rate from the state `before` seconds earlier on the same motion. Precondition: finish().
  void finish_rates(const Snapshot& snapshot, double before);
  /// Returns the values of all channels of the system.
  [[nodiscard]] std::vector<double> values(const Snapshot& snapshot) const;
  /// Computes ChannelRange::final_bend from the values `before` seconds earlier and the state 2 `before` seconds earlier. Precondition:
  /// finish().
  void finish_bends(const std::vector<double>& middle, const Snapshot& snapshot, double before);

  /// Returns the ranges in the order of the system's channels; complete after finish().
  [[nodiscard]] const std::vector<ChannelRange>& ranges() const { return ranges_; }
  /// As ranges(), which is empty from then on.
  [[nodiscard]] std::vector<ChannelRange> take_ranges() { return std::exchange(ranges_, {}); }

  /// Returns by how much contacts pressed beyond the ends of their parts (face_travel.h).
  [[nodiscard]] std::vector<FaceTravel> face_travels() const { return faces_.travels(); }

  static constexpr double k_resolution = 1e-6; ///< accuracy of extremes, relative to the range of the channel
  static constexpr double k_at_pole = 1e9;     ///< a channel without unit beyond this value counts as a pole

private:
  static constexpr int k_nodes = 9;       ///< largest number of nodes inside a stretch
  static constexpr int k_longest = 16;    ///< largest number of fixed steps in a stretch
  static constexpr double k_noise = 1e-9; ///< accuracy of extremes, relative to the largest range of channels with the same unit
  class Site;
  /// States with a smaller pivot of the constraints, the square of a distance in rad², count as singular: nearer than 0.01 mrad.
  static constexpr double k_singular_pivot = 1e-10;
  /// Progress of the search for one channel in the present stretch.
  struct ChannelSearchState {
    bool is_open = false; ///< the search for an extreme is not finished
    double error = 0.0;   ///< error of the polynomial through the nodes, in the unit of the channel
    double earlier_error = std::numeric_limits<double>::infinity(); ///< error with half as many nodes
  };
  struct Kind {                        ///< data common to channels with the same unit
    const std::string* unit = nullptr; ///< never nullptr
    double range = 0.0, largest = 0.0;
    double scale = 0.0; ///< expected magnitude, used while everything is at rest
  };

  struct Top { ///< maximum of the polynomial through the nodes of a channel
    std::size_t channel = 0;
    double theta = 0.0, value = 0.0;
  };
  struct KnownDirectionRange { ///< range of values at times when the direction of every slip was known
    double low = std::numeric_limits<double>::quiet_NaN(), high = low;
  };

  void set_scales();
  void check_slip_directions(const Integrator& integrator, Dynamics& dynamics, bool is_new);
  void record_known_direction(std::size_t c, double value);
  void note(std::size_t c, double value, double t);
  void evaluate(double t, const Snapshot& snapshot, double* values, bool is_everything);
  void take(std::size_t c, double t, const Snapshot& snapshot, double* values);
  void take(std::size_t c, double t, double value);
  void pass_between(double t, const Snapshot& snapshot);
  Snapshot evaluate_dense(double theta, Integrator& integrator, Dynamics& dynamics);
  void state_at(double t, Integrator& integrator, Dynamics& dynamics);
  void close(double t, Integrator& integrator, Dynamics& dynamics);
  void screen(const Snapshot& snapshot);
  [[nodiscard]] bool suspect(double h);
  [[nodiscard]] bool turns_inside(std::size_t c, double h) const;
  void search(Integrator& integrator, Dynamics& dynamics);
  void refine(int level, Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] bool settle(std::size_t c, int level);
  void check_tops(int level, Integrator& integrator, Dynamics& dynamics);
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
  [[nodiscard]] ChannelRange& range(std::size_t c) { return ranges_[searched_[c]]; }
  [[nodiscard]] const ChannelRange& range(std::size_t c) const { return ranges_[searched_[c]]; }
  [[nodiscard]] double at(std::size_t c, int node) const { return node_[node][c]; }
  [[nodiscard]] bool is_ruled_out(std::size_t c) const { return screened_slot_[c] >= 0 && !is_wanted_[screened_slot_[c]]; }

  static constexpr int k_no_rate = -1, k_rate_not_searched = -2;

  const System& system_;
  std::vector<ChannelRange> ranges_;  ///< of all channels of the system
  std::vector<std::size_t> searched_; ///< indices in the system of the channels that have extremes
  // From here on "per channel" means per channel of searched_, and an index of a channel is one in searched_.
  std::size_t count_; ///< size of searched_
  std::vector<Kind> kinds_;
  std::vector<int> kind_;          ///< per channel: index in kinds_
  std::vector<int> screened_slot_; ///< per channel: index in bounds_ if it has cheap bounds, otherwise −1
  std::vector<int> rate_of_;       ///< per channel: index of the channel that is its rate, k_no_rate or k_rate_not_searched
  std::vector<std::size_t> dimensionless_;

  double t_ = 0.0, t_last_ = 0.0, h_last_ = 0.0; ///< start of the stretch; start and length of the previous one, s; length 0: none
  double t1_ = 0.0;                              ///< end of the stretch, s
  std::vector<double> before_;                   ///< per channel: value at the start of the previous stretch
  std::vector<std::vector<double>> node_;        ///< per node, per channel: value; nodes 0 and 8 are the ends
  std::vector<ChannelSearchState> curve_;
  std::vector<double> curvature_; ///< per channel: recent second derivative, per s²
  std::vector<std::size_t> open_; ///< channels still searched in this stretch
  std::vector<Top> unchecked_;    ///< maxima whose error may exceed the tolerance
  std::vector<double> jitter_;    ///< per channel: amplitude of rounding noise; empty until first needed
  std::vector<ValueBounds> bounds_, bounds_before_;
  std::vector<char> is_wanted_; ///< per channel with bounds: the channel may exceed its extremes at the last end

  int steps_ = 0, longest_ = 1;                  ///< number of steps in the stretch, and the largest number allowed
  std::vector<double> step_t_, step_y_, step_k_; ///< time, state and rates at the starts of these steps
  std::size_t stride_;
  std::vector<double> y_, dy_, scratch_;
  bool is_begun_ = false;
  double slip_ = std::numeric_limits<double>::infinity(); ///< speed of the slowest slip whose direction may change, at the last end, m/s
  bool is_unsure_ = false;                                ///< slip_ is below the accuracy of velocities
  std::vector<KnownDirectionRange> known_direction_;      ///< per channel; empty until the first slip of unknown direction
  bool is_singular_ = false;                              ///< the last evaluated state is near a singular position of joints
  FaceWatch faces_;
  std::unique_ptr<FormulaExtremes> formulas_; ///< search for extremes of formulas
};

} // namespace steplap
