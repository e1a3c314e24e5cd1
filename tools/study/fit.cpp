// Study kind "fit": identifies parameters from measured histories by least squares, and finds out which parameters the records determine.
#include "tools/study/kinds.h"

#include "tools/study/counter_random.h"
#include "tools/study/history.h"
#include "tools/study/least_squares.h"
#include "tools/study/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace steplap::study {

namespace {

/// Settings of a "fit" study.
struct FitSettings : KindSettings {
  long starts = 50;      ///< number of candidate start points; the search starts from the best of them
  long iterations = 100; ///< limit for one search
  double confidence = 0.95;
};

FieldTable fit_fields() {
  FieldTable t;
  t.add("starts", &FitSettings::starts).at_least(1).at_most(10000).doc("places looked at first; searches begin at the best of them");
  t.add("iterations", &FitSettings::iterations).at_least(1).at_most(10000).doc("of one search, at most");
  t.add("confidence", &FitSettings::confidence).at_least(0.5).at_most(0.9999).doc("of the intervals");
  return t;
}

using Eigen::VectorXd;

std::string in_words(const char* format, double a, double b = 0.0) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

// The fit as a least squares problem: residuals divided by their noise, parameters scaled by their ranges.
class FitProblem {
public:
  explicit FitProblem(StudyRun& run) : run_(run), histories_(run.study().histories) {
    for (std::size_t i = 0; i < run.study().variables.size(); ++i)
      if (!run.study().variables[i].range.empty()) fitted_.push_back(i);
    const double run_error = run_error_of(run.loaded);
    problem_.residuals = [this](const std::vector<VectorXd>& points) { return residuals(points); };
    problem_.step.resize(size());
    for (Eigen::Index i = 0; i < size(); ++i) {
      const double value = std::abs(run.law.nominal()[index(i)]);
      problem_.step[i] = std::min(0.25, std::cbrt(run_error) * (value > 0.0 ? std::min(1.0, value / width(i)) : 1.0));
    }
    for (const History& h : histories_) {
      double largest = 0.0;
      for (const double y : h.measured) largest = std::max(largest, std::abs(y));
      problem_.floor += static_cast<double>(h.t.size()) * std::pow(run_error * largest / noise_of(h), 2);
    }
    problem_.iterations = settings_of<FitSettings>(run.study()).iterations;
  }
  FitProblem(const FitProblem&) = delete;
  FitProblem& operator=(const FitProblem&) = delete;

  [[nodiscard]] const LeastSquaresProblem& problem() const { return problem_; }
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(fitted_.size()); }
  [[nodiscard]] const Variable& variable(Eigen::Index i) const { return run_.study().variables[index(i)]; }
  [[nodiscard]] double width(Eigen::Index i) const { return variable(i).range[1] - variable(i).range[0]; }
  [[nodiscard]] double value(Eigen::Index i, double share) const {
    return share >= 1.0 ? variable(i).range[1] : variable(i).range[0] + share * width(i);
  }
  /// Returns true if the noise is given, so that the size of the residuals can be tested.
  [[nodiscard]] bool has_noise() const { return histories_.front().noise.has_value(); }
  [[nodiscard]] static double noise_of(const History& h) { return h.noise.value_or(1.0); }
  [[nodiscard]] const std::string& last_reason() const { return reason_; }
  [[nodiscard]] std::size_t index(Eigen::Index i) const { return fitted_[static_cast<std::size_t>(i)]; }

  [[nodiscard]] VectorXd nominal() const {
    VectorXd z(size());
    for (Eigen::Index i = 0; i < size(); ++i) z[i] = std::clamp((run_.law.nominal()[index(i)] - variable(i).range[0]) / width(i), 0.0, 1.0);
    return z;
  }

private:
  std::vector<VectorXd> residuals(const std::vector<VectorXd>& points) {
    std::vector<double> values;
    for (const VectorXd& z : points) {
      values.insert(values.end(), run_.law.nominal().begin(), run_.law.nominal().end());
      const std::size_t base = values.size() - run_.law.nominal().size();
      for (Eigen::Index i = 0; i < size(); ++i) values[base + index(i)] = value(i, z[i]);
    }
    std::vector<VectorXd> rows;
    for (const StoredSample& sample : run_.evaluator.evaluate(values)) rows.push_back(weighed(sample.outcome));
    return rows;
  }

