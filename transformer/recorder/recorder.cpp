#include "transformer/recorder/recorder.h"

#include <algorithm>

namespace steplap {

namespace {

// Returns "z" for "-z".
std::string letter_of(const std::string& axis) { return axis.substr(axis.starts_with('-') ? 1 : 0); }

void check(const Recorder& recorder, const Model& model) {
  std::vector<Diagnostic> problems;
  const auto wrong = [&](const char* field, const std::string& message) { problems.push_back({recorder.place(field), message}); };
  const auto marker =
      std::find_if(model.markers.begin(), model.markers.end(), [&](const Marker& each) { return each.name == recorder.marker; });
  const Body* const body = marker == model.markers.end() ? nullptr : model.find_body(marker->body);
  if (marker != model.markers.end() && (!body || body->fixed))
    wrong("marker", "the recorder '" + recorder.name + "' sits on '" + marker->body + "', which never moves: give a marker of the tank");
  if (recorder.x != "none" && letter_of(recorder.x) == letter_of(recorder.y))
    wrong("y",
          "the recorder '" + recorder.name + "' has its axis " + letter_of(recorder.x) + " along x and along y: they are different axes");
  for (const std::string* const axis : {&recorder.x, &recorder.y})
    if (recorder.across != "none" && letter_of(recorder.across) == letter_of(*axis))
      wrong("across", "the recorder '" + recorder.name + "' has its axis " + letter_of(*axis) +
                          " in the plane and across it: they are different axes");
  if (recorder.x == "none" && recorder.y == "none")
    wrong("x", "the recorder '" + recorder.name + "' has no axis in the plane of the model: give x, y or both");
  const auto is_recorder = [](const TableEntry& entry) { return entry.kind == &recorder_kind(); };
  const auto first = std::find_if(model.tables.begin(), model.tables.end(), is_recorder);
  if (first != model.tables.end() && first->table->name != recorder.name)
    problems.push_back({recorder.where, "a second recorder, '" + recorder.name + "' beside '" + first->table->name +
                                            "': one place of a rigid tank is driven, so give one recorder for each model"});
  if (!problems.empty()) throw ModelError(std::move(problems));
}

} // namespace

const TableKind& recorder_kind() {
  static const TableKind kind = [] {
    using T = Recorder;
    TableKind k;
    k.name = "recorder";
    k.doc = "A shock recorder on the tank: where it sat and which way it pointed. Usual runs take no notice of it. `steplap assess` drives "
            "its body by the recorded acceleration, from static equilibrium, event after event.";
    FieldTable& f = k.fields;
    const std::vector<std::string> axes = {"none", "x", "-x", "y", "-y", "z", "-z"};
    f.add("marker", &T::marker).as(FieldType::marker).required().doc("where the recorder sat; its axes count");
    f.add("x", &T::x).one_of(axes).required().doc("axis of the record that points along the marker's x; none: no motion that way");
    f.add("y", &T::y).one_of(axes).required().doc("axis of the record that points along the marker's y");
    f.add("across", &T::across)
        .one_of(axes)
        .doc("axis of the record that points out of the plane, from the front face of the core to the back: it takes the place of "
             "every transverse_acceleration of the model");
    f.add("plane", &T::plane).doc("what people call the plane of the model: lengthwise, crosswise");
    f.add("replaces", &T::replaces)
        .as(FieldType::elements)
        .doc("elements that the record takes the place of: drives, loads and suspensions of the tank");
    f.add("mounted", &T::mounted)
        .one_of({"lid", "frame"})
        .doc("frame: the frame or the bottom of the tank. With a recorder on the lid a margin of a joint below 1.5 is not known");
    f.add("rotation", &T::rotation)
        .one_of({"held", "free"})
        .doc("of the driven body: held: it keeps its angle; free: it turns as what else acts on it makes it turn");
    f.add("drift", &T::drift)
        .one_of({"none", "line"})
        .doc("of each event: none: as recorded; line: less a constant, so that velocity ends where it began");
    f.add("settle", &T::settle).in("s").not_negative().doc("run on after each event, for the machine to come to rest before the next");
    f.add("knows_not", &T::knows_not).doc("effects that the model omits, listed with the decision");
    k.holds<T>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element& table, Model& model) { check(static_cast<const Recorder&>(table), model); };
    return k;
  }();
  return kind;
}

const Recorder* recorder_of(const Model& model) {
  for (const TableEntry& entry : model.tables)
    if (entry.kind == &recorder_kind()) return static_cast<const Recorder*>(entry.table.get());
  return nullptr;
}

} // namespace steplap
