// A study as its file describes it: what varies, what is looked at, what counts as failure, what is asked.
//
// Everything is in SI. The reader (study_reader.h) has checked all of it against the models before anything runs.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/model/fields.h"

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
  std::optional<double> low, high, mode;  ///< of a uniform, triangular or beta distribution
  std::optional<double> shape, shape2, scale, location;
  std::optional<double> lower, upper;     ///< the distribution is truncated there
  std::string measured, column;           ///< a CSV file the distribution is fitted to
  std::optional<double> value;            ///< where studies around a point stand; the model's own if not given
  std::string unit;                       ///< of the paths; else as the file says
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

/// [[response]]: a number made of a run.
struct Response {
  std::string name;
  std::string model;   ///< name of the model it is taken from; needed where there are several
  std::string channel; ///< pattern with * and ?
  std::string what;    ///< highest, lowest, largest, final, initial, mean, path, time_of_highest, ...
  std::string event, element; ///< patterns: events counted or timed
  std::optional<double> otherwise; ///< the time of an event that never happens; infinity if not given
  std::string expression;     ///< of variables and of the responses before it
  std::string unit;
  Location where;
};

/// [[history]]: a measured record that a fit compares a channel with.
struct History {
  std::string name;
  std::string model;   ///< needed where there are several
  std::string channel; ///< its name
  std::string file;    ///< CSV
  std::string time = "1", column = "2"; ///< columns, by name or number
  std::string unit, time_unit;          ///< of the columns; "": the channel's, seconds
  std::string noise_text;               ///< as given
  std::optional<double> from, to;       ///< s: other rows are left out
  std::optional<double> noise;          ///< standard deviation of a measured value, in the channel's unit
  std::string channel_unit;
  std::vector<double> t, measured;      ///< as read: s, and the channel's unit
  Location where;
};

/// [[limit_state]]: fails where its expression is negative.
struct LimitState {
  std::string name;
  std::string expression;
  Location where;
};

struct SweepSettings {
  std::string design = "grid"; ///< grid, list, one_at_a_time
  long points = 11;            ///< of a range or a distribution's 5 % to 95 %
  Location where;
};

struct SampleSettings {
  std::string design = "monte_carlo"; ///< monte_carlo, latin_hypercube, sobol, halton
  long samples = 1000;
  Location where;
};

struct ReliabilitySettings {
  std::vector<std::string> methods{"form", "importance_sampling"};
  std::vector<std::string> limit_states; ///< all if none
  std::string combination = "any";       ///< the system fails where any, or where all of them are negative
  double cov = 0.05;                     ///< sampling stops at this coefficient of variation of the probability
  long samples = 100000;                 ///< and at this number of samples for each method
  std::optional<double> seconds;         ///< and at this time for each method
  double difference = 1e-3;              ///< step of difference in standard normal space
  long starts = 8;                       ///< of the search for design points
  std::optional<long> search_samples;    ///< for all searches together; 300 and 50 for each variable if not given
  long subset_samples = 2000;            ///< a level
  long repetitions = 4;                  ///< of subset simulation: its interval comes from their scatter
  double confidence = 0.95;
  Location where;
};

struct SensitivitySettings {
  std::string method = "elasticity"; ///< elasticity, morris, sobol, tornado
  double difference = 1e-3;          ///< relative step of an elasticity
  long samples = 1000;               ///< base size of Sobol indices
  long trajectories = 20;            ///< of Morris
  long levels = 8;
  double confidence = 0.95;
  Location where;
};

struct CriticalSettings {
  std::string variable;
  std::string expression; ///< whose zeros are looked for
  long points = 21;       ///< of the first look
  double tolerance = 1e-9; ///< of the variable's range
  Location where;
};

struct MapSettings {
  std::vector<std::string> variables; ///< two
  std::string expression;             ///< the border is where it is zero
  double step = 0.02;                 ///< along the border, of the ranges
  long points = 11;                   ///< a side, of the first look
  double tolerance = 1e-9;
  bool is_logarithmic = false;
  Location where;
};

struct NeedsSettings {
  double accuracy = 0.01; ///< changes of responses up to this share of them do not matter
  Location where;
};

struct FitSettings {
  long starts = 8;       ///< places where the search may begin; it does from the best of them
  long iterations = 100; ///< of one search
  double confidence = 0.95;
  Location where;
};

struct Study {
  std::string file;
  std::string text;
  std::string title;
  std::string kind;
  std::vector<std::string> models; ///< paths of files
  long seed = 1;
  std::string failed = "bounds";   ///< what runs that do not reach their end count as
  std::vector<Variable> variables;
  std::vector<Correlation> correlations;
  std::vector<Response> responses;
  std::vector<LimitState> limit_states;
  std::vector<History> histories;
  SweepSettings sweep;
  SampleSettings sample;
  ReliabilitySettings reliability;
  SensitivitySettings sensitivity;
  CriticalSettings critical;
  MapSettings map;
  NeedsSettings needs;
  FitSettings fit;
  Location where;

  /// -1 if there is none.
  [[nodiscard]] int index_of_variable(const std::string& name) const;
};

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
[[nodiscard]] FieldTable sweep_fields();
[[nodiscard]] FieldTable sample_fields();
[[nodiscard]] FieldTable reliability_fields();
[[nodiscard]] FieldTable sensitivity_fields();
[[nodiscard]] FieldTable critical_fields();
[[nodiscard]] FieldTable map_fields();
[[nodiscard]] FieldTable needs_fields();
[[nodiscard]] FieldTable fit_fields();
/// All of them, in the order of a file.
[[nodiscard]] std::vector<StudyTable> study_tables();

/// JSON Schema of study files.
[[nodiscard]] std::string study_schema();

} // namespace steplap::study