  VectorXd weighed(const Outcome& outcome) {
    VectorXd row(static_cast<Eigen::Index>(outcome.curve.size()));
    Eigen::Index place = 0;
    for (const History& h : histories_)
      for (const double measured : h.measured) {
        row[place] = (outcome.curve[static_cast<std::size_t>(place)] - measured) / noise_of(h);
        ++place;
      }
    const bool is_ok = outcome.status == SampleStatus::ok;
    if (is_ok && row.allFinite()) return row;
    reason_ = is_ok ? "the channel has no value at a measured time" : outcome.reason;
    return {};
  }

  StudyRun& run_;
  const std::vector<History>& histories_;
  std::vector<std::size_t> fitted_;
  LeastSquaresProblem problem_;
  std::string reason_;
};

// --- the search ---------------------------------------------------------------------------------------------------

struct Start {
  VectorXd at, residuals;
};

// Evaluates the nominal point and random points in the ranges. Returns those with a result, best fit first.
std::vector<Start> starts_of(StudyRun& run, const FitProblem& fit) {
  const CounterRandom random(static_cast<std::uint64_t>(run.study().seed), 11);
  std::vector<VectorXd> points{fit.nominal()};
  for (long k = 1; k < settings_of<FitSettings>(run.study()).starts; ++k) {
    VectorXd z(fit.size());
    for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = random.uniform(static_cast<std::uint64_t>(k), static_cast<std::uint32_t>(i));
    points.push_back(z);
  }
  std::vector<VectorXd> rows = fit.problem().residuals(points);
  std::vector<Start> starts;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (rows[k].size() > 0) starts.push_back({points[k], std::move(rows[k])});
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.residuals.squaredNorm() < b.residuals.squaredNorm(); });
  return starts;
}

std::vector<LeastSquaresMinimum> search(StudyRun& run, const FitProblem& fit) {
  constexpr std::size_t k_searches = 3;
  std::vector<Start> starts = starts_of(run, fit);
  if (starts.size() > k_searches) starts.resize(k_searches);
  std::vector<LeastSquaresMinimum> minima;
  for (const Start& start : starts) {
    minima.push_back(minimise(fit.problem(), start.at, start.residuals));
    Finding f{"fit", "", "sum of squares", minima.back().sum};
    f.samples = run.evaluator.asked();
    run.evaluator.note(f);
  }
  std::stable_sort(minima.begin(), minima.end(), [](const LeastSquaresMinimum& a, const LeastSquaresMinimum& b) { return a.sum < b.sum; });
  return minima;
}

// Returns another basis of the space spanned by the columns of `ways`, in which each vector has as few non-zero components as possible
// (Gauss-Jordan elimination on columns). Any basis of the undetermined combinations of parameters is equivalent; this one is the easiest to
// read.
Eigen::MatrixXd plainest(Eigen::MatrixXd ways) {
  for (Eigen::Index k = 0; k < ways.cols(); ++k) {
    Eigen::Index row = 0, column = 0;
    ways.rightCols(ways.cols() - k).cwiseAbs().maxCoeff(&row, &column);
    ways.col(k).swap(ways.col(k + column));
    ways.col(k) /= ways(row, k);
    for (Eigen::Index j = 0; j < ways.cols(); ++j)
      if (j != k) ways.col(j) -= ways(row, j) * VectorXd(ways.col(k));
  }
  return ways;
}

// --- analysis of the minimum ---------------------------------------------------------------------------------------

class FitReport {
public:
  FitReport(StudyRun& run, const FitProblem& fit, const std::vector<LeastSquaresMinimum>& minima)
      : run_(run), fit_(fit), minima_(minima), best_(minima.front()) {
    const auto count = static_cast<double>(best_.residuals.size());
    freedom_ = count - static_cast<double>(fit.size());
    const double found = std::max(best_.sum, fit.problem().floor) / freedom_;
    variance_ = fit.has_noise() ? 1.0 : found;
    told_ = identify(best_, variance_);
    const double p = 0.5 * (1.0 + settings_of<FitSettings>(run.study()).confidence);
    quantile_ = fit.has_noise() ? normal_quantile(p) : student_quantile(freedom_, p);
    off_.resize(static_cast<std::size_t>(fit.size()));
  }

