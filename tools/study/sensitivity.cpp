#include "tools/study/sensitivity.h"

#include "tools/study/counter_random.h"
#include "tools/study/kinds.h"
#include "tools/study/random_variables.h"

#include <openturns/ComposedDistribution.hxx>
#include <openturns/Log.hxx>
#include <openturns/MartinezSensitivityAlgorithm.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/SobolIndicesExperiment.hxx>
#include <openturns/Uniform.hxx>

#include <algorithm>
#include <cmath>

namespace steplap::study {

namespace {

FieldTable sensitivity_fields() {
  using S = SensitivitySettings;
  FieldTable t;
  t.add("method", &S::method).one_of({"elasticity", "morris", "sobol", "tornado"}).doc("how sensitivities are found");
  t.add("difference", &S::difference).positive().at_most(0.3).doc("relative step of elasticities; halved to check it");
  t.add("samples", &S::samples).at_least(16).at_most(1e7).doc("base size of Sobol indices: the study takes (variables + 2) times as many");
  t.add("trajectories", &S::trajectories).at_least(4).at_most(1e5).doc("of Morris' screening");
  t.add("levels", &S::levels).at_least(4).at_most(100).doc("of the grid of Morris' screening, an even number");
  t.add("confidence", &S::confidence).at_least(0.5).at_most(0.9999).doc("of the intervals");
  return t;
}

// Returns responses and limit states of a sample; NaN if the run has no result.
std::vector<double> numbers_of(const StoredSample& sample, std::size_t count) {
  return sample.outcome.status == SampleStatus::ok ? sample.outcome.numbers : std::vector<double>(count, std::nan(""));
}

std::string in_words(const char* format, double a, double b) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

// --- elasticities -------------------------------------------------------------------------------

// Difference quotients of one response with respect to one variable, with steps h, h/2, h/4.
struct Quotients {
  double central[3], left[3], right[3];
};

struct Derivative {
  double value = 0.0, error = 0.0;
  std::string status;
};

// Applies Richardson extrapolation twice. The error is the difference of the last two values plus rounding of the run.
Derivative derivative_of(const Quotients& q, double noise) {
  Derivative d;
  const double first = (4.0 * q.central[1] - q.central[0]) / 3.0, second = (4.0 * q.central[2] - q.central[1]) / 3.0;
  d.value = second;
  d.error = std::abs(second - first) + noise;
  // One-sided quotients of a smooth response converge to each other in proportion to the step. If they do not, there is a kink.
  const double gap = std::abs(q.right[0] - q.left[0]), closer = std::abs(q.right[2] - q.left[2]);
  const double size = std::max({std::abs(q.left[2]), std::abs(q.right[2]), 1e-300}); // 1e-300: no difference at all
  if (!std::isfinite(d.value)) d.status = "a run next to the point has no result";
  else if (closer > 0.5 * gap && closer > 1e-3 * size && closer > 10.0 * noise)
    d.status = in_words("kink, or jump: to the left %.6g, to the right %.6g; this is no derivative", q.left[2], q.right[2]);
  else if (size > 1e-300 && d.error > 0.05 * size) d.status = "the difference steps disagree: the error is as large as the value";
  return d;
}

Answer elasticities(StudyRun& run) {
  const double run_error = run_error_of(run.loaded);
  const std::vector<double>& nominal = run.law.nominal();
  const std::size_t n = nominal.size(), count = run.loaded.number_count();
  const double h = settings_of<SensitivitySettings>(run.study()).difference;
  std::vector<double> points(nominal);
  std::vector<double> steps(n);
  for (std::size_t i = 0; i < n; ++i) {
    steps[i] = h * (nominal[i] != 0.0 ? std::abs(nominal[i]) : 1.0);
    for (int level = 0; level < 3; ++level)
      for (const double side : {-1.0, 1.0}) {
        points.insert(points.end(), nominal.begin(), nominal.end());
        points[points.size() - n + i] += side * steps[i] / (1 << level);
      }
  }
  run.evaluator.expect(static_cast<long>(points.size() / run.law.nominal().size()));
  const std::vector<StoredSample>& rows = run.evaluator.evaluate(points);
  Answer answer;
  const std::vector<std::string> names = run.loaded.number_names();
  for (std::size_t r = 0; r < count; ++r) {
    const double here = numbers_of(rows[0], count)[r];
    answer.findings.push_back({"elasticity", names[r], "value", here, std::nan(""), std::nan(""), run.evaluator.asked()});
    for (std::size_t i = 0; i < n; ++i) {
      Quotients q{};
      for (std::size_t level = 0; level < 3; ++level) {
        const double below = numbers_of(rows[1 + 6 * i + 2 * level], count)[r], above = numbers_of(rows[2 + 6 * i + 2 * level], count)[r];
        // Differences of the values actually run, which include the rounding of nominal ± h.
        const double left = nominal[i] - rows[1 + 6 * i + 2 * level].values[i], right = rows[2 + 6 * i + 2 * level].values[i] - nominal[i];
        q.central[level] = (above - below) / (left + right);
        q.left[level] = (here - below) / left;
        q.right[level] = (above - here) / right;
      }
      const Derivative d = derivative_of(q, run_error * std::abs(here) / (steps[i] / 4.0));
      const bool is_relative = here != 0.0 && nominal[i] != 0.0;
      const double scale = is_relative ? nominal[i] / here : 1.0;
      Finding f{"elasticity", names[r], (is_relative ? "elasticity to " : "derivative by ") + run.study().variables[i].name,
                scale * d.value};
      f.low = f.value - std::abs(scale) * d.error;
      f.high = f.value + std::abs(scale) * d.error;
      f.samples = run.evaluator.asked();
      f.status = d.status;
      if (!std::isfinite(f.value)) answer.degrade(Standing::not_met);
      answer.findings.push_back(f);
    }
  }
  return answer;
}

// --- Morris' screening --------------------------------------------------------------------------

// Returns the probability at which a distribution is evaluated: the tails of unbounded ones are excluded.
double without_tails(double cube) { return std::clamp(cube, 0.01, 0.99); }

// Computes the values of the variables at a point of the unit cube.
void values_at_cube(const StudyRun& run, const std::vector<double>& cube, std::vector<double>& points) {
  const std::size_t n = run.law.dimension();
  std::vector<double> u(n), values(run.law.nominal().size());
  for (std::size_t d = 0; d < n; ++d) u[d] = normal_quantile(without_tails(cube[d]));
  run.law.values_at(u.data(), values.data());
  for (std::size_t d = 0; d < n; ++d) { // variables with a range instead of a distribution
    const std::size_t i = run.law.random()[d];
    const Variable& v = run.study().variables[i];
    if (!v.has_distribution()) values[i] = v.range[0] + cube[d] * (v.range[1] - v.range[0]);
  }
  points.insert(points.end(), values.begin(), values.end());
}

struct Effects {
  std::vector<double> all;
  [[nodiscard]] double mean(bool is_absolute) const {
    double sum = 0.0;
    for (const double e : all) sum += is_absolute ? std::abs(e) : e;
    return all.empty() ? std::nan("") : sum / static_cast<double>(all.size());
  }
  [[nodiscard]] double deviation(bool is_absolute) const {
    const double m = mean(is_absolute);
    double sum = 0.0;
    for (const double e : all) sum += std::pow((is_absolute ? std::abs(e) : e) - m, 2);
    return all.size() < 2 ? std::nan("") : std::sqrt(sum / static_cast<double>(all.size() - 1));
  }
};

// Trajectories on a grid of levels. Each changes every variable once, by half the levels, in random order.
struct Trajectories {
  struct Move {
    std::size_t variable;
    double step; // signed change of the variable's probability, or of its place in its range
  };
  // values of all variables at all points, trajectory by trajectory; each has one point more than moves
  std::vector<double> points;
  std::vector<std::vector<Move>> moves; // moves of each trajectory
};

Trajectories drawn_trajectories(const StudyRun& run, const SensitivitySettings& s) {
  const std::size_t n = run.law.dimension();
  const CounterRandom random(static_cast<std::uint64_t>(run.study().seed), 6);
  const double p = static_cast<double>(s.levels), jump = p / (2.0 * (p - 1.0));
  Trajectories drawn;
  for (long t = 0; t < s.trajectories; ++t) {
    const auto draw = [&](std::size_t k) { return random.uniform(static_cast<std::uint64_t>(t), static_cast<std::uint32_t>(k)); };
    std::vector<double> cube(n);
    std::vector<Trajectories::Move> moves(n); // on the grid
    for (std::size_t d = 0; d < n; ++d) {
      // a point in the lower half of the levels; moves in the other direction start in the upper half
      cube[d] = std::floor(draw(d) * p / 2.0) / (p - 1.0);
      moves[d] = {d, draw(n + d) < 0.5 ? -jump : jump};
      if (moves[d].step < 0.0) cube[d] += jump;
    }
    for (std::size_t d = n; d-- > 1;) std::swap(moves[d], moves[static_cast<std::size_t>(draw(2 * n + d) * static_cast<double>(d + 1))]);
    values_at_cube(run, cube, drawn.points);
    for (Trajectories::Move& move : moves) {
      double& place = cube[move.variable];
      const double from = place;
      place += move.step;
      values_at_cube(run, cube, drawn.points);
      if (run.study().variables[run.law.random()[move.variable]].has_distribution()) move.step = without_tails(place) - without_tails(from);
    }
    drawn.moves.push_back(std::move(moves));
  }
  return drawn;
}

// Returns the elementary effects of each variable on each number: the change divided by the step that was made. Unknown effects are counted
// in `missing`.
std::vector<std::vector<Effects>> effects_of(const Trajectories& drawn, const std::vector<StoredSample>& rows, std::size_t count,
                                             std::size_t n, long& missing) {
  std::vector<std::vector<Effects>> effects(count, std::vector<Effects>(n));
  for (std::size_t t = 0; t < drawn.moves.size(); ++t)
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t row = t * (n + 1) + k;
      const Trajectories::Move& move = drawn.moves[t][k];
      const std::vector<double> before = numbers_of(rows[row], count), after = numbers_of(rows[row + 1], count);
      for (std::size_t r = 0; r < count; ++r) {
        const double e = (after[r] - before[r]) / move.step;
        if (std::isfinite(e)) effects[r][move.variable].all.push_back(e);
        else ++missing;
      }
    }
  return effects;
}

Answer morris(StudyRun& run) {
  const auto& s = settings_of<SensitivitySettings>(run.study());
  const std::size_t n = run.law.dimension(), count = run.loaded.number_count();
  const Trajectories drawn = drawn_trajectories(run, s);
  run.evaluator.expect(static_cast<long>(drawn.points.size() / run.law.nominal().size()));
  long missing = 0;
  const std::vector<std::vector<Effects>> effects = effects_of(drawn, run.evaluator.evaluate(drawn.points), count, n, missing);
  Answer answer;
  const std::vector<std::string> names = run.loaded.number_names();
  for (std::size_t r = 0; r < count; ++r)
    for (std::size_t d = 0; d < n; ++d) {
      const Effects& e = effects[r][d];
      const std::string& variable = run.study().variables[run.law.random()[d]].name;
      const double size = static_cast<double>(e.all.size());
      const double half =
          e.all.size() < 2 ? std::nan("") : student_quantile(size - 1.0, 0.5 * (1.0 + s.confidence)) * e.deviation(true) / std::sqrt(size);
      const std::string status = missing ? "effects next to runs without result are left out" : "";
      answer.findings.push_back({"morris", names[r], "mu* of " + variable, e.mean(true), std::max(0.0, e.mean(true) - half),
                                 e.mean(true) + half, run.evaluator.asked(), status});
      answer.findings.push_back(
          {"morris", names[r], "sigma of " + variable, e.deviation(false), std::nan(""), std::nan(""), run.evaluator.asked(), status});
    }
  if (missing) answer.degrade(Standing::not_met);
  if (missing) answer.notes.push_back(std::to_string(missing) + " effects are not known: neighbouring runs have no result");
  return answer;
}

// --- Sobol indices --------------------------------------------------------------------------------

// Interval of the correlation coefficient r of two columns of `output`, each `size` rows from `a` and `b`. Responses are seldom normal, as
// Fisher's 1/√n assumes: the scatter of r is that of its influence function, x y − r (x² + y²)/2 with standardised x and y. The interval is
// formed on the scale atanh r, so that it stays within −1 and 1. If one row carries much of the scatter, rarer rows that carry more are missing,
// and the interval is too short. (Of 500 samples of exp(2 x), 95 %: Fisher's misses 49 of 120 exact indices, this one 26, 8 of them with the
// remark.)
struct CorrelationFound {
  Interval interval;
  bool is_uneven = false;
};
CorrelationFound correlation_of(const OT::Sample& output, std::size_t a, std::size_t b, std::size_t size, std::size_t response,
                                double confidence) {
  const double n = static_cast<double>(size);
  constexpr double k_uneven = 0.3; // share of one row; of 500 normal responses the largest has 0.06
  double mean_a = 0.0, mean_b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0, scatter = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    mean_a += output(a + i, response) / n;
    mean_b += output(b + i, response) / n;
  }
  const auto for_all = [&](const auto& use) {
    for (std::size_t i = 0; i < size; ++i) use(output(a + i, response) - mean_a, output(b + i, response) - mean_b);
  };
  for_all([&](double x, double y) { aa += x * x, bb += y * y, ab += x * y; });
  const double r = std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0);
  for_all([&](double x, double y) {
    const double square = std::pow(x * y / std::sqrt(aa * bb) - 0.5 * r * (x * x / aa + y * y / bb), 2);
    scatter += square;
    largest = std::max(largest, square);
  });
  if (!(std::abs(r) < 1.0)) return {{r, r}};
  const double z = std::atanh(r), half = normal_quantile(0.5 * (1.0 + confidence)) * std::sqrt(scatter) / (1.0 - r * r);
  return {{std::tanh(z - half), std::tanh(z + half)}, largest > k_uneven * scatter};
}

