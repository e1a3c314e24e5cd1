// Finds the first event inside a step: where a watch value falls below zero.
//
// A step is passed only if every watch value is known to stay positive on the whole of it (docs/explanation/theory.md, "Events"):
//   far      its least value at the ends and stages is more than half its largest: it cannot have reached zero
//            in between unless it varies faster than stages resolve, which no step lets it (watch_nodes.h);
//   certain  the bound of watch_nodes.h keeps it positive between stages;
//   looked   else it is interpolated on dense output by a polynomial, the part of the step divided until the
//            polynomial, held against the value where it was not known before, is exact enough to tell (event_survey.cpp).
// A change of sign that is certain to be the only one is closed in on at once. The root is closed in on to rounding; all
// values that are negative on the far side of the bracket fire together. A step that takes more parts than there may be
// ends where it has been looked through, with nothing fired.
//
// A value that belongs to a unit or friction whose mode has just changed is *fresh*: it starts at zero
// up to rounding and is not believed negative until it has been positive.
#pragma once

#include "mbd/base/part_polynomial.h"
#include "mbd/base/root_estimate.h"
#include "mbd/integrators/integrator.h"

#include <array>
#include <limits>
#include <vector>

namespace steplap {

class EventFinder {
public:
  EventFinder(const System& system, int max_dimension);

  /// True if the step just made by `integrator` contains an event; then theta(), state() and fired()
  /// tell which: none, if it only has to end there. `fresh[slot]` as above.
  bool find(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh);

  /// find() has found nothing, for the step does not bear to be looked into: it has to be made again.
  [[nodiscard]] bool is_step_withdrawn() const { return is_step_withdrawn_; }

  [[nodiscard]] double theta() const { return theta_; }
  [[nodiscard]] const std::vector<double>& state() const { return y_; }
  [[nodiscard]] const std::vector<int>& fired() const { return fired_; }

private:
  enum class Suspicion { none, at_end, inside };
  enum class Bracket { none, found, at_once };
  struct Look {
    double theta = 0.0;
    std::vector<double> watch, rate; ///< rate: per unit of theta, NaN where it is not known
  };
  /// A part of the step, interpolated.
  struct Part {
    double begin = 0.0, end = 1.0;
    int slot = -1;      ///< whose polynomial was not exact enough in the part that this one is a piece of
    double error = 0.0; ///< of it there
    int stalled = 0;    ///< generations in which dividing has not made it more exact
  };
  /// Where a value may be below zero between places known to be positive.
  struct Unclear {
    double place = -1.0; ///< in the part, 0 … 1; −1: nowhere
    int slot = -1;
    double error = 0.0;
    int stalled = 0;
  };
  /// A value that ends and stages do not make certain, in the part of the step being looked through.
  struct Near {
    int slot = -1;
    int stalled = 0;
    std::size_t from = 0, to = 0; ///< places between which it has to be positive for the part to be passed
    bool has_fired = false;       ///< it falls below zero behind the last of these
    PartPolynomial polynomial;
  };

  [[nodiscard]] Suspicion suspicion(Integrator& integrator, const Dynamics& dynamics, const std::vector<char>& fresh);
  [[nodiscard]] bool is_merged(const Dynamics& dynamics, int slot);
  Bracket bracket_whole(const Integrator& integrator);
  // --- event_survey.cpp
  Bracket survey(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh);
  bool look_through(Integrator& integrator, Dynamics& dynamics, const Part& part);
  void begin_parts(Integrator& integrator, Dynamics& dynamics, bool is_any_unarmed);
  void arm_positive(double theta, const std::vector<double>& watch);
  std::size_t look_at_places(Integrator& integrator, Dynamics& dynamics, const Part& part);
  void fit_near(const Part& part, std::size_t last);
  [[nodiscard]] double tangents_meet_below(int slot, std::size_t last) const;
  [[nodiscard]] int doubtful_gap(const Near& near) const;
  [[nodiscard]] Unclear unclear_at(const Near& near, double place) const;
  [[nodiscard]] Unclear unclear_place(std::size_t last) const;
  [[nodiscard]] double place_to_check() const;
  [[nodiscard]] Unclear belied_place(Integrator& integrator, Dynamics& dynamics, const Part& part, std::size_t last);
  // --- event_closing.cpp
  void close_in(Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] double next_look(double middle);
  [[nodiscard]] double first_secant() const;
  [[nodiscard]] bool is_root_just_before(const Look& beyond, double reach) const;

  void watch_at(Integrator& integrator, Dynamics& dynamics, double theta, Look& look);
  static void look_at_end(const Integrator& integrator, bool is_last, Look& look);
  /// From zero or above to below.
  [[nodiscard]] bool crosses(const Look& low, const Look& high);
  /// The same for what velocities are known to: from the slack below zero or above to below that, or below zero at the
  /// step's end. What crosses zero within the slack is neither lost nor found twice.
  [[nodiscard]] bool falls(const Look& low, const Look& high);
  [[nodiscard]] Bracket bracket_of_fall();
  [[nodiscard]] bool is_any_merged_near(const Integrator& integrator, const Dynamics& dynamics) const;
  void set_slack(const Integrator& integrator, const Dynamics& dynamics);

  const System& system_;
  int slots_;
  double theta_ = 0.0;
  bool is_step_withdrawn_ = false;
  std::vector<double> y_, dy_;
  Look low_, high_, middle_; ///< the bracket's ends, and a place between them
  static constexpr std::size_t k_most_known = 7;
  std::array<Look, k_most_known> known_; ///< the last ones, from which the next place is estimated
  std::size_t known_count_ = 0;
  RootEstimate estimate_;
  /// Of the root being closed in on, in parts of the step.
  struct Aim {
    double reach = 0.0;      ///< to either side of the root, where the bracket is to end
    double root = 0.0;       ///< as last estimated
    double distance = 1.0;   ///< of the last two estimates
    double expected = 1.0;   ///< error of the last one
    int looks = 0;           ///< estimates so far
    bool is_settled = false; ///< the root is as exact as it can be
  };
  Aim aim_;
  static constexpr std::size_t k_places = PartPolynomial::k_order + 1;
  std::array<Look, k_places> place_; ///< of the part of the step being looked through
  /// Per slot: a dip that is not deeper and comes up again within the step is none. Of rates of slip and of what ForceGroup's
  /// watch_kind() says, that to which velocities or places are known; 0 of all else.
  std::vector<double> slack_;
  std::vector<int> place_slots_, rate_slots_; ///< of units
  std::vector<char> is_of_joint_;             ///< per slot: of friction over an area
  std::vector<int> near_;                     ///< slots that ends and stages do not make certain
  std::vector<char> merged_;                  ///< slots of joints that are merged, once somebody has asked in this step
  bool are_merged_known_ = false;
  std::vector<Near> curves_;               ///< of those among near_ that are looked at in the part
  std::vector<Part> parts_;                ///< still to be looked through, the first one last
  bool is_merged_near_ = false;            ///< some joint that is merged may give way in the step
  std::vector<char> armed_, armed_before_; ///< believed when negative
  std::vector<int> fired_, fired_before_;
};

} // namespace steplap
