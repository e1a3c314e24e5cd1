#include "mbd/io/look.h"

#include <algorithm>
#include <utility>

namespace steplap {

namespace {

// A kind of part, with the name of the field that gives its size; "": its size is fixed.
struct Part {
  std::string name, size_field;
};

const std::vector<Part>& parts() {
  static const std::vector<Part> list{{"wheel", "radius"}, {"winding", "size"}, {"wood", "size"}, {"foot", "size"},
                                      {"tank", "wall"},    {"road", ""},        {"rail", ""}};
  return list;
}

std::vector<std::string> part_names() {
  std::vector<std::string> names;
  for (const Part& part : parts()) names.push_back(part.name);
  return names;
}

[[noreturn]] void fail(const Look& look, const std::string& field, const std::string& message) {
  throw ModelError(look.place(field), "look '" + look.name + "': " + message);
}

void check(const Look& look, const Model& model) {
  const auto part = std::find_if(parts().begin(), parts().end(), [&](const Part& p) { return look.draw == p.name; });
  const std::string quoted = "draw = \"" + look.draw + "\"";
  const std::pair<std::string, bool> sizes[] = {
      {"radius", look.radius.has_value()}, {"size", look.size.has_value()}, {"wall", look.wall.has_value()}};
  for (const auto& [field, is_given] : sizes) {
    if (field == part->size_field && !is_given) fail(look, "draw", quoted + " needs '" + field + "'");
    if (field != part->size_field && is_given) fail(look, field, "'" + field + "' does not go with " + quoted);
  }
  if (look.size && !(look.size->minCoeff() > 0.0)) fail(look, "size", "width and height must be positive");
  if (look.oil && look.draw != "tank") fail(look, "oil", "'oil' does not go with " + quoted);
  if ((look.count > 1) != look.pitch.has_value()) fail(look, look.pitch ? "pitch" : "count", "a 'count' above 1 and 'pitch' go together");
  const Body* const body = model.find_body(look.body);
  if (look.draw == "tank" && (!body || body->outline.empty()))
    fail(look, "body", "a tank is drawn along the outline of its body: give '" + look.body + "' an 'outline'");
}

} // namespace

std::vector<Vec2> places_of(const Look& look) {
  std::vector<Vec2> places;
  for (long k = 0; k < look.count; ++k)
    places.push_back(look.at + Vec2((static_cast<double>(k) - 0.5 * static_cast<double>(look.count - 1)) * look.pitch.value_or(0.0), 0.0));
  return places;
}

const TableKind& look_kind() {
  static const TableKind kind = [] {
    using T = Look;
    TableKind k;
    k.name = "look";
    k.doc = "What a part of a body is, for drawings: wheels, windings, wooden blocks, feet, a tank with its wall and oil, a road or rail. "
            "Several looks of one body add up. They have no mass and do not affect the motion.";
    FieldTable& f = k.fields;
    f.add("body", &T::body).as(FieldType::body).required().doc("the body that it is a part of, or 'ground'");
    f.add("draw", &T::draw).one_of(part_names()).required().doc("what it is");
    f.add("at", &T::at).in("m").doc("its middle, or that of the row, in the body's frame; of a road or rail a point of its level surface");
    f.add("size", &T::size).in("m").doc("width and height of a winding, wooden block or foot");
    f.add("radius", &T::radius).in("m").positive().doc("of a wheel");
    f.add("wall", &T::wall).in("m").positive().doc("thickness of a tank's wall, inwards from the body's outline");
    f.add("oil", &T::oil).in("m").doc("level of the oil in a tank, y in the body's frame; left out: no oil");
    f.add("count", &T::count).at_least(1).at_most(100).doc("equal parts in a row along the body's x axis");
    f.add("pitch", &T::pitch).in("m").positive().doc("distance between neighbours of the row");
    k.holds<T>();
    k.reads_masses = false;
    k.reads_elements = false;
    k.apply = [](const Element& table, Model& model) { check(static_cast<const T&>(table), model); };
    return k;
  }();
  return kind;
}

} // namespace steplap
