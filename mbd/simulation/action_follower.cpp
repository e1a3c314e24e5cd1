#include "mbd/simulation/action_follower.h"

#include "mbd/base/shown_text.h"
#include "mbd/system/element_failure.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Times that differ by less than this, relative to the time or to the scene's characteristic time, are equal.
constexpr double k_same_instant = 1e-13;
// Executions of one action at one time, if events between its executions trigger it repeatedly.
constexpr std::ptrdiff_t k_most_at_once = 20;

RunStatistics sum_of(const RunStatistics& a, const RunStatistics& b) {
  RunStatistics sum = b; // dissipated energy and work of `b` already contain those of earlier legs
  sum.steps += a.steps;
  sum.rejections += a.rejections;
  sum.evaluations += a.evaluations;
  sum.events += a.events;
  sum.coded_stages += a.coded_stages;
  sum.storms += a.storms;
  sum.max_position_residual = std::max(a.max_position_residual, b.max_position_residual);
  sum.max_velocity_residual = std::max(a.max_velocity_residual, b.max_velocity_residual);
  sum.energy_residual = a.energy_residual + b.energy_residual; // the residual of a leg is counted from its own start
  sum.energy_exchanged = std::max(a.energy_exchanged, b.energy_exchanged);
  sum.energy_scale = std::max(a.energy_scale, b.energy_scale);
  sum.energy_worst_step = std::max(a.energy_worst_step, b.energy_worst_step);
  sum.energy_rounding = std::max(a.energy_rounding, b.energy_rounding);
  if (a.passed_pulse) sum.passed_pulse = a.passed_pulse;
  if (a.undecided_condition) sum.undecided_condition = a.undecided_condition;
  if (a.divided_steps.shortest < b.divided_steps.shortest) sum.divided_steps = a.divided_steps;
  sum.rounded_tolerance = std::max(a.rounded_tolerance, b.rounded_tolerance);
  sum.divided_steps.count = a.divided_steps.count + b.divided_steps.count;
  return sum;
}

ChannelRange joined(const ChannelRange& a, const ChannelRange& b) {
  ChannelRange both = b;
  both.channel = a.channel;
  both.first = a.first;
  if (std::isnan(b.low.value) || a.low.value <= b.low.value) {
    both.low = a.low;
    both.is_low_singular = a.is_low_singular;
    both.unsure_low = a.unsure_low;
  }
  if (std::isnan(b.high.value) || a.high.value >= b.high.value) {
    both.high = a.high;
    both.is_high_singular = a.is_high_singular;
    both.unsure_high = a.unsure_high;
  }
  both.resolution = std::max(a.resolution, b.resolution);
  both.had_no_value = a.had_no_value || b.had_no_value;
  if (a.first_above_one) both.first_above_one = a.first_above_one;
  return both;
}

// Returns the index of the element to which `element` belongs, for example the joint of an interface; −1 if there is none.
int whole_of(const Model& model, std::size_t element) {
  const ElementEntry& part = model.elements[element];
  for (const Field& field : part.kind->fields.fields()) {
    if (field.type != FieldType::element) continue;
    const auto name = std::get<std::string>(field.get(part.element.get()));
    for (std::size_t i = 0; i < model.elements.size(); ++i)
      if (model.elements[i].element->name == name) return static_cast<int>(i);
  }
  return -1;
}

void refuse_other_channels(const System& first, const System& system) {
  const std::size_t own = system.channels.size();
  std::size_t i = 0;
  while (i < own && i < first.channels.size() && system.channels[i].name == first.channels[i].name) ++i;
  if (i == own && own <= first.channels.size() && system.integrands.size() == first.integrands.size()) return;
  const std::string name = i < own ? system.channels[i].name : first.channels[std::min(i, first.channels.size() - 1)].name;
  throw ModelError({}, "it has other channels than at the start ('" + name +
                           "'): give the element a value of the field that is set from the start, which the action then changes");
}

