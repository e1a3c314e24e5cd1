// Subset simulation by OpenTURNS, several times over: the scatter of independent repetitions makes the interval.
#include "tools/study/samplers.h"

#include <openturns/CompositeRandomVector.hxx>
#include <openturns/Less.hxx>
#include <openturns/Log.hxx>
#include <openturns/Normal.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/SubsetSampling.hxx>
#include <openturns/ThresholdEvent.hxx>

#include <cmath>

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
    for (OT::UnsignedInteger i = 0; i < sample.getSize(); ++i) result(i, 0) = values[i].is_bad ? (is_bad_unsafe_ ? -k_extreme : k_extreme) : values[i].g;
    return result;
  }

private:
  LimitFunction* limit_;
  bool is_bad_unsafe_;
};

struct Repetition {
  double probability = 0.0, cov = 0.0;
};

Repetition repeat(LimitFunction& limit, bool is_bad_unsafe, long k) {
  const Study& study = limit.run().study();
  OT::RandomGenerator::SetSeed(static_cast<OT::UnsignedInteger>(study.seed * 1000003 + k * 7919 + (is_bad_unsafe ? 1 : 0)));
  const OT::Function function{OT::Evaluation(OT::Pointer<OT::EvaluationImplementation>(new SubsetEvaluation(limit, is_bad_unsafe)))};
  const OT::RandomVector input{OT::Distribution(OT::Normal(limit.dimension()))};
  OT::SubsetSampling subset(OT::ThresholdEvent(OT::CompositeRandomVector(function, input), OT::Less(), 0.0));
  const auto samples = static_cast<OT::UnsignedInteger>(study.reliability.subset_samples), block = std::max<OT::UnsignedInteger>(1, samples / 10);
  subset.setMaximumOuterSampling((samples + block - 1) / block);
  subset.setBlockSize(block);
  subset.run();
  const OT::ProbabilitySimulationResult result = subset.getResult();
  return {result.getProbabilityEstimate(), result.getCoefficientOfVariation()};
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
    std::snprintf(text, sizeof text, "%zu repetitions: coefficient of variation %.3g, %.3g was asked for", unsafe.size(), e.cov, target.cov);
    e.status = text;
  }
  return e;
}

} // namespace steplap::study
