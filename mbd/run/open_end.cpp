#include "mbd/run/open_end.h"

#include "mbd/base/name_pattern.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/formula/formula.h"
#include "mbd/model/action.h"
#include "mbd/model/formula_fields.h"
#include "mbd/model/signal_network.h"
#include "mbd/run/limited_channels.h"
#include "mbd/run/quantity_text.h"
#include "mbd/run/range_index.h"
#include "mbd/system/places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace steplap {

namespace {

constexpr std::size_t k_most_names = 8;

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  const std::size_t shown = std::min(names.size(), k_most_names);
  for (std::size_t i = 0; i < shown; ++i) text += (i == 0 ? "'" : i + 1 == names.size() ? " and '" : ", '") + names[i] + "'";
  return shown < names.size() ? text + " and " + std::to_string(names.size() - shown) + " more" : text;
}

// Returns true if a criterion refers to the body or element of this name.
bool is_asked(const Model& model, const RunResult& result, const std::string& name) {
  return std::any_of(model.criteria.begin(), model.criteria.end(), [&](const Criterion& criterion) {
    if (!criterion.event.empty()) return criterion.element.empty() || matches_pattern(name, criterion.element);
    return std::any_of(result.ranges.begin(), result.ranges.end(), [&](const ChannelRange& range) {
      return range.channel->name.starts_with(name + ".") && matches_pattern(range.channel->name, criterion.channel);
    });
  });
}

// Returns the word of a code: "slips" for 2 in "0 free, 1 sticks, 2 slips".
std::string word_of(const std::string& codes, double value) {
  std::istringstream list(codes);
  for (std::string entry; std::getline(list, entry, ',');) {
    std::istringstream words(entry);
    double code = 0.0;
    std::string word;
    if (words >> code >> word && code == value) return word;
  }
  return "";
}

// Returns the owner of a channel, its name up to the last point: "box" of "box.x".
std::string owner_of(const std::string& channel) { return channel.substr(0, channel.rfind('.')); }

// Returns the owners of a channel and, if it is a formula, of all channels that it uses directly or through other formulas.
std::set<std::string> owners_of(const Model& model, const std::string& channel) {
  std::set<std::string> owners, seen{channel};
  std::vector<std::string> names{channel};
  while (!names.empty()) {
    const std::string name = std::move(names.back());
    names.pop_back();
    bool is_formula = false;
    for (const DefinedChannel& defined : model.channels) {
      if (defined.name != name) continue;
      is_formula = true;
      const Formula formula(defined.expression, "", {});
      for (const std::string& each : formula.names())
        if (seen.insert(each).second) names.push_back(each);
    }
    if (!is_formula) owners.insert(owner_of(name));
  }
  return owners;
}

// Returns the moving bodies that an element connects, directly or as the friction of other elements, such as contacts.
std::vector<std::string> bodies_of(const Model& model, const ElementEntry& entry) {
  std::vector<std::string> bodies;
  for (const Field& field : entry.kind->fields.fields()) {
    const FieldValue value = field.get(entry.element.get());
    if (field.type == FieldType::marker || field.type == FieldType::body) {
      const auto& name = std::get<std::string>(value);
      const Body* const body = name.empty() ? nullptr : place_of(model, name).body;
      if (body && !body->fixed) bodies.push_back(body->name);
    }
    if (field.type != FieldType::elements) continue;
    for (const std::string& name : std::get<std::vector<std::string>>(value))
      for (const ElementEntry& other : model.elements)
        if (other.element->name == name && &other != &entry) {
          const std::vector<std::string> more = bodies_of(model, other);
          bodies.insert(bodies.end(), more.begin(), more.end());
        }
  }
  return bodies;
}

bool slips_at_end(const RangeIndex& ranges, const std::string& element) {
  const ChannelRange* const mode = ranges.find(element + ".mode");
  const std::string word = mode ? word_of(mode->channel->codes, mode->final) : "";
  return word == "slips" || word == "slides";
}

