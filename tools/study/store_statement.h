// A prepared SQL statement that is finalised automatically. For the implementation of the store only.
#pragma once

#include "tools/study/store.h"

namespace steplap::study {

/// A prepared statement. Parameters are counted from 1, columns from 0, as in SQLite.
struct Store::Statement {
  Statement(Store& store, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  void bind(int i, double x);
  void bind(int i, long n);
  void bind(int i, const std::string& text);
  void bind(int i, const std::vector<double>& numbers);
  /// Reads a column of numbers.
  void take(int i, std::vector<double>& numbers) const;
  /// Executes one step. Returns true if there is a row.
  bool step();
  /// Executes a statement that returns no rows.
  void once();
  // Read a value of the type that was written. Throw if the type differs, because SQLite would convert a text to a number.
  [[nodiscard]] double number(int i) const;
  [[nodiscard]] long integer(int i) const;
  [[nodiscard]] std::string text(int i) const;

  Store& store_;
  sqlite3_stmt* statement = nullptr;
};

} // namespace steplap::study
