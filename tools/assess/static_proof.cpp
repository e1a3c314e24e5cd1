#include "tools/assess/static_proof.h"

#include "mbd/base/name_pattern.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/base/stop.h"
#include "mbd/run/drawing.h"
#include "mbd/run/edges.h"
#include "mbd/run/findings.h"
#include "mbd/run/prominence.h"
#include "mbd/run/quantity_text.h"
#include "mbd/system/actions.h"
#include "mbd/trust/criteria.h"
#include "mbd/trust/element_judgement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace steplap::assess {

namespace {

constexpr double k_close = 1e-6;       // relative accuracy of a margin, from the accuracy of equilibria
constexpr double k_same_forces = 5e-3; // difference up to which forces are the same after two loading paths to the same load
constexpr double k_least_pull = 1e-3;  // share of a load; a machine that gives way to less is not held at all
constexpr double k_just_below = 1e-3;  // the path from the opposite pull ends this fraction below the acceleration of the first limit

// Returns true for channels that have a meaning at rest: those whose unit contains no rate.
bool is_of_rest(const std::string& unit) { return unit.find("/s") == std::string::npos; }

// Returns the events of a limit that was reached. The direction in which friction along a line slips is not kept.
std::vector<EventKind> events_of(LimitKind kind) {
  switch (kind) {
  case LimitKind::slips: return {EventKind::slips};
  case LimitKind::slides: return {EventKind::slips_forward, EventKind::slips_backward};
  case LimitKind::lifts: return {EventKind::opens};
  case LimitKind::breaks: return {EventKind::breaks};
  case LimitKind::ends: break;
  }
  return {};
}

// Returns the kinds of events of a criterion, and those of them that a path of rests shows.
std::pair<EventKinds, EventKinds> asked_and_seen(const Criterion& criterion) {
  EventKinds seen;
  for (const LimitKind kind : {LimitKind::slips, LimitKind::slides, LimitKind::lifts, LimitKind::breaks})
    for (const EventKind event : events_of(kind)) seen.set(static_cast<std::size_t>(event));
  seen.set(static_cast<std::size_t>(EventKind::changes_slip_direction)); // it has begun to slip before
  const EventKinds asked = event_kinds_matching(criterion.event), both = asked & seen;
  const bool is_one_way =
      both.test(static_cast<std::size_t>(EventKind::slips_forward)) != both.test(static_cast<std::size_t>(EventKind::slips_backward));
  return {asked, is_one_way ? EventKinds() : both};
}

// Returns true if the criterion forbids what happens where this limit is reached.
bool forbids(const Criterion& criterion, const Watch& watch) {
  const std::vector<EventKind> events = events_of(watch.kind);
  const EventKinds asked = event_kinds_matching(criterion.event);
  return criterion.channel.empty() && matches_pattern(watch.element, criterion.element.empty() ? "*" : criterion.element) &&
         std::any_of(events.begin(), events.end(), [&](EventKind event) { return asked.test(static_cast<std::size_t>(event)); });
}

// Returns the results of a path to an equilibrium in the form of a run from the equilibrium without acceleration.
RunResult as_run(const StaticMachine& machine, const Probe& probe) {
  RunResult result;
  for (std::size_t w = 0; w < probe.left.size(); ++w)
    if (!(probe.left[w] >= -k_close)) // within rounding of a limit it is not known: CaseProof::check_rest()
      for (const EventKind event : events_of(machine.watches()[w].kind))
        result.events.push_back({0.0, machine.watches()[w].element, event});
  result.trajectory = std::make_unique<Trajectory>(machine.system(), std::vector<std::string>{""});
  const Probe& before = machine.at_rest();
  for (std::size_t i = 0; i < machine.system().channels.size(); ++i) {
    const double first = before.values[i], last = probe.values[i];
    ChannelRange range;
    range.channel = &machine.system().channels[i];
    range.first = first;
    range.final = last;
    range.low = {std::min(probe.low[i], first), 0.0}; // NaN on the path remains
    range.high = {std::max(probe.high[i], first), 0.0};
    range.had_no_value = std::isnan(first) || std::isnan(probe.low[i]);
    result.ranges.push_back(range);
  }
  return result;
}

// Evaluates the criteria of elements and of the model in one equilibrium.
std::vector<CriterionResult> judged(const StaticMachine& machine, const Probe& probe) {
  const RunResult result = as_run(machine, probe);
  const Model& model = machine.model();
  std::vector<CriterionResult> criteria;
  for (const ElementEntry& entry : model.elements) {
    if (!entry.kind->judge) continue;
    const ElementJudgement own = entry.kind->judge(*entry.element, model, result);
    criteria.insert(criteria.end(), own.criteria.begin(), own.criteria.end());
  }
  for (const Criterion& criterion : model.criteria) {
    CriterionResult one = judge_criterion(criterion, result);
    if (criterion.channel.empty() ? asked_and_seen(criterion).second.any() : is_of_rest(one.unit)) criteria.push_back(std::move(one));
  }
  return criteria;
}

Verdict proof_of(Verdict outcome) { return outcome == Verdict::inspect ? Verdict::reject : outcome; }
int weight(Verdict verdict) { return verdict == Verdict::hold ? 0 : verdict == Verdict::open ? 1 : 2; }

std::string number(double value, const std::string& unit) { return quantity_text(value, unit, 1.0); }
std::string acceleration(double a) { return rounded_text(a, 4) + " m/s²"; }

std::string criterion_text(const CriterionResult& c, const std::string& begin) {
  const std::string what = "'" + (c.channel.empty() ? c.where : c.channel) + "'";
  if (!c.value && c.channel.empty()) return begin + ": " + c.text + " (" + what + ")"; // an event
  return begin + ": " + c.text + " (" + what + (c.value ? " is " + number(*c.value, c.unit) : " has no value") + ")";
}

// Proves one load case along several loading paths.
class CaseProof {
public:
  /// `monitored`: the model of `machine` with its system.
  CaseProof(StaticMachine& machine, const LoadedModel& loaded, const LoadedModel& monitored, const StaticLoad& load)
      : machine_(machine), loaded_(loaded), monitored_(monitored) {
    case_.load = load;
    case_.apparent = machine.gravity() + load.pull;
  }

