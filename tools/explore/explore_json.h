// JSON messages between pages and the server (explorer.h).
#pragma once

#include "mbd/run/report.h"
#include "tools/explore/explored_model.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// Request for one run.
struct RunRequest {
  std::size_t model = 0;   ///< index of the model
  ExploredValues values;   ///< values to set, SI
  std::string page;        ///< identifier of the requesting page, chosen by it
  bool is_settled = false; ///< true if errors must be estimated, too
  std::string name;        ///< name of the file to save, if any
};

/// Request for the verdicts at points of a plane of two values.
struct MapRequest {
  std::size_t model = 0;
  ExploredValues values;
  std::string x, y;                             ///< paths of the two values
  std::vector<std::pair<double, double>> cells; ///< values of x and y of each requested run
};

/// Result of one run of a map.
struct MapCell {
  std::string verdict, error;                         ///< reason why there is no result; "" if there is one
  std::vector<std::pair<std::string, double>> shares; ///< utilisation of each limit by name (mbd/run/utilisation.h)
};

/// Parses a request. Throws std::invalid_argument if the text is invalid. `models` is the number of models.
[[nodiscard]] RunRequest run_request(const std::string& body, std::size_t models);
/// Parses a request with at most `most_cells` cells. Throws as above.
[[nodiscard]] MapRequest map_request(const std::string& body, std::size_t models, std::size_t most_cells);
/// Parses the query of an address: "model=0&values=%7B…%7D". Throws as above.
[[nodiscard]] RunRequest report_request(const std::string& query, std::size_t models);

/// Returns {"errors": [{"file", "line", "column", "message"}]}.
[[nodiscard]] std::string errors_json(const std::vector<Diagnostic>& problems);
/// Returns {"is_superseded": true}.
[[nodiscard]] std::string superseded_json();
/// Returns {"version", "data"}. Curves take about `budget` bytes.
[[nodiscard]] std::string run_json(const Report& report, long version, std::size_t budget);
/// Returns {"cells"}.
[[nodiscard]] std::string map_json(const std::vector<MapCell>& cells);
/// Returns {"file"}.
[[nodiscard]] std::string saved_json(const std::string& file);
/// Returns {"name", "path", "title", "sliders", "errors"} of one model.
[[nodiscard]] std::string model_state_json(const ExploredModel& model, const std::vector<Diagnostic>& problems);
/// Returns {"program", "version", "models"}. `models` are texts of model_state_json().
[[nodiscard]] std::string state_json(long version, const std::vector<std::string>& models);

} // namespace steplap
