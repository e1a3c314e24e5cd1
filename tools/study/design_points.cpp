#include "tools/study/design_points.h"

#include "tools/study/design_search.h"
#include "tools/study/reliability.h"

#include <openturns/AbdoRackwitz.hxx>
#include <openturns/CompositeRandomVector.hxx>
#include <openturns/Less.hxx>
#include <openturns/Log.hxx>
#include <openturns/Normal.hxx>
#include <openturns/SORM.hxx>
#include <openturns/ThresholdEvent.hxx>

#include <algorithm>
#include <cmath>
#include <utility>

namespace steplap::study {

namespace {

// Thrown if a run has no result. The gradient is then unknown, and the search from this start ends.
class BadSample : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

double cosine_between(const std::vector<double>& a, const std::vector<double>& b) {
  double product = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) product += a[i] * b[i];
  const double lengths = length_of(a.data(), a.size()) * length_of(b.data(), b.size());
  return lengths > 0.0 ? product / lengths : 0.0;
}

std::vector<double> vector_of(const OT::Point& p) { return {p.begin(), p.end()}; }

double g_at(LimitFunction& limit, const OT::Point& u) {
  const LimitValue value = limit.at_point(vector_of(u));
  if (value.is_missing) throw BadSample("a run without result lay on the way");
  return value.g;
}

// The limit function g for OpenTURNS. All points of an evaluation are run in one batch, so that all processors are used.
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

class LimitGradient : public OT::GradientImplementation {
public:
  LimitGradient(LimitFunction& limit, double h) : limit_(&limit), h_(h) {}
  LimitGradient* clone() const override { return new LimitGradient(*this); }
  OT::UnsignedInteger getInputDimension() const override { return limit_->dimension(); }
  OT::UnsignedInteger getOutputDimension() const override { return 1; }
  OT::Matrix gradient(const OT::Point& u) const override {
    const auto d = gradient_at(*limit_, vector_of(u), h_);
    if (!d) throw BadSample("a run without result lay on the way");
    OT::Matrix matrix(d->size(), 1);
    for (std::size_t i = 0; i < d->size(); ++i) matrix(i, 0) = (*d)[i];
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
            if (i != j || si == sj) add(i, 0.5 * si * h_ * (i == j ? 1.0 : 2.0), j, 0.5 * sj * h_ * (i == j ? 1.0 : 2.0));
    const std::vector<LimitValue>& g = limit_->at(points);
    for (const LimitValue& value : g)
      if (value.is_missing) throw BadSample("a run without result lay on the way");
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
  // Second differences use a larger step h, because their noise is proportional to 1/h².
  const OT::Function function{OT::Evaluation(OT::Pointer<OT::EvaluationImplementation>(new LimitEvaluation(limit))),
                              OT::Gradient(OT::Pointer<OT::GradientImplementation>(new LimitGradient(limit, h))),
                              OT::Hessian(OT::Pointer<OT::HessianImplementation>(new LimitHessian(limit, std::max(10.0 * h, 1e-3))))};
  const OT::RandomVector input{OT::Distribution(OT::Normal(limit.dimension()))};
  return OT::ThresholdEvent(OT::CompositeRandomVector(function, input), OT::Less(), 0.0);
}

// Checks whether a search ended at a design point: on the surface g = 0, with u parallel to the gradient.
DesignPoint point_of(LimitFunction& limit, const SearchEnd& end, bool is_origin_failing) {
  constexpr double k_on_surface = 1e-4, k_aligned = 1e-4;
  DesignPoint point;
  point.u = end.u;
  const std::size_t n = point.u.size();
  const double distance = length_of(point.u.data(), n);
  point.beta = is_origin_failing ? -distance : distance;
  for (const double x : point.u) point.alpha.push_back(distance > 0.0 ? -x / point.beta : 0.0);
  point.breitung = std::nan("");
  point.g = end.g;
  point.off_surface = std::numeric_limits<double>::infinity();
  const auto gradient = gradient_at(limit, point.u, limit.settings().difference);
  const double steepness = gradient ? length_of(gradient->data(), n) : 0.0;
  if (!(steepness > 0.0)) return point;
  point.off_surface = std::abs(point.g) / steepness;
  double product = 0.0;
  for (std::size_t i = 0; i < n; ++i) product += point.u[i] * (*gradient)[i];
  point.misalignment = distance > 0.0 ? 1.0 - std::abs(product) / (distance * steepness) : 0.0;
  point.is_found = point.off_surface < k_on_surface * std::max(1.0, distance) && point.misalignment < k_aligned;
  return point;
}

bool is_same(const DesignPoint& a, const DesignPoint& b) {
  constexpr double k_near = 1e-2;
  return distance_between(a.u, b.u) < k_near * std::max(1.0, std::abs(a.beta));
}

void add_second_order(LimitFunction& limit, const OT::OptimizationAlgorithm& search, double h, DesignPoint& point) {
  try {
    OT::Point start(point.u.size());
    std::copy(point.u.begin(), point.u.end(), start.begin());
    OT::SORM sorm(search, event_of(limit, h), start);
    sorm.run();
    point.breitung = sorm.getResult().getEventProbabilityBreitung();
  } catch (const OT::Exception&) {
  } catch (const BadSample&) {}
}

// Returns a search algorithm that reports a known design point, as required by OpenTURNS.
OT::AbdoRackwitz search_algorithm() {
  OT::Log::Show(OT::Log::NONE);
  OT::AbdoRackwitz search;
  search.setMaximumEvaluationNumber(1000);
  search.setMaximumIterationNumber(60);
  search.setMaximumAbsoluteError(1e-6);
  search.setMaximumRelativeError(1e-6);
  search.setMaximumConstraintError(1e-12);
  search.setMaximumResidualError(1e-12);
  return search;
}

// Returns true if the point is new.
bool add_point(DesignPoint point, std::vector<DesignPoint>& points) {
  for (DesignPoint& other : points)
    if (is_same(point, other)) {
      if (point.is_found && (!other.is_found || point.off_surface < other.off_surface)) other = std::move(point);
      return false;
    }
  points.push_back(std::move(point));
  return true;
}

// Returns true if sampling needs this point: it is no nearer than 1.5 standard deviations to any other, where a sample around that has three
// times the weight, and its first-order probability is not below a hundredth of theirs.
bool is_needed(const DesignPoint& point, const std::vector<DesignPoint>& others) {
  constexpr double k_apart = 1.5, k_little = 0.01;
  return point.is_found && std::none_of(others.begin(), others.end(), [&](const DesignPoint& other) {
           const bool is_little = normal_cdf(-std::abs(point.beta)) < k_little * normal_cdf(-std::abs(other.beta));
           return other.is_found && (is_little || distance_between(point.u, other.u) < k_apart);
         });
}

// Runs one search until sample number `last`; records the reason if it ends early. Returns true if it found a new point. `is_away`: the
// start is away from all points.
bool search_from(LimitFunction& limit, const std::vector<double>& start, long last, DesignPoints& found, bool is_away) {
  ++found.starts;
  // searches that failed closer than this to the surface, relative, are treated as known: other starts would oscillate there, too
  constexpr double k_near_surface = 1e-2;
  std::vector<std::vector<double>> known;
  for (const DesignPoint& p : found.points)
    if (p.is_found || p.off_surface < k_near_surface) known.push_back(p.u);
  const SearchEnd end = search_design_point(limit, start, known, last);
  if (!end.trouble.empty() && found.failed_starts++ == 0) found.trouble = end.trouble;
  // A search that could not leave its start has seen nothing, unless none can, as of limit states with few values.
  found.fruitless += is_away && (end.is_known || end.u != start || found.needed == 0);
  if (end.is_known || end.is_bad) return false;
  DesignPoint point = point_of(limit, end, found.is_origin_failing);
  if (is_needed(point, found.points)) {
    ++found.needed;
    found.fruitless = 0;
  }
  return add_point(std::move(point), found.points);
}

void sort_points(std::vector<DesignPoint>& points) {
  std::stable_sort(points.begin(), points.end(), [](const DesignPoint& a, const DesignPoint& b) {
    return a.is_found != b.is_found ? a.is_found : std::abs(a.beta) < std::abs(b.beta);
  });
}

// Returns the largest number of samples for all searches together. A search takes about five steps with one gradient each, and most
// searches end at known points.
long budget_of(const LimitFunction& limit) {
  return limit.settings().search_samples.value_or(300 + 50 * static_cast<long>(limit.dimension()));
}

std::vector<double> random_direction(const CounterRandom& random, std::uint64_t k, std::size_t dimension) {
  std::vector<double> a;
  for (std::size_t i = 0; i < dimension; ++i) a.push_back(random.normal(k, static_cast<std::uint32_t>(i)));
  const double length = length_of(a.data(), dimension);
  for (double& x : a) x /= length;
  return a;
}

// Returns well separated directions: of many random ones, repeatedly the one farthest from all chosen before.
std::vector<std::vector<double>> spread_directions(const LimitFunction& limit, long count) {
  constexpr long k_pool = 20; // candidates per direction
  const CounterRandom random(static_cast<std::uint64_t>(limit.study().seed), 3);
  std::vector<std::vector<double>> pool, directions;
  for (long k = 1; k <= k_pool * count; ++k) pool.push_back(random_direction(random, static_cast<std::uint64_t>(k), limit.dimension()));
  std::vector<double> nearest(pool.size(), -1.0); // largest cosine of the angle to a chosen direction
  for (std::size_t next = 0; static_cast<long>(directions.size()) < count;) {
    directions.push_back(pool[next]);
    for (std::size_t i = 0; i < pool.size(); ++i) nearest[i] = std::max(nearest[i], cosine_between(pool[i], directions.back()));
    next = static_cast<std::size_t>(std::min_element(nearest.begin(), nearest.end()) - nearest.begin());
  }
  return directions;
}

constexpr double k_far = 3.0; // distance of starts from the origin

// Chooses the start points. The limit state is evaluated in three well separated directions per start. Points with the lowest values
// (highest, if the origin fails) are chosen that are well separated from each other and from known design points.
std::vector<std::vector<double>> starts_of(LimitFunction& limit, long count, const DesignPoints& found) {
  constexpr double k_apart = 0.9; // cosine between two directions
  std::vector<std::vector<double>> looks = spread_directions(limit, 3 * count);
  std::vector<double> points;
  for (std::vector<double>& u : looks) {
    for (double& x : u) x *= k_far;
    points.insert(points.end(), u.begin(), u.end());
  }
  if (looks.empty()) return {};
  const std::vector<LimitValue> values = limit.at(points);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < looks.size(); ++i)
    if (!values[i].is_missing) order.push_back(i);
  const double sign = found.is_origin_failing ? -1.0 : 1.0;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sign * values[a].g < sign * values[b].g; });
  std::vector<std::vector<double>> starts, taken;
  for (const DesignPoint& p : found.points)
    if (p.is_found) taken.push_back(p.u);
  for (const std::size_t i : order) {
    if (static_cast<long>(starts.size()) == count) break;
    const bool is_apart = std::none_of(taken.begin(), taken.end(),
                                       [&](const std::vector<double>& other) { return cosine_between(other, looks[i]) > k_apart; });
    if (!is_apart) continue;
    taken.push_back(looks[i]);
    starts.push_back(looks[i]);
  }
  return starts;
}

