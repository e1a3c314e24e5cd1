#include "tools/study/study_reader.h"

#include "mbd/base/event_kind.h"
#include "mbd/base/name_pattern.h"
#include "mbd/base/number_text.h"
#include "mbd/io/document.h"
#include "mbd/io/field_reader.h"
#include "mbd/io/possible_events.h"
#include "mbd/io/presentation.h"
#include "mbd/io/read_input.h"
#include "mbd/io/reader.h"
#include "mbd/io/units.h"
#include "mbd/model/completion.h"
#include "mbd/model/model_path.h"
#include "mbd/model/validate.h"
#include "mbd/system/requested_channels.h"
#include "tools/study/case_limits.h"
#include "tools/study/expression.h"
#include "tools/study/history.h"
#include "tools/study/kinds.h"
#include "tools/study/law.h"
#include "transformer/program.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

namespace steplap::study {

namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

std::string list_text(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

// Returns the names of all kinds with this property, for a message.
std::string kinds_with(bool StudyKind::*takes) {
  std::string text;
  for (const StudyKind& kind : study_kinds())
    if (kind.*takes) text += (text.empty() ? "'" : " or '") + kind.name + "'";
  return text;
}

// A key that accepts one text or a list of texts.
void make_list(Node& table, const std::string& key) {
  Node* node = table.find(key);
  if (!node || node->type != Node::Type::text) return;
  Node item = *node;
  item.key.clear();
  node->type = Node::Type::array;
  node->scalar = {};
  node->children = {std::move(item)};
}

class Reader {
public:
  Reader(Document document, std::string file) : document_(std::move(document)) {
    refuse_control_characters(document_);
    problems_ = std::move(document_.problems);
    study_.file = std::move(file);
  }

  LoadedStudy read() {
    read_header();
    stop_if_wrong(); // throws if there are errors so far, because later checks need valid models
    load_models();
    stop_if_wrong();
    read_array("variable", [this](Node& entry) { read_variable(entry); });
    read_array("response", [this](Node& entry) { read_response(entry); });
    read_array("limit_state", [this](Node& entry) { read_limit_state(entry); });
    read_array("history", [this](Node& entry) { read_history(entry); });
    read_array("correlation", [this](Node& entry) { read_correlation(entry); });
    read_array("evidence", [this](Node& entry) { read_evidence(entry); });
    for (const StudyKind& kind : study_kinds()) read_settings(kind);
    stop_if_wrong();
    loaded_.models.assign(models_.begin(), models_.end());
    add_reserves_of_cases(loaded_);
    if (kind_->prepare) kind_->prepare(loaded_);
    const std::size_t known = problems_.size();
    check_names();
    const bool are_names_right = problems_.size() == known;
    find_nominal();
    if (are_names_right) check_expressions(); // with wrong names, expressions would give misleading errors
    stop_if_wrong();
    check_values();
    stop_if_wrong();
    kind_->check(loaded_, problems_);
    stop_if_wrong();
    return std::move(loaded_);
  }

private:
  void add(const Location& where, std::string message) { problems_.push_back({where, std::move(message)}); }
  void add_all(const ModelError& error) { problems_.insert(problems_.end(), error.diagnostics().begin(), error.diagnostics().end()); }
  void stop_if_wrong() {
    if (problems_.empty()) return;
    std::stable_sort(problems_.begin(), problems_.end(),
                     [](const Diagnostic& a, const Diagnostic& b) { return a.where.file == b.where.file && a.where.line < b.where.line; });
    throw ModelError(problems_);
  }

  // Reads the fields of a table and checks their ranges. Fields that accept several types are read separately.
  void read_table(const Node& table, const FieldTable& fields, void* object, TableReading reading) {
    const std::size_t before = problems_.size();
    const std::vector<GivenField> given = read_fields(table, fields, object, reading, problems_);
    if (problems_.size() != before) return;
    for (const GivenField& field : given) {
      const std::string problem = field.is_usable && field.node ? range_problem(*field.field, field.field->get(object)) : "";
      if (!problem.empty()) add(field.node->where(), "'" + field.field->name + "' of " + reading.subject + " " + problem);
    }
  }

  void read_header() {
    study_.where = {study_.file, 1, 1};
    make_list(document_.root, "model");
    TableReading reading;
    reading.subject = "the study";
    for (const StudyTable& table : study_tables())
      if (!table.name.empty()) reading.known_keys.push_back(table.name);
    read_table(document_.root, header_fields(), &study_, reading);
    if (study_.kind.empty()) return;
    const std::vector<std::string> kinds = kind_names();
    kind_ = find_kind(study_.kind);
    if (!kind_)
      add(document_.root.find("kind")->where(),
          "there is no kind of study '" + study_.kind + "'" + did_you_mean(study_.kind, kinds) + "; those there are: " + list_text(kinds));
  }

  void load_models() {
    const Node* node = document_.root.find("model");
    for (std::size_t i = 0; i < study_.models.size(); ++i) {
      const std::filesystem::path given = study_.models[i];
      const std::string path =
          given.is_absolute() ? given.string() : (std::filesystem::path(study_.file).parent_path() / given).lexically_normal().string();
      if (!std::filesystem::exists(path)) {
        add(node->children[i].where(), "there is no model file '" + path + "'");
        continue;
      }
      try {
        std::shared_ptr<StudyModel> model = read_study_model(path);
        for (const auto& other : models_)
          if (other->name == model->name) add(node->children[i].where(), "two models are called '" + model->name + "'");
        models_.push_back(std::move(model));
      } catch (const ModelError& error) {
        add_all(error);
      }
    }
  }

  template <class Read> void read_array(const std::string& name, const Read& read) {
    Node* array = document_.root.find(name);
    if (!array) return;
    if (array->type == Node::Type::array && array->children.empty()) return;
    if (!array->is_array_of_tables())
      return add(array->where_key(),
                 "'" + name + "' must be an array of tables, each begun by [[" + name + "]], not " + array->type_name());
    for (Node& entry : array->children) read(entry);
  }

  void read_settings(const StudyKind& kind) {
    const std::string& name = kind.name;
    const Node* table = document_.root.find(name);
    const std::shared_ptr<KindSettings> settings = kind.create();
    settings->where = study_.where;
    if (&kind == kind_) study_.settings = settings;
    if (!table) {
      if (&kind == kind_)
        for (const Field& field : kind.fields.fields())
          if (field.is_required) return add(study_.where, "a study of the kind '" + name + "' needs a table [" + name + "]");
      return;
    }
    if (!table->is_table()) return add(table->where_key(), "'" + name + "' must be a table, [" + name + "], not " + table->type_name());
    settings->where = table->where();
    TableReading reading;
    reading.subject = "[" + name + "]";
    read_table(*table, kind.fields, fields_of(*settings), reading);
  }

  // Returns the unit of a variable: that of the fields at its paths in the models, or the unit given in the study. Returns "*" if any is
  // accepted.
  std::string unit_of_paths(const Node& entry, Variable& v) {
    const Node* paths = entry.find("path");
    const Node* model = entry.find("model");
    const bool is_factor =
        entry.find("factor") && entry.find("factor")->type == Node::Type::boolean && std::get<bool>(entry.find("factor")->scalar);
    if (model && model->type == Node::Type::text && !find_model(model->text()))
      add(model->where(), "there is no model '" + model->text() + "'" + did_you_mean(model->text(), model_names()));
    if (!paths || paths->type != Node::Type::array || paths->children.empty()) {
      if (const Node* unit = entry.find("unit"); unit && unit->type == Node::Type::text) {
        if (!parse_quantity("1 " + unit->text(), unit->text()).problem.empty()) // a unit is required, so a number without unit is invalid
          add(unit->where(), "'" + unit->text() + "' is not a unit");
        return unit->text();
      }
      return "";
    }
    if (models_.empty()) add(paths->where(), "the study has no model, so that variable '" + entry_name(entry) + "' cannot have a path");
    if (const Node* unit = entry.find("unit")) add(unit->where(), "a variable with a path has the unit of the model's field");
    std::optional<std::string> common;
    for (const Node& path : paths->children) {
      if (path.type != Node::Type::text) continue;
      for (const auto& m : models_) {
        if (model && model->text() != m->name) continue;
        try {
          const std::string unit = unit_of(m->given, path.text());
          if (common && *common != unit && !is_factor)
            add(path.where(),
                "'" + path.text() + "' is in '" + unit + "', the path before it in '" + *common + "': one value cannot be both");
          if (!common) common = unit;
        } catch (const ModelError& error) {
          for (const Diagnostic& d : error.diagnostics())
            add(path.where(),
                "path '" + path.text() + "' of variable '" + entry_name(entry) + "' in model '" + m->name + "': " + d.message);
        }
      }
    }
    v.unit = is_factor ? "" : common.value_or("*");
    return v.unit;
  }

  void read_variable(Node& entry) {
    Variable v;
    v.where = entry.where();
    make_list(entry, "path");
    const std::string unit = unit_of_paths(entry, v);
    TableReading reading;
    reading.subject = subject_text("variable", entry_name(entry));
    const std::size_t before = problems_.size();
    read_table(entry, variable_fields(unit), &v, reading);
    if (v.unit.empty() && !v.is_factor) v.unit = unit;
    if (problems_.size() == before) check_variable(entry, v);
    study_.variables.push_back(std::move(v));
  }

  void check_variable(const Node& entry, const Variable& v) {
    const std::string subject = "variable '" + v.name + "'";
    const int ways = !v.values.empty() + !v.range.empty() + v.has_distribution();
    const bool is_mean_sought = kind_ && kind_->seeks_a_mean && v.has_distribution() && ways == 2;
    if (ways > 1 && !is_mean_sought) add(v.where, subject + ": 'values', 'range' and 'distribution' exclude each other");
    if (const Node* mean = entry.find("mean"); mean && is_mean_sought)
      add(mean->where_key(), subject + ": its 'mean' is sought in its range: leave 'mean' out");
    if (ways == 0 && !v.value) add(v.where, subject + " needs 'values', 'range', 'distribution' or 'value'");
    if (entry.find("values") && v.values.empty()) add(entry.find("values")->where(), subject + ": 'values' is empty");
    if (entry.find("range") && v.range.size() != 2) add(entry.find("range")->where(), subject + ": 'range' is [low, high]");
    if (v.range.size() == 2 && !(v.range[0] < v.range[1]))
      add(entry.find("range")->where(), subject + ": the first of 'range' must be below the second");
    if (!v.has_distribution())
      for (const char* key : {"mean", "standard_deviation", "cov", "low", "high", "mode", "shape", "shape2", "scale", "location", "lower",
                              "upper", "measured", "column"})
        if (const Node* node = entry.find(key))
          add(node->where_key(), "'" + std::string(key) + "' of " + subject + " goes with 'distribution'");
    if (v.is_factor && v.paths.empty()) add(v.where, subject + ": 'factor' needs a path, whose value it multiplies");
    for (const double x : v.values)
      if (!std::isfinite(x)) add(v.where, subject + ": values must be finite");
  }

  void read_response(const Node& entry) {
    Response r;
    r.where = entry.where();
    TableReading reading;
    reading.subject = subject_text("response", entry_name(entry));
    const std::size_t before = problems_.size();
    read_table(entry, response_fields(), &r, reading);
    if (problems_.size() == before) check_response(entry, r);
    study_.responses.push_back(std::move(r));
  }

  // Sets `measure` from the text `what`. Leaves it unchanged for texts that the field table has already rejected.
  static void set_measure(Response& r) {
    struct Named {
      Measure measure;
      bool takes_time = false; // true: the response is the time of the extreme
    };
    static const std::map<std::string, Named> measures = {{"highest", {Measure::highest}},
                                                          {"lowest", {Measure::lowest}},
                                                          {"largest", {Measure::largest_magnitude}},
                                                          {"final", {Measure::final_value}},
                                                          {"initial", {Measure::initial_value}},
                                                          {"mean", {Measure::mean}},
                                                          {"path", {Measure::path}},
                                                          {"count", {Measure::event_count}},
                                                          {"time_of_first", {Measure::first_event}},
                                                          {"time_of_highest", {Measure::highest, true}},
                                                          {"time_of_lowest", {Measure::lowest, true}},
                                                          {"time_of_largest", {Measure::largest_magnitude, true}},
                                                          {"verdict", {Measure::verdict}},
                                                          {"reserve", {Measure::reserve}},
                                                          {k_reserve_of_cases, {Measure::reserve}}};
    const auto found = measures.find(r.what);
    if (found == measures.end()) return;
    r.measure = found->second.measure;
    r.takes_time = found->second.takes_time;
  }

  void check_response(const Node& entry, Response& r) {
    const std::string subject = "response '" + r.name + "'";
    if (!r.expression.empty()) {
      for (const char* key : {"channel", "what", "event", "element", "otherwise", "model"})
        if (const Node* node = entry.find(key))
          add(node->where_key(), "'" + std::string(key) + "' does not go with 'expression' in " + subject);
      return;
    }
    if (models_.empty()) return add(r.where, subject + ": the study has no model; give 'expression'");
    if (r.what.empty()) return add(r.where, subject + " needs 'what', or 'expression'");
    set_measure(r);
    if (r.model.empty() && models_.size() > 1)
      return add(r.where, subject + ": say which 'model' it is taken from: " + list_text(model_names()));
    const StudyModel* model = r.model.empty() ? models_.front().get() : find_model(r.model);
    if (!model) return add(entry.find("model")->where(), "there is no model '" + r.model + "'" + did_you_mean(r.model, model_names()));
    r.model = model->name;
    const bool is_of_events = r.measure == Measure::event_count || r.measure == Measure::first_event;
    if (!is_of_events)
      for (const char* key : {"event", "element", "otherwise"})
        if (const Node* node = entry.find(key)) add(node->where_key(), "'" + std::string(key) + "' of " + subject + " is for events only");
    if (is_of_events) return check_events(entry, r, *model);
    if (is_judged(r.measure)) {
      if (const Node* node = entry.find("channel"))
        add(node->where_key(), subject + ": '" + r.what + "' is of the whole run, not of a channel");
      return;
    }
    check_channel(entry, r, *model);
  }

  void check_events(const Node& entry, Response& r, const StudyModel& model) {
    const std::string subject = "response '" + r.name + "'";
    if (r.measure == Measure::first_event) r.unit = "s";
    if (r.event.empty()) return add(r.where, subject + " needs 'event'");
    if (r.measure == Measure::event_count && entry.find("otherwise"))
      add(entry.find("otherwise")->where_key(), "'otherwise' is for 'time_of_first'");
    const auto& names = model.system->element_names;
    if (!r.element.empty() && std::none_of(names.begin(), names.end(), [&](const auto& name) { return matches_pattern(name, r.element); }))
      return add(entry.find("element")->where(),
                 "no element of model '" + model.name + "' matches '" + r.element + "'" + did_you_mean(r.element, names));
    if (const std::string problem = why_no_event(completed(model.given), *model.system, r.element, r.event); !problem.empty())
      add(entry.find("event")->where(), subject + ": " + problem);
  }

  static bool is_on_request(const Response& r, const StudyModel& model) {
    try {
      return !channels_of(r, *compile_with_all_channels(completed(model.given))).empty();
    } catch (const ModelError&) { // the error is reported when the model is read
      return false;
    }
  }

  void check_channel(const Node& entry, Response& r, const StudyModel& model) {
    const std::string subject = "response '" + r.name + "'";
    if (r.channel.empty()) return add(r.where, subject + " needs 'channel'");
    const auto found = channels_of(r, *model.system);
    const Location where = entry.find("channel")->where();
    if (found.empty()) {
      if (is_on_request(r, model))
        return add(where, "channel '" + r.channel + "' of model '" + model.name + "' is made on request only: write also = [\"" +
                              r.channel + "\"] below the model's [output]");
      std::vector<std::string> names;
      for (const Channel& c : model.system->channels) names.push_back(c.name);
      return add(where, "no channel of model '" + model.name + "' is called '" + r.channel + "'" + did_you_mean(r.channel, names));
    }
    for (const Channel* c : found)
      if (c->unit != found.front()->unit)
        return add(where,
                   "'" + found.front()->name + "' and '" + c->name + "' are of different units: the outermost of both means nothing");
    for (const Channel* c : found)
      if (is_extreme(r.measure) && !c->has_extremes) return add(where, "'" + c->name + "' passes through infinity: it has no extremes");
    if (!is_extreme(r.measure) && found.size() > 1) return add(where, subject + ": '" + r.what + "' is of one channel, and several match");
    r.unit = r.takes_time ? "s" : found.front()->unit;
  }

  void read_limit_state(const Node& entry) {
    LimitState l;
    l.where = entry.where();
    TableReading reading;
    reading.subject = subject_text("limit_state", entry_name(entry));
    read_table(entry, limit_state_fields(), &l, reading);
    study_.limit_states.push_back(std::move(l));
  }

  void read_history(const Node& entry) {
    History h;
    h.where = entry.where();
    TableReading reading;
    reading.subject = subject_text("history", entry_name(entry));
    const std::size_t before = problems_.size();
    read_table(entry, history_fields(), &h, reading);
    if (!kind_->takes_histories) add(h.where, "a [[history]] is for studies of the kind " + kinds_with(&StudyKind::takes_histories));
    else if (models_.empty()) add(h.where, "the study has no model to compare history '" + h.name + "' with");
    else if (h.model.empty() && models_.size() > 1)
      add(h.where, "history '" + h.name + "': say which 'model' was measured: " + list_text(model_names()));
    if (problems_.size() != before) return;
    const StudyModel* model = h.model.empty() ? models_.front().get() : find_model(h.model);
    if (!model) return add(entry.find("model")->where(), "there is no model '" + h.model + "'" + did_you_mean(h.model, model_names()));
    h.model = model->name;
    load_history(entry, *model, h, problems_);
    study_.histories.push_back(std::move(h));
  }

  void read_correlation(const Node& entry) {
    Correlation c;
    c.where = entry.where();
    TableReading reading;
    reading.subject = "[[correlation]]";
    const std::size_t before = problems_.size();
    read_table(entry, correlation_fields(), &c, reading);
    if (problems_.size() != before) return;
    if (c.between.size() != 2 || c.between[0] == c.between[1]) return add(c.where, "'between' of [[correlation]] names two variables");
    for (std::size_t i = 0; i < 2; ++i) {
      const int v = study_.index_of_variable(c.between[i]);
      std::vector<std::string> names;
      for (const Variable& other : study_.variables) names.push_back(other.name);
      const Location where = entry.find("between")->children[i].where();
      if (v < 0) return add(where, "there is no variable '" + c.between[i] + "'" + did_you_mean(c.between[i], names));
      if (!study_.variables[v].has_distribution())
        return add(where, "variable '" + c.between[i] + "' has no distribution, so that it has no correlation");
    }
    for (const Correlation& other : study_.correlations)
      if (std::set(other.between.begin(), other.between.end()) == std::set(c.between.begin(), c.between.end()))
        return add(c.where, "the correlation of " + list_text(c.between) + " is given already");
    study_.correlations.push_back(std::move(c));
  }

  void read_evidence(Node& entry) {
    Evidence e;
    e.where = entry.where();
    for (const char* key : {"anew", "set", "limit_states"}) make_list(entry, key);
    TableReading reading;
    reading.subject = "[[evidence]]";
    const std::size_t before = problems_.size();
    read_table(entry, evidence_fields(), &e, reading);
    if (!kind_->takes_evidence) add(e.where, "[[evidence]] is for studies of the kind " + kinds_with(&StudyKind::takes_evidence));
    if (problems_.size() != before) return;
    for (const std::string& text : e.settings) read_measured_value(text, entry.find("set")->where(), e);
    study_.evidence.push_back(std::move(e));
  }

  // Reads "shock = 0.8" or "pressure = 80 kPa".
  void read_measured_value(const std::string& text, const Location& where, Evidence& e) {
    const std::size_t sign = text.find('=');
    const auto trimmed = [](const std::string& part) {
      const std::size_t first = part.find_first_not_of(' '), last = part.find_last_not_of(' ');
      return first == std::string::npos ? std::string() : part.substr(first, last - first + 1);
    };
    if (sign == std::string::npos) return add(where, "'" + text + "' is no measured value: write \"variable = value\"");
    const std::string name = trimmed(text.substr(0, sign)), given = trimmed(text.substr(sign + 1));
    const int v = study_.index_of_variable(name);
    if (v < 0) return add(where, "there is no variable '" + name + "'" + did_you_mean(name, loaded_.variable_names()));
    double value = 0.0;
    const auto [rest, status] = std::from_chars(given.data(), given.data() + given.size(), value);
    if (status != std::errc() || rest != given.data() + given.size()) {
      const Quantity quantity = parse_quantity(given, study_.variables[static_cast<std::size_t>(v)].unit);
      if (!quantity.problem.empty()) return add(where, "'" + text + "': " + quantity.problem);
      value = quantity.value;
    }
    if (!std::isfinite(value)) return add(where, "'" + text + "': the value must be finite");
    e.values.emplace_back(v, value);
  }

  void check_names() {
    std::set<std::string> taken;
    const auto check = [&](const std::string& noun, const std::string& name, const Location& where) {
      const std::string problem = name_problem(name);
      if (!problem.empty()) add(where, "the name of " + noun + " '" + name + "' " + problem);
      else if (!taken.insert(name).second)
        add(where, noun + " '" + name + "': the name is taken; variables, responses, limit states and histories share their names");
    };
    for (const Variable& v : study_.variables) check("variable", v.name, v.where);
    for (const Response& r : study_.responses) check("response", r.name, r.where);
    for (const LimitState& l : study_.limit_states) check("limit state", l.name, l.where);
    for (const History& h : study_.histories) check("history", h.name, h.where);
    std::map<std::pair<std::string, std::string>, const Variable*> paths;
    for (const Variable& v : study_.variables)
      for (const std::string& path : v.paths)
        for (const auto& m : models_) {
          if (!is_set_in(v, *m)) continue;
          const auto [other, is_new] = paths.try_emplace({m->name, path}, &v);
          if (!is_new && other->second == &v) add(v.where, "variable '" + v.name + "' names the path '" + path + "' twice");
          else if (!is_new) add(v.where, "'" + path + "' is set by two variables, '" + other->second->name + "' and '" + v.name + "'");
        }
  }

  void check_expressions() {
    std::vector<std::string> names;
    for (const Variable& v : study_.variables) names.push_back(v.name);
    const auto check = [&](const std::string& text, const Location& where) {
      try {
        (void)Expression(text, names, where);
      } catch (const ModelError& error) {
        add_all(error);
      }
    };
    for (const Response& r : study_.responses) {
      if (!r.expression.empty()) check(r.expression, r.where);
      names.push_back(r.name);
    }
    for (const LimitState& l : study_.limit_states) {
      check(l.expression, l.where);
      names.push_back(l.name);
    }
  }

  void find_nominal() {
    for (const Variable& v : study_.variables) {
      double base = k_nan;
      for (const auto& m : models_)
        if (std::isnan(base) && is_set_in(v, *m) && !v.paths.empty()) base = number_of(m->given, v.paths.front());
      try {
        double nominal = v.is_factor ? 1.0 : base;
        if (v.value) nominal = *v.value;
        else if (v.has_distribution()) nominal = mean_of(v);
        else if (!v.range.empty()) nominal = 0.5 * (v.range[0] + v.range[1]);
        else if (!v.values.empty()) nominal = v.values.front();
        loaded_.nominal.push_back(nominal);
      } catch (const ModelError& error) {
        add_all(error);
        loaded_.nominal.push_back(k_nan);
      }
    }
  }

  // Checks that the models accept the values: all listed ones, the ends of ranges, and the nominal point.
  void check_values() {
    for (std::size_t i = 0; i < study_.variables.size(); ++i) {
      const Variable& v = study_.variables[i];
      std::vector<double> values = v.values;
      values.insert(values.end(), v.range.begin(), v.range.end());
      values.push_back(loaded_.nominal[i]);
      for (const auto& m : loaded_.models)
        for (const std::string& path : v.paths) {
          if (!is_set_in(v, *m)) continue;
          const double factor = v.is_factor ? number_of(m->given, path) : 1.0;
          try {
            Model trial = m->given;
            for (const double value : values) set_value(trial, path, factor * value);
          } catch (const ModelError& error) {
            for (const Diagnostic& d : error.diagnostics()) add(v.where, "variable '" + v.name + "', path '" + path + "': " + d.message);
          }
        }
    }
    std::vector<Diagnostic> wrong;
    (void)JointLaw(study_, loaded_.nominal, wrong);
    problems_.insert(problems_.end(), wrong.begin(), wrong.end());
  }

  const StudyModel* find_model(const std::string& name) const {
    for (const auto& m : models_)
      if (m->name == name) return m.get();
    return nullptr;
  }
  std::vector<std::string> model_names() const {
    std::vector<std::string> names;
    for (const auto& m : models_) names.push_back(m->name);
    return names;
  }

  Document document_;
  LoadedStudy loaded_;
  Study& study_ = loaded_.study;
  const StudyKind* kind_ = nullptr; ///< nullptr before the header has been read
  std::vector<std::shared_ptr<StudyModel>> models_;
  std::vector<Diagnostic> problems_;
};

} // namespace

std::shared_ptr<StudyModel> read_study_model(const std::string& path, const std::vector<std::string>& overrides) {
  const InputFiles inputs;
  auto model = std::make_shared<StudyModel>();
  model->path = path;
  model->name = std::filesystem::path(path).stem().string();
  model->overrides = overrides;
  model->given = read_given_model(path, program_catalogue(), overrides);
  model->text = effective_model_text(path, program_catalogue(), overrides);
  Model whole = completed(model->given);
  model->system = compile(whole);
  check_written_channels(whole, *model->system);
  (void)check_presentation(whole, *model->system);
  model->files = inputs.files();
  return model;
}

LoadedStudy read_study(const std::string& path) {
  std::error_code ignored;
  if (is_standard_input(path))
    throw ModelError(Location{shown_input(path), 0, 0}, "cannot read the study from the standard input: studies are read more than once, "
                                                        "and paths of models are relative to their file. Give a file");
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    throw ModelError(Location{path, 0, 0},
                     "cannot read the study: it is no file. Studies are read more than once, so pipes cannot be taken");
  const InputFiles inputs;
  LoadedStudy loaded = Reader(load_document(path), path).read();
  loaded.study.text = model_source_text(path);
  loaded.files = inputs.files();
  return loaded;
}

LoadedStudy parse_study(std::string text, const std::string& file_name) {
  const InputFiles inputs;
  LoadedStudy loaded = Reader(parse_document(text, file_name), file_name).read();
  loaded.study.text = std::move(text);
  loaded.files = inputs.files();
  return loaded;
}

} // namespace steplap::study
