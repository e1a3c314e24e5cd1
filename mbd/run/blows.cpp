#include "mbd/run/blows.h"

#include "mbd/base/name_pattern.h"
#include "mbd/formula/formula.h"
#include "mbd/model/action.h"
#include "mbd/run/acting_signals.h"
#include "mbd/run/quantity_text.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <vector>

namespace steplap {

namespace {

// Returns "rope" for "rope.tension".
std::string owner_of(const std::string& channel) { return channel.substr(0, std::min(channel.rfind('.'), channel.size())); }

// Returns all impacts of a run. Those caused by an action are assigned to the elements that the action activated.
std::vector<RigidImpact> blows_of(const Model& model, const RunResult& result) {
  std::vector<RigidImpact> blows;
  for (const RigidImpact& blow : result.blows) {
    const Action* const action = find_action(model, blow.element);
    if (!action) blows.push_back(blow);
    for (const std::string& text : action ? action->steps : std::vector<std::string>{})
      if (const ActionStepText step = action_step(text); step.verb == ActionVerb::hold || step.verb == ActionVerb::set)
        blows.push_back({blow.t, step.name});
  }
  return blows;
}

// Set of all bodies and elements that took part in an impact or are connected to such bodies by constraints, with the time of their first
// impact.
class ImpactParticipants {
public:
  ImpactParticipants(const LoadedModel& loaded, const std::vector<RigidImpact>& blows) : model_(loaded.model), system_(*loaded.system) {
    parent_.resize(static_cast<std::size_t>(system_.body_count()));
    std::iota(parent_.begin(), parent_.end(), 0);
    for (int i = 1; i < system_.body_count(); ++i) place_[system_.bodies[i].name] = i;
    for (const Marker& marker : model_.markers)
      if (const auto body = place_.find(marker.body); body != place_.end()) place_.try_emplace(marker.name, int{body->second});
    for (const RowSpec& row : system_.rows) join(row.a, row.b);
    for (const RigidImpact& blow : blows)
      for (const int body : bodies_of(blow.element)) join(body, bodies_of(blow.element).front());
    for (const RigidImpact& blow : blows) {
      note(elements_, blow.element, blow.t);
      for (const int body : bodies_of(blow.element)) note(roots_, root(body), blow.t);
    }
    for (const RowSpec& row : system_.rows)
      for (const int body : {row.a, row.b})
        if (const auto struck = body == k_ground ? roots_.end() : roots_.find(root(body)); struck != roots_.end())
          note(elements_, system_.element_names[static_cast<std::size_t>(row.element)], struck->second);
  }

  /// Returns the time of the first impact that affected the channel. Returns nothing if there was none or the channel is neither a force
  /// nor an acceleration.
  [[nodiscard]] std::optional<double> first_blow(const std::string& channel, const std::string& unit) const {
    const std::string owner = owner_of(channel);
    if (unit == "N" || unit == "N m") {
      const auto element = elements_.find(owner);
      return element == elements_.end() ? std::nullopt : std::optional(element->second);
    }
    const auto body = place_.find(owner);
    if ((unit != "m/s^2" && unit != "rad/s^2") || body == place_.end()) return {};
    const auto struck = roots_.find(root(body->second));
    return struck == roots_.end() ? std::nullopt : std::optional(struck->second);
  }

private:
  template <class Key> static void note(std::unordered_map<Key, double>& first, const Key& key, double t) {
    const auto known = first.try_emplace(key, t).first;
    known->second = std::min(known->second, t);
  }

  [[nodiscard]] int root(int i) const {
    while (parent_[static_cast<std::size_t>(i)] != i) i = parent_[static_cast<std::size_t>(i)];
    return i;
  }
  void join(int a, int b) {
    if (a != k_ground && b != k_ground) parent_[static_cast<std::size_t>(root(a))] = root(b);
  }

  // Returns the moving bodies to which the element refers.
  [[nodiscard]] std::vector<int> bodies_of(const std::string& element) const {
    std::vector<int> bodies;
    const auto add = [&](const std::string& name) {
      if (const auto place = place_.find(name); place != place_.end()) bodies.push_back(place->second);
    };
    for (const ElementEntry& entry : model_.elements) {
      if (entry.element->name != element) continue;
      for (const Field& field : entry.kind->fields.fields()) {
        if (field.type == FieldType::marker || field.type == FieldType::body) add(std::get<std::string>(field.get(entry.element.get())));
        if (field.type != FieldType::texts || field.name != "over") continue;
        const auto over = std::get<std::vector<std::string>>(field.get(entry.element.get()));
        for (const std::string& marker : over) add(marker);
      }
    }
    return bodies;
  }

  const Model& model_;
  const System& system_;
  std::vector<int> parent_;                          ///< union-find forest: bodies of one tree are connected by constraints
  std::unordered_map<std::string, int> place_;       ///< body index, by name of body or marker
  std::unordered_map<int, double> roots_;            ///< time of the first impact, s, by root of the tree
  std::unordered_map<std::string, double> elements_; ///< time of the first impact, s, by element name
};

// Returns the time of the first impact that affected a channel or, for a formula, any channel in the formula.
std::optional<double> first_blow_of(const Channel& channel, const Model& model, const System& system, const ImpactParticipants& struck) {
  if (const auto t = struck.first_blow(channel.name, channel.unit)) return t;
  for (const DefinedChannel& defined : model.channels) {
    if (defined.name != channel.name) continue;
    const Formula formula(defined.expression, "", {});
    for (const std::string& name : formula.names())
      for (const Channel& part : system.channels)
        if (part.name == name && part.name != channel.name)
          if (const auto t = first_blow_of(part, model, system, struck)) return t;
  }
  return {};
}

} // namespace

void leave_impacts_open(Judgement& judgement, const LoadedModel& loaded, const RunResult& result) {
  const Model& model = loaded.model;
  const std::vector<RigidImpact> blows = judgement.criteria.empty() ? std::vector<RigidImpact>{} : blows_of(model, result);
  if (blows.empty()) return;
  const ImpactParticipants struck(loaded, blows);
  const std::size_t of_elements = judgement.criteria.size() - std::min(judgement.criteria.size(), model.criteria.size());
  for (std::size_t i = of_elements; i < judgement.criteria.size(); ++i) {
    CriterionResult& judged = judgement.criteria[i];
    const Criterion& criterion = model.criteria[i - of_elements];
    if (judged.outcome != Verdict::hold || !criterion.event.empty()) continue;
    for (const ChannelRange& range : result.ranges) {
      if (!matches_pattern(range.channel->name, criterion.channel)) continue;
      const auto t = first_blow_of(*range.channel, model, *loaded.system, struck);
      if (!t) continue;
      judged.outcome = Verdict::open;
      judged.doubt = std::string(k_but_for_a_blow) + " at t = " + time_text(*t) + " s, of whose force in '" + range.channel->name +
                     "' only the impulse is known: give what is caught there a stiffness";
      break;
    }
    judgement.so_far = std::max(judgement.so_far, judged.outcome);
    judgement.verdict = std::max(judgement.verdict, std::min(judged.outcome, Verdict::open));
  }
}

} // namespace steplap
