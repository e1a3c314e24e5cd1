// Cache of layouts with a limited size. Sets of modes recur, and computing a layout costs as much as dozens of evaluations, but a model
// with many contacts has more sets of modes than memory can hold.
//
// A layout that was discarded and is computed again is bit-identical to the first one. It depends on the modes and on the relative poses of
// merged bodies. The latter are computed once for each set of merging joints, when it first occurs, and kept until clear(), because
// rounding errors change the relative poses later.
#pragma once

#include "mbd/dynamics/layout.h"

#include <cstddef>
#include <list>
#include <vector>

namespace steplap {

/// Cache of the layouts used most recently.
class LayoutStore {
public:
  /// `system` must outlive this object.
  explicit LayoutStore(const System& system);

  /// Result of at(). The reference is valid until the next call of at(), also after clear().
  struct Found {
    Layout& layout;
    bool is_new;
  };
  /// Returns the layout for the modes of `state`, which is computed if it is not stored.
  [[nodiscard]] Found at(const State& state, Coordinates coordinates);
  /// Discards all layouts. Required when merged bodies have moved relative to each other.
  void clear();
  /// Sets the largest number of layouts, ≥ 1. Results do not depend on it.
  void keep_at_most(std::size_t count);
  [[nodiscard]] std::size_t size() const { return layouts_.size(); }
  /// Returns the number of compiled stages of all layouts.
  [[nodiscard]] std::size_t program_count() const { return program_count_; }
  /// Must be called when a layout has received a compiled stage. A count is kept because it is read at every event.
  void count_program() { ++program_count_; }
  /// Discards the compiled stages of all layouts.
  void clear_programs();

private:
  using Place = std::list<Layout>::iterator;

  [[nodiscard]] const MergedBodies& merged_at(const State& state);
  void give_up_beyond(std::size_t count);

  const System& system_;
  std::list<Layout> layouts_;      ///< most recently used first
  std::list<Layout> discarded_;    ///< by clear(); kept until the next at(), because the last result is still in use
  std::vector<Place> by_key_;      ///< sorted by key, for the look-up at every event
  std::list<MergedBodies> merged_; ///< relative poses of merged bodies, for each set of merging joints since clear()
  LayoutKey key_;
  std::size_t most_, program_count_ = 0;
};

} // namespace steplap
