// A channel defined by a formula of other channels. Formulas within formulas are merged into one tree, whose operands are channels of
// elements.
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
  /// An operand of the merged tree: a channel that is not a formula.
  struct Leaf {
    std::string name; ///< name of the channel
    std::function<double(const Snapshot&)> value;
    double factor; ///< value of one unit of the channel in SI
  };

  /// Merges `tree` with the formulas among its operands; operand i of `tree` is *operands[i]. The tree is evaluated in SI; `factor`
  /// converts its value to the unit of the channel.
  FormulaChannel(const FormulaTree& tree, const std::vector<const Channel*>& operands, double factor);

  /// Returns the merged tree, in SI. Its last node is the value, and its operand i is leaves()[i].
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

/// Type of Channel::value for a formula channel, from which formula_of() recovers the formula.
struct FormulaValue {
  std::shared_ptr<const FormulaChannel> formula;
  double operator()(const Snapshot& snapshot) const { return formula->value(snapshot); }
};

/// Returns the formula of a channel; null if the channel is not a formula.
[[nodiscard]] inline const FormulaChannel* formula_of(const Channel& channel) {
  const FormulaValue* const value = channel.value.target<FormulaValue>();
  return value ? value->formula.get() : nullptr;
}

} // namespace steplap
