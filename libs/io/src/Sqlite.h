// SPDX-License-Identifier: BSD-3-Clause
// SQLite with RAII and exceptions: as much of it as the map file needs.
#pragma once

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace csom::detail {

/// A connection. Every failure is a FileError that names the file as the user knows it.
class Database {
 public:
  enum class Mode { ReadOnly, ReadWrite };

  /// Opens `path`; `shown_name` stands in errors.
  Database(const std::string& path, const std::string& shown_name, Mode mode);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void execute(const std::string& sql);
  /// To be called before the first table is made: every page keeps room for its seal.
  void reserveForSeals();
  /// Makes this database, which must be empty, the same as another one, page by page.
  void copyFrom(const Database& source);
  /// Closes the connection and reports what that finds; the destructor would be silent.
  void close();

  [[noreturn]] void fail(const std::string& what) const;
  sqlite3* handle() const { return handle_; }
  const std::string& shownName() const { return shown_name_; }

 private:
  sqlite3* handle_ = nullptr;
  std::string shown_name_;
};

/// A prepared statement. Parameters count from 1, columns from 0.
class Statement {
 public:
  Statement(const Database& database, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);
  Statement& bind(int parameter, std::string_view text);
  /// The bytes must live until the next run() or step().
  Statement& bindBlob(int parameter, const void* bytes, std::size_t size);

  /// Advances to the next row; false at the end.
  bool step();
  /// Makes it ready to be run again; the values of the current row are gone.
  void reset() { check(sqlite3_reset(statement_)); }
  /// Runs a statement without rows and makes it ready for the next set of parameters.
  void run();

  /// Values of the current row. A value of another type is a FileError: nothing is converted.
  std::int64_t integer(int column) const;
  /// NaN for null: that is how SQLite stores NaN.
  double real(int column) const;
  std::string text(int column) const;
  /// Valid until the next step().
  std::string_view blob(int column) const;
  /// Number of the current row, from 1.
  std::int64_t row() const { return row_; }

 private:
  void check(int result) const;
  void expectType(int column, int type) const;

  const Database& database_;
  sqlite3_stmt* statement_ = nullptr;
  std::int64_t row_ = 0;
};

}  // namespace csom::detail
