#include "tools/study/design_points.h"

#include <openturns/AbdoRackwitz.hxx>
#include <openturns/CompositeRandomVector.hxx>
#include <openturns/FORM.hxx>
#include <openturns/Less.hxx>
#include <openturns/Log.hxx>
#include <openturns/Normal.hxx>
#include <openturns/SORM.hxx>
#include <openturns/ThresholdEvent.hxx>

#include <cmath>

namespace steplap::study {

namespace {

// A run that has no result has no gradient either: the search from this start ends.
class BadSample : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

std::vector<double> vector_of(const OT::Point& p) { return {p.begin(), p.end()}; }

double g_at(LimitFunction& limit, const OT::Point& u) {
  const LimitValue value = limit.at_point(vector_of(u));
  if (value.is_bad) throw BadSample("a run without result lay on the way");
  return value.g;
}

// g, and its differences asked for in one batch each, so that all processors have something to do.
class LimitEvaluation : public OT::EvaluationImplementation {
public:
  explicit LimitEvaluation(LimitFunction& limit) : limit_(&limit) {
    setInputDescription(OT::Description::BuildDefault(limit.dimension(), "u"));
    setOutputDescription(OT::Description(1, "g"));
  }
  LimitEvaluation* clone() const override { return new LimitEvaluation(*this); }
  OT::UnsignedInteger getInputDimension() const override { return limit_->dimension(); }
  OT::UnsignedInteger getOutputDimension() const override { return 1; }
  OT::Point operator()(const OT::Point& u) const override { return OT::Point(1, g_at(*limit_, u)); }
  OT::Sample operator()(const OT::Sample& sample) const override {
    OT::Sample result(sample.getSize(), 1);
    for (OT::UnsignedInteger i = 0; i < sample.getSize(); ++i) result(i, 0) = g_at(*limit_, sample[i]);
    return result;
  }

private:
  LimitFunction* limit_;
};

std::vector<double> gradient_at(LimitFunction& limit, const std::vector<double>& u, double h) {
  const std::size_t n = u.size();
  std::vector<double> points;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    points.insert(points.end(), u.begin(), u.end());
    points[i * n + i / 2] += i % 2 ? -h : h;
  }
  const std::vector<LimitValue>& g = limit.at(points);
  std::vector<double> gradient(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (g[2 * i].is_bad || g[2 * i + 1].is_bad) throw BadSample("a run without result lay on the way");
    gradient[i] = (g[2 * i].g - g[2 * i + 1].g) / (2.0 * h);
  }
  return gradient;
}

class LimitGradient : public OT::GradientImplementation {
public:
  LimitGradient(LimitFunction& limit, double h) : limit_(&limit), h_(h) {}
  LimitGradient* clone() const override { return new LimitGradient(*this); }
  OT::UnsignedInteger getInputDimension() const override { return limit_->dimension(); }
  OT::UnsignedInteger getOutputDimension() const override { return 1; }
  OT::Matrix gradient(const OT::Point& u) const override {
    const std::vector<double> d = gradient_at(*limit_, vector_of(u), h_);
    OT::Matrix matrix(d.size(), 1);
    for (std::size_t i = 0; i < d.size(); ++i) matrix(i, 0) = d[i];
    return matrix;
  }

private:
  LimitFunction* limit_;
  double h_;
};

class LimitHessian : public OT::HessianImplementation {
public:
  LimitHessian(LimitFunction& limit, double h) : limit_(&limit), h_(h) {}
  LimitHessian* clone() const override { return new LimitHessian(*this); }
  OT::UnsignedInteger getInputDimension() const override { return limit_->dimension(); }
  OT::UnsignedInteger getOutputDimension() const override { return 1; }
  OT::SymmetricTensor hessian(const OT::Point& at) const override {
    const std::vector<double> u = vector_of(at);
    const std::size_t n = u.size();
    std::vector<double> points(u);
    const auto add = [&](std::size_t i, double di, std::size_t j, double dj) {
      points.insert(points.end(), u.begin(), u.end());
      points[points.size() - n + i] += di;
      points[points.size() - n + j] += dj;
    };
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j <= i; ++j)
        for (const double si : {1.0, -1.0})
          for (const double sj : {1.0, -1.0})
            if (i != j || si == sj)
              add(i, 0.5 * si * h_ * (i == j ? 1.0 : 2.0), j, 0.5 * sj * h_ * (i == j ? 1.0 : 2.0));
    const std::vector<LimitValue>& g = limit_->at(points);
    for (const LimitValue& value : g)
      if (value.is_bad) throw BadSample("a run without result lay on the way");
    OT::SymmetricTensor tensor(n, 1);
    std::size_t k = 1;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        if (i == j) tensor(i, j, 0) = (g[k].g - 2.0 * g[0].g + g[k + 1].g) / (h_ * h_), k += 2;
        else tensor(i, j, 0) = (g[k].g - g[k + 1].g - g[k + 2].g + g[k + 3].g) / (4.0 * h_ * h_), k += 4;
      }
    return tensor;
  }

