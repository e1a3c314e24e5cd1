#include "tools/study/proposal.h"
#include "tools/study/sampling_course.h"

#include <cmath>

namespace steplap::study {

namespace {

// Sums over the weights of failing and of surviving samples. Runs without a result are counted in `…_or_bad` only.
struct Sums {
  WeightedMean fails, fails_or_bad, holds, holds_or_bad;
  WeightedMean met_widely; ///< failures, or survivals where the origin fails, that the wide component drew
  void add(const LimitValue& value, double w) {
    const bool is_failure = !value.is_bad && value.g < 0.0, is_hold = !value.is_bad && !is_failure;
    fails.add(is_failure ? w : 0.0);
    fails_or_bad.add(is_hold ? 0.0 : w);
    holds.add(is_hold ? w : 0.0);
    holds_or_bad.add(is_failure ? 0.0 : w);
  }
};

class ImportanceSampling {
public:
  ImportanceSampling(LimitFunction& limit, DesignPoints& design, const SamplingTarget& target)
      : limit_(limit), design_(design), target_(target), course_(limit, target),
        random_(static_cast<std::uint64_t>(limit.run().study().seed), 4), proposal_(design.points, {}, limit.dimension()) {
    e_.method = "importance_sampling";
  }

  Estimate estimate() {
    do run_stages();
    while (!course_.is_over() && (finds_from_stray() || finds_elsewhere()));
    course_.say_why_it_ended(e_);
    judge();
    return e_;
  }

private:
  // Runs the first stage, repeated while it finds further centres, and then the second stage, which gives the estimate.
  void run_stages() {
    // 10 % of the samples: fewer than 100 do not show the scatter, more than 300 take too long.
    const long first = std::clamp(target_.samples / 10, 100L, 300L);
    do {
      begin();
      draw_until(first);
    } while (!course_.is_over() && (finds_from_stray() || finds_from_heaviest() || finds_elsewhere()));
    if (course_.is_over()) return; // no sample is left for the second stage
    is_complement_ = holds_better();
    set();
    // Smallest number of samples in the second stage. With fewer, the confidence interval is too wide to be useful.
    constexpr long k_fewest = 300;
    const long second = std::max(course_.planned(first, e_.cov), k_fewest);
    begin();
    draw_until(second);
    while (!course_.is_over() && !(e_.cov <= target_.cov))
      draw_until(std::max(course_.planned(sums_.fails.count(), e_.cov), sums_.fails.count() + k_fewest));
  }

  void begin() {
    proposal_ = Proposal(design_.points, outposts_, limit_.dimension());
    sums_ = {};
    e_.influence = Influence(limit_.run().law);
    nearest_stray_ = std::numeric_limits<double>::infinity();
    stray_.clear();
    heaviest_ = 0.0;
    e_.bad = 0;
  }

  void draw_until(long count) {
    constexpr std::size_t k_most = 1000; // largest number of samples between checks of the time limit
    const std::size_t n = limit_.dimension();
    while (sums_.fails.count() < count && !course_.is_over()) {
      const std::size_t block = std::min({std::min(course_.block(), k_most), static_cast<std::size_t>(count - sums_.fails.count()),
                                          static_cast<std::size_t>(course_.left())});
      points_.clear();
      is_wide_.clear();
      for (std::size_t i = 0; i < block; ++i) is_wide_.push_back(proposal_.draw(random_, next_++, points_));
      const std::vector<LimitValue>& values = limit_.at(points_);
      for (std::size_t i = 0; i < block; ++i) {
        const double w = proposal_.weight(&points_[i * n]);
        sums_.add(values[i], w);
        if (is_wide_[i] && !values[i].is_bad && (values[i].g < 0.0) != design_.is_origin_failing)
          sums_.met_widely.add(proposal_.wide_weight(&points_[i * n]));
        e_.influence.add(&points_[i * n], w, values[i]);
        e_.bad += values[i].is_bad;
        if (!values[i].is_bad && values[i].g < 0.0) remember(&points_[i * n], n, w);
      }
      set();
      course_.note(e_);
    }
  }

  // Remembers the failure nearest to the origin that only the wide component could sample, and the failure with the largest weight.
  void remember(const double* u, std::size_t n, double w) {
    if (w > heaviest_) {
      heaviest_ = w;
      heaviest_place_.assign(u, u + n);
    }
    const double distance = length_of(u, n);
    if (distance >= nearest_stray_ || !proposal_.is_stray(u)) return;
    nearest_stray_ = distance;
    stray_.assign(u, u + n);
  }

