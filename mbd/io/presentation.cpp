#include "mbd/io/presentation.h"

#include "mbd/base/event_kind.h"
#include "mbd/base/number_text.h"
#include "mbd/io/possible_events.h"
#include "mbd/io/units.h"
#include "mbd/model/action.h"
#include "mbd/simulation/trajectory.h"
#include "mbd/system/requested_channels.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <utility>

namespace steplap {

namespace {

// Refuses channel names that would be ambiguous in formulas or in trajectory.csv.
void check_channel_name(const DefinedChannel& channel) {
  const std::string& name = channel.name;
  const bool has_control = std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; });
  if (!name.empty() && !has_control && name.find_first_of("{}") == std::string::npos && name.back() != ']') return;
  throw ModelError(channel.place("name"),
                   "channel: a 'name' has letters and no line breaks, no braces, no ']' at its end (there stands the unit)");
}

// One limit of a criterion: name of its field, member with its text, member with its value.
struct Limit {
  const char* field;
  std::string Criterion::*text;
  std::optional<double> Criterion::*value;
};
constexpr Limit k_limits[] = {{"at_least", &Criterion::at_least_text, &Criterion::at_least},
                              {"at_most", &Criterion::at_most_text, &Criterion::at_most},
                              {"within", &Criterion::within_text, &Criterion::within}};

void check_criterion(const Criterion& c) {
  const auto fail = [&c](const std::string& field, const std::string& message) {
    throw ModelError(c.place(field), "acceptance '" + c.name + "': " + message);
  };
  if (c.channel.empty() == c.event.empty()) fail("event", "needs either 'channel' or 'event'");
  if (!c.event.empty()) {
    for (const Limit& limit : k_limits)
      if (!(c.*limit.text).empty()) fail(limit.field, "'at_least', 'at_most' and 'within' are for channels, not for events");
    return;
  }
  if (!c.element.empty()) fail("element", "'element' goes with 'event'; a channel's name holds its element");
  const bool is_bounded = !c.at_least_text.empty() || !c.at_most_text.empty();
  if (!is_bounded && c.within_text.empty()) fail("", "needs a limit: 'at_least', 'at_most' or 'within'");
  if (is_bounded && !c.within_text.empty()) fail("within", "'within' bounds both sides: leave out 'at_least' and 'at_most'");
}

// Reads the text of a limit. A number without unit counts as being in the channel's unit.
Quantity read_limit(const std::string& text, const std::string& unit) {
  Quantity bare;
  const auto [rest, status] = std::from_chars(text.data(), text.data() + text.size(), bare.value);
  if (status != std::errc() || rest != text.data() + text.size()) return parse_quantity(text, unit);
  if (!std::isfinite(bare.value)) bare.problem = "must be finite, got " + text;
  return bare;
}

// Checks names and patterns against the channels and events of the system.
class PresentationCheck {
public:
  PresentationCheck(Model& model, const System& system)
      : model_(model), written_(system, model.output.channels), all_(system, {}), system_(system) {}

  std::vector<std::string> run() {
    for (const Plot& plot : model_.plots) check_plot(plot);
    // Plots of channels that are not written are removed, after the check that the channels exist.
    std::erase_if(model_.plots, [this](const Plot& plot) {
      if (!is_written(plot)) left_out_.push_back(plot.name);
      return !is_written(plot);
    });
    for (const ElementEntry& entry : model_.elements)
      if (const auto* const action = as_action(*entry.element)) check_action(*action);
    run_criteria();
    return std::move(left_out_);
  }

  // Checks the channels that are written. Throws all problems found.
  void run_written() {
    for (const std::string& pattern : model_.output.channels) found(model_.output.where, "'channels' of [output]", pattern);
    if (!problems_.empty()) throw ModelError(std::move(problems_));
  }

  // Checks criteria only. Throws all problems found.
  void run_criteria() {
    for (Criterion& criterion : model_.criteria) check_criterion_on(criterion);
    if (!problems_.empty()) throw ModelError(std::move(problems_));
  }

private:
  std::vector<const Channel*> matches(const std::string& pattern) const {
    std::vector<const Channel*> found;
    for (const Channel* channel : all_.channels())
      if (matches_pattern(channel->name, pattern)) found.push_back(channel);
    return found;
  }

