// What pages and server write to each other (explorer.h), as JSON.
#pragma once

#include "run/report.h"
#include "tools/explore/explored_model.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// What is asked about one run.
struct RunRequest {
  std::size_t model = 0;   ///< which of the models
  ExploredValues values;   ///< SI
  std::string page;        ///< a name that the page has chosen for itself
  bool is_settled = false; ///< errors are to be estimated
  std::string name;        ///< of a file, where one is to be saved
};

/// What is asked about a map of two values.
struct MapRequest {
  std::size_t model = 0;
  ExploredValues values;
  std::string x, y;                             ///< paths
  std::vector<std::pair<double, double>> cells; ///< values at x and y
};

/// One run of a map.
struct MapCell {
  std::string verdict, error;                         ///< an error: there is no run
  std::vector<std::pair<std::string, double>> shares; ///< of limits, by their names (run/utilisation.h)
};

/// They throw std::invalid_argument for a text that is no such request: `models`: how many there are.
[[nodiscard]] RunRequest run_request(const std::string& body, std::size_t models);
/// The same; at most so many cells.
[[nodiscard]] MapRequest map_request(const std::string& body, std::size_t models, std::size_t most_cells);
/// From the query of an address: "model=0&values=%7B…%7D".
[[nodiscard]] RunRequest report_request(const std::string& query, std::size_t models);

/// {"errors": [{"file", "line", "column", "message"}]}
[[nodiscard]] std::string errors_json(const std::vector<Diagnostic>& problems);
/// {"is_superseded": true}
[[nodiscard]] std::string superseded_json();
/// {"version", "data"}: curves take about `budget` bytes.
[[nodiscard]] std::string run_json(const Report& report, long version, std::size_t budget);
/// {"cells"}
[[nodiscard]] std::string map_json(const std::vector<MapCell>& cells);
/// {"file"}
[[nodiscard]] std::string saved_json(const std::string& file);
/// {"name", "path", "title", "sliders", "errors"} of one model.
[[nodiscard]] std::string model_state_json(const ExploredModel& model, const std::vector<Diagnostic>& problems);
/// {"program", "version", "models"}: `models` are texts of model_state_json().
[[nodiscard]] std::string state_json(long version, const std::vector<std::string>& models);

} // namespace steplap