// Elements that slip when the run ends, and the places that move with them.
class Slides {
public:
  Slides(const LoadedModel& loaded, const RunResult& result) : model_(loaded.model), result_(result) {
    const RangeIndex ranges(result.ranges);
    for (const ElementEntry& entry : model_.elements) {
      if (!slips_at_end(ranges, entry.element->name)) continue;
      owners_.insert(entry.element->name);
      for (const std::string& body : bodies_of(model_, entry)) owners_.insert(body);
    }
    if (!owners_.empty()) follow_joints(*loaded.system);
  }
  /// Returns true if the channel is a place that belongs to an element that slips, to one of its bodies or to a body that these carry by
  /// joints, or a formula of such channels.
  [[nodiscard]] bool moves(const Channel& channel) const {
    if (!is_place(channel)) return false;
    const auto owners = owners_of(model_, channel.name);
    return std::any_of(owners.begin(), owners.end(), [this](const std::string& owner) { return owners_.count(owner) > 0; });
  }
  /// Returns true if a criterion limits a place of the element's bodies, or a formula of their channels.
  [[nodiscard]] bool is_limited(const ElementEntry& entry) const {
    const std::vector<std::string> bodies = bodies_of(model_, entry);
    return std::any_of(result_.ranges.begin(), result_.ranges.end(), [&](const ChannelRange& range) {
      if (!is_place(*range.channel) || !is_limited(range.channel->name)) return false;
      const auto owners = owners_of(model_, range.channel->name);
      return std::any_of(bodies.begin(), bodies.end(), [&](const std::string& body) { return owners.count(body) > 0; });
    });
  }

private:
  // Adds the bodies that joints connect to those that slide. A body that a drive moves, such as the vehicle on which a load slides, moves
  // without the slide.
  void follow_joints(const System& system) {
    std::vector<std::vector<int>> joined(system.bodies.size());
    std::vector<char> is_left_out(system.bodies.size(), 0);
    is_left_out[k_ground] = 1;
    for (const RowSpec& row : system.rows) {
      joined[static_cast<std::size_t>(row.a)].push_back(row.b);
      joined[static_cast<std::size_t>(row.b)].push_back(row.a);
      if (row.drive) is_left_out[static_cast<std::size_t>(row.a)] = is_left_out[static_cast<std::size_t>(row.b)] = 1;
    }
    std::vector<int> next;
    const auto take = [&](int body) {
      if (std::exchange(is_left_out[static_cast<std::size_t>(body)], char{1}) != 0) return;
      owners_.insert(system.bodies[static_cast<std::size_t>(body)].name);
      next.push_back(body);
    };
    for (int body = 1; body < system.body_count(); ++body) {
      const std::string& name = system.bodies[static_cast<std::size_t>(body)].name;
      if (owners_.count(name) > 0 && is_left_out[static_cast<std::size_t>(body)] != 0) owners_.erase(name);
      else if (owners_.count(name) > 0) take(body);
    }
    while (!next.empty()) {
      const int body = next.back();
      next.pop_back();
      for (const int other : joined[static_cast<std::size_t>(body)]) take(other);
    }
  }

  static bool is_place(const Channel& channel) { return channel.unit == "m" || channel.unit == "rad"; }
  [[nodiscard]] bool is_limited(const std::string& channel) const {
    return std::any_of(model_.criteria.begin(), model_.criteria.end(),
                       [&](const Criterion& criterion) { return criterion.event.empty() && matches_pattern(channel, criterion.channel); });
  }

  const Model& model_;
  const RunResult& result_;
  std::unordered_set<std::string> owners_;
};

// Returns the force channel if the element is a contact, which has a gap and a force; nullptr otherwise.
const ChannelRange* force_of_contact(const RangeIndex& ranges, const std::string& element) {
  return ranges.find(element + ".gap") ? ranges.find(element + ".force") : nullptr;
}

} // namespace

namespace {

Location where_of(const Model& model, const std::string& criterion) {
  const auto found = std::find_if(model.criteria.begin(), model.criteria.end(), [&](const Criterion& c) { return c.name == criterion; });
  return found == model.criteria.end() ? Location{} : found->where;
}

Finding still_grows(const Model& model, const std::string& criterion, const std::string& how) {
  return {"criterion_still_grows", FindingLevel::warning,
          "'" + criterion + "' is met so far, but " + how + ". Let the run go on until it comes to rest", where_of(model, criterion)};
}

std::string after(double seconds) { return " after " + rounded_text(seconds, 3) + " s more"; }

// Returns the time, s, in which the worst value of criterion i reaches its limit at the rate of the last eighth of a run of length `end`,
// s. Returns nothing if the value did not grow in each eighth of the second half, or if its growth slows down.
std::optional<double> builds_up_in(const ReserveHistory& history, std::size_t i, double end) {
  constexpr int k_parts = 8;
  constexpr double k_steady = 0.5; // least growth of the last eighth, relative to the growth in the earlier ones
  double before = history.reserve(i, 0.5 * end), grown = 0.0, last = 0.0;
  for (int part = k_parts / 2 + 1; part <= k_parts; ++part) {
    const double left = history.reserve(i, part == k_parts ? std::numeric_limits<double>::infinity() : end * part / k_parts);
    last = before - left;
    if (!(last > 0.0) || !std::isfinite(last)) return std::nullopt;
    if (part < k_parts) grown += last;
    before = left;
  }
  if (last < k_steady * grown / (k_parts / 2 - 1)) return std::nullopt;
  return before / last * end / k_parts;
}

} // namespace

