#include "mbd/trust/event_match.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace steplap {

namespace {

constexpr std::size_t k_most_cells = 4000000; // largest number of cells of a table (32 MB); longer lists are not paired
constexpr double k_as_good_as_at = 1e-12;     // s, and relative to t: a time this near to an event counts as at the event
constexpr double k_furthest = 10.0;           // largest time difference of a pair, in times to the neighbouring event of the element

using Places = std::vector<std::size_t>;

using Key = std::tuple<std::string, EventKind, bool>; // element, kind, and whether the event is at t = 0

Key key_of(const Event& event) { return {event.element, event.kind, event.is_at_start()}; }

std::map<Key, std::pair<Places, Places>> by_key(const std::vector<Event>& mine, const std::vector<Event>& reference) {
  std::map<Key, std::pair<Places, Places>> lists;
  for (std::size_t i = 0; i < mine.size(); ++i) lists[key_of(mine[i])].first.push_back(i);
  for (std::size_t i = 0; i < reference.size(); ++i) lists[key_of(reference[i])].second.push_back(i);
  return lists;
}

// Assigns each time in `few` to one in `many`, in order and with the least sum of differences. Dynamic programming: sum(i, out) is the
// least sum for the first i times of `few` if `out` times of `many` are skipped.
Places partners(const std::vector<double>& few, const std::vector<double>& many) {
  const std::size_t width = many.size() - few.size() + 1;
  std::vector<double> sum(width, 0.0);
  std::vector<char> is_left_out(few.size() * width, 0); // true if the least sum is reached by skipping one more time
  for (std::size_t i = 0; i < few.size(); ++i)
    for (std::size_t out = 0; out < width; ++out) {
      sum[out] += std::abs(few[i] - many[i + out]);
      if (out == 0 || !(sum[out - 1] < sum[out])) continue;
      // It is better to skip one more time of `many` than to pair it.
      sum[out] = sum[out - 1];
      is_left_out[i * width + out] = 1;
    }
  Places places(few.size());
  std::size_t out = width - 1;
  for (std::size_t i = few.size(); i-- > 0;) {
    while (out > 0 && is_left_out[i * width + out]) --out;
    places[i] = i + out;
  }
  return places;
}

void pair_up(const Places& mine, const Places& theirs, const std::vector<Event>& my_events, const std::vector<Event>& their_events,
             EventMatch& match) {
  const bool is_mine_fewer = mine.size() <= theirs.size();
  const Places& few = is_mine_fewer ? mine : theirs;
  const Places& many = is_mine_fewer ? theirs : mine;
  std::vector<char> is_paired(many.size(), 0);
  const bool is_beyond = few.size() * (many.size() - few.size() + 1) > k_most_cells;
  if (!few.empty() && !is_beyond) {
    std::vector<double> few_times, many_times;
    for (const std::size_t i : few) few_times.push_back((is_mine_fewer ? my_events : their_events)[i].t);
    for (const std::size_t i : many) many_times.push_back((is_mine_fewer ? their_events : my_events)[i].t);
    const Places found = partners(few_times, many_times);
    for (std::size_t i = 0; i < few.size(); ++i) {
      is_paired[found[i]] = 1;
      const std::size_t other = many[found[i]];
      match.pairs.push_back(is_mine_fewer ? EventPair{few[i], other} : EventPair{other, few[i]});
    }
  } else {
    Places& alone = is_mine_fewer ? match.only_mine : match.only_reference;
    alone.insert(alone.end(), few.begin(), few.end());
  }
  Places& alone = is_mine_fewer ? match.only_reference : match.only_mine;
  for (std::size_t i = 0; i < many.size(); ++i)
    if (!is_paired[i]) alone.push_back(many[i]);
}

// Returns for each event the time, s, to the nearest event of the same element, of any kind, at another instant.
std::vector<double> times_to_neighbours(const std::vector<Event>& events) {
  std::vector<double> times(events.size(), std::numeric_limits<double>::infinity());
  std::map<std::string, Places> of_element;
  for (std::size_t i = 0; i < events.size(); ++i) of_element[events[i].element].push_back(i);
  for (const auto& [element, places] : of_element) {
    std::size_t before = 0; // index of the first event at the same instant as the last one
    for (std::size_t k = 1; k < places.size(); ++k) {
      const double passed = events[places[k]].t - events[places[before]].t;
      if (passed <= k_as_good_as_at * std::max(1.0, events[places[k]].t)) continue;
      for (std::size_t i = before; i < k; ++i) times[places[i]] = std::min(times[places[i]], passed);
      std::size_t last = k;
      while (last + 1 < places.size() &&
             events[places[last + 1]].t - events[places[k]].t <= k_as_good_as_at * std::max(1.0, events[places[k]].t))
        ++last;
      for (std::size_t i = k; i <= last; ++i) times[places[i]] = passed;
      before = k;
      k = last;
    }
  }
  return times;
}

// Separates pairs whose time difference is too large for the same event, such as a bounce of 1 µs in one run and one 0.1 s later in the
// other.
void part_strangers(const std::vector<Event>& mine, const std::vector<Event>& reference, EventMatch& match) {
  const std::vector<double> my_times = times_to_neighbours(mine), their_times = times_to_neighbours(reference);
  const auto is_strange = [&](const EventPair& pair) {
    const Event &my_event = mine[pair.mine], &their_event = reference[pair.reference];
    const double apart = std::abs(my_event.t - their_event.t) - my_event.located_within - their_event.located_within;
    return apart > k_furthest * std::max(my_times[pair.mine], their_times[pair.reference]);
  };
  for (const EventPair& pair : match.pairs) {
    if (!is_strange(pair)) continue;
    match.only_mine.push_back(pair.mine);
    match.only_reference.push_back(pair.reference);
  }
  std::erase_if(match.pairs, is_strange);
}

} // namespace

EventMatch match_events(const std::vector<Event>& mine, const std::vector<Event>& reference) {
  EventMatch match;
  for (const auto& [key, lists] : by_key(mine, reference)) pair_up(lists.first, lists.second, mine, reference, match);
  part_strangers(mine, reference, match);
  std::sort(match.only_mine.begin(), match.only_mine.end());
  std::sort(match.only_reference.begin(), match.only_reference.end());
  return match;
}

BetweenEvents::BetweenEvents(const EventMatch& match, const std::vector<Event>& mine, const std::vector<Event>& reference) {
  std::vector<Interval> all;
  for (const EventPair& pair : match.pairs) {
    const auto [begin, end] = std::minmax(mine[pair.mine].t, reference[pair.reference].t);
    const double slack = k_as_good_as_at * std::max(1.0, end);
    all.push_back({begin - slack, end + slack});
  }
  std::sort(all.begin(), all.end(), [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  for (const Interval& next : all) {
    if (intervals_.empty() || next.begin > intervals_.back().end) intervals_.push_back(next);
    else intervals_.back().end = std::max(intervals_.back().end, next.end);
  }
}

bool BetweenEvents::holds(double t) const {
  const auto after = std::upper_bound(intervals_.begin(), intervals_.end(), t,
                                      [](double value, const Interval& interval) { return value < interval.begin; });
  return after != intervals_.begin() && t <= std::prev(after)->end;
}

} // namespace steplap
