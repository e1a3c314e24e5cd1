#include "mbd/system/system.h"

#include "mbd/base/name_pattern.h"
#include "mbd/model/method.h"
#include "mbd/system/measured_channel.h"
#include "mbd/system/one_way_lock.h"
#include "mbd/system/own_states.h"
#include "mbd/system/places.h"
#include "mbd/system/requested_channels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace steplap {

void place_bodies(const std::vector<double>& q, const std::vector<double>& v, std::vector<Motion<double>>& motion) {
  motion.resize(q.size() / 3);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    Motion<double>& m = motion[i];
    m.x = q[3 * i];
    m.y = q[3 * i + 1];
    set_angle(m, q[3 * i + 2]);
    m.vx = v[3 * i];
    m.vy = v[3 * i + 1];
    m.omega = v[3 * i + 2];
  }
}

// A drive given as velocity or acceleration starts at the position of the body; one given as acceleration also starts with the body's
// velocity. A drive given as position is absolute: its base is f(0), which Signal::drive() subtracts.
void start_drives(const System& system, State& state, const std::vector<char>* begins) {
  std::vector<Motion<double>> motion;
  place_bodies(state.q, state.v, motion);
  for (const RowSpec& row : system.rows) {
    if (!row.drive || (begins && (*begins)[row.element] == 0)) continue;
    if (row.level == DriveLevel::position) {
      state.bases[row.base].value = system.initial_bases[row.base].value + row.drive->value(0.0);
      continue;
    }
    const auto m = evaluate_row<false>(row, motion.data());
    const SignalJet now = row.drive->drive(state.t, row.level);
    const double base_rate = row.level == DriveLevel::acceleration ? m.rate - now.rate : 0.0;
    state.bases[row.base] = {m.value - now.value - base_rate * state.t, base_rate};
  }
}

// --- System -----------------------------------------------------------------------------------

State System::initial_state() const {
  State state;
  state.q.resize(3 * bodies.size());
  state.v.resize(3 * bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      state.q[3 * i + k] = bodies[i].pose[k];
      state.v[3 * i + k] = bodies[i].velocity[k];
    }
  state.mode.assign(units.size(), 0);
  state.friction.resize(frictions.size());
  state.bases = initial_bases;
  state.impacts = initial_impacts;
  state.inner = initial_inner;
  return state;
}

double System::potential_energy(const Motion<double>* motion) const {
  double sum = 0.0;
  for (std::size_t i = 1; i < bodies.size(); ++i) sum -= bodies[i].mass * (gravity.x() * motion[i].x + gravity.y() * motion[i].y);
  for (const auto& group : groups) sum += group->potential(motion);
  return sum;
}

double System::kinetic_energy(const State& state) const {
  double sum = 0.0;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const double* v = &state.v[3 * i];
    sum += 0.5 * bodies[i].mass * (v[0] * v[0] + v[1] * v[1]) + 0.5 * bodies[i].inertia * v[2] * v[2];
  }
  return sum;
}

double System::fastest_at(double t) const {
  double fastest = 0.0;
  for (const auto& signal : signals_) fastest = std::max(fastest, signal->fastest_at(t));
  return fastest;
}

const Channel* System::find_channel(const std::string& name) const {
  for (const Channel& channel : channels)
    if (channel.name == name) return &channel;
  return nullptr;
}

Channel System::make_channel(std::string name, std::string_view unit, const ChannelText& text,
                             std::function<double(const Snapshot&)> value) {
  return {std::move(name),         texts.stored(unit),       texts.stored(text.meaning),
          texts.stored(text.sign), texts.stored(text.codes), std::move(value)};
}

// --- SystemBuilder ------------------------------------------------------------------------------

SystemBuilder::SystemBuilder(const Model& model, const std::vector<std::string>* wanted)
    : model_(model), system_(new System), signals_(model), wanted_(wanted) {
  system_->title = model.header.title;
  system_->gravity = model.header.gravity;
}

