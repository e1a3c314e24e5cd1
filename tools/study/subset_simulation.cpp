// Subset simulation by OpenTURNS, several times over: the scatter of independent repetitions makes the interval.
#include "tools/study/samplers.h"

#include <openturns/CompositeRandomVector.hxx>
#include <openturns/Less.hxx>
#include <openturns/Log.hxx>
#include <openturns/Normal.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/SubsetSampling.hxx>
#include <openturns/ThresholdEvent.hxx>

#include <algorithm>
#include <cmath>
#include <memory>

namespace steplap::study {

namespace {

// Runs without result are the worst there is, or the best.
class SubsetEvaluation : public OT::EvaluationImplementation {
public:
  SubsetEvaluation(LimitFunction& limit, bool is_bad_unsafe) : limit_(&limit), is_bad_unsafe_(is_bad_unsafe) {
    setInputDescription(OT::Description::BuildDefault(limit.dimension(), "u"));
    setOutputDescription(OT::Description(1, "g"));
  }
  SubsetEvaluation* clone() const override { return new SubsetEvaluation(*this); }
  OT::UnsignedInteger getInputDimension() const override { return limit_->dimension(); }
  OT::UnsignedInteger getOutputDimension() const override { return 1; }
  OT::Point operator()(const OT::Point& u) const override {
    OT::Sample sample(1, u);
    return (*this)(sample)[0];
  }
  OT::Sample operator()(const OT::Sample& sample) const override {
    constexpr double k_extreme = 1e300;
    const OT::Point flat = sample.getImplementation()->getData();
    const std::vector<LimitValue>& values = limit_->at({flat.begin(), flat.end()});
    OT::Sample result(sample.getSize(), 1);
    for (OT::UnsignedInteger i = 0; i < sample.getSize(); ++i) {
      result(i, 0) = values[i].is_bad ? (is_bad_unsafe_ ? -k_extreme : k_extreme) : values[i].g;
      tally_->add(result(i, 0));
    }
    return result;
  }

