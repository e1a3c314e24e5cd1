// The layouts that a run keeps, at most so many: modes come back, and to find a layout anew costs as much as dozens of
// evaluations; but a scene with many contacts has more sets of modes than memory has room for.
//
// A layout that was given up and is found anew is the same one, to the bit: it hangs on the modes, and on where merged bodies
// are held against each other. The latter is found once for each set of joints that merge, at the poses in which it comes
// first, and kept until clear(): at later poses the bodies have moved against each other by rounding.
#pragma once

#include "mbd/dynamics/layout.h"

#include <cstddef>
#include <list>
#include <vector>

namespace steplap {

class LayoutStore {
public:
  explicit LayoutStore(const System& system);

  /// That of the modes in `state`. Valid until another one is asked for that is not kept, or clear().
  struct Found {
    Layout& layout;
    bool is_new;
  };
  [[nodiscard]] Found at(const State& state, Coordinates coordinates);
  /// Gives all up: merged bodies have moved against each other.
  void clear();
  /// Keeps `count` ≥ 1 layouts from now on. Results do not hang on it.
  void keep_at_most(std::size_t count);
  [[nodiscard]] std::size_t size() const { return layouts_.size(); }
  /// Of all layouts kept.
  [[nodiscard]] std::size_t program_count() const { return program_count_; }
  /// One of them has got one more: a run asks for their number at every event.
  void count_program() { ++program_count_; }
  void clear_programs();

private:
  using Place = std::list<Layout>::iterator;

  [[nodiscard]] const MergedBodies& merged_at(const State& state);
  void give_up_beyond(std::size_t count);

  const System& system_;
  std::list<Layout> layouts_;      ///< the last one used first
  std::vector<Place> by_key_;      ///< in the order of their keys: a run looks for one at every event
  std::list<MergedBodies> merged_; ///< as many as joints that let go since clear(), at most
  LayoutKey key_;
  std::size_t most_, program_count_ = 0;
};

} // namespace steplap
