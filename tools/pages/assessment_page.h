// Creates the page of an assessment or of a static proof, from assessment.json and static.json in a folder.
#pragma once

#include "mbd/run/ordered_json.h"

#include <string>

namespace steplap {

/// Returns true if the folder contains assessment.json or static.json.
[[nodiscard]] bool is_assessment(const std::string& folder);

/// Returns the content of both files for a page. Throws FileError if a file is not as `steplap assess` wrote it.
[[nodiscard]] OrderedJson assessment_data(const std::string& folder);
/// Returns a self-contained HTML file. Its first printed sheet is one A4 page with room for two signatures. Throws as assessment_data().
[[nodiscard]] std::string assessment_page(const std::string& folder);

} // namespace steplap
