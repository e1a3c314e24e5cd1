// A catalogue with made-up kinds, for tests of the reader: it knows no real element either.
#pragma once

#include "mbd/io/record_signal.h"
#include "mbd/model/placement.h"

namespace steplap::testing {

struct Spring : Element {
  std::string a, b;
  double stiffness = 0.0;
  std::optional<double> damping;
  double preload = 0.0;
  std::string law = "linear";
  std::vector<Vec2> table;
  long turns = 3;
  bool is_on = true;
};

struct Pin : PlacingElement {
  std::optional<double> angle, spin;
  std::optional<RelativePose> relative_pose() const override {
    if (!angle) return std::nullopt;
    return RelativePose{Vec2::Zero(), *angle, Vec2::Zero(), spin.value_or(0.0)};
  }
  const char* placing_field() const override { return "angle"; }
  const char* idle_field() const override { return spin ? "spin" : nullptr; }
};

struct Pusher : Element {
  std::string body, signal;
  std::vector<std::string> against;
  std::vector<double> offsets;
};

struct Pair : Element {
  double spacing = 1.0;
  std::string carrier = "ground";
};

inline const ElementKind& spring_kind() {
  static const ElementKind kind = [] {
    ElementKind k;
    k.name = "spring";
    k.doc = "A spring between two markers; pulls when stretched.";
    k.holds<Spring>();
    k.fields.add("a", &Spring::a).as(FieldType::marker).required().doc("first end");
    k.fields.add("b", &Spring::b).as(FieldType::marker).required().doc("second end");
    k.fields.add("stiffness", &Spring::stiffness).in("N/m").positive().required().doc("stiffness");
    k.fields.add("damping", &Spring::damping).in("N s/m").not_negative().doc("damper's coefficient");
    k.fields.add("preload", &Spring::preload).in("N").doc("force in the reference pose");
    k.fields.add("law", &Spring::law).one_of({"linear", "table"}).doc("how force follows stretch");
    k.fields.add("table", &Spring::table).in("m", "N").doc("stretch and force");
    k.fields.add("turns", &Spring::turns).at_least(1).at_most(20).doc("number of turns");
    k.fields.add("is_on", &Spring::is_on).doc("false: does nothing");
    return k;
  }();
  return kind;
}

inline const ElementKind& pin_kind() {
  static const ElementKind kind = [] {
    ElementKind k;
    k.name = "pin";
    k.doc = "Joins two markers.";
    k.holds<Pin>();
    k.fields.add("a", &Pin::a).as(FieldType::marker).required().doc("first marker");
    k.fields.add("b", &Pin::b).as(FieldType::marker).doc("second marker");
    k.fields.add("angle", &Pin::angle).in("rad").doc("of a against b in the reference pose");
    k.fields.add("spin", &Pin::spin).in("rad/s").doc("its rate");
    return k;
  }();
  return kind;
}

inline const ElementKind& pusher_kind() {
  static const ElementKind kind = [] {
    ElementKind k;
    k.name = "pusher";
    k.doc = "Pushes a body.";
    k.holds<Pusher>();
    k.fields.add("body", &Pusher::body).as(FieldType::body).required().doc("what it pushes");
    k.fields.add("signal", &Pusher::signal).as(FieldType::signal).in("*").required().doc("force, N");
    k.fields.add("against", &Pusher::against).as(FieldType::elements).doc("elements it works against");
    k.fields.add("offsets", &Pusher::offsets).in("m").doc("lever arms");
    return k;
  }();
  return kind;
}

// [[pair]]: adds two bodies.
inline const TableKind& pair_kind() {
  static const TableKind kind = [] {
    TableKind k;
    k.name = "pair";
    k.doc = "Two equal bodies side by side.";
    k.holds<Pair>();
    k.fields.add("spacing", &Pair::spacing).in("m").positive().doc("distance of the two");
    k.fields.add("carrier", &Pair::carrier).as(FieldType::body).doc("what carries them");
    k.apply = [](const Element& table, Model& model) {
      const auto& pair = static_cast<const Pair&>(table);
      for (const double side : {-0.5, 0.5}) {
        Body& body = model.bodies.emplace_back();
        body.name = pair.name + (side < 0 ? " left" : " right");
        body.mass = body.inertia = 1.0;
        body.position = {side * pair.spacing, 0.0};
        body.where = pair.where;
      }
    };
    return k;
  }();
  return kind;
}

inline const Catalogue& small_catalogue() {
  static const Catalogue catalogue = [] {
    Catalogue c{{&spring_kind(), &pin_kind(), &pusher_kind()}, signal_kinds(), {&pair_kind()}};
    c.signals.push_back(&record_signal_kind());
    return c;
  }();
  return catalogue;
}

} // namespace steplap::testing
