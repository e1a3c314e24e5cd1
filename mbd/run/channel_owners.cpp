#include "mbd/run/channel_owners.h"

#include "mbd/formula/formula.h"
#include "mbd/system/places.h"

#include <utility>

namespace steplap {

std::string owner_of(const std::string& channel) { return channel.substr(0, channel.rfind('.')); }

std::set<std::string> owners_of(const Model& model, const std::string& channel) {
  std::set<std::string> owners, seen{channel};
  std::vector<std::string> names{channel};
  while (!names.empty()) {
    const std::string name = std::move(names.back());
    names.pop_back();
    bool is_formula = false;
    for (const DefinedChannel& defined : model.channels) {
      if (defined.name != name) continue;
      is_formula = true;
      const Formula formula(defined.expression, "", {});
      for (const std::string& each : formula.names())
        if (seen.insert(each).second) names.push_back(each);
    }
    if (!is_formula) owners.insert(owner_of(name));
  }
  return owners;
}

std::vector<std::string> bodies_of(const Model& model, const ElementEntry& entry) {
  std::vector<std::string> bodies;
  for (const Field& field : entry.kind->fields.fields())
    if (field.type == FieldType::marker || field.type == FieldType::body) {
      const auto name = std::get<std::string>(field.get(entry.element.get()));
      const Body* const body = name.empty() ? nullptr : place_of(model, name).body;
      if (body && !body->fixed) bodies.push_back(body->name);
    }
  return bodies;
}

} // namespace steplap
