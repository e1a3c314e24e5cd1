#include "elements/drawn_outline.h"

#include "mbd/io/dxf.h"
#include "mbd/io/named_file.h"

#include <algorithm>

namespace steplap {

namespace {

void apply_drawing(const DrawnOutline& drawing, Model& model) {
  const auto fail = [&](const std::string& field, const std::string& message) {
    throw ModelError(drawing.place(field), "drawing '" + drawing.name + "': " + message);
  };
  const auto body = std::find_if(model.bodies.begin(), model.bodies.end(), [&](const Body& b) { return b.name == drawing.body; });
  if (body == model.bodies.end()) return fail("body", "the ground has no outline: name a body");
  if (!body->outline.empty()) return fail("body", "body '" + drawing.body + "' has an outline already: give one of them");
  const std::string text = read_named_file(drawing.file, drawing.place("file"), "the drawing ", drawing.sha256);
  body->outline = parse_dxf_outline(text, drawing.file, drawing.layer, drawing.unit, drawing.place("layer"));
  for (Vec2& corner : body->outline) corner -= drawing.origin;
}

} // namespace

const TableKind& drawn_outline_kind() {
  static const TableKind kind = [] {
    using T = DrawnOutline;
    TableKind k;
    k.name = "drawing";
    k.doc = "The outline of a body from a drawing: the closed polyline that is alone on a layer of an ASCII DXF file.";
    FieldTable& f = k.fields;
    f.add("body", &T::body).as(FieldType::body).required().doc("the body that gets the outline");
    f.add("file", &T::file).as(FieldType::file).required().doc("DXF file, relative to the model file");
    f.add("layer", &T::layer).required().doc("its layer with an LWPOLYLINE or POLYLINE without arcs");
    f.add("unit", &T::unit)
        .one_of({"", "mm", "cm", "dm", "m", "km", "in", "ft", "yd"})
        .doc("unit of the drawing, where its $INSUNITS states none");
    f.add("origin", &T::origin).in("m").doc("where the drawing has the origin of the body's frame");
    f.add("sha256", &T::sha256).doc("SHA-256 of the file, as sha256sum prints it: another content is refused. Results give it");
    k.holds<T>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element& table, Model& model) { apply_drawing(static_cast<const T&>(table), model); };
    return k;
  }();
  return kind;
}

} // namespace steplap