private:
  LimitFunction* limit_;
  double h_;
};

OT::RandomVector event_of(LimitFunction& limit, double h) {
  // Second differences take a larger step: their noise goes with its square.
  const OT::Function function{
      OT::Evaluation(OT::Pointer<OT::EvaluationImplementation>(new LimitEvaluation(limit))),
      OT::Gradient(OT::Pointer<OT::GradientImplementation>(new LimitGradient(limit, h))),
      OT::Hessian(OT::Pointer<OT::HessianImplementation>(new LimitHessian(limit, std::max(10.0 * h, 1e-3))))};
  const OT::RandomVector input{OT::Distribution(OT::Normal(limit.dimension()))};
  return OT::ThresholdEvent(OT::CompositeRandomVector(function, input), OT::Less(), 0.0);
}

// The first start is the origin; the others lie in random directions.
OT::Point start_of(const LimitFunction& limit, const CounterRandom& random, long k) {
  constexpr double k_far = 3.0;
  const std::size_t n = limit.dimension();
  OT::Point start(n, 0.0);
  if (k == 0) return start;
  for (std::size_t i = 0; i < n; ++i)
    start[i] = random.normal(static_cast<std::uint64_t>(k), static_cast<std::uint32_t>(i));
  return start * (k_far / start.norm());
}

void judge(LimitFunction& limit, double h, DesignPoint& point) {
  constexpr double k_on_surface = 1e-4, k_aligned = 1e-4;
  const std::size_t n = point.u.size();
  const std::vector<double> gradient = gradient_at(limit, point.u, h);
  const double steepness = length_of(gradient.data(), n), distance = length_of(point.u.data(), n);
  point.g = limit.at_point(point.u).g;
  point.off_surface = steepness > 0.0 ? std::abs(point.g) / steepness : std::numeric_limits<double>::infinity();
  double product = 0.0;
  for (std::size_t i = 0; i < n; ++i) product += point.u[i] * gradient[i];
  point.misalignment = distance > 0.0 && steepness > 0.0 ? 1.0 - std::abs(product) / (distance * steepness) : 0.0;
  point.is_found = point.off_surface < k_on_surface * std::max(1.0, distance) && point.misalignment < k_aligned;
}

bool is_same(const DesignPoint& a, const DesignPoint& b) {
  constexpr double k_near = 1e-2;
  double square = 0.0;
  for (std::size_t i = 0; i < a.u.size(); ++i) square += (a.u[i] - b.u[i]) * (a.u[i] - b.u[i]);
  return std::sqrt(square) < k_near * std::max(1.0, std::abs(a.beta));
}

DesignPoint point_of(const OT::FORMResult& result) {
  DesignPoint point;
  point.u = vector_of(result.getStandardSpaceDesignPoint());
  const double distance = length_of(point.u.data(), point.u.size());
  point.beta = result.getIsStandardPointOriginInFailureSpace() ? -distance : distance;
  for (const double x : point.u) point.alpha.push_back(distance > 0.0 ? -x / point.beta : 0.0);
  point.breitung = point.hohenbichler = point.tvedt = std::nan("");
  return point;
}

