// Declares the fields of study files, except those of study kinds. Reader and schema use these tables.
#include "tools/study/kinds.h"

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
  t.add("model", &Study::models).doc("model files, relative to the study; none: limit states are expressions of variables");
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
  t.add("path", &Variable::paths).doc("fields of the model that get the value, by their paths: element.foot.stiffness");
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
  t.add("location", &Variable::location).in(unit).doc("shift of a lognormal, Weibull or exponential distribution, mode of a Gumbel's");
  t.add("lower", &Variable::lower).in(unit).doc("the distribution is truncated below");
  t.add("upper", &Variable::upper).in(unit).doc("the distribution is truncated above");
  t.add("measured", &Variable::measured)
      .as(FieldType::file)
      .doc("CSV file of measurements that the distribution is fitted to, in the unit in brackets in its header, or SI");
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
  t.add("model", &Response::model).doc("the model it is taken from, where there are several: the file's name without ending");
  t.add("channel", &Response::channel).doc("channel of the run, a pattern with * and ?: the outermost of all that match");
  t.add("what", &Response::what)
      .one_of({"highest", "lowest", "largest", "time_of_highest", "time_of_lowest", "time_of_largest", "final", "initial", "mean", "path",
               "count", "time_of_first", "verdict", "reserve", "reserve_of_cases"})
      .doc("extremes are located, largest is of the absolute value; mean and path (sum of all ways) are of the samples "
           "every output.step; count and "
           "time_of_first are of events; verdict: 0 hold, 1 open, 2 inspect, 3 reject; reserve: 0.2 where 20 % of the limit that is used "
           "most is left, with its estimated error, negative unless the verdict is hold; reserve_of_cases: the least of all load cases of "
           "the "
           "model ([[case]])");
  t.add("event", &Response::event).doc("pattern of events, as events.csv writes them, for count and time_of_first");
  t.add("element", &Response::element).doc("pattern of the elements whose events count; all if not given");
  t.add("otherwise", &Response::otherwise).in("s").doc("the time of an event that never happens; infinite if not given");
  t.add("expression", &Response::expression).doc("of variables and of responses that stand before it");
  t.add("unit", &Response::unit).doc("of an expression, for tables");
  return t;
}

FieldTable limit_state_fields() {
  FieldTable t;
  t.add("name", &LimitState::name).required().doc("letters, digits and _: expressions of later limit states use it");
  t.add("expression", &LimitState::expression).required().doc("of variables, responses and limit states before it; negative: failure");
  return t;
}

FieldTable history_fields() {
  FieldTable t;
  t.add("name", &History::name).required().doc("letters, digits and _");
  t.add("model", &History::model).doc("the model it was measured of, where there are several: the file's name without ending");
  t.add("channel", &History::channel).required().doc("channel of the run that was measured: its name");
  t.add("file", &History::file).required().as(FieldType::file).doc("CSV file of the record");
  t.add("time", &History::time).doc("column of the times, by name or number");
  t.add("column", &History::column).doc("column of the measured values, by name or number");
  t.add("unit", &History::unit).doc("of the measured values; if not given that in brackets in the header, or the channel's");
  t.add("time_unit", &History::time_unit).doc("of the times; if not given that in brackets in the header, or s");
  t.add("from", &History::from).in("s").not_negative().doc("earlier rows are left out");
  t.add("to", &History::to).in("s").not_negative().doc("later rows are left out");
  t.add("noise", &History::noise_text)
      .as(FieldType::quantity)
      .doc("standard deviation of a measured value, in the unit of the channel or with one of its own; found from what "
           "is left over if not given");
  return t;
}

FieldTable evidence_fields() {
  FieldTable t;
  t.add("held", &Evidence::is_held).doc("true: no limit state failed; false: one did");
  t.add("times", &Evidence::times).at_least(1).at_most(1000).doc("number of such loads");
  t.add("anew", &Evidence::anew).doc("random variables that have another, independent value in each load: the shock, not the clamping");
  t.add("set", &Evidence::settings).doc("values that were measured: \"shock = 0.8\", with a unit if need be");
  t.add("limit_states", &Evidence::limit_states).doc("of another model, of that load; those of the study if none is named");
  return t;
}

std::vector<StudyTable> study_tables() {
  std::vector<StudyTable> tables{{"", "top-level keys of a study file", false, header_fields()},
                                 {"variable", "a number that is not known, or that is to be tried", true, variable_fields("*")},
                                 {"correlation", "of two variables with distributions", true, correlation_fields()},
                                 {"response", "a number made of a run", true, response_fields()},
                                 {"limit_state", "fails where its expression is negative", true, limit_state_fields()},
                                 {"history", "a measured record that a fit compares a channel with", true, history_fields()},
                                 {"evidence", "loads of the past that have been held, or not", true, evidence_fields()}};
  for (const StudyKind& kind : study_kinds()) tables.push_back({kind.name, "settings of kind = \"" + kind.name + "\"", false, kind.fields});
  return tables;
}

} // namespace steplap::study
