// EventFinder: what watch values do inside a step that its ends and stages do not make certain.
//
// Part by part from the step's start, values at seven Chebyshev–Lobatto places of dense output are interpolated
// (mbd/base/part_polynomial.h). A part is passed if every value is above zero between those places by more than the
// polynomial may be off, and if one more look, where the value that is nearest to zero is least, finds no value further from
// its polynomial than that. Else the part is divided: where the polynomial is least, so that the bottom of a dip becomes an
// end of both halves, or where it was off. A value that is negative at a place makes the bracket of an event, if it
// passes zero once for certain from the place before, and nothing else does. What dips below zero for less than k_shortest of
// a step, and only by rounding, is no event. That this misses nothing is argued in docs/explanation/theory.md, "Events".
#include "mbd/events/event_finder.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ranges>
#include <utility>

namespace steplap {

namespace {

constexpr double k_shortest = 1e-9;                       // part of a step that is not divided
constexpr double k_margin_of_cut = 0.1;                   // of a part: not nearer to its ends;
constexpr double k_margin_if_rough = 0.3, k_rough = 1e-3; // … where the error is a larger share of the values than this
constexpr double k_stalled = 0.9;                         // of the error of the part before: no more exact
constexpr int k_most_stalled = 4;                         // generations in a row
constexpr int k_most_parts = 400;                         // of one step
// Of the step: nearer to its start nobody believes what was not positive there (dense output does not know so small
// changes); what has not become positive at all is decided anew here.
constexpr double k_at_once = 1e-4;
constexpr double k_of_flanks = 0.05;  // of the larger of two values: tangents that meet so low may belong to a kink below zero
constexpr double k_off_places = 0.25; // of a gap between places: a check is not made nearer to these, where nothing can be off
// Beside what a polynomial is off by at one place it may be off by so many times that at others: between the first two
// places it reaches about a quarter of what it does in the middle.
constexpr double k_elsewhere = 4.0;
constexpr double k_far = 0.25; // of the size of a value that is clear: it is not checked

} // namespace

// Where the tangents at two neighbouring places, falling at one and rising at the next, meet below zero or near it: the bottom of
// what is convex between them, as the gap to anything round that is flown past, may be as low. That of two flanks of a sine, as of the
// end of an arm that turns past a thin wall, is lower than where they meet, by δ³/3 of a place δ off it: 2 % of the value there between
// places of a step that turns by a radian. −1: nowhere, or rates are not known.
double EventFinder::tangents_meet_below(int slot, std::size_t last) const {
  const double begin = place_[0].theta, width = place_[k_places - 1].theta - begin;
  for (std::size_t k = 0; k < last; ++k) {
    const double w0 = place_[k].watch[slot], w1 = place_[k + 1].watch[slot];
    const double s0 = place_[k].rate[slot], s1 = place_[k + 1].rate[slot];
    if (!(s0 < 0.0 && s1 > 0.0)) continue;
    const double gap = place_[k + 1].theta - place_[k].theta, x = (w1 - w0 - s1 * gap) / (s0 - s1);
    if (x > 0.0 && x < gap && w0 + s0 * x < k_of_flanks * std::max(w0, w1))
      return std::clamp((place_[k].theta + x - begin) / width, k_margin_of_cut, 1.0 - k_margin_of_cut);
  }
  return -1.0;
}

// The polynomials of the near values in the part whose places are looked at, and between which of them each has to be
// positive: up to `last`, or where some value has been seen below zero behind that, one place more. What is fresh is not
// believed before it has been positive, nor what is negative at the part's begin.
void EventFinder::fit_near(const Part& part, std::size_t last) {
  curves_.clear();
  for (const int slot : near_) {
    Near near;
    near.slot = slot;
    near.has_fired = last + 1 < k_places && std::find(fired_.begin(), fired_.end(), slot) != fired_.end();
    near.to = near.has_fired ? last : std::min(last + 1, k_places - 1);
    const auto is_positive = [&](const Look& place) { return place.watch[slot] > 0.0 && place.theta >= k_at_once; };
    if (armed_before_[slot] == 0 || place_[0].watch[slot] < 0.0)
      while (near.from < k_places && !is_positive(place_[near.from])) ++near.from;
    if (near.from > near.to) continue;
    PartPolynomial::Values values;
    for (std::size_t k = 0; k < k_places; ++k) values[k] = place_[k].watch[slot];
    near.polynomial.fit(values);
    if (near.polynomial.largest() == 0.0) continue; // what touches and does not move: zero is not below zero, however fine one looks
    // What dividing does not make more exact is rounding (a contact that touches without being pressed), or a jump: its
    // values at the places are all there is to know. Errors at a kink fall with the width, those of what is smooth much
    // faster.
    const bool is_stalled = slot == part.slot && near.polynomial.error() > k_stalled * part.error;
    near.stalled = is_stalled ? part.stalled + 1 : 0;
    if (near.stalled < k_most_stalled) curves_.push_back(near);
  }
}

// The gap between places in which the value may be below zero, or pass it more than once; −1: none.
int EventFinder::doubtful_gap(const Near& near) const {
  const double floor = -slack_[near.slot];
  const int gap = near.polynomial.doubtful_gap(floor, near.from, near.to);
  if (gap >= 0 || !near.has_fired || near.polynomial.falls_once(floor, near.to)) return gap;
  return static_cast<int>(near.to);
}

EventFinder::Unclear EventFinder::unclear_at(const Near& near, double place) const {
  const PartPolynomial& p = near.polynomial;
  const double margin = p.error() > k_rough * p.largest() ? k_margin_if_rough : k_margin_of_cut;
  return {std::clamp(place, margin, 1.0 - margin), near.slot, p.error(), near.stalled};
}

// Where in the part some near value may be below zero between the places.
EventFinder::Unclear EventFinder::unclear_place(std::size_t last) const {
  for (const Near& near : curves_) {
    if (const double x = tangents_meet_below(near.slot, last); x >= 0.0) return {x, near.slot, 0.0, 0};
    const int gap = doubtful_gap(near);
    if (gap < 0) continue;
    const auto k = static_cast<std::size_t>(gap); // a bottom may lie at its end
    return unclear_at(near, near.polynomial.lowest(k > 0 ? k - 1 : 0, std::min(k + 2, k_places - 1)));
  }
  return {};
}

// Where the value that comes nearest to zero, as a share of its size, is least between the places; −1: there is none, or all are
// so far away that the polynomial would have to be off by as much as the value itself.
double EventFinder::place_to_check() const {
  const Near* nearest = nullptr;
  double least = 0.0;
  for (const Near& near : curves_) {
    if (near.from >= near.to) continue;
    double low = place_[near.from].watch[near.slot];
    for (std::size_t k = near.from + 1; k <= near.to; ++k) low = std::min(low, place_[k].watch[near.slot]);
    const double share = low / near.polynomial.largest();
    if (nearest && share >= least) continue;
    nearest = &near;
    least = share;
  }
  if (!nearest || least > k_far) return -1.0;
  const double x = nearest->polynomial.lowest(nearest->from, nearest->to);
  std::size_t gap = nearest->from;
  while (gap + 1 < nearest->to && x > PartPolynomial::place(gap + 1)) ++gap;
  const double begin = PartPolynomial::place(gap), width = PartPolynomial::place(gap + 1) - begin;
  return std::clamp(x, begin + k_off_places * width, begin + (1.0 - k_off_places) * width);
}

// All near values are clear by their polynomials: are they what these say at a place where nobody has looked? Where one is
// not, and may be below zero if the polynomial is off by so much, the part has to be divided; there, where one, near or not, is
// below zero before the first place that has one.
EventFinder::Unclear EventFinder::belied_place(Integrator& integrator, Dynamics& dynamics, const Part& part, std::size_t last) {
  const double x = place_to_check();
  if (x < 0.0) return {};
  watch_at(integrator, dynamics, part.begin + x * (part.end - part.begin), middle_);
  for (int i = 0; i < slots_ && x < PartPolynomial::place(last); ++i)
    if (armed_before_[i] && place_[0].watch[i] >= -slack_[i] && middle_.watch[i] < -slack_[i]) return {x, i, 0.0, 0};
  for (Near& near : curves_) {
    if (x < PartPolynomial::place(near.from) || x > PartPolynomial::place(near.to)) continue;
    const double off = std::abs(middle_.watch[near.slot] - near.polynomial.at(x));
    if (!(off > near.polynomial.error())) continue;
    near.polynomial.widen(k_elsewhere * off);
    if (doubtful_gap(near) >= 0) return unclear_at(near, x);
  }
  return {};
}

// All places of the part beyond its begin; the one up to which nothing has been seen below zero.
std::size_t EventFinder::look_at_places(Integrator& integrator, Dynamics& dynamics, const Part& part) {
  const double width = part.end - part.begin;
  std::size_t last = k_places - 1;
  for (std::size_t k = 1; k < k_places; ++k) {
    const double theta = k == k_places - 1 ? part.end : part.begin + PartPolynomial::place(k) * width;
    if (theta == 1.0) look_at_end(integrator, true, place_[k]);
    else watch_at(integrator, dynamics, theta, place_[k]);
    if (last < k_places - 1) continue;
    if (falls(place_[k - 1], place_[k])) {
      last = k - 1;
      continue;
    }
    arm_positive(place_[k].theta, place_[k].watch);
  }
  return last;
}

void EventFinder::arm_positive(double theta, const std::vector<double>& watch) {
  if (theta < k_at_once) return;
  for (int i = 0; i < slots_; ++i)
    if (watch[i] > 0.0) armed_[i] = 1;
}

// A look ahead of which what is fresh is not believed. What is, and is not far from zero between the step's start and that
// look, has to be looked at in between.
void EventFinder::begin_parts(Integrator& integrator, Dynamics& dynamics, bool is_any_unarmed) {
  parts_.clear();
  parts_.push_back({});
  if (!is_any_unarmed) return;
  parts_.back().begin = k_at_once;
  watch_at(integrator, dynamics, k_at_once, high_);
  const bool is_any_near = std::any_of(near_.begin(), near_.end(), [this](int slot) {
    const double low = std::min(low_.watch[slot], high_.watch[slot]), high = std::max(low_.watch[slot], high_.watch[slot]);
    return armed_[slot] && 2.0 * low <= high;
  });
  if (is_any_near || falls(low_, high_)) {
    parts_.push_back({0.0, k_at_once});
    return;
  }
  arm_positive(k_at_once, high_.watch);
  std::swap(low_, high_);
}

// low_ is at the part's begin. True with a bracket in low_ and high_; else low_ is at its end, or the part has been divided.
bool EventFinder::look_through(Integrator& integrator, Dynamics& dynamics, const Part& part) {
  const double width = part.end - part.begin;
  place_[0] = low_;
  armed_before_ = armed_;
  const std::size_t last = look_at_places(integrator, dynamics, part);
  if (last + 1 < k_places) (void)falls(place_[last], place_[last + 1]);
  if (width > k_shortest) {
    fit_near(part, last);
    Unclear unclear = unclear_place(last);
    if (unclear.slot < 0) unclear = belied_place(integrator, dynamics, part, last);
    if (unclear.slot >= 0) {
      const double cut = part.begin + unclear.place * width;
      parts_.push_back({cut, part.end, unclear.slot, unclear.error, unclear.stalled});
      parts_.push_back({part.begin, cut, unclear.slot, unclear.error, unclear.stalled});
      armed_ = armed_before_;
      return false;
    }
  }
  if (last + 1 < k_places) {
    std::swap(low_, place_[last]);
    std::swap(high_, place_[last + 1]);
    return true;
  }
  std::swap(low_, place_[k_places - 1]);
  return false;
}

EventFinder::Bracket EventFinder::survey(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh) {
  look_at_end(integrator, false, low_);
  bool is_any_unarmed = false;
  for (int i = 0; i < slots_; ++i) {
    armed_[i] = !fresh[i] && low_.watch[i] >= 0.0;
    is_any_unarmed = is_any_unarmed || !armed_[i];
  }
  begin_parts(integrator, dynamics, is_any_unarmed);
  // Values that were never positive up to low_: the mode chosen is not the one the motion takes. The event is at once; the handler
  // decides anew a hair later. No step ends with a value below zero, nor does one that another event cuts.
  const auto every_slot = std::views::iota(0, slots_);
  const auto was_never_positive = [this](int slot) {
    return low_.theta < 1.0 ? armed_[slot] == 0 && low_.watch[slot] < -slack_[slot] : low_.watch[slot] < 0.0;
  };
  for (int parts = 0; !parts_.empty(); ++parts) {
    const Part part = parts_.back();
    parts_.pop_back();
    if (parts >= k_most_parts && part.begin > 0.0) { // the step ends where it has been looked through
      fired_.clear();
      high_ = low_;
      return Bracket::at_once;
    }
    if (look_through(integrator, dynamics, part)) {
      const bool is_any_late = low_.theta >= k_at_once && std::any_of(every_slot.begin(), every_slot.end(), was_never_positive);
      if (!is_any_late) return bracket_of_fall();
      break;
    }
  }
  fired_.clear();
  std::copy_if(every_slot.begin(), every_slot.end(), std::back_inserter(fired_), was_never_positive);
  if (fired_.empty()) return Bracket::none;
  high_.theta = k_at_once;
  return Bracket::at_once;
}

// Of a value that lies within the slack below zero where the bracket begins, that is the event.
EventFinder::Bracket EventFinder::bracket_of_fall() {
  const auto is_above = [this](int slot) { return low_.watch[slot] >= 0.0; };
  if (std::all_of(fired_.begin(), fired_.end(), is_above)) return Bracket::found;
  fired_.erase(std::remove_if(fired_.begin(), fired_.end(), is_above), fired_.end());
  high_.theta = std::max(low_.theta, k_at_once);
  return Bracket::at_once;
}

} // namespace steplap