namespace {

// Returns the value that a channel reaches within `length` seconds after the end, at its present rate and growing second derivative. A
// place in a slide goes on for up to k_far of this time: as far as its deceleration lets it, or for all of that time if it has none.
double value_after_end(const ChannelRange& range, double length, bool is_slide) {
  constexpr double k_far = 50.0; // a slide of half a minute, where the run shows half a second
  const double rate = range.final_rate, bend = range.final_bend;
  const double growing = bend * rate > 0.0 ? bend : 0.0;
  if (!is_slide) return range.final + (rate + 0.5 * growing * length) * length;
  const double far = k_far * length, stops_in = bend * rate < 0.0 ? -rate / bend : far;
  const double way = stops_in < far ? 0.5 * rate * stops_in : (rate + 0.5 * growing * far) * far;
  return range.final + std::copysign(std::max(std::abs(way), std::abs(rate) * length), rate);
}

} // namespace

std::vector<Finding> growing_criteria(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement) {
  constexpr double k_still_worst = 1e-6; // tolerance relative to the range: accuracy of extremes
  const double length = result.final_state.t;
  std::vector<Finding> findings;
  std::unordered_set<std::string> known;
  const std::vector<LimitedChannel> all = limited_channels(loaded.model, result, judgement);
  const ReserveHistory history(result, all);
  const Slides slides(loaded, result);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const LimitedChannel& limited = all[i];
    const ChannelRange& range = result.ranges[limited.channel];
    const double slack = k_still_worst * (range.high.value - range.low.value), rate = range.final_rate;
    const double then = value_after_end(range, length, slides.moves(*range.channel));
    const bool rises = rate > 0.0 && range.final >= range.high.value - slack && then >= limited.largest;
    const bool falls = rate < 0.0 && range.final <= range.low.value + slack && then <= limited.least;
    const std::string &unit = range.channel->unit, &name = range.channel->name;
    if (rises || falls) {
      const double limit = rises ? limited.largest : limited.least;
      if (known.insert(limited.criterion).second)
        findings.push_back(still_grows(loaded.model, limited.criterion,
                                       "when the run ends '" + name + "' is at " + quantity_text(range.final, unit) + " and still " +
                                           (rises ? "rises" : "falls") + ": at its present rate it reaches the limit of " +
                                           quantity_text(limit, unit) + after((limit - range.final) / rate)));
    } else if (const auto builds_up = i < history.count() ? builds_up_in(history, i, length) : std::nullopt;
               builds_up && *builds_up <= length) {
      if (known.insert(limited.criterion).second)
        findings.push_back(still_grows(loaded.model, limited.criterion,
                                       "the largest value of '" + name +
                                           "' grows to the end of the run: at its present rate it reaches "
                                           "the limit" +
                                           after(*builds_up)));
    }
  }
  return findings;
}

std::vector<Finding> open_at_end(const LoadedModel& loaded, const RunResult& result) {
  const Model& model = loaded.model;
  if (model.criteria.empty()) return {}; // without criteria nothing is judged
  const RangeIndex ranges(result.ranges);
  const Slides slides(loaded, result);
  std::vector<std::string> slip, are_open;
  for (const ElementEntry& entry : model.elements) {
    const std::string& name = entry.element->name;
    const bool slips = slips_at_end(ranges, name);
    const ChannelRange* const force = force_of_contact(ranges, name);
    const bool has_opened = force && force->first > 0.0 && !(force->final > 0.0);
    if ((!slips && !has_opened) || entry.kind->judge || is_asked(model, result, name) || (slips && slides.is_limited(entry))) continue;
    (slips ? slip : are_open).push_back(name);
  }
  if (slip.empty() && are_open.empty()) return {};
  std::string text = "when the run ends ";
  if (!slip.empty()) text += list_of(slip) + (slip.size() == 1 ? " slips" : " slip");
  if (!slip.empty() && !are_open.empty()) text += " and ";
  if (!are_open.empty()) text += list_of(are_open) + (are_open.size() == 1 ? " is open" : " are open");
  return {{"open_at_end",
           FindingLevel::note,
           text + ", and no criterion asks for " + (slip.size() + are_open.size() == 1 ? "it" : "them"),
           {}}};
}

namespace {

// Union-find structure of bodies connected by elements. Bodies named by limits, forces and drives are connected with the ground.
class Carriers {
public:
  // `asks`: bodies named by limits count as carried, too. Finding them is slow, so this is requested only if some body is not carried
  // otherwise.
  Carriers(const Model& model, const RunResult& result, bool asks) : model_(model), result_(result), ranges_(result.ranges), asks_(asks) {
    for (const Body& body : model.bodies)
      if (!body.fixed) place_[body.name] = static_cast<int>(parent_.size()), parent_.push_back(static_cast<int>(parent_.size()));
    for (const Marker& marker : model.markers) place_.try_emplace(marker.name, of(marker.body));
    for (const ElementEntry& entry : model.elements) add(entry);
    if (!asks) return;
    for (const Body& body : model.bodies)
      if (is_limited(body.name)) join(of(body.name), 0);
    for (const DefinedChannel& channel : model.channels)
      if (std::any_of(model.criteria.begin(), model.criteria.end(),
                      [&](const Criterion& c) { return c.event.empty() && matches_pattern(channel.name, c.channel); })) {
        const Formula formula(channel.expression, "", {});
        for (const std::string& name : formula.names()) join_named(name);
      }
  }