Answer sobol(StudyRun& run) {
  OT::Log::Show(OT::Log::NONE);
  const auto& s = settings_of<SensitivitySettings>(run.study());
  const std::size_t n = run.law.dimension(), count = run.loaded.number_count();
  OT::RandomGenerator::SetSeed(static_cast<OT::UnsignedInteger>(run.study().seed));
  const OT::ComposedDistribution cube(OT::ComposedDistribution::DistributionCollection(n, OT::Uniform(0.0, 1.0)));
  const OT::Sample design = OT::SobolIndicesExperiment(cube, static_cast<OT::UnsignedInteger>(s.samples), false).generate();
  OT::Sample output(design.getSize(), count);
  run.evaluator.expect(static_cast<long>(design.getSize()));
  constexpr std::size_t k_block = 10000;
  long bad = 0;
  std::vector<double> points, u(n), values(run.law.nominal().size());
  for (std::size_t from = 0; from < design.getSize(); from += k_block) {
    const std::size_t part = std::min<std::size_t>(k_block, design.getSize() - from);
    points.clear();
    for (std::size_t i = 0; i < part; ++i) {
      for (std::size_t d = 0; d < n; ++d) u[d] = normal_quantile(std::clamp(design(from + i, d), 1e-16, 1.0 - 1e-16));
      run.law.values_at(u.data(), values.data());
      points.insert(points.end(), values.begin(), values.end());
    }
    const std::vector<StoredSample>& rows = run.evaluator.evaluate(points);
    for (std::size_t i = 0; i < part; ++i) {
      bad += rows[i].outcome.status != SampleStatus::ok;
      for (std::size_t r = 0; r < count; ++r) output(from + i, r) = rows[i].outcome.numbers[r];
    }
  }
  Answer answer;
  const std::vector<std::string> names = run.loaded.number_names();
  for (std::size_t r = 0; r < count; ++r) {
    bool is_whole = bad == 0;
    for (std::size_t i = 0; i < output.getSize() && is_whole; ++i) is_whole = std::isfinite(output(i, r));
    const auto add = [&](const char* order, std::size_t d, double value, double low, double high, const std::string& status) {
      answer.findings.push_back({"sobol", names[r], std::string(order) + " of " + run.study().variables[run.law.random()[d]].name, value,
                                 low, high, run.evaluator.asked(), status});
    };
    try {
      if (!is_whole) throw OT::NotDefinedException(HERE);
      OT::MartinezSensitivityAlgorithm indices(design, output.getMarginal(r), static_cast<OT::UnsignedInteger>(s.samples));
      const OT::Point first = indices.getFirstOrderIndices(), total = indices.getTotalOrderIndices();
      const auto size = static_cast<std::size_t>(s.samples);
      // The design has samples A, B, and for each variable E_d: A with this variable of B. Martinez' indices are the correlation of B and
      // E_d, and one minus that of A and E_d.
      const auto correlation = [&](std::size_t with, std::size_t d) {
        return correlation_of(output, with * size, (2 + d) * size, size, r, s.confidence);
      };
      const auto remark = [](const CorrelationFound& c) {
        return c.is_uneven ? "one sample carries a third of the scatter: the interval is too short" : "";
      };
      for (std::size_t d = 0; d < n; ++d) {
        const CorrelationFound c = correlation(1, d);
        add("first order", d, first[d], c.interval.low, c.interval.high, remark(c));
      }
      for (std::size_t d = 0; d < n; ++d) {
        const CorrelationFound c = correlation(0, d);
        add("total", d, total[d], 1.0 - c.interval.high, 1.0 - c.interval.low, remark(c));
      }
    } catch (const OT::Exception&) {
      const std::string why = is_whole ? "it does not vary" : "some runs have no result, and indices need all of them";
      for (std::size_t d = 0; d < n; ++d) add("first order", d, std::nan(""), std::nan(""), std::nan(""), why);
      answer.degrade(is_whole ? Standing::not_met : Standing::not_trusted);
    }
  }
  return answer;
}

