#include "mbd/run/utilisation.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace steplap {

namespace {

constexpr std::size_t k_most_frictions = 100;
constexpr double k_unused = 1e-9; // utilisations of friction below this are rounding

std::string last_part(const std::string& channel) { return channel.substr(channel.rfind('.') + 1); }
std::string element_part(const std::string& channel) { return channel.substr(0, channel.rfind('.')); }

// Built-in criteria of kinds: the channel that is limited, and the words for it.
struct LimitedQuantity {
  const char* channel;
  const char* name;
  bool is_lower;  // the limit is a lower bound
  const char* of; // text for 100 %
};

const LimitedQuantity* aspect_of(const std::string& channel) {
  static constexpr LimitedQuantity k_aspects[] = {{"margin", "friction", true, "what friction holds"},
                                                  {"corner_margin", "a single corner", true, "what friction holds"},
                                                  {"part_margin", "a single packet", true, "what friction holds"},
                                                  {"least_pressure", "pressure lost", true, "the pressure at the start"},
                                                  {"overlap_left", "overlap lost", true, "the overlap"},
                                                  {"clearance_left", "clearance used", true, "the clearance"},
                                                  {"slid_share", "displacement", false, "the slide that is allowed"},
                                                  {"edge_share", "sheet edges", false, "the line load that is allowed"},
                                                  {"strength_share", "strength", false, "its strength"}};
  const std::string part = last_part(channel);
  for (const LimitedQuantity& aspect : k_aspects)
    if (part == aspect.channel) return &aspect;
  return nullptr;
}

// --- shares

struct Share {
  double value = 0.0, slope = 0.0; // `slope`: derivative of the share with respect to the value
};

std::optional<Share> share_by_way(double value, double limit, const ChannelRange* range) {
  if (!range || !std::isfinite(range->first) || range->first == limit) return {};
  const double way = range->first - limit;
  return Share{(range->first - value) / way, 1.0 / way};
}

std::optional<Share> share_of_upper(double value, double limit, const ChannelRange* range) {
  if (limit > 0.0) return Share{std::max(0.0, value / limit), 1.0 / limit};
  return share_by_way(value, limit, range);
}

std::optional<Share> share_of_lower(double value, double limit, const ChannelRange* range) {
  if (limit <= 0.0) return share_by_way(value, limit, range);
  if (value <= limit / Utilisation::k_most_share) return Share{Utilisation::k_most_share, 0.0};
  return Share{limit / value, limit / (value * value)};
}

class Finder {
public:
  Finder(const Report& report, const RangeIndex& ranges, ShownDigits digits) : report_(report), ranges_(ranges), digits_(digits) {}

  std::vector<Utilisation> find() {
    add_criteria();
    add_ties();
    add_frictions();
    std::stable_sort(found_.begin(), found_.end(), [](const Utilisation& a, const Utilisation& b) {
      return a.share > b.share || (a.share == b.share && a.beyond && !b.beyond);
    });
    return std::move(found_);
  }

private:
  // --- criteria

