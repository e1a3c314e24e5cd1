// The stack of a core's sheets, packet on packet: how many layers lie how, and which lie on each other.
//
// Packets follow each other from the front face to the back; each begins a book of its own. A packet of depth
// D, stacking factor f (steel's share) and sheet thickness d has ⌊f D/d⌋ sheets; its last layer may have fewer
// sheets than the others, its last book fewer layers: both are counted as they are. An oil duct parts two
// sheets, which then do not touch; between which, its place tells (measured from the front face, ducts not
// counted). Where packets meet, the last layer of one lies on the first of the next.
#pragma once

#include "transformer/core/book.h"

#include <cstddef>
#include <vector>

namespace steplap {

struct Packet {
  double width = 0.0;       ///< of the limb's sheets, m
  double yoke_height = 0.0; ///< of the yoke's, m
  double depth = 0.0;       ///< of steel and insulation, m
  double pressure = 1.0;    ///< share of the corner's clamping pressure
};

struct Duct {
  double place = 0.0; ///< m
  double width = 0.0; ///< m
};

struct Stack {
  std::vector<Packet> packets;
  double stacking_factor = 1.0;
  double sheet_thickness = 0.0; ///< of the steel, m
  std::vector<Duct> ducts;
  Book book;
  /// Do interfaces alike in different packets, and in as many slices of each, count apart? For pressures that differ with
  /// the place in the stack.
  bool is_by_place = false;
  long slices = 1;
};

/// Sheets of one outline: the packet that they are like, and the line at which they are cut.
struct LayerShape {
  std::size_t packet = 0; ///< the first of its width, yoke height and pressure
  long position = 0;
  friend bool operator<(const LayerShape& a, const LayerShape& b) {
    return a.packet != b.packet ? a.packet < b.packet : a.position < b.position;
  }
  friend bool operator==(const LayerShape& a, const LayerShape& b) { return a.packet == b.packet && a.position == b.position; }
};

/// Two layers that touch, `a` not after `b`: which of them is in front does not matter.
struct LayerPair {
  LayerShape a, b;
  long count = 0;           ///< times in the stack
  std::size_t zone = 0;     ///< of a stack by place: packet · slices + slice
  double before = 0.0;      ///< of a stack by place: sheets in front of it, in the mean
  long first = 0, last = 0; ///< of a stack by place: sheets in front of the foremost and of the rearmost such pair
};

struct LayerCount {
  LayerShape shape;
  long sheets = 0;
};

[[nodiscard]] long sheets_in(const Stack& stack, const Packet& packet);
[[nodiscard]] long sheets_in(const Stack& stack);
/// The last one of a packet may be incomplete.
[[nodiscard]] long layers_in(const Stack& stack, const Packet& packet);
[[nodiscard]] long layers_in(const Stack& stack);
/// Sheets in front of a duct.
[[nodiscard]] long sheets_before(const Stack& stack, const Duct& duct);
/// Of steel, insulation and ducts.
[[nodiscard]] double depth_of(const Stack& stack);
/// The first packet of the same width, yoke height and pressure.
[[nodiscard]] std::size_t likeness(const Stack& stack, std::size_t packet);

/// All pairs of layers that touch, each kind once (by place: once in a zone), those of one packet first.
[[nodiscard]] std::vector<LayerPair> layer_pairs(const Stack& stack);
/// All sheets by their outline.
[[nodiscard]] std::vector<LayerCount> layer_counts(const Stack& stack);

} // namespace steplap
