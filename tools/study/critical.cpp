// Study kind "critical": finds the values of one variable at which an expression is zero.
#include "tools/study/kinds.h"

#include "tools/study/crossing.h"
#include "tools/study/line_scan.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

namespace {

/// Settings of a "critical" study.
struct CriticalSettings : KindSettings {
  std::string variable;
  std::string expression;  ///< the expression whose zeros are searched
  long points = 21;        ///< number of points of the first scan
  double tolerance = 1e-9; ///< tolerance of a zero, relative to the variable's range
};

FieldTable critical_fields() {
  using S = CriticalSettings;
  FieldTable t;
  t.add("variable", &S::variable).required().doc("whose critical values are looked for, within its range");
  t.add("expression", &S::expression).required().doc("of responses and variables: critical where it is zero");
  t.add("points", &S::points).at_least(3).at_most(1e6).doc("of the first look along the range: closer pairs of crossings are not seen");
  t.add("tolerance", &S::tolerance).positive().at_most(0.01).doc("of the critical value, of the range");
  return t;
}

std::vector<std::string> names_of(const Study& study) {
  std::vector<std::string> names;
  for (const Variable& v : study.variables) names.push_back(v.name);
  return names;
}

// The expression as a function of the variable, with all other variables at their nominal values.
class Line {
public:
  explicit Line(StudyRun& run)
      : run_(run), variable_(static_cast<std::size_t>(run.study().index_of_variable(settings_of<CriticalSettings>(run.study()).variable))),
        place_(static_cast<std::size_t>(run.loaded.index_of_number("critical"))) {}

