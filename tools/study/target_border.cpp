#include "tools/study/target_border.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

LoadedStudy with_design_value(const LoadedStudy& loaded, std::size_t variable, double x) {
  LoadedStudy changed = loaded;
  Variable& v = changed.study.variables[variable];
  v.range.clear();
  v.values.clear();
  (v.has_distribution() ? v.mean : v.value) = x;
  changed.nominal[variable] = x;
  return changed;
}

// The study with the design variable set to one value. Its samples belong to the whole study.
struct TargetSearch::Scene {
  LoadedStudy loaded;
  std::vector<Diagnostic> problems; // must be empty; the reader has checked the study
  JointLaw law;
  StudyRun run;
  LimitFunction limit;

  Scene(StudyRun& whole, std::size_t variable, double x, long seeds)
      : loaded(shifted(with_design_value(whole.loaded, variable, x), seeds)), law(loaded.study, loaded.nominal, problems),
        run{loaded, law, whole.evaluator}, limit(run) {}

  static LoadedStudy shifted(LoadedStudy loaded, long seeds) {
    loaded.study.seed += seeds;
    return loaded;
  }
};

// Searches design points at x. If the usual starts fail, the design point of the nearest known value is one more start.
DesignPoints TargetSearch::points_of(Scene& scene, double x) {
  DesignPoints points = find_design_points(scene.limit, false);
  const auto is_found = [&points] { return !points.points.empty() && points.points.front().is_found; };
  if (!is_found() && !known_points_.empty()) {
    const auto nearest = std::min_element(known_points_.begin(), known_points_.end(),
                                          [x](const auto& a, const auto& b) { return std::abs(a.first - x) < std::abs(b.first - x); });
    (void)search_again(scene.limit, nearest->second, points);
  }
  if (is_found()) known_points_[x] = points.points.front().u;
  return points;
}

IndexEstimate TargetSearch::first_order(double x) {
  Scene scene(run_, variable_, x, 0);
  const DesignPoints points = points_of(scene, x);
  IndexEstimate index;
  if (!points.points.empty() && points.points.front().is_found) index.beta = points.points.front().beta;
  else index.doubt = "no design point was found" + (points.trouble.empty() ? "" : ": " + points.trouble);
  return index;
}

IndexEstimate TargetSearch::sampled(double x) {
  Scene scene(run_, variable_, x, ++samplings_);
  DesignPoints points = points_of(scene, x);
  IndexEstimate index;
  if (points.points.empty()) {
    index.doubt = "no design point was found: " + points.trouble;
    return index;
  }
  last_ = importance_sampling(scene.limit, points, sampling_);
  const auto index_of = [](double p) { return p > 0.0 && p < 1.0 ? -normal_quantile(p) : std::nan(""); };
  const Interval interval = last_.interval("bounds"); // runs without a result count as failures in one bound and as survivals in the other
  index.beta = index_of(last_.unsafe);
  index.low = index_of(interval.high);
  index.high = index_of(interval.low);
  if (!last_.is_trusted || std::isnan(index.beta)) index.doubt = last_.status.empty() ? "sampling met no failure" : last_.status;
  return index;
}

TargetBorder TargetSearch::border_near(double x, double low, double high) {
  // distance in β within which β(x) is treated as linear: its curvature is negligible compared with the sampling interval
  constexpr double k_near = 0.05;
  constexpr int k_most = 6;
  const double h = 0.005 * (high - low);
  const double before = std::max(low, x - h), after = std::min(high, x + h);
  const double slope = (first_order(after).beta - first_order(before).beta) / (after - before);
  TargetBorder border{x, x, x, x, {}, ""};
  if (std::isnan(slope) || slope == 0.0) {
    border.doubt = "the slope of the reliability index is not known there";
    return border;
  }
  for (int round = 0; round < k_most; ++round) {
    const IndexEstimate index = sampled(x);
    border.checked_at = x;
    border.check = last_;
    border.doubt = index.doubt;
    if (std::isnan(index.beta)) return border;
    const auto moved = [&](double beta) { return x + (target_ - beta) / slope; };
    border.value = moved(index.beta);
    border.low = std::min(moved(index.low), moved(index.high));
    border.high = std::max(moved(index.low), moved(index.high));
    if (border.value < low || border.value > high) border.doubt = "by sampling the border lies beyond the range";
    if (std::abs(index.beta - target_) <= k_near) return border;
    x = std::clamp(border.value, low, high);
  }
  border.doubt = "sampling did not settle on a border";
  return border;
}

} // namespace steplap::study