// Returns directions away from all points, for searches of unknown ones. Many limit states have design points at right angles. From a place
// without a component along the known points, the gradient points to an unknown one.
class AwayDirections {
public:
  AwayDirections(const LimitFunction& limit, const DesignPoints& found)
      : random_(static_cast<std::uint64_t>(limit.study().seed), 14), dimension_(limit.dimension()), found_(found),
        next_(static_cast<std::uint64_t>(k_pool * found.starts)) {}

  // In turn a direction at right angles to all points, the opposite one, one without a component towards any point, and one as far from all
  // points and earlier directions as there is. The last one replaces those for which the points leave no room, and all if `is_any`.
  std::vector<double> next(bool is_any) {
    const long turn = is_any ? 3 : turn_++ % 4;
    std::vector<double> direction;
    if (turn == 1) {
      direction = used_.back();
      for (double& x : direction) x = -x;
    } else {
      std::vector<double> far = farthest(), turned = turn == 3 ? std::vector<double>() : turned_away(far, turn == 2);
      direction = std::move(turned.empty() ? far : turned);
    }
    return used_.emplace_back(std::move(direction));
  }

private:
  std::vector<double> farthest() {
    std::vector<double> best;
    double least = 2.0;
    for (long k = 0; k < k_pool; ++k) {
      std::vector<double> a = random_direction(random_, next_++, dimension_);
      double largest = -1.0;
      for (const DesignPoint& p : found_.points)
        if (p.is_found) largest = std::max(largest, cosine_between(a, p.u));
      for (const std::vector<double>& other : used_) largest = std::max(largest, cosine_between(a, other));
      if (largest >= least) continue;
      least = largest;
      best = std::move(a);
    }
    return best;
  }

