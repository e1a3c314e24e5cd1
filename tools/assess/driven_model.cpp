#include "tools/assess/driven_model.h"

#include "elements/prescribed_motion.h"
#include "elements/step_lap/step_lap_joint.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/input_files.h"
#include "mbd/io/read_input.h"
#include "mbd/io/reader.h"
#include "mbd/model/completion.h"
#include "mbd/model/entries.h"
#include "mbd/model/model_building.h"
#include "tools/assess/assumed_limits.h"
#include "transformer/core/core.h"
#include "transformer/program.h"
#include "transformer/recorder/fields.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <utility>

namespace steplap::assess {

namespace {

// A signal defined by samples in memory instead of a file.
struct Recorded : SignalDefinition {
  std::vector<DriveHistory> histories;
  enum class Axis { x, y, across } axis = Axis::x;
  [[nodiscard]] const std::vector<double>& of(const DriveHistory& history) const {
    return axis == Axis::x ? history.x : axis == Axis::y ? history.y : history.across;
  }
};

// Returns the acceleration across the sheets as a continuous signal. Each history ends at zero, except if the next one continues it; then
// its last value is held.
Signal build_pressing(const Recorded& recorded) {
  std::vector<Signal::Piece> pieces(1);
  double held = 0.0;
  bool is_held = true; // true while the signal is constant
  for (const DriveHistory& history : recorded.histories) {
    std::vector<double> a = history.across;
    if (a.size() < 2) continue;
    if (history.begin > 0.0) a.front() = is_held ? held : 0.0;
    if (!history.goes_on) a.back() = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      Signal::Piece piece;
      piece.start = history.begin + static_cast<double>(i) * history.step;
      piece.c[0] = a[i];
      if (i + 1 < a.size()) piece.c[1] = (a[i + 1] - a[i]) / history.step;
      if (piece.start > pieces.back().start) pieces.push_back(std::move(piece));
      else pieces.back() = std::move(piece);
    }
    held = a.back(), is_held = history.goes_on;
  }
  return Signal(std::move(pieces));
}

Signal build_recorded(const SignalDefinition& definition) {
  const auto& recorded = static_cast<const Recorded&>(definition);
  std::vector<Signal::Piece> pieces(1); // zero before the first history
  if (recorded.axis == Recorded::Axis::across) return build_pressing(recorded);
  for (const DriveHistory& history : recorded.histories) {
    const std::vector<double>& a = recorded.of(history);
    for (std::size_t i = 0; i < a.size(); ++i) {
      Signal::Piece piece;
      piece.start = history.begin + static_cast<double>(i) * history.step;
      if (i + 1 < a.size()) piece.c[0] = a[i], piece.c[1] = (a[i + 1] - a[i]) / history.step; // 0 after the last sample
      if (piece.start > pieces.back().start) pieces.push_back(std::move(piece));
      else pieces.back() = std::move(piece);
    }
  }
  return Signal(std::move(pieces));
}

const SignalKind& recorded_kind() {
  static const SignalKind kind = [] {
    SignalKind k;
    k.name = "recorded event";
    k.doc = "The acceleration of a recorder.";
    k.holds<Recorded>();
    k.build = build_recorded;
    return k;
  }();
  return kind;
}

constexpr const char *k_along_x = "recorder drive x", *k_along_y = "recorder drive y", *k_angle = "recorder drive angle";
constexpr const char* k_across = "recorder drive across";

void add_drive(Model& model, const std::string& name, const Recorder& recorder, const std::string& coordinate) {
  auto definition = std::make_shared<Recorded>();
  definition->name = name;
  if (coordinate == "y") definition->axis = Recorded::Axis::y;
  model.signals.emplace_back(&recorded_kind(), std::move(definition));
  auto& motion = add_element<PrescribedMotion>(model, prescribed_motion_kind(), name);
  motion.a = recorder.marker;
  motion.b = "ground";
  motion.coordinate = coordinate;
  motion.signal = name;
  motion.as = "acceleration";
}

// Replaces the signals that press cores and joints across their sheets by the third axis of the record.
void add_across(Model& model, const Recorder& recorder, std::vector<std::string>& notes) {
  if (recorder.across == "none") return;
  const auto is_taken = [&](std::string& signal, const std::string& name) {
    if (signal.empty()) return false;
    notes.push_back("The record's axis " + recorder.across + " takes the place of '" + signal + "' across '" + name + "'.");
    signal = k_across;
    return true;
  };
  bool is_any = false;
  for (Core* const core : tables_of<Core>(model)) is_any |= is_taken(core->transverse_acceleration, core->name);
  for (StepLapJoint* const joint : elements_of<StepLapJoint>(model)) is_any |= is_taken(joint->transverse_acceleration, joint->name);
  if (!is_any)
    throw ModelError(recorder.place("across"), "the recorder '" + recorder.name +
                                                   "' has an axis across that the model does not use: give the core a "
                                                   "'transverse_acceleration' (any signal, which the record replaces) and a "
                                                   "'transverse_support', or leave 'across' out");
  auto definition = std::make_shared<Recorded>();
  definition->name = k_across;
  definition->axis = Recorded::Axis::across;
  model.signals.emplace_back(&recorded_kind(), std::move(definition));
}

// Throws if another drive moves the body, because it would contradict the record.
void refuse_other_drives(const Model& model, const Recorder& recorder, const std::string& body) {
  const auto body_of = [&](const std::string& marker) {
    for (const Marker& m : model.markers)
      if (m.name == marker) return m.body;
    return marker;
  };
  for (const PrescribedMotion* const motion : elements_of<PrescribedMotion>(model)) {
    if (body_of(motion->a) != body && body_of(motion->b) != body) continue;
    throw ModelError(recorder.where, "'" + motion->name + "' drives '" + body + "', and so does the recorder '" + recorder.name +
                                         "': name it in 'replaces', as the record takes its place");
  }
}

// Returns true if the channel belongs to one of the removed elements.
bool belongs_to_any(const std::string& channel, const std::set<std::string>& gone) {
  return std::any_of(gone.begin(), gone.end(), [&](const std::string& name) { return channel.starts_with(name + "."); });
}

void remove_replaced(Model& model, const Recorder& recorder, std::vector<std::string>& notes) {
  const std::set<std::string> gone(recorder.replaces.begin(), recorder.replaces.end());
  std::erase_if(model.elements, [&](const ElementEntry& e) { return gone.contains(e.element->name); });
  std::set<const Element*> unused;
  for (const Plot* const plot : tables_of<Plot>(std::as_const(model))) unused.insert(plot); // signals used only by figures count as unused
  for (const Criterion* const c : tables_of<Criterion>(std::as_const(model))) {
    if (!belongs_to_any(c->channel, gone) && !gone.contains(c->element)) continue;
    notes.push_back("'" + c->name + "' is not asked: the record takes the place of what it looks at.");
    unused.insert(c);
  }
  std::erase_if(model.tables, [&](const TableEntry& entry) { return unused.contains(entry.table.get()); });
  for (const std::string& name : recorder.replaces) notes.push_back("The record takes the place of '" + name + "'.");
}

void begin_at_rest(Model& model, std::vector<std::string>& notes) {
  bool had_speed = model.simulation.velocity != Vec2::Zero();
  model.simulation.velocity.setZero();
  for (Body& body : model.bodies) {
    had_speed |= body.velocity != Vec2::Zero() || body.angular_velocity != 0.0;
    body.velocity.setZero();
    body.angular_velocity = 0.0;
  }
  if (had_speed) notes.push_back("The model's own velocities at the start are left out: the voyage begins at rest.");
  model.simulation.initial = "equilibrium";
}

} // namespace