namespace {

SceneUnits units_of(const System& system, double duration) {
  SceneUnits scale;
  double size = 0.0;
  for (const BodyData& body : system.bodies)
    if (body.mass > 0.0) size = std::max(size, std::sqrt(body.inertia / body.mass));
  if (size > 0.0) scale.length = size;
  const double gravity = system.gravity.norm();
  scale.duration = duration;
  scale.rate = gravity > 0.0 ? std::sqrt(gravity / scale.length) : std::numbers::pi / duration;
  return scale;
}

} // namespace

void SystemBuilder::compile_bodies() {
  system_->bodies.push_back({"ground", 0.0, 0.0, Vec3::Zero(), Vec3::Zero()});
  body_index_["ground"] = k_ground;
  std::unordered_map<std::string, const Body*> by_name;
  for (const Body& body : model_.bodies) {
    by_name[body.name] = &body;
    if (body.fixed) {
      body_index_[body.name] = k_ground;
      continue;
    }
    body_index_[body.name] = system_->body_count();
    const Vec2 velocity = body.velocity + model_.simulation.velocity;
    system_->bodies.push_back(
        {body.name, body.mass, body.inertia, body.reference_pose(), Vec3(velocity.x(), velocity.y(), body.angular_velocity)});
  }
  system_->scale = units_of(*system_, model_.simulation.end);
  State state = system_->initial_state();
  place_bodies(state.q, state.v, reference_);

  // Marker positions are relative to the centre of gravity. A marker on a fixed body becomes a point of the ground, so that fixed bodies
  // are not computed.
  const auto compiled = [&](const std::string& body_name, const std::optional<Vec2>& point, const std::optional<Vec2>& at, double angle) {
    CompiledMarker marker;
    marker.body = body_index_.at(body_name);
    marker.angle = angle;
    const auto found = by_name.find(body_name);
    const Body* body = found == by_name.end() ? nullptr : found->second;
    Vec2 ground_position = Vec2::Zero();
    if (at) ground_position = *at;
    else if (body) ground_position = body->position + rotated(point ? *point : body->cg, body->angle);
    else if (point) ground_position = *point;
    if (marker.body == k_ground) {
      marker.point = ground_position;
      if (body) marker.angle += body->angle;
    } else if (point) {
      marker.point = *point - body->cg;
    } else {
      const Motion<double>& m = reference_[marker.body];
      marker.point = rotated(ground_position - Vec2(m.x, m.y), -m.theta);
      if (!at) marker.point.setZero();
    }
    return marker;
  };
  marker_index_.reserve(body_index_.size() + model_.markers.size());
  for (const auto& [name, index] : body_index_) marker_index_[name] = compiled(name, std::nullopt, std::nullopt, 0.0);
  for (const Marker& marker : model_.markers) marker_index_[marker.name] = compiled(marker.body, marker.point, marker.at, marker.angle);
}

std::vector<char> acting_elements(const Model& model) {
  std::vector<char> acts;
  std::unordered_map<std::string_view, const Element*> by_name;
  for (const ElementEntry& entry : model.elements) {
    acts.push_back(entry.element->active ? 1 : 0);
    by_name[entry.element->name] = entry.element.get();
  }
  if (std::find(acts.begin(), acts.end(), 0) == acts.end()) return acts;
  for (std::size_t i = 0; i < acts.size(); ++i)
    for (const Field& field : model.elements[i].kind->fields.fields()) {
      if (field.type != FieldType::element) continue;
      const auto other = by_name.find(std::get<std::string>(field.get(model.elements[i].element.get())));
      if (other != by_name.end() && !other->second->active) acts[i] = 0;
    }
  return acts;
}

void SystemBuilder::compile_elements(RequestedChannels& requested) {
  element_index_.reserve(model_.elements.size());
  system_->element_names.reserve(model_.elements.size());
  system_->element_kinds.reserve(model_.elements.size());
  for (std::size_t i = 0; i < model_.elements.size(); ++i) {
    const Element& element = *model_.elements[i].element;
    element_index_[element.name] = i;
    system_->element_names.push_back(element.name);
    system_->element_kinds.push_back(model_.elements[i].kind->name);
  }
  const std::vector<char> acts = acting_elements(model_);
  for (const int stage : {0, 1}) {
    for (std::size_t i = 0; i < model_.elements.size(); ++i) {
      if (model_.elements[i].kind->stage != stage) continue;
      element_ = static_cast<int>(i);
      if (acts[i] == 0) {
        compile_inactive(model_.elements[i], requested);
        continue;
      }
      requested.begin_element();
      model_.elements[i].kind->compile(*model_.elements[i].element, *this);
      requested.end_element();
    }
    for (const auto& [element, work] : std::exchange(after_joints_, {})) {
      element_ = element;
      work();
    }
  }
}

