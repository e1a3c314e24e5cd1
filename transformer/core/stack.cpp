#include "transformer/core/stack.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace steplap {

namespace {

// Tolerance, so that rounding does not reduce a depth that is a whole number of sheets by one.
constexpr double k_rounded_sheets = 1e-9;

// Returns how many of the numbers 0 … n−1 leave the remainder `rest` when divided by `period`.
long count_of(long n, long rest, long period) { return n > rest ? (n - 1 - rest) / period + 1 : 0; }

class PairCounter {
public:
  explicit PairCounter(const Stack& stack) : stack_(stack) {}

  std::vector<LayerPair> count() {
    for (std::size_t p = 0; p < stack_.packets.size(); ++p) count_within(p);
    for (std::size_t p = 0; p + 1 < stack_.packets.size(); ++p) count_between(p);
    std::set<long> gaps; // two ducts between the same sheets count once
    for (const Duct& duct : stack_.ducts) gaps.insert(sheets_before(stack_, duct));
    for (const long gap : gaps) part(gap);
    std::vector<LayerPair> pairs;
    for (const bool is_same_packet : {true, false})
      for (const auto& [shapes, n] : counts_)
        if (n > 0 && (shapes.first.packet == shapes.second.packet) == is_same_packet) pairs.push_back({shapes.first, shapes.second, n});
    return pairs;
  }

  // Counts the pairs of a stack by place, interface by interface.
  std::vector<LayerPair> count_by_place() {
    std::set<long> gaps;
    for (const Duct& duct : stack_.ducts) gaps.insert(sheets_before(stack_, duct));
    std::map<std::pair<std::size_t, Shapes>, LayerPair> found;
    long before = 0;
    const auto add = [&](std::size_t zone, const Shapes& shapes) {
      if (gaps.count(before) > 0) return;
      LayerPair& pair = found.try_emplace({zone, shapes}, LayerPair{shapes.first, shapes.second, 0, zone, 0.0}).first->second;
      pair.before += static_cast<double>(before); // sum over the interfaces, divided by their count at the end
      if (pair.count == 0) pair.first = before;   // set by the first interface, since pairs are visited from front to back
      pair.last = before;
      ++pair.count;
    };
    const auto slices = static_cast<std::size_t>(stack_.slices);
    for (std::size_t p = 0; p < stack_.packets.size(); ++p) {
      const long first = before, layers = layers_in(stack_, stack_.packets[p]);
      for (long i = 0; i + 1 < layers; ++i) {
        before = first + (i + 1) * stack_.book.sheets_per_layer;
        add(p * slices + static_cast<std::size_t>(i * stack_.slices / (layers - 1)), ordered(shape(p, i), shape(p, i + 1)));
      }
      before = first + sheets_in(stack_, stack_.packets[p]);
      if (p + 1 < stack_.packets.size()) add(p * slices + slices - 1, seam(p));
    }
    std::vector<LayerPair> pairs;
    for (const bool is_same_packet : {true, false})
      for (auto& [key, pair] : found)
        if ((pair.a.packet == pair.b.packet) == is_same_packet) {
          pairs.push_back(pair);
          pairs.back().before /= static_cast<double>(pair.count);
        }
    return pairs;
  }

private:
  using Shapes = std::pair<LayerShape, LayerShape>;

  [[nodiscard]] LayerShape shape(std::size_t packet, long layer) const {
    return {likeness(stack_, packet), position_of(stack_.book, layer)};
  }
  static Shapes ordered(const LayerShape& a, const LayerShape& b) { return b < a ? Shapes{b, a} : Shapes{a, b}; }

  void count_within(std::size_t p) {
    const long pairs = layers_in(stack_, stack_.packets[p]) - 1, period = period_of(stack_.book);
    for (long i = 0; i < std::min(pairs, period); ++i) counts_[ordered(shape(p, i), shape(p, i + 1))] += count_of(pairs, i, period);
  }

