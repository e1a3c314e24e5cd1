// Contents of a study file: variables, responses, limit states and settings.
//
// All values are SI. The reader (study_reader.h) has checked them against the models before anything runs.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/model/fields.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap::study {

/// [[variable]]: an uncertain number, or one that is varied. Defined by 'values', by 'range' or by a distribution.
struct Variable {
  std::string name;
  std::vector<std::string> paths; ///< paths in the models; empty: used in expressions only
  bool is_factor = false;         ///< true if the variable multiplies the model's value at its paths
  std::string model;              ///< name of the only model in which the variable is set; "": all models
  std::vector<double> values;
  std::vector<double> range; ///< [low, high] of the variable
  std::string distribution;
  std::optional<double> mean, standard_deviation, cov;
  std::optional<double> low, high, mode; ///< bounds and mode of a uniform, triangular or beta distribution
  std::optional<double> shape, shape2, scale, location;
  std::optional<double> lower, upper; ///< bounds at which the distribution is truncated
  std::string measured, column;       ///< CSV file and column of measured values to which the distribution is fitted
  std::optional<double> value;        ///< point around which local studies are made; the model's value if not given
  std::string unit;                   ///< unit of the numbers given; "": the unit of the model's field
  Location where;

  [[nodiscard]] bool has_distribution() const { return !distribution.empty(); }
};

/// [[correlation]] between two variables.
struct Correlation {
  std::vector<std::string> between;
  double rho = 0.0;
  std::string of = "values"; ///< "values" (linear), "ranks" (Spearman) or "normal" (of the normal copula)
  Location where;
};

/// How a response is computed from a run.
enum class Measure : std::uint8_t {
  expression,        ///< none: computed from variables and other responses
  highest,           ///< largest value of the channels
  lowest,            ///< smallest value of the channels
  largest_magnitude, ///< largest absolute value of the channels
  final_value,       ///< value of a channel at the end
  initial_value,     ///< value of a channel at the start
  mean,              ///< mean of a channel over the written samples
  path,              ///< sum of a channel's absolute changes over the written samples
  event_count,       ///< number of events that match
  first_event,       ///< time of the first event, s
  verdict,           ///< 0 hold, 1 open, 2 inspect, 3 reject
  reserve            ///< smallest reserve of all limits (mbd/run/utilisation.h); negative unless the verdict is "hold"
};

/// Returns true for extremes of channels.
[[nodiscard]] constexpr bool is_extreme(Measure m) {
  return m == Measure::highest || m == Measure::lowest || m == Measure::largest_magnitude;
}
/// Returns true if the response needs the verdict or the limits of the run.
[[nodiscard]] constexpr bool is_judged(Measure m) { return m == Measure::verdict || m == Measure::reserve; }
/// Returns true if the response needs the output samples of the run.
[[nodiscard]] constexpr bool needs_samples(Measure m) { return m == Measure::mean || m == Measure::path; }

/// [[response]]: a number computed for each run.
struct Response {
  std::string name;
  std::string model;   ///< name of the model that is run; required if there are several
  std::string channel; ///< pattern with * and ?
  std::string
      what; ///< statistic of the channel: highest, final, mean, path (sum of all changes), time_of_highest …; all in study_reader.cpp
  Measure measure = Measure::expression; ///< value of `what`
  bool takes_time = false;               ///< true if a response takes the time of an extreme, s, instead of its value
  std::string event, element;            ///< patterns of events that are counted or timed
  std::optional<double> otherwise;       ///< value of the time if the event never happens; infinity if not given
  std::string expression;                ///< formula of variables and earlier responses
  std::string unit;
  Location where;
};

/// [[history]]: a measured record with which a fit compares a channel.
struct History {
  std::string name;
  std::string model;                    ///< required if there are several models
  std::string channel;                  ///< name of the channel
  std::string file;                     ///< path of the CSV file
  std::string time = "1", column = "2"; ///< columns, by name or number
  std::string unit, time_unit;          ///< units of the columns; "": the channel's unit, seconds
  std::string noise_text;               ///< noise as given in the file
  std::optional<double> from, to;       ///< s; rows outside are ignored
  std::optional<double> noise;          ///< standard deviation of the measurement, in the channel's unit
  std::string channel_unit;
  std::vector<double> t, measured; ///< s; in the channel's unit
  Location where;
};

/// [[limit_state]]: a sample fails if the expression is negative.
struct LimitState {
  std::string name;
  std::string expression;
  Location where;
  bool is_border = false; ///< true if the study kind searches zeros of the expression, which are not failures
};

/// [[evidence]]: past loads in which the system held, or failed. Variables not listed in `anew` or `settings` had the same values as now.
struct Evidence {
  bool is_held = true;
  long times = 1;                             ///< number of past loads of this kind
  std::vector<std::string> anew;              ///< names of variables with independent values in each load
  std::vector<std::string> settings;          ///< measured values as given: "variable=value"
  std::vector<std::pair<int, double>> values; ///< variables with measured values: index, value
  std::vector<std::string> limit_states;      ///< limit states of the past loads; empty: all of the study's system
  Location where;
};

/// Settings of a study kind, read from its table. Each kind derives its own type (study_kind.h).
struct KindSettings {
  Location where; ///< location of the kind's table, or of the study if there is none

  KindSettings() = default;
  KindSettings(const KindSettings&) = default;
  KindSettings& operator=(const KindSettings&) = default;
  virtual ~KindSettings() = default;
  /// Returns true if computing time decides when the study ends, so that repetitions differ.
  [[nodiscard]] virtual bool ends_by_clock() const { return false; }
};

/// A study file.
struct Study {
  std::string file;
  std::string text;
  std::string title;
  std::string kind;
  std::vector<std::string> models; ///< paths of the model files
  long seed = 1;
  std::string failed = "bounds"; ///< how runs without a result are counted: bounds, safe, unsafe, or stop
  std::vector<Variable> variables;
  std::vector<Correlation> correlations;
  std::vector<Response> responses;
  std::vector<LimitState> limit_states;
  std::vector<History> histories;
  std::vector<Evidence> evidence;
  std::shared_ptr<const KindSettings> settings; ///< type depends on the kind
  Location where;

  /// Returns the index, or −1 if there is no such variable.
  [[nodiscard]] int index_of_variable(const std::string& name) const;
};

/// Returns the settings of a study whose kind has settings T. Throws std::bad_cast otherwise.
template <class T> [[nodiscard]] const T& settings_of(const Study& study) { return dynamic_cast<const T&>(*study.settings); }

/// Description of a table of a study file.
struct StudyTable {
  std::string name; ///< "" for the top level
  std::string doc;
  bool is_array = false;
  FieldTable fields;
};

/// Returns the fields of a [[variable]] whose numbers have the unit `unit` ("*": any).
[[nodiscard]] FieldTable variable_fields(const std::string& unit);
[[nodiscard]] FieldTable header_fields();
[[nodiscard]] FieldTable correlation_fields();
[[nodiscard]] FieldTable response_fields();
[[nodiscard]] FieldTable limit_state_fields();
[[nodiscard]] FieldTable history_fields();
[[nodiscard]] FieldTable evidence_fields();
/// Returns all tables, including those of the kinds, in the order of a file.
[[nodiscard]] std::vector<StudyTable> study_tables();

/// Returns the JSON Schema of study files.
[[nodiscard]] std::string study_schema();

} // namespace steplap::study