namespace {

// Contacts of inactive elements: always open, zero normal force.
class InactiveContacts final : public ForceGroup {
public:
  struct ElementData {
    int contact = 0, unit = 0, first_event = 0;
  };
  std::vector<ElementData> entries;

  void add_forces(Evaluation& e) const override {
    for (const ElementData& entry : entries) e.contact_force[entry.contact] = 0.0;
  }
  [[nodiscard]] bool record_forces(TracedEvaluation& e) const override {
    for (const ElementData& entry : entries) e.contact_force[entry.contact] = TapeNumber(0.0);
    return true;
  }
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }
  void add_jacobian(const Evaluation&, std::vector<PairJacobian>&) const override {}
  void mark_bodies(std::vector<char>&) const override {}
};

// Returns true for what an element does, which is zero while it does not act: forces, pressures and powers, modes, shares of a bound.
bool is_of_acting(const Channel& channel) {
  if (!channel.codes.empty() || channel.role != ChannelRole::none) return true;
  const auto has = [&](const char* part) { return channel.unit.find(part) != std::string::npos; };
  return has("N") || has("Pa") || has("J") || has("W");
}

// Sets the value of a channel of an inactive element. What depends on the motion only is kept, and what the element does is zero. Anything
// else is the element's own, and unknown: zero would meet a criterion on it.
void end_value(Channel& channel) {
  channel.bounds = {};
  if (channel.value.target<MotionValue>()) return;
  if (const auto* const measured = measured_by(channel)) {
    MeasuredValue left = *measured;
    left.shown = [row = left.measure, zero = left.zero, is_rate = left.is_rate](const Snapshot& s) {
      const MeasureValue<double> m = evaluate_row<false>(row, s.motion);
      return is_rate ? m.rate : m.value - zero;
    };
    channel.value = std::move(left);
    return;
  }
  channel.value = [value = is_of_acting(channel) ? 0.0 : std::numeric_limits<double>::quiet_NaN()](const Snapshot&) { return value; };
}

} // namespace

// Compiles an inactive element into a temporary system, which is then discarded. Its errors are found in this way, and its channels exist.
// Elements that refer to it as a contact get one that is always open.
void SystemBuilder::compile_inactive(const ElementEntry& entry, RequestedChannels& requested) {
  auto aside = std::make_unique<System>();
  aside->bodies = system_->bodies;
  aside->scale = system_->scale;
  aside->gravity = system_->gravity;
  aside->element_names = system_->element_names;
  aside->element_kinds = system_->element_kinds;
  aside->contact_count = system_->contact_count;
  std::vector<GroupType> types;
  const auto first_channel = static_cast<std::ptrdiff_t>(system_->channels.size());
  const std::size_t first_operand = system_->operands.size();
  std::swap(system_, aside);
  std::swap(group_types_, types);
  acting_ = aside.get();
  requested.begin_element();
  entry.kind->compile(*entry.element, *this);
  const bool is_contact = system_->contact_count > acting_->contact_count;
  acting_ = nullptr;
  requested.end_inactive_element(*aside);
  std::swap(system_, aside);
  std::swap(group_types_, types);
  for (auto channel = system_->channels.begin() + first_channel; channel != system_->channels.end(); ++channel) end_value(*channel);
  for (std::size_t i = first_operand; i < system_->operands.size(); ++i) end_value(*system_->operands[i]);
  if (!is_contact) return;
  auto& contacts = group<InactiveContacts>();
  contacts.entries.push_back({});
  add_unit(contacts, 0);
  contacts.entries.back().contact = add_contact(contacts.entries.back().unit);
}