  // Returns the pair of layers where packet p meets the next. Precondition: both packets have sheets.
  [[nodiscard]] Shapes seam(std::size_t p) const { return ordered(shape(p, layers_in(stack_, stack_.packets[p]) - 1), shape(p + 1, 0)); }
  void count_between(std::size_t p) { ++counts_[seam(p)]; }

  // Removes the pair that a duct after `gap` sheets separates, if the duct is between two layers.
  void part(long gap) {
    for (std::size_t p = 0; p < stack_.packets.size(); ++p) {
      const long sheets = sheets_in(stack_, stack_.packets[p]);
      if (gap > 0 && gap < sheets && gap % stack_.book.sheets_per_layer == 0) {
        const long layer = gap / stack_.book.sheets_per_layer;
        --counts_[ordered(shape(p, layer - 1), shape(p, layer))];
      }
      if (gap == sheets && p + 1 < stack_.packets.size()) --counts_[seam(p)];
      gap -= sheets;
      if (gap <= 0) return;
    }
  }

  const Stack& stack_;
  std::map<Shapes, long> counts_;
};

} // namespace

long sheets_in(const Stack& stack, const Packet& packet) {
  return std::lround(std::floor(packet.depth * stack.stacking_factor / stack.sheet_thickness + k_rounded_sheets));
}

long sheets_in(const Stack& stack) {
  long sum = 0;
  for (const Packet& packet : stack.packets) sum += sheets_in(stack, packet);
  return sum;
}

long layers_in(const Stack& stack, const Packet& packet) {
  return (sheets_in(stack, packet) + stack.book.sheets_per_layer - 1) / stack.book.sheets_per_layer;
}

long layers_in(const Stack& stack) {
  long sum = 0;
  for (const Packet& packet : stack.packets) sum += layers_in(stack, packet);
  return sum;
}

long sheets_before(const Stack& stack, const Duct& duct) {
  double place = duct.place;
  long before = 0;
  for (const Packet& packet : stack.packets) {
    const long sheets = sheets_in(stack, packet);
    if (place <= packet.depth) {
      const long own = std::lround(std::max(0.0, place) * stack.stacking_factor / stack.sheet_thickness);
      return before + std::min(own, sheets);
    }
    place -= packet.depth;
    before += sheets;
  }
  return before;
}

double depth_of(const Stack& stack) {
  double sum = 0.0;
  for (const Packet& packet : stack.packets) sum += packet.depth;
  for (const Duct& duct : stack.ducts) sum += duct.width;
  return sum;
}

std::size_t likeness(const Stack& stack, std::size_t packet) {
  const Packet& own = stack.packets[packet];
  for (std::size_t p = 0; p < packet; ++p)
    if (const Packet& other = stack.packets[p];
        other.width == own.width && other.yoke_height == own.yoke_height && other.pressure == own.pressure)
      return p;
  return packet;
}

std::vector<LayerPair> layer_pairs(const Stack& stack) {
  PairCounter counter(stack);
  return stack.is_by_place ? counter.count_by_place() : counter.count();
}

std::vector<LayerCount> layer_counts(const Stack& stack) {
  std::map<LayerShape, long> counts;
  const long m = stack.book.sheets_per_layer, period = period_of(stack.book);
  for (std::size_t p = 0; p < stack.packets.size(); ++p) {
    const long sheets = sheets_in(stack, stack.packets[p]), layers = layers_in(stack, stack.packets[p]);
    for (long i = 0; i < std::min(layers, period); ++i)
      counts[{likeness(stack, p), position_of(stack.book, i)}] += m * count_of(layers, i, period);
    if (layers > 0) counts[{likeness(stack, p), position_of(stack.book, layers - 1)}] -= m * layers - sheets;
  }
  std::vector<LayerCount> all;
  for (const auto& [shape, sheets] : counts) all.push_back({shape, sheets});
  return all;
}

} // namespace steplap
