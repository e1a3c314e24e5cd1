// Directional simulation. For a direction a the probability of failure is the integral of the density of the distance over the failing
// intervals of the ray. The ray is divided into strata. In each stratum one point is drawn from the density within the stratum; if it
// fails, the stratum's probability is added. The estimate is unbiased for any shape of the failure region: a band thinner than a stratum is
// hit with the correct probability.
//
// A stratum is divided into three if its neighbours differ, because a border lies in it, and also if a line through the two points on one
// side of it reaches zero inside. This decision must use points outside the stratum only. Its own point is then still distributed over the
// whole stratum, and the division keeps the estimate unbiased. (Dividing strata whose point differs from the neighbours would underestimate
// thin bands: those that are hit would be divided and found to be thin, those that are missed would stay missed.)
#include "tools/study/sampling_course.h"

#include <openturns/DistFunc.hxx>

#include <cmath>

namespace steplap::study {

namespace {

enum class RayState { holds, fails, bad };

struct RayPoint {
  double at = 0.0, g = 0.0; // distance from the origin; limit function
  RayState state = RayState::holds;
};

RayPoint ray_point_at(double at, const LimitValue& value) {
  return {at, value.g, value.is_bad ? RayState::bad : value.g < 0.0 ? RayState::fails : RayState::holds};
}

struct Stratum {
  std::size_t ray;
  double low, high;           // distances from the origin; `high` is infinite in the last stratum
  double tail_low, tail_high; // probability of a distance larger than `low` and than `high`
  bool is_last = false;
  RayPoint own{};
  RayPoint beside[4]{}; // two points before and two after the stratum, outside the stratum that was divided to obtain it

  [[nodiscard]] double probability() const { return tail_low - tail_high; }

  // Returns true if the stratum must be divided. The decision uses neighbouring points only, which keeps the estimate unbiased.
  [[nodiscard]] bool is_to_cut() const {
    // no division below this fraction of the probability of larger distances; it is less than the scatter between rays
    constexpr double k_fine = 0.1;
    if (is_last || probability() <= k_fine * tail_low) return false;
    return beside[1].state != beside[2].state || comes_to_zero(beside[0], beside[1]) || comes_to_zero(beside[3], beside[2]);
  }

private:
  [[nodiscard]] bool comes_to_zero(const RayPoint& far, const RayPoint& near) const {
    if (far.state != near.state || near.state == RayState::bad || far.at == near.at) return false;
    const double zero = near.at - near.g * (near.at - far.at) / (near.g - far.g); // NaN if both values are equal
    return zero > low && zero < high;
  }
};

// Evaluates several rays in one batch, so that all processors are used.
class Rays {
public:
  Rays(LimitFunction& limit, const CounterRandom& random, std::uint64_t first, std::size_t count, const RayPoint& origin)
      : limit_(limit), random_(random), first_(first), n_(limit.dimension()), draws_(count, 0) {
    constexpr double k_beyond = 1e-16; // probability of the last stratum, which extends to infinity
    const double reach = std::sqrt(2.0 * OT::DistFunc::qGamma(0.5 * static_cast<double>(n_), k_beyond, true));
    for (std::size_t i = 0; i < count; ++i) {
      add_direction(i);
      for (std::size_t k = 0; k < k_strata; ++k) {
        const double width = reach / static_cast<double>(k_strata);
        Stratum s{i, width * static_cast<double>(k), width * static_cast<double>(k + 1), 0.0, 0.0, k + 1 == k_strata};
        measure(s);
        place(s);
        strata_.push_back(s);
      }
    }
    sample_rays(strata_);
    for (std::size_t k = 0; k < strata_.size(); ++k) {
      RayPoint* const beside = strata_[k].beside;
      const std::size_t place = k % k_strata;
      beside[1] = place == 0 ? origin : strata_[k - 1].own;
      beside[0] = place == 0 ? origin : place == 1 ? origin : strata_[k - 2].own;
      beside[2] = strata_[k].is_last ? beside[1] : strata_[k + 1].own;
      beside[3] = place + 2 < k_strata ? strata_[k + 2].own : beside[2];
    }
    while (refine()) {}
  }

  /// Returns the probability on each ray of the points for which `wanted` is true.
  template <class Wanted> std::vector<double> probabilities(const Wanted& wanted) const {
    std::vector<double> sums(draws_.size(), 0.0);
    for (const Stratum& s : strata_)
      if (wanted(s.own.state)) sums[s.ray] += s.probability();
    return sums;
  }
  [[nodiscard]] long bad() const { return bad_; }

private:
  void add_direction(std::size_t i) {
    std::vector<double> a(n_);
    for (std::size_t d = 0; d < n_; ++d) a[d] = random_.normal(first_ + i, static_cast<std::uint32_t>(d));
    const double length = length_of(a.data(), n_);
    for (const double x : a) directions_.push_back(x / length);
  }

  void measure(Stratum& s) const {
    const auto beyond = [this](double r) { return OT::DistFunc::pGamma(0.5 * static_cast<double>(n_), 0.5 * r * r, true); };
    s.tail_low = s.low > 0.0 ? beyond(s.low) : 1.0;
    s.tail_high = s.is_last ? 0.0 : beyond(s.high);
  }

