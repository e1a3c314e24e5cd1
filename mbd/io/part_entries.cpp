#include "mbd/io/part_entries.h"

#include "mbd/formula/renamed_formula.h"
#include "mbd/io/parameters_reader.h"
#include "mbd/io/presentation.h"
#include "mbd/model/action.h"
#include "mbd/model/formula_fields.h"
#include "mbd/model/placement.h"

#include <algorithm>
#include <stdexcept>

namespace steplap {

namespace {

const char* const k_ground_name = "ground";

// Returns true if a marker, or a table about a body such as a look, names the ground.
bool is_on_ground(const Node& entry) {
  const Node* const body = entry.find("body");
  return body && body->text() == k_ground_name;
}

void prefix_texts(Node& node, const std::string& prefix) {
  if (node.type == Node::Type::text && node.text() != k_ground_name) node.scalar = prefix + node.text();
  for (Node& child : node.children) prefix_texts(child, prefix);
}

// Adds the prefix to the names of elements, signals and actions in the steps of an action.
void prefix_steps(Node& node, const std::string& prefix) {
  for (Node& child : node.children) prefix_steps(child, prefix);
  if (node.type != Node::Type::text) return;
  try {
    ActionStepText step = action_step(node.text());
    if (step.verb == ActionVerb::stop) return;
    step.name = prefix + step.name;
    if (step.verb == ActionVerb::set && is_name_in_step(step.value)) step.value = prefix + step.value;
    node.scalar = text_of(step);
  } catch (const std::invalid_argument&) { // reported when the action is compiled
  }
}

Node text_at(const std::string& key, const Node& at, const std::string& text) {
  Node node = node_at(key, at);
  node.type = Node::Type::text;
  node.scalar = text;
  return node;
}

bool is_presentation(const std::string& array) { return array == "channel" || array == "plot" || array == "acceptance"; }

} // namespace

// Properties of a kind of entry that the conversion needs.
struct PartEntries::KindFacts {
  const FieldTable* fields = nullptr;
  std::shared_ptr<Element> made;            // null for signals
  std::vector<const Field*> ground_markers; // marker fields that default to the ground
  bool has_ground_axes = false;             // vectors are in ground axes if `frame` is not given
};

std::string with_prefixed_names(const std::string& formula, const std::string& prefix, bool (*stays)(const std::string& name)) {
  if (prefix.empty()) return formula;
  return with_operands(formula, [&](const std::string& name) { return stays && stays(name) ? name : "{" + prefix + name + "}"; });
}

void prefix_formulas(Node& node, const std::string& prefix) {
  if (node.type == Node::Type::text && is_formula(node)) {
    const std::string text = node.text();
    const std::size_t begin = text.find('=') + 1;
    node.scalar = text.substr(0, begin) + with_prefixed_names(text.substr(begin), prefix);
  }
  for (Node& child : node.children) prefix_formulas(child, prefix);
}

PartEntries::PartEntries(const Catalogue& catalogue, std::vector<Diagnostic>& problems) : problems_(problems) {
  for (const ElementKind* kind : catalogue.elements) elements_.emplace(kind->name, facts_of(kind->fields, kind->create()));
  for (const SignalKind* kind : catalogue.signals) signals_.emplace(kind->name, facts_of(kind->fields, nullptr));
  for (const TableKind* kind : catalogue.tables) {
    tables_.emplace(kind->name, facts_of(kind->fields, kind->create()));
    if (!is_allowed_in_part(*kind)) model_only_.push_back(kind->name);
  }
}

std::shared_ptr<const PartEntries::KindFacts> PartEntries::facts_of(const FieldTable& fields, std::shared_ptr<Element> made) {
  auto facts = std::make_shared<KindFacts>();
  facts->fields = &fields;
  facts->made = std::move(made);
  if (!facts->made) return facts;
  for (const Field& field : fields.fields()) {
    const auto text = [&] { return std::get<std::string>(field.get(facts->made.get())); };
    if (field.type == FieldType::marker && text() == k_ground_name) facts->ground_markers.push_back(&field);
    if (field.name == "frame" && field.type == FieldType::choice) facts->has_ground_axes = text() == k_ground_name;
  }
  return facts;
}

bool PartEntries::are_model_only(const std::string& array) const {
  return std::find(model_only_.begin(), model_only_.end(), array) != model_only_.end();
}

bool PartEntries::are_known(const std::string& array) const {
  return array == "body" || array == "marker" || array == "signal" || array == "element" ||
         (tables_.count(array) > 0 && !are_model_only(array));
}

std::vector<std::string> PartEntries::arrays() const {
  std::vector<std::string> names = {"body", "marker", "signal", "element"};
  for (const auto& [name, facts] : tables_)
    if (!are_model_only(name)) names.push_back(name);
  std::sort(names.begin() + 4, names.end());
  return names;
}

const PartEntries::KindFacts* PartEntries::kind_of(const Kinds& kinds, const Node& entry) const {
  const Node* const name = entry.find("kind");
  const auto found = kinds.find(name ? name->text() : "");
  return found == kinds.end() ? nullptr : found->second.get();
}

Node PartEntries::made(const std::string& array, const Node& entry, const Node& root, const PartPlacement& part, bool is_whole) {
  Node result = entry;
  prefix_formulas(result, part.prefix);
  if (Node* const name = result.find("name")) prefix_texts(*name, part.prefix);
  if (array == "body") put_body(result, root, part, is_whole);
  else if (array == "marker") put_marker(result, part, is_whole);
  else if (is_presentation(array)) put_presentation(array, result, part, is_whole);
  else if (const auto table = tables_.find(array); table != tables_.end()) put_fields(result, *table->second, part, is_whole);
  else if (const KindFacts* const facts = kind_of(array == "element" ? elements_ : signals_, entry))
    put_fields(result, *facts, part, is_whole);
  return result; // unknown kinds are reported by the reader
}

void PartEntries::note_placing_joints(const Node& root, const PartPlacement& part) {
  const Node* const array = root.find("element");
  if (!array || !array->is_array_of_tables()) return;
  for (const Node& entry : array->children) {
    const KindFacts* const facts = kind_of(elements_, entry);
    const auto* const joint = facts ? dynamic_cast<const PlacingElement*>(facts->made.get()) : nullptr;
    if (!joint || !entry.find(joint->placing_field())) continue;
    for (const char* const end : {"a", "b"}) {
      const Node* const marker = entry.find(end);
      if (!marker) continue;
      const Node* const body = marker->is_table() ? marker->find("body") : marker;
      if (body && body->text() != k_ground_name) placed_.insert(part.prefix + body->text());
    }
  }
}

bool PartEntries::is_placed_by_joint(const Node& body, const Node& root, const PartPlacement& part) const {
  const std::string name = entry_name(body); // the name with the prefix of the part
  if (placed_.count(name) > 0) return true;
  const Node* const markers = root.find("marker");
  if (!markers || !markers->is_array_of_tables()) return false;
  return std::any_of(markers->children.begin(), markers->children.end(), [&](const Node& marker) {
    const Node* const owner = marker.find("body");
    return owner && part.prefix + owner->text() == name && placed_.count(part.prefix + entry_name(marker)) > 0;
  });
}

void PartEntries::put_body(Node& body, const Node& root, const PartPlacement& part, bool is_whole) const {
  const PartFrame& frame = part.frame;
  if (!frame.is_placed()) return;
  Node *const position = body.find("position"), *const angle = body.find("angle"), *const velocity = body.find("velocity");
  const bool has_position = position != nullptr, has_angle = angle != nullptr;
  if (position) frame.place_points(*position);
  if (angle) frame.turn_angle(*angle);
  if (velocity) frame.turn_vector(*velocity, "m/s");
  if (!is_whole || (!has_position && !has_angle && is_placed_by_joint(body, root, part))) return;
  if (!has_position) body.children.push_back(frame.origin_node("position", body));
  if (!has_angle && frame.is_turned()) body.children.push_back(frame.angle_node("angle", body));
}

void PartEntries::put_marker(Node& marker, const PartPlacement& part, bool is_whole) const {
  const bool is_grounded = is_on_ground(marker);
  if (Node* const body = marker.find("body")) prefix_texts(*body, part.prefix);
  const PartFrame& frame = part.frame;
  if (!frame.is_placed()) return;
  Node* const at = marker.find("at");
  if (at) frame.place_points(*at);
  if (!is_grounded) return;
  Node *const point = marker.find("point"), *const angle = marker.find("angle");
  const bool has_angle = angle != nullptr;
  if (point) frame.place_points(*point);
  if (angle) frame.turn_angle(*angle);
  if (!is_whole) return;
  if (!point && !at) marker.children.push_back(frame.origin_node("at", marker));
  if (!has_angle && frame.is_turned()) marker.children.push_back(frame.angle_node("angle", marker));
}

// Converts a reference to a marker or body, or an inline marker. If the part has a position, a reference to the ground becomes a marker at
// the part's origin.
void PartEntries::put_reference(Node& node, const PartPlacement& part) const {
  if (node.is_table()) {
    if (Node* const name = node.find("name")) prefix_texts(*name, part.prefix);
    return put_marker(node, part);
  }
  if (node.text() != k_ground_name || !part.frame.is_placed()) return prefix_texts(node, part.prefix);
  Node marker = node_at(node.key, node);
  marker.key_line = node.key_line;
  marker.key_column = node.key_column;
  marker.children.push_back(text_at("body", node, k_ground_name));
  put_marker(marker, part);
  node = std::move(marker);
}

void PartEntries::put_fields(Node& entry, const KindFacts& facts, const PartPlacement& part, bool is_whole) {
  const Node* const frame = entry.find("frame");
  const bool is_in_ground = facts.has_ground_axes && (!frame || frame->text() == k_ground_name);
  const std::string subject = entry_name(entry);
  for (Node& child : entry.children)
    if (const Field* const field = facts.fields->find(child.key)) put_field(child, *field, facts, is_in_ground, subject, part);
  if (!part.frame.is_placed()) return;
  if (is_on_ground(entry)) put_on_ground(entry, facts, part, is_whole);
  if (!is_whole) return;
  for (const Field* field : facts.ground_markers) {
    if (entry.find(field->name)) continue;
    Node ground = text_at(field->name, entry, k_ground_name);
    put_reference(ground, part);
    entry.children.push_back(std::move(ground));
  }
}

// Moves an entry that is drawn on the ground, such as a road, with its part. An error is added if the part is rotated, since such entries
// are horizontal.
void PartEntries::put_on_ground(Node& entry, const KindFacts& facts, const PartPlacement& part, bool is_whole) {
  const Field* const place = facts.fields->find("at");
  if (!place || place->type != FieldType::vec2) return;
  if (part.frame.is_turned())
    problems_.push_back({entry.where(), "'" + entry_name(entry) +
                                            "' lies level on the ground and cannot turn with its part, which has an " +
                                            "'angle': write it into the model"});
  Node* const at = entry.find("at");
  if (at) part.frame.place_points(*at);
  else if (is_whole) entry.children.push_back(part.frame.origin_node("at", entry));
}

void PartEntries::put_field(Node& child, const Field& field, const KindFacts& facts, bool is_in_ground, const std::string& subject,
                            const PartPlacement& part) {
  switch (field.type) {
  case FieldType::body:
  case FieldType::signal:
  case FieldType::signals:
  case FieldType::element:
  case FieldType::elements: prefix_texts(child, part.prefix); break;
  case FieldType::marker: put_reference(child, part); break;
  default: break;
  }
  if (facts.made && as_action(*facts.made)) {
    if (field.name == "do") return prefix_steps(child, part.prefix);
    const auto event = field.name == "when" && child.type == Node::Type::text ? event_text(child.text()) : std::nullopt;
    if (event) {
      child.scalar = part.prefix + event->element + " " + words_of(event->kind);
      return;
    }
  }
  if (is_formula_field(field) && child.type == Node::Type::text) child.scalar = with_prefixed_names(child.text(), part.prefix, is_own_name);
  const PartTreatment treatment = part_treatment(*facts.fields, field);
  if (treatment == PartTreatment::name) prefix_texts(child, part.prefix);
  if (!is_in_ground) return;
  if (treatment == PartTreatment::place) part.frame.place_points(child);
  if (treatment == PartTreatment::direction) part.frame.turn_vector(child, field.unit);
  if (treatment == PartTreatment::fixed_axis && part.frame.is_turned())
    problems_.push_back({child.where(), "'" + field.name + "' of '" + subject +
                                            "' acts along an axis of the ground and cannot turn with its part, which has an 'angle': " +
                                            "give it frame = \"body\", and its marker the axes"});
}

// Adds the prefix to names in formulas, and to patterns of channels and elements.
void PartEntries::put_presentation(const std::string& array, Node& entry, const PartPlacement& part, bool is_whole) const {
  const auto prefixed = [&](const char* key) {
    if (Node* const node = entry.find(key)) prefix_texts(*node, part.prefix);
  };
  if (array == "channel") {
    Node* const expression = entry.find("expression");
    if (expression && expression->type == Node::Type::text) expression->scalar = with_prefixed_names(expression->text(), part.prefix);
  } else if (array == "plot") {
    prefixed("channels");
    prefixed("bounds");
  } else {
    prefixed("channel");
    prefixed("element");
    Node* const event = entry.find("event"); // without `element`, the event of any element of the part is meant
    if (!is_whole || !event || entry.find("element")) return;
    entry.children.push_back(text_at("element", *event, part.prefix + "*"));
  }
}

} // namespace steplap
