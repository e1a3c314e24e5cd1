#include "mbd/simulation/trajectory.h"

#include <stdexcept>

namespace steplap {

Trajectory::Trajectory(const System& system, const std::vector<std::string>& patterns) {
  for (const Channel& channel : system.channels) {
    bool is_wanted = patterns.empty();
    for (const std::string& pattern : patterns) is_wanted |= matches_pattern(channel.name, pattern);
    if (is_wanted) channels_.push_back(&channel);
  }
}

void Trajectory::add(double t, const Snapshot& snapshot) {
  times_.push_back(t);
  for (const Channel* channel : channels_) values_.push_back(channel->value(snapshot));
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
