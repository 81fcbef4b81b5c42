// SPDX-License-Identifier: BSD-3-Clause
// Writing of .npz files: ZIP archives of NumPy arrays.
#pragma once

#include <csom/io/TemporaryFolder.h>

#include <cstddef>
#include <deque>
#include <fstream>
#include <string>

namespace csom::detail {

/// One array on its way into an archive, in C order.
class NumpyArray {
 public:
  /// Starts the file. `type` as NumPy names it ("<f8"), `shape` as Python writes a tuple ("(3,)").
  NumpyArray(std::string name, const std::string& file, const std::string& type,
             const std::string& shape);

  /// Appends numbers. Throws FileError.
  void write(const void* bytes, std::size_t size);
  /// Throws FileError.
  void close();

  const std::string& name() const { return name_; }
  const std::string& file() const { return file_; }

 private:
  std::string name_;
  std::string file_;
  std::ofstream stream_;
};

/// Collects arrays in temporary files, so that none needs to fit into memory, and zips them.
class NumpyArchive {
 public:
  /// Valid until the archive is destroyed. Throws FileError.
  NumpyArray& add(const std::string& name, const std::string& type, const std::string& shape);

  /// Writes NAME.npy for each array. The file appears complete or not at all. Throws FileError.
  void write(const std::string& target);

 private:
  TemporaryFolder folder_;
  std::deque<NumpyArray> arrays_;
};

}  // namespace csom::detail
