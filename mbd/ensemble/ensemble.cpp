#include "mbd/ensemble/ensemble.h"

#include <algorithm>

namespace steplap {

struct Ensemble::Sample {
  Finished run;
  const MachineCode* code = nullptr; ///< that makes the try which is due, with others
  bool is_finished = false;
};

Ensemble::Ensemble(int width) : width_(static_cast<std::size_t>(std::max(width, 1))) {
  if (MachineCode::is_available()) columns_ = std::make_unique<LaneColumns>(MachineCode::most_lanes());
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

// As far as it goes alone: until a try is due that others may share, or to its end.
void Ensemble::bring_to_try(Sample& sample) {
  guarded(sample, [&](Simulation& simulation) {
    for (bool is_due = false;;) {
      if (!is_due && !simulation.begin_advance()) {
        sample.is_finished = true;
        return;
      }
      const StageProgram* const program = columns_ ? simulation.lane_program() : nullptr;
      sample.code = program ? program->lane_code() : nullptr;
      if (sample.code) return;
      simulation.make_try();
      ++statistics_.lone_tries;
      is_due = !simulation.conclude_try();
    }
  });
}

// After a try: the next one, of the same step or another.
void Ensemble::conclude(Sample& sample) {
  guarded(sample, [&](Simulation& simulation) {
    while (!simulation.conclude_try()) {
      const StageProgram* const program = simulation.lane_program();
      sample.code = program ? program->lane_code() : nullptr;
      if (sample.code) return;
      simulation.make_try();
      ++statistics_.lone_tries;
    }
    sample.code = nullptr;
  });
  if (!sample.is_finished && !sample.code) bring_to_try(sample);
}

void Ensemble::make_alone(Sample& sample) {
  guarded(sample, [&](Simulation& simulation) {
    simulation.make_try();
    ++statistics_.lone_tries;
  });
  if (!sample.is_finished) conclude(sample);
}

void Ensemble::make_in_lanes(std::vector<Sample*>& together) {
  for (std::size_t lane = 0; lane < together.size(); ++lane)
    together[lane]->run.simulation->load_try(*columns_, static_cast<int>(lane));
  const unsigned holds = columns_->run();
  ++statistics_.lane_passes;
  for (std::size_t lane = 0; lane < together.size(); ++lane) {
    Sample& sample = *together[lane];
    if ((holds >> lane & 1U) == 0) {
      make_alone(sample); // a branch of its own
      continue;
    }
    ++statistics_.lane_tries;
    guarded(sample, [&](Simulation& simulation) { simulation.take_try(*columns_, static_cast<int>(lane)); });
    if (!sample.is_finished) conclude(sample);
  }
}

// Those of the tape of the pass before, if they fill the lanes: their constants are there; else of the tape that most wait for.
bool Ensemble::pick(std::vector<Sample*>& together) {
  const auto count = [this](const MachineCode* code) {
    return std::count_if(samples_.begin(), samples_.end(), [code](const auto& s) { return s->code == code; });
  };
  together.clear();
  if (samples_.empty()) return false;
  if (!last_ || count(last_) < lanes()) {
    long most = 0;
    for (const auto& sample : samples_) {
      const long n = count(sample->code);
      if (n > most) {
        most = n;
        last_ = sample->code;
      }
    }
  }
  for (const auto& sample : samples_)
    if (sample->code == last_ && together.size() < static_cast<std::size_t>(lanes())) together.push_back(sample.get());
  return true;
}

void Ensemble::run(const std::function<std::unique_ptr<Simulation>()>& start, const std::function<void(Finished&&)>& done) {
  std::size_t started = 0;
  bool is_more = true;
  std::vector<Sample*> together;
  samples_.clear();
  for (;;) {
    while (is_more && samples_.size() < width_) {
      auto sample = std::make_unique<Sample>();
      sample->run.number = started;
      try {
        sample->run.simulation = start();
        is_more = sample->run.simulation != nullptr;
      } catch (...) {
        sample->run.failure = std::current_exception();
      }
      if (!is_more) break;
      ++started;
      if (sample->run.simulation) bring_to_try(*sample);
      if (sample->is_finished || !sample->run.simulation) done(std::move(sample->run));
      else samples_.push_back(std::move(sample));
    }
    if (!pick(together)) return;
    if (together.size() == 1) make_alone(*together.front());
    else make_in_lanes(together);
    for (auto& sample : samples_)
      if (sample->is_finished) done(std::move(sample->run));
    std::erase_if(samples_, [](const auto& sample) { return sample->is_finished; });
  }
}

} // namespace steplap
