#include "mbd/run/story.h"

#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/model/action.h"
#include "mbd/system/contact_description.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

namespace steplap {

namespace {

struct SubjectText {
  const char* key;     // result of key_of()
  const char* verb;    // for one subject: "slips"
  const char* several; // for several subjects: "slip"
};

const SubjectText& words_of(StorySubject what) {
  static constexpr std::array<SubjectText, 17> k_words{
      {{"slips", "slips", "slip"},
       {"would slip", "would slip", "would slip"},
       {"lifts", "lifts", "lift"},
       {"opens", "opens", "open"},
       {"closes", "touches", "touch"},
       {"goes slack", "goes slack", "go slack"},
       {"becomes taut", "becomes taut", "become taut"},
       {"opens", "opens its gap", "open their gaps"},
       {"closes", "closes its gap", "close their gaps"},
       {"strikes", "strikes its stop", "strike their stops"},
       {"leaves its stop", "leaves its stop", "leave their stops"},
       {"tips", "tips", "tip"},
       {"breaks", "breaks", "break"},
       {"comes apart", "comes apart", "come apart"},
       {"loses an interface", "loses an interface", "lose interfaces"},
       {"changes too often", "changes too often to be followed event by event", "change too often to be followed event by event"},
       {"happens", "happens", "happen"}}};
  return k_words[static_cast<std::size_t>(what)];
}

// Occurrences of one kind at one element; repetitions are counted.
struct Happening {
  StorySubject what = StorySubject::slips;
  std::string who;
  std::size_t count = 0;
  double from = 0.0, begun = 0.0; // begin of the first and of the last occurrence, s
  std::optional<double> to;       // end of the last occurrence, s; empty: it lasts until the end of the run
  std::optional<StoryAmount> amount;
  std::optional<double> from_error, to_error;
  bool is_over = true;
  std::string detail = {};        // for an action: its effect
  std::string body = {}, on = {}; // for friction under contacts: the sliding body, and the body on which it slides
};

bool is_instant(StorySubject what) {
  return what == StorySubject::breaks || what == StorySubject::apart || what == StorySubject::interface || what == StorySubject::tips ||
         what == StorySubject::would_slip || what == StorySubject::happens;
}

// --- from events to occurrences

constexpr double k_at_start = 1e-5; // events before this fraction of the run belong to the start

// Occurrence of an element that opens and closes repeatedly, defined by its first event.
struct SubjectDirection {
  StorySubject what;
  bool is_opening;
};

class OccurrenceCollector {
public:
  OccurrenceCollector(const Report& report, const RangeIndex& ranges) : report_(report), ranges_(ranges) {
    const Model& model = report.run.loaded->model;
    for (const ElementEntry& entry : model.elements) entry_of_.emplace(entry.element->name, &entry);
  }

  std::vector<Happening> gather() {
    const std::vector<Event>& events = report_.run.result.events;
    for (std::size_t i = 0; i < events.size(); ++i) take(events[i], report_.event_error(i));
    for (Happening& h : found_) {
      add_amount(h);
      add_bodies(h);
    }
    add_monitored();
    add_tipped();
    const double end = report_.run.result.final_state.t;
    std::erase_if(found_, [end](const Happening& h) { // bodies that touch the floor at the start and stay there are not reported
      return h.what == StorySubject::touches && h.count == 1 && h.from <= k_at_start * end && !h.is_over;
    });
    std::stable_sort(found_.begin(), found_.end(), [](const Happening& a, const Happening& b) { return a.from < b.from; });
    return std::move(found_);
  }

private:
  // Smallest reported rotation, rad; smaller ones are rocking on springs.
  static constexpr double k_tipped = 5.0 / 180.0 * std::numbers::pi;
  static constexpr double k_upright = 0.7; // least cosine of the angle of a supporting contact to the vertical, about 45°

  const ElementEntry* entry_of(const std::string& element) const {
    const auto found = entry_of_.find(element);
    return found == entry_of_.end() ? nullptr : found->second;
  }

  bool goes_slack(const std::string& element) const {
    const ElementEntry* entry = entry_of(element);
    return entry && entry->kind->goes_slack;
  }

  std::optional<ContactDescription> contact_at(const std::string& element) const {
    const ElementEntry* const entry = entry_of(element);
    return entry ? contact_of(*entry, report_.run.loaded->model) : std::nullopt;
  }

