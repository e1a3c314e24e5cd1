#include "tools/study/critical.h"

#include "tools/study/crossing.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

namespace {

std::vector<std::string> names_of(const Study& study) {
  std::vector<std::string> names;
  for (const Variable& v : study.variables) names.push_back(v.name);
  return names;
}

// The expression along the variable, the others at their values.
class Line {
public:
  explicit Line(StudyRun& run)
      : run_(run), variable_(static_cast<std::size_t>(run.study().index_of_variable(run.study().critical.variable))),
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

struct Look {
  std::vector<double> x, g;
};

// Between two looks at which the expression comes nearer to zero than beside them it may touch it: looked at more
// closely.
void look_closer(Line& line, Look& look) {
  constexpr int k_parts = 8;
  std::vector<double> more;
  for (std::size_t i = 1; i + 1 < look.x.size(); ++i) {
    const double before = look.g[i - 1], here = look.g[i], after = look.g[i + 1];
    const bool is_one_side = (before < 0.0) == (here < 0.0) && (after < 0.0) == (here < 0.0);
    if (!is_one_side || !(std::abs(here) < std::abs(before) && std::abs(here) < std::abs(after))) continue;
    for (int k = 1; k < k_parts; ++k)
      for (const std::size_t from : {i - 1, i})
        more.push_back(look.x[from] + (look.x[from + 1] - look.x[from]) * k / k_parts);
  }
  if (more.empty()) return;
  std::sort(more.begin(), more.end());
  more.erase(std::unique(more.begin(), more.end()), more.end());
  const std::vector<double> values = line.at(more);
  std::vector<std::pair<double, double>> all;
  for (std::size_t i = 0; i < look.x.size(); ++i) all.emplace_back(look.x[i], look.g[i]);
  for (std::size_t i = 0; i < more.size(); ++i) all.emplace_back(more[i], values[i]);
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  look = {};
  for (const auto& [x, g] : all) look.x.push_back(x), look.g.push_back(g);
}

std::string monotonic_text(const Look& look) {
  bool rises = false, falls = false, is_known = true;
  for (std::size_t i = 1; i < look.g.size(); ++i) {
    is_known = is_known && !std::isnan(look.g[i]) && !std::isnan(look.g[i - 1]);
    rises = rises || look.g[i] > look.g[i - 1];
    falls = falls || look.g[i] < look.g[i - 1];
  }
  if (!is_known) return "may be monotonic or not: some runs gave no value";
  if (rises && falls) return "is not monotonic over the range: all crossings that the looks tell apart are given";
  return rises ? "rises all over the range" : falls ? "falls all over the range" : "is constant over the range";
}

// Where the expression is zero at two neighbouring looks, it is at all values between; neighbours are joined.
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

} // namespace

void check_critical(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const CriticalSettings& s = loaded.study.critical;
  const int v = loaded.study.index_of_variable(s.variable);
  if (v < 0)
    problems.push_back(
        {s.where, "there is no variable '" + s.variable + "'" + did_you_mean(s.variable, names_of(loaded.study))});
  else if (loaded.study.variables[static_cast<std::size_t>(v)].range.size() != 2)
    problems.push_back({loaded.study.variables[static_cast<std::size_t>(v)].where,
                        "variable '" + s.variable + "' needs a 'range' to look for critical values in"});
}

Answer run_critical(StudyRun& run) {
  const CriticalSettings& s = run.study().critical;
  const Variable& v = run.study().variables[static_cast<std::size_t>(run.study().index_of_variable(s.variable))];
  const double low = v.range[0], width = v.range[1] - v.range[0];
  Line line(run);
  Look look;
  for (long k = 0; k < s.points; ++k)
    look.x.push_back(k + 1 == s.points ? v.range[1]
                                       : low + width * static_cast<double>(k) / static_cast<double>(s.points - 1));
  look.g = line.at(look.x);
  look_closer(line, look);

  std::vector<Crossing> crossings;
  Answer answer;
  for (std::size_t i = 1; i < look.x.size(); ++i) {
    const double a = look.g[i - 1], b = look.g[i];
    if (std::isnan(a) || std::isnan(b)) continue;
    if (a == 0.0 && b == 0.0) {
      add_flat(look.x[i - 1], look.x[i], s.variable, run.evaluator.asked(), answer);
      continue;
    }
    if (a == 0.0 && i > 1) continue; // the end of the interval before
    if ((a < 0.0) != (b < 0.0) || a == 0.0 || b == 0.0) crossings.push_back({look.x[i - 1], look.x[i], a, b});
  }
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
    const auto known = std::find_if(look.g.begin(), look.g.end(), [](double g) { return !std::isnan(g); });
    f.status = known == look.g.end() ? "no run gave a value"
                                     : std::string("none in the range: the expression is ") +
                                           (*known < 0.0 ? "negative" : "positive") + " wherever it was looked at";
    answer.findings.push_back(f);
    answer.degrade(Standing::not_met);
  }
  answer.notes.push_back("The expression " + monotonic_text(look) + ".");
  if (line.bad() > 0) {
    answer.notes.push_back(
        std::to_string(line.bad()) +
        " runs did not reach their end or are not to be trusted: crossings beside them are not seen");
    answer.degrade(Standing::not_met);
  }
  return answer;
}

} // namespace steplap::study