  // Removes the components along the points, or only those towards them. Returns nothing if little is left.
  [[nodiscard]] std::vector<double> turned_away(std::vector<double> a, bool is_one_sided) const {
    constexpr int k_sweeps = 20;
    constexpr double k_little = 0.1;
    for (int sweep = 0; sweep < k_sweeps; ++sweep)
      for (const DesignPoint& p : found_.points) {
        const double cosine = p.is_found ? cosine_between(a, p.u) : 0.0, own = length_of(a.data(), dimension_);
        if (is_one_sided && cosine <= 0.0) continue;
        for (std::size_t i = 0; i < dimension_; ++i) a[i] -= cosine * own * p.u[i] / std::max(std::abs(p.beta), 1e-300);
      }
    const double left = length_of(a.data(), dimension_);
    if (left < k_little) return {};
    for (double& x : a) x /= left;
    return a;
  }

  static constexpr long k_pool = 200; // candidates per direction
  CounterRandom random_;
  std::size_t dimension_;
  const DesignPoints& found_;
  std::uint64_t next_;
  std::vector<std::vector<double>> used_;
  long turn_ = 0;
};

} // namespace

DesignPoints find_design_points(LimitFunction& limit, bool is_second_order) {
  const auto& settings = limit.settings();
  const std::vector<double> origin(limit.dimension(), 0.0);
  DesignPoints found;
  const long before = limit.asked(), last = before + budget_of(limit);
  const LimitValue value = limit.at_point(origin);
  found.is_origin_failing = !value.is_missing && value.g < 0.0;
  (void)search_from(limit, origin, last, found, false);
  for (const std::vector<double>& start : starts_of(limit, settings.starts - 1, found)) {
    if (limit.asked() >= last) {
      ++found.left_starts;
      continue;
    }
    const auto known = std::count_if(found.points.begin(), found.points.end(), [](const DesignPoint& p) { return p.is_found; });
    (void)search_from(limit, start, last, found, known < 2); // starts are not chosen to be away from what later ones found
  }
  sort_points(found.points);
  if (is_second_order && !found.points.empty() && found.points.front().is_found)
    for (DesignPoint& point : found.points)
      if (point.is_found) add_second_order(limit, search_algorithm(), settings.difference, point);
  found.samples = limit.asked() - before;
  return found;
}