  Answer write() {
    if (!best_.problem.empty()) distrust(best_.problem);
    check_ends_of_intervals();
    add_parameters();
    add_correlations();
    add_directions();
    add_residuals();
    add_other_minima();
    keep_histories();
    char text[300];
    std::snprintf(text, sizeof text,
                  "Intervals of %g %%: of first order, by %s, for residuals that are independent and normal; %ld "
                  "measured values, %ld parameters.",
                  100.0 * settings_of<FitSettings>(run_.study()).confidence,
                  fit_.has_noise() ? "the normal distribution with the stated noise" : "Student's distribution with the noise found",
                  static_cast<long>(best_.residuals.size()), static_cast<long>(fit_.size()));
    answer_.notes.emplace_back(text);
    return std::move(answer_);
  }

private:
  Finding finding(const std::string& subject, const std::string& quantity, double value) const {
    Finding f{"fit", subject, quantity, value};
    f.samples = run_.evaluator.asked();
    return f;
  }
  void distrust(const std::string& why) {
    answer_.notes.push_back("Not to be trusted: " + why + ".");
    answer_.degrade(Standing::not_trusted);
  }
  [[nodiscard]] double deviation(Eigen::Index i) const { return std::sqrt(told_.covariance(i, i)); }
  // Returns true if parameter i is part of a combination that the records do not determine.
  [[nodiscard]] bool is_untold(Eigen::Index i) const {
    constexpr double k_share = 0.05;
    for (Eigen::Index k = told_.rank; k < fit_.size(); ++k)
      if (std::abs(told_.directions(i, k)) > k_share) return true;
    return false;
  }

  // Evaluates the sum of squares at both ends of the confidence interval along each determined direction. Parameters for which it differs
  // from the linearised value by more than a factor of 2 get a remark.
  void check_ends_of_intervals() {
    std::vector<VectorXd> points;
    for (int k = 0; k < told_.rank; ++k)
      for (const double side : {-1.0, 1.0}) {
        const VectorXd way = side * quantile_ * std::sqrt(variance_) / told_.singular[k] * told_.directions.col(k);
        points.push_back((best_.at + way).cwiseMax(0.0).cwiseMin(1.0));
      }
    if (points.empty()) return;
    const std::vector<VectorXd> rows = fit_.problem().residuals(points);
    for (std::size_t j = 0; j < points.size(); ++j) {
      const VectorXd way = points[j] - best_.at;
      const double expected = (best_.jacobian * way).squaredNorm() + 2.0 * (best_.jacobian * way).dot(best_.residuals);
      // A rise that is small relative to the sum, or close to the numerical error of the runs, cannot be compared.
      if (!(expected > 1e-6 * best_.sum) || expected < 100.0 * fit_.problem().floor) continue;
      const double rise = rows[j].size() > 0 ? (rows[j].squaredNorm() - best_.sum) / expected : std::nan("");
      if (rise > 0.5 && rise < 2.0) continue;
      for (Eigen::Index i = 0; i < fit_.size(); ++i)
        if (std::abs(told_.directions(i, static_cast<Eigen::Index>(j / 2))) > 0.1)
          off_[static_cast<std::size_t>(i)] =
              std::isnan(rise) ? "at an end of its interval the run has no result"
                               : in_words("the interval is of first order, which is off: at its end the sum of squares rises %.2g "
                                          "times as much as it should",
                                          rise);
    }
  }

  void add_parameters() {
    for (Eigen::Index i = 0; i < fit_.size(); ++i) {
      const std::string& name = fit_.variable(i).name;
      Finding f = finding(name, "value", fit_.value(i, best_.at[i]));
      Finding d = finding(name, "standard deviation", fit_.width(i) * deviation(i));
      if (is_untold(i)) {
        f.status = d.status = "the record does not determine it: see 'not determined'";
        d.value = std::nan("");
        answer_.degrade(Standing::not_met);
      } else {
        f.low = f.value - quantile_ * d.value;
        f.high = f.value + quantile_ * d.value;
        f.status = off_[static_cast<std::size_t>(i)];
        if (!f.status.empty()) answer_.degrade(Standing::not_met);
      }
      if (best_.is_at_end[static_cast<std::size_t>(i)] && !is_untold(i)) {
        f.status = "at the end of its range: it would lie beyond";
        answer_.degrade(Standing::not_met);
      }
      answer_.findings.push_back(f);
      answer_.findings.push_back(d);
    }
  }

  void add_correlations() {
    constexpr double k_high = 0.95;
    for (Eigen::Index i = 0; i < fit_.size(); ++i)
      for (Eigen::Index j = i + 1; j < fit_.size(); ++j) {
        if (is_untold(i) || is_untold(j)) continue;
        Finding f = finding(fit_.variable(i).name + ", " + fit_.variable(j).name, "correlation",
                            told_.covariance(i, j) / (deviation(i) * deviation(j)));
        if (std::abs(f.value) > k_high) f.status = "strongly correlated: a change of one is nearly compensated by the other";
        answer_.findings.push_back(f);
      }
  }

