// Integrates the hand-written transformer with ARKODE of SUNDIALS: explicit Dormand-Prince 5(4), its own root finding, restart after every
// event.

#include "sundials_handles.h"
#include "transformer_programs.h"

#include <arkode/arkode_arkstep.h>

#include <algorithm>
#include <array>

namespace steplap::peers {
namespace {

// Longest step, s. A foot that lifts and lands within one step would not be detected; the shortest lift in this scene takes 6.4 ms.
constexpr double k_longest_step = 6e-3;

class Run {
public:
  Run(Condition condition, double tolerance, Record* record) : model_(condition), record_(record), y_(model_.initial_state()) {
    for (int i = 0; i < k_states; ++i) weights_[i] = tolerance * k_scale[i];
    const VectorView weights(k_states, weights_.data(), sundials_.context);
    memory_ = ARKStepCreate(rates, nullptr, 0.0, y_vector_.get(), sundials_.context);
    require(ARKStepSetTableNum(memory_, ARKODE_DIRK_NONE, ARKODE_DORMAND_PRINCE_7_4_5), "SetTableNum");
    require(ARKStepSVtolerances(memory_, 0.0, weights.get()), "SVtolerances");
    require(ARKStepSetUserData(memory_, &model_), "SetUserData");
    require(ARKStepRootInit(memory_, k_switches, roots), "RootInit");
    std::array<int, k_switches> falling;
    falling.fill(-1);
    require(ARKStepSetRootDirection(memory_, falling.data()), "SetRootDirection");
    require(ARKStepSetMaxStep(memory_, k_longest_step), "SetMaxStep");
    require(ARKStepSetMaxNumSteps(memory_, 1000000), "SetMaxNumSteps");
    // Disables the warning about event functions that are zero at the start of a mode, which is intended.
    require(ARKStepSetNoInactiveRootWarn(memory_), "SetNoInactiveRootWarn");
  }
  ~Run() { ARKStepFree(&memory_); }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  RunCounts integrate() {
    for (const double stop : k_breakpoints) {
      if (t_ > 0.0) restart();
      require(ARKStepSetStopTime(memory_, stop), "SetStopTime");
      while (t_ < stop) {
        const double before = t_;
        const int flag = ARKStepEvolve(memory_, stop, y_vector_.get(), &t_, record_ != nullptr ? ARK_ONE_STEP : ARK_NORMAL);
        require(flag, "Evolve");
        if (record_ != nullptr) sample(before);
        if (flag != ARK_ROOT_RETURN) continue;
        handle_event();
        restart();
        // A restart clears the stop time, which prevents steps across kinks of the load.
        require(ARKStepSetStopTime(memory_, stop), "SetStopTime");
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
    require(ARKStepGetRootInfo(memory_, found.data()), "GetRootInfo");
    const auto hit = std::find_if(found.begin(), found.end(), [](int i) { return i != 0; });
    if (hit == found.end()) return;
    const int slot = static_cast<int>(hit - found.begin());
    ++counts_.events;
    if (record_ != nullptr) record_->happenings.push_back({t_, model_.describe(slot)});
    model_.cross(slot, t_, y_);
  }

  void restart() {
    double step = 0.0;
    require(ARKStepGetLastStep(memory_, &step), "GetLastStep");
    collect();
    require(ARKStepReInit(memory_, rates, nullptr, t_, y_vector_.get()), "ReInit");
    require(ARKStepSetInitStep(memory_, step), "SetInitStep");
  }

  // Adds up the counters, which reinitialisation clears.
  void collect() {
    long steps = 0;
    long failed = 0;
    require(ARKStepGetNumSteps(memory_, &steps), "GetNumSteps");
    require(ARKStepGetNumErrTestFails(memory_, &failed), "GetNumErrTestFails");
    counts_.steps += steps;
    counts_.rejected += failed;
  }

  void sample(double before) {
    State y;
    const VectorView view(k_states, y.data(), sundials_.context);
    while (static_cast<int>(record_->samples.size()) < k_samples) {
      const double t = k_sample_interval * static_cast<double>(record_->samples.size() + 1);
      if (t > t_ || t <= before - k_sample_interval) return;
      require(ARKStepGetDky(memory_, t, 0, view.get()), "GetDky");
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
  RunCounts counts_;
};

} // namespace

RunCounts run_transformer_arkode(Condition condition, double tolerance, Record* record) {
  return Run(condition, tolerance, record).integrate();
}

} // namespace steplap::peers