// Adds to `system` the channels that were added to the first system after compilation, in the same order. Channels of inactive elements are
// zero.
void add_channels(const ActionGroup& group, const System& first, System& system) {
  const std::size_t own = system.channels.size();
  const auto is_same = [](const Channel& a, const Channel& b) { return a.name == b.name; };
  for (const auto& addition : group.additions) addition(system);
  const std::vector<Channel> added(system.channels.begin() + static_cast<std::ptrdiff_t>(own), system.channels.end());
  while (system.channels.size() > own) system.channels.pop_back();
  for (std::size_t i = own; i < first.channels.size(); ++i) {
    const auto found =
        std::find_if(added.begin(), added.end(), [&](const Channel& channel) { return is_same(channel, first.channels[i]); });
    Channel channel = found == added.end() ? first.channels[i] : *found;
    if (found == added.end()) channel.value = [](const Snapshot&) { return 0.0; };
    system.channels.push_back(std::move(channel));
  }
}

} // namespace

ActionFollower::ActionFollower(const System& system) : first_(system), group_(*action_group(system)), triggers_(group_) {
  for (const ElementEntry& entry : group_.model->elements) now_.acts.push_back(entry.element->active ? 1 : 0);
  Arranged& first = arranged_[now_];
  first.system = &first_;
  first.acts = acting_elements(*group_.model);
}

// All actions due at one time are executed in the order of the file, then their changes take effect together. If a value is set twice, the
// last one counts.
void ActionFollower::act(std::unique_ptr<RunLeg>& leg) {
  const double t = leg->state().t;
  if (std::abs(t - instant_) > k_same_instant * std::max(first_.scale.time(), std::abs(t))) at_once_.clear();
  instant_ = t;
  first_now_ = at_once_.size();
  while (leg->is_interrupted() && !is_ended_) {
    const Arrangement before = now_;
    const std::size_t known = leg->record().events.size();
    for (std::size_t i = 0; i < group_.entries.size() && !is_ended_; ++i)
      if (triggers_.is_due[i] != 0) happen(i, *leg);
    if (!(now_ == before)) change_over(leg, before);
    if (!is_ended_) leg->interrupt_if_action_due(known);
  }
  if (is_ended_) leg->close(true);
  else leg->go_on();
}

void ActionFollower::happen(std::size_t action, RunLeg& leg) {
  const ActionGroup::ElementData& entry = group_.entries[action];
  guard_against_rings(action, leg);
  at_once_.push_back(action);
  triggers_.spend(action, entry.is_once);
  leg.record().events.push_back({leg.state().t, entry.name, EventKind::happens, entry.text});
  for (const ActionStep& step : entry.steps) {
    take_step(step);
    if (step.verb == ActionVerb::stop) ended_by_ = entry.name;
  }
}

void ActionFollower::take_step(const ActionStep& step) {
  const auto target = static_cast<std::size_t>(std::max(step.target, 0));
  switch (step.verb) {
  case ActionVerb::release: now_.acts[target] = 0; break;
  case ActionVerb::hold: now_.acts[target] = 1; break;
  case ActionVerb::set: now_.set[{step.target, step.field}] = &step; break;
  case ActionVerb::arm: triggers_.arm(target); break;
  case ActionVerb::disarm: triggers_.disarm(target); break;
  case ActionVerb::stop: is_ended_ = true; break;
  }
}

void ActionFollower::guard_against_rings(std::size_t action, const RunLeg& leg) const {
  const auto now = at_once_.begin() + static_cast<std::ptrdiff_t>(first_now_);
  auto from = std::find(now, at_once_.end(), action);
  if (from == at_once_.end() && std::count(at_once_.begin(), at_once_.end(), action) >= k_most_at_once)
    from = std::prev(std::find(at_once_.rbegin(), at_once_.rend(), action).base());
  if (from == at_once_.end()) return;
  std::string ring;
  std::vector<std::string> names;
  for (; from != at_once_.end(); ++from) {
    names.push_back(group_.entries[*from].name);
    ring += "'" + names.back() + "', then ";
  }
  throw ElementFailure("at t = " + rounded_text(leg.state().t, 12) + " s actions set each other off without end: " + ring + "'" +
                           group_.entries[action].name +
                           "' again. Let one of them happen at another condition, so that there is a way between them",
                       names);
}