  // Reports combinations of parameters whose simultaneous change does not affect the fit.
  void add_directions() {
    answer_.findings.push_back(finding("", "condition", told_.singular[0] / told_.singular[fit_.size() - 1]));
    const Eigen::MatrixXd untold = plainest(told_.directions.rightCols(fit_.size() - told_.rank));
    for (Eigen::Index k = 0; k < untold.cols(); ++k) {
      VectorXd way = untold.col(k);
      const double seen = (best_.jacobian * way).norm() / (way.norm() * told_.singular[0]);
      Eigen::Index largest = 0;
      (void)way.cwiseAbs().maxCoeff(&largest);
      way *= 0.01 / way[largest];
      std::string names, changes;
      for (Eigen::Index i = 0; i < fit_.size(); ++i) {
        if (std::abs(way[i]) < 0.05 * 0.01) continue;
        const Variable& v = fit_.variable(i);
        names += (names.empty() ? "" : ", ") + v.name;
        changes += (changes.empty() ? "" : " and ") + v.name + " changes by " + in_words("%+.4g", way[i] * fit_.width(i)) +
                   (v.unit.empty() || v.unit == "*" ? "" : " " + v.unit);
      }
      Finding f = finding(names, "not determined", seen);
      f.status = names.find(',') == std::string::npos ? "the record does not depend on it"
                                                      : "cannot be distinguished: the record does not change where " + changes;
      answer_.findings.push_back(f);
      answer_.degrade(Standing::not_met);
    }
  }

  // Tests the residuals: if they exceed the noise or are correlated, the model does not describe the measurement.
  void add_residuals() {
    constexpr double k_sure = 4.0; // standard deviations; exceeded by chance in one of 16 000 cases
    Eigen::Index place = 0;
    for (const History& h : run_.study().histories) {
      const auto count = static_cast<Eigen::Index>(h.t.size());
      const VectorXd r = best_.residuals.segment(place, count);
      place += count;
      const double n = static_cast<double>(count), sum = r.squaredNorm();
      Finding f = finding(h.name, "residual, root mean square", std::sqrt(sum / n) * FitProblem::noise_of(h));
      // The sum of products of neighbouring residuals, divided by the variance, has the standard deviation √n if they are independent.
      const double products = r.head(count - 1).dot(r.tail(count - 1)), together = sum > 0.0 ? products / sum : 0.0;
      const double share = h.noise ? products / n : together;
      const bool is_exact = sum <= 10.0 * fit_.problem().floor;
      if (count > 20 && !is_exact && share * std::sqrt(n) > k_sure)
        f.status = in_words("residuals are correlated (%.2f from one to the next): the model does not "
                            "describe the record to its noise, "
                            "and the intervals are too narrow",
                            together);
      // χ² with n degrees of freedom is approximately normal with standard deviation √(2n).
      else if (h.noise && sum > n + k_sure * std::sqrt(2.0 * n))
        f.status = in_words("residuals are %.3g times the stated noise: the model does not describe the record, or the noise is larger",
                            std::sqrt(sum / n));
      if (!f.status.empty()) answer_.degrade(Standing::not_trusted);
      answer_.findings.push_back(f);
      check_interpolation(h, place - count);
    }
  }

  // Warns if linear interpolation between output samples is too coarse. Its error is at most 1/8 of the second difference, which is
  // proportional to the square of the output step.
  void check_interpolation(const History& h, Eigen::Index place) {
    const auto model =
        std::find_if(run_.loaded.models.begin(), run_.loaded.models.end(), [&](const auto& m) { return m->name == h.model; });
    const Sampling sampling = sampling_of(run_.study(), **model);
    if (sampling.is_exact) return;
    double largest = 0.0;
    const auto fitted = [&](std::size_t i) {
      return h.measured[i] + best_.residuals[place + static_cast<Eigen::Index>(i)] * FitProblem::noise_of(h);
    };
    for (std::size_t i = 1; i + 1 < h.t.size(); ++i) {
      const double a = h.t[i] - h.t[i - 1], b = h.t[i + 1] - h.t[i];
      const double curvature = 2.0 * ((fitted(i + 1) - fitted(i)) / b - (fitted(i) - fitted(i - 1)) / a) / (a + b);
      largest = std::max(largest, std::abs(curvature) * sampling.step * sampling.step / 8.0);
    }
    const double noise = std::sqrt(variance_) * FitProblem::noise_of(h);
    answer_.notes.push_back("History '" + h.name +
                            "': its times are no multiples of one step; runs are interpolated between samples every " +
                            in_words("%.3g s, which is off by %.1g at most", sampling.step, largest) + " " + h.channel_unit + ".");
    if (largest > 0.1 * noise)
      distrust("interpolating runs for '" + h.name + "' is off by more than a tenth of its noise; resample the record evenly");
  }