  bool opening_ends_slip(const std::string& element) const {
    const std::optional<ContactDescription> contact = contact_at(element);
    return contact && contact->opening_ends_slip;
  }

  // Returns true if the contact supports a body against gravity, so that its opening is a lift.
  bool is_upright(const std::string& element) const { return upward(element) > k_upright; }
  // Returns the cosine of the angle between the force on a and the vertical; 0 without a contact or gravity.
  double upward(const std::string& element) const {
    const auto [known, is_new] = upward_.try_emplace(element, 0.0);
    if (is_new) known->second = find_upward(element);
    return known->second;
  }
  double find_upward(const std::string& element) const {
    const std::optional<ContactDescription> contact = contact_at(element);
    if (!contact) return 0.0;
    const LoadedModel& loaded = *report_.run.loaded;
    const State reference = loaded.system->initial_state();
    const auto points = contact->points(*entry_of(element)->element, ScenePose(loaded.model, *loaded.system, reference));
    const Vec2& gravity = loaded.model.header.gravity;
    if (points.empty() || gravity == Vec2::Zero()) return 0.0;
    return -points.front().normal.dot(gravity) / gravity.norm();
  }

  static std::string place_name(StorySubject what, const std::string& who) {
    return who + '\0' + static_cast<char>('a' + static_cast<int>(what));
  }

  Happening& entry(StorySubject what, const std::string& who) {
    const auto [place, is_new] = place_.try_emplace(place_name(what, who), found_.size());
    if (is_new) found_.push_back({what, who, 0, 0.0, 0.0, {}, {}, {}, {}, true});
    return found_[place->second];
  }

  void begin(StorySubject what, const Event& event, std::optional<double> error) {
    Happening& h = entry(what, event.element);
    if (!h.is_over) return;
    if (h.count++ == 0) {
      h.from = event.t;
      h.from_error = error;
    }
    h.begun = event.t;
    h.to.reset();
    h.is_over = is_instant(what);
    if (h.is_over) h.to = event.t;
  }

  void end(StorySubject what, const Event& event, std::optional<double> error) {
    const auto place = place_.find(place_name(what, event.element));
    if (place == place_.end() || found_[place->second].is_over) return;
    Happening& h = found_[place->second];
    h.is_over = true;
    h.to = event.t;
    h.to_error = error;
  }

  // Begins or ends an occurrence. `is_opening`: the element opens, goes slack or reaches its stop; false for the reverse.
  void toggle(bool is_opening, const Event& event, std::optional<double> error) {
    auto way = ways_.find(event.element);
    if (way == ways_.end()) way = ways_.emplace(event.element, SubjectDirection{what_of(event, is_opening), is_opening}).first;
    if (way->second.is_opening == is_opening) begin(way->second.what, event, error);
    else end(way->second.what, event, error);
  }

  // Returns the occurrence that begins with the first event of the element.
  StorySubject what_of(const Event& event, bool is_opening) const {
    switch (event.kind) {
    case EventKind::opens:
    case EventKind::closes:
      return !is_opening ? StorySubject::touches : is_upright(event.element) ? StorySubject::lifts : StorySubject::opens;
    case EventKind::enters_gap:
    case EventKind::closes_gap:
      if (goes_slack(event.element)) return is_opening ? StorySubject::slack : StorySubject::taut;
      return is_opening ? StorySubject::leaves_gap : StorySubject::closes_gap;
    default: return is_opening ? StorySubject::strikes : StorySubject::leaves_stop;
    }
  }

  // Adds an action. If it releases an element, the element's occurrences end: it no longer slides, presses or is slack.
  void take_action(const Event& event, std::optional<double> error) {
    begin(StorySubject::happens, event, error);
    entry(StorySubject::happens, event.element).detail = event.detail;
    const ElementEntry* const found = entry_of(event.element);
    const auto* const action = found ? as_action(*found->element) : nullptr;
    if (!action) return;
    for (const std::string& text : action->steps) {
      const ActionStepText step = action_step(text);
      if (step.verb != ActionVerb::release) continue;
      for (const StorySubject what :
           {StorySubject::slips, StorySubject::lifts, StorySubject::opens, StorySubject::touches, StorySubject::slack, StorySubject::taut,
            StorySubject::leaves_gap, StorySubject::closes_gap, StorySubject::strikes, StorySubject::leaves_stop})
        end(what, {event.t, step.name, EventKind::none}, error);
    }
  }

