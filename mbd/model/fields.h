// The fields of everything a model file can contain, declared once.
//
// A kind of thing (a body, a signal, a spring-damper, the simulation settings) is a plain struct.
// Its FieldTable lists name, type, unit, default, range and one line of documentation for each
// member. From that table come: reading, validation messages, `--set` paths, the generated
// reference and the JSON Schema. A struct never parses anything itself.
#pragma once

#include "mbd/base/types.h"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace steplap {

/// What kind of value a field holds.
enum class FieldType {
  number,   ///< double, in `unit`
  integer,  ///< long
  boolean,  ///< bool
  text,     ///< free text
  choice,   ///< one of `choices`
  vec2,     ///< [x, y], both in `unit`
  numbers,  ///< list of numbers, each in `unit`
  points,   ///< list of [x, y]; x in `unit`, y in `unit2` (same as unit if empty)
  rings,    ///< list of lists of [x, y]
  body,     ///< name of a body, or "ground"
  marker,   ///< name of a marker or body, or an inline marker { body, at | point, ... }
  signal,   ///< name of a signal
  signals,  ///< list of names of signals
  element,  ///< name of an element
  elements, ///< list of names of elements
  texts,    ///< list of free texts
  quantity, ///< number, or text with a unit that is only known later: kept as text
  file      ///< path of a file, relative to the model file that names it; read as a usable path
};

/// What a field holds, after reading: units removed, inline markers replaced by a marker's name.
using FieldValue = std::variant<double, long, bool, std::string, Vec2, std::vector<double>, std::vector<Vec2>,
                                std::vector<std::vector<Vec2>>, std::vector<std::string>>;

/// One field of a kind of thing: what a file may give, and where in the struct it goes.
struct Field {
  std::string name;                   ///< as written in a model file
  std::string earlier_name;           ///< accepted with a warning until the next minor version; "" if the field was never renamed
  FieldType type = FieldType::number; ///< what it holds
  std::string unit;                   ///< SI unit in UDUNITS spelling ("N/m"), "" = dimensionless; "N m|N": by other fields (field_units.h)
  std::string unit2;                  ///< second unit of a list of points
  std::string doc;                    ///< one line
  bool is_required = false;           ///< a file has to give it
  bool is_limit = false;              ///< a run is judged by it, and nothing moves by it
  double minimum = -std::numeric_limits<double>::infinity(); ///< of each number, in `unit`
  double maximum = std::numeric_limits<double>::infinity();  ///< of each number, in `unit`
  bool is_minimum_excluded = false;                          ///< the value has to be larger than `minimum`
  std::vector<std::string> choices;                          ///< of a field of type choice
  std::function<void(void* object, const FieldValue&)>
      set;                                           ///< writes the value into the struct; throws std::bad_variant_access for another type
  std::function<FieldValue(const void* object)> get; ///< reads it; text "" for an optional field that is not given
};

/// Chained description of one field: table.add("mass", &Body::mass).in("kg").positive().required().
class FieldBuilder {
public:
  /// Describes `field`, which has to outlive it.
  explicit FieldBuilder(Field& field) : field_(&field) {}
  /// Its SI unit in UDUNITS spelling: "N/m".
  FieldBuilder& in(std::string unit) { return assign(field_->unit, std::move(unit)); }
  /// Of a list of points: units of x and y.
  FieldBuilder& in(std::string unit, std::string unit2) {
    field_->unit2 = std::move(unit2);
    return in(std::move(unit));
  }
  /// One line for the reference and for messages.
  FieldBuilder& doc(std::string text) { return assign(field_->doc, std::move(text)); }
  /// The name that the field had in the last minor version. Files may still use it, with a warning.
  FieldBuilder& renamed_from(std::string earlier) { return assign(field_->earlier_name, std::move(earlier)); }
  /// A file has to give it.
  FieldBuilder& required() { return assign(field_->is_required, true); }
  /// A run is judged by it, from its start to its end, and nothing moves by it.
  FieldBuilder& limit() { return assign(field_->is_limit, true); }
  /// Larger than 0.
  FieldBuilder& positive() { return at_least(0.0).excluding_minimum(); }
  /// 0 or larger.
  FieldBuilder& not_negative() { return at_least(0.0); }
  /// Not less than this.
  FieldBuilder& at_least(double lowest) { return assign(field_->minimum, lowest); }
  /// Not more than this.
  FieldBuilder& at_most(double largest) { return assign(field_->maximum, largest); }
  /// Larger than the minimum given.
  FieldBuilder& excluding_minimum() { return assign(field_->is_minimum_excluded, true); }
  /// One of these texts.
  FieldBuilder& one_of(std::vector<std::string> choices) {
    field_->type = FieldType::choice;
    return assign(field_->choices, std::move(choices));
  }
  /// Of another type than its member's own: a name that refers to something, a file.
  FieldBuilder& as(FieldType type) { return assign(field_->type, type); }

private:
  template <class T> FieldBuilder& assign(T& target, T value) {
    target = std::move(value);
    return *this;
  }
  Field* field_;
};

