#include "mbd/run/limited_channels.h"

#include "mbd/base/name_pattern.h"

#include <cmath>

namespace steplap {

namespace {

void add_stated(const Criterion& criterion, const RunResult& result, std::vector<LimitedChannel>& limited) {
  for (std::size_t c = 0; c < result.ranges.size(); ++c) {
    if (!matches_pattern(result.ranges[c].channel->name, criterion.channel)) continue;
    LimitedChannel one{criterion.name, c};
    if (criterion.at_least) one.least = *criterion.at_least;
    if (criterion.at_most) one.largest = *criterion.at_most;
    if (criterion.within) one.least = std::max(one.least, -*criterion.within), one.largest = std::min(one.largest, *criterion.within);
    limited.push_back(one);
  }
}

// Adds the limit of an element's own criterion. It is an upper limit if the value nearest to it is below.
void add_of_element(const CriterionResult& criterion, const RunResult& result, std::vector<LimitedChannel>& limited) {
  if (!criterion.value || !criterion.limit) return;
  for (std::size_t c = 0; c < result.ranges.size(); ++c) {
    if (result.ranges[c].channel->name != criterion.channel) continue;
    LimitedChannel one{criterion.name, c};
    (*criterion.value < *criterion.limit ? one.largest : one.least) = *criterion.limit;
    limited.push_back(one);
  }
}

} // namespace

double ReserveHistory::reserve(std::size_t i, double t) const {
  const std::size_t c = limited_[i].channel;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ExtremesSoFar& then : result_.growth) {
    if (then.t > t) break;
    low = std::fmin(low, then.range[c].first); // running extremes of earlier legs
    high = std::fmax(high, then.range[c].second);
  }
  return limited_[i].reserve(low, high);
}

double ReserveHistory::first_reserve(std::size_t i) const {
  const double first = result_.ranges[limited_[i].channel].first;
  return limited_[i].reserve(first, first);
}

std::vector<LimitedChannel> limited_channels(const Model& model, const RunResult& result, const Judgement& judgement) {
  std::vector<LimitedChannel> limited;
  const std::size_t of_elements = judgement.criteria.size() - std::min(judgement.criteria.size(), model.criteria.size());
  for (std::size_t i = 0; i < judgement.criteria.size(); ++i) {
    if (judgement.criteria[i].outcome != Verdict::hold) continue;
    if (i < of_elements) add_of_element(judgement.criteria[i], result, limited);
    else if (const Criterion& stated = model.criteria[i - of_elements]; stated.event.empty()) add_stated(stated, result, limited);
  }
  return limited;
}

} // namespace steplap
