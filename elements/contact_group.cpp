#include "elements/contact_group.h"

#include "elements/drawn_outline.h"
#include "elements/polygon_contact.h"
#include "elements/shape.h"
#include "mbd/base/name_pattern.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/repetition.h"
#include "mbd/model/entries.h"
#include "mbd/model/model_building.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace steplap {

namespace {

using Names = std::vector<std::string>;

bool has(const Names& names, const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); }

class GroupMaker {
public:
  GroupMaker(const ContactGroup& group, Model& model) : group_(group), model_(model) {
    for (const Body& body : model.bodies) {
      order_.emplace(body.name, bodies_.size());
      bodies_.push_back(body.name);
    }
  }

  void make() {
    if (const std::string problem = friction_problem(group_.static_friction, group_.kinetic_friction); !problem.empty())
      error("static_friction", problem);
    const Names ones = members("a", group_.a, {}), others = members("b", group_.b, touchable());
    check_outlines("a", ones);
    if (!group_.normal) check_outlines("b", others);
    if (problems_.empty()) add_pairs(ones, others);
    if (!problems_.empty()) throw ModelError(std::move(problems_));
  }

private:
  void error(const std::string& field, const std::string& message) {
    problems_.push_back({group_.place(field), "contacts '" + group_.name + "': " + message});
  }
  // Returns the names that are no bodies but may be touched: a pattern never matches them.
  [[nodiscard]] Names touchable() const {
    Names names{"ground"};
    for (const Marker& marker : model_.markers) names.push_back(marker.name);
    return names;
  }
  // Returns the bodies that match a pattern, in the order of patterns and bodies, and the names of `further` that are given.
  Names members(const std::string& field, const Names& patterns, const Names& further) {
    Names found;
    for (const std::string& pattern : patterns) {
      const std::size_t before = found.size();
      bool is_known = has(further, pattern);
      if (is_known && !has(found, pattern)) found.push_back(pattern);
      for (const std::string& body : bodies_) {
        if (!matches_pattern(body, pattern)) continue;
        is_known = true;
        if (!has(found, body)) found.push_back(body);
      }
      if (found.size() == before && !is_known) error(field, "'" + pattern + "' names no body" + did_you_mean(pattern, bodies_));
    }
    return found;
  }
  // A body without outline would be an error of each of its pairs.
  void check_outlines(const std::string& field, const Names& members) {
    Names outlined; // by tables that are applied later
    for (const BodyShape* shape : tables_of<BodyShape>(model_)) outlined.push_back(shape->body);
    for (const DrawnOutline* drawing : tables_of<DrawnOutline>(model_)) outlined.push_back(drawing->body);
    for (const Body& body : model_.bodies)
      if (body.outline.empty() && !has(outlined, body.name) && has(members, body.name))
        error(field, "'" + body.name + "' has no outline: give it one");
  }
  void add_pairs(const Names& ones, const Names& others) {
    std::set<std::pair<std::string, std::string>> made;
    std::vector<std::pair<std::string, std::string>> pairs;
    const std::set<std::string> in_a(ones.begin(), ones.end()), in_b(others.begin(), others.end());
    const auto is_made_the_other_way = [&](const std::string& one, const std::string& other) {
      return in_a.count(other) > 0 && in_b.count(one) > 0 && order_.at(other) > order_.at(one);
    };
    for (const std::string& one : ones)
      for (const std::string& other : others) {
        if (one == other || is_made_the_other_way(one, other)) continue;
        if (made.insert(std::minmax(one, other)).second) pairs.emplace_back(one, other);
      }
    if (pairs.empty()) error("", "makes no contact: 'a' and 'b' are the same single body");
    if (pairs.size() > k_most_entries)
      return error("", "makes " + std::to_string(pairs.size()) + " contacts, more than the " + std::to_string(k_most_entries) +
                           " entries that a model may have");
    for (const auto& [one, other] : pairs) add_pair(one, other);
  }
  void add_pair(const std::string& one, const std::string& other) {
    PolygonContact& contact = add_element<PolygonContact>(model_, polygon_contact_kind(), group_.name + "." + one + " on " + other);
    contact.where = group_.where;
    contact.a = one;
    contact.b = other;
    contact.normal = group_.normal;
    contact.stiffness = group_.stiffness;
    contact.dissipation = group_.dissipation;
    contact.static_friction = group_.static_friction;
    contact.kinetic_friction = group_.kinetic_friction;
    contact.source = group_.source;
  }

  const ContactGroup& group_;
  Model& model_;
  Names bodies_;
  std::map<std::string, std::size_t> order_; ///< of the bodies in the model
  std::vector<Diagnostic> problems_;
};

} // namespace

void ContactGroup::add_bodies(Model& model) const { GroupMaker(*this, model).make(); }

const TableKind& contact_group_kind() {
  static const TableKind kind = [] {
    using T = ContactGroup;
    TableKind k;
    k.name = "contacts";
    k.doc = "Contact between the outlines of all bodies of one group and all of another: a polygon_contact for each pair, named "
            "'name.one on other', with the fields given here.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).required().doc("bodies that touch: patterns of names with * and ?");
    f.add("b", &T::b).required().doc("what they touch: patterns of bodies, \"ground\", or names of markers; may be the same group");
    f.add("normal", &T::normal).doc("b are half-planes, as in polygon_contact");
    add_contact_law<T>(f);
    k.holds<T>();
    k.reads_masses = k.reads_elements = false;
    k.apply = [](const Element&, Model&) {}; // it adds only elements between bodies
    return k;
  }();
  return kind;
}

} // namespace steplap
