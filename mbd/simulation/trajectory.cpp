#include "mbd/simulation/trajectory.h"

#include <stdexcept>

namespace steplap {

Trajectory::Trajectory(const System& system, const std::vector<std::string>& patterns) {
  for (std::size_t i = 0; i < system.channels.size(); ++i) {
    const Channel& channel = system.channels[i];
    bool is_wanted = patterns.empty();
    for (const std::string& pattern : patterns) is_wanted |= matches_pattern(channel.name, pattern);
    if (!is_wanted) continue;
    channels_.push_back(&channel);
    places_.push_back(i);
  }
  rows_ = std::make_unique<RowStore>(channels_.size() + 1);
}

void Trajectory::add(double t, const Snapshot& snapshot, const System& system) {
  double* row = rows_->add_row();
  if (!row) return;
  *row = t;
  for (const std::size_t place : places_) *++row = system.channels[place].value(snapshot);
}

const std::vector<double>& Trajectory::times() const {
  for (std::size_t i = times_.size(); i < size(); ++i) times_.push_back(time(i));
  return times_;
}

std::size_t Trajectory::column(const std::string& name) const {
  for (std::size_t i = 0; i < channels_.size(); ++i)
    if (channels_[i]->name == name) return i;
  throw std::out_of_range("no channel '" + name + "' in the trajectory");
}

std::vector<double> Trajectory::series(const std::string& name) const {
  const std::size_t c = column(name);
  std::vector<double> result(size());
  for (std::size_t i = 0; i < size(); ++i) result[i] = value(i, c);
  return result;
}

} // namespace steplap
