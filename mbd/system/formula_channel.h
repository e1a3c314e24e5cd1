// A channel that is a formula of others: one tree over the channels that are none, also where it is a formula of formulas.
#pragma once

#include "mbd/formula/formula_tree.h"
#include "mbd/system/system.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace steplap {

class FormulaChannel {
public:
  struct Leaf {
    std::string name; ///< of the channel
    std::function<double(const Snapshot&)> value;
    double factor; ///< of its unit: so many SI units
  };

  /// `operands`: what `tree` calls by their numbers. The value is `factor` times the tree's, which is in SI.
  FormulaChannel(const FormulaTree& tree, const std::vector<const Channel*>& operands, double factor);

  /// Over the leaves, in SI; its last node is the channel's value.
  [[nodiscard]] const FormulaTree& tree() const { return tree_; }
  [[nodiscard]] const std::vector<Leaf>& leaves() const { return leaves_; }
  [[nodiscard]] double value(const Snapshot& snapshot) const;

private:
  class Joining;

  FormulaTree tree_;
  std::vector<Leaf> leaves_;
};

/// What the channel of a formula calls.
struct FormulaValue {
  std::shared_ptr<const FormulaChannel> formula;
  double operator()(const Snapshot& snapshot) const { return formula->value(snapshot); }
};

/// What a channel is a formula of; null where it is none.
[[nodiscard]] inline const FormulaChannel* formula_of(const Channel& channel) {
  const FormulaValue* const value = channel.value.target<FormulaValue>();
  return value ? value->formula.get() : nullptr;
}

} // namespace steplap