void add_second_order(LimitFunction& limit, const OT::OptimizationAlgorithm& search, double h, DesignPoint& point) {
  try {
    OT::Point start(point.u.size());
    std::copy(point.u.begin(), point.u.end(), start.begin());
    OT::SORM sorm(search, event_of(limit, h), start);
    sorm.run();
    const OT::SORMResult result = sorm.getResult();
    point.breitung = result.getEventProbabilityBreitung();
    try {
      point.hohenbichler = result.getEventProbabilityHohenbichler();
      point.tvedt = result.getEventProbabilityTvedt();
    } catch (const OT::Exception&) { // where curvatures are too large for them
    }
  } catch (const OT::Exception&) {
  } catch (const BadSample&) {
  }
}

OT::AbdoRackwitz search_algorithm() {
  OT::Log::Show(OT::Log::NONE);
  OT::AbdoRackwitz search;
  // Steps of 1e-6 standard deviations end it: beta is known to the square of that. Points that have not arrived are
  // told by judge().
  search.setMaximumEvaluationNumber(1000);
  search.setMaximumIterationNumber(60);
  search.setMaximumAbsoluteError(1e-6);
  search.setMaximumRelativeError(1e-6);
  search.setMaximumConstraintError(1e-12);
  search.setMaximumResidualError(1e-12);
  return search;
}

// True if the point is new.
bool add_point(DesignPoint point, std::vector<DesignPoint>& points) {
  for (DesignPoint& other : points)
    if (is_same(point, other)) {
      if (point.is_found && (!other.is_found || point.off_surface < other.off_surface)) other = std::move(point);
      return false;
    }
  points.push_back(std::move(point));
  return true;
}

// One search; what ends it early is noted.
bool search_from(LimitFunction& limit, const OT::Point& start, DesignPoints& found) {
  const double h = limit.run().study().reliability.difference;
  ++found.starts;
  try {
    OT::FORM form(search_algorithm(), event_of(limit, h), start);
    form.run();
    DesignPoint point = point_of(form.getResult());
    judge(limit, h, point);
    return add_point(std::move(point), found.points);
  } catch (const OT::Exception& error) {
    if (found.failed_starts++ == 0) found.trouble = error.what();
  } catch (const BadSample& error) {
    if (found.failed_starts++ == 0) found.trouble = error.what();
  }
  return false;
}

void sort_points(std::vector<DesignPoint>& points) {
  std::stable_sort(points.begin(), points.end(), [](const DesignPoint& a, const DesignPoint& b) {
    return a.is_found != b.is_found ? a.is_found : std::abs(a.beta) < std::abs(b.beta);
  });
}

} // namespace

DesignPoints find_design_points(LimitFunction& limit, bool is_second_order) {
  const ReliabilitySettings& settings = limit.run().study().reliability;
  const CounterRandom random(static_cast<std::uint64_t>(limit.run().study().seed), 3);
  DesignPoints found;
  const long before = limit.asked();
  for (long k = 0; k < settings.starts; ++k) (void)search_from(limit, start_of(limit, random, k), found);
  sort_points(found.points);
  if (is_second_order && !found.points.empty() && found.points.front().is_found)
    for (DesignPoint& point : found.points)
      if (point.is_found) add_second_order(limit, search_algorithm(), settings.difference, point);
  found.samples = limit.asked() - before;
  return found;
}

bool search_again(LimitFunction& limit, const std::vector<double>& start, DesignPoints& found) {
  const long before = limit.asked();
  OT::Point u(start.size());
  std::copy(start.begin(), start.end(), u.begin());
  const bool is_new = search_from(limit, u, found);
  sort_points(found.points);
  found.samples += limit.asked() - before;
  return is_new;
}

} // namespace steplap::study
