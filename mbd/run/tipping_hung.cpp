#include "mbd/run/tipping_hung.h"

#include "mbd/system/places.h"

#include <algorithm>

namespace steplap {

namespace {

/// An element as a connection of bodies. It has end points if it exerts only forces at points.
struct Tie {
  std::vector<int> bodies;
  std::vector<Vec2> points; ///< one point per body, m; empty if the element also exerts couples or forces elsewhere
};

void add_force(BodyForce& sum, const Vec2& centre, const Vec2& point, const Vec2& force) {
  const Vec2 lever = point - centre;
  sum.fx += force.x();
  sum.fy += force.y();
  sum.m += lever.x() * force.y() - lever.y() * force.x();
}

class HangingSearch {
public:
  HangingSearch(const LoadedModel& loaded, const State& state, const std::vector<std::string>& touching,
                const std::vector<BodyForce>& force)
      : loaded_(loaded), system_(*loaded.system), state_(state), force_(force) {
    found_.is_hung.assign(system_.bodies.size(), 0);
    found_.correction.assign(system_.bodies.size(), BodyForce{});
    for (const ElementEntry& entry : loaded.model.elements) {
      const bool is_open = entry.kind->contact && std::find(touching.begin(), touching.end(), entry.element->name) == touching.end();
      ties_.push_back(is_open ? Tie{} : tie_of(entry));
    }
  }

  HangingLoads run() {
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < ties_.size(); ++i)
      if (auto candidate = hung_by(i)) candidates.push_back(std::move(*candidate));
    for (const Candidate& candidate : candidates) // a load whose carrier belongs to another hanging load is part of that load
      if (std::none_of(candidates.begin(), candidates.end(), [&](const Candidate& c) { return c.is_below[candidate.load.carrier]; }))
        take(candidate);
    return std::move(found_);
  }

private:
  struct Candidate {
    std::size_t tie = 0;
    std::vector<char> is_below;      ///< per body: belongs to the hanging load
    std::size_t first = 0, last = 0; ///< range of the tie's points that do not belong to the load
    std::size_t at = 0;              ///< index of the suspension point among the tie's points
    HangingLoad load;
  };

  void add_point(Tie& tie, const std::string& name) const {
    const Place place = place_of(loaded_.model, name);
    const Vec3 pose = pose_of(system_, state_, place.body);
    tie.bodies.push_back(index_of(system_, place.body));
    tie.points.push_back(Vec2(pose.x(), pose.y()) + rotated(place.point, pose.z()));
  }

  [[nodiscard]] Tie tie_of(const ElementEntry& entry) const {
    Tie tie;
    const Element& element = *entry.element;
    for (const Field& field : entry.kind->fields.fields()) {
      if (field.type != FieldType::marker && field.type != FieldType::body) continue;
      if (const std::string name = std::get<std::string>(field.get(&element)); !name.empty()) add_point(tie, name);
    }
    if (const auto pulls_between = loaded_.views->of(*entry.kind).pulls_between)
      if (const std::vector<std::string> markers = pulls_between(element); !markers.empty()) {
        tie = {};
        for (const std::string& name : markers) add_point(tie, name);
        return tie;
      }
    // an element with one body is a load from outside: its body does not hang freely
    if (tie.bodies.size() == 1) tie.bodies.push_back(k_ground);
    tie.points.clear();
    return tie;
  }

  // Returns, per body, whether it is connected with `body` when tie `cut` is removed. The search stops when it reaches the ground.
  [[nodiscard]] std::vector<char> joined_with(int body, std::size_t cut) const {
    std::vector<char> is_joined(system_.bodies.size(), 0);
    is_joined[body] = 1;
    for (bool is_changed = true; is_changed && !is_joined[k_ground];) {
      is_changed = false;
      for (std::size_t i = 0; i < ties_.size(); ++i) {
        if (i == cut) continue;
        const std::vector<int>& bodies = ties_[i].bodies;
        if (std::none_of(bodies.begin(), bodies.end(), [&](int b) { return is_joined[b] != 0; })) continue;
        for (const int b : bodies)
          if (!is_joined[b]) is_joined[b] = 1, is_changed = true;
      }
    }
    return is_joined;
  }