  // What was met, of all copies of the function together.
  struct Tally {
    long first_level = 0;                       // samples of the first level, which is crude Monte Carlo
    long samples = 0, failures = 0, early = 0;  // early: failures in the first level
    void add(double g) {
      early += samples < first_level && g < 0.0;
      failures += g < 0.0;
      ++samples;
    }
  };
  std::shared_ptr<Tally> tally_ = std::make_shared<Tally>();

private:
  LimitFunction* limit_;
  bool is_bad_unsafe_;
};

struct Repetition {
  double probability = 0.0, cov = 0.0;
  long failures = 0, samples = 0; ///< of the first level, where it was all there was to it; else 0
  std::string problem;
};

Repetition repeat(LimitFunction& limit, bool is_bad_unsafe, long k) {
  const Study& study = limit.run().study();
  // The same for both bounds, so that they differ by what runs without result count as, not by chance.
  OT::RandomGenerator::SetSeed(static_cast<OT::UnsignedInteger>(study.seed * 1000003 + k * 7919 + 1));
  SubsetEvaluation evaluation(limit, is_bad_unsafe);
  const auto tally = evaluation.tally_;
  const auto samples = static_cast<OT::UnsignedInteger>(study.reliability.subset_samples);
  const OT::UnsignedInteger block = std::max<OT::UnsignedInteger>(1, samples / 10),
                            blocks = (samples + block - 1) / block;
  tally->first_level = static_cast<long>(blocks * block);
  const OT::Function function{
      OT::Evaluation(OT::Pointer<OT::EvaluationImplementation>(new SubsetEvaluation(evaluation)))};
  const OT::RandomVector input{OT::Distribution(OT::Normal(limit.dimension()))};
  OT::SubsetSampling subset(OT::ThresholdEvent(OT::CompositeRandomVector(function, input), OT::Less(), 0.0));
  subset.setMaximumOuterSampling(blocks);
  subset.setBlockSize(block);
  std::string problem;
  try {
    subset.run();
  } catch (const OT::Exception& error) {
    problem = error.what();
  }
  // Where the first level is all, it is crude Monte Carlo, and counted as such (OpenTURNS finds no variance there now
  // and then).
  const double share = static_cast<double>(tally->early) / static_cast<double>(tally->first_level);
  if (tally->samples >= tally->first_level && share >= subset.getConditionalProbability())
    return {share, std::sqrt((1.0 - share) / static_cast<double>(tally->early)), tally->early, tally->first_level, ""};
  if (!problem.empty()) return {0.0, 0.0, 0, 0, problem};
  // Levels that come no nearer end without a failure, which OpenTURNS counts as if they had arrived.
  if (tally->failures == 0) return {0.0, 0.0, 0, 0, "no failure was met: its levels came no nearer"};
  const OT::Point thresholds = subset.getThresholdPerStep();
  if (thresholds.getSize() == 0 || thresholds[thresholds.getSize() - 1] > 0.0)
    return {0.0, 0.0, 0, 0, "its levels did not arrive at failure"};
  const OT::ProbabilitySimulationResult result = subset.getResult();
  return {result.getProbabilityEstimate(), result.getCoefficientOfVariation(), 0, 0, ""};
}

struct Mean {
  double value = 0.0, cov = std::numeric_limits<double>::infinity();
  Interval interval;
};

// The interval is of the logarithm: probabilities of repetitions scatter by factors.
Mean mean_of(const std::vector<Repetition>& all, double confidence) {
  Mean mean;
  const double n = static_cast<double>(all.size());
  double least = 1.0;
  for (const Repetition& r : all) mean.value += r.probability / n, least = std::min(least, r.probability);
  if (least <= 0.0 || all.size() < 2) return mean;
  if (std::all_of(all.begin(), all.end(), [](const Repetition& r) { return r.samples > 0; })) {
    double failures = 0.0, samples = 0.0;
    for (const Repetition& r : all)
      failures += static_cast<double>(r.failures), samples += static_cast<double>(r.samples);
    return {failures / samples, std::sqrt((1.0 - failures / samples) / failures),
            proportion_interval(failures, samples, confidence)};
  }
  double squares = 0.0, inner = 0.0;
  for (const Repetition& r : all) {
    squares += (r.probability - mean.value) * (r.probability - mean.value);
    inner += std::pow(r.cov * r.probability, 2) / n; // what each says of itself
  }
  const double variance = std::max(squares / (n - 1.0), inner);
  mean.cov = std::sqrt(variance / n) / mean.value;
  const double half = student_quantile(n - 1.0, 0.5 * (1.0 + confidence)) * mean.cov;
  mean.interval = {mean.value * std::exp(-half), std::min(1.0, mean.value * std::exp(half))};
  return mean;
}

// Where all repetitions met nothing, a probability of zero with the bounds of nothing known is an honest answer; where
// some did, their mean is none.
void add_problems(const std::vector<Repetition>& all, Estimate& e) {
  const auto failed = std::count_if(all.begin(), all.end(), [](const Repetition& r) { return !r.problem.empty(); });
  if (failed == 0) return;
  const auto first = std::find_if(all.begin(), all.end(), [](const Repetition& r) { return !r.problem.empty(); });
  e.status =
      std::to_string(failed) + " of " + std::to_string(all.size()) + " repetitions have no result: " + first->problem;
  e.is_target_met = false;
  e.is_trusted = e.is_trusted && failed == static_cast<long>(all.size());
}

} // namespace

Estimate subset_simulation(LimitFunction& limit, const SamplingTarget& target) {
  OT::Log::Show(OT::Log::NONE);
  const Study& study = limit.run().study();
  const long before = limit.asked(), bad = limit.bad();
  const double begin = limit.run().evaluator.seconds();
  std::vector<Repetition> unsafe, safe;
  bool is_late = false;
  const bool is_unsafe_first = study.failed != "safe";
  for (long k = 0; k < study.reliability.repetitions && !is_late; ++k) {
    unsafe.push_back(repeat(limit, is_unsafe_first, k));
    is_late = target.seconds && limit.run().evaluator.seconds() - begin > *target.seconds;
  }
  Estimate e;
  e.method = "subset";
  e.bad = limit.bad() - bad;
  if (e.bad > 0 && study.failed == "bounds")
    for (long k = 0; k < static_cast<long>(unsafe.size()); ++k) safe.push_back(repeat(limit, false, k));
  const Mean high = mean_of(unsafe, target.confidence), low = safe.empty() ? high : mean_of(safe, target.confidence);
  e.safe = low.value;
  e.unsafe = high.value;
  e.safe_interval = low.interval;
  e.unsafe_interval = high.interval;
  e.cov = std::max(low.cov, high.cov);
  e.samples = limit.asked() - before;
  e.is_target_met = e.cov <= target.cov;
  if (!e.is_target_met) {
    char text[120];
    std::snprintf(text, sizeof text, "%zu repetitions: coefficient of variation %.3g, %.3g was asked for",
                  unsafe.size(), e.cov, target.cov);
    e.status = text;
  }
  add_problems(unsafe, e);
  add_problems(safe, e);
  return e;
}

} // namespace steplap::study
