#include "tools/assess/static_preset.h"

#include "mbd/base/diagnostics.h"
#include "mbd/io/document.h"
#include "mbd/io/field_reader.h"

#include <cmath>
#include <set>
#include <stdexcept>

namespace steplap::assess {

namespace {

constexpr double k_g = 9.81;   // 1 g, m/s²; equal to the models' gravity, so that 1 g upwards cancels the weight exactly
constexpr double k_most = 1e4; // largest value accepted, m/s²

// Returns eight loads of magnitude a, m/s²: along the axes and at 45° between them.
std::vector<StaticLoad> all_round(double a) {
  const double half = a * std::sqrt(0.5);
  return {
      {"forward", {a, 0.0}, ""}, {"forward and up", {half, half}, ""},  {"up", {0.0, a}, ""},    {"back and up", {-half, half}, ""},
      {"back", {-a, 0.0}, ""},   {"back and down", {-half, -half}, ""}, {"down", {0.0, -a}, ""}, {"forward and down", {half, -half}, ""}};
}

// Returns the loads of road transport. The standard requires 0.6 g only for loads that may tip. It is applied to all loads, because these
// are not known in advance; this is conservative for sliding.
std::vector<StaticLoad> road() {
  return {{"forward", {0.8 * k_g, 0.0}, "lengthwise"},
          {"back", {-0.5 * k_g, 0.0}, "lengthwise"},
          {"to the right", {0.5 * k_g, 0.0}, "transverse"},
          {"to the left", {-0.5 * k_g, 0.0}, "transverse"},
          {"tipping to the right", {0.6 * k_g, 0.0}, "transverse"},
          {"tipping to the left", {-0.6 * k_g, 0.0}, "transverse"}};
}

// Returns the loads of sea transport: the largest value of the table for each axis, with the ship's heave upwards, downwards and zero.
std::vector<StaticLoad> sea() {
  constexpr double k_along = 3.8, k_across = 7.4, k_up = 9.2; // largest accelerations along, across and normal to the ship's deck, m/s²
  std::vector<StaticLoad> loads;
  for (const bool is_along : {true, false})
    for (const double side : {1.0, -1.0})
      for (const double heave : {0.0, 1.0, -1.0}) {
        const std::string way = is_along ? (side > 0.0 ? "forward" : "back") : side > 0.0 ? "to the right" : "to the left";
        const std::string heaving = heave == 0.0 ? "" : heave > 0.0 ? ", heave up" : ", heave down";
        loads.push_back({way + heaving, {side * (is_along ? k_along : k_across), heave * k_up}, is_along ? "lengthwise" : "transverse"});
      }
  return loads;
}

struct PresetHeader {
  std::string name, source;
};

class PresetReader {
public:
  explicit PresetReader(const std::string& path) : document_(load_document(path)), path_(path) { refuse_control_characters(document_); }

  StaticPreset read() {
    problems_ = std::move(document_.problems);
    PresetHeader header;
    FieldTable fields;
    fields.add("name", &PresetHeader::name).required().doc("what results call these loads");
    fields.add("source", &PresetHeader::source).required().doc("who requires them, by which document");
    TableReading reading;
    reading.subject = "the loads";
    reading.known_keys = {"case"};
    read_fields(document_.root, fields, &header, reading, problems_);
    preset_ = {header.name, header.source, {}};
    read_loads();
    if (!problems_.empty()) throw ModelError(std::move(problems_));
    return preset_;
  }

private:
  void read_loads() {
    const Node* const array = document_.root.find("case");
    if (!array || !array->is_array_of_tables()) {
      Location where = array ? array->where() : document_.root.where();
      if (where.file.empty()) where.file = path_;
      problems_.push_back(
          {where, "there are no loads: give each as [[case]] with a name and 'pull', its two accelerations in addition to gravity"});
      return;
    }
    FieldTable fields;
    fields.add("name", &StaticLoad::name).required().doc("what results call it");
    fields.add("pull", &StaticLoad::pull).in("m/s^2").required().doc("acceleration of everything along x and y, in addition to gravity");
    fields.add("plane", &StaticLoad::plane).one_of({"", "lengthwise", "transverse"}).doc("of the models that it is for; both if not given");
    std::set<std::string> names;
    for (const Node& entry : array->children) {
      StaticLoad load;
      const std::size_t before = problems_.size();
      TableReading reading;
      reading.subject = "case '" + entry_name(entry) + "'";
      read_fields(entry, fields, &load, reading, problems_);
      if (problems_.size() > before) continue;
      if (!(std::abs(load.pull.x()) <= k_most && std::abs(load.pull.y()) <= k_most))
        problems_.push_back(
            {entry.where(), "'pull' of case '" + load.name + "' is beyond 10000 m/s^2: is the unit right? \"0.8 gravity\" is 7.8 m/s^2"});
      if (!load.plane.empty() && load.plane != name_of(Plane::lengthwise) && load.plane != name_of(Plane::transverse))
        problems_.push_back({entry.find("plane")->where(), "'plane' of case '" + load.name + "' is '" + load.plane +
                                                               "': give lengthwise or transverse, or leave it out for both"});
      if (!names.insert(load.name).second)
        problems_.push_back({entry.where(), "there are two cases '" + load.name + "': give each its own name"});
      preset_.loads.push_back(std::move(load));
    }
  }

  Document document_;
  std::string path_;
  StaticPreset preset_;
  std::vector<Diagnostic> problems_;
};

} // namespace

const char* name_of(Plane plane) { return plane == Plane::lengthwise ? "lengthwise" : "transverse"; }

const std::vector<StaticPreset>& static_presets() {
  static const std::vector<StaticPreset> k_presets = {
      {"iec-1g",
       "1 g in every direction in addition to gravity, as IEC 60076-1:2011, 5.7.4.2 is commonly quoted (the text itself was not read)",
       all_round(k_g)},
      {"road",
       "EN 12195-1 as a training course on the CTU code quotes it (the text itself was not read): 0.8 g forward, 0.5 g back, 0.5 g "
       "sideways "
       "and 0.6 g sideways against tipping, weight once; a load that slides between 0.5 and 0.6 g sideways does not hold",
       road()},
      {"sea",
       "CSS code, annex 13, basic accelerations (from memory, not read): the largest of any place on board, 3.8 m/s^2 lengthwise, 7.4 "
       "m/s^2 "
       "across, 9.2 m/s^2 of heave; a known place has less",
       sea()}};
  return k_presets;
}

StaticPreset static_preset(const std::string& name_or_file) {
  if (name_or_file.size() > 5 && name_or_file.ends_with(".toml")) return PresetReader(name_or_file).read();
  std::string known;
  for (const StaticPreset& preset : static_presets()) {
    if (preset.name == name_or_file) return preset;
    known += preset.name + ", ";
  }
  throw std::invalid_argument("'" + name_or_file + "' is no preset of static loads: take one of " + known +
                              "or name a file of your own that ends with .toml. Those of the CTU code for rail and sea areas are not built "
                              "in, because its table of accelerations was not read");
}

std::vector<StaticLoad> loads_for(const StaticPreset& preset, Plane plane) {
  std::vector<StaticLoad> loads;
  for (const StaticLoad& load : preset.loads)
    if (load.plane.empty() || load.plane == name_of(plane)) loads.push_back(load);
  if (loads.empty()) throw std::invalid_argument("'" + preset.name + "' has no load for a model of the " + name_of(plane) + " plane");
  return loads;
}

bool depends_on_plane(const StaticPreset& preset) {
  for (const StaticLoad& load : preset.loads)
    if (!load.plane.empty()) return true;
  return false;
}

} // namespace steplap::assess