  // Draws a random point in the stratum from the distribution of the distance.
  void place(Stratum& s) {
    const double share = random_.uniform(first_ + s.ray, static_cast<std::uint32_t>(n_) + draws_[s.ray]++);
    const double tail = s.tail_high + share * s.probability();
    const double at = std::sqrt(2.0 * OT::DistFunc::qGamma(0.5 * static_cast<double>(n_), tail, true));
    s.own.at = s.is_last ? std::max(at, s.low) : std::clamp(at, s.low, s.high);
  }

  void sample_rays(std::vector<Stratum>& strata) {
    if (strata.empty()) return;
    std::vector<double> points;
    for (const Stratum& s : strata)
      for (std::size_t d = 0; d < n_; ++d) points.push_back(s.own.at * directions_[s.ray * n_ + d]);
    const std::vector<LimitValue>& values = limit_.at(points);
    for (std::size_t k = 0; k < strata.size(); ++k) {
      strata[k].own = ray_point_at(strata[k].own.at, values[k]);
      bad_ += values[k].is_bad;
    }
  }

  // Divides strata into three equal parts where needed. Returns true if any was divided. The part that contains the existing point keeps
  // it.
  bool refine() {
    std::vector<Stratum> next, fresh;
    std::vector<std::size_t> places, cuts; // indices of parts that need a new point; index of the first part of each divided stratum
    for (const Stratum& s : strata_) {
      if (!s.is_to_cut()) {
        next.push_back(s);
        continue;
      }
      cuts.push_back(next.size());
      for (int k = 0; k < k_parts; ++k) {
        Stratum part = s;
        part.low = s.low + (s.high - s.low) * k / k_parts;
        part.high = k + 1 == k_parts ? s.high : s.low + (s.high - s.low) * (k + 1) / k_parts;
        measure(part);
        const bool has_sample = part.own.at >= part.low && (part.own.at < part.high || k + 1 == k_parts);
        if (!has_sample) {
          place(part);
          fresh.push_back(part);
          places.push_back(next.size());
        }
        next.push_back(part);
      }
    }
    if (cuts.empty()) return false;
    sample_rays(fresh);
    for (std::size_t i = 0; i < fresh.size(); ++i) next[places[i]].own = fresh[i].own;
    for (const std::size_t first : cuts) set_beside(&next[first]);
    strata_ = std::move(next);
    return true;
  }

  // Sets the neighbouring points of three parts: the points of the other parts, then the neighbours of the divided stratum.
  static void set_beside(Stratum* part) {
    const RayPoint *const outside = part[0].beside,
                          seen[] = {outside[0], outside[1], part[0].own, part[1].own, part[2].own, outside[2], outside[3]};
    for (int k = 0; k < k_parts; ++k) {
      part[k].beside[0] = seen[k];
      part[k].beside[1] = seen[k + 1];
      part[k].beside[2] = seen[k + 3];
      part[k].beside[3] = seen[k + 4];
    }
  }

  static constexpr std::size_t k_strata = 16; // number of strata of a ray before any division
  static constexpr int k_parts = 3;
  LimitFunction& limit_;
  const CounterRandom& random_;
  std::uint64_t first_;
  std::size_t n_;
  std::vector<double> directions_;
  std::vector<std::uint32_t> draws_; // number of random numbers used by each ray
  std::vector<Stratum> strata_;
  long bad_ = 0;
};

} // namespace

Estimate directional(LimitFunction& limit, const SamplingTarget& target) {
  constexpr std::size_t k_rays = 32; // number of rays evaluated in one batch
  constexpr long k_first = 64;       // rays in the first stage, and minimum for the second
  const CounterRandom random(static_cast<std::uint64_t>(limit.run().study().seed), 5);
  SamplingCourse course(limit, target);
  Estimate e;
  e.method = "directional";
  const RayPoint origin = ray_point_at(0.0, limit.at_point(std::vector<double>(limit.dimension(), 0.0)));
  std::uint64_t ray = 0;
  WeightedMean safe, unsafe;
  const auto draw_until = [&](long count) {
    while (safe.count() < count && !course.is_over()) {
      const Rays rays(limit, random, ray, k_rays, origin);
      ray += k_rays;
      for (const double p : rays.probabilities([](RayState l) { return l == RayState::fails; })) safe.add(p);
      for (const double p : rays.probabilities([](RayState l) { return l != RayState::holds; })) unsafe.add(p);
      e.bad += rays.bad();
      course.set(e, share_of(safe, false, target), share_of(unsafe, false, target));
      course.note(e);
    }
  };
  draw_until(k_first);
  if (!course.is_over()) { // the first stage determines the number of rays of the second and is then discarded
    const long second = std::max(course.planned(safe.count(), e.cov), k_first);
    safe = unsafe = {};
    e.bad = 0;
    draw_until(second);
    while (!course.is_over() && !(e.cov <= target.cov)) draw_until(std::max(course.planned(safe.count(), e.cov), safe.count() + k_first));
  }
  course.say_why_it_ended(e);
  if (safe.hits() == 0) e.status = "no ray met failure";
  constexpr double k_uneven = 0.2;
  if (safe.largest_share() > k_uneven) {
    e.status += std::string(e.status.empty() ? "" : "; ") +
                "one ray carries more than a fifth of the estimate: its interval is not to be relied on";
    e.is_trusted = false;
  }
  return e;
}

} // namespace steplap::study
