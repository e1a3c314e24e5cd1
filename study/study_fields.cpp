// The fields of study files, declared once: the reader and the schema are made of these tables.
#include "study/study.h"

namespace steplap::study {

int Study::index_of_variable(const std::string& name) const {
  for (std::size_t i = 0; i < variables.size(); ++i)
    if (variables[i].name == name) return static_cast<int>(i);
  return -1;
}

FieldTable header_fields() {
  FieldTable t;
  t.add("title", &Study::title).doc("one line that names the study");
  t.add("kind", &Study::kind).required().doc("what is asked: the kind of study");
  t.add("model", &Study::models)
      .doc("model files, relative to the study; none: limit states are expressions of variables");
  t.add("seed", &Study::seed).at_least(0).doc("of all random numbers");
  t.add("failed", &Study::failed)
      .one_of({"bounds", "unsafe", "safe", "stop"})
      .doc("what samples count as whose run does not reach its end, or is not to be trusted: both in turn, failure, no "
           "failure, or the study stops");
  return t;
}

FieldTable variable_fields(const std::string& unit) {
  FieldTable t;
  t.add("name", &Variable::name).required().doc("letters, digits and _: expressions use it");
  t.add("path", &Variable::paths).doc("fields of the model that get the value, as --set names them");
  t.add("factor", &Variable::is_factor).doc("true: the value multiplies what the model has at the paths");
  t.add("model", &Variable::model).doc("name of the only model it is set in, the file's without ending");
  t.add("unit", &Variable::unit).doc("of a variable without path, for tables");
  t.add("values", &Variable::values).in(unit).doc("a list of values to try");
  t.add("range", &Variable::range).in(unit).doc("[low, high]");
  t.add("distribution", &Variable::distribution)
      .one_of({"normal", "lognormal", "uniform", "triangular", "weibull", "gumbel", "beta", "exponential"})
      .doc("by its moments or its own parameters, or fitted to 'measured'");
  t.add("mean", &Variable::mean).in(unit).doc("of the distribution");
  t.add("standard_deviation", &Variable::standard_deviation).in(unit).positive().doc("of the distribution");
  t.add("cov", &Variable::cov).positive().doc("coefficient of variation: standard deviation over mean");
  t.add("low", &Variable::low).in(unit).doc("lower end of a uniform, triangular or beta distribution");
  t.add("high", &Variable::high).in(unit).doc("upper end");
  t.add("mode", &Variable::mode).in(unit).doc("most likely value of a triangular distribution");
  t.add("shape", &Variable::shape).positive().doc("k of a Weibull distribution, alpha of a beta distribution");
  t.add("shape2", &Variable::shape2).positive().doc("beta of a beta distribution");
  t.add("scale", &Variable::scale).in(unit).positive().doc("of a Weibull, Gumbel or exponential distribution");
  t.add("location", &Variable::location)
      .in(unit)
      .doc("shift of a lognormal, Weibull or exponential distribution, mode of a Gumbel's");
  t.add("lower", &Variable::lower).in(unit).doc("the distribution is truncated below");
  t.add("upper", &Variable::upper).in(unit).doc("the distribution is truncated above");
  t.add("measured", &Variable::measured)
      .as(FieldType::file)
      .doc("CSV file of measurements, in SI, that the distribution is fitted to");
  t.add("column", &Variable::column).doc("its column, by name or number");
  t.add("value", &Variable::value)
      .in(unit)
      .doc("where studies around a point stand; if not given the mean, the middle of the range, the model's own");
  return t;
}

FieldTable correlation_fields() {
  FieldTable t;
  t.add("between", &Correlation::between).required().doc("two variables with distributions");
  t.add("rho", &Correlation::rho).required().at_least(-0.999999).at_most(0.999999).doc("coefficient of correlation");
  t.add("of", &Correlation::of)
      .one_of({"values", "ranks", "normal"})
      .doc("of the values (linear, by Nataf's transformation), of their ranks (Spearman), or of the normal variables "
           "behind them");
  return t;
}

FieldTable response_fields() {
  FieldTable t;
  t.add("name", &Response::name).required().doc("letters, digits and _: expressions use it");
  t.add("model", &Response::model)
      .doc("the model it is taken from, where there are several: the file's name without ending");
  t.add("channel", &Response::channel)
      .doc("channel of the run, a pattern with * and ?: the outermost of all that match");
  t.add("what", &Response::what)
      .one_of({"highest", "lowest", "largest", "time_of_highest", "time_of_lowest", "time_of_largest", "final",
               "initial", "mean", "path", "count", "time_of_first", "verdict"})
      .doc("extremes are located, largest is of the absolute value; mean and path (sum of all ways) are of the samples "
           "every output.step; count and "
           "time_of_first are of events; verdict: 0 hold, 1 open, 2 inspect, 3 reject");
  t.add("event", &Response::event).doc("pattern of events, as events.csv writes them, for count and time_of_first");
  t.add("element", &Response::element).doc("pattern of the elements whose events count; all if not given");
  t.add("otherwise", &Response::otherwise)
      .in("s")
      .doc("the time of an event that never happens; infinite if not given");
  t.add("expression", &Response::expression).doc("of variables and of responses that stand before it");
  t.add("unit", &Response::unit).doc("of an expression, for tables");
  return t;
}

FieldTable limit_state_fields() {
  FieldTable t;
  t.add("name", &LimitState::name).required().doc("letters, digits and _: expressions of later limit states use it");
  t.add("expression", &LimitState::expression)
      .required()
      .doc("of variables, responses and limit states before it; negative: failure");
  return t;
}

FieldTable history_fields() {
  FieldTable t;
  t.add("name", &History::name).required().doc("letters, digits and _");
  t.add("model", &History::model)
      .doc("the model it was measured of, where there are several: the file's name without ending");
  t.add("channel", &History::channel).required().doc("channel of the run that was measured: its name");
  t.add("file", &History::file).required().as(FieldType::file).doc("CSV file of the record");
  t.add("time", &History::time).doc("column of the times, by name or number");
  t.add("column", &History::column).doc("column of the measured values, by name or number");
  t.add("unit", &History::unit).doc("of the measured values; the channel's if not given");
  t.add("time_unit", &History::time_unit).doc("of the times; s if not given");
  t.add("from", &History::from).in("s").not_negative().doc("earlier rows are left out");
  t.add("to", &History::to).in("s").not_negative().doc("later rows are left out");
  t.add("noise", &History::noise_text)
      .as(FieldType::quantity)
      .doc("standard deviation of a measured value, in the unit of the channel or with one of its own; found from what "
           "is left over if not given");
  return t;
}

FieldTable sweep_fields() {
  FieldTable t;
  t.add("design", &SweepSettings::design)
      .one_of({"grid", "list", "one_at_a_time"})
      .doc("grid: all combinations; list: the first values of all, the second, ...; one at a time: the others stay at "
           "their value");
  t.add("points", &SweepSettings::points)
      .at_least(2)
      .at_most(1e6)
      .doc("of a variable with a range, or a distribution (from 5 % to 95 %)");
  return t;
}

FieldTable sample_fields() {
  FieldTable t;
  t.add("design", &SampleSettings::design)
      .one_of({"monte_carlo", "latin_hypercube", "sobol", "halton"})
      .doc("how samples are drawn");
  t.add("samples", &SampleSettings::samples).at_least(1).at_most(1e9).doc("their number");
  return t;
}

FieldTable reliability_fields() {
  using S = ReliabilitySettings;
  FieldTable t;
  t.add("methods", &S::methods)
      .doc(
          "monte_carlo, form, sorm, importance_sampling, directional, subset; the first that samples gives the answer");
  t.add("limit_states", &S::limit_states).doc("those that make the system; all if none is named");
  t.add("combination", &S::combination)
      .one_of({"any", "all"})
      .doc("the system fails where any of them does, or where all do");
  t.add("cov", &S::cov).positive().at_most(1).doc("sampling stops at this coefficient of variation of the probability");
  t.add("samples", &S::samples).at_least(1).at_most(1e10).doc("and at this number of samples, for each method");
  t.add("seconds", &S::seconds).in("s").positive().doc("and after this time, for each method");
  t.add("difference", &S::difference)
      .positive()
      .at_most(0.5)
      .doc("step of the difference quotients of FORM and SORM, in standard deviations");
  t.add("starts", &S::starts).at_least(1).at_most(1000).doc("of the search for design points");
  t.add("search_samples", &S::search_samples)
      .at_least(10)
      .at_most(1e7)
      .doc("for all searches for design points together; 300 and 50 more for each variable if not given");
  t.add("subset_samples", &S::subset_samples).at_least(100).at_most(1e7).doc("samples a level of subset simulation");
  t.add("repetitions", &S::repetitions)
      .at_least(2)
      .at_most(1000)
      .doc("of subset simulation; their scatter gives its interval");
  t.add("confidence", &S::confidence).at_least(0.5).at_most(0.9999).doc("of all intervals");
  return t;
}

FieldTable sensitivity_fields() {
  using S = SensitivitySettings;
  FieldTable t;
  t.add("method", &S::method).one_of({"elasticity", "morris", "sobol", "tornado"}).doc("how sensitivities are found");
  t.add("difference", &S::difference).positive().at_most(0.3).doc("relative step of elasticities; halved to check it");
  t.add("samples", &S::samples)
      .at_least(16)
      .at_most(1e7)
      .doc("base size of Sobol indices: the study takes (variables + 2) times as many");
  t.add("trajectories", &S::trajectories).at_least(4).at_most(1e5).doc("of Morris' screening");
  t.add("levels", &S::levels).at_least(4).at_most(100).doc("of the grid of Morris' screening, an even number");
  t.add("confidence", &S::confidence).at_least(0.5).at_most(0.9999).doc("of the intervals");
  return t;
}

FieldTable critical_fields() {
  using S = CriticalSettings;
  FieldTable t;
  t.add("variable", &S::variable).required().doc("whose critical values are looked for, within its range");
  t.add("expression", &S::expression).required().doc("of responses and variables: critical where it is zero");
  t.add("points", &S::points)
      .at_least(3)
      .at_most(1e6)
      .doc("of the first look along the range: closer pairs of crossings are not seen");
  t.add("tolerance", &S::tolerance).positive().at_most(0.01).doc("of the critical value, of the range");
  return t;
}

FieldTable map_fields() {
  using S = MapSettings;
  FieldTable t;
  t.add("variables", &S::variables).required().doc("two variables with ranges");
  t.add("expression", &S::expression).required().doc("of responses and variables: the border is where it is zero");
  t.add("step", &S::step).at_least(1e-4).at_most(0.2).doc("along the border, of the ranges");
  t.add("points", &S::points).at_least(3).at_most(1000).doc("a side, of the first look: smaller islands are not seen");
  t.add("tolerance", &S::tolerance).positive().at_most(0.01).doc("of the border's points, of the ranges");
  t.add("logarithmic", &S::is_logarithmic).doc("ranges are divided by ratios");
  return t;
}

FieldTable needs_fields() {
  FieldTable t;
  t.add("accuracy", &NeedsSettings::accuracy)
      .positive()
      .at_most(1)
      .doc("changes of responses up to this share of them do not matter");
  return t;
}

FieldTable fit_fields() {
  FieldTable t;
  t.add("starts", &FitSettings::starts)
      .at_least(1)
      .at_most(10000)
      .doc("places looked at first; searches begin at the best of them");
  t.add("iterations", &FitSettings::iterations).at_least(1).at_most(10000).doc("of one search, at most");
  t.add("confidence", &FitSettings::confidence).at_least(0.5).at_most(0.9999).doc("of the intervals");
  return t;
}

std::vector<StudyTable> study_tables() {
  return {{"", "top-level keys of a study file", false, header_fields()},
          {"variable", "a number that is not known, or that is to be tried", true, variable_fields("*")},
          {"correlation", "of two variables with distributions", true, correlation_fields()},
          {"response", "a number made of a run", true, response_fields()},
          {"limit_state", "fails where its expression is negative", true, limit_state_fields()},
          {"history", "a measured record that a fit compares a channel with", true, history_fields()},
          {"sweep", "settings of kind = \"sweep\"", false, sweep_fields()},
          {"sample", "settings of kind = \"sample\"", false, sample_fields()},
          {"reliability", "settings of kind = \"reliability\"", false, reliability_fields()},
          {"sensitivity", "settings of kind = \"sensitivity\"", false, sensitivity_fields()},
          {"critical", "settings of kind = \"critical\"", false, critical_fields()},
          {"map", "settings of kind = \"map\"", false, map_fields()},
          {"needs", "settings of kind = \"needs\"", false, needs_fields()},
          {"fit", "settings of kind = \"fit\"", false, fit_fields()}};
}

} // namespace steplap::study
