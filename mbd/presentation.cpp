#include "mbd/presentation.h"

#include "mbd/trajectory.h"

#include <algorithm>

namespace steplap {

namespace {

template <class Table>
void add_named(const std::string& noun, const Table& table, std::vector<Table>& tables) {
  for (const Table& other : tables)
    if (other.name == table.name)
      throw ModelError(table.where, noun + " named '" + table.name + "' exists already: choose another name");
  tables.push_back(table);
}

bool has_limit(const Criterion& c) { return c.at_least || c.at_most || c.within; }

void check_criterion(const Criterion& c) {
  const auto fail = [&c](const std::string& message) {
    throw ModelError(c.where, "acceptance '" + c.name + "': " + message);
  };
  if (c.channel.empty() == c.event.empty()) fail("needs either 'channel' or 'event'");
  if (!c.event.empty()) {
    if (has_limit(c)) fail("'at_least', 'at_most' and 'within' are for channels, not for events");
    return;
  }
  if (!c.element.empty()) fail("'element' goes with 'event'; a channel's name holds its element");
  if (!has_limit(c)) fail("needs a limit: 'at_least', 'at_most' or 'within'");
  if (c.within && (c.at_least || c.at_most)) fail("'within' bounds both sides: leave out 'at_least' and 'at_most'");
  if (c.at_least && c.at_most && *c.at_least > *c.at_most) fail("'at_least' is above 'at_most': nothing could meet it");
}

// Compares patterns with what the trajectory will hold.
class PresentationCheck {
public:
  PresentationCheck(const Model& model, const System& system)
      : model_(model), written_(system, model.output.channels), system_(system) {}

  void run() {
    for (const Plot& plot : model_.plots)
      check_plot(plot);
    for (const Criterion& criterion : model_.criteria)
      check_patterns(criterion);
    if (!problems_.empty()) throw ModelError(std::move(problems_));
  }

private:
  std::vector<const Channel*> matches(const std::string& pattern) const {
    std::vector<const Channel*> found;
    for (const Channel* channel : written_.channels())
      if (matches_pattern(channel->name, pattern)) found.push_back(channel);
    return found;
  }

  std::vector<const Channel*> found(const Element& table, const std::string& subject, const std::string& pattern) {
    auto channels = matches(pattern);
    if (!channels.empty()) return channels;
    std::vector<std::string> known;
    for (const Channel* channel : written_.channels())
      known.push_back(channel->name);
    problems_.push_back({table.where, subject + ": no channel of the trajectory matches '" + pattern + "'" +
                                          did_you_mean(pattern, known)});
    return channels;
  }

  void check_plot(const Plot& plot) {
    const std::string subject = "plot '" + plot.name + "'";
    const Channel* first = nullptr;
    for (const auto* list : {&plot.channels, &plot.bounds})
      for (const std::string& pattern : *list)
        for (const Channel* channel : found(plot, subject, pattern)) {
          if (!first) first = channel;
          if (channel->unit == first->unit) continue;
          problems_.push_back({plot.where, subject + ": '" + first->name + "' is in '" + first->unit + "', '" +
                                               channel->name + "' in '" + channel->unit + "': plot them apart"});
          return;
        }
  }

  void check_patterns(const Criterion& c) {
    const std::string subject = "acceptance '" + c.name + "'";
    if (!c.channel.empty()) found(c, subject, c.channel);
    if (c.element.empty()) return;
    const auto& names = system_.element_names;
    if (std::none_of(names.begin(), names.end(), [&](const std::string& n) { return matches_pattern(n, c.element); }))
      problems_.push_back({c.where, subject + ": no element matches '" + c.element + "'" + did_you_mean(c.element, names)});
  }

  const Model& model_;
  const Trajectory written_;
  const System& system_;
  std::vector<Diagnostic> problems_;
};

} // namespace

const TableKind& plot_kind() {
  static const TableKind kind = [] {
    TableKind k;
    k.name = "plot";
    k.doc = "Time histories that belong in one figure of a report, all of one unit.";
    k.fields.add("title", &Plot::title).doc("what the figure shows");
    k.fields.add("channels", &Plot::channels).required().doc("channels drawn, patterns with * and ?");
    k.fields.add("bounds", &Plot::bounds).doc("channels drawn dashed at plus and minus their value");
    k.create = [] { return std::shared_ptr<Element>(std::make_shared<Plot>()); };
    k.apply = [](const Element& table, Model& model) { add_named("plot", static_cast<const Plot&>(table), model.plots); };
    return k;
  }();
  return kind;
}

const TableKind& acceptance_kind() {
  static const TableKind kind = [] {
    using T = Criterion;
    TableKind k;
    k.name = "acceptance";
    k.doc = "What a run must meet for the machine to be held good: limits on channels, over the samples of "
            "the trajectory, or events that must not happen.";
    FieldTable& f = k.fields;
    f.add("channel", &T::channel).doc("channels that are limited, a pattern with * and ?");
    f.add("at_least", &T::at_least).in("*").doc("smallest value allowed");
    f.add("at_most", &T::at_most).in("*").doc("largest value allowed");
    f.add("within", &T::within).in("*").not_negative().doc("largest absolute value allowed");
    f.add("event", &T::event).doc("event that must not happen, as in events.csv, a pattern with * and ?");
    f.add("element", &T::element).doc("elements whose event is meant, a pattern; all if not given");
    f.add("consequence", &T::consequence).one_of({"inspect", "reject"}).doc("if the criterion is not met");
    f.add("reason", &T::reason).doc("why, or by which document");
    k.create = [] { return std::shared_ptr<Element>(std::make_shared<T>()); };
    k.apply = [](const Element& table, Model& model) {
      check_criterion(static_cast<const T&>(table));
      add_named("acceptance", static_cast<const T&>(table), model.criteria);
    };
    return k;
  }();
  return kind;
}

void check_presentation(const Model& model, const System& system) {
  PresentationCheck(model, system).run();
}

} // namespace steplap
