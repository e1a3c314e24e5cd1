// Creates the page of an assessment or of a static proof, from assessment.json and static.json in a folder.
#pragma once

#include <string>

namespace steplap {

/// Returns true if the folder contains assessment.json or static.json.
[[nodiscard]] bool is_assessment(const std::string& folder);

/// Returns a self-contained HTML file. Its first printed sheet is one A4 page with room for two signatures. Throws FileError if a file was
/// not written by `steplap assess`, or if its decision is less severe than one of its reasons.
[[nodiscard]] std::string assessment_page(const std::string& folder);

} // namespace steplap
