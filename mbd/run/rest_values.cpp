#include "mbd/run/rest_values.h"

#include "mbd/dynamics/dynamics.h"
#include "mbd/rest/statics.h"

#include <algorithm>

namespace steplap {

namespace {

// During its lifetime drives hold their positions at `state`.
class HeldDrives {
public:
  HeldDrives(System& system, State& state) : system_(system) {
    static const Signal k_still;
    for (RowSpec& row : system.rows) {
      drives_.push_back(row.drive);
      if (!row.drive) continue;
      const double now = static_target(row, state);
      row.drive = &k_still;
      state.bases[row.base].rate = 0.0;
      state.bases[row.base].value += now - static_target(row, state);
    }
  }
  HeldDrives(const HeldDrives&) = delete;
  HeldDrives& operator=(const HeldDrives&) = delete;
  ~HeldDrives() {
    for (std::size_t r = 0; r < drives_.size(); ++r) system_.rows[r].drive = drives_[r];
  }

private:
  System& system_;
  std::vector<const Signal*> drives_;
};

} // namespace

std::vector<double> values_at_rest(System& system, State rest) {
  std::fill(rest.v.begin(), rest.v.end(), 0.0);
  const HeldDrives held(system, rest);
  Dynamics dynamics(system);
  dynamics.set_state(rest);
  std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y.size());
  dynamics.pack(rest, y.data());
  dynamics.rates(rest.t, y.data(), dy.data());
  const Snapshot snapshot = dynamics.snapshot(dy.data());
  std::vector<double> values;
  values.reserve(system.channels.size());
  for (const Channel& channel : system.channels) values.push_back(channel.value(snapshot));
  return values;
}

} // namespace steplap
