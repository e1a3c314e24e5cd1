// Integrates the hand-written transformer with CVODE of SUNDIALS: Adams-Moulton of order 1 to 12, fixed-point iteration, its own root
// finding, restart after every event.

#include "sundials_handles.h"
#include "transformer_programs.h"

#include <cvode/cvode.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <array>

namespace steplap::peers {
namespace {

// Longest step, s. A foot that lifts and lands within one step would not be detected; the shortest lift in this scene takes 6.4 ms.
constexpr double k_longest_step = 2e-3;

// First step after a restart, relative to the last one. A restart begins with order 1 and needs much smaller steps.
constexpr double k_restart_share = 0.02;

class Run {
public:
  Run(Condition condition, double tolerance, Record* record) : model_(condition), record_(record), y_(model_.initial_state()) {
    for (int i = 0; i < k_states; ++i) weights_[i] = tolerance * k_scale[i];
    const VectorView weights(k_states, weights_.data(), sundials_.context);
    memory_ = CVodeCreate(CV_ADAMS, sundials_.context);
    require(CVodeInit(memory_, rates, 0.0, y_vector_.get()), "Init");
    solver_ = SUNNonlinSol_FixedPoint(y_vector_.get(), 0, sundials_.context);
    require(CVodeSetNonlinearSolver(memory_, solver_), "SetNonlinearSolver");
    require(CVodeSVtolerances(memory_, 0.0, weights.get()), "SVtolerances");
    require(CVodeSetUserData(memory_, &model_), "SetUserData");
    require(CVodeRootInit(memory_, k_switches, roots), "RootInit");
    std::array<int, k_switches> falling;
    falling.fill(-1);
    require(CVodeSetRootDirection(memory_, falling.data()), "SetRootDirection");
    require(CVodeSetMaxStep(memory_, k_longest_step), "SetMaxStep");
    require(CVodeSetMaxNumSteps(memory_, 1000000), "SetMaxNumSteps");
    // Disables the warning about event functions that are zero at the start of a mode, which is intended.
    require(CVodeSetNoInactiveRootWarn(memory_), "SetNoInactiveRootWarn");
  }
  ~Run() {
    CVodeFree(&memory_);
    SUNNonlinSolFree(solver_);
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  RunCounts integrate() {
    for (const double stop : k_breakpoints) {
      if (t_ > 0.0) restart();
      require(CVodeSetStopTime(memory_, stop), "SetStopTime");
      while (t_ < stop) {
        const double before = t_;
        const int flag = CVode(memory_, stop, y_vector_.get(), &t_, record_ != nullptr ? CV_ONE_STEP : CV_NORMAL);
        require(flag, "Evolve");
        if (record_ != nullptr) sample(before);
        if (flag != CV_ROOT_RETURN) continue;
        handle_event();
        restart();
        // A restart clears the stop time, which prevents steps across kinks of the load.
        require(CVodeSetStopTime(memory_, stop), "SetStopTime");
      }
    }
    collect();
    counts_.evaluations = model_.evaluations();
    return counts_;
  }

private:
  static int rates(double t, N_Vector y, N_Vector dydt, void* model) {
    static_cast<Transformer*>(model)->rates(t, data_of(y), data_of(dydt));
    return 0;
  }
  static int roots(double t, N_Vector y, double* g, void* model) {
    static_cast<Transformer*>(model)->switches(t, data_of(y), g);
    return 0;
  }

  void handle_event() {
    std::array<int, k_switches> found{};
    require(CVodeGetRootInfo(memory_, found.data()), "GetRootInfo");
    const auto hit = std::find_if(found.begin(), found.end(), [](int i) { return i != 0; });
    if (hit == found.end()) return;
    const int slot = static_cast<int>(hit - found.begin());
    ++counts_.events;
    if (record_ != nullptr) record_->happenings.push_back({t_, model_.describe(slot)});
    model_.cross(slot, t_, y_);
  }

  void restart() {
    double step = 0.0;
    require(CVodeGetLastStep(memory_, &step), "GetLastStep");
    collect();
    require(CVodeReInit(memory_, t_, y_vector_.get()), "ReInit");
    require(CVodeSetInitStep(memory_, k_restart_share * step), "SetInitStep");
  }

  // Adds up the counters, which reinitialisation clears.
  void collect() {
    long steps = 0;
    long failed = 0;
    require(CVodeGetNumSteps(memory_, &steps), "GetNumSteps");
    require(CVodeGetNumErrTestFails(memory_, &failed), "GetNumErrTestFails");
    counts_.steps += steps;
    counts_.rejected += failed;
  }

  void sample(double before) {
    State y;
    const VectorView view(k_states, y.data(), sundials_.context);
    while (static_cast<int>(record_->samples.size()) < k_samples) {
      const double t = k_sample_interval * static_cast<double>(record_->samples.size() + 1);
      if (t > t_ || t <= before - k_sample_interval) return;
      require(CVodeGetDky(memory_, t, 0, view.get()), "GetDky");
      record_->samples.push_back(model_.outputs(t, y));
    }
  }

  Transformer model_;
  Record* record_;
  State y_;
  State weights_{};
  double t_ = 0.0;
  SundialsContext sundials_;
  VectorView y_vector_{k_states, y_.data(), sundials_.context};
  void* memory_ = nullptr;
  SUNNonlinearSolver solver_ = nullptr;
  RunCounts counts_;
};

} // namespace

RunCounts run_transformer_cvode(Condition condition, double tolerance, Record* record) {
  return Run(condition, tolerance, record).integrate();
}

} // namespace steplap::peers
