#include "mbd/run/drawing.h"

#include "mbd/io/look.h"
#include "mbd/run/ordered_json.h"
#include "mbd/run/sketch.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

namespace steplap {

namespace {

using Json = nlohmann::ordered_json;

Json point_json(const Vec2& p) { return Json::array({p.x(), p.y()}); }

Json outline_json(const std::vector<Vec2>& outline) {
  Json json = Json::array();
  for (const Vec2& p : outline) json.push_back(point_json(p));
  return json;
}

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Returns the convex hull, counter-clockwise (A. M. Andrew, Inf. Process. Lett. 9 (1979) 216); two points if all points are on a line.
std::vector<Vec2> hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2> chain;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = chain.size();
    for (const Vec2& p : points) {
      while (chain.size() >= begin + 2 && cross(chain.back() - chain[chain.size() - 2], p - chain.back()) <= 0.0) chain.pop_back();
      chain.push_back(p);
    }
    chain.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return chain;
}

// Rounds to multiples of 1e-9, so that contact planes that differ by rounding become equal.
long long coarse(double value) { return std::llround(1e9 * value); }

class Drawing {
public:
  Drawing(const Model& model, const KindViews& views) : model_(model), views_(views) {
    for (const Body& body : model.bodies) bodies_[body.name] = &body;
    for (const Marker& marker : model.markers) markers_[marker.name] = &marker;
  }

  // Elements and bodies become text one by one, because their trees take ten times as much memory.
  void write(const FileSink& put) {
    put("{\"elements\":"); // before the bodies, whose geometry they define
    write_list(model_.elements, put, [this](const ElementEntry& entry) { return element_json(entry); });
    put(",\"bodies\":");
    write_list(model_.bodies, put, [this](const Body& body) { return body_json(body); });
    Json json = object_with_room(8);
    append(json, "ground") = ground_json();
    append(json, "planes") = planes_;
    append(json, "sheets") = sheets_json();
    append(json, "plots") = plots_json();
    append(json, "cores") = cores_json();
    append(json, "looks") = looks_json();
    append(json, "seen_from") = model_.output.seen_from;
    append(json, "gravity") = point_json(model_.header.gravity);
    put("," + text_of(json).substr(1) + "\n");
  }

private:
  // Invalid UTF-8 in names is replaced.
  [[nodiscard]] static std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }
  template <class Entries, class Make> static void write_list(const Entries& entries, const FileSink& put, const Make& make) {
    constexpr std::size_t k_piece = 1 << 16; // bytes
    std::string piece;
    const char* before = "[";
    for (const auto& entry : entries) {
      piece.append(std::exchange(before, ",")).append(text_of(make(entry)));
      if (piece.size() < k_piece) continue;
      put(piece);
      piece.clear();
    }
    put(piece.append(entries.empty() ? "[]" : "]"));
  }
  [[nodiscard]] Json cores_json() const {
    Json cores = Json::array();
    for (const TableEntry& entry : model_.tables)
      if (const auto sheet = views_.sheets.find(entry.kind); sheet != views_.sheets.end())
        cores.push_back({{"name", entry.table->name}, {"svg", sheet->second(*entry.table, model_)}});
    return cores;
  }
  [[nodiscard]] Json look_json(const Look& look) const {
    const Body* const carrier = body(look.body);
    const Vec2 cg = carrier ? carrier->cg : Vec2(Vec2::Zero());
    Json json{{"name", look.name}, {"body", look.body}, {"draw", look.draw}, {"at", Json::array()}};
    for (const Vec2& place : places_of(look)) json["at"].push_back(point_json(place - cg));
    if (look.size) json["size"] = point_json(*look.size);
    if (look.radius) json["radius"] = *look.radius;
    if (look.wall) json["wall"] = *look.wall;
    if (look.oil) json["oil"] = *look.oil - cg.y();
    return json;
  }
  [[nodiscard]] Json looks_json() const {
    Json looks = Json::array();
    for (const TableEntry& entry : model_.tables)
      if (entry.kind == &look_kind()) looks.push_back(look_json(static_cast<const Look&>(*entry.table)));
    return looks;
  }
  [[nodiscard]] const Body* body(const std::string& name) const {
    const auto found = bodies_.find(name);
    return found == bodies_.end() ? nullptr : found->second;
  }

  // Transforms a point to the body's axes about its centre of gravity: from ground axes in the reference pose, or from the frame of the
  // body.
  [[nodiscard]] static Vec2 about_centre(const Vec2& p, bool is_in_ground, const Body* body) {
    if (!body) return p;
    if (!is_in_ground) return p - body->cg;
    const Vec3 pose = body->reference_pose();
    return rotated(p - Vec2(pose.x(), pose.y()), -pose.z());
  }

  [[nodiscard]] MarkerPlace place_of(const std::string& name) const {
    const Marker& marker = *markers_.at(name);
    const bool is_in_ground = !marker.point;
    const Body* const carrier = body(marker.body);
    const Vec2 point = about_centre(is_in_ground ? *marker.at : *marker.point, is_in_ground, carrier);
    if (!carrier) return {marker.body, point, marker.angle, point, marker.angle};
    const Vec3 pose = carrier->reference_pose();
    return {marker.body, point, marker.angle, Vec2(pose.x(), pose.y()) + rotated(point, pose.z()), pose.z() + marker.angle};
  }

