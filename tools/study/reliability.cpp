#include "tools/study/reliability.h"

#include "tools/study/evidence.h"
#include "tools/study/kinds.h"
#include "tools/study/random_variables.h"
#include "tools/study/samplers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap::study {

namespace {

FieldTable reliability_fields() {
  using S = ReliabilitySettings;
  FieldTable t;
  t.add("methods", &S::methods)
      .doc("monte_carlo, form, sorm, importance_sampling, subset, kriging; the first that samples gives the answer");
  t.add("limit_states", &S::limit_states).doc("those that make the system; all if none is named");
  t.add("combination", &S::combination).one_of({"any", "all"}).doc("the system fails where any of them does, or where all do");
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
  t.add("repetitions", &S::repetitions).at_least(2).at_most(1000).doc("of subset simulation; their scatter gives its interval");
  t.add("confidence", &S::confidence).at_least(0.5).at_most(0.9999).doc("of all intervals");
  return t;
}

const std::vector<std::string> k_methods{"monte_carlo", "form", "sorm", "importance_sampling", "subset", "kriging"};

constexpr double k_alarm = 0.01; // probability of a false alarm over all comparisons of a study

SamplingTarget target_of(const ReliabilitySettings& s) {
  SamplingTarget target;
  target.cov = s.cov;
  target.samples = s.samples;
  target.seconds = s.seconds;
  target.confidence = s.confidence;
  return target;
}

double normal_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); }