  // Reports another minimum that fits equally well.
  void add_other_minima() {
    for (std::size_t k = 1; k < minima_.size(); ++k) {
      const LeastSquaresMinimum& other = minima_[k];
      if (other.sum - best_.sum > quantile_ * quantile_ * variance_) continue;
      VectorXd way = told_.directions.leftCols(told_.rank).transpose() * (other.at - best_.at);
      way = way.cwiseProduct(told_.singular.head(told_.rank)) / std::sqrt(variance_);
      if (way.norm() < 2.0 * quantile_ || (other.at - best_.at).norm() < 1e-3) continue;
      std::string text;
      for (Eigen::Index i = 0; i < fit_.size(); ++i)
        text += (i ? ", " : "") + fit_.variable(i).name + in_words(" = %.6g", fit_.value(i, other.at[i]));
      Finding f = finding("", "another fit", other.sum / best_.sum);
      f.status = "fits as well: " + text;
      answer_.findings.push_back(f);
      answer_.degrade(Standing::not_met);
      return;
    }
  }

  void keep_histories() {
    std::vector<Store::CurvePoint> points;
    Eigen::Index place = 0;
    for (const History& h : run_.study().histories)
      for (std::size_t i = 0; i < h.t.size(); ++i)
        points.push_back({h.name, h.t[i], h.measured[i], h.measured[i] + best_.residuals[place++] * FitProblem::noise_of(h)});
    run_.evaluator.store().set_histories(points);
  }

  StudyRun& run_;
  const FitProblem& fit_;
  const std::vector<LeastSquaresMinimum>& minima_;
  const LeastSquaresMinimum& best_;
  Answer answer_;
  Identified told_;
  double freedom_ = 1.0, variance_ = 1.0, quantile_ = 2.0;
  std::vector<std::string> off_; ///< per parameter: remark on its interval; "" if valid
};

void check_fit(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const Study& study = loaded.study;
  if (study.histories.empty()) problems.push_back({study.where, "a study of the kind 'fit' needs a [[history]]"});
  long fitted = 0;
  for (const Variable& v : study.variables) {
    fitted += !v.range.empty();
    if (!v.values.empty() || v.has_distribution())
      problems.push_back(
          {v.where, "variable '" + v.name + "': a fit takes 'range', where the parameter may lie, or 'value', which it keeps"});
  }
  if (fitted == 0 && !study.histories.empty())
    problems.push_back({study.where, "a study of the kind 'fit' needs a [[variable]] with a range"});
  const auto noisy = std::count_if(study.histories.begin(), study.histories.end(), [](const History& h) { return h.noise.has_value(); });
  if (study.histories.size() > 1 && noisy != static_cast<long>(study.histories.size()))
    problems.push_back({study.histories.back().where, "several histories need 'noise' each, which determines their weights"});
  if (!study.histories.empty() && static_cast<long>(loaded.curve_size()) <= fitted)
    problems.push_back({study.histories.front().where, std::to_string(loaded.curve_size()) + " measured values are too few for " +
                                                           std::to_string(fitted) + " parameters"});
  for (const Response& r : study.responses)
    if (needs_samples(r.measure))
      problems.push_back({r.where, "response '" + r.name + "': a fit samples runs at the measured times, not every output.step, which '" +
                                       r.what + "' is of"});
}

Answer run_fit(StudyRun& run) {
  const FitProblem fit(run);
  const std::vector<LeastSquaresMinimum> minima = search(run, fit);
  if (!minima.empty()) return FitReport(run, fit, minima).write();
  Answer answer;
  Finding f{"fit", "", "value"};
  f.samples = run.evaluator.asked();
  f.status = "no run had a result at any of the starts: " + fit.last_reason();
  answer.findings.push_back(f);
  answer.degrade(Standing::not_trusted);
  return answer;
}

} // namespace

StudyKind fit_kind() {
  StudyKind kind;
  kind.name = "fit";
  kind.doc = "parameters from measured histories by least squares, with what they are known to";
  kind.fields = fit_fields();
  kind.holds<FitSettings>();
  kind.takes_histories = true;
  kind.parts = {{"base", "value", UnitOf::subject},
                {"moment", "standard deviation", UnitOf::subject, 4},
                {"residual", "residual", UnitOf::subject, 4}, // quantity in the unit of a measured record
                {"sum of squares", "sum of squares"},         // dimensionless: residuals are divided by the noise
                {"correlation", "correlation", UnitOf::none, 3},
                {"condition", "condition", UnitOf::none, 3},
                {"not determined", "not determined", UnitOf::none, 3},
                {"another fit", "another fit", UnitOf::none, 3}};
  kind.check = check_fit;
  kind.run = run_fit;
  return kind;
}

} // namespace steplap::study
