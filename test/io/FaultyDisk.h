// SPDX-License-Identifier: BSD-3-Clause
// A disk that fails when it is told to: a SQLite VFS over the real one.
#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace csom::test {

/// While it lives, every database of this process lies on this disk. From the moment that a number
/// of writes and flushes has gone well, all further ones fail.
class FaultyDisk {
 public:
  FaultyDisk() : real_(sqlite3_vfs_find(nullptr)), vfs_(*real_) {
    vfs_.zName = "faulty";
    vfs_.pAppData = this;
    vfs_.szOsFile = static_cast<int>(sizeof(File)) + real_->szOsFile;
    vfs_.xOpen = &open;
    // These get the VFS itself and would look into our pAppData.
    vfs_.xDelete = [](sqlite3_vfs* v, const char* n, int s) {
      return self(v).real_->xDelete(self(v).real_, n, s);
    };
    vfs_.xAccess = [](sqlite3_vfs* v, const char* n, int f, int* r) {
      return self(v).real_->xAccess(self(v).real_, n, f, r);
    };
    vfs_.xFullPathname = [](sqlite3_vfs* v, const char* n, int s, char* o) {
      return self(v).real_->xFullPathname(self(v).real_, n, s, o);
    };
    if (sqlite3_vfs_register(&vfs_, 1) != SQLITE_OK) throw std::runtime_error("no VFS");
  }
  ~FaultyDisk() {
    sqlite3_vfs_register(real_, 1);
    sqlite3_vfs_unregister(&vfs_);
  }
  FaultyDisk(const FaultyDisk&) = delete;
  FaultyDisk& operator=(const FaultyDisk&) = delete;

  /// `error`: SQLITE_IOERR_WRITE, SQLITE_FULL, …
  void failAfter(long operations, int error) {
    left_ = operations;
    error_ = error;
  }
  void repair() { left_ = -1; }
  /// Writes and flushes so far.
  long operations() const { return operations_; }

 private:
  /// Ours, followed in memory by the real one's.
  struct File {
    sqlite3_file base;
    FaultyDisk* disk;
    sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
  };

  static FaultyDisk& self(sqlite3_vfs* vfs) { return *static_cast<FaultyDisk*>(vfs->pAppData); }
  static sqlite3_file* real(sqlite3_file* file) { return reinterpret_cast<File*>(file)->real(); }

  /// SQLITE_OK or the error.
  int use() {
    ++operations_;
    if (left_ == 0) return error_;
    if (left_ > 0) --left_;
    return SQLITE_OK;
  }
  static int use(sqlite3_file* file) { return reinterpret_cast<File*>(file)->disk->use(); }

  static int open(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* out) {
    auto* const ours = reinterpret_cast<File*>(file);
    FaultyDisk& disk = self(vfs);
    ours->disk = &disk;
    ours->base.pMethods = nullptr;
    const int result = disk.real_->xOpen(disk.real_, name, ours->real(), flags, out);
    if (ours->real()->pMethods != nullptr) ours->base.pMethods = methods();
    return result;
  }

  static const sqlite3_io_methods* methods() {
    static const sqlite3_io_methods table = [] {
      sqlite3_io_methods m{};
      m.iVersion = 2;  // with shared memory, which the write-ahead log needs
      m.xClose = [](sqlite3_file* f) { return real(f)->pMethods->xClose(real(f)); };
      m.xRead = [](sqlite3_file* f, void* b, int n, sqlite3_int64 at) {
        return real(f)->pMethods->xRead(real(f), b, n, at);
      };
      m.xWrite = [](sqlite3_file* f, const void* b, int n, sqlite3_int64 at) {
        const int failed = use(f);
        return failed != SQLITE_OK ? failed : real(f)->pMethods->xWrite(real(f), b, n, at);
      };
      m.xTruncate = [](sqlite3_file* f, sqlite3_int64 size) {
        const int failed = use(f);
        return failed != SQLITE_OK ? failed : real(f)->pMethods->xTruncate(real(f), size);
      };
      m.xSync = [](sqlite3_file* f, int flags) {
        const int failed = use(f);
        return failed != SQLITE_OK ? failed : real(f)->pMethods->xSync(real(f), flags);
      };
      m.xFileSize = [](sqlite3_file* f, sqlite3_int64* size) {
        return real(f)->pMethods->xFileSize(real(f), size);
      };
      m.xLock = [](sqlite3_file* f, int k) { return real(f)->pMethods->xLock(real(f), k); };
      m.xUnlock = [](sqlite3_file* f, int k) { return real(f)->pMethods->xUnlock(real(f), k); };
      m.xCheckReservedLock = [](sqlite3_file* f, int* out) {
        return real(f)->pMethods->xCheckReservedLock(real(f), out);
      };
      m.xFileControl = [](sqlite3_file* f, int op, void* arg) {
        return real(f)->pMethods->xFileControl(real(f), op, arg);
      };
      m.xSectorSize = [](sqlite3_file* f) { return real(f)->pMethods->xSectorSize(real(f)); };
      m.xDeviceCharacteristics = [](sqlite3_file* f) {
        return real(f)->pMethods->xDeviceCharacteristics(real(f));
      };
      m.xShmMap = [](sqlite3_file* f, int page, int size, int extend, void volatile** out) {
        return real(f)->pMethods->xShmMap(real(f), page, size, extend, out);
      };
      m.xShmLock = [](sqlite3_file* f, int offset, int n, int flags) {
        return real(f)->pMethods->xShmLock(real(f), offset, n, flags);
      };
      m.xShmBarrier = [](sqlite3_file* f) { real(f)->pMethods->xShmBarrier(real(f)); };
      m.xShmUnmap = [](sqlite3_file* f, int remove) {
        return real(f)->pMethods->xShmUnmap(real(f), remove);
      };
      return m;
    }();
    return &table;
  }

  sqlite3_vfs* real_;
  sqlite3_vfs vfs_;
  long left_ = -1;  ///< operations that still go well; −1: all
  int error_ = SQLITE_IOERR;
  long operations_ = 0;
};

/// What a disk does to who writes to it.
constexpr std::array<int, 3> kDiskErrors{SQLITE_IOERR_WRITE, SQLITE_IOERR_FSYNC, SQLITE_FULL};

/// Name of a test that runs once for each of them.
inline std::string diskErrorName(const testing::TestParamInfo<int>& error) {
  return error.param == SQLITE_FULL          ? "Full"
         : error.param == SQLITE_IOERR_FSYNC ? "Flush"
                                             : "Write";
}

}  // namespace csom::test
