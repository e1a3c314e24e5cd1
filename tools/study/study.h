// A study as its file describes it: what varies, what is looked at, what counts as failure, what is asked.
//
// Everything is in SI. The reader (study_reader.h) has checked all of it against the models before anything runs.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/model/fields.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace steplap::study {

/// [[variable]]: a number that is not known, or that is to be tried. Set either by 'values', by 'range' or by a
/// distribution.
struct Variable {
  std::string name;
  std::vector<std::string> paths; ///< in the models; none: the variable occurs in expressions only
  bool is_factor = false;         ///< it multiplies what the model has at its paths
  std::string model;              ///< name of the only model it is for; "": all
  std::vector<double> values;
  std::vector<double> range; ///< [low, high]
  std::string distribution;
  std::optional<double> mean, standard_deviation, cov;
  std::optional<double> low, high, mode; ///< of a uniform, triangular or beta distribution
  std::optional<double> shape, shape2, scale, location;
  std::optional<double> lower, upper; ///< the distribution is truncated there
  std::string measured, column;       ///< a CSV file the distribution is fitted to
  std::optional<double> value;        ///< where studies around a point stand; the model's own if not given
  std::string unit;                   ///< of the paths; else as the file says
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

/// What a response takes of a run.
enum class Measure : std::uint8_t {
  expression,        ///< nothing: it is made of variables and other responses
  highest,           ///< largest value of channels
  lowest,            ///< least value of channels
  largest_magnitude, ///< largest absolute value of channels
  final_value,       ///< of a channel, at the end
  initial_value,     ///< of a channel, at the start
  mean,              ///< of a channel, over the samples written
  path,              ///< sum of a channel's absolute changes over the samples written
  event_count,       ///< number of events
  first_event,       ///< time of the first event, s
  verdict            ///< 0 hold, 1 open, 2 inspect, 3 reject
};

/// Is it the extreme of channels?
[[nodiscard]] constexpr bool is_extreme(Measure m) {
  return m == Measure::highest || m == Measure::lowest || m == Measure::largest_magnitude;
}
/// Does it need the samples that a run writes?
[[nodiscard]] constexpr bool needs_samples(Measure m) { return m == Measure::mean || m == Measure::path; }

/// [[response]]: a number that each run gives.
struct Response {
  std::string name;
  std::string model;                     ///< name of the model it is taken from; needed where there are several
  std::string channel;                   ///< pattern with * and ?
  std::string what;                      ///< highest, lowest, largest, final, initial, mean, path, time_of_highest, ...
  Measure measure = Measure::expression; ///< `what` as a value
  bool takes_time = false;               ///< of an extreme: its time, s, instead of its value
  std::string event, element;            ///< patterns: events counted or timed
  std::optional<double> otherwise;       ///< the time of an event that never happens; infinity if not given
  std::string expression;                ///< of variables and of the responses before it
  std::string unit;
  Location where;
};

/// [[history]]: a measured record that a fit compares a channel with.
struct History {
  std::string name;
  std::string model;                    ///< needed where there are several
  std::string channel;                  ///< its name
  std::string file;                     ///< CSV
  std::string time = "1", column = "2"; ///< columns, by name or number
  std::string unit, time_unit;          ///< of the columns; "": the channel's, seconds
  std::string noise_text;               ///< as given
  std::optional<double> from, to;       ///< s: other rows are left out
  std::optional<double> noise;          ///< standard deviation of a measured value, in the channel's unit
  std::string channel_unit;
  std::vector<double> t, measured; ///< as read: s, and the channel's unit
  Location where;
};

/// [[limit_state]]: fails where its expression is negative.
struct LimitState {
  std::string name;
  std::string expression;
  Location where;
  bool is_border = false; ///< a kind of study looks for its zeros: it is no failure
};

/// What the table of a kind says; each kind has its own (study_kind.h).
struct KindSettings {
  Location where; ///< of the table; of the study where it has none

  KindSettings() = default;
  KindSettings(const KindSettings&) = default;
  KindSettings& operator=(const KindSettings&) = default;
  virtual ~KindSettings() = default;
  /// What the study asks for hangs on the time it has.
  [[nodiscard]] virtual bool ends_by_clock() const { return false; }
};

struct Study {
  std::string file;
  std::string text;
  std::string title;
  std::string kind;
  std::vector<std::string> models; ///< paths of files
  long seed = 1;
  std::string failed = "bounds"; ///< what runs that do not reach their end count as
  std::vector<Variable> variables;
  std::vector<Correlation> correlations;
  std::vector<Response> responses;
  std::vector<LimitState> limit_states;
  std::vector<History> histories;
  std::shared_ptr<const KindSettings> settings; ///< of its kind
  Location where;

  /// -1 if there is none.
  [[nodiscard]] int index_of_variable(const std::string& name) const;
};

/// The settings of a study whose kind has T. Throws std::bad_cast if its kind has others.
template <class T> [[nodiscard]] const T& settings_of(const Study& study) { return dynamic_cast<const T&>(*study.settings); }

/// What a table of a study file may hold.
struct StudyTable {
  std::string name; ///< "" is the top level
  std::string doc;
  bool is_array = false;
  FieldTable fields;
};

/// Fields of a [[variable]] whose numbers are in `unit` ("*": of any).
[[nodiscard]] FieldTable variable_fields(const std::string& unit);
[[nodiscard]] FieldTable header_fields();
[[nodiscard]] FieldTable correlation_fields();
[[nodiscard]] FieldTable response_fields();
[[nodiscard]] FieldTable limit_state_fields();
[[nodiscard]] FieldTable history_fields();
/// All of them and those of the kinds, in the order of a file.
[[nodiscard]] std::vector<StudyTable> study_tables();

/// JSON Schema of study files.
[[nodiscard]] std::string study_schema();

} // namespace steplap::study
