// A large scene in parts: stretches of some hundred clusters each, with the links, rows and elements that belong to them.
//
// A part is evaluated in one go while its bodies and links are in the processor's cache, and several by several threads. Parts
// follow from the layout alone, never from the number of threads, and so does the order in which forces on a body are added up:
// those of elements against the ground, of links inside its part, of elements that are evaluated as a whole, of links to other
// parts. Of a link to another part each of the two takes the force on its own body.
//
// Clusters stand in the file's order, mechanisms behind (layout.h). Parts end where nothing reaches over the end if such a place is
// near; where that is so of all of them, as with many pendulums, no part waits for another.
#pragma once

#include "mbd/system/system.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace steplap {

struct Layout;
struct ActiveLink;

/// Lists of indices, one for each part.
class PartLists {
public:
  PartLists() = default;
  /// Item i is in the list of part owner[i]; below 0: in none. In ascending order.
  PartLists(int parts, const std::vector<int>& owner);
  [[nodiscard]] std::span<const int> operator[](int part) const {
    return {items_.data() + begin_[part], static_cast<std::size_t>(begin_[part + 1] - begin_[part])};
  }

private:
  std::vector<int> begin_, items_;
};

/// What a part of the layout goes through, as stretches of the layout's lists.
struct Part {
  int clusters = 0, clusters_end = 0;     ///< in absolute coordinates
  int mechanisms = 0, mechanisms_end = 0; ///< of layout.mechanisms
  int coordinates = 0, coordinates_end = 0;
  int links = 0, links_inside = 0, links_end = 0; ///< of layout.links, those to other parts or from the ground from links_inside on
};

struct Parts {
  /// Layouts of fewer clusters are evaluated in one piece.
  static constexpr int k_least_clusters = 4000;
  /// In a part: bodies, links and forces of so many, half a kilobyte each, fit the caches of one processor.
  static constexpr int k_clusters = 512;

  std::vector<Part> parts;
  bool are_separate = true;      ///< no link and no row is between two of them
  std::vector<int> of_cluster;   ///< part of each
  PartLists link_sides;          ///< on bodies of the part, of links that are not inside one: 2 · link + side
  PartLists riding, locks;       ///< bodies of layout.riding, indices of layout.locks
  std::vector<int> of_row;       ///< part of each row between absolute clusters
  PartLists rows;                ///< those
  PartLists row_sides;           ///< on clusters of the part: 2 · row + side
  PartLists sliding;             ///< indices of layout.sliding
  std::vector<PartLists> elements;    ///< of each of the system's groups, if it can be divided
  std::vector<int> whole_groups;      ///< the others

  [[nodiscard]] int count() const { return static_cast<int>(parts.size()); }
  [[nodiscard]] int of(const Layout& layout, int a, int b) const; ///< of what is between two bodies
};

/// Null where the layout is to be evaluated in one piece: if it is small, or has rows over more than two bodies.
/// Puts the layout's links in the parts' order. `rows`: how many of the active rows are between absolute clusters.
[[nodiscard]] std::unique_ptr<Parts> make_parts(const System& system, Layout& layout, int rows);

} // namespace steplap
