#include "mbd/system/formula_channel.h"

#include "mbd/formula/unit_dimension.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <tuple>

namespace steplap {

namespace {

double factor_of(const std::string& unit) {
  const auto dimension = dimension_of(unit);
  return dimension ? dimension->factor : 1.0;
}

} // namespace

// Merges nested formulas into one tree. Equal nodes are made only once; otherwise the size could double with each level of nesting.
class FormulaChannel::Joining {
public:
  explicit Joining(FormulaChannel& made) : made_(made) {}

  int add(const FormulaNode& node) {
    const Key key{node.op, node.of, std::bit_cast<std::uint64_t>(node.number), node.operand};
    const auto [known, is_new] = known_.try_emplace(key, static_cast<int>(made_.tree_.size()));
    if (is_new) made_.tree_.push_back(node);
    return known->second;
  }
  int add(FormulaOp op, int a = -1, int b = -1) {
    FormulaNode node;
    node.op = op;
    node.of = {a, b, -1};
    return add(node);
  }
  int scaled(int node, double factor) {
    if (factor == 1.0) return node;
    FormulaNode number;
    number.number = factor;
    return add(FormulaOp::multiply, add(number), node);
  }
  // Adds the nodes of `tree`, with operand i replaced by node operands[i] of the merged tree. Returns the root.
  int add_tree(const FormulaTree& tree, const std::vector<int>& operands) {
    std::vector<int> place;
    for (FormulaNode node : tree) {
      for (int& of : node.of)
        if (of >= 0) of = place[static_cast<std::size_t>(of)];
      place.push_back(node.op == FormulaOp::operand ? operands[static_cast<std::size_t>(node.operand)] : add(node));
    }
    return place.back();
  }
  int add_leaf(const Leaf& leaf) {
    auto& leaves = made_.leaves_;
    const auto found = std::find_if(leaves.begin(), leaves.end(), [&](const Leaf& other) { return other.name == leaf.name; });
    FormulaNode node;
    node.op = FormulaOp::operand;
    node.operand = static_cast<int>(found - leaves.begin());
    if (found == leaves.end()) leaves.push_back(leaf);
    return add(node);
  }
  int add_operand(const Channel& channel) {
    const double factor = factor_of(channel.unit);
    const FormulaChannel* const formula = formula_of(channel);
    if (!formula) return add_leaf({channel.name, channel.value, factor});
    std::vector<int> leaves;
    for (const Leaf& leaf : formula->leaves_) leaves.push_back(add_leaf(leaf));
    return scaled(add_tree(formula->tree_, leaves), factor);
  }

private:
  using Key = std::tuple<FormulaOp, std::array<int, 3>, std::uint64_t, int>;
  FormulaChannel& made_;
  std::map<Key, int> known_;
};

FormulaChannel::FormulaChannel(const FormulaTree& tree, const std::vector<const Channel*>& operands, double factor) {
  Joining joining(*this);
  std::vector<int> nodes;
  for (const Channel* channel : operands) nodes.push_back(joining.add_operand(*channel));
  const int value = joining.scaled(joining.add(FormulaOp::finite, joining.add_tree(tree, nodes)), factor);
  FormulaNode last; // root node, also if the formula is just an operand
  last.op = FormulaOp::finite;
  last.of = {value, -1, -1};
  tree_.push_back(last);
}

double FormulaChannel::value(const Snapshot& snapshot) const {
  thread_local std::vector<double> leaves, values;
  leaves.resize(std::max(leaves.size(), leaves_.size()));
  values.resize(std::max(values.size(), tree_.size()));
  for (std::size_t i = 0; i < leaves_.size(); ++i) leaves[i] = leaves_[i].factor * leaves_[i].value(snapshot);
  return value_of(tree_, leaves.data(), snapshot.t, values.data());
}

} // namespace steplap