  [[nodiscard]] static Json places_json(const std::vector<MarkerPlace>& places) {
    Json json = Json::array();
    for (const MarkerPlace& place : places) json.push_back({{"body", place.body}, {"point", point_json(place.point)}});
    return json;
  }

  Json element_json(const ElementEntry& entry) {
    Sketch sketch(
        entry, [this](const std::string& marker) { return place_of(marker); },
        [this](const std::string& body) -> BodyGeometry& { return geometry_[body]; });
    draw_element(sketch, views_.of(*entry.kind).draw);
    Json json = object_with_room(12);
    append(json, "name") = entry.element->name;
    append(json, "kind") = entry.kind->name;
    append(json, "symbol") = sketch.shapes().empty() ? "hidden" : sketch.shapes().front().type;
    Json shapes = Json::array();
    for (const Shape& shape : sketch.shapes()) shapes.push_back(shape_json(shape));
    json["shapes"] = std::move(shapes);
    for (const Field& field : entry.kind->fields.fields()) {
      const bool is_name = field.type == FieldType::body || field.type == FieldType::signal || field.name == "as";
      if (is_name) json[field.name] = std::get<std::string>(field.get(entry.element.get()));
      if (field.type == FieldType::elements) json[field.name] = std::get<std::vector<std::string>>(field.get(entry.element.get()));
    }
    json["at"] = places_json(sketch.places());
    return json;
  }

  Json shape_json(const Shape& shape) {
    Json json = object_with_room(7);
    append(json, "type") = shape.type;
    append(json, "at") = places_json(shape.at);
    if (!shape.style.empty()) json["style"] = shape.style;
    if (!shape.quantity.empty()) json["quantity"] = shape.quantity;
    if (shape.direction) json["direction"] = point_json(*shape.direction);
    if (!shape.sizes.empty()) json["sizes"] = shape.sizes;
    const bool has_plane = shape.type == "contact" || shape.type == "faces";
    if (has_plane && shape.direction && !shape.at.empty()) json["plane"] = plane_of(shape.at.back(), *shape.direction, shape.sizes);
    return json;
  }

  // Returns the index of the half-plane of a contact. Contacts with the same line of a body share one half-plane.
  std::size_t plane_of(const MarkerPlace& place, const Vec2& normal, const std::vector<double>& ends) {
    std::vector<long long> key{coarse(normal.x()), coarse(normal.y()), coarse(normal.dot(place.point))};
    const double along = Vec2(normal.y(), -normal.x()).dot(place.point);
    for (const double end : ends) key.push_back(coarse(along + end));
    const auto [found, is_new] = plane_numbers_.try_emplace({place.body, std::move(key)}, planes_.size());
    if (is_new) planes_.push_back({{"body", place.body}, {"point", point_json(place.point)}, {"normal", point_json(normal)}});
    if (is_new && !ends.empty()) planes_.back()["ends"] = ends;
    return found->second;
  }

  // Returns a rectangle about the centre of gravity for a body without outline. Its size follows from the moment of inertia J = m (a² +
  // b²)/12 and the points at which elements act: b is the height of these points, and a follows from J; without a height a is their width.
  // If J is too small for the rectangle to contain the points, it is as large as J permits. Returns nothing if all points are at the centre
  // of gravity, if J is that of a slender rod between them, or if J is that of a body k_most_growth times as large as the points.
  [[nodiscard]] static std::vector<Vec2> rectangle_of(const Body& body, const std::vector<Vec2>& places) {
    constexpr double k_most_growth = 3.0, k_slender = 0.02;
    if (body.fixed) return {};
    Vec2 sides = Vec2::Zero();
    for (const Vec2& p : places) sides = sides.cwiseMax(2.0 * p.cwiseAbs());
    const double reached = sides.norm(), square = 12.0 * body.inertia / body.mass, diagonal = std::sqrt(square);
    if (reached == 0.0 || diagonal > k_most_growth * reached) return {};
    const int given = sides.y() > k_slender * reached ? 1 : 0, free = 1 - given;
    if (diagonal > reached) sides[free] = std::sqrt(square - sides[given] * sides[given]);
    else sides *= diagonal / reached;
    if (sides.minCoeff() <= k_slender * sides.maxCoeff()) return {};
    const Vec2 half = 0.5 * sides;
    return {-half, {half.x(), -half.y()}, half, {-half.x(), half.y()}};
  }

