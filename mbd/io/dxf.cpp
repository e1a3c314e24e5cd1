#include "mbd/io/dxf.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/units.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>
#include <system_error>

namespace steplap {

namespace {

constexpr double k_missing = std::numeric_limits<double>::quiet_NaN(); // coordinate that the file has not given yet

// Units of $INSUNITS, by its number.
const std::map<int, std::string>& units_of_dxf() {
  static const std::map<int, std::string> units = {{1, "in"}, {2, "ft"}, {4, "mm"}, {5, "cm"}, {6, "m"}, {7, "km"}, {10, "yd"}, {14, "dm"}};
  return units;
}

std::string_view trimmed(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

struct Group {
  int code = 0;
  std::string_view value;
  int line = 0; ///< of the value
};

enum class EntityKind { light_polyline, polyline, other };

EntityKind kind_of(std::string_view type) {
  if (type == "LWPOLYLINE") return EntityKind::light_polyline;
  return type == "POLYLINE" ? EntityKind::polyline : EntityKind::other;
}

// A polyline or another entity on some layer.
struct Entity {
  EntityKind kind = EntityKind::other;
  std::string type, layer; ///< `type` as the file names it, for messages
  std::vector<Vec2> corners;
  bool is_closed = false, has_arc = false, is_in_space = false, is_on_paper = false;
  int line = 0;
};

class DxfReader {
public:
  DxfReader(const std::string& text, const std::string& file, const Location& where) : rest_(text), file_(file), where_(where) {
    if (text.starts_with("AutoCAD Binary DXF")) fail_at(1, "is a binary DXF file: save it as ASCII DXF");
  }

  void read() {
    while (next()) {
      if (group_.code != 0 || group_.value != "SECTION") continue;
      if (!next() || group_.code != 2) fail_at(line_, "has a section without a name");
      if (group_.value == "HEADER") read_header();
      else if (group_.value == "ENTITIES") read_entities();
    }
    if (!has_entities_)
      throw ModelError(where_, "'" + file_ + "' has no section ENTITIES: it is no ASCII DXF drawing, or an incomplete one");
  }
  [[nodiscard]] int insertion_units() const { return units_; }
  [[nodiscard]] const std::vector<Entity>& entities() const { return entities_; }
  [[noreturn]] void fail_at(int line, const std::string& message) const { throw ModelError({file_, line, 1}, "the drawing " + message); }

private:
  std::string_view next_line() {
    const std::size_t end = rest_.find('\n');
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    return trimmed(line);
  }
  // Reads the next group. Returns false at the end of the file.
  bool next() {
    if (trimmed(rest_).empty() || (group_.code == 0 && group_.value == "EOF")) return false;
    const std::string_view code = next_line();
    const auto [end, status] = std::from_chars(code.data(), code.data() + code.size(), group_.code);
    if (status != std::errc() || end != code.data() + code.size())
      fail_at(line_, "has '" + shown(code.substr(0, 30)) + "' where a group code is expected: it is no ASCII DXF file");
    if (rest_.empty()) fail_at(line_, "ends within a group: it is incomplete");
    group_.value = next_line();
    group_.line = line_;
    return true;
  }
  [[nodiscard]] double number() const {
    const double value = parsed<double>("a number");
    if (!std::isfinite(value)) fail_at(group_.line, "has '" + shown(group_.value.substr(0, 30)) + "' where a number is expected");
    return value;
  }
  [[nodiscard]] int integer() const { return parsed<int>("a whole number"); }
  template <class T> [[nodiscard]] T parsed(const char* wanted) const {
    T value{};
    const std::string_view text = group_.value.starts_with('+') ? group_.value.substr(1) : group_.value;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc() || end != text.data() + text.size())
      fail_at(group_.line, "has '" + shown(group_.value.substr(0, 30)) + "' where " + wanted + " is expected");
    return value;
  }

  void read_header() {
    bool is_unit = false;
    while (next() && !(group_.code == 0 && group_.value == "ENDSEC")) {
      if (group_.code == 9) is_unit = group_.value == "$INSUNITS";
      else if (is_unit && group_.code == 70) units_ = integer();
    }
  }
  // The vertices of a POLYLINE are entities that follow it, up to a SEQEND.
  void read_entities() {
    has_entities_ = true;
    bool has_vertices = false; // an old polyline that is not at its end
    while (next() && !(group_.code == 0 && group_.value == "ENDSEC")) {
      if (group_.code == 0) {
        const std::string type(group_.value);
        is_vertex_ = has_vertices && type == "VERTEX";
        if (is_vertex_) entities_.back().corners.emplace_back(k_missing, k_missing);
        else if (!(has_vertices && type == "SEQEND"))
          entities_.push_back({kind_of(type), type, "", {}, false, false, false, false, group_.line});
        has_vertices = is_vertex_ || kind_of(type) == EntityKind::polyline;
      } else if (!entities_.empty()) {
        read_group(entities_.back());
      }
    }
  }
  void read_group(Entity& entity) {
    if (entity.kind == EntityKind::other && group_.code != 8 && group_.code != 67) return;
    const bool is_light = entity.kind == EntityKind::light_polyline;
    switch (group_.code) {
    case 8:
      if (!is_vertex_) entity.layer = group_.value;
      break;
    case 10:
      if (is_light) entity.corners.emplace_back(number(), k_missing);
      else if (is_vertex_) entity.corners.back().x() = number();
      break;
    case 20:
      if (!entity.corners.empty() && (is_light || is_vertex_)) entity.corners.back().y() = number();
      break;
    case 42: entity.has_arc = entity.has_arc || number() != 0.0; break;
    case 67: entity.is_on_paper = integer() != 0; break;
    case 70: read_flags(entity); break;
    case 230: entity.is_in_space = entity.is_in_space || number() != 1.0; break; // seen from below, or oblique
    default: break;
    }
  }
  void read_flags(Entity& entity) {
    constexpr int k_closed = 1, k_space_and_meshes = 8 | 16 | 64, k_curve_and_spline = 2 | 4, k_vertex_of_curve = 1 | 8 | 16;
    const int flags = integer();
    if (is_vertex_) {
      entity.has_arc = entity.has_arc || (flags & k_vertex_of_curve) != 0;
      return;
    }
    entity.is_closed = (flags & k_closed) != 0;
    if (entity.kind == EntityKind::light_polyline) return;
    entity.is_in_space = entity.is_in_space || (flags & k_space_and_meshes) != 0;
    entity.has_arc = entity.has_arc || (flags & k_curve_and_spline) != 0;
  }

  std::string_view rest_;
  const std::string& file_;
  const Location& where_;
  Group group_;
  int line_ = 0, units_ = 0;
  bool has_entities_ = false, is_vertex_ = false;
  std::vector<Entity> entities_;
};

// Returns metres for one unit of the drawing.
double unit_of(const DxfReader& drawing, const std::string& given, const std::string& file, const Location& where) {
  const auto stated = units_of_dxf().find(drawing.insertion_units());
  const bool is_stated = stated != units_of_dxf().end();
  if (given.empty() && !is_stated)
    throw ModelError(where, "'" + file + "' does not state its unit ($INSUNITS is " + std::to_string(drawing.insertion_units()) +
                                "): give 'unit', as in \"mm\"");
  if (!given.empty() && is_stated && given != stated->second)
    throw ModelError(where, "'unit' is " + given + ", and '" + file + "' is in " + stated->second + " ($INSUNITS): leave 'unit' out");
  return parse_quantity("1 " + (given.empty() ? stated->second : given), "m").value;
}

const Entity& only_polyline(const DxfReader& drawing, const std::string& layer, const std::string& file, const Location& where) {
  const Entity* found = nullptr;
  std::vector<std::string> layers;
  for (const Entity& entity : drawing.entities()) {
    if (entity.is_on_paper) continue;
    layers.push_back(entity.layer);
    if (entity.layer != layer) continue;
    const std::string subject = "has a " + shown(entity.type) + " on layer '" + layer + "'";
    if (entity.kind == EntityKind::other) drawing.fail_at(entity.line, subject + ": an outline is one closed polyline, alone on its layer");
    if (found)
      drawing.fail_at(entity.line, subject + ", after another in line " + std::to_string(found->line) + ": give each its own layer");
    found = &entity;
    if (entity.is_in_space) drawing.fail_at(entity.line, subject + " that is not drawn in the plane: flatten it");
    if (entity.has_arc) drawing.fail_at(entity.line, subject + " with arcs or curves: an outline has straight sides");
  }
  if (!found) throw ModelError(where, "'" + file + "' has nothing on a layer '" + layer + "'" + did_you_mean(layer, layers));
  return *found;
}

} // namespace

std::vector<Vec2> parse_dxf_outline(const std::string& text, const std::string& file_name, const std::string& layer,
                                    const std::string& unit, const Location& where) {
  DxfReader drawing(text, file_name, where);
  drawing.read();
  const Entity& polyline = only_polyline(drawing, layer, file_name, where);
  const double metres = unit_of(drawing, unit, file_name, where);
  std::vector<Vec2> corners = polyline.corners;
  const bool ends_where_it_begins = corners.size() > 1 && corners.front() == corners.back();
  if (!polyline.is_closed && !ends_where_it_begins)
    drawing.fail_at(polyline.line, "has an open " + polyline.type + " on layer '" + layer + "': close it");
  if (ends_where_it_begins) corners.pop_back();
  if (corners.size() < 3)
    drawing.fail_at(polyline.line, "has a " + polyline.type + " of " + counted(corners.size(), "corner", "corners") + " on layer '" +
                                       layer + "': an outline has three or more");
  for (Vec2& corner : corners) {
    if (!corner.allFinite())
      drawing.fail_at(polyline.line, "has a " + polyline.type + " on layer '" + layer + "' with a corner that lacks a coordinate");
    corner *= metres;
  }
  return corners;
}

} // namespace steplap
