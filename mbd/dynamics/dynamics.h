// Equations of motion of a compiled system in its present modes.
//
//   M a = Q(q, v, t) + Jᵀλ,  J a = γ            (27), (29)–(31) with the corrections of physics.md §1
// in the coordinates of a layout: x, y and θ of clusters, or joint coordinates of small islands (mechanism.h). The
// packed vector y holds the coordinates, their rates, the inner states of force elements, and two integrals of power: energy
// dissipated and work done by loads and drives.
//
// Three parts make it up, which know nothing of each other but what is handed on: where everything is (kinematics.h),
// the rows that hold (constraint_solution.h), and what follows from accelerations (reactions.h). What a set of modes
// fixes is in the layout, what an evaluation changes in the parts, what it finds in the functions below
// "by-products". One object per thread: it owns all scratch memory; rates() and project() allocate nothing.
#pragma once

#include "mbd/dynamics/constraint_solution.h"
#include "mbd/dynamics/layout_store.h"
#include "mbd/dynamics/reactions.h"
#include "mbd/dynamics/stage_program.h"
#include "mbd/system/evaluation_arrays.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

namespace steplap {

/// A constraint that projection cannot meet.
struct ConstraintFailure : NumericalFailure {
  ConstraintFailure(const std::string& message, int element_, double residual_, bool is_angle_)
      : NumericalFailure(message), element(element_), residual(residual_), is_angle(is_angle_) {}
  int element;     ///< the one that is off most
  double residual; ///< m, or rad
  bool is_angle;
};

/// What is asked of an evaluation beside the rates.
enum class Request : unsigned char {
  rates,            ///< all by-products. Near a singular position the rates are those of the nearest state on the constraints
  rates_as_given,   ///< all by-products, with the rates at y itself: the function of y and t that Linearization differentiates
  stage,            ///< of a stage inside a step: watch() and the count of evaluations. Other by-products may be those of the
                    ///< evaluation before, and factors are forgotten. Near a singular position (k_traced_pivot) it is `rates`
  stage_near_limit, ///< as `stage`, and the watch values of merged joints and of groups that share a load, where some are near their limit
  stage_and_joints, ///< as `stage`, and those watch values in any case
  end,              ///< of a step's end: rates, watch() and watch_merged(). Other by-products are found when somebody asks for them
};

/// The evaluation made last, if it was made by code: then its by-products are still to be found, and this is what is known of it.
/// While it is pending, nothing else of Dynamics may be asked for by-products before they are found.
class PendingEvaluation {
public:
  void reserve(std::size_t dimension) {
    if (y_.size() < dimension) y_.resize(dimension);
    if (dy_.size() < dimension) dy_.resize(dimension);
  }
  void begin(double t, const double* y, int dimension, double smallest_pivot) {
    is_pending_ = true;
    t_ = t;
    smallest_pivot_ = smallest_pivot;
    std::copy_n(y, dimension, y_.begin());
  }
  void end() { is_pending_ = false; }
  [[nodiscard]] bool is_pending() const { return is_pending_; }
  [[nodiscard]] double t() const { return t_; }                           ///< s
  [[nodiscard]] double smallest_pivot() const { return smallest_pivot_; } ///< as Layout::smallest_pivot
  [[nodiscard]] const double* y() const { return y_.data(); }
  [[nodiscard]] double* dy() { return dy_.data(); } ///< where its rates go once more

private:
  bool is_pending_ = false;
  double t_ = 0.0, smallest_pivot_ = 1.0;
  std::vector<double> y_, dy_;
};

class Dynamics {
public:
  explicit Dynamics(const System& system);
  Dynamics(const Dynamics&) = delete; // what it evaluates points into it
  Dynamics& operator=(const Dynamics&) = delete;

  /// What describes islands for which there is a choice; counts from the next set_state() on. Absolute unless asked.
  void use_coordinates(Coordinates coordinates) { choice_ = coordinates; }
  [[nodiscard]] Coordinates coordinates() const { return choice_; }
  void use_stage_code(StageCode choice) {
    layouts_.clear_programs();
    stage_programs_.choose(choice);
  }
  /// Layouts kept at a time; results do not hang on it.
  void keep_layouts(std::size_t count) { layouts_.keep_at_most(count); }
  /// Stages made by machine code, of all evaluations().
  [[nodiscard]] long coded_stages() const { return coded_stages_; }
  /// Takes over modes, friction phases and anchors. `state` must outlive the use of this object or be
  /// set anew; poses are read only where a new layout has to be made.
  void set_state(const State& state);
  /// Forgets layouts whose merged bodies may have moved against each other.
  void forget_layouts() {
    stage_programs_.leave();
    layouts_.clear();
  }
  /// Relative rates along the rows of friction element f, and what they change by in a second, at the last rates().
  void slip_motion(int f, const double* dy, double* rate, double* acceleration, double* rounding);

  /// Signals are read on the left side of `limit`, a breakpoint that no step passes: a jump there does
  /// not reach into the step that ends at it.
  void set_time_limit(double limit);
  /// rates() that follow take signals that are forces by their means from `from` to their time, until this is asked for
  /// with an infinite time.
  void take_means(double from) { evaluation_.mean_from = from; }