  // Starts a search at the remembered failure of the wide component. Returns true if a new design point was found; the samples drawn so far
  // do not cover its surroundings.
  bool finds_from_stray() {
    if (stray_.empty() || searches_++ >= k_most_searches) return false;
    const std::vector<double> start = std::move(stray_);
    stray_.clear();
    return search_again(limit_, start, design_);
  }

  // Checks whether one failure has much more weight than the mean, which indicates a region with too few samples. Searches a design point
  // from it, or makes it a centre if the search fails. Returns true if there is a new centre.
  bool finds_from_heaviest() {
    constexpr double k_many = 15.0; // ratio of the largest weight to the mean; for a plane limit state at distance 5 it is about 6
    const double hits = static_cast<double>(sums_.fails.hits()),
                 mean = sums_.fails.mean() * static_cast<double>(sums_.fails.count()) / std::max(hits, 1.0);
    if (hits < 10.0 || heaviest_ < k_many * mean || searches_++ >= k_most_searches) return false;
    if (search_again(limit_, heaviest_place_, design_)) return true;
    outposts_.push_back(heaviest_place_);
    return true;
  }

  // Searches on if neither searches nor samples of the wide component show that all design points are known. Returns true if one was found.
  bool finds_elsewhere() { return !is_covered() && search_on(limit_, design_); }

  // Returns true if unknown design points are unlikely: searches from places away from the known ones found no other, or the wide component
  // met so many failures that it would have met theirs. (None of 10 equal samples lies in a region with a quarter of the probability in 1 of
  // 18 cases.)
  [[nodiscard]] bool is_covered() const {
    constexpr double k_enough = 10.0;
    return design_.is_searched_out() || sums_.met_widely.effective() >= k_enough;
  }

  // Failures and survivals, with runs without a result as the study counts them.
  [[nodiscard]] const WeightedMean& failures() const { return course_.counts_bad() ? sums_.fails_or_bad : sums_.fails; }
  [[nodiscard]] const WeightedMean& survivals() const { return course_.counts_bad() ? sums_.holds : sums_.holds_or_bad; }

  // Returns true if the probability of survival has the smaller standard deviation. Both outcomes must have occurred often enough for an
  // estimate of their scatter.
  [[nodiscard]] bool holds_better() const {
    constexpr long k_enough = 20;
    return std::min(survivals().hits(), failures().hits()) >= k_enough && survivals().deviation() < failures().deviation();
  }

  void set() {
    const Share safe = share_of(is_complement_ ? sums_.holds_or_bad : sums_.fails, is_complement_, target_),
                unsafe = share_of(is_complement_ ? sums_.holds : sums_.fails_or_bad, is_complement_, target_);
    course_.set(e_, safe, unsafe);
  }

  void judge() {
    constexpr double k_uneven = 0.1;
    e_.is_covered = is_covered();
    const WeightedMean& counted = is_complement_ ? survivals() : failures();
    if (failures().hits() == 0) {
      e_.status = "no failure was met around the design points";
      e_.is_trusted = false;
    } else if (counted.largest_share() > k_uneven) {
      e_.status += std::string(e_.status.empty() ? "" : "; ") +
                   "one sample carries more than a tenth of the estimate: its interval is not to be relied on";
      e_.is_trusted = false;
    }
  }

  static constexpr int k_most_searches = 12;

  LimitFunction& limit_;
  DesignPoints& design_;
  const SamplingTarget& target_;
  SamplingCourse course_;
  CounterRandom random_;
  Proposal proposal_;
  Estimate e_;
  Sums sums_;
  std::uint64_t next_ = 0;
  std::vector<double> points_, stray_, heaviest_place_;
  std::vector<bool> is_wide_; ///< of the samples in points_
  std::vector<std::vector<double>> outposts_;
  double heaviest_ = 0.0;
  double nearest_stray_ = std::numeric_limits<double>::infinity();
  int searches_ = 0;
  bool is_complement_ = false;
};

} // namespace

Estimate importance_sampling(LimitFunction& limit, DesignPoints& design, const SamplingTarget& target) {
  return ImportanceSampling(limit, design, target).estimate();
}

} // namespace steplap::study
