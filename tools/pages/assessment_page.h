// The page of an assessment, or of a static proof alone: read from assessment.json and static.json of a folder.
#pragma once

#include <string>

namespace steplap {

/// True if the folder holds assessment.json or static.json.
[[nodiscard]] bool is_assessment(const std::string& folder);

/// One HTML file that needs no other file and no network. Its first printed sheet, with room for two signatures, is one page of A4.
/// Throws FileError for a file that is not as `steplap assess` writes it, or whose decision is milder than one of its reasons.
[[nodiscard]] std::string assessment_page(const std::string& folder);

} // namespace steplap
