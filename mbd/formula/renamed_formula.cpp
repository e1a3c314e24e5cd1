#include "mbd/formula/renamed_formula.h"

#include "mbd/formula/formula.h"

#include <algorithm>
#include <optional>

namespace steplap {

namespace {

std::optional<Formula> parsed(const std::string& text) {
  try {
    return Formula(text, "", {});
  } catch (const ModelError&) {
    return std::nullopt;
  }
}

} // namespace

std::string with_operands(const std::string& text, const std::function<std::string(const std::string& name)>& renamed) {
  const std::optional<Formula> formula = parsed(text);
  if (!formula) return text;
  std::vector<const FormulaNode*> operands;
  for (const FormulaNode& node : formula->tree())
    if (node.op == FormulaOp::operand) operands.push_back(&node);
  std::sort(operands.begin(), operands.end(), [](const FormulaNode* a, const FormulaNode* b) { return a->begin < b->begin; });
  std::string result;
  std::size_t done = 0;
  for (const FormulaNode* node : operands) {
    result.append(text, done, node->begin - done);
    result += renamed(formula->names()[static_cast<std::size_t>(node->operand)]);
    done = node->end;
    while (done > node->begin && (text[done - 1] == ' ' || text[done - 1] == '\t'))
      --done; // a node's range of text extends to the beginning of the next token
  }
  return result.append(text, done);
}

} // namespace steplap