std::unique_ptr<System> ActionFollower::compiled(const Arrangement& arrangement, std::vector<char>& acts) const {
  Model model = *group_.model;
  for (std::size_t i = 0; i < arrangement.acts.size(); ++i) model.elements[i].element->active = arrangement.acts[i] != 0;
  for (const auto& [target, step] : arrangement.set) {
    const ElementEntry& entry = model.elements[static_cast<std::size_t>(target.first)];
    entry.kind->fields.find(target.second)->set(entry.element.get(), step->value);
  }
  acts = acting_elements(model);
  auto system = compile(model, group_.channels ? &*group_.channels : nullptr);
  refuse_other_channels(first_, *system);
  add_channels(group_, first_, *system);
  return system;
}

const ActionFollower::Arranged& ActionFollower::arranged(const Arrangement& arrangement) {
  const auto [found, is_new] = arranged_.try_emplace(arrangement);
  Arranged& made = found->second;
  if (!is_new && made.system) return made;
  made.made = compiled(arrangement, made.acts);
  made.system = made.made.get();
  return made;
}

Changeover ActionFollower::changeover(const Arrangement& before, const Arrangement& after) {
  const Arranged &from = arranged(before), &to = arranged(after);
  Changeover change{*from.system, *to.system, from.acts, to.acts, std::vector<char>(to.acts.size(), 0)};
  for (std::size_t i = 0; i < to.acts.size(); ++i) change.begins[i] = static_cast<char>(to.acts[i] != 0 && from.acts[i] == 0);
  for (const auto& [target, step] : after.set) {
    const auto known = before.set.find(target);
    const auto element = static_cast<std::size_t>(target.first);
    if ((known != before.set.end() && known->second == step) || to.acts[element] == 0) continue;
    change.begins[element] = 1;
    if (const int whole = whole_of(*group_.model, element); whole >= 0) change.begins[static_cast<std::size_t>(whole)] = 1;
  }
  return change;
}

void ActionFollower::change_over(std::unique_ptr<RunLeg>& leg, const Arrangement& before) {
  try {
    const Changeover change = changeover(before, now_);
    leg->close(false);
    auto next = std::make_unique<RunLeg>(*leg, change);
    statistics_.push_back(leg->statistics());
    ranges_.push_back(leg->take_ranges());
    for (FaceTravel& travel : leg->face_travels()) face_travels_.push_back(std::move(travel));
    leg = std::move(next);
  } catch (const ModelError& error) { // the changed elements are inconsistent
    throw NumericalFailure("at t = " + rounded_text(leg->state().t, 12) + " s action '" + group_.entries[at_once_.back()].name +
                           "' makes a machine that cannot be: " + error.diagnostics().front().message);
  }
}

std::shared_ptr<const System> ActionFollower::made_system(const RunLeg& leg) const {
  for (const auto& [arrangement, each] : arranged_)
    if (each.system == &leg.system()) return each.made;
  return nullptr;
}

RunStatistics ActionFollower::add_statistics(const RunStatistics& last) const {
  RunStatistics sum = last;
  for (auto leg = statistics_.rbegin(); leg != statistics_.rend(); ++leg) sum = sum_of(*leg, sum);
  return sum;
}

std::vector<ChannelRange> ActionFollower::joined_ranges(std::vector<ChannelRange> last) const {
  for (auto leg = ranges_.rbegin(); leg != ranges_.rend(); ++leg)
    for (std::size_t c = 0; c < last.size(); ++c) last[c] = joined((*leg)[c], last[c]);
  return last;
}

State ActionFollower::in_first_system(const RunLeg& leg) const {
  if (&leg.system() == &first_) return leg.state();
  const Arranged *last = nullptr, *first = nullptr;
  for (const auto& [arrangement, each] : arranged_) {
    if (each.system == &leg.system()) last = &each;
    if (each.system == &first_) first = &each;
  }
  return carried({leg.system(), first_, last->acts, first->acts, std::vector<char>(first->acts.size(), 0)}, leg.state());
}

} // namespace steplap