  StaticCase run() {
    const double a = case_.load.pull.norm();
    grown_ = a > 0.0 ? machine_.ramped(case_.load.pull) : machine_.at_rest();
    if (a > 0.0) follow(a);
    if (!grown_.rest) return std::move(case_);
    case_.verdict = Verdict::hold; // set before the checks, which can only worsen it
    ways_.push_back(&grown_);
    add_other_paths();
    collect();
    decide();
    return std::move(case_);
  }

private:
  void note(Verdict verdict, const std::string& why) {
    if (weight(verdict) < weight(case_.verdict) || (verdict == case_.verdict && !case_.why.empty())) return;
    if (verdict == Verdict::hold) return;
    case_.verdict = verdict;
    case_.why = why;
  }

  // Grows the load to find the element that slips, slides or lifts first.
  void follow(double a) {
    const StaticRay ray = grow_pull(machine_, case_.load.pull / a, a);
    if (!ray.limits.empty()) {
      const std::string words = limit_text(ray, 0);
      case_.first = words + " at " + acceleration(ray.limits.front().acceleration);
    }
    if (grown_.rest) return;
    const StaticLimit* const end = ray.limits.empty() || ray.limits.back().kind != LimitKind::ends ? nullptr : &ray.limits.back();
    case_.verdict = Verdict::open;
    if (end && ray.limits.size() == 1 && end->acceleration < k_least_pull * a) {
      case_.why = "no rest: the machine gives way to the least pull (" + end->text + "). Hold its vehicle by a drive";
    } else if (end && ray.is_explained) {
      case_.verdict = Verdict::reject;
      case_.why = limit_text(ray, ray.limits.size() - 1) + " at " + acceleration(end->acceleration) + ", " +
                  rounded_text(100.0 * end->acceleration / a, 3) + " % of this load";
    } else {
      case_.why = "no rest is found, and whether there is none is not known: " + grown_.failure;
    }
  }

  void add_other_paths() {
    const Vec2& pull = case_.load.pull;
    if (pull == Vec2::Zero()) return;
    if (const Probe turned = machine_.ramped(-pull); turned.rest) {
      returned_ = machine_.loaded_again(turned, pull);
      if (returned_.rest) ways_.push_back(&returned_);
      else
        note(Verdict::open, "there is a rest if the load grows from nothing, but none is found after the same load the other way round: " +
                                returned_.failure);
    } else {
      case_.remarks.push_back("the reversed load is not carried, so its effect on the rest was not computed");
    }
    loose_ = machine_.without_friction(pull);
    if (loose_.rest) ways_.push_back(&loose_);
    else case_.remarks.push_back("it needs friction between bodies to hold: without, " + loose_.failure);
  }