  void take(const Event& event, std::optional<double> error) {
    switch (event.kind) {
    case EventKind::slips:
    case EventKind::slips_forward:
    case EventKind::slips_backward:
    case EventKind::changes_slip_direction: return begin(StorySubject::slips, event, error);
    case EventKind::sticks:
    case EventKind::loses_normal_force: return end(StorySubject::slips, event, error);
    case EventKind::force_reaches_zero:
      if (opening_ends_slip(event.element)) end(StorySubject::slips, event, error);
      return;
    case EventKind::opens:
      if (opening_ends_slip(event.element)) end(StorySubject::slips, event, error);
      return toggle(true, event, error);
    case EventKind::enters_gap:
    case EventKind::reaches_lower_stop:
    case EventKind::reaches_upper_stop: return toggle(true, event, error);
    case EventKind::closes:
    case EventKind::closes_gap:
    case EventKind::leaves_stop: return toggle(false, event, error);
    case EventKind::breaks: return begin(StorySubject::breaks, event, error);
    case EventKind::comes_apart: end(StorySubject::slips, event, error); return begin(StorySubject::apart, event, error);
    case EventKind::loses_interface: return begin(StorySubject::interface, event, error);
    case EventKind::happens: return take_action(event, error);
    case EventKind::storm: return begin(StorySubject::storm, event, error);
    case EventKind::event_storm_ends: return end(StorySubject::storm, event, error);
    default: return;
    }
  }

  // Returns the change of a channel since the start, or its largest value.
  std::optional<StoryAmount> excursion(const std::string& channel, bool is_from_start) const {
    const ChannelRange* range = ranges_.find(channel);
    if (!range || !std::isfinite(range->high.value) || !std::isfinite(range->low.value)) return {};
    const double first = is_from_start ? range->first : 0.0;
    const double up = range->high.value - first, down = first - range->low.value;
    const auto error = report_.error_of(*range, up >= down ? &ChannelError::high : &ChannelError::low);
    return StoryAmount{std::max(up, down), range->channel->unit, error};
  }

  std::optional<StoryAmount> slid(const std::string& who) const {
    for (const JointAssessment& joint : report_.joints)
      if (joint.joint == who) {
        std::optional<double> error;
        if (const auto& estimate = report_.estimate.errors) {
          const JointErrors e = joint_errors(joint, *report_.run.loaded->system, report_.run.result, *estimate);
          error = portable::hypot(e.slid_x, e.slid_y);
        }
        StoryAmount most{portable::hypot(joint.slid_x, joint.slid_y), "m", error};
        for (const char* axis : {".dx", ".dy"}) // a joint may slide out and back
          if (const auto way = excursion(who + axis, true); way && way->value > most.value) most = *way;
        return most;
      }
    return excursion(who + ".slide", true);
  }

  void add_amount(Happening& h) const {
    if (h.what == StorySubject::slips) h.amount = slid(h.who);
    if (h.what == StorySubject::lifts || h.what == StorySubject::opens)
      if (const ChannelRange* gap = ranges_.find(h.who + ".gap"); gap && gap->high.value > 0.0)
        h.amount = StoryAmount{gap->high.value, gap->channel->unit, report_.error_of(*gap, &ChannelError::high)};
    if (h.what == StorySubject::touches) h.amount = excursion(h.who + ".force", false);
    if (h.what == StorySubject::strikes)
      for (const char* part : {".force", ".couple"})
        if (!h.amount) h.amount = excursion(h.who + part, false);
  }

  // Returns the names of the bodies that friction under contacts joins; nothing for other elements.
  std::optional<std::pair<std::string, std::string>> bodies_of_friction(const ElementEntry& entry) const {
    if (!entry.kind->friction) return std::nullopt;
    const ElementEntry* touching = &entry;
    if (const Field* const contacts = entry.kind->fields.find("contacts")) { // friction is a separate element, on contacts
      const auto names = std::get<std::vector<std::string>>(contacts->get(entry.element.get()));
      touching = names.empty() ? nullptr : entry_of(names.front());
    }
    const auto contact = touching ? contact_of(*touching, report_.run.loaded->model) : std::nullopt;
    if (!contact) return std::nullopt;
    const auto name = [this](const std::string& marker) {
      const Place place = place_of(report_.run.loaded->model, marker);
      return place.body ? place.body->name : std::string("ground");
    };
    return std::pair{name(contact->a), name(contact->b)};
  }