  bool is_written(const Plot& plot) const {
    for (const auto* list : {&plot.channels, &plot.bounds})
      for (const std::string& pattern : *list)
        if (std::none_of(written_.channels().begin(), written_.channels().end(),
                         [&](const Channel* channel) { return matches_pattern(channel->name, pattern); }))
          return false;
    return true;
  }

  std::vector<const Channel*> found(const Location& where, const std::string& subject, const std::string& pattern) {
    auto channels = matches(pattern);
    if (!channels.empty()) return channels;
    std::vector<std::string> known;
    for (const Channel* channel : all_.channels()) known.push_back(channel->name);
    if (const std::string on_request = name_on_request(pattern); !on_request.empty())
      problems_.push_back(
          {where, subject + ": '" + on_request + "' is computed on request only: add also = [\"" + on_request + "\"] to [output]"});
    else problems_.push_back({where, subject + ": no channel matches '" + pattern + "'" + did_you_mean(pattern, known)});
    return channels;
  }

  // Returns the first channel on request that matches the pattern; "" if there is none.
  [[nodiscard]] std::string name_on_request(const std::string& pattern) const {
    try {
      const std::unique_ptr<System> system = compile_with_all_channels(model_);
      for (const Channel& channel : system->channels)
        if (channel.is_on_request && matches_pattern(channel.name, pattern)) return channel.name;
    } catch (const ModelError&) { // names that only "*" makes ambiguous
    }
    return {};
  }

  static const Location& place_of(const Plot& plot, const std::vector<std::string>* list) {
    return plot.place(list == &plot.channels ? "channels" : "bounds");
  }

  void check_plot(const Plot& plot) {
    const std::string subject = "plot '" + plot.name + "'";
    const Channel* first = nullptr;
    for (const auto* list : {&plot.channels, &plot.bounds})
      for (const std::string& pattern : *list)
        for (const Channel* channel : found(place_of(plot, list), subject, pattern)) {
          if (!first) first = channel;
          if (channel->unit == first->unit) continue;
          problems_.push_back({place_of(plot, list), subject + ": '" + first->name + "' is in '" + first->unit + "', '" + channel->name +
                                                         "' in '" + channel->unit + "': plot them apart"});
          return;
        }
  }

  void complain(const Criterion& c, const std::string& field, const std::string& message) {
    problems_.push_back({c.place(field), "acceptance '" + c.name + "': " + message});
  }

  void check_criterion_on(Criterion& c) {
    if (!c.channel.empty()) return check_limits(c);
    const auto& names = system_.element_names;
    if (!c.element.empty() && std::none_of(names.begin(), names.end(), [&](const std::string& n) { return matches_pattern(n, c.element); }))
      return complain(c, "element", "no element matches '" + c.element + "'" + did_you_mean(c.element, names));
    check_event(c);
  }

  void check_event(const Criterion& c) {
    if (const std::string problem = why_no_event(model_, system_, c.element, c.event); !problem.empty()) complain(c, "event", problem);
  }

  // Reports an action that waits for an event which its element cannot have.
  void check_action(const Action& action) {
    const auto event = event_text(action.when);
    if (!event) return;
    const std::string problem = why_no_event(model_, system_, event->element, words_of(event->kind));
    if (!problem.empty()) problems_.push_back({action.place("when"), "action '" + action.name + "': 'when': " + problem});
  }

  void check_limits(Criterion& c) {
    const auto channels = found(c.place("channel"), "acceptance '" + c.name + "'", c.channel);
    if (channels.empty()) return;
    const Channel& first = *channels.front();
    for (const Channel* channel : channels)
      if (!channel->has_extremes)
        return complain(c, "channel", "'" + channel->name + "' passes through infinity and has no extremes: limit another channel");
    for (const Channel* channel : channels)
      if (channel->unit != first.unit)
        return complain(c, "channel",
                        "'" + first.name + "' is in '" + first.unit + "', '" + channel->name + "' in '" + channel->unit +
                            "': limit them apart");
    for (const Limit& limit : k_limits) {
      const std::string& text = c.*limit.text;
      if (text.empty()) continue;
      const Quantity quantity = read_limit(text, first.unit);
      if (quantity.problem.empty()) c.*limit.value = quantity.value;
      else complain(c, limit.field, "'" + std::string(limit.field) + "' of channel '" + first.name + "': " + quantity.problem);
    }
    if (c.within && *c.within < 0.0) complain(c, "within", "'within' must be at least 0, got " + number_text(*c.within));
    if (c.at_least && c.at_most && *c.at_least > *c.at_most)
      complain(c, "at_least", "'at_least' is above 'at_most': nothing could meet it");
  }

