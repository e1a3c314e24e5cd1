#include "mbd/dynamics/layout_store.h"

#include "mbd/dynamics/stage_program.h"

#include <algorithm>

namespace steplap {

namespace {

// Intended memory of the whole cache, bytes: less than the rest of a run of a large model needs, and enough for all recurring modes of a
// model with some bodies.
constexpr std::size_t k_store_bytes = 32U << 20U;
// Estimated bytes of a layout for each body and each possible row. Measured: 374 MB for 6300 sets of modes of 300 landing blocks, 0.2 kB
// per body.
constexpr std::size_t k_bytes_per_member = 512;
// Limits on the number of layouts. With the lower limit, a run that alternates between few sets of modes never computes one again. The
// upper limit suffices for a dozen contacts, which have some hundred sets.
constexpr std::size_t k_fewest = 16, k_most = 1024;

std::size_t usual_count(const System& system) {
  const std::size_t members = system.bodies.size() + system.rows.size() + static_cast<std::size_t>(system.friction_row_count);
  return std::clamp(k_store_bytes / (k_bytes_per_member * members), k_fewest, k_most);
}

} // namespace

LayoutStore::LayoutStore(const System& system) : system_(system), most_(usual_count(system)) {}

LayoutStore::Found LayoutStore::at(const State& state, Coordinates coordinates) {
  discarded_.clear();
  layout_key(state, coordinates, key_);
  const auto known =
      std::lower_bound(by_key_.begin(), by_key_.end(), key_, [](const Place& place, const LayoutKey& key) { return place->key < key; });
  if (known != by_key_.end() && (*known)->key == key_) {
    layouts_.splice(layouts_.begin(), layouts_, *known);
    return {layouts_.front(), false};
  }
  layouts_.push_front(make_layout(system_, state, coordinates, merged_at(state)));
  by_key_.insert(known, layouts_.begin());
  give_up_beyond(most_);
  return {layouts_.front(), true};
}

const MergedBodies& LayoutStore::merged_at(const State& state) {
  const std::vector<int> sticking = merging_frictions(system_, state);
  const auto known = std::find_if(merged_.begin(), merged_.end(), [&](const MergedBodies& m) { return m.frictions == sticking; });
  return known != merged_.end() ? *known : merged_.emplace_back(merge_bodies(system_, state));
}

void LayoutStore::give_up_beyond(std::size_t count) {
  while (layouts_.size() > count) {
    const Place last = std::prev(layouts_.end());
    by_key_.erase(std::find(by_key_.begin(), by_key_.end(), last));
    program_count_ -= last->programs.size();
    layouts_.pop_back();
  }
}

void LayoutStore::clear() {
  by_key_.clear();
  discarded_.splice(discarded_.end(), layouts_);
  merged_.clear();
  program_count_ = 0;
}

void LayoutStore::keep_at_most(std::size_t count) {
  most_ = count;
  give_up_beyond(count);
}

void LayoutStore::clear_programs() {
  for (Layout& layout : layouts_) layout.programs.clear();
  program_count_ = 0;
}

} // namespace steplap