  /// As last set.
  [[nodiscard]] const State& state() const { return *state_; }
  [[nodiscard]] const Layout& layout() const { return *layout_; }
  [[nodiscard]] int dimension() const { return 2 * layout_->coordinate_count + inner_count() + 2; }
  [[nodiscard]] int inner_count() const { return system_.inner_count(); }
  [[nodiscard]] int coordinate_count() const { return layout_->coordinate_count; }
  void pack(const State& state, double* y) const;
  void unpack(double t, const double* y, State& state) const;

  /// Rates of the clusters, 3 each, at y; their accelerations with dy of the last rates(). Good until asked again.
  [[nodiscard]] const double* cluster_rates(const double* y);
  [[nodiscard]] const double* cluster_accelerations(const double* dy);

  /// dy/dt at (t, y). What is asked for beside it is left for the functions below.
  void evaluate(Request request, double t, const double* y, double* dy);
  /// The same with all by-products.
  void rates(double t, const double* y, double* dy);
  /// Selects the compiled stage for the present modes, if there is one.
  void begin_stages();
  /// Moves y onto the constraints (mass-weighted least change), locked coordinates exactly. Returns the
  /// residuals found before. Stops at `tolerance`, 0: where rounding sets an end to it; throws ConstraintFailure
  /// if that cannot be reached.
  /// Inner states are settled with it, and what that dissipates is booked.
  Residual project(double t, double* y, double tolerance);
  /// Velocities onto the constraints as closely as rounding allows: what has come to rest does not creep.
  void close_velocities(double t, double* y);
  /// Takes from a small change of y what the constraints at the last evaluation do not allow, if that was
  /// near a singular position; else leaves it. There accelerations across the constraints are as uncertain
  /// as rounding over the distance from the singularity, but projection takes that part away.
  void remove_held(double* change);
  /// Takes from a small change of coordinates or of velocities what the constraints at the last evaluation do
  /// not allow: what is left is its (mass-weighted) nearest one along them.
  void keep_allowed(double* change);
  /// How near to a singular position evaluations have come since forget_pivots(): the smallest pivot of the
  /// constraint matrix against its diagonal, about the square of the distance in radians.
  [[nodiscard]] double lowest_pivot() const { return lowest_pivot_; }
  void forget_pivots() { lowest_pivot_ = 1.0; }
  /// Was the last evaluation that near?
  [[nodiscard]] bool is_near_singular() const;
  /// That of the last evaluation, stages without joints apart, or of a projection since.
  [[nodiscard]] double smallest_pivot() const { return pending_.is_pending() ? pending_.smallest_pivot() : layout_->smallest_pivot(); }
  /// Residuals at y without moving it.
  [[nodiscard]] Residual residual(double t, const double* y);

  // --- by-products of the last rates() ----------------------------------------------------------
  [[nodiscard]] const std::vector<double>& watch() const { return arrays_.watch; }
  [[nodiscard]] const std::vector<double>& watch_rate() const { return arrays_.watch_rate; }
  /// Both with all bodies where they are.
  [[nodiscard]] const Evaluation& evaluation() {
    ensure_byproducts();
    kinematics_.complete();
    return evaluation_;
  }
  [[nodiscard]] const std::vector<Motion<double>>& motion() {
    ensure_byproducts();
    kinematics_.complete();
    return kinematics_.motion();
  }
  /// Multipliers of the layout's active rows.
  [[nodiscard]] const std::vector<double>& multipliers() {
    ensure_byproducts();
    return rows_.multipliers();
  }
  /// The loads that sticking elements share in more than one way, as last solved by watch_merged(); null where
  /// every wrench is its element's own.
  [[nodiscard]] const LoadSharing* sharing() const { return layout_->sharing ? sharing_now() : nullptr; }
  /// Per rate of a coordinate what velocity errors must be small against for the slip laws' sake, infinite
  /// where none asks for it; false if that is everywhere.
  [[nodiscard]] bool slip_scales(double* scale);
  /// The fastest decay that a slip law gives to changes of velocity, 1/s (an upper bound).
  [[nodiscard]] double slip_decay_rate();
  /// Adds the watch values of joints that are merged, and of groups of sticking elements that share a load: costs
  /// a pass over the merged bodies.
  void watch_merged(const double* dy);
  /// Will watch_merged_if_near() look at them?
  [[nodiscard]] bool looks_at_merged(bool always) const {
    return is_merged_near_ || was_merged_near_ || (always && layout_->is_merged_watched) || (sharing() && has_groups());
  }
  /// The same at a stage inside a step, where only values near their limit are worth the pass, unless `always`.
  void watch_merged_if_near(const double* dy, bool always = false);
  /// Integrals that snapshots show; null: none.
  void show_integrals(const Integrals* integrals) { integrals_ = integrals; }
  /// Accelerations of all bodies and all reactions; fills a snapshot valid until the next rates().
  [[nodiscard]] Snapshot snapshot(const double* dy);
  /// Power residual-free pieces of the energy balance: kinetic + potential at the last rates().
  [[nodiscard]] double mechanical_energy(double t, const double* y);