  void collect() {
    for (const std::string& joint : machine_.joints()) {
      StaticJoint one{joint, std::numeric_limits<double>::infinity()};
      for (const Probe* way : ways_) {
        const double margin = machine_.least(*way, joint + ".margin");
        if (!(margin >= one.margin)) one.margin = margin; // also true if margin is NaN
      }
      case_.joints.push_back(one);
    }
    for (std::size_t w = 0; w < machine_.watches().size(); ++w) {
      const Watch& watch = machine_.watches()[w];
      if (watch.kind == LimitKind::slides && grown_.left[w] < 0.0) case_.slid.push_back(watch.element);
      if (watch.kind != LimitKind::lifts) continue;
      StaticFoot foot{watch.element, false, machine_.value(grown_, watch.element + ".force"), 0.0};
      for (const Probe* way : ways_) {
        foot.lifts = foot.lifts || way->left[w] <= 0.0;
        foot.height = std::max(foot.height, machine_.largest(*way, watch.element + ".gap"));
      }
      case_.feet.push_back(foot);
    }
    collect_reactions();
    const State& rest = machine_.at_rest().rest->state;
    for (std::size_t i = 3; i < rest.q.size(); ++i)
      if (i % 3 < 2) case_.moved = std::max(case_.moved, std::abs(grown_.rest->state.q[i] - rest.q[i]));
    find_tipping();
  }

  // The findings of a run on a single state, and what the proof does not follow.
  void check_rest(const Probe& way) {
    for (const Finding& finding : contacts_beyond_edges(monitored_, way.rest->state)) note(Verdict::open, text_with_place(finding));
    for (const Finding& finding : contacts_too_deep(monitored_, as_run(machine_, way).ranges))
      note(Verdict::open, text_with_place(finding));
    if (!way.action.empty())
      note(Verdict::open,
           "the condition of action '" + way.action + "' is met on the way to this rest, and a static proof does not follow actions");
    for (std::size_t w = 0; w < machine_.watches().size(); ++w)
      if (machine_.watches()[w].kind == LimitKind::breaks && !(way.left[w] > k_close))
        note(Verdict::open, "'" + machine_.watches()[w].element + "' breaks, and the rest without it is not computed");
    for (const Criterion& criterion : machine_.model().criteria)
      for (std::size_t w = 0; w < machine_.watches().size(); ++w)
        if (const Watch& watch = machine_.watches()[w]; std::abs(way.left[w]) <= k_close && forbids(criterion, watch))
          note(Verdict::open, "whether '" + watch.element + "' " + name_of(watch.kind) + " is within rounding of its limit");
  }

  // A jump ends where the machine's inertia lets it, and forces that depend on the division of the path are not those of the machine.
  void check_path(const Probe& way) {
    const std::string advice = "Let the load grow slowly in a run";
    if (way.jump)
      note(Verdict::open, "'" + way.jump->element + "' slides by a jump at " + acceleration(way.jump->acceleration) +
                              ", and where that ends depends on inertia. " + advice);
    if (std::isinf(way.doubt)) note(Verdict::open, "one of two divisions of the load's path into increments comes to no rest. " + advice);
    else if (way.doubt > k_same_forces)
      note(Verdict::open, "forces differ by " + rounded_text(100.0 * way.doubt, 2) +
                              " % between two divisions of the load's path into increments. " + advice);
  }

  void collect_reactions() {
    const std::vector<Channel>& channels = machine_.system().channels;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (!is_reaction(channels[i])) continue;
      StaticReaction reaction{channels[i].name, 0.0, channels[i].unit, {}};
      for (const Probe* way : ways_)
        for (const double value : {way->values[i], way->low[i], way->high[i]})
          if (!(std::abs(value) <= std::abs(reaction.value))) reaction.value = value;
      for (const Criterion& c : machine_.model().criteria) {
        if (!matches_pattern(reaction.name, c.channel)) continue;
        const std::optional<double> bound = c.within ? c.within : c.at_most;
        if (bound && (!reaction.allowed || *bound < *reaction.allowed)) reaction.allowed = bound;
      }
      case_.reactions.push_back(reaction);
    }
  }

  // Determines which parts tip under gravity plus pull.
  void find_tipping() {
    if (!(case_.apparent.norm() > 0.0)) return;
    Model model = loaded_.model;
    model.header.gravity = case_.apparent;
    std::shared_ptr<const System> system = compile(model);
    LoadedModel turned = loaded_;
    turned.model = std::move(model);
    turned.system = std::move(system);
    case_.tipping = tipping_of(turned, grown_.rest->state);
  }

