#include "mbd/system/requested_channels.h"

#include "mbd/base/limits.h"
#include "mbd/base/name_pattern.h"
#include "mbd/model/formula_fields.h"
#include "mbd/system/actions.h"
#include "mbd/system/formula_channel.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/one_way_lock.h"
#include "mbd/system/own_states.h"

#include <algorithm>
#include <memory>
#include <set>

namespace steplap {

namespace {

constexpr const char* k_whole = "whole";

// Power that one element dissipates, and power that it supplies, W.
struct ElementPower {
  double dissipation = 0.0, work = 0.0;
};

ElementPower evaluate_element_power(const ForceGroup& share, const System& system, const Snapshot& s) {
  struct Scratch {
    std::vector<BodyForce> force;
    std::vector<double> contact_force, event_value, event_derivative, inner_rate;
  };
  thread_local Scratch scratch;
  scratch.force.resize(std::max<std::size_t>(scratch.force.size(), static_cast<std::size_t>(system.links.slot_count())));
  scratch.contact_force.resize(std::max(scratch.contact_force.size(), static_cast<std::size_t>(system.contact_count)));
  scratch.event_value.resize(std::max(scratch.event_value.size(), static_cast<std::size_t>(system.event_count)));
  scratch.event_derivative.resize(scratch.event_value.size());
  scratch.inner_rate.resize(std::max(scratch.inner_rate.size(), static_cast<std::size_t>(system.inner_count())));
  Evaluation e = *s.evaluation;
  e.force = e.link_force = scratch.force.data();
  e.contact_force = scratch.contact_force.data();
  e.event_value = scratch.event_value.data();
  e.event_derivative = scratch.event_derivative.data();
  e.inner_rate = scratch.inner_rate.data();
  e.dissipation = e.work = 0.0;
  share.add_forces(e);
  return {e.dissipation, e.work};
}

double power_of_friction(const System& system, std::size_t f, const Snapshot& s) {
  const FrictionUnit& unit = system.frictions[f];
  const FrictionState& state = s.evaluation->friction[f];
  if (state.phase != FrictionPhase::slip) return 0.0;
  const RowSpec* const rows = unit.friction->rows(state);
  double power = 0.0;
  for (int r = 0; r < unit.friction->dimension(); ++r)
    power -= s.friction_force[unit.row + r] * evaluate_row<false>(rows[r], s.motion).rate;
  return power;
}

// Returns true for friction whose contact point moves along a face, so that its slide must be integrated.
bool has_slide(const FrictionUnit& unit) {
  const FrictionState any{};
  return unit.friction->dimension() == 1 && unit.friction->rows(any)->kind == MeasureKind::slide;
}

double slip_rate(const System& system, std::size_t f, const Snapshot& s) {
  const FrictionState& state = s.evaluation->friction[f];
  if (state.phase != FrictionPhase::slip) return 0.0;
  return evaluate_row<false>(*system.frictions[f].friction->rows(state), s.motion).rate;
}

// Names of the channels of single elements that this file makes.
constexpr const char* k_of_elements[] = {"dissipated", "stored", "work", "slide"};

bool wants_shares(const std::vector<std::string>* wanted) {
  return wanted && std::any_of(wanted->begin(), wanted->end(), [](const std::string& name) {
           return std::any_of(std::begin(k_of_elements), std::end(k_of_elements), [&](const char* each) { return name.ends_with(each); });
         });
}

// Returns true for groups that store, dissipate and supply no energy: states and actions.
bool has_no_energy(const ForceGroup& group) {
  return dynamic_cast<const OwnStateGroup*>(&group) != nullptr || dynamic_cast<const ActionGroup*>(&group) != nullptr;
}

std::string without_unit(const std::string& name) {
  if (name.empty() || name.back() != ']') return name;
  const std::size_t open = name.rfind('[');
  if (open == std::string::npos || open < 2 || name[open - 1] != ' ') return name;
  return name.substr(0, open - 1);
}

} // namespace

RequestedChannels::RequestedChannels(SystemBuilder& builder)
    : builder_(builder), model_(builder.model_), has_requests_(!model_.output.also.empty() || !model_.channels.empty()),
      wants_shares_(has_requests_ || wants_shares(builder.wanted_)) {
  for (const DefinedChannel& definition : model_.channels) {
    Defined& formula = formulas_.emplace_back();
    formula.definition = &definition;
    try {
      formula.expression.emplace(definition.expression, "channel '" + definition.name + "'", definition.place("expression"));
    } catch (const ModelError& error) {
      builder_.errors_.insert(builder_.errors_.end(), error.diagnostics().begin(), error.diagnostics().end());
      continue;
    }
    for (const std::string& name : formula.expression->names())
      for (const std::string& each : {name, without_unit(name)}) builder_.operand_names_.push_back(each);
  }
  note_operands_of_elements();
  auto& names = builder_.operand_names_;
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
}

// Requests the channels that formulas of elements read.
void RequestedChannels::note_operands_of_elements() {
  for (const ElementEntry& entry : model_.elements)
    for (const std::string& name : names_in_formulas(entry)) builder_.operand_names_.push_back(name);
}

const Channel* RequestedChannels::made_channel(const SystemBuilder& builder, const std::string& name) {
  for (const Channel& channel : builder.system_->channels)
    if (channel.name == name) return &channel;
  for (const auto& channel : builder.system_->operands)
    if (channel->name == name) return channel.get();
  return nullptr;
}

std::vector<std::string> RequestedChannels::measured_names(const SystemBuilder& builder) {
  std::vector<std::string> names;
  for (const Channel& channel : builder.system_->channels)
    if (measured_by(channel)) names.push_back(channel.name);
  return names;
}

void RequestedChannels::note(const Location& where, const std::string& message) { builder_.errors_.push_back({where, message}); }

Channel* RequestedChannels::make(bool is_on_request, std::string_view owner, std::string_view name, std::string_view unit,
                                 const ChannelText& text, std::function<double(const Snapshot&)> value) {
  const SystemBuilder::Use use = builder_.use_of(owner, name, is_on_request);
  if (use == SystemBuilder::Use::none) return nullptr;
  Channel& channel = builder_.enter_channel(use, owner, name, unit, text, std::move(value));
  channel.is_on_request = is_on_request;
  return &channel;
}

// --- energies of single elements -------------------------------------------------------------------

void RequestedChannels::begin_element() {
  if (!wants_shares_) return;
  const System& system = *builder_.system_;
  counts_.resize(system.groups.size());
  for (std::size_t g = 0; g < counts_.size(); ++g) counts_[g] = builder_.group_types_[g].count(*system.groups[g]);
  rows_ = system.rows.size();
  frictions_ = system.frictions.size();
}

void RequestedChannels::end_element() {
  if (!wants_shares_) return;
  const System& system = *builder_.system_;
  const std::string& name = system.element_names[builder_.element_];
  bool is_wanted = false;
  for (const char* each : k_of_elements) is_wanted |= builder_.use_of(name, each, true) != SystemBuilder::Use::none;
  if (!is_wanted) return;
  Share share;
  share.element = builder_.element_;
  for (std::size_t g = 0; g < system.groups.size(); ++g) {
    const std::size_t before = g < counts_.size() ? counts_[g] : 0, now = builder_.group_types_[g].count(*system.groups[g]);
    if (now == before || has_no_energy(*system.groups[g])) continue;
    share.groups.push_back(system.groups[g].get());
    share.first.push_back(before);
    share.count.push_back(now - before);
    share.does_work.push_back(builder_.group_types_[g].does_work);
  }
  share.first_row = rows_;
  share.row_end = system.rows.size();
  share.first_friction = frictions_;
  share.friction_end = system.frictions.size();
  shares_.push_back(std::move(share));
}

void RequestedChannels::end_inactive_element(System& acting) {
  if (!wants_shares_) return;
  const System& aside = *builder_.system_;
  Share share;
  share.element = builder_.element_;
  share.acts = false;
  bool is_wanted = false;
  for (const char* each : k_of_elements)
    is_wanted |= builder_.use_of(acting.element_names[builder_.element_], each, true) != SystemBuilder::Use::none;
  if (!is_wanted) return;
  for (std::size_t g = 0; g < aside.groups.size(); ++g) {
    const std::size_t before = g < counts_.size() ? counts_[g] : 0;
    if (builder_.group_types_[g].count(*aside.groups[g]) == before || has_no_energy(*aside.groups[g])) continue;
    (builder_.group_types_[g].does_work ? share.works : share.stores) = true;
  }
  share.dissipates = share.stores;
  for (std::size_t f = frictions_; f < aside.frictions.size(); ++f) share.dissipates |= !aside.frictions[f].friction->is_elastic();
  for (std::size_t r = rows_; r < aside.rows.size(); ++r) share.works |= aside.rows[r].drive != nullptr;
  shares_.push_back(std::move(share));
}

// Adds the energy channels of an inactive element. Their values stay what they were when the element became inactive.
void RequestedChannels::add_inactive_share(const Share& share) {
  const auto none = [](const Snapshot&) { return 0.0; };
  if (share.dissipates) add_integral(share, "dissipated", "J", "energy that it has turned into heat since the start", {none, {}});
  if (share.stores) make(true, builder_.system_->element_names[share.element], "stored", "J", "energy stored in it now", none);
  if (share.works)
    add_integral(share, "work", "J", {"work that it has done since the start", "positive: it has given energy to the bodies"}, {none, {}});
}

void RequestedChannels::add_integral(const Share& share, const char* name, const char* unit, const ChannelText& text, Integrand integrand) {
  System& system = *builder_.system_;
  const int slot = static_cast<int>(system.integrands.size());
  const Channel* const made = make(true, system.element_names[share.element], name, unit, text,
                                   [slot](const Snapshot& s) { return s.integrals ? s.integrals->value(slot, s.t) : 0.0; });
  if (made) system.integrands.push_back(std::move(integrand));
}

// Adds the slide of an element whose contact point changes (polygon_contact), as the integral of its slip rate. A coordinate would jump
// when the contact point changes. Elements with fixed contact points have a channel of this name already.
void RequestedChannels::add_slide(const Share& share) {
  const System* const self = builder_.system_.get();
  const std::string name = self->element_names[share.element] + ".slide";
  for (std::size_t f = share.first_friction; f < share.friction_end; ++f) {
    if (!has_slide(self->frictions[f]) || find(name)) continue;
    add_integral(share, "slide", "m", {"way that a has slid along the touching face since the start", "as friction"},
                 {[self, f](const Snapshot& s) { return slip_rate(*self, f, s); }, {}});
  }
}

void RequestedChannels::add_share(const Share& share) {
  System& system = *builder_.system_;
  const System* const self = &system;
  std::vector<const ForceGroup*> givers, workers, inner;
  for (std::size_t i = 0; i < share.groups.size(); ++i) {
    std::size_t g = 0;
    while (system.groups[g].get() != share.groups[i]) ++g;
    system.shares.push_back(builder_.group_types_[g].share(*share.groups[i], share.first[i], share.count[i]));
    const ForceGroup* const alone = system.shares.back().get();
    (share.does_work[i] ? workers : givers).push_back(alone);
    if (std::find(system.inner_groups.begin(), system.inner_groups.end(), share.groups[i]) != system.inner_groups.end())
      inner.push_back(alone);
  }
  std::vector<std::size_t> frictions, driven;
  for (std::size_t f = share.first_friction; f < share.friction_end; ++f)
    if (!system.frictions[f].friction->is_elastic()) frictions.push_back(f);
  for (std::size_t r = share.first_row; r < share.row_end; ++r)
    if (system.rows[r].drive) driven.push_back(r);

  std::vector<int> impacts;
  for (const std::size_t f : frictions)
    if (const int index = impact_index(system.frictions[f]); index >= 0) impacts.push_back(index);

  const auto stored = [givers, inner](const Snapshot& s) {
    double sum = 0.0;
    for (const ForceGroup* group : givers) sum += group->potential(s.motion);
    for (const ForceGroup* group : inner) sum += group->inner_energy(s.motion, s.evaluation->inner);
    return sum;
  };
  if (!givers.empty() || !frictions.empty()) {
    Integrand integrand;
    integrand.power = [self, givers, frictions](const Snapshot& s) {
      double power = 0.0;
      for (const ForceGroup* group : givers) power += evaluate_element_power(*group, *self, s).dissipation;
      for (const std::size_t f : frictions) power += power_of_friction(*self, f, s);
      return power;
    };
    if (!inner.empty()) integrand.stored = stored;
    if (!impacts.empty())
      integrand.stored = [impacts](const Snapshot& s) {
        double lost = 0.0;
        for (const int index : impacts) lost += s.impacts[index].lost;
        return -lost;
      };
    add_integral(share, "dissipated", "J", "energy that it has turned into heat since the start", std::move(integrand));
  }
  if (!givers.empty()) make(true, system.element_names[share.element], "stored", "J", "energy stored in it now", stored);
  if (!workers.empty() || !driven.empty()) {
    Integrand integrand;
    integrand.power = [self, workers, driven](const Snapshot& s) {
      double power = 0.0;
      for (const ForceGroup* group : workers) power += evaluate_element_power(*group, *self, s).work;
      for (const std::size_t r : driven) power += s.row_force[r] * evaluate_row<false>(self->rows[r], s.motion).rate;
      return power;
    };
    add_integral(share, "work", "J", {"work that it has done since the start", "positive: it has given energy to the bodies"},
                 std::move(integrand));
  }
}

// --- markers and the whole system -----------------------------------------------------------------

void RequestedChannels::add_markers() {
  struct Part {
    const char* name;
    const char* unit;
    const char* meaning;
    int level, axis;
  };
  static constexpr Part k_parts[] = {{"x", "m", "place of the marker", 0, 0},
                                     {"y", "m", "place of the marker", 0, 1},
                                     {"vx", "m/s", "velocity of the marker", 1, 0},
                                     {"vy", "m/s", "velocity of the marker", 1, 1},
                                     {"ax", "m/s^2", "acceleration of the marker, from the equations of motion", 2, 0},
                                     {"ay", "m/s^2", "acceleration of the marker, from the equations of motion", 2, 1}};
  for (const Marker& marker : model_.markers) {
    if (builder_.body_index_.contains(marker.name)) continue; // the channels of the body itself already show it
    const CompiledMarker& compiled = builder_.marker_index_.at(marker.name);
    for (const Part& part : k_parts)
      make(true, marker.name, part.name, part.unit,
           {part.meaning, part.axis == 0 ? "along x of the ground axes" : "along y of the ground axes"},
           [body = compiled.body, point = compiled.point, level = part.level, axis = part.axis](const Snapshot& s) {
             const Motion<double>& m = s.motion[body];
             const Pair<double> r = to_ground(m, point);
             if (level == 0) return axis == 0 ? m.x + r.x : m.y + r.y;
             if (level == 1) return axis == 0 ? m.vx - m.omega * r.y : m.vy + m.omega * r.x;
             if (body == k_ground) return 0.0;
             const double* const a = s.acceleration + 3 * static_cast<std::ptrdiff_t>(body);
             return axis == 0 ? a[0] - a[2] * r.y - m.omega * m.omega * r.x : a[1] + a[2] * r.x - m.omega * m.omega * r.y;
           });
  }
}

void RequestedChannels::add_whole() {
  const System* const self = builder_.system_.get();
  const auto kinetic = [self](const Snapshot& s) {
    double sum = 0.0;
    for (int i = 1; i < self->body_count(); ++i) {
      const Motion<double>& m = s.motion[i];
      sum += 0.5 * self->bodies[i].mass * (m.vx * m.vx + m.vy * m.vy) + 0.5 * self->bodies[i].inertia * m.omega * m.omega;
    }
    return sum;
  };
  const auto potential = [self](const Snapshot& s) {
    double sum = self->potential_energy(s.motion);
    for (const ForceGroup* group : self->inner_groups) sum += group->inner_energy(s.motion, s.evaluation->inner);
    return sum;
  };
  make(true, k_whole, "kinetic", "J", "kinetic energy of all bodies", kinetic);
  make(true, k_whole, "potential", "J", {"energy of weight and of what elements have stored", "zero of weight at the origin of the ground"},
       potential);
  make(true, k_whole, "dissipated", "J", "energy turned into heat since the start, by friction and dampers",
       [](const Snapshot& s) { return s.dissipated; });
  make(true, k_whole, "work", "J", {"work of loads, motors and drives since the start", "positive: given to the machine"},
       [](const Snapshot& s) { return s.work; });
  make(true, k_whole, "balance", "J", "kinetic + potential + dissipated - work: what changes of it is error of the computation",
       [kinetic, potential](const Snapshot& s) { return kinetic(s) + potential(s) + s.dissipated - s.work; });
}

// --- formulas -------------------------------------------------------------------------------------

const Channel* RequestedChannels::find(const std::string& name) const { return made_channel(builder_, name); }

// Returns the channel that formula `d` calls `name`. A name with its unit, as in the header of trajectory.csv, is accepted if the unit is
// right. Throws ModelError if there is no such channel.
const Channel& RequestedChannels::operand(const DefinedChannel& d, const std::string& name) const {
  if (const Channel* exactly = find(name)) return *exactly;
  const std::string subject = "channel '" + d.name + "'", bare = without_unit(name);
  const Channel* const found = bare == name ? nullptr : find(bare);
  if (!found)
    throw ModelError(d.place("expression"), subject + ": there is no channel '" + name + "'" + did_you_mean(name, all_names()) +
                                                "; names with other characters than letters, digits, _ and points need braces");
  const std::string unit = name.substr(bare.size() + 2, name.size() - bare.size() - 3);
  if (found->unit != unit)
    throw ModelError(d.place("expression"), subject + ": '" + found->name + "' is in '" + found->unit + "', not in '" + unit + "'");
  return *found;
}

// Returns the unit of a formula channel, and the factor from SI to this unit. Throws ModelError if the unit given in the model does not fit
// the formula.
std::pair<std::string, double> RequestedChannels::unit_of(const DefinedChannel& d, const UnitDimension& derived) {
  const std::string subject = "channel '" + d.name + "'";
  if (d.unit.empty()) {
    if (derived.powers == std::array<double, 3>{1.0, 2.0, -2.0})
      throw ModelError(d.place("expression"), subject + ": energy or torque? Say so with unit = \"J\" or \"N m\"");
    return {unit_text(derived.powers), 1.0};
  }
  const auto given = dimension_of(d.unit);
  if (!given) throw ModelError(d.place("unit"), subject + ": the unit '" + d.unit + "' is not known to formulas");
  if (given->powers != derived.powers) {
    const std::string is = unit_text(derived.powers);
    throw ModelError(d.place("unit"), subject + ": the expression has " + (is.empty() ? "no unit" : "the unit " + is) +
                                          ", which is none of '" + d.unit + "'");
  }
  return {d.unit == "1" ? std::string() : d.unit, 1.0 / given->factor};
}

void RequestedChannels::refuse_as_too_large(const DefinedChannel& d, const std::string& what) {
  is_beyond_limits_ = true;
  throw ModelError(d.place("expression"), "channel '" + d.name + "': " + what + ": name fewer, or define them by elements' channels");
}

// Adds the channel of a formula, after those of the formulas that it uses. `depth`: number of formulas that lead to this one.
void RequestedChannels::add_formula(Defined& formula, int depth) {
  const DefinedChannel& d = *formula.definition;
  if (formula.mark == Defined::Mark::done) return;
  if (formula.mark == Defined::Mark::open)
    throw ModelError(d.place("expression"), "channel '" + d.name + "': its expression leads back to itself");
  if (depth > k_longest_channel_chain)
    refuse_as_too_large(d, "more than " + std::to_string(k_longest_channel_chain) + " formulas of channels name each other in a row");
  formula.mark = Defined::Mark::open;
  if (!formula.expression) return;
  for (const std::string& name : formula.expression->names())
    for (const std::string& each : {name, without_unit(name)})
      for (Defined& other : formulas_)
        if (other.definition->name == each) add_formula(other, depth + 1);
  std::vector<std::string> units;
  std::vector<const Channel*> operands; // pointers are valid as long as no channel is added
  for (const std::string& name : formula.expression->names()) {
    operands.push_back(&operand(d, name));
    units.push_back(operands.back()->unit);
  }
  const auto [unit, factor] = unit_of(d, formula.expression->dimension(units));
  formula.mark = Defined::Mark::done;
  const auto value = std::make_shared<const FormulaChannel>(formula.expression->tree(), operands, factor);
  operations_ += value->tree().size();
  if (operations_ > k_most_channel_operations)
    refuse_as_too_large(d, "the formulas of channels, each with those that it names, have more than " +
                               std::to_string(k_most_channel_operations) + " operations");
  const auto* const wanted = builder_.wanted_;
  const bool is_listed = !wanted || std::find(wanted->begin(), wanted->end(), d.name) != wanted->end();
  if (!is_listed && !std::binary_search(builder_.operand_names_.begin(), builder_.operand_names_.end(), d.name)) return;
  const std::string meaning = d.meaning.empty() ? "= " + d.expression : d.meaning;
  Channel& channel = builder_.enter_channel(is_listed ? SystemBuilder::Use::channel : SystemBuilder::Use::operand, "", d.name, unit,
                                            ChannelText(meaning, d.sign), FormulaValue{value});
  channel.is_on_request = true;
}

void RequestedChannels::add_formulas() {
  for (Defined& formula : formulas_) {
    try {
      add_formula(formula);
    } catch (const ModelError& error) {
      formula.mark = Defined::Mark::done;
      builder_.errors_.insert(builder_.errors_.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
    if (is_beyond_limits_) return; // one error is enough
  }
}

// --- names that match nothing ---------------------------------------------------------------------

std::unique_ptr<System> compile_with_all_channels(Model model) {
  model.output.also = {"*"};
  return compile(model);
}

// Returns the names of all channels that could be requested.
std::vector<std::string> RequestedChannels::all_names() const {
  std::vector<std::string> names;
  for (const DefinedChannel& d : model_.channels) names.push_back(d.name);
  Model everything = model_;
  everything.channels.clear();
  try {
    const std::unique_ptr<System> system = compile_with_all_channels(std::move(everything));
    for (const Channel& channel : system->channels) names.push_back(channel.name);
  } catch (const ModelError&) { // reported when the model itself is compiled
  }
  return names;
}

void RequestedChannels::check_names() {
  std::set<std::string> names;
  for (const Channel& channel : builder_.system_->channels)
    if (!names.insert(channel.name).second) {
      const DefinedChannel* definition = nullptr;
      for (const DefinedChannel& d : model_.channels)
        if (d.name == channel.name) definition = &d;
      note(definition ? definition->place("name") : model_.output.where,
           "two channels are called '" + channel.name + "'" +
               (definition ? ": choose another name" : ": rename the marker, the body or the element, or ask for one of them only"));
    }
}

void RequestedChannels::check_patterns() {
  for (const std::string& pattern : model_.output.also) {
    const auto& channels = builder_.system_->channels;
    if (std::any_of(channels.begin(), channels.end(), [&](const Channel& c) { return matches_pattern(c.name, pattern); })) continue;
    note(model_.output.where, "'also' of [output]: no channel matches '" + pattern + "'" + did_you_mean(pattern, all_names()) +
                                  "; `steplap channels MODEL` lists those on request");
  }
}

// Returns true if a requested channel does not exist after elements and bodies are compiled.
bool RequestedChannels::is_anything_missing() const {
  return builder_.wanted_ &&
         std::any_of(builder_.wanted_->begin(), builder_.wanted_->end(), [this](const std::string& name) { return !find(name); });
}

void RequestedChannels::add() {
  if (!has_requests_ && !is_anything_missing()) return;
  add_markers();
  for (const Share& share : shares_) {
    share.acts ? add_share(share) : add_inactive_share(share);
    if (share.acts) add_slide(share);
  }
  add_whole();
  if (!builder_.errors_.empty()) return; // after errors, elements may be without their channels
  add_formulas();
  check_names();
  if (!builder_.wanted_) check_patterns();
}

} // namespace steplap
