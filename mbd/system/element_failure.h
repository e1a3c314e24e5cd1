// Failure of a computation that is caused by certain elements. Callers that know the model add the locations of these elements in the file.
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

  /// Returns the names of the elements or bodies that caused the failure, the worst first.
  [[nodiscard]] const std::vector<std::string>& elements() const { return elements_; }

private:
  std::vector<std::string> elements_;
};

} // namespace steplap