  bool is_carried(const Body& body) { return body.fixed || root(of(body.name)) == root(0); }

private:
  [[nodiscard]] int of(const std::string& name) const { // index in parent_; 0 for the ground and bodies that never move
    const auto found = place_.find(name);
    return found == place_.end() ? 0 : found->second;
  }
  int root(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i)
      i = parent_[static_cast<std::size_t>(i)] = parent_[static_cast<std::size_t>(parent_[static_cast<std::size_t>(i)])];
    return i;
  }
  void join(int a, int b) { parent_[static_cast<std::size_t>(root(a))] = root(b); }

  // Joins the owner of a channel, "body" of "body.x", with the ground, so that it counts as carried.
  void join_named(const std::string& channel) {
    const std::size_t point = channel.rfind('.');
    const ChannelRange* const range = ranges_.find(channel);
    if (point != std::string::npos && !(range && is_rotation(*range->channel))) join(of(channel.substr(0, point)), 0);
  }

  // A body may turn as it likes while it falls: a limit of its rotation does not ask for the fall. Nor does a forbidden event.
  static bool is_rotation(const Channel& channel) { return channel.unit.starts_with("rad"); }
  [[nodiscard]] bool is_limited(const std::string& name) const {
    return std::any_of(model_.criteria.begin(), model_.criteria.end(), [&](const Criterion& criterion) {
      return criterion.event.empty() && std::any_of(result_.ranges.begin(), result_.ranges.end(), [&](const ChannelRange& range) {
               const std::string& channel = range.channel->name;
               return channel.starts_with(name + ".") && !is_rotation(*range.channel) && matches_pattern(channel, criterion.channel);
             });
    });
  }

  void add(const ElementEntry& entry) {
    const Element& element = *entry.element;
    if (as_action(element)) return;
    for (const std::string& name : names_in_formulas(entry)) join_named(name);
    if (const ChannelRange* const force = force_of_contact(ranges_, element.name);
        force && force->low.value == 0.0 && force->high.value == 0.0)
      return; // the contact never closed
    std::vector<int> bodies;
    for (const Field& field : entry.kind->fields.fields()) {
      if (field.type == FieldType::marker || field.type == FieldType::body)
        bodies.push_back(of(std::get<std::string>(field.get(&element))));
      if (field.type != FieldType::texts || field.name != "over") continue;
      const auto over = std::get<std::vector<std::string>>(field.get(&element));
      for (const std::string& marker : over) bodies.push_back(of(marker));
    }
    const bool is_load = entry.kind->has_constant_load != nullptr;
    const bool is_drive = !parts_of(entry.kind->fields, &element).empty();
    if (is_load || is_drive || (asks_ && is_limited(element.name))) bodies.push_back(0);
    for (const int body : bodies) join(body, bodies.front());
  }

  const Model& model_;
  const RunResult& result_;
  RangeIndex ranges_;
  bool asks_;
  std::unordered_map<std::string, int> place_; ///< index in parent_, by name of body or marker
  std::vector<int> parent_{0};                 ///< union-find forest: each tree is a set of connected bodies
};

} // namespace

std::vector<Finding> bodies_that_fall(const LoadedModel& loaded, const RunResult& result) {
  const Model& model = loaded.model;
  if (model.header.gravity == Vec2::Zero()) return {};
  const auto carries_all = [&](Carriers carriers) {
    return std::all_of(model.bodies.begin(), model.bodies.end(), [&](const Body& body) { return carriers.is_carried(body); });
  };
  if (carries_all({model, result, false})) return {};
  Carriers carriers(model, result, true);
  const RangeIndex ranges(result.ranges);
  std::vector<Finding> findings;
  for (const Body& body : model.bodies) {
    if (carriers.is_carried(body)) continue;
    const ChannelRange *const x = ranges.find(body.name + ".x"), *const y = ranges.find(body.name + ".y");
    const double way = x && y ? portable::hypot(x->final - x->first, y->final - y->first) : 0.0;
    findings.push_back(
        {"nothing_carries", FindingLevel::warning,
         "nothing carries body '" + body.name + "', which moves by " + quantity_text(way, "m") +
             ": no element that touches it leads to the ground, and no force, drive or limit of a place or velocity names it. Give it "
             "a support, or ask for what it should do",
         body.where});
  }
  return findings;
}

} // namespace steplap
