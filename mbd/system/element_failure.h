// Failure of a computation at certain elements. A caller that knows the model adds their locations in the file.
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

  /// Returns names of elements or bodies, the worst first.
  [[nodiscard]] const std::vector<std::string>& elements() const { return elements_; }

private:
  std::vector<std::string> elements_;
};

} // namespace steplap
