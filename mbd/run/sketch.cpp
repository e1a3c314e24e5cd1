#include "mbd/run/sketch.h"

#include <utility>

namespace steplap {

namespace {

void neutral(Sketch& s) { s.draw({"neutral", "", "", s.places(), {}, {}}); }

// Returns the shape that the element's field `draw` requests. Quantity, position and direction are those of the usual drawing `as_usual`.
Shape asked_for(const Sketch& as_usual, const std::string& type) {
  Shape shape{type, "", "", as_usual.places(), {}, {}};
  for (const char* field : {"normal", "axis"})
    if (!shape.direction) shape.direction = as_usual.direction(field);
  if (!as_usual.shapes().empty()) shape.quantity = as_usual.shapes().front().quantity;
  return shape;
}

} // namespace

Sketch::Sketch(const ElementEntry& entry, PlaceOf place_of, GeometryOf geometry_of)
    : entry_(&entry), place_of_(std::move(place_of)), geometry_of_(std::move(geometry_of)) {}

template <class T> std::optional<T> Sketch::value(const char* field) const {
  const Field* found = entry_->kind->fields.find(field);
  if (!found) return std::nullopt;
  const FieldValue value = found->get(entry_->element.get());
  const T* held = std::get_if<T>(&value);
  return held ? std::optional<T>(*held) : std::nullopt;
}

double Sketch::number(const char* field) const { return value<double>(field).value_or(0.0); }
std::optional<double> Sketch::given_number(const char* field) const { return value<double>(field); }
bool Sketch::is(const char* field) const { return value<bool>(field).value_or(false); }
std::string Sketch::text(const char* field) const { return value<std::string>(field).value_or(""); }
bool Sketch::is_given(const char* field) const { return !text(field).empty(); }
std::optional<Vec2> Sketch::vector(const char* field) const { return value<Vec2>(field); }
std::vector<Vec2> Sketch::points(const char* field) const { return value<std::vector<Vec2>>(field).value_or(std::vector<Vec2>()); }
std::vector<std::string> Sketch::texts(const char* field) const {
  return value<std::vector<std::string>>(field).value_or(std::vector<std::string>());
}

std::optional<MarkerPlace> Sketch::place(const char* field) const {
  const std::string marker = text(field);
  return marker.empty() ? std::nullopt : std::optional<MarkerPlace>(place_of_(marker));
}

std::vector<MarkerPlace> Sketch::places() const {
  std::vector<MarkerPlace> places;
  for (const Field& field : entry_->kind->fields.fields())
    if (field.type == FieldType::marker)
      if (const auto found = place(field.name.c_str())) places.push_back(*found);
  return places;
}

std::optional<Vec2> Sketch::direction(const char* field) const {
  const auto given = vector(field);
  const auto b = place("b");
  if (!given || !b || given->norm() == 0.0) return std::nullopt;
  return b->turned(given->normalized());
}

Shape& Sketch::draw(Shape shape) { return shapes_.emplace_back(std::move(shape)); }

void Sketch::size_last(std::vector<double> sizes) {
  if (!shapes_.empty()) shapes_.back().sizes = std::move(sizes);
}

void Sketch::circle(const MarkerPlace& centre, double radius, bool is_ring) {
  geometry_of_(centre.body).circles.insert({centre.point.x(), centre.point.y(), radius, is_ring ? 1.0 : 0.0});
}

void Sketch::segment(const MarkerPlace& frame, const Vec2& from, const Vec2& to, double thickness) {
  const Vec2 first = frame.in_body(from), last = frame.in_body(to);
  geometry_of_(frame.body).segments.insert({first.x(), first.y(), last.x(), last.y(), thickness});
}

void Sketch::polygon(const MarkerPlace& frame, const std::vector<Vec2>& corners) {
  std::vector<std::array<double, 2>> ring;
  for (const Vec2& corner : corners) {
    const Vec2 p = frame.in_body(corner);
    ring.push_back({p.x(), p.y()});
  }
  if (!ring.empty()) geometry_of_(frame.body).polygons.insert(std::move(ring));
}

void draw_element(Sketch& sketch, void (*draw)(Sketch&)) {
  for (const MarkerPlace& place : sketch.places()) sketch.note_place(place);
  (draw ? draw : neutral)(sketch);
  const std::string& asked = sketch.entry().element->draw;
  if (asked != "auto") sketch.replace(asked == "hidden" ? std::vector<Shape>() : std::vector<Shape>{asked_for(sketch, asked)});
}

} // namespace steplap