  Model& model_;
  const Trajectory written_, all_;
  const System& system_;
  std::vector<Diagnostic> problems_;
  std::vector<std::string> left_out_; ///< names of the removed plots
};

} // namespace

const TableKind& channel_kind() {
  static const TableKind kind = [] {
    using T = DefinedChannel;
    TableKind k;
    k.name = "channel";
    k.doc = "A channel that is a formula of others: written, plotted, limited and estimated like them. `docs/reference/channels.md` tells "
            "what formulas may hold.";
    k.fields.add("expression", &T::expression)
        .required()
        .doc("the formula; names with spaces in braces, numbers with units in quotes: \"abs({front foot.force}) / '12 kN'\"");
    k.fields.add("unit", &T::unit).doc("unit of its values, of the formula's dimension; SI if not given");
    k.fields.add("meaning", &T::meaning).doc("what it is, for lists and reports; the formula if not given");
    k.fields.add("sign", &T::sign).doc("when it is positive");
    k.holds<T>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element& table, Model& model) {
      const auto& channel = static_cast<const T&>(table);
      check_channel_name(channel);
      model.channels.push_back(channel);
    };
    return k;
  }();
  return kind;
}

const TableKind& plot_kind() {
  static const TableKind kind = [] {
    TableKind k;
    k.name = "plot";
    k.doc = "Time histories that belong in one figure of a report, all of one unit.";
    k.fields.add("title", &Plot::title).doc("what the figure shows");
    k.fields.add("channels", &Plot::channels).required().doc("channels drawn, patterns with * and ?");
    k.fields.add("bounds", &Plot::bounds).doc("channels drawn dashed at plus and minus their value");
    k.holds<Plot>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element& table, Model& model) { model.plots.push_back(static_cast<const Plot&>(table)); };
    return k;
  }();
  return kind;
}

const TableKind& acceptance_kind() {
  static const TableKind kind = [] {
    using T = AcceptanceTable;
    TableKind k;
    k.name = "acceptance";
    k.doc = "What a run must meet for the machine to be held good: limits on channels, written or not, over the whole "
            "run, or events that must not happen.";
    FieldTable& f = k.fields;
    f.add("channel", &T::channel).doc("channels that are limited, a pattern with * and ?");
    f.add("at_least", &T::at_least_text).as(FieldType::quantity).doc("smallest value allowed");
    f.add("at_most", &T::at_most_text).as(FieldType::quantity).doc("largest value allowed");
    f.add("within", &T::within_text).as(FieldType::quantity).doc("largest absolute value allowed");
    f.add("event", &T::event).doc("event that must not happen, as in events.csv, a pattern with * and ?");
    f.add("element", &T::element).doc("elements whose event is meant, a pattern; all if not given");
    f.add("consequence", &T::consequence).one_of({"inspect", "reject"}).doc("if the criterion is not met");
    f.add("reason", &T::reason).doc("why, or by which document");
    f.add("source", &T::source)
        .one_of({"assumed", "specified", "measured"})
        .doc("how the limit is known; in `steplap assess` an assumed one alone never makes \"return\"");
    k.holds<T>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element& table, Model& model) {
      Criterion criterion = static_cast<const T&>(table);
      check_criterion(criterion);
      for (const Limit& limit : k_limits) // kept in SI until the channels are known
        if (!(criterion.*limit.text).empty()) criterion.*limit.value = read_limit(criterion.*limit.text, "*").value;
      model.criteria.push_back(std::move(criterion));
    };
    return k;
  }();
  return kind;
}

std::vector<const AcceptanceTable*> acceptance_tables_of(const Model& model) {
  std::vector<const AcceptanceTable*> all;
  for (const TableEntry& entry : model.tables)
    if (entry.kind == &acceptance_kind()) all.push_back(static_cast<const AcceptanceTable*>(entry.table.get()));
  return all;
}

std::vector<std::string> check_presentation(Model& model, const System& system) { return PresentationCheck(model, system).run(); }

void check_written_channels(Model& model, const System& system) {
  if (!model.output.channels.empty()) PresentationCheck(model, system).run_written();
}

void convert_limits(Model& model, const System& system) { PresentationCheck(model, system).run_criteria(); }

} // namespace steplap