  // Sets the body that slides and the one on which it slides. If two friction elements join the same bodies, the names of the elements are
  // kept, to distinguish them.
  void add_bodies(Happening& h) const {
    const ElementEntry* const entry = h.what == StorySubject::slips ? entry_of(h.who) : nullptr;
    const auto bodies = entry ? bodies_of_friction(*entry) : std::nullopt;
    if (!bodies) return;
    const auto& elements = report_.run.loaded->model.elements;
    const auto same =
        std::count_if(elements.begin(), elements.end(), [&](const ElementEntry& e) { return bodies_of_friction(e) == bodies; });
    if (same == 1) std::tie(h.body, h.on) = *bodies;
  }

  // Adds monitored joints whose capacity was exceeded. Such a joint does not slip; the entry says that it would have slipped.
  void add_monitored() {
    for (const JointAssessment& joint : report_.joints)
      if (joint.is_monitored && joint.first_slip)
        found_.push_back(
            {StorySubject::would_slip, joint.joint, 1, *joint.first_slip, *joint.first_slip, *joint.first_slip, {}, {}, {}, true});
  }

  // Bodies on corners or faces, each with the moving bodies on which it stands; "" for the ground.
  using Floors = std::unordered_map<std::string, std::vector<std::string>>;

  Floors floors() const {
    Floors floors;
    const Model& model = report_.run.loaded->model;
    const auto note = [&](const std::string& above, const std::string& below, bool is_carried) {
      const Place top = place_of(model, above), floor = place_of(model, below);
      if (!top.body) return;
      std::vector<std::string>& known = floors[top.body->name];
      const std::string name = floor.body && !floor.body->fixed ? floor.body->name : "";
      if (is_carried && std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
    };
    for (const ElementEntry& entry : model.elements) {
      const std::optional<ContactDescription> contact = contact_of(entry, model);
      if (!contact || contact->standing == ContactDescription::Standing::none) continue;
      const double up = upward(entry.element->name);
      note(contact->a, contact->b, up > k_upright);
      if (contact->standing == ContactDescription::Standing::both) note(contact->b, contact->a, up < -k_upright);
    }
    return floors;
  }

  struct Tip {
    StoryAmount turned;
    double t = 0.0; // time of the largest rotation, s
  };

  // Returns the largest rotation of a body since the start against the ground, or against a body on which it stands.
  std::optional<Tip> tip_of(const std::string& body, const std::string& floor) const {
    const auto turned = excursion(body + ".theta", true);
    const ChannelRange* const range = ranges_.find(body + ".theta");
    if (!range || !turned) return {};
    Tip tip{*turned, range->high.value - range->first >= range->first - range->low.value ? range->high.t : range->low.t};
    const auto of_floor = floor.empty() ? std::nullopt : excursion(floor + ".theta", true);
    if (!of_floor || of_floor->value == 0.0) return tip;
    if (turned->value + of_floor->value < k_tipped) return tip;
    tip.turned = {std::max(0.0, turned->value - of_floor->value), turned->unit, {}}; // a lower bound, if the angles were not sampled
    const Trajectory& samples = *report_.run.result.trajectory;
    const auto column = [&samples](const std::string& name) {
      const auto& channels = samples.channels();
      const auto found = std::find_if(channels.begin(), channels.end(), [&name](const Channel* c) { return c->name == name; });
      return found == channels.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - channels.begin()));
    };
    const auto own = column(body + ".theta"), other = column(floor + ".theta");
    if (!own || !other) return tip;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double relative = samples.value(i, *own) - samples.value(i, *other) - range->first + ranges_.find(floor + ".theta")->first;
      if (std::abs(relative) > tip.turned.value) tip.turned.value = std::abs(relative), tip.t = samples.time(i);
    }
    return tip;
  }

  // Adds bodies on corners or faces that rotated far against all on which they stand, and that no joint guides. Rotation of wheels and
  // cranks is intended.
  void add_tipped() {
    const Floors standing = floors();
    if (standing.empty()) return;
    std::unordered_set<std::string> guided;
    const System& system = *report_.run.loaded->system;
    for (const RowSpec& row : system.rows)
      for (const int body : {row.a, row.b})
        if (body > 0) guided.insert(system.bodies[static_cast<std::size_t>(body)].name);
    for (const BodyData& body : system.bodies) {
      const auto floor = standing.find(body.name);
      if (floor == standing.end() || guided.contains(body.name)) continue;
      std::optional<Tip> least = floor->second.empty() ? tip_of(body.name, "") : std::nullopt;
      for (const std::string& below : floor->second)
        if (const auto tip = tip_of(body.name, below); tip && (!least || tip->turned.value < least->turned.value)) least = tip;
      if (!least || least->turned.value < k_tipped) continue;
      found_.push_back({StorySubject::tips, body.name, 1, least->t, least->t, least->t, least->turned, {}, {}, true});
    }
  }

