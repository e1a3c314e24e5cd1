// A computation that fails at an element: whoever knows the model can say where in its file that one stands.
#pragma once

#include "mbd/base/diagnostics.h"

#include <string>
#include <utility>
#include <vector>

namespace steplap {

class ElementFailure : public NumericalFailure {
public:
  ElementFailure(const std::string& message, std::vector<std::string> elements)
      : NumericalFailure(message), elements_(std::move(elements)) {}

  /// Names of elements or bodies, the worst first.
  [[nodiscard]] const std::vector<std::string>& elements() const { return elements_; }

private:
  std::vector<std::string> elements_;
};

} // namespace steplap
