#include "mbd/ensemble/ensemble.h"

#include <algorithm>

namespace steplap {

struct Ensemble::Sample {
  Finished run;
  const MachineCode* code = nullptr; ///< that makes the try which is due, with others
  double t = 0.0;                    ///< where that begins, s
  int lane = -1;                     ///< in which the last one was; −1: none was
  bool is_finished = false;
};

Ensemble::Ensemble(int width) : width_(static_cast<std::size_t>(std::max(width, 1))) {
  if (MachineCode::is_available()) columns_ = std::make_unique<LaneColumns>(MachineCode::most_lanes());
  in_lane_.resize(static_cast<std::size_t>(lanes()));
}

Ensemble::~Ensemble() = default;

int Ensemble::lanes() const { return columns_ ? columns_->lanes() : 1; }

template <class Work> void Ensemble::guarded(Sample& sample, const Work& work) {
  try {
    work(*sample.run.simulation);
  } catch (...) {
    sample.run.failure = std::current_exception();
    sample.is_finished = true;
  }
}

// As far as it goes alone: until a try is due that others may share, or to its end. `is_due`: a try is.
void Ensemble::go_on(Sample& sample, bool is_due) {
  Simulation& simulation = *sample.run.simulation;
  for (;; is_due = !simulation.conclude_try()) {
    if (!is_due && !simulation.begin_advance()) {
      sample.is_finished = true;
      return;
    }
    const StageProgram* const program = columns_ ? simulation.lane_program() : nullptr;
    sample.code = program ? program->lane_code() : nullptr;
    sample.t = simulation.time();
    if (sample.code) return;
    simulation.make_try();
    ++statistics_.lone_tries;
  }
}

void Ensemble::make_alone(Sample& sample) {
  guarded(sample, [&](Simulation& simulation) {
    simulation.make_try();
    ++statistics_.lone_tries;
    go_on(sample, !simulation.conclude_try());
  });
}

void Ensemble::make_in_lanes() {
  for (int lane = 0; lane < lanes(); ++lane) {
    Sample*& sample = in_lane_[static_cast<std::size_t>(lane)];
    if (!sample) continue;
    guarded(*sample, [&](Simulation& simulation) { simulation.load_try(*columns_, lane); }); // asks signals, which may fail
    if (sample->is_finished) sample = nullptr;
  }
  const unsigned holds = columns_->run();
  ++statistics_.lane_passes;
  for (int lane = 0; lane < lanes(); ++lane) {
    Sample* const sample = in_lane_[static_cast<std::size_t>(lane)];
    if (!sample) continue;
    if ((holds >> lane & 1U) == 0) { // a branch of its own
      sample->run.simulation->refuse_try();
      make_alone(*sample);
      continue;
    }
    ++statistics_.lane_tries;
    guarded(*sample, [&](Simulation& simulation) {
      simulation.take_try(*columns_, lane);
      go_on(*sample, !simulation.conclude_try());
    });
  }
}

// Who lags behind in time goes first, and takes along who wants the same: so samples stay near each other in time, which is what
// keeps them in the same modes. How many they are.
int Ensemble::fill_lanes() {
  std::stable_sort(samples_.begin(), samples_.end(), [](const auto& a, const auto& b) { return a->t < b->t; });
  const MachineCode* const code = samples_.front()->code;
  std::fill(in_lane_.begin(), in_lane_.end(), nullptr);
  together_.clear();
  for (const auto& sample : samples_) {
    if (sample->code != code || together_.size() == in_lane_.size()) continue;
    together_.push_back(sample.get());
    // Whoever was in a lane stays there, where its constants are.
    if (sample->lane < 0 || in_lane_[static_cast<std::size_t>(sample->lane)]) sample->lane = -1;
    else in_lane_[static_cast<std::size_t>(sample->lane)] = sample.get();
  }
  for (Sample* const sample : together_) {
    if (sample->lane >= 0) continue;
    const auto free = std::find(in_lane_.begin(), in_lane_.end(), nullptr);
    sample->lane = static_cast<int>(free - in_lane_.begin());
    *free = sample;
  }
  return static_cast<int>(together_.size());
}

// Null: there is no more.
std::unique_ptr<Ensemble::Sample> Ensemble::begin(const std::function<std::unique_ptr<Simulation>()>& start) {
  auto sample = std::make_unique<Sample>();
  try {
    sample->run.simulation = start();
  } catch (...) {
    sample->run.failure = std::current_exception();
    sample->is_finished = true;
    return sample;
  }
  if (!sample->run.simulation) return nullptr;
  guarded(*sample, [&](Simulation&) { go_on(*sample, false); });
  return sample;
}

void Ensemble::run(const std::function<std::unique_ptr<Simulation>()>& start, const std::function<void(Finished&&)>& done) {
  std::size_t started = 0;
  samples_.clear();
  for (bool is_more = true;;) {
    while (is_more && samples_.size() < width_) {
      std::unique_ptr<Sample> sample = begin(start);
      is_more = sample != nullptr;
      if (!sample) break;
      sample->run.number = started++;
      if (sample->is_finished) done(std::move(sample->run));
      else samples_.push_back(std::move(sample));
    }
    if (samples_.empty()) return;
    if (fill_lanes() == 1) make_alone(*together_.front());
    else make_in_lanes();
    for (auto& sample : samples_)
      if (sample->is_finished) done(std::move(sample->run));
    std::erase_if(samples_, [](const auto& sample) { return sample->is_finished; });
  }
}

} // namespace steplap