DriveHistory drive_history(const RecordEvents& record, const RecordedEvent& event, const Recorder& recorder, double angle) {
  const Window& window = event.window;
  const std::size_t count = window.times.size();
  const auto along = [&](const std::string& axis) -> std::vector<double> {
    if (axis == "none") return std::vector<double>(count, 0.0);
    const auto index = record.axis(axis.back());
    if (!index)
      throw FileError(record.file,
                      "the model wants axis " + axis.substr(axis.size() - 1) + " of the record, which '" + record.file + "' does not have");
    std::vector<double> values = window.filtered[*index];
    if (axis.starts_with('-'))
      for (double& value : values) value = -value;
    return values;
  };
  DriveHistory history;
  // Reduces the signal to zero at both ends of the window by a cosine taper, because an event must begin and end at rest. The tapers occupy
  // the outer halves of lead and tail.
  const std::size_t rise = window.lead / 2, fall = window.tail / 2;
  const auto weight = [&](std::size_t i) {
    const auto ramp = [](std::size_t at, std::size_t length) {
      return 0.5 - 0.5 * portable::cos(std::numbers::pi * (static_cast<double>(at) + 0.5) / static_cast<double>(length));
    };
    const std::size_t left = count - 1 - i;
    return (i < rise ? ramp(i, rise) : 1.0) * (left < fall ? ramp(left, fall) : 1.0);
  };
  history.step = 1.0 / window.rate;
  history.goes_on = event.event.goes_on;
  std::vector<double> a = along(recorder.x), b = along(recorder.y);
  if (recorder.across != "none") history.across = along(recorder.across);
  for (std::vector<double>* const values : {&a, &b, &history.across}) {
    if (values->empty() || recorder.drift != "line" || count < 2) continue;
    double sum = 0.0; // trapezoidal sum, in units of the sampling interval
    for (std::size_t i = 1; i < count; ++i) sum += 0.5 * ((*values)[i - 1] + (*values)[i]);
    const double mean = sum / static_cast<double>(count - 1);
    for (double& value : *values) value -= mean;
  }
  const double c = portable::cos(angle), s = portable::sin(angle);
  for (std::size_t i = 0; i < count; ++i) {
    const double w = weight(i);
    history.x.push_back(w * (c * a[i] - s * b[i]));
    history.y.push_back(w * (s * a[i] + c * b[i]));
  }
  return history;
}