  void decide() {
    for (std::size_t w = 0; w < ways_.size(); ++w) {
      const std::vector<CriterionResult> criteria = judged(machine_, *ways_[w]);
      if (w == 0) case_.criteria = criteria;
      for (std::size_t i = 0; i < criteria.size(); ++i) {
        const Verdict outcome = proof_of(criteria[i].outcome);
        const bool agrees = w == 0 || proof_of(case_.criteria[i].outcome) == outcome;
        if (agrees) note(outcome, criterion_text(criteria[i], "not met"));
        else note(Verdict::open, criterion_text(criteria[i], "not met after some ways to the load") + "; friction allows several rests");
        if (w > 0 && weight(outcome) > weight(proof_of(case_.criteria[i].outcome))) case_.criteria[i] = criteria[i];
      }
      if (ways_[w] != &loose_ && !ways_[w]->rest->indifferent.empty())
        note(Verdict::open,
             "nothing holds " + part_text(machine_.system(), ways_[w]->rest->indifferent.front()) + ": it rests wherever it is");
      check_rest(*ways_[w]);
      for (std::string& remark : remarks_on(machine_.system(), *ways_[w]->rest))
        if (std::find(case_.remarks.begin(), case_.remarks.end(), remark) == case_.remarks.end())
          case_.remarks.push_back(std::move(remark));
    }
    check_path(grown_);
    check_path(returned_);
    check_path(loose_);
    for (const StaticJoint& joint : case_.joints)
      if (!(std::abs(joint.margin - 1.0) > k_close)) note(Verdict::open, "the margin of '" + joint.name + "' is 1 within rounding");
    for (const FrictionMargin& margin : grown_.rest->margins)
      if (margin.is_shared && margin.used > 0.0) {
        const int element = machine_.system().frictions[static_cast<std::size_t>(margin.friction)].element;
        case_.remarks.push_back("'" + machine_.system().element_names[static_cast<std::size_t>(element)] +
                                "' and others can share their load in several ways");
      }
  }

  StaticMachine& machine_;
  const LoadedModel &loaded_, &monitored_;
  Probe grown_, returned_, loose_;
  std::vector<const Probe*> ways_;
  StaticCase case_;
};

// Returns true if the machine also has an equilibrium, with all limits kept, when the load grows from the opposite pull −`pull` instead of
// from zero.
bool has_equilibrium_from_opposite(StaticMachine& machine, const Vec2& pull) {
  const auto is_intact = [](const Probe& probe) {
    return probe.rest && std::all_of(probe.left.begin(), probe.left.end(), [](double left) { return left > 0.0; });
  };
  const Probe turned = machine.ramped(-pull);
  if (!is_intact(turned)) return true; // the opposite pull would exceed a limit itself, so there is no second path to compare
  return is_intact(machine.loaded_again(turned, pull));
}

StaticDirection limits_along(StaticMachine& machine, double angle, double largest) {
  const auto without_rounding = [](double x) { return std::abs(x) < 1e-15 ? 0.0 : x; };
  const Vec2 direction(without_rounding(portable::cos(angle)), without_rounding(portable::sin(angle)));
  StaticDirection found{angle, grow_pull(machine, direction, largest), true};
  if (!found.ray.limits.empty() && found.ray.limits.front().acceleration > 0.0)
    found.is_unique = has_equilibrium_from_opposite(machine, (1.0 - k_just_below) * found.ray.limits.front().acceleration * direction);
  return found;
}

std::vector<std::string> assumptions_of(Plane plane) {
  return {std::string("x of the model points ") + (plane == Plane::lengthwise ? "forward" : "to one side of the vehicle") + ", y up",
          "the vehicle is held by the drives of the model, signals have their values at t = 0, and its acceleration is constant; the swing "
          "with which a sudden one begins is "
          "not part of it",
          "friction, pressures and stiffnesses are those of the model: their scatter is not part of the margins",
          "the bodies of the model are rigid: what bends in them, and the other plane, is not known to it"};
}

