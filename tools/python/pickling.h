// Pickling of plain structs, member by member.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/run/version.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <type_traits>

namespace steplap::python {

namespace py = pybind11;

/// Conversion of a member of type T to a picklable object. Specialised for types that Python cannot convert.
template <class T> struct MemberPickle {
  static py::object state(const T& member) {
    if constexpr (std::is_enum_v<T>) return py::int_(static_cast<int>(member));
    else return py::cast(member);
  }
  static void restore(T& member, const py::handle& state) {
    if constexpr (std::is_enum_v<T>) member = static_cast<T>(state.cast<int>());
    else member = state.cast<T>();
  }
};

template <> struct MemberPickle<Location> {
  static py::object state(const Location& where) { return py::make_tuple(where.file, where.line, where.column); }
  static void restore(Location& where, const py::handle& state) {
    const auto parts = state.cast<py::tuple>();
    where = {parts[0].cast<std::string>(), parts[1].cast<int>(), parts[2].cast<int>()};
  }
};

/// Returns the argument of py::class_::def() that pickles the members of a default-constructible struct. A pickle of another version of
/// steplap is refused with ValueError, because its struct may differ.
template <class T, class... Members> auto pickling_of(Members T::*... members) {
  return py::pickle([members...](const T& object) { return py::make_tuple(k_version, MemberPickle<Members>::state(object.*members)...); },
                    [members...](const py::tuple& state) {
                      const auto version = state[0].cast<std::string>();
                      if (version != k_version)
                        throw py::value_error("pickled by steplap " + version + ", whose results steplap " + k_version + " cannot read");
                      T object;
                      std::size_t i = 1;
                      (MemberPickle<Members>::restore(object.*members, state[i++]), ...);
                      return object;
                    });
}

} // namespace steplap::python