  [[nodiscard]] std::optional<Candidate> hung_by(std::size_t i) const {
    const Tie& tie = ties_[i];
    if (tie.points.empty()) return std::nullopt;
    for (const int end : {tie.bodies.front(), tie.bodies.back()}) {
      if (end == k_ground) continue;
      Candidate c{i, joined_with(end, i), 0, 0, 0, {}};
      if (c.is_below[k_ground]) continue;
      const auto is_above = [&](int b) { return c.is_below[b] == 0; };
      const auto first = std::find_if(tie.bodies.begin(), tie.bodies.end(), is_above);
      const auto last = std::find_if(tie.bodies.rbegin(), tie.bodies.rend(), is_above).base(); // one past the last
      if (first == tie.bodies.end() || !std::all_of(first, last, is_above)) continue;
      c.first = static_cast<std::size_t>(first - tie.bodies.begin());
      c.last = static_cast<std::size_t>(last - tie.bodies.begin()) - 1;
      if (c.first > 0 && c.last + 1 < tie.bodies.size() && c.first != c.last)
        continue; // two parts of the rope hold the load at different points, so it does not swing
      c.at = c.first > 0 ? c.first : c.last;
      c.load.carrier = tie.bodies[c.at];
      c.load.point = tie.points[c.at];
      for (int b = 1; b < system_.body_count(); ++b)
        if (c.is_below[b]) c.load.mass += system_.bodies[b].mass, ++c.load.bodies;
      if (c.load.carrier != k_ground || c.first != c.last) return c;
    }
    return std::nullopt;
  }

  // Corrects the forces on the carrier: subtracts the present forces of the tie and adds those with the load at rest. The weight itself
  // enters by the mass of the load.
  void take(const Candidate& c) {
    const Tie& tie = ties_[c.tie];
    Vec2 on_load = Vec2::Zero();
    for (int b = 1; b < system_.body_count(); ++b)
      if (c.is_below[b]) found_.is_hung[b] = 1, on_load += Vec2(force_[b].fx, force_[b].fy);
    found_.by.push_back(loaded_.model.elements[c.tie].element->name);
    if (c.load.carrier != k_ground) {
      add_force(found_.correction[c.load.carrier], centre(c.load.carrier), c.load.point, on_load);
      found_.loads.push_back(c.load);
    }
    const double change = c.load.mass * system_.gravity.norm() - on_load.norm(); // change of the tension until the load is at rest, N
    for (std::size_t p = c.first; p < c.last; ++p) {
      const Vec2 along = tie.points[p + 1] - tie.points[p];
      if (tie.bodies[p] == tie.bodies[p + 1] || along == Vec2::Zero()) continue;
      add_force(found_.correction[tie.bodies[p]], centre(tie.bodies[p]), tie.points[p], change * along.normalized());
      add_force(found_.correction[tie.bodies[p + 1]], centre(tie.bodies[p + 1]), tie.points[p + 1], -change * along.normalized());
    }
  }

  [[nodiscard]] Vec2 centre(int body) const { return body == k_ground ? Vec2::Zero() : Vec2(state_.q[3 * body], state_.q[3 * body + 1]); }

  const LoadedModel& loaded_;
  const System& system_;
  const State& state_;
  const std::vector<BodyForce>& force_;
  std::vector<Tie> ties_; ///< connections, one per element of the model
  HangingLoads found_;
};

} // namespace

HangingLoads hanging_loads(const LoadedModel& loaded, const State& state, const std::vector<std::string>& touching,
                           const std::vector<BodyForce>& force) {
  return HangingSearch(loaded, state, touching, force).run();
}

} // namespace steplap
