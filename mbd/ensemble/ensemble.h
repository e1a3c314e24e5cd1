// Many runs of one scene with other numbers, side by side.
//
// Each sample keeps its own run (mbd/simulation): steps, events and modes are its own, and so are its bytes, which are those of the
// same run alone. Where several want to try a step in modes whose stages are one tape (mbd/dynamics/stage_program.h), the tries are
// made in the lanes of one register (mbd/integrators/lane_try.h); a sample that meets an event goes its own way, and joins others
// again where they are in the same modes. Other methods than dop853, and scenes whose stages cannot be written down, run one
// after the other as ever.
#pragma once

#include "mbd/simulation/simulation.h"

#include <exception>
#include <functional>
#include <memory>
#include <vector>

namespace steplap {

/// Runs samples side by side. It owns what they share while they run; one object per thread.
class Ensemble {
public:
  /// One run. `simulation` is null if it could not be started; `failure`: what has ended it before its end, null if nothing has.
  struct Finished {
    std::size_t number = 0;                 ///< in the order of starts, from 0
    std::unique_ptr<Simulation> simulation; ///< null if it could not be started
    std::exception_ptr failure;             ///< null if nothing has ended it before its end
  };
  /// How tries of steps were made.
  struct Statistics {
    long lane_tries = 0;  ///< tries of steps made in lanes
    long lane_passes = 0; ///< in so many passes, of lanes() at most
    long lone_tries = 0;  ///< made alone
  };

  /// `width`: samples under way at a time.
  explicit Ensemble(int width = k_usual_width);
  ~Ensemble();
  Ensemble(const Ensemble&) = delete;
  Ensemble& operator=(const Ensemble&) = delete;

  /// Lanes of a pass; 1 where no machine code is made.
  [[nodiscard]] int lanes() const;

  /// Runs what `start` gives, until it gives null, each to its end. `start` makes the Simulation of the next sample; what it throws
  /// is that sample's failure. `done` is called as samples end, in whatever order that is; what it throws ends all.
  void run(const std::function<std::unique_ptr<Simulation>()>& start, const std::function<void(Finished&&)>& done);

  /// Of all runs so far.
  [[nodiscard]] const Statistics& statistics() const { return statistics_; }

  /// Few enough that what they need stays in the processor's cache.
  static constexpr int k_usual_width = 8;

private:
  struct Sample;
  [[nodiscard]] std::unique_ptr<Sample> begin(const std::function<std::unique_ptr<Simulation>()>& start);
  void go_on(Sample& sample, bool is_due);
  [[nodiscard]] int fill_lanes();
  void make_alone(Sample& sample);
  void make_in_lanes();
  template <class Work> void guarded(Sample& sample, const Work& work);

  std::size_t width_;
  Statistics statistics_;
  std::unique_ptr<LaneColumns> columns_; ///< null: one lane
  std::vector<std::unique_ptr<Sample>> samples_;
  std::vector<Sample*> in_lane_;  ///< of the pass that is due; null: nobody
  std::vector<Sample*> together_; ///< the same without gaps
};

} // namespace steplap