  const Report& report_;
  const RangeIndex& ranges_;
  std::unordered_map<std::string, const ElementEntry*> entry_of_;
  std::unordered_map<std::string, std::size_t> place_; // index in found_ by element and subject
  std::unordered_map<std::string, SubjectDirection> ways_;
  mutable std::unordered_map<std::string, double> upward_; // cache of upward()
  std::vector<Happening> found_;
};

// --- from occurrences to text

class StoryWriter {
public:
  StoryWriter(const Report& report, ShownDigits digits) : digits_(digits), end_(report.run.result.final_state.t) {
    for (const ChannelRange& range : report.ranges()) { // sizes of the scene, to detect rounding errors
      if (range.channel->unit == "m") scale_m_ = std::max(scale_m_, std::abs(range.largest().value));
      if (range.channel->unit == "N") scale_n_ = std::max(scale_n_, std::abs(range.largest().value));
    }
  }

  // Returns "the start" or the time with its unit. `beside`: a later time in the same sentence, which gets the same unit.
  std::string time(double t, std::optional<double> error, double beside = 0.0) const {
    if (is_start(t)) return "the start";
    return shown_quantity(t, "s", {.error = error, .scale = end_, .column = std::max(t, beside)}, digits_);
  }
  bool is_start(double t) const { return t <= k_at_start * end_; }

  std::string amount(const StoryAmount& a) const {
    if (a.unit == "rad") {
      const double degrees = 180.0 / std::numbers::pi;
      return shown_quantity(a.value * degrees, "", {.error = a.error ? std::optional(*a.error * degrees) : std::nullopt}, digits_) + "°";
    }
    return shown_quantity(a.value, a.unit, {.error = a.error, .scale = a.unit == "m" ? scale_m_ : scale_n_}, digits_);
  }

  // Returns the amount as ", at most 3.1 mm" or similar; "" without an amount.
  std::string reach(StorySubject what, const std::optional<StoryAmount>& a) const {
    if (!a) return "";
    const std::string shown = amount(*a);
    if (shown.starts_with("0 ") || shown == "0°") return "";
    switch (what) {
    case StorySubject::slips: return " and slides " + shown;
    case StorySubject::lifts:
    case StorySubject::opens: return ", at most " + shown;
    case StorySubject::touches: return ", pressing with up to " + shown;
    case StorySubject::strikes: return ", with up to " + shown;
    case StorySubject::tips: return " by up to " + shown;
    default: return "";
    }
  }

  // Returns " at 0.2 s", " from 0.2 s to 0.3 s" or " 14 times between 0.2 s and 1.1 s".
  std::string when(const Happening& h) const {
    const std::string from = time(h.from, h.from_error, h.to.value_or(end_)), to = h.to ? time(*h.to, h.to_error) : "the end";
    if (h.count > 1) return " " + times(h.count) + " between " + from + " and " + to;
    if (is_instant(h.what)) return " at " + from;
    if (h.to && from == to) return " at " + from + " for " + time(*h.to - h.from, {});
    return " from " + from + " to " + to;
  }

  static std::string times(std::size_t count) { return count == 2 ? "twice" : std::to_string(count) + " times"; }

  // Returns true if the name is a plural, which determines the verb form: "Feet slip", "Front foot slips".
  static bool is_plural(const std::string& name) {
    if (name.ends_with("feet")) return true;
    return name.size() > 2 && name.back() == 's' && std::string("aisu").find(name[name.size() - 2]) == std::string::npos;
  }

  std::string sentence(const Happening& h) const {
    const std::string who = sentence_name(h.who);
    if (h.what == StorySubject::tips)
      return who + (h.amount && h.amount->value > k_over
                        ? " tips over: it has turned by " + amount(*h.amount) + " at " + time(h.from, {}) + "."
                        : " tips" + reach(h.what, h.amount) + " (at " + time(h.from, {}) + ").");
    if (h.what == StorySubject::would_slip) return who + ", which is only monitored, would slip at " + time(h.from, {}) + ".";
    if (h.what == StorySubject::happens) return "Action '" + h.who + "' happens" + when(h) + ": " + h.detail + ".";
    if (!h.body.empty()) return slide_sentence(h);
    std::string how = reach(h.what, h.amount);
    if (is_plural(h.who) && how.starts_with(" and slides")) how.replace(0, 11, " and slide");
    return who + " " + (is_plural(h.who) ? words_of(h.what).several : words_of(h.what).verb) + when(h) + how + ".";
  }

