#include "mbd/model/placement.h"

#include <deque>
#include <unordered_map>

namespace steplap {

namespace {

constexpr std::size_t k_nobody = static_cast<std::size_t>(-1); // index of the ground

// A joint that prescribes a relative pose, with its two bodies: an edge of the graph of bodies.
struct Edge {
  std::size_t element = 0;
  const PlacingElement* joint = nullptr;
  const ElementKind* kind = nullptr;
  const Marker* marker[2] = {nullptr, nullptr};
  std::size_t body[2] = {k_nobody, k_nobody};
  RelativePose pose; // pose of body[0] relative to body[1]
  bool is_used = false;

  [[nodiscard]] std::string text() const { return subject_text(kind->name, joint->name); }
};

// Pose (`place`, `angle`) and velocity of a frame relative to the ground: m, rad, m/s, rad/s.
struct Frame {
  Vec2 place = Vec2::Zero();
  double angle = 0.0;
  Vec2 velocity = Vec2::Zero();
  double spin = 0.0;
};

Vec2 turning(double spin, const Vec2& lever) { return {-spin * lever.y(), spin * lever.x()}; }

Frame seen_on(const Frame& base, const RelativePose& p) {
  const Vec2 reach = rotated(p.shift, base.angle);
  return {base.place + reach, base.angle + p.angle, base.velocity + turning(base.spin, reach) + rotated(p.velocity, base.angle),
          base.spin + p.spin};
}

// Returns the base frame, given that `frame` has the pose p relative to it: the inverse of seen_on().
Frame seen_from(const Frame& frame, const RelativePose& p) {
  Frame base;
  base.angle = frame.angle - p.angle;
  base.spin = frame.spin - p.spin;
  const Vec2 reach = rotated(p.shift, base.angle);
  base.place = frame.place - reach;
  base.velocity = frame.velocity - turning(base.spin, reach) - rotated(p.velocity, base.angle);
  return base;
}

class Placement {
public:
  Placement(Model& model, const GivenBodyField& given, const FieldLocator& locate, std::vector<Diagnostic>& problems)
      : model_(model), given_(given), locate_(locate), problems_(problems), placed_by_(model.bodies.size()),
        is_placed_(model.bodies.size(), 0), is_adrift_(is_placed_), edges_of_(model.bodies.size()) {}

  void run() {
    find_edges();
    if (edges_.empty()) return;
    for (std::size_t i = 0; i < model_.bodies.size(); ++i)
      if (model_.bodies[i].fixed || own_pose(i)) is_placed_[i] = 1;
    for (std::size_t e = 0; e < edges_.size(); ++e) follow(e);
    while (!waiting_.empty()) {
      const std::size_t body = waiting_.front();
      waiting_.pop_front();
      for (const std::size_t e : edges_of_[body]) follow(e);
    }
    report_leftovers();
  }

private:
  [[nodiscard]] std::optional<Location> own_pose(std::size_t body) const {
    const auto position = given_(body, "position");
    return position ? position : given_(body, "angle");
  }

  void complain(const Edge& edge, const std::string& message) {
    if (const auto where = locate_(Section::element, edge.element, edge.joint->placing_field()))
      problems_.push_back({*where, "'" + std::string(edge.joint->placing_field()) + "' of " + edge.text() + ": " + message});
  }

  void find_edges();
  void add_edge(std::size_t element, const PlacingElement& joint, const RelativePose& pose,
                const std::unordered_map<std::string, const Marker*>& markers, const std::unordered_map<std::string, std::size_t>& bodies);
  [[nodiscard]] bool is_known(std::size_t body) const { return body == k_nobody || is_placed_[body]; }
  void follow(std::size_t e);
  void place(Edge& edge, int side);
  [[nodiscard]] Frame marker_frame(const Edge& edge, int side) const;
  void put_body(std::size_t body, const Marker& marker, const Frame& frame);
  void refuse_velocity(const Edge& edge, std::size_t body);
  [[nodiscard]] std::string how_placed(std::size_t body, const Location& from) const;
  void report_leftovers();
  void mark_adrift(std::size_t body);

