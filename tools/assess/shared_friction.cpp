#include "tools/assess/shared_friction.h"

#include "elements/coulomb_stick.h"
#include "mbd/base/name_pattern.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/presentation.h"
#include "mbd/model/completion.h"
#include "mbd/model/entries.h"
#include "mbd/run/quantity_text.h"
#include "tools/assess/sliding_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

namespace steplap::assess {

namespace {

// A model, completed and compiled.
struct Compiled {
  Model whole;
  std::unique_ptr<System> system;
  explicit Compiled(const DrivenModel& model) : whole(completed(model.given)), system(compile(whole)) {
    static_cast<void>(check_presentation(whole, *system)); // converts limits to the units of their channels
  }
};

// Returns the record's axis along a direction of the model, 'x', 'y' or 'z'; ' ' if none is parallel.
char letter_along(const DrivenModel& model, const Vec2& direction) {
  const Vec2 x = rotated(Vec2(1.0, 0.0), model.marker_angle);
  const std::string& axis = std::abs(x.dot(direction)) >= std::abs(cross(x, direction)) ? model.recorder.x : model.recorder.y;
  return axis == "none" ? ' ' : axis.back();
}

// Returns the bodies that an element connects. The ground is added if it names only one.
std::set<std::string> bodies_of(const ElementEntry& entry, const std::map<std::string, std::string>& body_of_marker) {
  std::set<std::string> bodies;
  const auto add = [&](const std::string& name) {
    const auto marker = body_of_marker.find(name);
    if (!name.empty()) bodies.insert(marker == body_of_marker.end() ? name : marker->second);
  };
  for (const Field& field : entry.kind->fields.fields()) {
    const FieldValue value = field.get(entry.element.get());
    if (field.name == "over" && field.type == FieldType::texts) // guides of a rope
      for (const std::string& name : std::get<std::vector<std::string>>(value)) add(name);
    if (field.type == FieldType::marker || field.type == FieldType::body) add(std::get<std::string>(value));
  }
  if (bodies.size() == 1) bodies.insert("ground");
  return bodies;
}

// Returns the elements, other than `own`, that hold the load which rests on these frictions. The load consists of all bodies connected with
// the body on the friction, without the supporting body, the driven body and the ground.
std::vector<std::string> holders_of(const DrivenModel& model, const Compiled& compiled, const std::vector<std::string>& own) {
  const Model& whole = compiled.whole;
  std::map<std::string, std::string> body_of_marker;
  for (const Marker& marker : whole.markers) body_of_marker[marker.name] = marker.body;
  std::set<std::string> ends{"ground", model.body}, left_out(own.begin(), own.end()), pair;
  for (const Body& body : whole.bodies)
    if (body.fixed) ends.insert(body.name);
  for (const CoulombStick* const stick : elements_of<CoulombStick>(whole))
    if (left_out.contains(stick->name)) left_out.insert(stick->contacts.begin(), stick->contacts.end());
  std::vector<std::pair<std::string, std::set<std::string>>> edges;
  for (const ElementEntry& entry : whole.elements) {
    const std::set<std::string> bodies = bodies_of(entry, body_of_marker);
    if (left_out.contains(entry.element->name)) pair.insert(bodies.begin(), bodies.end());
    else if (!bodies.empty() && !(entry.kind->acts_from_outside && entry.kind->acts_from_outside(*entry.element, whole)))
      edges.emplace_back(entry.element->name, bodies);
  }
  std::set<std::string> load;
  for (const std::string& body : pair)
    if (load.empty() && !ends.contains(body)) load.insert(body);
  for (const std::string& body : pair)
    if (!load.contains(body)) ends.insert(body);
  for (std::size_t before = 0; before != load.size();) {
    before = load.size();
    for (const auto& [name, bodies] : edges)
      if (std::any_of(bodies.begin(), bodies.end(), [&](const std::string& body) { return load.contains(body); }))
        for (const std::string& body : bodies)
          if (!ends.contains(body)) load.insert(body);
  }
  std::vector<std::string> holders;
  for (const auto& [name, bodies] : edges)
    if (std::any_of(bodies.begin(), bodies.end(), [&](const std::string& body) { return load.contains(body); }) &&
        std::any_of(bodies.begin(), bodies.end(), [&](const std::string& body) { return ends.contains(body); }))
      holders.push_back(name);
  return holders;
}

std::vector<PlaneOfFriction::Limit> limits_of(const DrivenModel& model, const Compiled& compiled,
                                              const std::vector<std::string>& elements) {
  std::vector<PlaneOfFriction::Limit> limits;
  for (const Criterion& criterion : compiled.whole.criteria) {
    const bool is_of_slide = std::any_of(elements.begin(), elements.end(), [&](const std::string& element) {
      return !criterion.channel.empty() &&
             (matches_pattern(element + ".slide", criterion.channel) || matches_pattern(element + ".slide_rear", criterion.channel));
    });
    if (!is_of_slide) continue;
    double most = std::numeric_limits<double>::infinity();
    for (const std::optional<double>& limit : {criterion.within, criterion.at_most, criterion.at_least})
      if (limit) most = std::min(most, std::abs(*limit));
    const bool is_assumed =
        std::find(model.assumed_limits.begin(), model.assumed_limits.end(), criterion.name) != model.assumed_limits.end();
    limits.push_back({criterion.name, most, criterion.consequence == "reject" ? Verdict::reject : Verdict::inspect, is_assumed});
  }
  return limits;
}

std::optional<PlaneOfFriction> plane_of(std::size_t index, const DrivenModel& model, const Compiled& compiled, const std::string& name,
                                        const std::vector<std::string>& elements) {
  const std::optional<FrictionPlane> found = friction_plane(*compiled.system, name, elements, compiled.system->gravity, model.file);
  if (!found) return {};
  PlaneOfFriction plane{*found, index, {}, {}, {}};
  plane.model_name = model.name;
  plane.holders = holders_of(model, compiled, elements);
  plane.limits = limits_of(model, compiled, elements);
  return plane;
}

// Adds the elements to `model.traced` and returns their indices in it.
std::vector<std::size_t> trace(DrivenModel& model, const std::vector<std::string>& elements) {
  std::vector<std::size_t> places;
  for (const std::string& element : elements) {
    const auto known = std::find(model.traced.begin(), model.traced.end(), element);
    places.push_back(static_cast<std::size_t>(known - model.traced.begin()));
    if (known == model.traced.end()) model.traced.push_back(element);
  }
  return places;
}

} // namespace

std::vector<SharedFriction> find_shared_frictions(std::vector<DrivenModel>& models) {
  std::vector<SharedFriction> found;
  std::vector<FrictionNames> frictions;
  std::vector<std::unique_ptr<Compiled>> compiled(models.size());
  for (DrivenModel& model : models) {
    model.traced.clear();
    frictions.push_back(friction_names(model.given));
  }
  const auto plane = [&](std::size_t m, const std::string& name) {
    if (!compiled[m]) compiled[m] = std::make_unique<Compiled>(models[m]);
    return plane_of(m, models[m], *compiled[m], name, frictions[m].at(name));
  };
  for (std::size_t i = 0; i < models.size(); ++i)
    for (std::size_t k = i + 1; k < models.size(); ++k)
      for (const auto& [name, elements] : frictions[i]) {
        if (!frictions[k].contains(name)) continue;
        std::optional<PlaneOfFriction> first = plane(i, name), second = plane(k, name);
        if (!first || !second || letter_along(models[i], first->tangent) == letter_along(models[k], second->tangent)) continue;
        first->traces = trace(models[i], elements);
        second->traces = trace(models[k], frictions[k].at(name));
        found.push_back({name, {std::move(*first), std::move(*second)}});
      }
  return found;
}

std::string unshared_planes(const std::vector<DrivenModel>& models, const std::vector<SharedFriction>& shared) {
  struct Floor {
    std::string friction;
    char axis = ' '; ///< the record's axis along it
  };
  if (models.size() < 2) return {};
  constexpr double k_floor = 0.7;           // least cosine between gravity and the normal of a contact that carries weight
  std::vector<std::optional<Floor>> floors; // per model, its first
  for (const DrivenModel& model : models) {
    floors.emplace_back();
    const FrictionNames frictions = friction_names(model.given);
    if (frictions.empty()) continue;
    const Compiled compiled(model);
    for (const auto& [name, elements] : frictions) {
      const auto plane = friction_plane(*compiled.system, name, elements, compiled.system->gravity, model.file);
      if (!plane || !(std::abs(plane->tilt) > k_floor) || letter_along(model, plane->tangent) == ' ') continue;
      floors.back() = Floor{name, letter_along(model, plane->tangent)};
      break;
    }
  }
  const auto share = [&](std::size_t i, std::size_t k) {
    return std::any_of(shared.begin(), shared.end(),
                       [&](const SharedFriction& each) { return each.planes[0].model == i && each.planes[1].model == k; });
  };
  for (std::size_t i = 0; i < models.size(); ++i)
    for (std::size_t k = i + 1; k < models.size(); ++k)
      if (floors[i] && floors[k] && floors[i]->axis != floors[k]->axis && !share(i, k))
        return "'" + floors[i]->friction + "' of '" + models[i].name + "' and '" + floors[k]->friction + "' of '" + models[k].name + "'";
  return {};
}

// --- evaluation of an event -------------------------------------------------------------------------

struct SharedFrictionCourse::Instant {
  std::array<double, 2> force{}; ///< friction force in each model, N
  std::array<double, 2> pull{};  ///< acceleration of the load that friction must provide, m/s²
  std::array<bool, 2> sticks{};
  double normal = 0.0; ///< normal force on the contact, from both models, N
};

namespace {

double at(const std::vector<double>& values, double place) {
  if (values.empty() || place >= static_cast<double>(values.size() - 1)) return 0.0; // zero after the last sample
  const auto i = static_cast<std::size_t>(place);
  return values[i] + (place - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

template <class T> T last_or(const std::vector<T>& values, std::size_t i) { return values[std::min(i, values.size() - 1)]; }

SampledFriction trace_of(const PlaneOfFriction& plane, const std::vector<SampledFriction>& traces) {
  std::vector<SampledFriction> own;
  for (const std::size_t i : plane.traces) own.push_back(traces[i]);
  return sum_of_traces(own);
}

} // namespace

std::vector<SharedFrictionCourse::Instant> SharedFrictionCourse::instants(const std::array<SampledFriction, 2>& traces,
                                                                          const std::array<const DriveHistory*, 2>& histories) const {
  std::vector<Instant> all(std::max(traces[0].force.size(), traces[1].force.size()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k].normal = contact_->normal(traces, k);
    for (std::size_t p = 0; p < 2; ++p) {
      const PlaneOfFriction& plane = friction_.planes[p];
      const DriveHistory& history = *histories[p];
      const double place = static_cast<double>(k) * traces[p].step / history.step;
      all[k].force[p] = last_or(traces[p].force, k);
      all[k].sticks[p] = last_or(traces[p].sticks, k) != 0;
      all[k].pull[p] = plane.tangent.x() * at(history.x, place) + plane.tangent.y() * at(history.y, place) - plane.downhill;
    }
  }
  return all;
}

void SharedFrictionCourse::slide(const std::vector<Instant>& instants, const std::array<SampledFriction, 2>& traces, bool goes_on,
                                 SharedPassage& passage) {
  // Fits T = m a by least squares over the intervals of sticking. The sign of T for positive a is determined, too.
  double mass_sum = 0.0, squares = 0.0;
  std::array<double, 2> sign{};
  for (std::size_t p = 0; p < 2; ++p) {
    double held = 0.0, all = 0.0;
    for (const Instant& now : instants) {
      all += now.force[p] * now.pull[p];
      if (!now.sticks[p]) continue;
      held += now.force[p] * now.pull[p];
      squares += now.pull[p] * now.pull[p];
    }
    sign[p] = all < 0.0 ? -1.0 : 1.0;
    mass_sum += sign[p] * held;
  }
  const PlaneOfFriction& plane = friction_.planes[0];
  double mass = plane.gravity > 0.0 ? contact_->at_rest[0] / (plane.tilt * plane.gravity) : std::numeric_limits<double>::infinity();
  if (squares > 0.0 && mass_sum > 0.0) mass = std::min(mass, mass_sum / squares);
  if (!std::isfinite(mass) || !(mass > 0.0)) {
    passage.disagreement = "the weight of the load on '" + friction_.name + "' is unknown: it neither has weight nor is it pulled";
    return;
  }
  const double mu_static = std::min(traces[0].mu_static, traces[1].mu_static);
  SlidingPoint point(mass, mu_static, std::min(traces[0].mu_kinetic, traces[1].mu_kinetic), 1e-4, velocity_);
  const auto load = [&](const Instant& now) {
    PointLoad result;
    for (int p = 0; p < 2; ++p) {
      const auto i = static_cast<std::size_t>(p);
      result.drive[p] = now.sticks[i] ? -now.force[i] : -sign[i] * mass * now.pull[i];
    }
    result.normal = now.normal;
    return result;
  };
  for (std::size_t k = 1; k < instants.size(); ++k) point.advance(load(instants[k - 1]), load(instants[k]), traces[0].step);
  passage.slid = goes_on || point.come_to_rest(load(instants.back())) ? point.path() : std::numeric_limits<double>::infinity();
  velocity_ = goes_on ? point.velocity() : Vec2::Zero();
}

SharedPassage SharedFrictionCourse::pass(const std::array<SampledFriction, 2>& traces,
                                         const std::array<const DriveHistory*, 2>& histories) {
  SharedPassage passage;
  passage.slid_total = slid_total_;
  if (traces[0].force.empty() || traces[1].force.empty()) return passage; // a run failed, which is reported there
  if (!contact_)
    contact_ = {friction_.name, {&friction_.planes[0], &friction_.planes[1]}, {traces[0].normal.front(), traces[1].normal.front()}};
  passage.disagreement = contact_->disagreement();
  if (!passage.disagreement.empty()) return passage;
  static_cast<SharedUse&>(passage) = shared_use(*contact_, traces);
  const bool goes_on = histories[0]->goes_on && histories[1]->goes_on;
  if (passage.slips || velocity_ != Vec2::Zero()) {
    passage.slips = true;
    slide(instants(traces, histories), traces, goes_on, passage);
    for (std::size_t p = 0; p < 2 && passage.bound.empty(); ++p)
      if (traces[p].lifts) passage.bound = "a contact under it lifts in '" + friction_.planes[p].model_name + "'";
      else if (!friction_.planes[p].holders.empty())
        passage.bound = "'" + friction_.planes[p].holders.front() + "' holds the load as well in '" + friction_.planes[p].model_name + "'";
  }
  passage.slid_total = slid_total_ += passage.slid;
  return passage;
}

SharedFrictions::SharedFrictions(const std::vector<SharedFriction>& frictions) : frictions_(frictions) {
  for (const SharedFriction& friction : frictions) courses_.emplace_back(friction);
}

std::vector<SharedPassage> SharedFrictions::pass(const std::vector<const std::vector<SampledFriction>*>& traces,
                                                 const std::vector<const DriveHistory*>& histories) {
  std::vector<SharedPassage> passages;
  for (std::size_t f = 0; f < frictions_.size(); ++f) {
    std::array<SampledFriction, 2> both;
    std::array<const DriveHistory*, 2> driven{};
    for (std::size_t p = 0; p < 2; ++p) {
      const PlaneOfFriction& plane = frictions_[f].planes[p];
      if (!traces[plane.model]->empty()) both[p] = trace_of(plane, *traces[plane.model]);
      driven[p] = histories[plane.model];
    }
    passages.push_back(courses_[f].pass(both, driven));
    passages.back().friction = f;
  }
  return passages;
}

void add_to(VoyageSummary& summary, const SharedFriction& friction, const SharedPassage& passage, std::size_t number) {
  const std::string where = "event " + std::to_string(number);
  VoyageSummary now;
  now.planes_use = passage.use;
  if (!passage.disagreement.empty()) now.unknown = passage.disagreement;
  if (passage.slips && passage.disagreement.empty()) {
    const std::string slid = std::isfinite(passage.slid_total) ? "slides " + quantity_text(passage.slid_total, "m") : "slides without end";
    now.planes_slip = "In " + where + " '" + friction.planes[0].model_name + "' and '" + friction.planes[1].model_name +
                      "' together ask for " + rounded_text(100.0 * passage.use, 4) + " % of the friction '" + friction.name +
                      "': a point that moves in both planes " + slid + (number > 1 ? " in all" : "");
    double least = std::numeric_limits<double>::infinity();
    for (const PlaneOfFriction& plane : friction.planes)
      for (const PlaneOfFriction::Limit& limit : plane.limits) {
        least = std::min(least, limit.most);
        if (passage.slid_total <= limit.most || !passage.bound.empty()) continue;
        now.note_limit(limit.consequence, limit.is_assumed, passage.slid_total / limit.most,
                       "'" + limit.name + "' in " + where + " by both planes together, '" + friction.name + "' " + slid + " and may " +
                           quantity_text(limit.most, "m"));
      }
    if (!passage.bound.empty()) {
      now.planes = Verdict::inspect;
      now.planes_slip += ". That is an upper bound, as " + passage.bound;
    } else if (!std::isfinite(least)) {
      now.planes = Verdict::open;
      now.planes_slip += ". No [[acceptance]] limits it: add one for the channel 'slide'";
    } else {
      now.planes = passage.slid_total > least ? Verdict::inspect : Verdict::hold;
      now.planes_slip += "; " + quantity_text(least, "m") + " are allowed";
    }
    now.planes_slip += ".";
  }
  worsen(summary, now);
}

std::vector<std::string> assumptions_of(const std::vector<SharedFriction>& frictions) {
  std::vector<std::string> sentences;
  for (const SharedFriction& friction : frictions)
    sentences.push_back("'" + friction.name + "' is one friction in '" + friction.planes[0].model_name + "' and '" +
                        friction.planes[1].model_name +
                        "': both planes together are held against it. Turning about the vertical axis (yaw) is not modelled.");
  return sentences;
}

} // namespace steplap::assess