bool search_on(LimitFunction& limit, DesignPoints& found) {
  constexpr std::size_t k_most_points = 64; // more of them are on a surface at one distance, which the wide part of the density covers
  const long before = limit.asked(), n = static_cast<long>(limit.dimension());
  const bool is_limited = limit.settings().search_samples.has_value();
  long last = before + (is_limited ? std::max(0L, budget_of(limit) - found.samples) : budget_of(limit) / 2);
  AwayDirections directions(limit, found);
  const long needed_before = found.needed;
  bool is_level = false; // at right angles to all points, the limit state does not vary
  while (!found.is_searched_out() && limit.asked() < last && (is_limited || found.points.size() < k_most_points)) {
    std::vector<double> start = directions.next(is_level);
    for (double& x : start) x *= k_far;
    const long needed = found.needed, fruitless = found.fruitless;
    (void)search_from(limit, start, last, found, true);
    is_level = is_level || (found.needed == needed && found.fruitless == fruitless);
    if (found.needed > needed && !is_limited) last += 8 * (n + 5); // what a search takes that arrives: about four gradients
  }
  sort_points(found.points);
  found.samples += limit.asked() - before;
  return found.needed > needed_before;
}

bool search_again(LimitFunction& limit, const std::vector<double>& start, DesignPoints& found) {
  const long before = limit.asked();
  const bool is_new = search_from(limit, start, before + budget_of(limit) / 2, found, false);
  sort_points(found.points);
  found.samples += limit.asked() - before;
  return is_new;
}

} // namespace steplap::study