void SystemBuilder::finish() {
  System& s = *system_;
  for (FrictionUnit& unit : s.frictions) {
    unit.first_event = s.event_count;
    s.event_count += k_friction_event_count;
  }
  s.is_body_used.assign(s.bodies.size(), 0);
  for (const auto& group : s.groups) group->mark_bodies(s.is_body_used);
  for (const FrictionUnit& unit : s.frictions) unit.friction->mark_bodies(s.is_body_used);
  s.links.start(s.body_count());
  for (const auto& group : s.groups) group->register_links(s.links);
  s.force_link_count = s.links.size();
  for (const RowSpec& row : s.rows) s.links.add(row.a, row.b);
  for (const FrictionUnit& unit : s.frictions) {
    const RowSpec& row = *unit.friction->rows({}); // its rows have the same two bodies at all contact points
    s.links.add(row.a, row.b);
  }
  s.has_work = std::any_of(group_types_.begin(), group_types_.end(), [](const GroupType& type) { return type.does_work; }) ||
               std::any_of(s.rows.begin(), s.rows.end(), [](const RowSpec& row) { return row.drive != nullptr; });
  for (const Signal* signal : s.motion_signals_)
    std::copy_if(signal->breakpoints().begin(), signal->breakpoints().end(), std::back_inserter(s.motion_breakpoints),
                 [](double t) { return t > 0.0; });
  for (std::vector<double>* const times : {&s.breakpoints, &s.motion_breakpoints}) {
    std::sort(times->begin(), times->end());
    times->erase(std::unique(times->begin(), times->end()), times->end());
  }
}

void SystemBuilder::add_body_channels() {
  struct Coordinate {
    const char* name;
    const char* unit;
    const char* meaning;
    const char* sign;
    double Motion<double>::*member;
  };
  static constexpr const char *k_x = "along x of the ground axes", *k_y = "along y of the ground axes",
                              *k_turn = "positive counter-clockwise";
  static constexpr Coordinate coordinates[] = {
      {"x", "m", "place of the centre of gravity", k_x, &Motion<double>::x},
      {"y", "m", "place of the centre of gravity", k_y, &Motion<double>::y},
      {"theta", "rad", "angle of the body's axes against the ground's", k_turn, &Motion<double>::theta},
      {"vx", "m/s", "velocity of the centre of gravity", k_x, &Motion<double>::vx},
      {"vy", "m/s", "velocity of the centre of gravity", k_y, &Motion<double>::vy},
      {"omega", "rad/s", "angular velocity", k_turn, &Motion<double>::omega}};
  static constexpr Coordinate accelerations[] = {{"ax", "m/s^2", "acceleration of the centre of gravity", k_x, nullptr},
                                                 {"ay", "m/s^2", "acceleration of the centre of gravity", k_y, nullptr},
                                                 {"alpha", "rad/s^2", "angular acceleration", k_turn, nullptr}};
  const auto enter = [this](const std::string& name, const Coordinate& c, std::function<double(const Snapshot&)> value) {
    enter_channel(use_of(name, c.name, false), name, c.name, c.unit, {c.meaning, c.sign}, std::move(value));
  };
  // Room for the channels of a large scene: a vector that grows would touch twice the memory.
  constexpr std::size_t k_of_body = 9, k_of_element = 4;
  if (!wanted_ && model_.output.channels.empty())
    system_->channels.reserve(k_of_body * model_.bodies.size() + k_of_element * model_.elements.size());
  for (int i = 1; i < system_->body_count(); ++i) {
    const std::string& name = system_->bodies[i].name;
    for (const Coordinate& c : coordinates)
      if (use_of(name, c.name, false) != Use::none)
        enter(name, c, [i, member = c.member](const Snapshot& s) { return s.motion[i].*member; });
    for (int k = 0; k < 3; ++k)
      if (use_of(name, accelerations[k].name, false) != Use::none)
        enter(name, accelerations[k], [i, k](const Snapshot& s) { return s.acceleration[3 * i + k]; });
  }
}

CompiledMarker SystemBuilder::marker(const std::string& name) const {
  const auto found = marker_index_.find(name);
  if (found == marker_index_.end()) throw ModelError(model_.elements[element_].element->where, "unknown marker '" + name + "'");
  return found->second;
}

int SystemBuilder::body(const std::string& name) const {
  const auto found = body_index_.find(name);
  if (found == body_index_.end()) throw ModelError(model_.elements[element_].element->where, "unknown body '" + name + "'");
  return found->second;
}