  Model& model_;
  const GivenBodyField& given_;
  const FieldLocator& locate_;
  std::vector<Diagnostic>& problems_;
  std::vector<Edge> edges_;
  std::vector<const Edge*> placed_by_;
  std::vector<char> is_placed_, is_adrift_;
  std::vector<std::vector<std::size_t>> edges_of_;
  std::deque<std::size_t> waiting_;
  bool has_unresolved_ = false; // a joint could not be resolved, so that no body is reported as "not connected"
};

void Placement::find_edges() {
  std::vector<std::pair<std::size_t, RelativePose>> placing;
  for (std::size_t i = 0; i < model_.elements.size(); ++i) {
    const auto* joint = dynamic_cast<const PlacingElement*>(model_.elements[i].element.get());
    if (!joint) continue;
    if (const auto pose = joint->relative_pose()) {
      placing.emplace_back(i, *pose);
    } else if (const char* idle = joint->idle_field()) {
      if (const auto where = locate_(Section::element, i, idle))
        problems_.push_back({*where, "'" + std::string(idle) + "' of " + subject_text(model_.elements[i].kind->name, joint->name) +
                                         " goes with '" + joint->placing_field() + "': give that too, or leave it out"});
    }
  }
  if (placing.empty()) return;
  std::unordered_map<std::string, const Marker*> markers;
  for (const Marker& marker : model_.markers) markers.emplace(marker.name, &marker);
  std::unordered_map<std::string, std::size_t> bodies{{"ground", k_nobody}};
  for (std::size_t i = 0; i < model_.bodies.size(); ++i) bodies.emplace(model_.bodies[i].name, i);
  edges_.reserve(placing.size());
  for (const auto& [element, pose] : placing)
    add_edge(element, static_cast<const PlacingElement&>(*model_.elements[element].element), pose, markers, bodies);
}

// Adds a joint to the graph. A joint with unknown names is skipped, since validation reports these.
void Placement::add_edge(std::size_t element, const PlacingElement& joint, const RelativePose& pose,
                         const std::unordered_map<std::string, const Marker*>& markers,
                         const std::unordered_map<std::string, std::size_t>& bodies) {
  Edge edge{element, &joint, model_.elements[element].kind, {}, {}, pose, false};
  for (const int side : {0, 1}) {
    const auto marker = markers.find(side == 0 ? joint.a : joint.b);
    const auto body = marker == markers.end() ? bodies.end() : bodies.find(marker->second->body);
    if (body == bodies.end()) {
      has_unresolved_ = true;
      return;
    }
    edge.marker[side] = marker->second;
    edge.body[side] = body->second;
  }
  if (edge.body[0] == edge.body[1]) return; // compilation reports an error
  for (const std::size_t body : edge.body)
    if (body != k_nobody) edges_of_[body].push_back(edges_.size());
  edges_.push_back(edge);
}

void Placement::follow(std::size_t e) {
  Edge& edge = edges_[e];
  if (edge.is_used || is_known(edge.body[0]) == is_known(edge.body[1])) return;
  edge.is_used = true;
  place(edge, is_known(edge.body[1]) ? 0 : 1);
}

// Computes the pose of body[side] of the edge from that of the other body.
void Placement::place(Edge& edge, int side) {
  const std::size_t body = edge.body[side];
  if (edge.marker[side]->at)
    complain(edge, "it places body '" + model_.bodies[body].name + "', so marker '" + edge.marker[side]->name +
                       "' needs 'point', in the body's frame, instead of 'at'");
  refuse_velocity(edge, body);
  const Frame other = marker_frame(edge, 1 - side);
  put_body(body, *edge.marker[side], side == 0 ? seen_on(other, edge.pose) : seen_from(other, edge.pose));
  is_placed_[body] = 1;
  placed_by_[body] = &edge;
  waiting_.push_back(body);
}

Frame Placement::marker_frame(const Edge& edge, int side) const {
  const Marker& marker = *edge.marker[side];
  const Vec2 point = marker.point ? *marker.point : Vec2(Vec2::Zero());
  if (edge.body[side] == k_nobody) return {marker.at ? *marker.at : point, marker.angle, Vec2::Zero(), 0.0};
  const Body& body = model_.bodies[edge.body[side]];
  Frame frame;
  frame.place = marker.at ? *marker.at : Vec2(body.position + rotated(point, body.angle));
  frame.angle = body.angle + marker.angle;
  if (body.fixed) return frame;
  const Vec2 centre = body.position + rotated(body.cg, body.angle);
  frame.spin = body.angular_velocity;
  frame.velocity = body.velocity + turning(frame.spin, frame.place - centre);
  return frame;
}

void Placement::put_body(std::size_t index, const Marker& marker, const Frame& frame) {
  Body& body = model_.bodies[index];
  const Vec2 point = marker.point ? *marker.point : Vec2(Vec2::Zero());
  body.angle = frame.angle - marker.angle;
  body.position = frame.place - rotated(point, body.angle);
  body.angular_velocity = frame.spin;
  body.velocity = frame.velocity + turning(frame.spin, rotated(body.cg - point, body.angle));
}

void Placement::refuse_velocity(const Edge& edge, std::size_t body) {
  for (const char* field : {"velocity", "angular_velocity"})
    if (const auto where = given_(body, field))
      problems_.push_back({*where, "'" + std::string(field) + "' of body '" + model_.bodies[body].name + "': " + edge.text() +
                                       " places the body and gives its velocity as well: leave '" + field +
                                       "' out, or give the joint's rate there"});
}

std::string Placement::how_placed(std::size_t body, const Location& from) const {
  if (body == k_nobody) return "the ground stands still";
  const std::string name = "'" + model_.bodies[body].name + "' ";
  const auto line = [&from](const Location& where) {
    if (where.line == 0) return std::string();
    return " (line " + std::to_string(where.line) + (where.file == from.file ? "" : " of " + where.file) + ")";
  };
  if (const Edge* edge = placed_by_[body]) return name + "by " + edge->text() + line(edge->joint->where);
  if (const auto own = own_pose(body)) return name + "by its own pose" + line(*own);
  return name + "is fixed";
}

void Placement::report_leftovers() {
  for (const Edge& edge : edges_) {
    if (edge.is_used) continue;
    if (is_known(edge.body[0]) && is_known(edge.body[1])) {
      const Location& from = edge.joint->where;
      complain(edge, "both its bodies are placed already: " + how_placed(edge.body[0], from) + ", " + how_placed(edge.body[1], from) +
                         "; leave '" + edge.joint->placing_field() +
                         "' out here (assembly closes loops), or what places one of the two there");
    } else if (!has_unresolved_ && !is_adrift_[edge.body[0]]) {
      complain(edge, "nothing says where '" + model_.bodies[edge.body[1]].name +
                         "' is: give one body of this chain a 'position', or join it to the ground by a joint that "
                         "gives its coordinate");
      mark_adrift(edge.body[0]);
    }
  }
}

// Marks all bodies connected to `body` by joints that prescribe poses, so that the group is reported once.
void Placement::mark_adrift(std::size_t body) {
  is_adrift_[body] = 1;
  waiting_.push_back(body);
  while (!waiting_.empty()) {
    const std::size_t next = waiting_.front();
    waiting_.pop_front();
    for (const std::size_t e : edges_of_[next])
      for (const std::size_t other : edges_[e].body)
        if (other != k_nobody && !is_adrift_[other]) {
          is_adrift_[other] = 1;
          waiting_.push_back(other);
        }
  }
}

} // namespace

void place_by_joints(Model& model, const GivenBodyField& given, const FieldLocator& locate, std::vector<Diagnostic>& problems) {
  Placement(model, given, locate, problems).run();
}

} // namespace steplap
