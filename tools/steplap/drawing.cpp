#include "tools/steplap/drawing.h"

#include "elements/step_lap_interface.h"
#include "elements/step_lap_joint.h"
#include "tools/steplap/core_drawing.h"
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace steplap {

namespace {

using Json = nlohmann::ordered_json;

Json point_json(const Vec2& p) { return Json::array({p.x(), p.y()}); }

Json outline_json(const std::vector<Vec2>& outline) {
  Json json = Json::array();
  for (const Vec2& p : outline)
    json.push_back(point_json(p));
  return json;
}

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Convex hull, counter-clockwise (A. M. Andrew, Inf. Process. Lett. 9 (1979) 216); two points of a line.
std::vector<Vec2> hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2> chain;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = chain.size();
    for (const Vec2& p : points) {
      while (chain.size() >= begin + 2 && cross(chain.back() - chain[chain.size() - 2], p - chain.back()) <= 0.0)
        chain.pop_back();
      chain.push_back(p);
    }
    chain.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return chain;
}

// A square with the body's radius of gyration: J/m = s²/6.
std::vector<Vec2> square(const Body& body) {
  const double half = body.mass > 0.0 ? 0.5 * std::sqrt(6.0 * body.inertia / body.mass) : 0.1;
  return {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
}

// How the kinds are usually drawn; a kind that is not listed shows as a rod between its places.
std::string usual_symbol(const std::string& kind) {
  static const std::map<std::string, std::string> symbols{
      {"spring_damper", "spring"}, {"rotational_spring_damper", "pin"}, {"bushing", "pin"},
      {"unilateral_contact", "contact"}, {"coulomb_stick", "friction"}, {"step_lap_joint", "joint"},
      {"step_lap_interface", "hidden"}, {"revolute", "pin"}, {"prismatic", "rail"}, {"weld", "weld"},
      {"distance", "rod"}, {"point_on_line", "rail"}, {"prescribed_motion", "arrow"}, {"load", "arrow"}};
  const auto found = symbols.find(kind);
  return found == symbols.end() ? "rod" : found->second;
}

// A marker where it sits: in its body's axes about the centre of gravity; the ground's own.
struct Place {
  std::string body;
  Vec2 point = Vec2::Zero();
  double angle = 0.0; ///< of the marker's axes against the body's
};

class Drawing {
public:
  explicit Drawing(const Model& model) : model_(model) {
    for (const Body& body : model.bodies)
      bodies_[body.name] = &body;
    for (const Marker& marker : model.markers)
      markers_[marker.name] = &marker;
  }

  Json json() {
    Json elements = Json::array();
    for (const ElementEntry& entry : model_.elements)
      elements.push_back(element_json(entry));
    return {{"bodies", bodies_json()}, // after the elements, whose places make outlines
            {"elements", std::move(elements)},
            {"sheets", sheets_json()},
            {"plots", plots_json()},
            {"cores", cores_json()},
            {"seen_from", model_.output.seen_from}};
  }

private:
  [[nodiscard]] Json cores_json() const {
    Json cores = Json::array();
    for (const TableEntry& entry : model_.tables)
      if (const auto* core = dynamic_cast<const Core*>(entry.table.get()))
        cores.push_back({{"name", core->name}, {"svg", core_svg(*core, model_)}});
    return cores;
  }
  [[nodiscard]] const Body* body(const std::string& name) const {
    const auto found = bodies_.find(name);
    return found == bodies_.end() ? nullptr : found->second;
  }

  // From the ground frame of the reference pose, or from the frame of a body.
  [[nodiscard]] static Vec2 about_centre(const Vec2& p, bool is_in_ground, const Body* body) {
    if (!body) return p;
    if (!is_in_ground) return p - body->cg;
    const Vec3 pose = body->reference_pose();
    return rotated(p - Vec2(pose.x(), pose.y()), -pose.z());
  }

  [[nodiscard]] Place place_of(const std::string& name) const {
    const Marker& marker = *markers_.at(name);
    const bool is_in_ground = !marker.point;
    return {marker.body, about_centre(is_in_ground ? *marker.at : *marker.point, is_in_ground, body(marker.body)),
            marker.angle};
  }

  Json element_json(const ElementEntry& entry) {
    const Element& element = *entry.element;
    Json json{{"name", element.name},
              {"kind", entry.kind->name},
              {"symbol", element.draw == "auto" ? usual_symbol(entry.kind->name) : element.draw}};
    Json at = Json::array();
    std::optional<Place> last;
    for (const Field& field : entry.kind->fields.fields()) {
      const FieldValue value = field.get(&element);
      if (field.type == FieldType::marker && !std::get<std::string>(value).empty()) {
        last = place_of(std::get<std::string>(value));
        places_[last->body].push_back(last->point);
        at.push_back({{"body", last->body}, {"point", point_json(last->point)}});
      }
      if (field.type == FieldType::body) json[field.name] = std::get<std::string>(value);
      if (field.type == FieldType::elements) json[field.name] = std::get<std::vector<std::string>>(value);
    }
    if (last) add_direction(entry, *last, json);
    json["at"] = std::move(at);
    return json;
  }

  // A contact's normal or the axis of a spring or joint: both in the axes of the last marker.
  void add_direction(const ElementEntry& entry, const Place& last, Json& json) {
    for (const char* name : {"normal", "axis"}) {
      const Field* field = entry.kind->fields.find(name);
      if (!field || field->type != FieldType::vec2) continue;
      const FieldValue value = field->get(entry.element.get());
      const Vec2* direction = std::get_if<Vec2>(&value);
      if (!direction || direction->norm() == 0.0) continue;
      json["direction"] = point_json(rotated(direction->normalized(), last.angle));
      return;
    }
  }

  std::vector<Vec2> outline_of(const Body& body) {
    std::vector<Vec2> outline;
    for (const Vec2& p : body.outline)
      outline.push_back(p - body.cg);
    if (!outline.empty()) return outline;
    std::vector<Vec2> places = places_[body.name];
    places.push_back(Vec2::Zero());
    outline = hull(std::move(places));
    return outline.size() < 2 ? square(body) : outline;
  }

  Json bodies_json() {
    Json json = Json::array();
    for (const Body& body : model_.bodies) {
      const Vec3 pose = body.reference_pose();
      json.push_back({{"name", body.name},
                      {"label", body.label},
                      {"pose", {pose.x(), pose.y(), pose.z()}},
                      {"fixed", body.fixed},
                      {"is_outline_given", !body.outline.empty()},
                      {"outline", outline_json(outline_of(body))}});
    }
    return json;
  }

  [[nodiscard]] std::vector<Vec2> sheet(const std::vector<Vec2>& corners, const std::string& frame,
                                        const std::string& owner) const {
    std::vector<Vec2> local;
    for (const Vec2& p : corners)
      local.push_back(about_centre(p, frame == "ground", body(owner)));
    return local;
  }

  // Of one sheet: round holes, as the polygons that count, and cutouts.
  [[nodiscard]] Json holes_json(const StepLapInterface& face, bool is_yoke, const std::string& owner) const {
    Json json = Json::array();
    for (const Vec2& centre : sheet(is_yoke ? face.yoke_holes : face.limb_holes, face.frame, owner))
      json.push_back(outline_json(round_hole(centre, face.hole_diameter, face.hole_sides)));
    for (const std::vector<Vec2>& cutout : is_yoke ? face.yoke_cutouts : face.limb_cutouts)
      json.push_back(outline_json(sheet(cutout, face.frame, owner)));
    return json;
  }

  Json sheets_json() const {
    std::map<std::string, const StepLapJoint*> joints;
    for (const ElementEntry& entry : model_.elements)
      if (const auto* joint = dynamic_cast<const StepLapJoint*>(entry.element.get())) joints[joint->name] = joint;
    Json json = Json::array();
    for (const ElementEntry& entry : model_.elements) {
      const auto* face = dynamic_cast<const StepLapInterface*>(entry.element.get());
      if (!face || joints.count(face->joint) == 0) continue;
      const StepLapJoint& joint = *joints[face->joint];
      json.push_back({{"name", face->name},
                      {"joint", joint.name},
                      {"limb", joint.limb},
                      {"active_part", joint.active_part},
                      {"count", face->count},
                      {"yoke", outline_json(sheet(face->yoke, face->frame, joint.active_part))},
                      {"limb_sheet", outline_json(sheet(face->limb, face->frame, joint.limb))},
                      {"yoke_holes", holes_json(*face, true, joint.active_part)},
                      {"limb_holes", holes_json(*face, false, joint.limb)}});
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
  std::map<std::string, const Body*> bodies_;
  std::map<std::string, const Marker*> markers_;
  std::map<std::string, std::vector<Vec2>> places_; ///< per body: where elements act
};

} // namespace

std::string drawing_json(const Model& model) {
  return Drawing(model).json().dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace steplap
