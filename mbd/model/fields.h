// Description of all fields that a model file can contain.
//
// Each kind of entry (body, signal, spring-damper, simulation settings) is a plain struct. Its FieldTable lists name, type, unit, default,
// range and documentation for each member. Reading, validation messages, `--set` paths, the generated reference and the JSON Schema all use
// this table; a struct contains no parsing code.
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

/// Type of the value of a field.
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

/// Value of a field after reading: in SI units; an inline marker is replaced by the name of the marker made for it.
using FieldValue = std::variant<double, long, bool, std::string, Vec2, std::vector<double>, std::vector<Vec2>,
                                std::vector<std::vector<Vec2>>, std::vector<std::string>>;

/// Description of one field: its spelling and range in a file, and access to the member of the struct.
struct Field {
  std::string name;                   ///< as written in a model file
  std::string earlier_name;           ///< accepted with a warning until the next minor version; "" if the field was never renamed
  FieldType type = FieldType::number; ///< type of its value
  std::string unit;                   ///< SI unit in UDUNITS spelling ("N/m"), "" = dimensionless; "N m|N": by other fields (field_units.h)
  std::string unit2;                  ///< second unit of a list of points
  std::string doc;                    ///< description, one line
  bool is_required = false;           ///< must be given in a file
  bool is_limit = false;              ///< limit used only to judge a run, without effect on the motion
  double minimum = -std::numeric_limits<double>::infinity(); ///< smallest allowed value of each number, in `unit`
  double maximum = std::numeric_limits<double>::infinity();  ///< largest allowed value of each number, in `unit`
  bool is_minimum_excluded = false;                          ///< values must be larger than `minimum`, not equal
  std::vector<std::string> choices;                          ///< allowed texts, for type choice
  std::function<void(void* object, const FieldValue&)>
      set;                                           ///< writes the value into the struct; throws std::bad_variant_access for another type
  std::function<FieldValue(const void* object)> get; ///< returns the value; text "" for an optional field that is not given
};

/// Chained description of one field: table.add("mass", &Body::mass).in("kg").positive().required().
class FieldBuilder {
public:
  /// Edits `field`, which must outlive the builder.
  explicit FieldBuilder(Field& field) : field_(&field) {}
  /// Sets the SI unit in UDUNITS spelling, such as "N/m".
  FieldBuilder& in(std::string unit) { return assign(field_->unit, std::move(unit)); }
  /// Sets the units of x and y for a list of points.
  FieldBuilder& in(std::string unit, std::string unit2) {
    field_->unit2 = std::move(unit2);
    return in(std::move(unit));
  }
  /// Sets the description, one line, for the reference and for messages.
  FieldBuilder& doc(std::string text) { return assign(field_->doc, std::move(text)); }
  /// Sets the name of the field in the previous minor version. Files may still use it, with a warning.
  FieldBuilder& renamed_from(std::string earlier) { return assign(field_->earlier_name, std::move(earlier)); }
  /// Marks the field as required in files.
  FieldBuilder& required() { return assign(field_->is_required, true); }
  /// Marks the field as a limit that only judges a run from start to end and does not affect the motion.
  FieldBuilder& limit() { return assign(field_->is_limit, true); }
  /// Requires values > 0.
  FieldBuilder& positive() { return at_least(0.0).excluding_minimum(); }
  /// Requires values ≥ 0.
  FieldBuilder& not_negative() { return at_least(0.0); }
  /// Requires values ≥ `lowest`.
  FieldBuilder& at_least(double lowest) { return assign(field_->minimum, lowest); }
  /// Requires values ≤ `largest`.
  FieldBuilder& at_most(double largest) { return assign(field_->maximum, largest); }
  /// Excludes the minimum itself.
  FieldBuilder& excluding_minimum() { return assign(field_->is_minimum_excluded, true); }
  /// Makes the field a choice of these texts.
  FieldBuilder& one_of(std::vector<std::string> choices) {
    field_->type = FieldType::choice;
    return assign(field_->choices, std::move(choices));
  }
  /// Sets a type other than that of the member, for example for a text that is a name or a file.
  FieldBuilder& as(FieldType type) { return assign(field_->type, type); }

private:
  template <class T> FieldBuilder& assign(T& target, T value) {
    target = std::move(value);
    return *this;
  }
  Field* field_;
};

/// Fields of one kind of entry, in the order in which they were added.
class FieldTable {
public:
  /// Adds member `member` of struct T under `name`. Its default is the value in T{}. A member of type std::optional<X> has no default: if
  /// it is absent, it is not given.
  template <class T, class M> FieldBuilder add(std::string name, M T::*member);

  /// Returns all fields, in order of addition.
  [[nodiscard]] const std::vector<Field>& fields() const { return fields_; }
  /// Returns the field with this name, or nullptr.
  [[nodiscard]] const Field* find(const std::string& name) const;
  /// Returns the field that had this name in an earlier version, or nullptr.
  [[nodiscard]] const Field* find_earlier(const std::string& name) const;
  /// Returns the names of all fields, in the same order.
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
