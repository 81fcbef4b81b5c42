// SPDX-License-Identifier: BSD-3-Clause
#include "Sqlite.h"

#include <csom/core/Error.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>

#include "MapSchema.h"
#include "PageSeals.h"

namespace csom::detail {

namespace {

namespace fs = std::filesystem;

constexpr int kBusyMilliseconds = 10000;

/// The path as nothing but a path: SQLite takes `file:NAME` for a URI and `:memory:` for no file.
std::string plainPath(const std::string& path) {
  return fs::absolute(path).string();
}

/// Nothing that a file holds can be longer than the file and its log; what claims to be is made up
/// by the file's own schema.
void limitLengths(sqlite3* handle, const std::string& path) {
  constexpr std::uintmax_t kAtLeast = 1U << 20U;
  constexpr std::uintmax_t kAtMost = 1000000000;  // SQLite's own limit
  std::uintmax_t size = 0;
  for (const char* ending : {"", "-wal"}) {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(path + ending, error);
    if (!error) size += bytes;
  }
  sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, static_cast<int>(std::clamp(size, kAtLeast, kAtMost)));
}

}  // namespace

Database::Database(const std::string& path, const std::string& shown_name, Mode mode)
    : shown_name_(shown_name) {
  const int flags =
      mode == Mode::ReadOnly ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const std::string plain = plainPath(path);
  const int result = sqlite3_open_v2(plain.c_str(), &handle_, flags, nullptr);
  if (result != SQLITE_OK) {
    const std::string reason = sqlite3_errstr(result);
    sqlite3_close(handle_);
    throw FileError(shown_name_, "cannot be opened: " + reason);
  }
  // A map file is data: nothing in its schema may run.
  for (const int setting : {SQLITE_DBCONFIG_TRUSTED_SCHEMA, SQLITE_DBCONFIG_ENABLE_TRIGGER,
                            SQLITE_DBCONFIG_ENABLE_VIEW, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION})
    sqlite3_db_config(handle_, setting, 0, nullptr);
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  if (mode == Mode::ReadOnly) limitLengths(handle_, plain);
  // Whoever writes to the file holds it for a moment only.
  sqlite3_busy_timeout(handle_, kBusyMilliseconds);
}

Database::~Database() {
  sqlite3_close(handle_);
}

void Database::execute(const std::string& sql) {
  if (sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail(sql);
}

void Database::reserveForSeals() {
  execute("PRAGMA page_size = " + std::to_string(kPageSize));
  int bytes = static_cast<int>(kSealSize);
  sqlite3_file_control(handle_, "main", SQLITE_FCNTL_RESERVE_BYTES, &bytes);
}

void Database::copyFrom(const Database& source) {
  sqlite3_backup* const backup = sqlite3_backup_init(handle_, "main", source.handle_, "main");
  if (backup == nullptr) fail("copying");
  sqlite3_backup_step(backup, -1);
  const int result = sqlite3_backup_finish(backup);
  if (result != SQLITE_OK) throw FileError(shown_name_, sqlite3_errstr(result));
}

void Database::close() {
  const int result = sqlite3_close(handle_);
  handle_ = nullptr;
  if (result != SQLITE_OK) throw FileError(shown_name_, sqlite3_errstr(result));
}

void Database::fail(const std::string& what) const {
  switch (sqlite3_errcode(handle_)) {
    case SQLITE_NOTADB:
      throw FileError(shown_name_, "is no csom map (not a SQLite database)");
    case SQLITE_CORRUPT:
      throw FileError(shown_name_, "is damaged or truncated (" +
                                       std::string(sqlite3_errmsg(handle_)) + ")" + kDamaged);
    case SQLITE_FULL:
      throw FileError(shown_name_, "cannot be written: the disk is full");
    case SQLITE_IOERR: {
      const int reason = sqlite3_system_errno(handle_);
      throw FileError(shown_name_, std::string("cannot be read or written: ") +
                                       (reason != 0 ? std::strerror(reason) : "disk I/O error"));
    }
    case SQLITE_BUSY:
      throw FileError(shown_name_,
                      "cannot be locked: another program is writing to it, or its file system has "
                      "no locks; in that case copy it, or write it, to another one");
    case SQLITE_CANTOPEN:
      throw FileError(
          shown_name_,
          "cannot be opened; if it has a log beside it (-wal) and lies where nothing can "
          "be written, copy both to another folder");
    case SQLITE_TOOBIG:
      throw FileError(shown_name_,
                      std::string("has a value that is longer than the file") + kDamaged);
    default:
      throw FileError(shown_name_, std::string(sqlite3_errmsg(handle_)) + " (at: " + what + ")");
  }
}

Statement::Statement(const Database& database, const std::string& sql) : database_(database) {
  const int result = sqlite3_prepare_v2(database_.handle(), sql.c_str(), -1, &statement_, nullptr);
  if (result != SQLITE_OK) database_.fail(sql);
}

Statement::~Statement() {
  sqlite3_finalize(statement_);
}

void Statement::check(int result) const {
  if (result != SQLITE_OK && result != SQLITE_DONE && result != SQLITE_ROW)
    database_.fail(sqlite3_sql(statement_));
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(statement_, parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  check(sqlite3_bind_double(statement_, parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
  check(sqlite3_bind_text64(statement_, parameter, text.data(), text.size(), SQLITE_TRANSIENT,
                            SQLITE_UTF8));
  return *this;
}

Statement& Statement::bindBlob(int parameter, const void* bytes, std::size_t size) {
  check(sqlite3_bind_blob64(statement_, parameter, bytes, size, SQLITE_STATIC));
  return *this;
}

bool Statement::step() {
  const int result = sqlite3_step(statement_);
  check(result);
  if (result != SQLITE_ROW) return false;
  ++row_;
  return true;
}

void Statement::run() {
  step();
  check(sqlite3_reset(statement_));
}

void Statement::expectType(int column, int type) const {
  const int found = sqlite3_column_type(statement_, column);
  if (found == type) return;
  static constexpr const char* kTypeNames[] = {"",       "an integer", "a real number",
                                               "a text", "a blob",     "null"};
  const char* name = sqlite3_column_name(statement_, column);
  throw FileError(database_.shownName(),
                  "row " + std::to_string(row_) + " of '" + sqlite3_sql(statement_) +
                      "': column '" + (name != nullptr ? name : "?") + "' is " + kTypeNames[found] +
                      ", must be " + kTypeNames[type] + kDamaged);
}

std::int64_t Statement::integer(int column) const {
  expectType(column, SQLITE_INTEGER);
  return sqlite3_column_int64(statement_, column);
}

double Statement::real(int column) const {
  if (sqlite3_column_type(statement_, column) == SQLITE_NULL)
    return std::numeric_limits<double>::quiet_NaN();
  expectType(column, SQLITE_FLOAT);
  return sqlite3_column_double(statement_, column);
}

std::string Statement::text(int column) const {
  expectType(column, SQLITE_TEXT);
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  if (bytes == nullptr) database_.fail("reading a text");
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

std::string_view Statement::blob(int column) const {
  expectType(column, SQLITE_BLOB);
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_, column));
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

}  // namespace csom::detail
