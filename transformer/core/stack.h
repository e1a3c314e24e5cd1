// Stack of a core's sheets, packet after packet: numbers of layers of each shape, and of pairs of neighbouring layers.
//
// Packets are listed from the front face to the back; each begins its own book. A packet of depth D with stacking factor f (fraction
// of steel) and sheet thickness d has ⌊f D/d⌋ sheets. Its last layer may have fewer sheets than the others, and its last book fewer layers;
// both are counted exactly. An oil duct separates two sheets; its position, measured from the front face without ducts, determines which.
// Where packets meet, the last layer of one is next to the first layer of the next.
#pragma once

#include "transformer/core/book.h"

#include <cstddef>
#include <vector>

namespace steplap {

/// Packet of equal sheets.
struct Packet {
  double width = 0.0;       ///< width of the limb sheets, m
  double yoke_height = 0.0; ///< height of the yoke, m
  double depth = 0.0;       ///< depth of steel and insulation, m
  double pressure = 1.0;    ///< pressure relative to the clamping pressure of the corner
};

/// Cooling duct in the stack.
struct Duct {
  double place = 0.0; ///< position from the front face, not counting ducts, m
  double width = 0.0; ///< width, m
};

/// The sheets of a core from front to back.
struct Stack {
  std::vector<Packet> packets;
  double stacking_factor = 1.0;
  double sheet_thickness = 0.0; ///< thickness of the steel, m
  std::vector<Duct> ducts;
  Book book;
  /// True: equal interfaces in different packets, and in different slices of a packet, are counted separately, because their pressures
  /// depend on the position in the stack.
  bool is_by_place = false;
  long slices = 1;
};

/// Sheets of one outline: packet and line of the cut.
struct LayerShape {
  std::size_t packet = 0; ///< first packet with the same width, yoke height and pressure
  long position = 0;
  friend bool operator<(const LayerShape& a, const LayerShape& b) {
    return a.packet != b.packet ? a.packet < b.packet : a.position < b.position;
  }
  friend bool operator==(const LayerShape& a, const LayerShape& b) { return a.packet == b.packet && a.position == b.position; }
};

/// Two neighbouring layers, with `a` not after `b` in the order of LayerShape; their order in the stack is irrelevant.
struct LayerPair {
  LayerShape a, b;
  long count = 0;           ///< number of occurrences in the stack
  std::size_t zone = 0;     ///< in a stack by place: packet · slices + slice
  double before = 0.0;      ///< in a stack by place: mean number of sheets in front of the pair
  long first = 0, last = 0; ///< in a stack by place: number of sheets in front of the first and the last such pair
};

/// Number of sheets with one outline.
struct LayerCount {
  LayerShape shape;
  long sheets = 0;
};

/// Return the number of sheets in a packet, or in the whole stack.
[[nodiscard]] long sheets_in(const Stack& stack, const Packet& packet);
[[nodiscard]] long sheets_in(const Stack& stack);
/// Returns the number of layers in a packet, or in the whole stack. The last layer of a packet may be incomplete.
[[nodiscard]] long layers_in(const Stack& stack, const Packet& packet);
[[nodiscard]] long layers_in(const Stack& stack);
/// Returns the number of sheets in front of a duct.
[[nodiscard]] long sheets_before(const Stack& stack, const Duct& duct);
/// Returns the depth of steel, insulation and ducts, m.
[[nodiscard]] double depth_of(const Stack& stack);
/// Returns the index of the first packet with the same width, yoke height and pressure.
[[nodiscard]] std::size_t likeness(const Stack& stack, std::size_t packet);

/// Returns all kinds of pairs of neighbouring layers with their number (in a stack by place once for each zone), those within a packet
/// first.
[[nodiscard]] std::vector<LayerPair> layer_pairs(const Stack& stack);
/// Returns the number of sheets of each outline.
[[nodiscard]] std::vector<LayerCount> layer_counts(const Stack& stack);

} // namespace steplap