  std::vector<double> at(const std::vector<double>& xs) {
    std::vector<double> points;
    for (const double x : xs) {
      points.insert(points.end(), run_.law.nominal().begin(), run_.law.nominal().end());
      points[points.size() - run_.law.nominal().size() + variable_] = x;
    }
    std::vector<double> values;
    for (const StoredSample& sample : run_.evaluator.evaluate(points)) {
      const bool is_ok = sample.outcome.status == SampleStatus::ok;
      values.push_back(is_ok ? sample.outcome.numbers[place_] : std::nan(""));
      bad_ += !is_ok;
    }
    return values;
  }
  [[nodiscard]] long bad() const { return bad_; }

private:
  StudyRun& run_;
  std::size_t variable_, place_;
  long bad_ = 0;
};

// Adds three points between neighbouring points at which the expression is zero. They show whether it is zero on the whole interval or at
// its ends only.
void sample_flats(const LineFunction& line, LineSamples& line_samples) {
  constexpr int k_parts = 4;
  std::vector<double> more;
  for (std::size_t i = 1; i < line_samples.x.size(); ++i)
    for (int k = 1; k < k_parts && line_samples.g[i - 1] == 0.0 && line_samples.g[i] == 0.0; ++k)
      more.push_back(line_samples.x[i - 1] + (line_samples.x[i] - line_samples.x[i - 1]) * k / k_parts);
  if (!more.empty()) add_samples(line, std::move(more), line_samples);
}

std::string where_nearest(const LineSamples& line_samples) {
  std::size_t best = line_samples.g.size();
  for (std::size_t i = 0; i < line_samples.g.size(); ++i)
    if (!std::isnan(line_samples.g[i]) && (best == line_samples.g.size() || std::abs(line_samples.g[i]) < std::abs(line_samples.g[best])))
      best = i;
  char text[80];
  std::snprintf(text, sizeof text, "; nearest to zero at %.6g, where it is %.3g", line_samples.x[best], line_samples.g[best]);
  return text;
}

std::string monotonic_text(const LineSamples& line_samples) {
  bool rises = false, falls = false, is_known = true;
  for (std::size_t i = 1; i < line_samples.g.size(); ++i) {
    is_known = is_known && !std::isnan(line_samples.g[i]) && !std::isnan(line_samples.g[i - 1]);
    rises = rises || line_samples.g[i] > line_samples.g[i - 1];
    falls = falls || line_samples.g[i] < line_samples.g[i - 1];
  }
  if (!is_known) return "may be monotonic or not: some runs gave no value";
  if (rises && falls) return "is not monotonic over the range: all crossings that the points resolve are given";
  return rises ? "rises all over the range" : falls ? "falls all over the range" : "is constant over the range";
}

// Reports an interval on which the expression is zero as one finding without a critical value. Extends the previous finding if both
// intervals are adjacent.
void add_flat(double low, double high, const std::string& variable, long samples, Answer& answer) {
  answer.degrade(Standing::not_met);
  if (!answer.findings.empty() && answer.findings.back().high == low) {
    answer.findings.back().high = high;
    return;
  }
  Finding f{"critical", variable, "critical value", std::nan(""), low, high, samples};
  f.status = "the expression is zero all over this interval: no value of it is critical";
  answer.findings.push_back(f);
}

// Returns the intervals at whose ends the expression has different signs, and single points at which it is zero.
std::vector<Crossing> crossings_of(const LineSamples& line_samples, const std::string& variable, long samples, Answer& answer) {
  std::vector<Crossing> crossings;
  const auto is_zero = [&](std::size_t i) { return i < line_samples.g.size() && line_samples.g[i] == 0.0; };
  for (std::size_t i = 0; i < line_samples.x.size(); ++i) {
    const double here = line_samples.g[i];
    if (here == 0.0 && !is_zero(i + 1) && !(i > 0 && is_zero(i - 1)))
      crossings.push_back({line_samples.x[i], line_samples.x[i], here, here});
    if (i + 1 == line_samples.x.size()) break;
    const double next = line_samples.g[i + 1];
    if (here == 0.0 && next == 0.0) add_flat(line_samples.x[i], line_samples.x[i + 1], variable, samples, answer);
    if (here * next < 0.0) crossings.push_back({line_samples.x[i], line_samples.x[i + 1], here, next});
  }
  return crossings;
}

// Adds a note if there are fewer than three points per crossing: two crossings between neighbouring points may then be missed.
void note_if_too_few_points(std::size_t crossings, long points, Answer& answer) {
  constexpr long k_points_per_crossing = 3; // required points per crossing
  if (crossings < 3 || k_points_per_crossing * static_cast<long>(crossings) < points) return;
  answer.notes.push_back(std::to_string(crossings) + " crossings among " + std::to_string(points) +
                         " points: there may be more between them; raise 'points'");
  answer.degrade(Standing::not_met);
}

// Adds the expression as a limit state, so that the evaluator computes it.
void add_critical_expression(LoadedStudy& loaded) {
  const auto& s = settings_of<CriticalSettings>(loaded.study);
  loaded.study.limit_states.push_back({"critical", s.expression, s.where, true});
}

void check_critical(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const auto& s = settings_of<CriticalSettings>(loaded.study);
  const int v = loaded.study.index_of_variable(s.variable);
  if (v < 0) problems.push_back({s.where, "there is no variable '" + s.variable + "'" + did_you_mean(s.variable, names_of(loaded.study))});
  else if (loaded.study.variables[static_cast<std::size_t>(v)].range.size() != 2)
    problems.push_back({loaded.study.variables[static_cast<std::size_t>(v)].where,
                        "variable '" + s.variable + "' needs a 'range' to look for critical values in"});
}

Answer run_critical(StudyRun& run) {
  const auto& s = settings_of<CriticalSettings>(run.study());
  const Variable& v = run.study().variables[static_cast<std::size_t>(run.study().index_of_variable(s.variable))];
  const double width = v.range[1] - v.range[0];
  Line line(run);
  const LineFunction function = [&line](const std::vector<double>& xs) { return line.at(xs); };
  LineSamples line_samples;
  add_samples(function, evenly_spaced(v.range[0], v.range[1], s.points), line_samples);
  sample_flats(function, line_samples);
  refine_turns(function, line_samples);

  Answer answer;
  std::vector<Crossing> crossings = crossings_of(line_samples, s.variable, run.evaluator.asked(), answer);
  note_if_too_few_points(crossings.size(), s.points, answer);
  close_crossings(crossings, s.tolerance * width,
                  [&](const std::vector<std::size_t>&, const std::vector<double>& at) { return line.at(at); });

  for (const Crossing& c : crossings) {
    Finding f{"critical", s.variable, "critical value", c.root(), c.low, c.high, run.evaluator.asked()};
    if (c.is_jump) f.status = "the expression jumps past zero there: it is discontinuous";
    if (c.is_bad) f.status = "a run between both ends gave no value: closed in no further";
    if (c.is_bad) answer.degrade(Standing::not_met);
    answer.findings.push_back(f);
  }
  if (answer.findings.empty()) {
    Finding f{"critical", s.variable, "critical value"};
    f.samples = run.evaluator.asked();
    const auto known = std::find_if(line_samples.g.begin(), line_samples.g.end(), [](double g) { return !std::isnan(g); });
    f.status = known == line_samples.g.end()
                   ? "no run gave a value"
                   : std::string("none in the range: the expression is ") + (*known < 0.0 ? "negative" : "positive") +
                         " wherever it was looked at" + where_nearest(line_samples);
    answer.findings.push_back(f);
    answer.degrade(Standing::not_met);
  }
  answer.notes.push_back("The expression " + monotonic_text(line_samples) + ".");
  char text[200];
  std::snprintf(text, sizeof text,
                "Looks lie %.3g apart: two crossings nearer to each other may lie between them unseen, where nothing "
                "points to them; 'points' looks closer.",
                width / static_cast<double>(s.points - 1));
  answer.notes.emplace_back(text);
  if (line.bad() > 0) {
    answer.notes.push_back(std::to_string(line.bad()) +
                           " runs did not reach their end or are not to be trusted: crossings next to them are not found");
    answer.degrade(Standing::not_met);
  }
  return answer;
}

} // namespace

StudyKind critical_kind() {
  StudyKind kind;
  kind.name = "critical";
  kind.doc = "the values of a variable at which an expression is zero";
  kind.fields = critical_fields();
  kind.holds<CriticalSettings>();
  kind.shown = {"variable"};
  kind.parts = {{"critical", "critical value", UnitOf::subject}};
  kind.prepare = add_critical_expression;
  kind.check = check_critical;
  kind.run = run_critical;
  return kind;
}

} // namespace steplap::study