  // Returns the given outline. Without one the result is a rectangle (rectangle_of) or, for bodies with other geometry from elements, the
  // convex hull of the centre of gravity and of the points of elements outside all circles of the body.
  [[nodiscard]] static std::vector<Vec2> outline_of(const Body& body, const BodyGeometry& geometry) {
    std::vector<Vec2> outline;
    for (const Vec2& p : body.outline) outline.push_back(p - body.cg);
    if (!outline.empty() || !geometry.polygons.empty()) return outline;
    const auto is_covered = [&](const Vec2& p) {
      return std::any_of(geometry.circles.begin(), geometry.circles.end(), [&](const std::array<double, 4>& circle) {
        return (p - Vec2(circle[0], circle[1])).norm() <= circle[2] * (1.0 + 1e-9);
      });
    };
    std::vector<Vec2> places;
    for (const Vec2& p : geometry.places)
      if (!is_covered(p)) places.push_back(p);
    if (places.empty()) return {};
    const bool is_bare = geometry.circles.empty() && geometry.segments.empty();
    if (outline = is_bare ? rectangle_of(body, places) : outline; !outline.empty()) return outline;
    places.push_back(Vec2::Zero());
    outline = hull(std::move(places));
    return outline.size() < 2 ? std::vector<Vec2>() : outline;
  }

  static void add_geometry(const BodyGeometry& geometry, Json& json) {
    json["circles"] = geometry.circles;
    json["segments"] = geometry.segments;
    json["polygons"] = geometry.polygons;
  }

  Json body_json(const Body& body) {
    const Vec3 pose = body.reference_pose();
    const BodyGeometry& geometry = geometry_[body.name];
    Json entry = object_with_room(10);
    append(entry, "name") = body.name;
    append(entry, "label") = body.label;
    append(entry, "pose") = {pose.x(), pose.y(), pose.z()};
    append(entry, "fixed") = body.fixed;
    append(entry, "is_outline_given") = !body.outline.empty();
    append(entry, "outline") = outline_json(outline_of(body, geometry));
    add_geometry(geometry, entry);
    Json& holes = append(entry, "holes") = Json::array();
    for (const auto openings_of : views_.openings)
      for (const std::vector<Vec2>& opening : openings_of(body, model_)) holes.push_back(outline_json(opening));
    return entry;
  }

  Json ground_json() {
    Json json = Json::object();
    add_geometry(geometry_["ground"], json);
    return json;
  }

  // Transforms points of a sheet to the axes of the body that carries it, about its centre of gravity.
  [[nodiscard]] std::vector<Vec2> sheet(const std::vector<Vec2>& corners, bool is_in_ground, const std::string& owner) const {
    std::vector<Vec2> local;
    for (const Vec2& p : corners) local.push_back(about_centre(p, is_in_ground, body(owner)));
    return local;
  }

  // Returns the holes of one sheet: round holes as polygons, then cutouts.
  [[nodiscard]] Json holes_json(const DrawnSheets& pair, bool is_yoke, const std::string& owner) const {
    Json json = Json::array();
    for (const Vec2& centre : sheet(is_yoke ? pair.yoke_holes : pair.limb_holes, pair.is_in_ground, owner)) {
      std::vector<Vec2> hole = pair.hole;
      for (Vec2& corner : hole) corner += centre;
      json.push_back(outline_json(hole));
    }
    for (const std::vector<Vec2>& cutout : is_yoke ? pair.yoke_cutouts : pair.limb_cutouts)
      json.push_back(outline_json(sheet(cutout, pair.is_in_ground, owner)));
    return json;
  }

  Json sheets_json() const {
    Json json = Json::array();
    for (const ElementEntry& entry : model_.elements) {
      const auto sheets_of = views_.of(*entry.kind).sheets;
      const std::optional<DrawnSheets> sheets = sheets_of ? sheets_of(*entry.element, model_) : std::nullopt;
      if (!sheets) continue;
      Json pair = object_with_room(9);
      append(pair, "name") = entry.element->name;
      append(pair, "joint") = sheets->joint;
      append(pair, "limb") = sheets->limb;
      append(pair, "active_part") = sheets->active_part;
      append(pair, "count") = sheets->count;
      append(pair, "yoke") = outline_json(sheet(sheets->yoke, sheets->is_in_ground, sheets->active_part));
      append(pair, "limb_sheet") = outline_json(sheet(sheets->limb_sheet, sheets->is_in_ground, sheets->limb));
      append(pair, "yoke_holes") = holes_json(*sheets, true, sheets->active_part);
      append(pair, "limb_holes") = holes_json(*sheets, false, sheets->limb);
      json.push_back(std::move(pair));
    }
    return json;
  }

  Json plots_json() const {
    Json json = Json::array();
    for (const Plot& plot : model_.plots)
      json.push_back({{"name", plot.name}, {"title", plot.title}, {"channels", plot.channels}, {"bounds", plot.bounds}});
    return json;
  }

  const Model& model_;
  const KindViews& views_;
  std::map<std::string, const Body*> bodies_;
  std::map<std::string, const Marker*> markers_;
  std::unordered_map<std::string, BodyGeometry> geometry_; ///< per body, including the ground
  std::map<std::pair<std::string, std::vector<long long>>, std::size_t> plane_numbers_;
  Json planes_ = Json::array();
};

} // namespace

void write_drawing(const Model& model, const KindViews& views, const FileSink& put) { Drawing(model, views).write(put); }

std::string drawing_json(const Model& model, const KindViews& views) {
  std::string text;
  write_drawing(model, views, [&text](std::string_view piece) { text += piece; });
  return text;
}

} // namespace steplap
