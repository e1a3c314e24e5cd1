// How far the run of a scaled model is from that of the model itself, both in the model's own units.
#pragma once

#include "tests/scales/scaled_model.h"

#include <memory>

namespace steplap::testing {

struct Difference {
  std::string failure;    ///< of one run and not of the other, or other words; "": both ended alike
  long steps[2] = {0, 0}; ///< accepted, of the model and of the scaled one
  long evaluations[2] = {0, 0};
  long events[2] = {0, 0};
  std::string first_event; ///< that is not the same; "": all are
  double event_time = 0.0; ///< largest difference, of the run's duration
  double value = 0.0;      ///< of what channels end with and of their extremes, of the larger of these and what there is in such a scene
  std::string channel;     ///< of that
  std::string verdict[2];

  [[nodiscard]] bool is_same_course() const { return failure.empty() && first_event.empty() && verdict[0] == verdict[1]; }
};

/// A model of which scaled ones are compared with it.
class Original {
public:
  /// The run is cut off after `longest`, in s, and the method is the model's own unless one is given.
  Original(const std::string& file, double longest, const std::string& integrator = "");
  [[nodiscard]] Difference difference(const Scaling& by) const;
  [[nodiscard]] const std::string& failure() const { return own_.failure; }

private:
  struct Run {
    std::unique_ptr<System> system;
    RunResult result;
    std::string failure, verdict;
  };
  static Run run(const Model& model);

  Model model_;
  Run own_;
};

} // namespace steplap::testing
