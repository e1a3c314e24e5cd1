#include "mbd/io/reference.h"

#include "mbd/base/event_kind.h"
#include "mbd/base/number_text.h"
#include "mbd/io/described.h"
#include "mbd/io/kind_channels.h"
#include "mbd/model/field_units.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

std::string range_text(const Field& field) {
  const bool has_minimum = std::isfinite(field.minimum), has_maximum = std::isfinite(field.maximum);
  std::string text;
  if (has_minimum) text = (field.is_minimum_excluded ? "> " : ">= ") + number_text(field.minimum);
  if (has_maximum) text += (has_minimum ? ", <= " : "<= ") + number_text(field.maximum);
  return text;
}

std::string unit_text(const Field& field) {
  if (field.type == FieldType::quantity) return "the channel's";
  if (field.unit == "*") return "any unit";
  return field.unit2.empty() ? shown_unit(field) : field.unit + ", " + field.unit2;
}

std::string default_text(const Described& kind, const Field& field) {
  if (field.is_required) return "required";
  const std::string text = kind.default_text(field);
  return text.empty() ? "-" : text;
}

std::string heading(const Described& kind) {
  if (kind.role == "signal") return "[[signal]] of kind \"" + kind.name + "\"";
  if (kind.role == "element") return "[[element]] of kind \"" + kind.name + "\"";
  if (kind.role == "common") return "every [[element]]";
  if (kind.role == "settings") return "[" + kind.name + "]";
  return kind.role == "table" ? "[[" + kind.name + "]]" : "top level of a model file";
}

ReferenceRows rows_of(const Described& kind) {
  ReferenceRows rows{{"field", "type", "unit", "default", "range", "meaning"}};
  const bool has_name = kind.role == "signal" || kind.role == "element" || kind.role == "table";
  if (has_name && !kind.fields->find("name")) rows.push_back({"name", "text", "", "required", "", "unique name"});
  for (const Field& f : kind.fields->fields())
    rows.push_back({f.name, type_text(f), unit_text(f), default_text(kind, f), range_text(f), f.doc});
  return rows;
}

std::string escaped(std::string cell) {
  for (std::size_t i = cell.find('|'); i != std::string::npos; i = cell.find('|', i + 2)) cell.insert(i, "\\");
  return cell;
}

std::string markdown(const ReferenceRows& rows) {
  std::string text;
  for (const std::vector<std::string>& row : rows) {
    for (const std::string& cell : row) text += "| " + escaped(cell) + " ";
    text += "|\n";
    if (&row != &rows.front()) continue;
    for (std::size_t i = 0; i < row.size(); ++i) text += "|---";
    text += "|\n";
  }
  return text;
}

// Returns the example of a kind of element; "" for kinds that are not elements.
std::string example_of(const Catalogue& catalogue, const Described& kind) {
  const ElementKind* const element = kind.role == "element" ? catalogue.find_element(kind.name) : nullptr;
  return element ? example_text(*element) : std::string{};
}

// Returns the channels of elements of a kind, of bodies or of markers.
std::vector<KindChannel> channels_of(const Catalogue& catalogue, const Described& kind) {
  if (kind.role == "table" && kind.name == "body") return channels_of_bodies(catalogue);
  if (kind.role == "table" && kind.name == "marker") return channels_of_markers(catalogue);
  if (kind.role == "settings" && kind.name == "output") return channels_of_model(catalogue);
  if (kind.role != "element") return {};
  const ElementKind* const element = catalogue.find_element(kind.name);
  return element ? channels_of_kind(catalogue, *element) : std::vector<KindChannel>{};
}

std::string owner_of(const Described& kind) { return kind.name == "output" ? "whole." : "NAME."; }

ReferenceRows rows_of(const std::string& owner, const std::vector<KindChannel>& channels) {
  ReferenceRows rows{{"channel", "unit", "made", "sign", "meaning"}};
  for (const KindChannel& c : channels)
    rows.push_back({owner + c.name, units_text(c), c.is_on_request ? "on request" : "always", c.sign,
                    c.codes.empty() ? c.meaning : c.meaning + ": " + c.codes});
  return rows;
}

std::string events_markdown() {
  ReferenceRows rows{{"event", "what happens"}};
  for (std::size_t i = 1; i < k_event_kinds; ++i) {
    const auto kind = static_cast<EventKind>(i);
    rows.push_back({words_of(kind), doc_of(kind)});
  }
  return "\n## Events\nWhat `events.csv` and the criteria `event = \"…\"` of `[[acceptance]]` call what happens.\n\n" + markdown(rows);
}

} // namespace

ReferenceRows kinds_rows(const Catalogue& catalogue) {
  ReferenceRows rows{{"role", "kind", "what it is"}};
  for (const Described& kind : describe(catalogue)) rows.push_back({kind.role, kind.name, kind.doc});
  return rows;
}

std::vector<KindReference> kind_references(const Catalogue& catalogue, const std::string& name) {
  std::vector<KindReference> found;
  std::vector<std::string> known;
  for (const Described& kind : describe(catalogue)) {
    if (kind.name == name) {
      const std::vector<KindChannel> channels = channels_of(catalogue, kind);
      found.push_back({heading(kind), kind.doc, rows_of(kind), channels.empty() ? ReferenceRows{} : rows_of(owner_of(kind), channels),
                       example_of(catalogue, kind)});
    }
    known.push_back(kind.name);
  }
  if (!found.empty()) return found;
  throw ModelError(Location{}, "there is no kind '" + name + "'" + did_you_mean(name, known));
}

std::string example_model(const Catalogue& catalogue, const std::string& name) {
  if (const ElementKind* const element = catalogue.find_element(name)) return example_model(*element);
  std::vector<std::string> known;
  for (const ElementKind* kind : catalogue.elements) known.push_back(kind->name);
  throw ModelError(Location{}, "there is no kind of element '" + name + "'" + did_you_mean(name, known));
}

std::string reference_markdown(const Catalogue& catalogue) {
  std::string text = "# Model reference\n\nGenerated from the field tables. Numbers are SI; a string "
                     "may carry a unit, as in \"47 t\".\n\nBelow the fields of a kind stand the channels of its elements "
                     "(docs/reference/channels.md): what a run "
                     "writes always, and what it writes if `also` of `[output]` asks for it.\n";
  for (const Described& kind : describe(catalogue)) {
    text += "\n## " + heading(kind) + "\n" + kind.doc + "\n\n" + markdown(rows_of(kind));
    if (const std::vector<KindChannel> channels = channels_of(catalogue, kind); !channels.empty())
      text += "\n" + markdown(rows_of(owner_of(kind), channels));
    if (const std::string example = example_of(catalogue, kind); !example.empty()) text += "\n```toml\n" + example + "```\n";
  }
  return text + events_markdown();
}

} // namespace steplap