double trace_step(const DriveHistory& history) {
  // limits of the step, s; 1 ms resolves vibration of heavy machines' contacts, below 100 Hz
  constexpr double k_most = 1e-3, k_least = 5e-4;
  if (history.step > k_most) return history.step / std::ceil(history.step / k_most);
  return history.step * std::ceil(k_least / history.step);
}

std::string check_gravity(const RecordEvents& record, const DrivenModel& model) {
  // g: smallest reading of gravity; largest deviation from the expected reading, which allows for shocks in the first second
  constexpr double k_gravity_seen = 0.7, k_other = 0.5;
  const std::vector<AxisColumn>& axes = record.recording.layout.axes;
  double size = 0.0;
  for (std::size_t i = 0; i < axes.size(); ++i) size += record.rest[i] * record.rest[i];
  if (model.given.header.gravity.norm() < k_gravity_seen * k_gravity || record.recording.layout.is_peaks) return "";
  if (std::sqrt(size) < k_gravity_seen * k_gravity)
    return "'" + record.file + "' has no gravity in it: that its axes point as '" + model.name + "' says could not be seen.";
  // At rest an accelerometer reads the reaction of its support, opposite to gravity.
  const Vec2 up = -model.given.header.gravity / model.given.header.gravity.norm();
  const double c = portable::cos(model.marker_angle), s = portable::sin(model.marker_angle);
  const std::pair<std::string, double> felt[] = {{model.recorder.x, c * up.x() + s * up.y()}, {model.recorder.y, -s * up.x() + c * up.y()}};
  for (const auto& [axis, share] : felt) {
    const auto index = axis == "none" ? std::nullopt : record.axis(axis.back());
    if (!index) continue;
    const double sign = axis.starts_with('-') ? -1.0 : 1.0, rest = record.rest[*index] / k_gravity;
    if (std::abs(sign * rest - share) < k_other) continue;
    throw FileError(record.file, "axis " + axis.substr(axis.size() - 1) + " of '" + record.file + "' reads " + rounded_text(rest, 3) +
                                     " g at rest, and would read " + rounded_text(sign * share, 3) + " g at rest if it sat as '" +
                                     model.name + "' says (x = \"" + model.recorder.x + "\", y = \"" + model.recorder.y +
                                     "\" of [[recorder]]): correct the axes there, or choose columns and signs of the record");
  }
  return "";
}

DrivenModel driven_model(Model given, const std::string& name) {
  const Recorder* const found = recorder_of(given);
  if (!found)
    throw ModelError({name, 0, 0},
                     "the model has no [[recorder]]: say where the recorder sat and which way it pointed (steplap elements recorder)");
  DrivenModel driven;
  driven.name = name;
  driven.recorder = *found;
  const Model whole = completed(given); // positions of bodies inherited from extended files are known only after completion
  const auto marker = std::find_if(whole.markers.begin(), whole.markers.end(), [&](const Marker& m) { return m.name == found->marker; });
  driven.body = marker->body;
  driven.marker_angle = marker->angle + whole.find_body(driven.body)->angle;
  remove_replaced(given, driven.recorder, driven.notes);
  begin_at_rest(given, driven.notes);
  refuse_other_drives(given, driven.recorder, driven.body);
  add_drive(given, k_along_x, driven.recorder, "x");
  add_drive(given, k_along_y, driven.recorder, "y");
  if (driven.recorder.rotation == "held") add_drive(given, k_angle, driven.recorder, "angle");
  add_across(given, driven.recorder, driven.notes);
  for (TableEntry& entry : given.tables) // the elements named here may have been removed
    if (entry.kind == &recorder_kind()) static_cast<Recorder&>(*entry.table).replaces.clear();
  driven.assumed_limits = assumed_limits(given);
  driven.given = std::move(given);
  return driven;
}

DrivenModel read_driven_model(const std::string& path, const std::vector<std::string>& overrides) {
  if (is_standard_input(path)) throw FileError(path, "a decision names its model: give a file, not standard input");
  DrivenModel driven = driven_model(read_given_model(path, program_catalogue(), overrides), std::filesystem::path(path).stem().string());
  driven.file = path;
  driven.sha256 = sha256_of_file(path);
  driven.text = effective_model_text(path, program_catalogue(), overrides);
  if (!driven.given.header.title.empty()) driven.name = driven.given.header.title;
  return driven;
}

void drive_by(Model& driven, std::vector<DriveHistory> histories, double end) {
  for (SignalEntry& entry : driven.signals) {
    if (entry.kind != &recorded_kind()) continue;
    auto& recorded = static_cast<Recorded&>(*entry.definition);
    if (recorded.name != k_angle) recorded.histories = histories;
  }
  driven.simulation.end = end;
  driven.output.step = end; // only the final output sample is needed; extremes and events do not depend on the step
}

} // namespace steplap::assess