std::string text_of(const char* format, double a, double b = 0.0, double c = 0.0) {
  char text[240];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

class Reliability {
public:
  explicit Reliability(StudyRun& run)
      : run_(run), limit_(run), settings_(settings_of<ReliabilitySettings>(run.study())), target_(target_of(settings_)) {}

  Answer answer() {
    if (!run_.study().evidence.empty()) return answer_with_evidence();
    const bool has_form = asks("form") || asks("sorm");
    target_.test_confidence = 1.0 - k_alarm / static_cast<double>(comparisons());
    if (has_form || asks("importance_sampling")) points_ = find_design_points(limit_, asks("sorm"));
    for (const std::string& method : settings_.methods) {
      run_.evaluator.expect(0);
      if (method == "monte_carlo") estimates_.push_back(monte_carlo(limit_, target_));
      if (method == "subset") estimates_.push_back(subset_simulation(limit_, target_));
      if (method == "importance_sampling") sample_around(target_);
      if (method == "kriging") learn();
    }
    if (has_form && estimates_.empty()) { // a first-order result is always checked by sampling
      SamplingTarget check = target_;
      check.cov = std::max(check.cov, 0.1);
      check.samples = std::min(check.samples, 5000L);
      sample_around(check);
    }
    if (has_form) report_form();
    for (const Estimate& e : estimates_) add_findings(e, limit_, run_.study().failed, answer_);
    report_influence();
    compare_estimates();
    check_cover();
    if (limit_.bad() > 0)
      answer_.notes.push_back(std::to_string(limit_.bad()) + " runs did not reach their end or are not to be trusted: they count as \"" +
                              run_.study().failed + "\"");
    return std::move(answer_);
  }

private:
  Answer answer_with_evidence() {
    points_ = find_design_points(limit_, false);
    (void)search_on(limit_, points_);
    if (!points_.is_searched_out()) note_unsearched();
    sample_with_evidence(limit_, points_, target_, answer_);
    return std::move(answer_);
  }

  [[nodiscard]] bool asks(const char* method) const {
    return std::find(settings_.methods.begin(), settings_.methods.end(), method) != settings_.methods.end();
  }
  [[nodiscard]] const DesignPoint* best() const {
    return points_.points.empty() || !points_.points.front().is_found ? nullptr : &points_.points.front();
  }

  // Says so if sampling without a surrogate would have been faster for the same coefficient of variation.
  void learn() {
    const double begin = run_.evaluator.seconds();
    const Estimate& e = estimates_.emplace_back(kriging(limit_, target_));
    const double took = run_.evaluator.seconds() - begin, rate = run_.evaluator.rate();
    if (rate == 0.0 || !std::isfinite(e.cov)) return;
    constexpr double k_around = 14.0; // runs times cov²: importance sampling needs at most 1400 at 0.1 for smooth limit states
    const double rarer = std::min(e.safe, 1.0 - e.safe), crude = (1.0 - rarer) / rarer;
    const double seconds = std::min(crude, k_around) / (e.cov * e.cov) / rate;
    if (seconds < took)
      answer_.notes.push_back(std::string("Runs cost little here: \"") + (crude < k_around ? "monte_carlo" : "importance_sampling") +
                              "\" is the better method. " +
                              text_of("It would be as accurate after about %.2g s; kriging took %.2g s.", seconds, took));
  }

  void sample_around(const SamplingTarget& target) {
    if (!points_.points.empty()) {
      estimates_.push_back(importance_sampling(limit_, points_, target));
      return;
    }
    Finding f{"importance_sampling", limit_.subject(), "probability"};
    f.status = "no design point was found to sample around: " + points_.trouble;
    answer_.findings.push_back(f);
    answer_.degrade(Standing::not_trusted);
  }

  // Returns the reason why a design point may be wrong; "" if there is none.
  std::string doubt(const DesignPoint& p) const {
    if (p.off_surface >= 1e-4 * std::max(1.0, std::abs(p.beta)))
      return text_of("not on the limit state: |g| is %.3g there, %.3g standard deviations from zero", std::abs(p.g), p.off_surface);
    if (!p.is_found) return text_of("not the nearest point around it: off the gradient's line by 1 - cos = %.3g", p.misalignment);
    const double slack = 1e-3 * std::max(1.0, p.beta);
    if (p.beta > 0.0 && limit_.nearest_failure() < p.beta - slack)
      return text_of("another design point beats it: a sample failed at a distance of %.5g, nearer than %.5g", limit_.nearest_failure(),
                     p.beta);
    return "";
  }

  // Returns the number of comparisons between estimates. The confidence level of each comparison is raised by it, so that only one study in
  // a hundred reports a contradiction by chance (Bonferroni correction).
  [[nodiscard]] long comparisons() const {
    const auto theories = (asks("form") || asks("sorm") ? 1 : 0) + (asks("sorm") ? 1 : 0);
    const auto samplings = std::max<long>(1, std::count_if(settings_.methods.begin(), settings_.methods.end(),
                                                           [](const std::string& method) { return method != "form" && method != "sorm"; }));
    // comparisons of two sampling methods count twice, because both bounds are compared
    return std::max(1L, samplings * theories + samplings * (samplings - 1));
  }

  // Returns a sentence if a sampling interval does not contain the probability p: the ratio of p to it. Returns "" otherwise.
  std::string sampling_doubt(double p, const char* whose) const {
    for (const Estimate& e : estimates_) {
      const Interval test = e.test(run_.study().failed);
      if (!e.is_trusted || (p >= test.low && p <= test.high)) continue;
      return std::string(whose) + " is off: " + e.method + text_of(" gives %.4g to %.4g", test.low, test.high) + ", which it is " +
             factor_text(p, test) + " times";
    }
    return "";
  }
  static std::string factor_text(double p, const Interval& test) {
    return text_of("%.3g", p / test.high) + (test.low > 0.0 ? text_of(" to %.3g", p / test.low) : " or more");
  }

  // Reports the ratio of p to the result of each sampling method, also if both agree.
  void report_factors(const char* method, const std::string& name, double p) {
    for (const Estimate& e : estimates_) {
      if (!e.is_trusted || !std::isfinite(e.cov)) continue;
      const Interval test = e.test(run_.study().failed);
      const double sampled = run_.study().failed == "unsafe" ? e.unsafe : e.safe;
      const auto over = [p](double q) { return q > 0.0 ? p / q : std::nan(""); };
      answer_.findings.push_back(
          {method, limit_.subject(), name + " to " + e.method, over(sampled), over(test.high), over(test.low), e.samples});
    }
  }

  void report_form() {
    const long samples = points_.samples;
    const std::string subject = limit_.subject();
    if (points_.points.empty()) {
      Finding f{"form", subject, "beta"};
      f.samples = samples;
      f.status = "no search for a design point arrived: " + points_.trouble;
      answer_.findings.push_back(f);
      answer_.degrade(Standing::not_trusted);
      return;
    }
    const DesignPoint& first = points_.points.front();
    const double probability = normal_cdf(-first.beta);
    std::string status = doubt(first);
    if (status.empty()) status = sampling_doubt(probability, "first order");
    if (!status.empty() && !has_trusted_estimate()) answer_.degrade(Standing::not_trusted);
    check_surrogate(first, probability);
    check_regions(first);
    add("form", "beta", first.beta, status);
    add("form", "probability", probability, status);
    report_factors("form", "factor", probability);
    if (asks("sorm")) report_sorm(first);
    report_points();
    if (points_.failed_starts > 0)
      answer_.notes.push_back(std::to_string(points_.failed_starts) + " of " + std::to_string(points_.starts) +
                              " searches for a design point gave up: " + points_.trouble);
    if (points_.left_starts > 0)
      answer_.notes.push_back("The samples for searches were used up before " + std::to_string(points_.left_starts) +
                              " more were begun: 'search_samples' gives more");
  }

  // A surrogate that gives a tenth of first order or less may not have learned the region about the design point: without samples of the
  // limit state itself it is no witness against a point that was found.
  void check_surrogate(const DesignPoint& first, double probability) {
    constexpr double k_far = 10.0;
    const auto is_surrogate = [](const Estimate& e) { return e.method == "kriging"; };
    const auto is_trusted_sampling = [&](const Estimate& e) { return e.is_trusted && !is_surrogate(e); };
    if (!first.is_found || std::any_of(estimates_.begin(), estimates_.end(), is_trusted_sampling)) return;
    for (const Estimate& e : estimates_) {
      if (!is_surrogate(e) || !(probability > k_far * e.test(run_.study().failed).high)) continue;
      answer_.notes.push_back(
          text_of("kriging gives at most %.3g, first order at the design point %.3g: kriging may have missed the failures "
                  "there. Add \"importance_sampling\" to the methods",
                  e.test(run_.study().failed).high, probability));
      answer_.degrade(Standing::not_trusted);
    }
  }

  // A failure far nearer than the design point, from which no search arrived at another one, lies in a region that sampling around design
  // points and levels may have missed. Crude Monte Carlo meets every region by its probability.
  void check_regions(const DesignPoint& first) {
    constexpr double k_more = 10.0; // ratio of the first-order probabilities
    const double nearest = limit_.nearest_failure();
    const bool is_far_nearer = nearest < first.beta && normal_cdf(-nearest) > k_more * normal_cdf(-first.beta);
    if (!first.is_found || !is_far_nearer || has_trusted_crude()) return;
    answer_.notes.push_back(text_of("A sample failed at a distance of %.4g, and the nearest design point lies at %.4g: a region of failure "
                                    "may be missing. Add \"monte_carlo\" to the methods",
                                    nearest, first.beta));
    answer_.degrade(Standing::not_trusted);
  }

  // Searches that still find design points leave others unknown. Crude Monte Carlo meets every region by its probability.
  void check_cover() {
    const auto is_uncovered = [](const Estimate& e) { return e.is_trusted && !e.is_covered; };
    if (std::any_of(estimates_.begin(), estimates_.end(), is_uncovered) && !has_trusted_crude()) note_unsearched();
  }

  void note_unsearched() {
    answer_.notes.push_back("Searches still found design points when they ended, at " + std::to_string(points_.points.size()) +
                            ": a region of failure may be missing. Give more 'search_samples', or add \"monte_carlo\" to the methods");
    answer_.degrade(Standing::not_trusted);
  }

  [[nodiscard]] bool has_trusted_crude() const {
    return std::any_of(estimates_.begin(), estimates_.end(),
                       [](const Estimate& e) { return e.method == "monte_carlo" && e.is_trusted && std::isfinite(e.cov); });
  }

  void report_sorm(const DesignPoint& first) {
    const double p = first.breitung;
    const bool is_known = p > 0.0 && p < 1.0;
    std::string status = doubt(first);
    if (status.empty())
      status = is_known ? sampling_doubt(p, "second order") : "the curvatures at the design point are too large for it, or unknown";
    add("sorm", "probability (Breitung)", is_known ? p : std::nan(""), status);
    if (!is_known) return;
    report_factors("sorm", "factor (Breitung)", p);
    add("sorm", "beta (Breitung)", -normal_quantile(p), status);
  }

  void report_points() {
    const auto& random = run_.law.random();
    std::vector<double> values(run_.study().variables.size());
    std::size_t k = 0;
    for (const DesignPoint& p : points_.points) {
      if (!p.is_found && k > 0) continue;
      const std::string name = "design point " + std::to_string(++k);
      run_.law.values_at(p.u.data(), values.data());
      answer_.findings.push_back({"form", name, "beta", p.beta, std::nan(""), std::nan(""), points_.samples, doubt(p)});
      for (std::size_t i = 0; i < random.size(); ++i) {
        const std::string& variable = run_.study().variables[random[i]].name;
        answer_.findings.push_back({"form", name, variable, values[random[i]], std::nan(""), std::nan(""), points_.samples});
        answer_.findings.push_back(
            {"form", name, "importance of " + variable, p.alpha[i] * p.alpha[i], std::nan(""), std::nan(""), points_.samples});
        answer_.findings.push_back({"form", name, "signed importance of " + variable, p.alpha[i] * std::abs(p.alpha[i]), std::nan(""),
                                    std::nan(""), points_.samples});
      }
    }
    if (const DesignPoint* const nearest = best(); nearest && nearest->beta != 0.0) report_slopes(*nearest);
    if (k > 1) answer_.notes.push_back(std::to_string(k) + " design points: the first order probability is of the nearest alone");
  }

  // Reports first-order changes at the design point with the mean and the scatter of each variable. If the limit state is linear there,
  // β = m/s with s² = Σ s_i², of which variable i contributes the share α_i². Multiplying its scatter by c changes β to
  // β/√(1 − (1 − c²) α_i²).
  void report_slopes(const DesignPoint& point) {
    const auto& random = run_.law.random();
    const auto slopes = run_.law.index_slopes(point.u, point.beta);
    const auto put = [&](const std::string& quantity, double value) {
      answer_.findings.push_back({"form", "design point 1", quantity, value, std::nan(""), std::nan(""), points_.samples});
    };
    for (std::size_t i = 0; i < random.size(); ++i) {
      const std::string& name = run_.study().variables[random[i]].name;
      put("beta by mean of " + name, slopes[i].by_mean);
      put("beta by standard deviation of " + name, slopes[i].by_deviation);
      put("elasticity of the probability by mean of " + name,
          -normal_density(point.beta) / normal_cdf(-point.beta) * slopes[i].by_mean * run_.law.mean(i));
      if (!run_.law.is_independent()) continue;
      const double share = point.alpha[i] * point.alpha[i];
      put("probability with half the scatter of " + name, halved_scatter(point, i));
      put("omission factor of " + name, 1.0 / std::sqrt(1.0 - std::min(share, 1.0 - 1e-12)));
    }
    if (!run_.law.is_independent())
      answer_.notes.push_back(
          "The variables are correlated: shares of single variables in the scatter are not defined, and importances are "
          "those of the independent variables from which they are made, in their order");
  }

  static double halved_scatter(const DesignPoint& point, std::size_t i) {
    return normal_cdf(-point.beta / std::sqrt(1.0 - 0.75 * point.alpha[i] * point.alpha[i]));
  }

  // Reports what other distributions would change, of the trusted estimate that is known best.
  void report_influence() {
    const Estimate* sampled = nullptr;
    for (const Estimate& e : estimates_)
      if (e.is_trusted && e.influence.is_known() && (!sampled || e.cov < sampled->cov)) sampled = &e;
    const std::size_t notes = answer_.notes.size();
    if (sampled)
      sampled->influence.add_findings(
          limit_, {sampled->method, limit_.subject(), "", run_.study().failed == "safe" ? sampled->safe : sampled->unsafe}, answer_);
    if (answer_.notes.size() == notes) note_most_important();
  }

  // Names the variable that matters most where the samples do not tell.
  void note_most_important() {
    const DesignPoint* const point = best();
    if (!(asks("form") || asks("sorm")) || !point || !run_.law.is_independent()) return;
    const auto most =
        std::max_element(point->alpha.begin(), point->alpha.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    const auto i = static_cast<std::size_t>(most - point->alpha.begin());
    answer_.notes.push_back(
        "'" + run_.study().variables[run_.law.random()[i]].name + "' matters most, to first order: " +
        text_of("half its scatter would change the probability from %.3g to %.3g.", normal_cdf(-point->beta), halved_scatter(*point, i)));
  }

  void add(const char* method, const char* quantity, double value, const std::string& status) {
    answer_.findings.push_back({method, limit_.subject(), quantity, value, std::nan(""), std::nan(""), points_.samples, status});
  }

  [[nodiscard]] bool has_trusted_estimate() const {
    return std::any_of(estimates_.begin(), estimates_.end(), [](const Estimate& e) { return e.is_trusted && std::isfinite(e.cov); });
  }

  // Reports two sampling methods with disjoint intervals, because one of them has missed a failure region. The lower and upper bounds are
  // compared separately; otherwise their difference, caused by runs without a result, would hide a contradiction.
  void compare_estimates() {
    for (std::size_t i = 0; i < estimates_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Estimate &a = estimates_[i], &b = estimates_[j];
        const bool is_of_safe = run_.study().failed != "unsafe" && lie_apart(a.safe_test, b.safe_test),
                   is_of_unsafe = run_.study().failed != "safe" && lie_apart(a.unsafe_test, b.unsafe_test);
        if (!is_of_safe && !is_of_unsafe) continue;
        answer_.notes.push_back(a.method + " and " + b.method + " contradict each other: one of them has missed a part of the failures");
        answer_.degrade(Standing::not_trusted);
      }
  }
  static bool lie_apart(const Interval& a, const Interval& b) { return a.low > b.high || b.low > a.high; }

  StudyRun& run_;
  LimitFunction limit_;
  const ReliabilitySettings& settings_;
  SamplingTarget target_;
  DesignPoints points_;
  std::vector<Estimate> estimates_;
  Answer answer_;
};

std::string list_text(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

void check_reliability(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  check_random(loaded, false, problems);
  const auto& s = settings_of<ReliabilitySettings>(loaded.study);
  if (loaded.study.limit_states.empty())
    problems.push_back({loaded.study.where, "a study of the kind 'reliability' needs a [[limit_state]]"});
  if (s.methods.empty()) problems.push_back({s.where, "'methods' is empty; there are " + list_text(k_methods)});
  for (const std::string& method : s.methods)
    if (std::find(k_methods.begin(), k_methods.end(), method) == k_methods.end())
      problems.push_back(
          {s.where, "there is no method '" + method + "'" + did_you_mean(method, k_methods) + "; there are " + list_text(k_methods)});
  std::vector<std::string> names;
  for (const LimitState& l : loaded.study.limit_states) names.push_back(l.name);
  for (const std::string& name : s.limit_states)
    if (std::find(names.begin(), names.end(), name) == names.end())
      problems.push_back({s.where, "there is no limit state '" + name + "'" + did_you_mean(name, names)});
  check_evidence(loaded, problems);
}

Answer run_reliability(StudyRun& run) { return Reliability(run).answer(); }

Drawn reliability_drawn(const ShownSettings& settings) {
  return is_only(settings, "methods", "monte_carlo") ? Drawn::independently : Drawn::otherwise;
}

} // namespace

StudyKind reliability_kind() {
  StudyKind kind;
  kind.name = "reliability";
  kind.doc = "how likely failure is, by sampling and by design points";
  kind.fields = reliability_fields();
  kind.holds<ReliabilitySettings>();
  kind.shown = {"methods", "limit_states", "combination", "cov", "confidence"};
  kind.draws_jointly = true;
  kind.takes_evidence = true;
  kind.parts = {{"half scatter", "probability with half the scatter of ", UnitOf::none, 4},
                {"smaller mean", "probability with a mean 10 % smaller of ", UnitOf::none, 4},
                {"larger mean", "probability with a mean 10 % larger of ", UnitOf::none, 4},
                {"slope", "beta by mean of ", UnitOf::quotient, 4},
                {"slope", "beta by standard deviation of ", UnitOf::quotient, 4},
                {"omission", "omission factor of ", UnitOf::none, 4},
                {"elasticity of P", "elasticity of the probability by mean of ", UnitOf::none, 4},
                {"signed importance", "signed importance of "},
                {"probability", "probability", UnitOf::none, 4},
                {"doubt", "with doubtful samples ", UnitOf::none, 4},
                {"population", "population", UnitOf::none, 7},
                {"prior", "without evidence", UnitOf::none, 4},
                {"evidence", "chance of the evidence", UnitOf::none, 4},
                {"evidence", "effective samples", UnitOf::none, 4},
                {"posterior", "mean with evidence", UnitOf::subject},
                {"posterior", "standard deviation with evidence", UnitOf::subject},
                {"beta", "beta", UnitOf::none, 5},
                {"importance", "importance of "},
                {"factor", "factor"}}; // ratio of a probability by theory to one by sampling
  kind.points = {{"form", "design point"}, {"evidence", "posterior sample", true}};
  kind.check = check_reliability;
  kind.run = run_reliability;
  kind.drawn = reliability_drawn;
  return kind;
}

} // namespace steplap::study