  // "Active part slides 0.79 mm on lower tank from 0.1 s to 0.2 s."
  std::string slide_sentence(const Happening& h) const {
    const bool is_repeated = h.count > 1, has_way = !reach(h.what, h.amount).empty();
    const std::string way = has_way ? (is_repeated ? " up to " : " ") + amount(*h.amount) : "";
    return sentence_name(h.body) + (is_plural(h.body) ? " slide" : " slides") + way + " on " +
           (h.on == "ground" ? "the ground" : shown(h.on)) + (is_repeated ? "," : "") + when(h) + ".";
  }

  StoryEntry entry(const Happening& h) const {
    return {h.from, is_instant(h.what) ? std::nullopt : h.to, h.what, {h.who}, h.count, h.amount, sentence(h)};
  }

  // Merges elements with the same occurrence into one entry.
  StoryEntry entry(const std::vector<const Happening*>& group) const {
    const Happening* most = nullptr;
    StoryEntry entry{group.front()->from, group.front()->from, group.front()->what, {}, 0, {}, ""};
    bool lasts = false;
    for (const Happening* h : group) {
      entry.who.push_back(h->who);
      entry.count += h->count;
      lasts = lasts || !h->to;
      if (h->to) entry.to = std::max(*entry.to, *h->to);
      if (h->amount && (!most || h->amount->value > most->amount->value)) most = h;
    }
    const StorySubject what = group.front()->what;
    const std::string to = lasts ? "the end" : time(*entry.to, {});
    if (lasts || is_instant(what)) entry.to.reset();
    const std::size_t more = group.size() - 2;
    entry.text = sentence_name(entry.who[0]) + ", " + entry.who[1] + " and " + std::to_string(more) + " more " + words_of(what).several +
                 (entry.count > group.size() ? ", " + times(entry.count) + " in all," : "") + " between " + time(entry.from, {}, end_) +
                 " and " + to;
    if (most) {
      entry.amount = most->amount;
      if (const std::string how = reach(what, most->amount); !how.empty())
        entry.text += ", most '" + most->who + "': " + amount(*most->amount);
    }
    entry.text += ".";
    return entry;
  }

private:
  static constexpr double k_over = 60.0 / 180.0 * std::numbers::pi; // smallest rotation, rad, from which a body does not return
  ShownDigits digits_;
  double end_ = 0.0, scale_m_ = k_least_length_scale, scale_n_ = 0.0;
};

constexpr std::size_t k_few = 8;      // largest number of entries that are shown individually
constexpr std::size_t k_together = 3; // smallest number of elements that are merged, if there are more than k_few entries

} // namespace

std::string sentence_name(std::string name) {
  if (!name.empty() && name.front() >= 'a' && name.front() <= 'z') name.front() = static_cast<char>(name.front() - 'a' + 'A');
  return shown(name);
}

const char* key_of(StorySubject what) { return words_of(what).key; }

bool describes_motion(const StoryEntry& entry) {
  switch (entry.what) {
  case StorySubject::slips:
  case StorySubject::lifts:
  case StorySubject::opens:
  case StorySubject::leaves_gap:
  case StorySubject::breaks:
  case StorySubject::apart:
  case StorySubject::tips:
  case StorySubject::interface: return true;
  default: return false;
  }
}

std::vector<StoryEntry> story_of(const Report& report, const RangeIndex& ranges, ShownDigits digits) {
  const std::vector<Happening> happenings = OccurrenceCollector(report, ranges).gather();
  const StoryWriter teller(report, digits);
  std::map<StorySubject, std::vector<const Happening*>> groups;
  if (happenings.size() > k_few)
    for (const Happening& h : happenings) groups[h.what].push_back(&h);
  std::vector<StoryEntry> story;
  for (const Happening& h : happenings) {
    const auto group = groups.find(h.what);
    if (group == groups.end() || group->second.size() < k_together) story.push_back(teller.entry(h));
    else if (group->second.front() == &h) story.push_back(teller.entry(group->second));
  }
  return story;
}

} // namespace steplap