/// The fields of one kind of thing, in the order in which they were added.
class FieldTable {
public:
  /// Adds the member `member` of struct T under `name`. Its default is what T{} holds. A member of
  /// type std::optional<X> is a field without a default: absent means "not given".
  template <class T, class M> FieldBuilder add(std::string name, M T::*member);

  /// In that order.
  [[nodiscard]] const std::vector<Field>& fields() const { return fields_; }
  /// Nullptr if there is none of that name.
  [[nodiscard]] const Field* find(const std::string& name) const;
  /// The field that had this name earlier; nullptr if there is none.
  [[nodiscard]] const Field* find_earlier(const std::string& name) const;
  /// Of all fields, in that order.
  [[nodiscard]] std::vector<std::string> names() const;

private:
  std::vector<Field> fields_;
};

// ---------------------------------------------------------------------------------------------

namespace detail {

template <class M> constexpr FieldType default_field_type() {
  if constexpr (std::is_same_v<M, bool>) return FieldType::boolean;
  else if constexpr (std::is_integral_v<M>) return FieldType::integer;
  else if constexpr (std::is_floating_point_v<M>) return FieldType::number;
  else if constexpr (std::is_same_v<M, std::string>) return FieldType::text;
  else if constexpr (std::is_same_v<M, Vec2>) return FieldType::vec2;
  else if constexpr (std::is_same_v<M, std::vector<double>>) return FieldType::numbers;
  else if constexpr (std::is_same_v<M, std::vector<Vec2>>) return FieldType::points;
  else if constexpr (std::is_same_v<M, std::vector<std::vector<Vec2>>>) return FieldType::rings;
  else return FieldType::texts;
}

template <class M> M from_field_value(const FieldValue& value) {
  if constexpr (std::is_same_v<M, bool>) return std::get<bool>(value);
  else if constexpr (std::is_integral_v<M>) return static_cast<M>(std::get<long>(value));
  else return std::get<M>(value);
}

template <class M> FieldValue to_field_value(const M& value) {
  if constexpr (std::is_same_v<M, bool>) return value;
  else if constexpr (std::is_integral_v<M>) return static_cast<long>(value);
  else return value;
}

template <class M> struct optional_traits {
  using type = M;
  static constexpr bool is_optional = false;
};
template <class M> struct optional_traits<std::optional<M>> {
  using type = M;
  static constexpr bool is_optional = true;
};

} // namespace detail

template <class T, class M> FieldBuilder FieldTable::add(std::string name, M T::*member) {
  using Value = typename detail::optional_traits<M>::type;
  Field& field = fields_.emplace_back();
  field.name = std::move(name);
  field.type = detail::default_field_type<Value>();
  field.set = [member](void* object, const FieldValue& value) {
    static_cast<T*>(object)->*member = detail::from_field_value<Value>(value);
  };
  field.get = [member](const void* object) -> FieldValue {
    if constexpr (detail::optional_traits<M>::is_optional) {
      const M& held = static_cast<const T*>(object)->*member;
      return held ? detail::to_field_value<Value>(*held) : FieldValue(std::string());
    } else {
      return detail::to_field_value<Value>(static_cast<const T*>(object)->*member);
    }
  };
  return FieldBuilder(field);
}

} // namespace steplap