  /// Response to unit wrenches along rows: columns of J_c P J_cᵀ and J_c a − γ_c for rows that are not
  /// active (candidates of the mode problem), P the constrained inverse mass. Uses the last rates().
  struct Candidates {
    std::vector<const RowSpec*> rows;
    std::vector<double> compliance;   ///< n × n, row-major
    std::vector<double> acceleration; ///< n: relative acceleration without their wrenches
    std::vector<double> rounding;     ///< n: of it
  };
  void respond(Candidates& candidates, const double* dy);

  [[nodiscard]] long evaluations() const { return evaluations_; }
  [[nodiscard]] const System& system() const { return system_; }

private:
  void take_inner(const double* inner);
  Residual project_rows(double t, double* y, double tolerance);
  void settle_inner(double t, double* y);
  void apply_sliding(std::size_t i);
  void sliding_rates(std::size_t i, double* rate) const;
  void apply_forces();
  void begin_rates(double t, const double* y, double* dy);
  void put_place_rates(const double* y, double* dy) const;
  void finish_rates(const double* y, double* dy);
  void finish_power(const double* a);
  void finish_watches();
  void rates_as_given(double t, const double* y, double* dy);
  void evaluate_stage(double t, const double* y, double* dy);
  void evaluate_stage_without_code(double t, const double* y, double* dy);
  void evaluate_stage_and_joints(double t, const double* y, double* dy, bool always);
  void evaluate_end(double t, const double* y, double* dy);
  Residual constraint_values(double t, const double* y);
  void rates_at(double t, const double* y, double* dy);
  void rates_nearby(double t, const double* y, double* dy);
  [[nodiscard]] bool reach_positions(double t, double* y, double tolerance, Residual& now);
  void reach_velocities(double t, double* y, Residual now, double tolerance);
  [[noreturn]] void fail_projection(double t) const;
  [[noreturn]] void fail_velocities(double t) const;
  [[nodiscard]] double place_rounding(const double* y) const;
  [[nodiscard]] double rate_rounding(const double* y) const;
  struct CandidateRow;
  void decide_rank();
  void record_rank(State& state) const;
  void find_sharing();
  [[nodiscard]] const LoadSharing* sharing_now() const;
  [[nodiscard]] bool is_shared(int friction) const;
  [[nodiscard]] bool has_groups() const;
  void take_solved_friction();
  [[nodiscard]] bool watch_groups();
  [[nodiscard]] bool watch_joints(const double* dy);
  [[nodiscard]] bool watch_wrenches();
  void take_time_inputs(double t, double* into);
  [[nodiscard]] bool run_code(double t, const double* y, double* dy, bool all);
  [[nodiscard]] bool may_look_by_code() const;
  [[nodiscard]] bool look_by_code(const StageProgram& program, double t);
  void count_stage(double t, const double* y, const double* dy);
  void defer_byproducts(const StageProgram& program, double t, const double* y);
  void ensure_byproducts() {
    if (pending_.is_pending()) [[unlikely]]
      evaluate_byproducts();
  }
  void evaluate_byproducts();
  void settle_loads();

  /// A merged joint with more of its capacity left than this at a step's ends is not looked at in between: what
  /// rises and falls by so much within a step is not resolved anyway.
  static constexpr double k_near_limit = 0.5;
  static constexpr double k_bound_slack = 1e-13; ///< as in coulomb_stick.cpp

  const System& system_;
  const State* state_ = nullptr;
  LayoutStore layouts_;
  Coordinates choice_ = Coordinates::absolute;
  Layout* layout_ = nullptr;
  bool is_rank_new_ = false;     ///< which rows of friction the equations leave out is decided, or was, since set_state()
  bool is_merged_near_ = false;  ///< some merged joint or group was near its limit when last watched
  bool was_merged_near_ = false; ///< or the time before: the other end of a step
  double time_cap_ = std::numeric_limits<double>::infinity();
  long evaluations_ = 0, coded_stages_ = 0;

  Evaluation evaluation_;
  FrictionScratches scratch_;
  EvaluationArrays arrays_; ///< the force of a body that is its cluster's only one is the cluster's
  std::vector<double> inner_;
  Kinematics kinematics_;
  ConstraintSolution rows_;
  Reactions reactions_;
  StagePrograms stage_programs_;
  const Motion<double>* motion_; ///< of kinematics_
  double* friction_force_;       ///< of reactions_
  double lowest_pivot_ = 1.0;
  double booked_[2] = {0.0, 0.0}; ///< dissipated energy and work at the last rates(), J
  const Integrals* integrals_ = nullptr;
  PendingEvaluation pending_;
  std::vector<double> placed_;                        ///< state of rates_nearby
  std::vector<double> kept_;                          ///< scratch of keep_allowed, per active row
  std::vector<char> was_out_;                         ///< scratch of decide_rank, per active row
  mutable std::vector<double> cluster_q_, cluster_v_; ///< 3 per cluster, where some are in mechanisms
  std::vector<double> cluster_a_;
};

} // namespace steplap