const Signal* SystemBuilder::signal(const std::string& name, SignalUse use) {
  if (name.empty()) return nullptr;
  const Signal* const found = signal_of(name);
  auto& moving = acting().motion_signals_;
  if (use == SignalUse::motion && std::find(moving.begin(), moving.end(), found) == moving.end()) moving.push_back(found);
  return found;
}

const Signal* SystemBuilder::signal_of(const std::string& name) {
  if (const auto found = signal_index_.find(name); found != signal_index_.end()) return found->second;
  if (const Signal* built = signals_.build(name)) {
    auto signal = std::make_unique<Signal>(*built);
    for (const double t : signal->breakpoints())
      if (t > 0.0) acting().breakpoints.push_back(t);
    signal_index_[name] = signal.get();
    acting().signals_.push_back(std::move(signal));
    return signal_index_[name];
  }
  throw ModelError(model_.elements[element_].element->where, "unknown signal '" + name + "'");
}

Vec2 SystemBuilder::marker_position(const CompiledMarker& marker) const {
  const Motion<double>& m = reference_[marker.body];
  return Vec2(m.x, m.y) + rotated(marker.point, m.theta);
}

Vec2 SystemBuilder::direction(const CompiledMarker& marker, const Vec2& local) const { return rotated(local.normalized(), marker.angle); }

const ContactIndex* SystemBuilder::contact(const std::string& element) const {
  const auto found = contact_index_.find(element);
  return found == contact_index_.end() ? nullptr : &found->second;
}

const ElementEntry* SystemBuilder::element(const std::string& name) const {
  const auto found = element_index_.find(name);
  return found == element_index_.end() ? nullptr : &model_.elements[found->second];
}

int SystemBuilder::add_contact(int unit) {
  contact_index_[system_->element_names[element_]] = {system_->contact_count, unit};
  return system_->contact_count++;
}

void SystemBuilder::add_endless_face(int contact, int a, std::vector<Vec2> points, const std::string& b, const Vec2& normal,
                                     std::string remedy) {
  const Body* const part = place_of(model_, b).body;
  if (!part || part->outline.empty()) return;
  const CompiledMarker frame = marker(b);
  EndlessFace face;
  face.element = element_;
  face.contact = contact;
  face.a = a;
  face.b = frame.body;
  face.points = std::move(points);
  face.origin = frame.point;
  face.normal = direction(frame, normal);
  face.part = part->name;
  face.remedy = std::move(remedy);
  face.low = std::numeric_limits<double>::infinity();
  face.high = -face.low;
  const Vec2 along(face.normal.y(), -face.normal.x());
  const Vec3 pose = frame.body == k_ground ? part->reference_pose() : Vec3::Zero(); // a fixed body belongs to the ground
  for (const Vec2& corner : part->outline) {
    const double at = along.dot(Vec2(pose.x(), pose.y()) + rotated(corner - part->cg, pose.z()));
    face.low = std::min(face.low, at);
    face.high = std::max(face.high, at);
  }
  system_->endless_faces.push_back(std::move(face));
}

int SystemBuilder::add_base(double value) {
  system_->initial_bases.push_back({value, 0.0});
  system_->base_elements.push_back(element_);
  return static_cast<int>(system_->initial_bases.size()) - 1;
}

int SystemBuilder::add_impacts() {
  system_->initial_impacts.emplace_back();
  system_->impact_elements.push_back(element_);
  return static_cast<int>(system_->initial_impacts.size()) - 1;
}

int SystemBuilder::add_inner(const ForceGroup& group, double start) {
  const std::string& integrator = model_.simulation.integrator;
  const bool is_first =
      system_->inner_elements.empty() || system_->inner_elements.back() != element_; // at most one message for each element
  const auto cannot = [&](const Method& m) { return m.name == integrator && m.is_time_stepping; };
  if (is_first && !group.are_inner_states_stepped() && std::any_of(methods().begin(), methods().end(), cannot))
    error("'" + integrator +
          "' does not follow what it remembers (the slid distance of an elastic joint, whether a tie has "
          "broken): choose another 'integrator', auto for one");
  if (std::find(system_->inner_groups.begin(), system_->inner_groups.end(), &group) == system_->inner_groups.end())
    system_->inner_groups.push_back(&group);
  system_->initial_inner.push_back(start);
  system_->inner_elements.push_back(element_);
  return system_->inner_count() - 1;
}

