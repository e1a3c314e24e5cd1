#include "mbd/run/model_entries.h"

namespace steplap {

// Markers that the reader created for references to bodies are omitted; the fields that refer to bodies contain their names.
std::vector<ModelEntry> entries_of(const Model& model) {
  std::vector<ModelEntry> entries{{"", "", &ModelHeader::fields(), nullptr, &model.header},
                                  {"simulation", "", &SimulationSettings::fields(), nullptr, &model.simulation},
                                  {"output", "", &OutputSettings::fields(), nullptr, &model.output}};
  for (const Body& body : model.bodies) entries.push_back({"body." + body.name, "", &Body::fields(), nullptr, &body});
  for (const Marker& marker : model.markers) entries.push_back({"marker." + marker.name, "", &Marker::fields(), nullptr, &marker});
  for (const SignalEntry& e : model.signals)
    entries.push_back({"signal." + e.definition->name, e.kind->name, &e.kind->fields, nullptr, e.definition.get()});
  for (const ElementEntry& e : model.elements)
    entries.push_back({"element." + e.element->name, e.kind->name, &e.kind->fields, &Element::common_fields(), e.element.get()});
  for (const TableEntry& e : model.tables)
    entries.push_back({e.kind->name + "." + e.table->name, "", &e.kind->fields, nullptr, e.table.get()});
  return entries;
}

} // namespace steplap
