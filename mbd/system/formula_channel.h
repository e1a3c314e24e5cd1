// A channel defined by a formula of other channels. Nested formulas are merged into one tree whose leaves are not formulas.
#pragma once

#include "mbd/formula/formula_tree.h"
#include "mbd/system/system.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace steplap {

/// The value of a channel that is a formula of other channels.
class FormulaChannel {
public:
  /// A channel that is not a formula itself.
  struct Leaf {
    std::string name; ///< name of the channel
    std::function<double(const Snapshot&)> value;
    double factor; ///< value of one unit of the channel in SI
  };

  /// `operands` are the channels that `tree` refers to by number. The value of the channel is `factor` times the value of the tree, which
  /// is in SI.
  FormulaChannel(const FormulaTree& tree, const std::vector<const Channel*>& operands, double factor);

  /// Returns the merged tree over the leaves, in SI; its last node is the value.
  [[nodiscard]] const FormulaTree& tree() const { return tree_; }
  /// Returns the operands of the merged tree.
  [[nodiscard]] const std::vector<Leaf>& leaves() const { return leaves_; }
  /// Returns the value at `snapshot`, in the unit of the channel.
  [[nodiscard]] double value(const Snapshot& snapshot) const;

private:
  class Joining;

  FormulaTree tree_;
  std::vector<Leaf> leaves_;
};

/// Callable stored in Channel::value of a formula channel.
struct FormulaValue {
  std::shared_ptr<const FormulaChannel> formula;
  double operator()(const Snapshot& snapshot) const { return formula->value(snapshot); }
};

/// Returns the formula of a channel, or null if it is not a formula.
[[nodiscard]] inline const FormulaChannel* formula_of(const Channel& channel) {
  const FormulaValue* const value = channel.value.target<FormulaValue>();
  return value ? value->formula.get() : nullptr;
}

} // namespace steplap