// Returns why no case of this model can be proven: findings that cap the verdict of a run, and actions that a rest does not meet.
std::vector<std::string> caps_of(const LoadedModel& loaded) {
  std::vector<std::string> caps;
  for (const Finding& finding : findings_before(loaded))
    if (caps_verdict(finding)) caps.push_back(text_with_place(finding));
  const ActionGroup* const group = action_group(*loaded.system);
  if (!group) return caps;
  for (const ActionGroup::ElementData& entry : group->entries)
    if (entry.is_armed && !entry.trigger.formula)
      caps.push_back("action '" + entry.name + "' acts " + (entry.trigger.time ? "at a time" : "at an event") +
                     ", and a static proof does not follow actions: take it out of the model of the proof");
  return caps;
}

void conclude(StaticProof& proof, const StaticMachine& machine) {
  proof.verdict = Verdict::hold;
  for (const StaticCase& one : proof.cases) {
    if (weight(one.verdict) <= weight(proof.verdict)) continue;
    proof.verdict = one.verdict;
    proof.reason = one.load.name + ": " + one.why;
  }
  if (proof.verdict != Verdict::hold) return;
  if (!proof.caps.empty()) {
    proof.verdict = Verdict::open;
    proof.reason = "at rest under every load, but the proof cannot mean \"hold\": " + proof.caps.front();
    return;
  }
  proof.reason = "at rest under every load, with all criteria met that a rest can answer";
  const bool is_asked = !machine.watches().empty() ||
                        std::any_of(proof.cases.begin(), proof.cases.end(), [](const StaticCase& one) { return !one.criteria.empty(); });
  if (is_asked) return;
  proof.verdict = Verdict::open;
  proof.reason = "at rest under every load, but nothing was asked: the model has no joint, contact or friction that could give way, and no "
                 "criterion on a force or a place";
}

} // namespace

std::string limit_text(const StaticRay& ray, std::size_t limit) {
  const StaticLimit& one = ray.limits[limit];
  if (one.kind != LimitKind::ends) return one.text;
  std::string lifting, sliding, slipping;
  for (const StaticLimit& other : ray.limits) {
    if (!(other.acceleration >= one.acceleration - 4.0 * (one.error + other.error))) continue;
    if (other.kind == LimitKind::lifts) lifting = other.element;
    if (other.kind == LimitKind::slides) sliding = other.element;
    if (other.kind == LimitKind::slips) slipping = other.element;
  }
  if (!slipping.empty()) return "'" + slipping + "' slips, and nothing else holds";
  if (!sliding.empty()) return "'" + sliding + "' slides away";
  if (!lifting.empty()) return "the machine tips over as '" + lifting + "' lifts";
  constexpr std::string_view none = "no static equilibrium: ";
  return "the machine leaves its rest (" + (one.text.starts_with(none) ? one.text.substr(none.size()) : one.text) + ")";
}

StaticProof prove_statically(const LoadedModel& loaded, const StaticPreset& preset, const StaticProofOptions& options) {
  const StopScope stopping(options.stop);
  StaticMachine machine(loaded);
  StaticProof proof;
  proof.model = loaded.name;
  proof.file = loaded.path;
  proof.drawing = drawing_json(loaded.model, *loaded.views);
  proof.overrides = loaded.overrides;
  proof.assumptions = assumptions_of(options.plane);
  proof.plane = options.plane;
  proof.preset = preset;
  proof.gravity = machine.gravity();
  proof.largest = options.largest;
  const auto ask_whether_to_stop = [&options] {
    if (!options.stop) return;
    if (const std::string why = options.stop(); !why.empty()) throw RunStopped(why);
  };
  LoadedModel monitored = loaded;
  monitored.model = machine.model();
  monitored.system = std::shared_ptr<const System>(std::shared_ptr<void>(), &machine.system()); // owned by `machine`
  for (const StaticLoad& load : loads_for(preset, options.plane)) {
    ask_whether_to_stop();
    proof.cases.push_back(CaseProof(machine, loaded, monitored, load).run());
  }
  for (int i = 0; i < options.directions; ++i) {
    ask_whether_to_stop();
    proof.polar.push_back(limits_along(machine, 2.0 * std::numbers::pi * i / options.directions, options.largest));
  }
  const RunResult rest = as_run(machine, machine.at_rest());
  for (const Criterion& criterion : machine.model().criteria) {
    const auto [asked, seen] = asked_and_seen(criterion);
    if (criterion.channel.empty() ? asked != seen : !is_of_rest(judge_criterion(criterion, rest).unit))
      proof.unasked.push_back(criterion.name);
  }
  proof.caps = caps_of(loaded);
  conclude(proof, machine);
  return proof;
}

} // namespace steplap::assess
