#include "tools/study/design_search.h"

#include "tools/study/reliability.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

namespace {

constexpr int k_most_steps = 30, k_most_halvings = 8;
// the search has converged if the step is shorter than this, relative to |u|; the error of beta is quadratic in it
constexpr double k_arrived = 1e-5;
constexpr double k_known = 0.1; // the search ends at this distance from a known design point, relative to |u|

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Returns the zero of the linearised g that is closest to the origin.
std::vector<double> aim_of(const SearchEnd& at) {
  const double scale = (product(at.gradient, at.u) - at.g) / product(at.gradient, at.gradient);
  std::vector<double> aim(at.gradient);
  for (double& x : aim) x *= scale;
  return aim;
}

std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b, double share) {
  std::vector<double> u(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) u[i] = a[i] + share * (b[i] - a[i]);
  return u;
}

bool is_near_any(const std::vector<std::vector<double>>& known, const std::vector<double>& u) {
  const double near = k_known * std::max(1.0, length_of(u.data(), u.size()));
  return std::any_of(known.begin(), known.end(), [&](const std::vector<double>& k) { return distance_between(k, u) < near; });
}

class Search {
public:
  Search(LimitFunction& limit, long last) : limit_(limit), last_(last) {}

  SearchEnd from(std::vector<double> start, const std::vector<std::vector<double>>& known) {
    at_.u = std::move(start);
    const LimitValue value = limit_.at_point(at_.u);
    if (value.is_missing) return ended_badly();
    at_.g = value.g;
    for (int step = 0; step < k_most_steps; ++step) {
      const auto gradient = gradient_at(limit_, at_.u, limit_.settings().difference);
      if (!gradient) return ended_badly();
      at_.gradient = *gradient;
      if (!(product(at_.gradient, at_.gradient) > 0.0)) return ended("the limit state is level where it stood");
      const std::vector<double> aim = aim_of(at_);
      at_.is_known = is_near_any(known, aim) && (is_near_any(known, at_.u) || is_plane(aim));
      if (at_.is_known) return at_;
      const double way = distance_between(at_.u, aim), size = std::max(1.0, length_of(aim.data(), aim.size()));
      if (stands_still()) return ended("it went to and fro where the limit state has an edge");
      if (!go(aim)) return at_;
      if (way < k_arrived * size) return at_;
      if (limit_.asked() >= last_) return ended("the samples for searches were used up");
    }
    return ended("its steps came to no end");
  }

private:
  SearchEnd ended(const char* why) {
    at_.trouble = why;
    return at_;
  }

  SearchEnd ended_badly() {
    at_.is_bad = true;
    return ended("a run without result lay on the way");
  }

  // Returns true if four consecutive steps stayed on the surface without approaching the origin. The search then oscillates between the
  // gradients on both sides of an edge.
  bool stands_still() {
    constexpr double k_still = 1e-4;
    constexpr int k_steps = 4;
    const double distance = length_of(at_.u.data(), at_.u.size()), size = std::max(1.0, distance),
                 off = std::abs(at_.g) / length_of(at_.gradient.data(), at_.gradient.size());
    const bool is_still = std::abs(distance - last_distance_) < k_still * size && off < k_still * size;
    last_distance_ = distance;
    still_ = is_still ? still_ + 1 : 0;
    return still_ >= k_steps;
  }

  // Tests the linearisation: returns true if g at its predicted zero is less than 0.01 of its previous value.
  bool is_plane(const std::vector<double>& aim) {
    const LimitValue value = limit_.at_point(aim);
    return !value.is_missing && std::abs(value.g) < 0.01 * std::abs(at_.g);
  }

  [[nodiscard]] double merit(const std::vector<double>& u, double g, double c) const { return 0.5 * product(u, u) + c * std::abs(g); }

  // Steps towards the target as far as the merit function decreases sufficiently (Armijo's rule). Any decrease is not enough if the surface
  // has the curvature of the sphere, on which full steps oscillate. Returns false if the merit function does not decrease.
  bool go(const std::vector<double>& aim) {
    const double steepness = length_of(at_.gradient.data(), at_.gradient.size()), distance = length_of(at_.u.data(), at_.u.size());
    const double c = 2.0 * std::max(distance, length_of(aim.data(), aim.size())) / steepness;
    constexpr double k_part = 0.3;
    const double before = merit(at_.u, at_.g, c), slope = product(at_.u, aim) - product(at_.u, at_.u) - c * std::abs(at_.g);
    double share = 1.0;
    for (int k = 0; k <= k_most_halvings; ++k, share *= 0.5) {
      const std::vector<double> u = between(at_.u, aim, share);
      const LimitValue value = limit_.at_point(u);
      if (value.is_missing) continue;
      const bool falls = merit(u, value.g, c) <= before + k_part * share * slope;
      if (!falls && share * distance_between(at_.u, aim) > k_arrived) continue;
      at_.u = u;
      at_.g = value.g;
      return true;
    }
    at_.trouble = "its steps came no nearer";
    return false;
  }

  LimitFunction& limit_;
  long last_;
  SearchEnd at_;
  double last_distance_ = std::numeric_limits<double>::infinity();
  int still_ = 0;
};

} // namespace

double distance_between(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

std::optional<std::vector<double>> gradient_at(LimitFunction& limit, const std::vector<double>& u, double h) {
  const std::size_t n = u.size();
  std::vector<double> points;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    points.insert(points.end(), u.begin(), u.end());
    points[i * n + i / 2] += i % 2 ? -h : h;
  }
  const std::vector<LimitValue>& g = limit.at(points);
  std::vector<double> gradient(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (g[2 * i].is_missing || g[2 * i + 1].is_missing) return {};
    gradient[i] = (g[2 * i].g - g[2 * i + 1].g) / (2.0 * h);
  }
  return gradient;
}

SearchEnd search_design_point(LimitFunction& limit, std::vector<double> start, const std::vector<std::vector<double>>& known, long last) {
  return Search(limit, last).from(std::move(start), known);
}

} // namespace steplap::study