void SystemBuilder::add_rows(std::vector<RowSpec> rows, bool is_rigid, int coordinate) {
  const int first = static_cast<int>(system_->rows.size());
  for (RowSpec& row : rows) {
    row.element = element_;
    if (row.drive) { // jumps within the run itself were reported by the element
      constexpr double k_ever = std::numeric_limits<double>::infinity();
      const auto jump = row.drive->first_jump(row.level, std::nextafter(model_.simulation.end, 0.0), k_ever);
      if (jump) system_->drives_end = std::min(system_->drives_end, jump->t);
    }
    system_->rows.push_back(row);
  }
  system_->row_blocks.push_back({first, static_cast<int>(rows.size()), is_rigid, coordinate, element_});
}

int SystemBuilder::add_friction(std::unique_ptr<FrictionElement> friction) {
  const int row = system_->friction_row_count;
  system_->friction_row_count += friction->dimension();
  FrictionUnit unit{std::move(friction), row, 0, element_};
  unit.bounded = dynamic_cast<const BoundedFriction*>(unit.friction.get());
  unit.rope = dynamic_cast<const OneSidedRow*>(unit.friction.get());
  unit.clutch = dynamic_cast<const OneWayLock*>(unit.friction.get());
  system_->frictions.push_back(std::move(unit));
  return static_cast<int>(system_->frictions.size()) - 1;
}

bool SystemBuilder::is_channel_requested(std::string_view owner, std::string_view name) const {
  if (!wanted_) return true;
  return std::any_of(wanted_->begin(), wanted_->end(), [&](std::string_view w) {
    return w.size() == owner.size() + 1 + name.size() && w.starts_with(owner) && w[owner.size()] == '.' && w.ends_with(name);
  });
}

SystemBuilder::Use SystemBuilder::use_of(std::string_view owner, std::string_view name, bool is_on_request) const {
  const auto& also = model_.output.also;
  if (!wanted_ && !is_on_request) return Use::channel;
  if (wanted_ ? is_channel_requested(owner, name) : false) return Use::channel;
  if (!also.empty() || !operand_names_.empty()) {
    std::string whole(owner);
    whole.append(1, '.').append(name);
    if (!wanted_ && std::any_of(also.begin(), also.end(), [&](const std::string& pattern) { return matches_pattern(whole, pattern); }))
      return Use::channel;
    if (std::binary_search(operand_names_.begin(), operand_names_.end(), whole)) return Use::operand;
  }
  return Use::none;
}

Channel& SystemBuilder::enter_channel(Use use, std::string_view owner, std::string_view name, std::string_view unit,
                                      const ChannelText& text, std::function<double(const Snapshot&)> value) {
  std::string whole(owner);
  if (!whole.empty()) whole.append(1, '.');
  whole.append(name);
  Channel channel = acting().make_channel(std::move(whole), unit, text, std::move(value));
  if (use == Use::channel) return acting().channels.emplace_back(std::move(channel));
  return *acting().operands.emplace_back(std::make_unique<Channel>(std::move(channel)));
}

void SystemBuilder::error(const std::string& message) {
  const Element& element = *model_.elements[element_].element;
  errors_.push_back({element.where, model_.elements[element_].kind->name + " '" + element.name + "': " + message});
}

std::unique_ptr<System> compile(const Model& model, const std::vector<std::string>* wanted) {
  if (!model.tables.empty() && !model.is_completed)
    throw ModelError(model.tables.front().table->where,
                     "the model is as given: what its tables stand for is missing, take completed() of it (mbd/model/completion.h)");
  SystemBuilder builder(model, wanted);
  RequestedChannels requested(builder);
  builder.compile_bodies();
  builder.add_body_channels();
  builder.compile_elements(requested);
  builder.finish();
  requested.add();
  if (!builder.errors_.empty()) throw ModelError(builder.errors_);
  return std::move(builder.system_);
}

} // namespace steplap