// --- tornado --------------------------------------------------------------------------------------

Answer tornado(StudyRun& run) {
  const std::size_t n = run.law.dimension(), count = run.loaded.number_count();
  std::vector<double> points(run.law.nominal());
  for (std::size_t d = 0; d < n; ++d)
    for (const bool is_high : {false, true}) {
      points.insert(points.end(), run.law.nominal().begin(), run.law.nominal().end());
      const std::size_t i = run.law.random()[d];
      const Variable& v = run.study().variables[i];
      points[points.size() - run.law.nominal().size() + i] =
          v.has_distribution() ? run.law.quantile(d, is_high ? 0.95 : 0.05) : v.range[is_high];
    }
  run.evaluator.expect(static_cast<long>(points.size() / run.law.nominal().size()));
  const std::vector<StoredSample>& rows = run.evaluator.evaluate(points);
  Answer answer;
  const std::vector<std::string> names = run.loaded.number_names();
  for (std::size_t r = 0; r < count; ++r) {
    const double nominal = numbers_of(rows[0], count)[r];
    answer.findings.push_back({"tornado", names[r], "value", nominal, std::nan(""), std::nan(""), run.evaluator.asked()});
    std::vector<Finding> bars;
    for (std::size_t d = 0; d < n; ++d) {
      const double low = numbers_of(rows[1 + 2 * d], count)[r], high = numbers_of(rows[2 + 2 * d], count)[r];
      Finding f{"tornado",
                names[r],
                "swing by " + run.study().variables[run.law.random()[d]].name,
                std::abs(high - low),
                low,
                high,
                run.evaluator.asked()};
      if (!std::isfinite(f.value)) f.status = "a run at one end has no result";
      else if ((low - nominal) * (high - nominal) > 0.0) f.status = "both ends lie on one side of the nominal value";
      if (!std::isfinite(f.value)) answer.degrade(Standing::not_met);
      bars.push_back(f);
    }
    std::stable_sort(bars.begin(), bars.end(), [](const Finding& a, const Finding& b) { return a.value > b.value; });
    answer.findings.insert(answer.findings.end(), bars.begin(), bars.end());
  }
  answer.notes.emplace_back("Each bar reaches from the response at the variable's 5 % value to that at its 95 % value "
                            "(or the ends of its range), the others at their values.");
  return answer;
}

} // namespace