  // The criteria of the model come last in a judgement, in their order.
  void add_criteria() {
    const auto& all = report_.judgement.criteria;
    const auto& own = report_.run.loaded->model.criteria;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!all[i].value || !all[i].limit || !std::isfinite(*all[i].value)) continue;
      const std::size_t of_elements = all.size() - own.size();
      const std::size_t before = found_.size();
      if (i < of_elements) add_of_element(all[i]);
      else add_of_model(all[i], own[i - of_elements]);
      if (found_.size() > before) found_.back().criterion = i;
    }
  }

  void add(const CriterionResult& c, const std::string& name, const std::optional<Share>& share, const std::string& detail,
           const std::string& of) {
    if (!share || !std::isfinite(share->value)) return;
    Utilisation u;
    u.name = name;
    u.channel = c.channel;
    u.share = std::clamp(share->value, 0.0, Utilisation::k_most_share);
    u.value = *c.value;
    u.limit = *c.limit;
    u.unit = c.unit;
    u.at = c.t;
    u.beyond = c.outcome == Verdict::inspect || c.outcome == Verdict::reject;
    const bool is_settled = u.beyond && !c.reserve; // the element slipped or broke, independently of rounding
    if (c.error && !is_settled) u.error = std::abs(*c.error * share->slope);
    u.detail = detail;
    u.text = shown_share(u.share, u.error, digits_) + " of " + of + (detail.empty() ? "" : ": " + detail);
    known_.insert(c.channel);
    found_.push_back(std::move(u));
  }

  std::string shown_value(const CriterionResult& c) const {
    return shown_quantity(*c.value, c.unit, {.error = c.error, .limit = c.limit, .scale = *c.limit, .column = *c.limit}, digits_);
  }
  std::string size_of(CriterionResult c, const Criterion& asked) const {
    if (asked.within) c.value = std::abs(*c.value);
    return shown_value(c);
  }
  std::string shown_limit(const CriterionResult& c) const { return shown_quantity(*c.limit, c.unit, {}, digits_); }

  // Adds the utilisation of an element's own criterion. A margin must be at least 1, or the larger value that the model requires.
  void add_of_element(const CriterionResult& c) {
    const LimitedQuantity* aspect = aspect_of(c.channel);
    if (!aspect) return;
    const ChannelRange* range = ranges_.find(c.channel);
    const auto share = aspect->is_lower ? share_of_lower(*c.value, *c.limit, range) : share_of_upper(*c.value, *c.limit, range);
    std::string detail;
    if (c.unit.empty() && aspect->is_lower && *c.limit > 0.0)
      detail =
          (c.reserve || aspect_of(c.channel)->name != std::string("friction") ? "margin " + shown_value(c) + ", at least " + shown_limit(c)
                                                                              : "it slipped");
    else if (!c.unit.empty()) detail = shown_value(c) + " left";
    const bool has_reserve = *c.limit > 1.0 && aspect->is_lower && c.unit.empty();
    add(c, c.where + ": " + aspect->name, share, detail, has_reserve ? "what the asked margin leaves" : aspect->of);
  }

  void add_of_model(const CriterionResult& c, const Criterion& asked) {
    const ChannelRange* range = ranges_.find(c.channel);
    const double value = *c.value;
    std::optional<Share> share;
    const auto take = [&share](const std::optional<Share>& other) {
      if (other && (!share || other->value > share->value)) share = other;
    };
    if (asked.within) take(share_of_upper(std::abs(value), *asked.within, nullptr));
    if (asked.at_most) take(share_of_upper(value, *asked.at_most, range));
    if (asked.at_least) take(share_of_lower(value, *asked.at_least, range));
    const bool is_lower = asked.at_least && *c.limit == *asked.at_least;
    const bool is_pattern = c.channel != asked.channel;
    add(c, c.name + (is_pattern ? " (" + element_part(c.channel) + ")" : ""), share,
        is_lower ? shown_value(c) + ", at least " + shown_limit(c) : size_of(c, asked) + " of " + shown_limit(c), "the limit");
  }

  // Adds ties, which are designed to break first and are therefore not judged.
  void add_ties() {
    for (const ChannelRange& range : report_.ranges()) {
      const std::string& name = range.channel->name;
      if (range.channel->role != ChannelRole::strength_use || known_.contains(name) || !std::isfinite(range.high.value)) continue;
      CriterionResult c;
      c.value = range.high.value;
      c.limit = 1.0;
      c.t = range.high.t;
      c.channel = name;
      c.error = report_.error_of(range, &ChannelError::high);
      add(c, element_part(name) + ": strength", share_of_upper(*c.value, 1.0, nullptr), "", "its strength");
      found_.back().beyond = range.high.value >= 1.0 - 1e-9;
    }
  }

  // --- friction

  struct Friction {
    std::string element;
    const ChannelRange* used = nullptr; ///< range of the element's channel with the role friction_use
    double share = 0.0, at = 0.0;
  };

  void add_frictions() {
    std::unordered_map<std::string, double> first_slip;
    for (const Event& event : report_.run.result.events)
      if (is_slip(event.kind)) first_slip.try_emplace(event.element, event.t);
    std::vector<Friction> frictions;
    for (const ChannelRange& range : report_.ranges()) {
      const std::string& name = range.channel->name;
      if (range.channel->role != ChannelRole::friction_use || known_.contains(name) || !(range.high.value > k_unused)) continue;
      Friction f{element_part(name), &range, std::min(1.0, range.high.value), range.high.t};
      if (const auto slip = first_slip.find(f.element); slip != first_slip.end()) {
        f.share = 1.0;
        f.at = slip->second;
      }
      frictions.push_back(std::move(f));
    }
    std::stable_sort(frictions.begin(), frictions.end(), [](const Friction& a, const Friction& b) { return a.share > b.share; });
    if (frictions.size() > k_most_frictions) frictions.resize(k_most_frictions);
    for (const Friction& f : frictions) add_friction(f, first_slip.contains(f.element));
  }

  void add_friction(const Friction& f, bool slipped) {
    Utilisation u;
    u.name = f.element + ": friction";
    u.channel = f.used->channel->name;
    u.share = f.share;
    u.at = f.at;
    u.beyond = slipped;
    if (slipped) u.detail = "it slips";
    else u.error = report_.error_of(*f.used, &ChannelError::high);
    u.text = shown_share(u.share, u.error, digits_) + " of what friction holds" + (slipped ? ": " + u.detail : "");
    found_.push_back(std::move(u));
  }

  const Report& report_;
  const RangeIndex& ranges_;
  ShownDigits digits_;
  std::unordered_set<std::string> known_;
  std::vector<Utilisation> found_;
};

} // namespace

std::vector<Utilisation> utilisations_of(const Report& report, const RangeIndex& ranges, ShownDigits digits) {
  return Finder(report, ranges, digits).find();
}

double reserve_of(const Report& report) {
  // Smallest reserve with the sign of the verdict: "hold" can also be prevented by findings and errors that no utilisation contains.
  constexpr double k_least = 1e-9;
  double least = 1.0;
  for (const Utilisation& u : utilisations_of(report, RangeIndex(report.ranges()))) {
    if (!u.criterion) continue;
    const double error = u.error.value_or(0.0); // for unknown errors the verdict is already open
    least = std::min(least, 1.0 - u.share - (std::isnan(error) ? 0.0 : error));
  }
  return report.judgement.verdict == Verdict::hold ? std::max(least, k_least) : std::min(least, -k_least);
}

} // namespace steplap