double run_error_of(const LoadedStudy& loaded) {
  constexpr double k_formula = 1e-15, k_located = 1e-10, k_default = 1e-8;
  double error = k_formula;
  for (const auto& model : loaded.models) {
    const SimulationSettings& s = model->given.simulation;
    error = std::max(error, s.step ? k_located : s.tolerance.value_or(k_default));
  }
  return error;
}

namespace {

void check_sensitivity(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const auto& s = settings_of<SensitivitySettings>(loaded.study);
  if (loaded.number_count() == 0) problems.push_back({loaded.study.where, "a study of the kind 'sensitivity' needs a [[response]]"});
  if (s.method == "elasticity") {
    if (loaded.study.variables.empty()) problems.push_back({loaded.study.where, "a study of the kind 'sensitivity' needs a [[variable]]"});
    return;
  }
  check_random(loaded, true, problems);
  if (s.method == "morris" && s.levels % 2) problems.push_back({s.where, "'levels' of Morris' screening must be even"});
  if (!loaded.study.correlations.empty())
    problems.push_back(
        {loaded.study.correlations.front().where, "'" + s.method + "' takes variables one by one: they must be independent"});
}

Answer run_sensitivity(StudyRun& run) {
  const std::string& method = settings_of<SensitivitySettings>(run.study()).method;
  if (method == "morris") return morris(run);
  if (method == "sobol") return sobol(run);
  return method == "tornado" ? tornado(run) : elasticities(run);
}

Drawn sensitivity_drawn(const ShownSettings& settings) {
  return is_only(settings, "method", "sobol") ? Drawn::by_design : Drawn::otherwise;
}

} // namespace

StudyKind sensitivity_kind() {
  StudyKind kind;
  kind.name = "sensitivity";
  kind.doc = "how much each variable matters: elasticities, Morris' screening, Sobol indices, a tornado";
  kind.fields = sensitivity_fields();
  kind.holds<SensitivitySettings>();
  kind.shown = {"method", "confidence"};
  kind.parts = {{"base", "value", UnitOf::subject},
                {"elasticity", "elasticity to "},
                {"elasticity", "derivative by ", UnitOf::quotient},
                {"mu*", "mu* of ", UnitOf::subject},
                {"sigma", "sigma of ", UnitOf::subject, 4},
                {"first order", "first order of "},
                {"total", "total of "},
                {"swing", "swing by ", UnitOf::subject}};
  kind.check = check_sensitivity;
  kind.run = run_sensitivity;
  kind.drawn = sensitivity_drawn;
  return kind;
}

} // namespace steplap::study
